// An interval: a part of a ray's line that lies inside a shape, and the sides of the shape at its ends. A line may have
// several of them in a shape that is not convex.
//
// Sides are numbered by each shape. A ray that starts on a side has that side's own crossing left out, by identity:
// where it goes in, the interval begins at minus infinity; where it goes out, an interval that ends at the start is
// left out.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_RAY_INTERVAL_H
#define TRACE_RAY_INTERVAL_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/attributes.h"
#include "math/ray.h"
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

// Two bounds of a coordinate, and the sides there: `low_side` and the next one.
typedef struct Slab {
    double low, high;
    uint8_t low_side;
} Slab;

#include "math/lane_double.h"
#include "trace/interval.inc"

// The part of the line that is between the bounds in a coordinate, o + t d. False when none is. A line along a bound is
// inside; NaN is not.
RT_ALWAYS_INLINE bool interval_slab(double o, double d, Slab slab, uint8_t left_side, RayInterval *interval)
{
    if (d == 0.0) {
        *interval = INTERVAL_ALL;
        return slab.low <= o && o <= slab.high;
    }
    *interval = interval_between(o, d, slab);
    if (left_side == interval->enter_side) {
        interval->enter = -(double)INFINITY;
    } else if (left_side == interval->leave_side) {
        interval->leave = (double)INFINITY;
    }
    return interval->enter <= interval->leave;
}

// ---- intervals found from one crossing of the line to the next

typedef struct IntervalWalk {
    RayInterval *intervals, open; // `open` is INTERVAL_ALL at the beginning
    unsigned count;
    bool is_inside;
} IntervalWalk;

static inline void interval_walk_cross(IntervalWalk *walk, double t, uint8_t side)
{
    if (walk->is_inside) {
        walk->open.leave = t;
        walk->open.leave_side = side;
        walk->intervals[walk->count++] = walk->open;
    } else {
        walk->open.enter = t;
        walk->open.enter_side = side;
    }
    walk->is_inside = !walk->is_inside;
}

// The line stays inside as far as anybody asks.
static inline void interval_walk_stay(IntervalWalk *walk)
{
    walk->open.leave = (double)INFINITY;
    walk->open.leave_side = SIDE_NONE;
    walk->intervals[walk->count++] = walk->open;
}

// Where a line is in a ball about 0: middle - half to middle + half; false where it is not.
static inline bool ball_line(const Ray *ray, double radius, double *middle, double *half)
{
    double square = vec3_length_squared(ray->direction), at = -vec3_dot(ray->origin, ray->direction) / square;
    double depth = radius * radius - vec3_length_squared(vec3_add_scaled(ray->origin, at, ray->direction));
    *middle = at;
    *half = sqrt(depth / square);
    return depth >= 0.0 && square > 0.0;
}

#endif
