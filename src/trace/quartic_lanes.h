// What a closed surface of order 4 is along some rays, in its own space: part of curve_lanes.h.
//
// Along a line it is a polynomial of degree 4 whose leading coefficient is above 0: convex, concave between the roots
// of its second derivative, and convex again. Its coefficients are those of polynomial.c and as good; within the box of
// the surface all that rounding does has one bound.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_QUARTIC_LANES_H
#define TRACE_QUARTIC_LANES_H

#include "trace/line_lanes.h"

#define LINE_REAL Doubles
#include "trace/polynomial_line.h"

typedef struct QuarticLanes {
    Doubles terms[5];
    Doubles base, along; // the greatest coordinates of the line's base and direction
    Doubles moved;       // how far the base may be off
    Doubles room, slope_room;
    const double *sizes;
} QuarticLanes;

// 40 u, by which a term may be off as a share of its size: what polynomial.c has for degree 4.
#define QUARTIC_ROUNDING (40.0 * 0x1p-53)

// Sums of terms' sizes at a greatest coordinate, and their first two derivatives.
RT_ALWAYS_INLINE void quartic_sizes(const double *sizes, Doubles r, Doubles sums[3])
{
    sums[0] = (((sizes[4] * r + sizes[3]) * r + sizes[2]) * r + sizes[1]) * r + sizes[0];
    sums[1] = ((4.0 * sizes[4] * r + 3.0 * sizes[3]) * r + 2.0 * sizes[2]) * r + sizes[1];
    sums[2] = (12.0 * sizes[4] * r + 6.0 * sizes[3]) * r + 2.0 * sizes[2];
}

// One over the greatest powers of two within numbers above 0.
RT_ALWAYS_INLINE Doubles doubles_inverse_power(Doubles a)
{
    const int64_t exponent = INT64_C(0x7ff) << 52, both = INT64_C(2046) << 52;
    return (Doubles)(both - ((DoublesMask)a & exponent));
}

// Where the lines are in the box.
RT_ALWAYS_INLINE void quartic_lanes_near(const PreparedPrimitive *primitive, const Doubles base[3],
                                         const Doubles along[3], LineLanes *line)
{
    const double *from = &primitive->fixed[0].x, *to = &primitive->fixed[1].x;
    line->low = doubles_splat(-(double)INFINITY);
    line->high = doubles_splat((double)INFINITY);
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
        Doubles size = doubles_abs(along[axis]);
        Doubles inverse = 1.0 / doubles_choose(size > 0x1p-60, along[axis], doubles_splat(0x1p-60));
        Doubles first = (from[axis] - base[axis]) * inverse, second = (to[axis] - base[axis]) * inverse;
        line->low = doubles_max(line->low, doubles_min(first, second));
        line->high = doubles_min(line->high, doubles_max(first, second));
    }
    line->is_near = line->low < line->high;
}

// `starts`: all start on the surface, so that their last coefficient is 0.
RT_ALWAYS_INLINE void quartic_lanes_set(const PreparedPrimitive *primitive, bool starts, const Doubles f[3],
                                        const Doubles d[3], QuarticLanes *quartic, LineLanes *line)
{
    const Doubles zero = doubles_splat(0.0);
    const double *list = primitive->list.items;
    Doubles square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], base[3], along[3], *c = quartic->terms;
    Doubles far = doubles_max(doubles_max(doubles_abs(f[0]), doubles_abs(f[1])), doubles_abs(f[2]));
    line->t_base = starts ? zero : -(f[0] * d[0] + f[1] * d[1] + f[2] * d[2]) / square;
    line->step =
        doubles_inverse_power(doubles_max(doubles_max(doubles_abs(d[0]), doubles_abs(d[1])), doubles_abs(d[2])));
    for (int axis = 0; axis < 3; axis++) {
        base[axis] = f[axis] + line->t_base * d[axis];
        along[axis] = line->step * d[axis];
    }
    quartic->sizes = polynomial_sizes(list);
    quartic->base = doubles_max(doubles_max(doubles_abs(base[0]), doubles_abs(base[1])), doubles_abs(base[2]));
    quartic->along = doubles_max(doubles_max(doubles_abs(along[0]), doubles_abs(along[1])), doubles_abs(along[2]));
    quartic->moved = starts ? zero : 0x1p-52 * (far + quartic->base);
    quartic_lanes_near(primitive, base, along, line);
    line->start = -line->t_base / line->step;
    line->unit = 0x1p-40 * (far + quartic->base);
    // A line's point nearest to 0 is no farther from it than any of the box: no coordinate of the sum of both parts of
    // a place is greater than five times those of the box.
    Doubles sums[3];
    line->size = greater_of(vec3_max_abs(primitive->fixed[0]), vec3_max_abs(primitive->fixed[1]));
    quartic_sizes(quartic->sizes, doubles_splat(5.5 * line->size), sums);
    quartic->room = 2.0 * (QUARTIC_ROUNDING * sums[0] + quartic->moved * sums[1]);
    quartic->slope_room = 2.0 * quartic->along * (QUARTIC_ROUNDING * sums[1] + quartic->moved * sums[2]);
    line->is_certain = (square > 0x1p-900) & (square < 0x1p900) & (quartic->room < 0x1p900);
    if (!doubles_mask_bits(line->is_near | ~line->is_certain)) {
        return;
    }
    Doubles whole[LINE_TERMS_MOST];
    compose_of(list, base, along, 4, false, whole);
    for (int i = 0; i < 5; i++) {
        c[i] = whole[i];
    }
    c[0] = starts ? zero : c[0];
    Doubles third = 3.0 * c[3], half = -0.5 * third, inner = half * half - 6.0 * c[4] * c[2];
    line->bends = inner > 0.0;
    Doubles root = doubles_sqrt(doubles_choose(line->bends, inner, zero));
    line->first = (half - root) / (6.0 * c[4]);
    line->second = (half + root) / (6.0 * c[4]);
    line->is_certain &= c[4] > 0.0;
}

RT_ALWAYS_INLINE LinePlace quartic_lanes_at(const QuarticLanes *quartic, Doubles s)
{
    const Doubles *c = quartic->terms;
    return (LinePlace){.value = (((c[4] * s + c[3]) * s + c[2]) * s + c[1]) * s + c[0],
                       .slope = ((4.0 * c[4] * s + 3.0 * c[3]) * s + 2.0 * c[2]) * s + c[1],
                       .room = quartic->room,
                       .slope_room = quartic->slope_room,
                       .is_certain = ~(DoublesMask){0}};
}

// Two steps more. Returns where what rounding of the terms moves the root by is as little as polynomial.c wants it.
RT_ALWAYS_INLINE DoublesMask quartic_lanes_refine(const QuarticLanes *quartic, const LineLanes *line,
                                                  const Doubles f[3], Doubles s, Doubles *root, Doubles *along)
{
    const Doubles *c = quartic->terms;
    LinePlace place = quartic_lanes_at(quartic, s);
    Doubles change = place.value / place.slope, bend = (6.0 * c[4] * s + 3.0 * c[3]) * s + c[2], sums[3];
    DoublesMask is_single = doubles_abs(bend * change) < 0x1p-10 * doubles_abs(place.slope);
    s -= change;
    DoublesMask is_near = doubles_abs(change) < 0x1p-30 * (doubles_abs(s) + quartic->base);
    place = quartic_lanes_at(quartic, s);
    s -= place.value / place.slope;
    quartic_sizes(quartic->sizes, quartic->base + quartic->along * doubles_abs(s), sums);
    Doubles error = QUARTIC_ROUNDING * sums[0] + quartic->moved * sums[1];
    Doubles far = doubles_max(doubles_max(doubles_abs(f[0]), doubles_abs(f[1])), doubles_abs(f[2]));
    *root = line->t_base + s * line->step;
    *along = doubles_abs(place.slope) / line->step;
    return is_single & is_near & (error <= 0x1p-44 * (far + doubles_abs(s)) * doubles_abs(place.slope));
}

#endif
