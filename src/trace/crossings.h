// Crossings of a line and a surface that closes a space: in any order, then in that of the line, then intervals.
//
// There is an even number of them, so that the line is outside before the first and behind the last. A ray that starts
// on the surface leaves out its own crossing, by their number.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_CROSSINGS_H
#define TRACE_CROSSINGS_H

#include <stdlib.h>

#include "trace/ray_interval.h"

enum { CROSSINGS_SHORT = 32 };

typedef struct Crossing {
    double t;
    uint8_t side;
} Crossing;

static int crossings_order(const void *a, const void *b)
{
    double x = ((const Crossing *)a)->t, y = ((const Crossing *)b)->t;
    return (x > y) - (x < y);
}

static inline void crossings_sort(Crossing *crossings, uint32_t count)
{
    if (count > CROSSINGS_SHORT) {
        qsort(crossings, count, sizeof *crossings, crossings_order);
        return;
    }
    for (uint32_t i = 1; i < count; i++) {
        Crossing own = crossings[i];
        uint32_t at = i;
        for (; at > 0 && crossings[at - 1].t > own.t; at--) {
            crossings[at] = crossings[at - 1];
        }
        crossings[at] = own;
    }
}

// The first crossing behind a start on the surface; `inward`: the ray is inside from there on. How many crossings lie
// behind the start says whether its own is among them, which then is the first. `is_inside_end`: the line is inside
// behind the last.
static inline uint32_t crossings_first_behind(const Crossing *crossings, uint32_t count, bool is_inside_end,
                                              bool *inward)
{
    uint32_t first = 0;
    while (first < count && !(crossings[first].t > 0.0)) {
        first++;
    }
    bool is_odd = (count - first) & 1;
    if (is_odd != (*inward != is_inside_end)) {
        if (first < count) {
            first++;
        } else {
            *inward = is_inside_end;
        }
    }
    return first;
}

// Puts them in order; count / 2 + 1 intervals at most. Returns how many.
static inline unsigned crossings_intervals(Crossing *crossings, uint32_t count, SideLeft left, RayInterval *intervals)
{
    bool is_start = left.side != SIDE_NONE;
    IntervalWalk walk = {.intervals = intervals, .open = INTERVAL_ALL, .is_inside = is_start && left.inward};
    crossings_sort(crossings, count);
    for (uint32_t i = is_start ? crossings_first_behind(crossings, count, false, &walk.is_inside) : 0; i < count; i++) {
        interval_walk_cross(&walk, crossings[i].t, crossings[i].side);
    }
    return walk.count;
}

#endif
