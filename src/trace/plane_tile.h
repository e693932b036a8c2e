// A plane against the rays of a tile, and against those from its surfaces to a light: part of spheres_kernel.c.
//
// Roots and their errors are those of plane.h, by the same text (trace/plane.inc).
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_PLANE_TILE_H
#define TRACE_PLANE_TILE_H

#include "trace/plane.h"
#include "trace/simd.h"
#include "trace/spheres.h"
#include "trace/vec3s.h"

#include "trace/lane_doubles.h"
#include "trace/plane.inc"

static uint64_t plane_closest(const PlaneShape *plane, ShapeId shape, const SphereTile *tile, TileHits *hits)
{
    Vec3 n = plane->normal;
    double away = plane->distance - vec3_dot(n, tile->origin);
    uint64_t tied = 0;
    for (unsigned i = 0; i < TILE_RAYS; i += DOUBLES) {
        _Alignas(64) double t[DOUBLES];
        Doubles along = vec3s_dot(vec3s_splat(n), vec3s_load(tile->direction, i)), root = away / along;
        Doubles before = doubles_load(&hits->t[i]);
        unsigned ahead = doubles_gt(root, doubles_splat(0.0));
        unsigned nearer = ahead & doubles_gt(before, root);
        uint64_t met = (uint64_t)nearer << i, inside = (uint64_t)doubles_gt(along, doubles_splat(0.0)) << i;
        tied |= (uint64_t)(ahead & doubles_ge(before, root) & doubles_ge(root, before)) << i;
        hits->inside = (hits->inside & ~met) | (met & inside);
        hits->met |= met;
        doubles_store(t, root);
        for (; nearer; nearer &= nearer - 1) {
            unsigned k = (unsigned)__builtin_ctz(nearer);
            hits->t[i + k] = t[k];
            hits->shape[i + k] = shape;
        }
    }
    return tied & hits->met;
}

static uint64_t plane_foremost(const PlaneShape *plane, ShapeId shape, uint32_t order, const SphereTile *tile,
                               TileForemost *all)
{
    Vec3 n = plane->normal;
    const Vec3s origin = vec3s_splat(tile->origin);
    double away = plane->distance - vec3_dot(n, tile->origin);
    TileHits *hits = all->hits;
    const Doubles zero = doubles_splat(0.0), far = doubles_splat((double)INFINITY);
    uint64_t left = hits->met;
    for (unsigned i = 0; i < TILE_RAYS; i += DOUBLES) {
        _Alignas(64) double t[DOUBLES];
        Vec3s direction = vec3s_load(tile->direction, i);
        Doubles along = vec3s_dot(vec3s_splat(n), direction), root = away / along;
        Doubles error = planes_crossing_error(plane, origin, direction, root), to = root + error;
        unsigned free = ~hits->met >> i & ((1u << DOUBLES) - 1), ahead = free & doubles_gt(root, zero);
        unsigned plain = ahead & doubles_gt(error, zero) & doubles_gt(far, to);
        left |= (uint64_t)(ahead & ~plain) << i;
        doubles_store(&all->from[i], doubles_choose_bits(plain, root * (root / to), doubles_load(&all->from[i])));
        doubles_store(&all->limit[i], doubles_choose_bits(plain, to, doubles_load(&all->limit[i])));
        hits->inside = (hits->inside & ~((uint64_t)plain << i)) | (uint64_t)(plain & doubles_gt(along, zero)) << i;
        hits->met |= (uint64_t)plain << i;
        doubles_store(t, root);
        for (; plain; plain &= plain - 1) {
            unsigned k = (unsigned)__builtin_ctz(plain);
            hits->t[i + k] = t[k];
            hits->shape[i + k] = shape;
            all->order[i + k] = order;
        }
    }
    return left;
}

static uint64_t plane_occluded(const PlaneShape *plane, ShapeId shape, const TileSurfaces *from,
                               const SurfaceRays *rays)
{
    uint64_t occluded = 0, own = 0;
    for (int i = 0; i < from->count; i += DOUBLES) {
        Doubles root = planes_root(plane, vec3s_load(from->point, i), vec3s_load(rays->towards, i));
        occluded |= (uint64_t)(doubles_gt(root, doubles_splat(0.0)) &
                               doubles_gt(doubles_load(&rays->distance[i]), root))
                    << i;
    }
    for (int i = 0; i < from->count; i += FLOATS) {
        own |= (uint64_t)ints_equal(&from->shape[i], shape) << i;
    }
    return occluded & ~own;
}

#endif
