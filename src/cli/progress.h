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
} Progress;

void progress_begin(Progress *progress, bool enabled);
void progress_update(Progress *progress, double done);
void progress_end(Progress *progress); // wipes the bar

#endif
