// Points and normals of what a tile's rays have met, some at once: part of spheres_kernel.c.
//
// Operations and their order are those of geometry_surface for spheres, so the bits are the same.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERES_SURFACE_H
#define TRACE_SPHERES_SURFACE_H

#include "trace/simd.h"
#include "trace/spheres.h"

// Of rays from one point, `apart` = 0, or each from its own, `apart` = 1.
RT_ALWAYS_INLINE uint64_t surfaces_find(const SphereTable *table, const double *const origin[3], unsigned apart,
                                        const double direction[3][TILE_RAYS], const TileHits *hits,
                                        TileSurfaces *surfaces)
{
    _Alignas(64) double begin[3][TILE_RAYS];
    _Alignas(64) double centre[3][TILE_RAYS];
    _Alignas(64) double radius_squared[TILE_RAYS];
    _Alignas(64) double t[TILE_RAYS];
    unsigned count = (unsigned)surfaces->count;
    for (unsigned i = 0; i < count; i++) {
        unsigned ray = surfaces->ray[i];
        ShapeId shape = hits->shape[ray];
        surfaces->shape[i] = shape;
        surfaces->direction[0][i] = direction[0][ray];
        surfaces->direction[1][i] = direction[1][ray];
        surfaces->direction[2][i] = direction[2][ray];
        for (int axis = 0; apart && axis < 3; axis++) {
            begin[axis][i] = origin[axis][ray];
        }
        t[i] = hits->t[ray];
        SphereData ball = shape_kind(shape) == SHAPE_SPHERE ? sphere_table_ball(table, shape_index(shape))
                                                            : (SphereData){{0.0, 0.0, 0.0}, (double)NAN};
        centre[0][i] = ball.centre.x;
        centre[1][i] = ball.centre.y;
        centre[2][i] = ball.centre.z;
        radius_squared[i] = ball.radius_squared;
    }
    // The last vector is filled up, so that every place holds a number.
    for (unsigned i = count; i % DOUBLES != 0; i++) {
        for (int axis = 0; axis < 3; axis++) {
            surfaces->direction[axis][i] = surfaces->direction[axis][count - 1];
            centre[axis][i] = centre[axis][count - 1];
            begin[axis][i] = apart ? begin[axis][count - 1] : 0.0;
        }
        radius_squared[i] = radius_squared[count - 1];
        t[i] = t[count - 1];
    }
    uint64_t done = 0;
    for (unsigned i = 0; i < count; i += DOUBLES) {
        Doubles offset[3], own[3], begun[3], along[3];
        Doubles square = doubles_load(&radius_squared[i]);
#pragma GCC unroll 3
        for (int axis = 0; axis < 3; axis++) {
            own[axis] = doubles_load(&centre[axis][i]);
            begun[axis] = apart ? doubles_load(&begin[axis][i]) : doubles_splat(*origin[axis]);
            along[axis] = doubles_load(&t[i]) * doubles_load(&surfaces->direction[axis][i]);
            offset[axis] = (begun[axis] - own[axis]) + along[axis];
        }
        Doubles length_squared = offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2];
        done |= (uint64_t)doubles_ge(0x1p-20 * square, doubles_abs(length_squared - square)) << i;
        Doubles shrink = 1.0 / doubles_sqrt(length_squared);
        Doubles radius = doubles_sqrt(square);
        DoublesMask is_near = doubles_load(&t[i]) < radius;
#pragma GCC unroll 3
        for (int axis = 0; axis < 3; axis++) {
            Doubles normal = shrink * offset[axis];
            doubles_store(&surfaces->outward[axis][i], normal);
            doubles_store(&surfaces->point[axis][i],
                          doubles_choose(is_near, begun[axis] + along[axis], own[axis] + radius * normal));
        }
    }
    return done;
}

static uint64_t surfaces_sphere(const SphereTable *table, const SphereTile *tile, const TileHits *hits,
                                TileSurfaces *surfaces)
{
    const double *const origin[3] = {&tile->origin.x, &tile->origin.y, &tile->origin.z};
    return surfaces_find(table, origin, 0, tile->direction, hits, surfaces);
}

static uint64_t surfaces_secondary(const SphereTable *table, const SecondaryRays *rays, const TileHits *hits,
                                   TileSurfaces *surfaces)
{
    const double *const origin[3] = {rays->origin[0], rays->origin[1], rays->origin[2]};
    return surfaces_find(table, origin, 1, rays->direction, hits, surfaces);
}

#endif
