// Seconds of a clock that only goes forward, for measuring how long something takes.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_CLOCK_H
#define BASE_CLOCK_H

#include <time.h>

static inline double clock_seconds_of(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static inline double clock_seconds(void)
{
    return clock_seconds_of(CLOCK_MONOTONIC);
}

#endif
