// Finding POV-Ray and running it on one scene: linear 16 bit, no shell, no window.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_POVRAY_RUN_H
#define CHECK_POVRAY_RUN_H

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
} PovrayJob;

// The absolute path of a program as a shell would find it, to be freed; NULL: there is none.
char *povray_find(const char *name);

// Runs and waits. False when POV-Ray failed or left no picture; `detail` then says why, in a few lines.
bool povray_run(const PovrayJob *job, char *detail, size_t detail_size);

// Processor seconds that a finished run says it traced for; 0 when it does not say.
double povray_trace_seconds(const char *log);

#endif
