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
    int part, parts; // the run is one of so many that have one bar; 0: it is alone
    int width; // of what was shown last
} Progress;

// The next run is a part of several, counted from 0, which have one bar.
void progress_share(Progress *progress, int part, int parts);
void progress_begin(Progress *progress, bool enabled);
// `note` is printed after the bar; may be NULL. `seconds_left` below 0: by what is done.
void progress_update(Progress *progress, double done, double seconds_left, const char *note);
void progress_end(Progress *progress); // wipes the bar

#endif
