// Points and normals of what a tile's rays have met, some at once: part of spheres_kernel.c.
//
// By the arithmetic of single rays (trace/sphere.inc), so the bits are those of geometry_surface.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERES_SURFACE_H
#define TRACE_SPHERES_SURFACE_H

#include "trace/simd.h"
#include "trace/sphere_rays.h"
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
        Vec3s from = apart ? vec3s_load(begin, i) : vec3s_splat(vec3(*origin[0], *origin[1], *origin[2]));
        const Rays rays = {from, vec3s_load(surfaces->direction, i)};
        const Balls balls = {vec3s_load(centre, i), doubles_load(&radius_squared[i])};
        Vec3s offset = spheres_offset(&rays, &balls, doubles_load(&t[i]));
        done |= (uint64_t)spheres_offset_is_right(&balls, offset) << i;
        Vec3s normal = vec3s_normalize(offset);
        vec3s_store(surfaces->outward, i, normal);
        vec3s_store(surfaces->point, i, spheres_point(&rays, &balls, doubles_load(&t[i]), normal));
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
