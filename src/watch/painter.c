// Two pipes: a byte asks for a picture, and a head with so many bytes answers.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "watch/painter.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "peer/povray_run.h"

enum { DETAIL_SIZE = 1024, SWITCHES_FIXED = 5 };

typedef struct AnswerHead {
    bool is_picture; // else what went wrong, as text
    double seconds;
    size_t length;
} AnswerHead;

// ---- whole reads and writes of a pipe

static bool read_all(int file, void *bytes, size_t length)
{
    for (size_t had = 0; had < length;) {
        ssize_t got = read(file, (char *)bytes + had, length - had);
        if (got == 0 || (got < 0 && errno != EINTR)) {
            return false;
        }
        had += got > 0 ? (size_t)got : 0;
    }
    return true;
}

static bool write_all(int file, const void *bytes, size_t length)
{
    for (size_t had = 0; had < length;) {
        ssize_t put = write(file, (const char *)bytes + had, length - had);
        if (put < 0 && errno != EINTR) {
            return false;
        }
        had += put > 0 ? (size_t)put : 0;
    }
    return true;
}

// ---- the process

typedef struct Paint {
    PovrayJob job;
    char folder[PATH_MAX]; // where pictures are made
    int asked, answers;
} Paint;

static bool send_answer(const Paint *paint, bool is_picture, double seconds, const void *bytes, size_t length)
{
    AnswerHead head = {is_picture, seconds, length};
    return write_all(paint->answers, &head, sizeof head) && write_all(paint->answers, bytes, length);
}

// The picture of the last run.
static bool send_picture(const Paint *paint, double seconds)
{
    struct stat status;
    FILE *file = fopen(paint->job.output, "rbe");
    size_t length = file && fstat(fileno(file), &status) == 0 ? (size_t)status.st_size : 0;
    char *bytes = length > 0 ? malloc(length) : NULL;
    bool is_read = bytes && fread(bytes, 1, length, file) == length;
    static const char fault[] = "povray's picture cannot be read";
    bool fine = is_read ? send_answer(paint, true, seconds, bytes, length)
                        : send_answer(paint, false, seconds, fault, strlen(fault));
    free(bytes);
    if (file) {
        fclose(file);
    }
    return fine;
}

// A picture for each request; a later question ends an earlier one's run, and so does the program's end.
static void paint_until_end(Paint *paint)
{
    char questions[64], detail[DETAIL_SIZE];
    bool fine = true;
    while (fine && read(paint->asked, questions, sizeof questions) > 0) {
        double begun = clock_seconds();
        bool is_drawn = povray_run(&paint->job, detail, sizeof detail);
        double seconds = clock_seconds() - begun;
        if (!is_drawn && poll(&(struct pollfd){.fd = paint->asked, .events = POLLIN}, 1, 0) > 0) {
            continue; // that ended it
        }
        fine = is_drawn ? send_picture(paint, seconds) : send_answer(paint, false, seconds, detail, strlen(detail));
    }
}

// With anti-aliasing, as rtlang's picture is smooth, too.
static const char **make_switches(const PainterJob *job, char ***owned)
{
    static const char *const fixed[SWITCHES_FIXED] = {"+FN8", "File_Gamma=srgb", "+AM2", "+A0.05", "+R3"};
    size_t count = SWITCHES_FIXED + (size_t)job->declaration_count;
    const char **switches = calloc(count + 1, sizeof *switches);
    char **made = calloc((size_t)job->declaration_count + 1, sizeof *made);
    bool fine = switches && made;
    for (size_t i = 0; fine && i < count; i++) {
        size_t k = i - SWITCHES_FIXED;
        fine = i < SWITCHES_FIXED || asprintf(&made[k], "Declare=%s", job->declarations[k]) > 0;
        switches[i] = i < SWITCHES_FIXED ? fixed[i] : made[k];
    }
    *owned = made;
    return fine ? switches : NULL;
}

// The process from its beginning to its end.
static void paint(const PainterJob *job, const char *program, int asked, int answers)
{
    Paint work = {.asked = asked, .answers = answers};
    char output[PATH_MAX + 16], log[PATH_MAX + 16], **owned;
    const char **switches = make_switches(job, &owned);
    // An interrupt from the terminal is the program's to hear, which then goes away.
    signal(SIGINT, SIG_IGN);
    signal(SIGTERM, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
    if (!switches || !povray_make_folder(work.folder)) {
        return;
    }
    snprintf(output, sizeof output, "%s/p.png", work.folder);
    snprintf(log, sizeof log, "%s/log", work.folder);
    work.job = (PovrayJob){.program = program,
                           .scene = job->scene,
                           .output = output,
                           .log = log,
                           .include_paths = (char *const *)job->include_paths,
                           .include_path_count = job->include_path_count,
                           .width = job->width,
                           .height = job->height,
                           .clock = job->clock,
                           .switches = switches,
                           .stop = &work.asked};
    paint_until_end(&work);
    (void)remove(output);
    (void)remove(log);
    (void)rmdir(work.folder);
}

void painter_init(Painter *painter, Board *board)
{
    *painter = (Painter){.ask = -1, .hear = -1, .board = board};
    board->peer_state = PEER_MISSING;
}

void painter_open(Painter *painter, const PainterJob *job)
{
    int asked[2] = {-1, -1}, answers[2] = {-1, -1};
    char *program = povray_find_program("povray");
    if (!program || pipe2(asked, O_CLOEXEC) != 0 || pipe2(answers, O_CLOEXEC) != 0 || (painter->process = fork()) < 0) {
        painter->process = 0;
    } else if (painter->process == 0) {
        close(asked[1]);
        close(answers[0]);
        paint(job, program, asked[0], answers[1]);
        _exit(0);
    } else {
        painter->board->peer_state = PEER_IDLE;
        painter->ask = asked[1];
        painter->hear = answers[0];
        asked[1] = answers[0] = -1;
    }
    for (int i = 0; i < 2; i++) {
        close(asked[i]);
        close(answers[i]);
    }
    free(program);
}

// ---- in the program

static void *listen_to(void *client)
{
    Painter *painter = client;
    Board *board = painter->board;
    AnswerHead head;
    while (read_all(painter->hear, &head, sizeof head)) {
        char *bytes = malloc(head.length + 1);
        if (!bytes || !read_all(painter->hear, bytes, head.length)) {
            free(bytes);
            break;
        }
        board_lock(board);
        board->peer_seconds = head.seconds;
        if (head.is_picture &&
            board_set_picture(&board->peer, (const unsigned char *)bytes, head.length, board->peer_asked)) {
            board->peer_state = PEER_DONE;
        } else if (!head.is_picture) {
            text_clear(&board->peer_fault);
            text_append_n(&board->peer_fault, bytes, head.length);
            board->peer_state = PEER_FAULT;
        }
        board_change(board);
        free(bytes);
    }
    board_lock(board);
    board->peer_state = PEER_MISSING; // the process has ended: nothing can be asked of it
    board_change(board);
    return NULL;
}

void painter_start(Painter *painter)
{
    painter->has_thread = painter->process > 0 && pthread_create(&painter->thread, NULL, listen_to, painter) == 0;
}

void painter_ask(Painter *painter)
{
    Board *board = painter->board;
    if (painter->has_thread && write_all(painter->ask, "n", 1)) {
        board->peer_state = PEER_DRAWING;
        board->peer_asked = board->save;
    }
}

void painter_close(Painter *painter)
{
    close(painter->ask);
    if (painter->has_thread) {
        pthread_join(painter->thread, NULL); // its pipe ends with the process
    }
    close(painter->hear);
    if (painter->process > 0) {
        waitpid(painter->process, NULL, 0);
    }
}
