// Rough roots made right, some at once: part of spheres_kernel.c.
//
// Operations and their order are those of sphere_refine, so the bits are the same.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERES_REFINE_H
#define TRACE_SPHERES_REFINE_H

#include "trace/double_words.h"
#include "trace/simd.h"
#include "trace/spheres.h"

typedef struct Balls {
    Doubles centre[3], radius_squared;
} Balls;

// The spheres of shapes.
RT_ALWAYS_INLINE Balls balls_gather(const SphereTable *table, DoublesMask shapes)
{
    DoublesMask slot = shapes & ((INT64_C(1) << SHAPE_INDEX_BITS) - 1);
    DoublesMask bytes = slot / SPHERE_BLOCK * (int64_t)sizeof(SphereBlock) +
                        slot % SPHERE_BLOCK * (int64_t)sizeof(double);
    const SphereBlock *blocks = table->blocks;
    return (Balls){{doubles_gather(blocks->x, bytes), doubles_gather(blocks->y, bytes), doubles_gather(blocks->z, bytes)},
                   doubles_gather(blocks->radius_squared, bytes)};
}

// Of one ray and one sphere each. Returns those for which it is certain.
RT_ALWAYS_INLINE unsigned roots_refine(const Doubles origin[3], const Doubles direction[3], Doubles inverse_square,
                                       const Balls *ball, Doubles *t)
{
    Doubles root = *t;
    Doubles f_squared = doubles_splat(0.0);
    Doubles slope = doubles_splat(0.0);
    Doubles low = doubles_splat(0.0);
    DoubleWords square[3];
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        DoubleWords f = two_sums(origin[i], -ball->centre[i]);
        DoubleWords along = two_products(root, direction[i]);
        DoubleWords p = two_sums(f.hi, along.hi);
        square[i] = two_products(p.hi, p.hi);
        low += square[i].lo + 2.0 * p.hi * (p.lo + (f.lo + along.lo));
        slope += p.hi * direction[i];
        f_squared += f.hi * f.hi;
    }
    Doubles radius = doubles_sqrt(ball->radius_squared);
    DoubleWords r = two_products(radius, radius);
    DoubleWords xy = two_sums(square[0].hi, square[1].hi);
    DoubleWords xyz = two_sums(xy.hi, square[2].hi);
    DoubleWords all = two_sums(xyz.hi, -r.hi);
    Doubles residual = all.hi + (all.lo + (xyz.lo + (xy.lo + (low - r.lo))));
    Doubles step = residual / (2.0 * slope);
    Doubles reach = 2.0 * root * doubles_abs(slope);
    Doubles sum = f_squared + ball->radius_squared;
    *t = root - step;
    return ~doubles_ge(sum, doubles_splat(0x1p900)) & ~doubles_ge(doubles_splat(0x1p-900), sum) &
           doubles_ge(reach, 0x1p-46 * sum) & doubles_ge(reach * inverse_square, step * step * 0x1p56);
}

#endif
