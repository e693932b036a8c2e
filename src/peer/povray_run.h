// Finding POV-Ray and running it on one scene: linear 16 bit unless switches say otherwise, no shell, no window.
//
// SPDX-License-Identifier: MIT
#ifndef PEER_POVRAY_RUN_H
#define PEER_POVRAY_RUN_H

#include <stdbool.h>
#include <stddef.h>

// All paths but the scene's are absolute: POV-Ray runs in the scene's folder, so that its relative includes are found.
typedef struct PovrayJob {
    const char *program;
    const char *scene;
    const char *output; // picture to be made
    const char *log;    // file for what POV-Ray says
    char *const *include_paths;
    int include_path_count;
    int width, height;
    const double *clock; // NULL: none is given
    int threads; // 0: as many as the machine has
    const char *const *switches; // more of them, ends with NULL; NULL: no anti-aliasing
    double *process_seconds;     // of the processor, the whole process; NULL: not asked for
    const int *stop; // a file: when there is something to be read, or its writer has gone, the run is ended; NULL: none
} PovrayJob;

// The absolute path of a program as a shell would find it, to be freed; NULL: there is none.
char *povray_find_program(const char *name);

// Makes a folder of the caller's own for pictures and logs, where temporary files belong. `path` receives its absolute
// path, of up to PATH_MAX bytes. False when it could not be made; errno says why.
bool povray_make_folder(char *path);

// Runs and waits. False when POV-Ray failed or left no picture; `detail` then says why, in a few lines.
bool povray_run(const PovrayJob *job, char *detail, size_t detail_size);

// The version that POV-Ray tells of itself. `log` is the path of a file that may be written and removed. False when it
// tells none.
bool povray_version(const char *program, const char *log, char *text, size_t size);

// What a run took, by its log; 0 where that does not tell.
typedef struct PovrayCost {
    double seconds; // of the processor, tracing
    double wall;    // by the clock, tracing
    double rays;    // from the camera
} PovrayCost;

PovrayCost povray_cost(const char *log);

#endif
