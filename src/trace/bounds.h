// Boxes along the axes, in double: unions and common parts.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_BOUNDS_H
#define TRACE_BOUNDS_H

#include "math/vec3.h"

typedef struct Bounds {
    Vec3 low, high;
} Bounds;

#define BOUNDS_ALL                                                                                                     \
    ((Bounds){{-(double)INFINITY, -(double)INFINITY, -(double)INFINITY},                                               \
              {(double)INFINITY, (double)INFINITY, (double)INFINITY}})
#define BOUNDS_NONE                                                                                                    \
    ((Bounds){{(double)INFINITY, (double)INFINITY, (double)INFINITY},                                                  \
              {-(double)INFINITY, -(double)INFINITY, -(double)INFINITY}})

static inline Bounds bounds_join(Bounds a, Bounds b)
{
    return (Bounds){vec3(fmin(a.low.x, b.low.x), fmin(a.low.y, b.low.y), fmin(a.low.z, b.low.z)),
                    vec3(fmax(a.high.x, b.high.x), fmax(a.high.y, b.high.y), fmax(a.high.z, b.high.z))};
}

static inline Bounds bounds_meet(Bounds a, Bounds b)
{
    return (Bounds){vec3(fmax(a.low.x, b.low.x), fmax(a.low.y, b.low.y), fmax(a.low.z, b.low.z)),
                    vec3(fmin(a.high.x, b.high.x), fmin(a.high.y, b.high.y), fmin(a.high.z, b.high.z))};
}

static inline bool bounds_are_finite(Bounds b)
{
    return vec3_is_finite(b.low) && vec3_is_finite(b.high);
}

// What is not a number may be anywhere.
static inline bool bounds_are_empty(Bounds b)
{
    return b.low.x > b.high.x || b.low.y > b.high.y || b.low.z > b.high.z;
}

#endif
