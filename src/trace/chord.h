// A chord: the part of a ray's line that lies inside a convex shape, and the sides of the shape at its ends.
//
// Sides are numbered by each shape. A ray that starts on a side and goes in has that side's own crossing left out, by
// identity: the chord then begins at minus infinity.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_CHORD_H
#define TRACE_CHORD_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/attributes.h"
#include "math/vec3.h"

enum { SIDE_NONE = 255 };

typedef struct Chord {
    double enter, leave; // may be infinite
    uint8_t enter_side, leave_side;
} Chord;

#define CHORD_ALL ((Chord){-(double)INFINITY, (double)INFINITY, SIDE_NONE, SIDE_NONE})

// Keeps what also lies in the other one. Where two sides are met at once, the one of `chord` counts.
RT_ALWAYS_INLINE void chord_meet(Chord *chord, const Chord *other)
{
    if (other->enter > chord->enter) {
        chord->enter = other->enter;
        chord->enter_side = other->enter_side;
    }
    if (other->leave < chord->leave) {
        chord->leave = other->leave;
        chord->leave_side = other->leave_side;
    }
}

// A coordinate of the line, o + t d, between two bounds, whose sides are `low_side` and low_side + 1. False when no
// part of the line is. A line along a bound is inside; NaN is not.
RT_ALWAYS_INLINE bool chord_slab(double o, double d, double low, double high, uint8_t low_side, uint8_t left_side,
                                 Chord *chord)
{
    if (d == 0.0) {
        *chord = CHORD_ALL;
        return low <= o && o <= high;
    }
    uint8_t high_side = (uint8_t)(low_side + 1);
    double t_low = left_side == low_side ? -copysign((double)INFINITY, d) : (low - o) / d;
    double t_high = left_side == high_side ? copysign((double)INFINITY, d) : (high - o) / d;
    *chord = d > 0.0 ? (Chord){t_low, t_high, low_side, high_side} : (Chord){t_high, t_low, high_side, low_side};
    return chord->enter <= chord->leave;
}

#endif
