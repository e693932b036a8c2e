// Requests to and replies from a process that reads picture files.
//
// Both sides are this program, so that records go through the pipes as they lie in memory. The process is not trusted
// once it has seen a file: sizes and kinds are judged as if they came from the file.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "image/picture_reader.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/confine_filter.h"
#include "base/process.h"
#include "image/encode.h"
#include "image/image_error.h"
#include "image/module.h"

enum { FORMAT_BYTES = 8, WAIT_MILLISECONDS = 20, ROOM_TO_DECODE = 512 << 20 };

typedef struct Request {
    char format[FORMAT_BYTES];
    PictureLimit limit;
    uint64_t data_most; // bytes of private memory that the process may have
    char real[PATH_MAX];
} Request;

// A PictureFile in numbers, any of which may be wrong; samples follow.
typedef struct Reply {
    int32_t status, has_no_memory;
    int32_t width, height, channels, depth, bits, has_gamma, is_associated, is_damaged;
    double gamma;
    char detail[sizeof(((ImageError *)NULL)->detail)];
} Reply;

static size_t samples_bytes(const PictureFile *file)
{
    return (size_t)file->width * (size_t)file->height * (size_t)file->channels * encode_sample_bytes(file->depth);
}

// ---- the process

static bool pipe_take(int fd, void *bytes, size_t length)
{
    for (char *at = bytes; length > 0;) {
        ssize_t count = read(fd, at, length);
        if (count <= 0 && !(count < 0 && errno == EINTR)) {
            return false;
        }
        at += count > 0 ? count : 0;
        length -= count > 0 ? (size_t)count : 0;
    }
    return true;
}

static bool pipe_put(int fd, const void *bytes, size_t length)
{
    for (const char *at = bytes; length > 0;) {
        ssize_t count = write(fd, at, length);
        if (count <= 0 && !(count < 0 && errno == EINTR)) {
            return false;
        }
        at += count > 0 ? count : 0;
        length -= count > 0 ? (size_t)count : 0;
    }
    return true;
}

// Loads what reads the format, while memory that can be run may still be made. Reading reports what is missing, too.
static bool load_module(const char *format)
{
    ImageError error;
    const JpegModule *jpeg;
    const OiioModule *oiio;
    ImageStatus status =
        strcmp(format, "jpeg") == 0 ? module_load_jpeg(&jpeg, &error) : module_load_oiio(&oiio, &error);
    return status == IMAGE_OK;
}

static void limit_data(uint64_t most)
{
    struct rlimit data;
    if (getrlimit(RLIMIT_DATA, &data) == 0) {
        data.rlim_cur = most < data.rlim_max ? (rlim_t)most : data.rlim_max;
        (void)setrlimit(RLIMIT_DATA, &data);
    }
}

static bool answer(int replies, const Request *request)
{
    PictureFile file;
    ImageError error;
    ImageStatus status = picture_file_read_real(request->real, request->format, &request->limit, &file, &error);
    Reply reply = {.status = (int32_t)status,
                   .has_no_memory = error.no_memory,
                   .width = file.width,
                   .height = file.height,
                   .channels = file.channels,
                   .depth = (int32_t)file.depth,
                   .bits = file.bits,
                   .has_gamma = file.has_gamma,
                   .is_associated = file.is_associated,
                   .is_damaged = file.is_damaged,
                   .gamma = file.gamma};
    memcpy(reply.detail, error.detail, sizeof reply.detail);
    bool is_said = pipe_put(replies, &reply, sizeof reply) &&
                   (status != IMAGE_OK || pipe_put(replies, file.samples, samples_bytes(&file)));
    if (status == IMAGE_OK) {
        picture_file_fini(&file);
    }
    return is_said;
}

// What one library reads, until the pipe of requests is closed.
static void serve(int requests, int replies)
{
    Request request;
    bool is_ready = false;
    while (pipe_take(requests, &request, sizeof request)) {
        limit_data(request.data_most);
        if (!is_ready) {
            is_ready = load_module(request.format);
            confine_filter(CONFINE_READS | CONFINE_IS_STRICT);
        }
        if (!answer(replies, &request)) {
            return;
        }
    }
}

// What it inherits of handlers and buffers is the program's: it leaves without touching them.
static _Noreturn void be_reader(int requests, int replies, pid_t parent)
{
    const struct rlimit none = {0, 0};
    signal(SIGINT, SIG_IGN); // from a terminal it comes to both; the program ends this one
    signal(SIGTERM, SIG_IGN);
    (void)setrlimit(RLIMIT_CORE, &none);
    (void)prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    if (prctl(PR_SET_PDEATHSIG, SIGKILL) == 0 && getppid() == parent) {
        confine_filter(CONFINE_READS);
        serve(requests, replies);
    }
    _exit(0);
}

// ---- the program's side

void picture_reader_init(PictureReader *reader, const atomic_bool *cancel)
{
    *reader = (PictureReader){.requests = {-1, -1}, .replies = -1, .cancel = cancel};
}

static bool reader_start(PictureReader *reader, ImageError *error)
{
    int replies[2];
    pid_t parent = getpid();
    if (pipe2(reader->requests, O_CLOEXEC) != 0) {
        image_error_system(error, "a process to read it", errno);
        return false;
    }
    pid_t process = pipe2(replies, O_CLOEXEC) == 0 ? process_copy() : -1;
    if (process == 0) {
        close(reader->requests[1]);
        close(replies[0]);
        be_reader(reader->requests[0], replies[1], parent);
    }
    if (process < 0) {
        image_error_system(error, "a process to read it", errno);
        close(reader->requests[0]);
        close(reader->requests[1]);
        return false;
    }
    close(replies[1]);
    reader->replies = replies[0];
    reader->process = process;
    return true;
}

// Waits for the process, whose pipes are closed, a moment; it may not hear. Whether it ended, and how.
static bool reader_wait(const PictureReader *reader, int *status)
{
    const struct timespec pause = {.tv_nsec = 1000000};
    bool is_ended = waitpid(reader->process, status, WNOHANG) != 0;
    for (int i = 0; !is_ended && i < WAIT_MILLISECONDS; i++) {
        nanosleep(&pause, NULL);
        is_ended = waitpid(reader->process, status, WNOHANG) != 0;
    }
    return is_ended;
}

// A program that has forbidden itself signals may leave a process that works on, which ends with the program's thread.
static int reader_end(PictureReader *reader)
{
    int status = 0;
    close(reader->requests[0]);
    close(reader->requests[1]);
    close(reader->replies);
    if (!reader_wait(reader, &status) && kill(reader->process, SIGKILL) == 0) {
        (void)waitpid(reader->process, &status, 0);
        status = 0; // that signal is no news
    }
    reader->process = 0;
    return status;
}

void picture_reader_end(PictureReader *reader)
{
    if (reader->process > 0) {
        (void)reader_end(reader);
    }
}

// Takes bytes that the process sends. False: it ended before, or nobody waits for them any more.
static bool reader_take(const PictureReader *reader, void *bytes, size_t length)
{
    for (char *at = bytes; length > 0;) {
        struct pollfd pipe = {.fd = reader->replies, .events = POLLIN};
        siginfo_t ended = {.si_pid = 0};
        int ready = poll(&pipe, 1, WAIT_MILLISECONDS);
        ssize_t count = ready > 0 ? read(reader->replies, at, length) : 0;
        if (atomic_load(reader->cancel) || (ready > 0 && count <= 0 && !(count < 0 && errno == EINTR))) {
            return false;
        }
        // Where others hold the pipe open, its end does not come.
        if (ready == 0 && waitid(P_PID, (id_t)reader->process, &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
            ended.si_pid != 0 && poll(&pipe, 1, 0) == 0) {
            return false;
        }
        at += count > 0 ? count : 0;
        length -= count > 0 ? (size_t)count : 0;
    }
    return true;
}

// Bytes of private memory that this process has now, of which the other one is a copy.
static uint64_t data_bytes(void)
{
    unsigned long long pages = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    if (file) {
        if (fscanf(file, "%*u %*u %*u %*u %*u %llu", &pages) != 1) { // NOLINT(cert-err34-c): the kernel's own
            pages = 0;
        }
        fclose(file);
    }
    return pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

// Whether a file may be as the process says.
static bool reply_is_sound(const Reply *reply)
{
    if (reply->status != IMAGE_OK) {
        return reply->status > 0 && reply->status <= IMAGE_TOO_LARGE && reply->width >= 0 && reply->height >= 0;
    }
    return reply->width > 0 && reply->height > 0 && reply->channels >= 1 && reply->channels <= 4 && reply->depth >= 0 &&
           reply->depth <= IMAGE_DEPTH_FLOAT && reply->bits >= 1 && reply->bits <= 64 && isfinite(reply->gamma) &&
           reply->gamma >= 0.0;
}

static void reply_open(const Reply *reply, PictureFile *file, ImageError *error)
{
    *file = (PictureFile){.width = reply->width,
                          .height = reply->height,
                          .channels = reply->channels,
                          .depth = (ImageDepth)reply->depth,
                          .bits = reply->bits,
                          .has_gamma = reply->has_gamma != 0,
                          .gamma = reply->gamma,
                          .is_associated = reply->is_associated != 0,
                          .is_damaged = reply->is_damaged != 0};
    image_error_set(error, "%.*s", (int)sizeof reply->detail, reply->detail);
    error->no_memory = reply->has_no_memory != 0;
}

// Says how the process ended, which sent no reply that makes sense.
static ImageStatus fail_reader(PictureReader *reader, ImageError *error)
{
    int status = reader_end(reader);
    if (WIFSIGNALED(status)) {
        image_error_set(error, "the process that read it was ended by signal %d", WTERMSIG(status));
    } else {
        image_error_set(error, "the process that read it failed");
    }
    return IMAGE_NOT_A_PICTURE;
}

static bool is_started(PictureReader *reader, const char *format, ImageError *error)
{
    bool is_jpeg = strcmp(format, "jpeg") == 0;
    if (reader->process > 0 && reader->reads_jpeg != is_jpeg) {
        (void)reader_end(reader); // it can load no other library
    }
    reader->reads_jpeg = is_jpeg;
    return reader->process > 0 || reader_start(reader, error);
}

ImageStatus picture_reader_read(PictureReader *reader, const char *real, const char *format, const PictureLimit *limit,
                                PictureFile *file, ImageError *error)
{
    Request request = {.limit = {.pixels = limit->pixels, .bytes = limit->bytes}};
    Reply reply;
    uint64_t room = limit->bytes < INT64_MAX / 4 ? limit->bytes : INT64_MAX / 4;
    *file = (PictureFile){0};
    image_error_clear(error);
    snprintf(request.format, sizeof request.format, "%s", format);
    snprintf(request.real, sizeof request.real, "%s", real); // realpath gives no longer ones
    request.data_most = data_bytes() + room + ROOM_TO_DECODE;
    ImageStatus status = picture_file_begins(real, format, error);
    if (status == IMAGE_OK && !is_started(reader, format, error)) {
        status = IMAGE_IO;
    }
    if (status != IMAGE_OK) {
        return status;
    }
    if (!pipe_put(reader->requests[1], &request, sizeof request) || !reader_take(reader, &reply, sizeof reply) ||
        !reply_is_sound(&reply)) {
        return fail_reader(reader, error);
    }
    reply_open(&reply, file, error);
    status = reply.status == IMAGE_OK ? picture_file_allocate(file, limit) : (ImageStatus)reply.status;
    if (status == IMAGE_OK && !reader_take(reader, file->samples, samples_bytes(file))) {
        status = fail_reader(reader, error);
        picture_file_fini(file);
    } else if (status != IMAGE_OK && reply.status == IMAGE_OK) {
        picture_reader_end(reader); // whose samples nobody takes
    }
    return status;
}
