// Rays against spheres, some at once, one of each: what trace/sphere.h is for one. Part of files that are compiled once
// for each instruction set.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERE_RAYS_H
#define TRACE_SPHERE_RAYS_H

#include "trace/double_words.h"
#include "trace/simd.h"
#include "trace/spheres.h"
#include "trace/vec3s.h"

typedef struct Balls {
    Vec3s centre;
    Doubles radius_squared;
} Balls;

typedef struct Rays {
    Vec3s origin, direction;
} Rays;

typedef struct SphereRays {
    Vec3s origin, direction, direction_over_length2;
    Doubles inverse_square;
} SphereRays;

#include "trace/lane_doubles.h"
#include "trace/sphere.inc"

// The same ray for all.
RT_ALWAYS_INLINE SphereRays sphere_rays_splat(const SphereRay *ray)
{
    return (SphereRays){vec3s_splat(ray->origin), vec3s_splat(ray->direction), vec3s_splat(ray->direction_over_length2),
                        doubles_splat(ray->inverse_square)};
}

// Some of a block.
RT_ALWAYS_INLINE Balls balls_load(const SphereBlock *block, uint32_t at)
{
    return (Balls){vec3s(doubles_load(&block->x[at]), doubles_load(&block->y[at]), doubles_load(&block->z[at])),
                   doubles_load(&block->radius_squared[at])};
}

// The spheres of shapes.
RT_ALWAYS_INLINE Balls balls_gather(const SphereTable *table, DoublesMask shapes)
{
    DoublesMask slot = shapes & ((INT64_C(1) << SHAPE_INDEX_BITS) - 1);
    DoublesMask bytes = slot / SPHERE_BLOCK * (int64_t)sizeof(SphereBlock) +
                        slot % SPHERE_BLOCK * (int64_t)sizeof(double);
    const SphereBlock *blocks = table->blocks;
    return (Balls){
        vec3s(doubles_gather(blocks->x, bytes), doubles_gather(blocks->y, bytes), doubles_gather(blocks->z, bytes)),
        doubles_gather(blocks->radius_squared, bytes)};
}

#endif
