// An interval: a part of a ray's line that lies inside a shape, and the sides of the shape at its ends. A line may have
// several of them in a shape that is not convex.
//
// Sides are numbered by each shape. A ray that starts on a side has that side's own crossing left out, by identity: where
// it goes in, the interval begins at minus infinity; where it goes out, an interval that ends at the start is left out.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_RAY_INTERVAL_H
#define TRACE_RAY_INTERVAL_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/attributes.h"
#include "math/vec3.h"

enum { SIDE_NONE = 255, SIDES_MOST = 8 };

// The side of a shape that a ray starts on, and whether it goes into the shape there.
typedef struct SideLeft {
    uint8_t side; // SIDE_NONE: it does not start on the shape
    bool inward;
} SideLeft;

#define LEFT_NONE ((SideLeft){SIDE_NONE, false})

typedef struct RayInterval {
    double enter, leave; // may be infinite
    uint8_t enter_side, leave_side;
} RayInterval;

#define INTERVAL_ALL ((RayInterval){-(double)INFINITY, (double)INFINITY, SIDE_NONE, SIDE_NONE})

// Keeps what also lies in the other one. Where two sides are met at once, the one of `interval` counts.
RT_ALWAYS_INLINE void interval_meet(RayInterval *interval, const RayInterval *other)
{
    if (other->enter > interval->enter) {
        interval->enter = other->enter;
        interval->enter_side = other->enter_side;
    }
    if (other->leave < interval->leave) {
        interval->leave = other->leave;
        interval->leave_side = other->leave_side;
    }
}

// A coordinate of the line, o + t d, between two bounds, whose sides are `low_side` and low_side + 1. False when no
// part of the line is. A line along a bound is inside; NaN is not.
RT_ALWAYS_INLINE bool interval_slab(double o, double d, double low, double high, uint8_t low_side, uint8_t left_side,
                                    RayInterval *interval)
{
    if (d == 0.0) {
        *interval = INTERVAL_ALL;
        return low <= o && o <= high;
    }
    uint8_t high_side = (uint8_t)(low_side + 1);
    double t_low = left_side == low_side ? -copysign((double)INFINITY, d) : (low - o) / d;
    double t_high = left_side == high_side ? copysign((double)INFINITY, d) : (high - o) / d;
    *interval =
        d > 0.0 ? (RayInterval){t_low, t_high, low_side, high_side} : (RayInterval){t_high, t_low, high_side, low_side};
    return interval->enter <= interval->leave;
}

#endif
