// Some lines through a solid, as curve_lanes.h wants them: part of spheres_kernel.c.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_LINE_LANES_H
#define TRACE_LINE_LANES_H

#include "trace/simd.h"
#include "trace/prepared_primitive.h"

// By s: t = t_base + s step. All of the solid that a line may meet lies between `low` and `high`.
typedef struct LineLanes {
    Doubles t_base, step, start; // start: of the ray
    Doubles low, high;
    Doubles first, second; // where `bends`, the function is concave between these; elsewhere it is convex
    Doubles unit;          // far above what rounding moves s by
    double size;           // of the solid, about
    DoublesMask is_near, bends, is_certain;
} LineLanes;

// The function at a place, and what surely is more than it and its slope may be off.
typedef struct LinePlace {
    Doubles value, slope, room, slope_room;
    DoublesMask is_certain;
} LinePlace;

// What is known of some rays: those that may meet the solid ahead, those of which it is certain, and their first roots
// with n·d there, n being the gradient for gradient_most.
typedef struct CurveFirst {
    unsigned possible, certain;
    Doubles root, along;
} CurveFirst;

#endif
