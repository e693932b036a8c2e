// The painter: a process that runs POV-Ray on the scene on request, and hands back the picture.
//
// It is made before the kernel confines the program, which then may start nothing itself: over a pipe it can only say
// "now". It ends, and POV-Ray with it, when the program does, however that ends.
//
// SPDX-License-Identifier: MIT
#ifndef WATCH_PAINTER_H
#define WATCH_PAINTER_H

#include <pthread.h>
#include <stdbool.h>
#include <sys/types.h>

#include "watch/board.h"

typedef struct PainterJob {
    const char *scene;
    int width, height;
    const char *const *include_paths;
    int include_path_count;
    const char *const *declarations; // NAME=VALUE
    int declaration_count;
    const double *clock; // NULL: none is given
} PainterJob;

typedef struct Painter {
    pid_t process; // 0: POV-Ray is not installed
    int ask, hear; // the ends of pipes
    pthread_t thread;
    bool has_thread;
    Board *board;
} Painter;

// There is no process yet; the board says that POV-Ray is missing.
void painter_init(Painter *painter, Board *board);
// Makes the process, where POV-Ray is installed. To be called before there are threads.
void painter_open(Painter *painter, const PainterJob *job);
// Begins to listen to it.
void painter_start(Painter *painter);
// Has it draw the scene as it is now; with the board's lock.
void painter_ask(Painter *painter);
void painter_close(Painter *painter);

#endif
