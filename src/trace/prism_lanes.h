// Which of some rays come into a prism through one of its ends, and which pass it by: part of primitive_lanes.h.
//
// A ray is between the planes of the ends over a stretch, whose image in the outline's plane is a stretch, too. Where
// that begins inside of the outline, and no piece is near there, the ray comes in at the end; where it begins outside
// and comes to no piece, it passes. All others are left undecided: they are asked one by one.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_PRISM_LANES_H
#define TRACE_PRISM_LANES_H

#include "scene/outline.h"
#include "trace/prepared_primitive.h"
#include "trace/simd.h"

// The stretches in the outline's plane.
typedef struct PrismLanes {
    Doubles u, v;                         // where they begin
    Doubles low_u, low_v, high_u, high_v; // their boxes
    Doubles a, b, c;                      // the lines that they are on, as an OutlineLine has them
    Doubles from_u, from_v, by_u, by_v;   // the rays' images
    Doubles near;                         // t times the square of `by` up to which a crossing is near the beginning
    DoublesMask is_inside, is_near, crosses;
} PrismLanes;

// Rays whose stretch lies in the box with one of its ends or whose side of a piece in it counts for what is inside.
RT_ALWAYS_INLINE unsigned prism_lanes_asked(const PrismLanes *of, const double *box)
{
    const double *low = box + PIECE_LOW, *high = box + PIECE_HIGH;
    DoublesMask meets =
        (of->low_u <= high[0]) & (of->high_u >= low[0]) & (of->low_v <= high[1]) & (of->high_v >= low[1]);
    DoublesMask counts = (of->v <= high[1]) & (of->v > low[1]) & (of->u < high[0]);
    return doubles_mask_bits(meets | counts);
}

// What is inside, by the line along u, as outline_holds has it.
RT_ALWAYS_INLINE void prism_lanes_count(PrismLanes *of, const double *piece, const double *end)
{
    const double *low = piece + PIECE_LOW, *high = piece + PIECE_HIGH, *begin = piece + PIECE_POINTS;
    DoublesMask counts = (of->v <= high[1]) & (of->v > low[1]) & (of->u < high[0]), is_left = of->u < low[0];
    DoublesMask changes = (begin[1] < of->v) ^ (end[1] < of->v);
    of->is_inside ^= counts & is_left & changes;
    counts &= ~is_left;
    if (!doubles_mask_bits(counts)) {
        return;
    }
    if (piece[PIECE_DEGREE] > 1.0) {
        of->is_near |= counts;
        return;
    }
    Doubles first = begin[1] - of->v, last = end[1] - of->v;
    Doubles u = begin[0] + first / doubles_choose(changes, first - last, doubles_splat(1.0)) * (end[0] - begin[0]);
    double size = fabs(begin[0]) + fabs(end[0]);
    of->is_near |= counts & changes & (doubles_abs(u - of->u) <= 0x1p-30 * size);
    of->is_inside ^= counts & changes & (u > of->u);
}

// Whether stretches come to the piece: not where the form of their lines has one sign at its points, however rounded.
RT_ALWAYS_INLINE void prism_lanes_cross(PrismLanes *of, const double *piece, unsigned points)
{
    const double *low = piece + PIECE_LOW, *high = piece + PIECE_HIGH, *p = piece + PIECE_POINTS;
    DoublesMask meets =
        (of->low_u <= high[0]) & (of->high_u >= low[0]) & (of->low_v <= high[1]) & (of->high_v >= low[1]);
    if (!doubles_mask_bits(meets)) {
        return;
    }
    Doubles least = doubles_splat((double)INFINITY), most = -least, size = doubles_splat(0.0);
    for (unsigned i = 0; i < points; i++) {
        Doubles u = of->a * p[2 * i], v = of->c * p[2 * i + 1], form = u + v + of->b;
        least = doubles_min(least, form);
        most = doubles_max(most, form);
        size = doubles_max(size, doubles_abs(u) + doubles_abs(v) + doubles_abs(of->b));
    }
    meets &= ~((least > 0x1p-44 * size) | (most < -0x1p-44 * size));
    Doubles first = doubles_min((low[0] - of->from_u) * of->by_u, (high[0] - of->from_u) * of->by_u) +
                    doubles_min((low[1] - of->from_v) * of->by_v, (high[1] - of->from_v) * of->by_v);
    of->crosses |= meets;
    of->is_near |= meets & ~(first > of->near);
}

// From where the planes of the ends are met, enter < leave, both ahead; *misses: for certain. Returns those that come
// in where they enter.
static __attribute__((noinline)) unsigned prism_lanes_enter(const PreparedPrimitive *primitive, const Doubles *f,
                                                            const Doubles *d, Doubles enter, Doubles leave,
                                                            unsigned asked, unsigned *misses)
{
    const Numbers *list = &primitive->list;
    const Vec3 low = primitive->fixed[0], high = primitive->fixed[1];
    const uint32_t stride = outline_stride(list), pieces = outline_piece_count(list);
    const unsigned points = outline_degree(list) + 1;
    Doubles u = f[0] + enter * d[0], v = f[2] + enter * d[2], last_u = f[0] + leave * d[0],
            last_v = f[2] + leave * d[2];
    Doubles square = d[0] * d[0] + d[2] * d[2], room = 0x1p-28 * (doubles_abs(enter) + doubles_abs(leave));
    PrismLanes of = {
        .u = u,
        .v = v,
        .low_u = doubles_min(u, last_u),
        .low_v = doubles_min(v, last_v),
        .high_u = doubles_max(u, last_u),
        .high_v = doubles_max(v, last_v),
        .a = -d[2],
        .b = d[2] * f[0] - d[0] * f[2],
        .c = d[0],
        .from_u = f[0],
        .from_v = f[2],
        .by_u = d[0],
        .by_v = d[2],
        .near = (enter + room) * square + 0x1p-40 * (doubles_abs(f[0] * d[0]) + doubles_abs(f[2] * d[2])),
    };
    *misses = doubles_mask_bits((of.high_u < low.x) | (of.low_u > high.x) | (of.high_v < low.z) | (of.low_v > high.z));
    asked &= ~*misses;
    for (uint32_t i = 0; asked && i < pieces; i++) {
        const double *piece = outline_place(list, stride, i);
        if (i % OUTLINE_GROUP == 0 && !(asked & prism_lanes_asked(&of, piece - OUTLINE_BOX))) {
            i += OUTLINE_GROUP - 1;
            continue;
        }
        if (asked & prism_lanes_asked(&of, piece)) {
            prism_lanes_count(&of, piece, piece + stride - 2);
            prism_lanes_cross(&of, piece, points);
        }
    }
    DoublesMask is_told = ~of.is_near & (square > 0x1p-900) & (square < 0x1p900);
    *misses |= asked & doubles_mask_bits(is_told & ~of.is_inside & ~of.crosses);
    return asked & doubles_mask_bits(is_told & of.is_inside);
}

#endif
