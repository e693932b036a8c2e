// Watching a scene that is being written: a page that draws again at each save.
//
// Turns a scene's file into a page on the loopback address, by a server library in a module (http_module.h). Three
// calls, so that the kernel can confine the program between the first, which opens socket, module and pipes, and the
// second, which reads the scene. Knows nothing of the command line.
//
// SPDX-License-Identifier: MIT
#ifndef WATCH_WATCH_H
#define WATCH_WATCH_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/attributes.h"
#include "rtlang/rtlang.h"

typedef struct WatchJob {
    const char *scene;
    int width, height;
    int threads;          // as of rt_render
    rt_sampling sampling; // sampler, filter, seed, goals and most samples; without goals there are some
    rt_status (*configure)(rt_session *session, const void *client); // what holds for all readings of the scene
    const void *client;
    const volatile sig_atomic_t *interrupted_by; // not 0: it is to end
    bool has_no_peer;                            // POV-Ray is not to be run
    // For POV-Ray.
    const char *const *include_paths;
    int include_path_count;
    const char *const *declarations;
    int declaration_count;
    const double *clock;
} WatchJob;

typedef struct Watch Watch;

enum { WATCH_ADDRESS = 80 };

// Opens what the kernel may forbid later; makes no thread. NULL when it cannot be, and `why` says why.
Watch *watch_open(const WatchJob *job, char *why, size_t size) RT_MUST_CHECK;
// "http://127.0.0.1:PORT/TOKEN/"
const char *watch_address(const Watch *watch);
// Draws and serves until it is interrupted. False when it could not begin.
bool watch_run(Watch *watch) RT_MUST_CHECK;
void watch_close(Watch *watch);

#endif
