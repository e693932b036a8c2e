// Draws a bar on stderr, at most ten times a second and only after the first second.
//
// SPDX-License-Identifier: MIT
#include "cli/progress.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"

void progress_begin(Progress *progress, bool enabled)
{
    bool continues = progress->parts > 0 && progress->start > 0.0;
    *progress = (Progress){.enabled = enabled && isatty(STDERR_FILENO),
                           .start = continues ? progress->start : clock_seconds(),
                           .part = progress->part,
                           .parts = progress->parts};
}

void progress_share(Progress *progress, int part, int parts)
{
    progress->start = part > 0 && parts == progress->parts ? progress->start : 0.0;
    progress->part = part;
    progress->parts = parts;
}

void progress_update(Progress *progress, double done, double seconds_left, const char *note)
{
    enum { WIDTH = 40 };
    double now = clock_seconds(), elapsed = now - progress->start;
    if (!progress->enabled || elapsed < 1.0 || now - progress->last < 0.1 || done <= 0.0) {
        return;
    }
    progress->last = now;
    progress->shown = true;
    if (progress->parts > 0) {
        done = (progress->part + done) / progress->parts;
        seconds_left = -1.0;
    }
    char bar[WIDTH + 1];
    int filled = (int)(done * WIDTH);
    memset(bar, ' ', WIDTH);
    memset(bar, '#', (size_t)(filled < WIDTH ? filled : WIDTH));
    bar[WIDTH] = '\0';
    double left = seconds_left >= 0.0 ? seconds_left : elapsed * (1.0 - done) / done;
    int width = fprintf(stderr, "\r[%s] %3.0f %%  %.0f s left  %s", bar, 100.0 * done, left, note ? note : "");
    fprintf(stderr, "%*s", progress->width > width ? progress->width - width : 0, "");
    progress->width = width;
}

void progress_end(Progress *progress)
{
    if (progress->shown) {
        fprintf(stderr, "\r%*s\r", progress->width, "");
    }
    progress->shown = false;
}
