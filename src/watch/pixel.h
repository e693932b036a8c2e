// The ray of a pixel: a session of its own that reports what the ray of a pixel meets while another one draws.
//
// SPDX-License-Identifier: MIT
#ifndef WATCH_PIXEL_H
#define WATCH_PIXEL_H

#include <pthread.h>
#include <stdint.h>

#include "base/text.h"
#include "watch/watch.h"

typedef struct Pixel {
    pthread_mutex_t lock;  // of a question
    pthread_mutex_t guard; // of what ends one
    bool is_over;
    const WatchJob *job;
    rt_session *session; // NULL: nobody has asked yet
    uint64_t save;       // that it has loaded
    rt_status status;
} Pixel;

void pixel_init(Pixel *pixel, const WatchJob *job);
void pixel_fini(Pixel *pixel);

// Ends a question, and all later ones.
void pixel_cancel(Pixel *pixel);

// The ray's log as a JSON object with `log`, of rtlang's own JSON, and `text`. False when the scene cannot be loaded or
// has no such pixel. The first question after a save loads the scene.
bool pixel_trace(Pixel *pixel, uint64_t save, int x, int y, TextBuffer *out) RT_MUST_CHECK;

#endif
