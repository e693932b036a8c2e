// The progress bar: part done and time left, on a terminal only, for runs longer than a second.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_PROGRESS_H
#define CLI_PROGRESS_H

#include <stdbool.h>

typedef struct Progress {
    bool enabled;
    bool shown; // a bar stands on the line
    double start, last;
    int width; // of what was shown last
} Progress;

void progress_begin(Progress *progress, bool enabled);
// `note` is told behind the bar; may be NULL. `seconds_left` below 0: by what is done.
void progress_update(Progress *progress, double done, double seconds_left, const char *note);
void progress_end(Progress *progress); // wipes the bar

#endif
