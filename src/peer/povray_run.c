// One job to one POV-Ray process. Its switches: POV-Ray 3.7 manual, "Command-Line and INI-File Options".
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "peer/povray_run.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { FIXED_ARGUMENTS = 12, TAIL_BYTES = 400, START_TRIES = 5, STOP_MILLISECONDS = 20 };

typedef struct ArgumentList {
    char **items; // ends with NULL
    int count;
    bool failed; // out of memory
} ArgumentList;

static bool is_program(const char *path)
{
    struct stat status;

    return stat(path, &status) == 0 && S_ISREG(status.st_mode) && access(path, X_OK) == 0;
}

char *povray_find_program(const char *name)
{
    const char *search = getenv("PATH");
    char *found = NULL;

    if (strchr(name, '/')) {
        return is_program(name) ? realpath(name, NULL) : NULL;
    }
    while (search && !found) {
        int length = (int)strcspn(search, ":");
        char *path;

        if (asprintf(&path, "%.*s/%s", length > 0 ? length : 1, length > 0 ? search : ".", name) < 0) {
            return NULL;
        }
        found = is_program(path) ? realpath(path, NULL) : NULL;
        free(path);
        search = search[length] == ':' ? search + length + 1 : NULL;
    }
    return found;
}

bool povray_make_folder(char *path)
{
    const char *base = getenv("TMPDIR");
    char *made = NULL;
    bool fine = asprintf(&made, "%s/rtlang-XXXXXX", base && base[0] != '\0' ? base : "/tmp") >= 0 && mkdtemp(made) &&
                realpath(made, path);
    free(made);
    return fine;
}

__attribute__((format(printf, 2, 3))) static void argument_add(ArgumentList *list, const char *format, ...)
{
    va_list arguments;
    char *text;

    va_start(arguments, format);
    if (vasprintf(&text, format, arguments) < 0) {
        list->failed = true;
    } else {
        list->items[list->count++] = text;
    }
    va_end(arguments);
}

static void arguments_fini(ArgumentList *list)
{
    for (int i = 0; i < list->count; i++) {
        free(list->items[i]);
    }
    free(list->items);
}

// Paths are quoted: POV-Ray splits an argument at blanks.
static bool arguments_make(ArgumentList *list, const PovrayJob *job)
{
    const char *slash = strrchr(job->scene, '/');
    size_t switches = 0;

    while (job->switches && job->switches[switches]) {
        switches++;
    }
    *list = (ArgumentList){0};
    list->items = calloc((size_t)job->include_path_count + FIXED_ARGUMENTS + switches + 1, sizeof *list->items);
    if (!list->items) {
        return false;
    }
    argument_add(list, "%s", job->program);
    argument_add(list, "+I\"./%s\"", slash ? slash + 1 : job->scene);
    argument_add(list, "+O\"%s\"", job->output);
    argument_add(list, "+FN16");
    argument_add(list, "File_Gamma=1.0");
    argument_add(list, "-D");
    for (size_t i = 0; i < switches; i++) {
        argument_add(list, "%s", job->switches[i]);
    }
    if (!job->switches) {
        argument_add(list, "-A");
    }
    argument_add(list, "-P");
    argument_add(list, "+W%d", job->width);
    argument_add(list, "+H%d", job->height);
    if (job->threads > 0) {
        argument_add(list, "+WT%d", job->threads);
    }
    if (job->clock) {
        argument_add(list, "+K%.17g", *job->clock);
    }
    for (int i = 0; i < job->include_path_count; i++) {
        argument_add(list, "+L\"%s\"", job->include_paths[i]);
    }
    return !list->failed;
}

// The folder of the scene, to be freed.
static char *scene_folder(const char *scene)
{
    const char *slash = strrchr(scene, '/');

    return !slash ? strdup(".") : strndup(scene, (size_t)(slash - scene) + 1);
}

// 0, or an errno value.
static int process_start(const PovrayJob *job, char **arguments, const char *folder, pid_t *process)
{
    posix_spawn_file_actions_t actions;
    int code = posix_spawn_file_actions_init(&actions);

    if (code != 0) {
        return code;
    }
    code = posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (code == 0) {
        code = posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, job->log, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    }
    if (code == 0) {
        code = posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    }
    if (code == 0) {
        code = posix_spawn_file_actions_addchdir_np(&actions, folder);
    }
    if (code == 0) {
        code = posix_spawn(process, job->program, &actions, NULL, arguments, environ);
    }
    posix_spawn_file_actions_destroy(&actions);
    return code;
}

static double seconds_of(struct timeval time)
{
    return (double)time.tv_sec + 1e-6 * (double)time.tv_usec;
}

// Ends a process when its job is to be stopped. Whether it has ended, its status is there to be fetched.
static bool process_watch(pid_t process, const int *stop)
{
    struct pollfd word = {.fd = *stop, .events = POLLIN};
    siginfo_t end = {.si_pid = 0};

    if (poll(&word, 1, STOP_MILLISECONDS) > 0) {
        kill(process, SIGKILL);
        return true;
    }
    return waitid(P_PID, (id_t)process, &end, WEXITED | WNOHANG | WNOWAIT) != 0 || end.si_pid == process;
}

// Waits for the end; 0, or the exit status, or 128 and the signal's number, or -1 when that cannot be known.
static int process_wait(pid_t process, const int *stop, double *seconds)
{
    int status;
    struct rusage usage;

    while (stop && !process_watch(process, stop)) {
        continue;
    }
    while (wait4(process, &status, 0, &usage) < 0) {
        if (errno != EINTR) {
            return -1;
        }
    }
    if (seconds) {
        *seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// The end of the log from the beginning of a line.
static void log_tail(const char *path, char tail[static TAIL_BYTES])
{
    FILE *log = fopen(path, "rb");
    size_t length = 0;
    char *line;

    if (log) {
        if (fseek(log, 1 - TAIL_BYTES, SEEK_END) != 0) { // a shorter log
            rewind(log);
        }
        length = fread(tail, 1, TAIL_BYTES - 1, log);
        fclose(log);
    }
    tail[length] = '\0';
    line = length == TAIL_BYTES - 1 ? strchr(tail, '\n') : NULL;
    if (line) {
        memmove(tail, line + 1, strlen(line + 1) + 1);
    }
}

// On a machine that is busy, POV-Ray gives up before it begins: its threads have a time limit for their start.
static bool has_not_begun(const PovrayJob *job, int status)
{
    char tail[TAIL_BYTES];

    if (status == 0) {
        return false;
    }
    log_tail(job->log, tail);
    return strstr(tail, "Timed out waiting for worker thread startup") != NULL;
}

static bool outcome_judge(const PovrayJob *job, int status, char *detail, size_t detail_size)
{
    struct stat output;
    char tail[TAIL_BYTES];
    bool has_output = stat(job->output, &output) == 0 && output.st_size > 0;

    if (status == 0 && has_output) {
        return true;
    }
    log_tail(job->log, tail);
    if (status == 0) {
        snprintf(detail, detail_size, "povray made no picture:\n%s", tail);
    } else {
        snprintf(detail, detail_size, "povray ended with status %d:\n%s", status, tail);
    }
    return false;
}

bool povray_run(const PovrayJob *job, char *detail, size_t detail_size)
{
    ArgumentList arguments;
    char *folder = scene_folder(job->scene);
    bool fine = false;
    pid_t process;
    int code = 0;
    int status = -1;

    snprintf(detail, detail_size, "out of memory");
    if (arguments_make(&arguments, job) && folder) {
        for (int i = 0; i < START_TRIES; i++) {
            code = process_start(job, arguments.items, folder, &process);
            status = code == 0 ? process_wait(process, job->stop, job->process_seconds) : -1;
            if (code != 0 || !has_not_begun(job, status)) {
                break;
            }
        }
        if (code != 0) {
            snprintf(detail, detail_size, "povray cannot be started: %s", strerror(code));
        } else {
            fine = outcome_judge(job, status, detail, detail_size);
        }
    }
    arguments_fini(&arguments);
    free(folder);
    return fine;
}

// `povray --version` prints "POV-Ray 3.7.0.10.unofficial", perhaps below complaints about its configuration.
bool povray_version(const char *program, const char *log, char *text, size_t size)
{
    char *arguments[] = {(char[]){"povray"}, (char[]){"--version"}, NULL};
    PovrayJob job = {.program = program, .log = log};
    pid_t process;
    FILE *file = NULL;

    if (process_start(&job, arguments, ".", &process) == 0 && process_wait(process, NULL, NULL) == 0) {
        file = fopen(log, "rb");
    }
    bool is_read = false;
    while (file && !is_read && size > 0 && fgets(text, (int)size, file)) {
        is_read = strncmp(text, "POV-Ray ", strlen("POV-Ray ")) == 0;
    }
    if (file) {
        fclose(file);
    }
    unlink(log);
    if (is_read) {
        text[strcspn(text, "\r\n")] = '\0';
    }
    return is_read;
}

// "Pixels:     1300   Samples:    3852   Smpls/Pxl: 2.96", then "  Trace Time:       0 hours  0 minutes  1 seconds
// (1.234 seconds)" and below "using 1 thread(s) with 1.200 CPU-seconds total".
PovrayCost povray_cost(const char *log)
{
    FILE *file = fopen(log, "rb");
    char line[256];
    PovrayCost cost = {0.0, 0.0, 0.0};
    bool is_trace = false;

    while (file && fgets(line, sizeof line, file)) {
        const char *with = strstr(line, " with ");
        double pixels, samples;

        if (sscanf(line, "Pixels: %lf Samples: %lf", &pixels, &samples) == 2) {
            cost.rays = pixels + samples;
        }
        if (strstr(line, "Trace Time:")) {
            const char *wall = strchr(line, '(');
            is_trace = true;
            cost.wall = wall ? strtod(wall + 1, NULL) : 0.0;
        }
        if (is_trace && with && strstr(line, "CPU-seconds")) {
            cost.seconds = strtod(with + 6, NULL);
            break;
        }
    }
    if (file) {
        fclose(file);
    }
    return cost;
}
