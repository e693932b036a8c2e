// A plane against the rays of a tile, and against those from its surfaces to a light: part of spheres_kernel.c.
//
// Operations and their order are those of plane_root, plane_crossing_error and root_span.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_PLANE_TILE_H
#define TRACE_PLANE_TILE_H

#include "trace/plane.h"
#include "trace/simd.h"
#include "trace/spheres.h"

static uint64_t plane_closest(const PlaneShape *plane, ShapeId shape, const SphereTile *tile, TileHits *hits)
{
    Vec3 n = plane->normal;
    double away = plane->distance - vec3_dot(n, tile->origin);
    uint64_t tied = 0;
    for (unsigned i = 0; i < TILE_RAYS; i += DOUBLES) {
        _Alignas(64) double t[DOUBLES];
        Doubles along = n.x * doubles_load(&tile->direction[0][i]) + n.y * doubles_load(&tile->direction[1][i]) +
                        n.z * doubles_load(&tile->direction[2][i]);
        Doubles root = away / along;
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

// |o| + |t d| of an axis, as plane_crossing_error has it.
RT_ALWAYS_INLINE Doubles plane_reach(double normal, double origin, Doubles t, const double *direction)
{
    return normal != 0.0 ? doubles_abs(doubles_splat(origin)) + doubles_abs(t * doubles_load(direction))
                         : doubles_splat(0.0);
}

static uint64_t plane_foremost(const PlaneShape *plane, ShapeId shape, uint32_t order, const SphereTile *tile,
                               TileForemost *all)
{
    Vec3 n = plane->normal, o = tile->origin;
    double away = plane->distance - vec3_dot(n, o);
    TileHits *hits = all->hits;
    const Doubles zero = doubles_splat(0.0), far = doubles_splat((double)INFINITY);
    uint64_t left = hits->met;
    for (unsigned i = 0; i < TILE_RAYS; i += DOUBLES) {
        _Alignas(64) double t[DOUBLES];
        const double *x = &tile->direction[0][i], *y = &tile->direction[1][i], *z = &tile->direction[2][i];
        Doubles along = n.x * doubles_load(x) + n.y * doubles_load(y) + n.z * doubles_load(z), root = away / along;
        Doubles rx = plane_reach(n.x, o.x, root, x), ry = plane_reach(n.y, o.y, root, y),
                rz = plane_reach(n.z, o.z, root, z);
        Doubles reach = doubles_sqrt(rx * rx + ry * ry + rz * rz) + fabs(plane->distance);
        Doubles error = TRANSFORM_ROUNDING * reach / doubles_abs(along), to = root + error;
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
    Vec3 n = plane->normal;
    uint64_t occluded = 0, own = 0;
    for (int i = 0; i < from->count; i += DOUBLES) {
        Doubles height = n.x * doubles_load(&from->point[0][i]) + n.y * doubles_load(&from->point[1][i]) +
                         n.z * doubles_load(&from->point[2][i]);
        Doubles along = n.x * doubles_load(&rays->towards[0][i]) + n.y * doubles_load(&rays->towards[1][i]) +
                        n.z * doubles_load(&rays->towards[2][i]);
        Doubles root = (plane->distance - height) / along;
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
