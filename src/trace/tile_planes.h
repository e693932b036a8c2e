// Planes through the rays of a tile, and what of a solid they touch: part of spheres_kernel.c.
//
// Planes go through the origin of the rays, and carry a margin far above their rounding, so that nothing is lost.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_TILE_PLANES_H
#define TRACE_TILE_PLANES_H

#include "trace/cone_test.h"
#include "trace/shapes.h"
#include "trace/simd.h"
#include "trace/spheres.h"

enum { ROWS = TILE_RAYS / TILE_ROW };

// A plane through the origin of rays, and how far their directions, of unit length, are from it at most.
typedef struct RayPlane {
    Vec3 normal;
    double spread;
} RayPlane;

// Those of a tile.
typedef struct TilePlanes {
    bool has_planes, has_rows; // whether they are known: many tiles come to no leaf, or meet nothing there
    RayPlane along, across;    // the rows; the columns
    _Alignas(64) double row_normal[3][ROWS];
    _Alignas(64) double row_spread[ROWS];
} TilePlanes;

// Some of a tile's rays and the plane of a normal.
static RayPlane ray_plane(const SphereTile *tile, Vec3 normal, unsigned begin, unsigned end)
{
    Doubles greatest = doubles_splat(0.0);
    for (unsigned i = begin; i < end; i += DOUBLES) {
        Doubles aside = doubles_load(&tile->direction[0][i]) * normal.x +
                        doubles_load(&tile->direction[1][i]) * normal.y +
                        doubles_load(&tile->direction[2][i]) * normal.z;
        greatest = doubles_max(doubles_abs(aside), greatest);
    }
    return (RayPlane){normal, doubles_greatest(greatest) + CONE_MARGIN};
}

// That of two rays, NaN where they are one.
static Vec3 tile_normal(const SphereTile *tile, unsigned a, unsigned b)
{
    return vec3_normalize(vec3_cross(lane_get(tile->direction, a), lane_get(tile->direction, b)));
}

static void tile_set_planes(TilePlanes *planes, const SphereTile *tile)
{
    enum { MIDDLE = TILE_RAYS / 2 };
    Vec3 normal = tile_normal(tile, MIDDLE, MIDDLE + TILE_ROW - 1);
    Vec3 axis = vec3_add(lane_get(tile->direction, MIDDLE - TILE_ROW / 2 - 1),
                         lane_get(tile->direction, MIDDLE + TILE_ROW / 2));
    planes->along = ray_plane(tile, normal, 0, TILE_RAYS);
    planes->across = ray_plane(tile, vec3_normalize(vec3_cross(normal, axis)), 0, TILE_RAYS);
    planes->has_planes = true;
}

static void tile_set_rows(TilePlanes *planes, const SphereTile *tile)
{
    for (unsigned row = 0; row < ROWS; row++) {
        unsigned begin = row * TILE_ROW, end = begin + TILE_ROW;
        RayPlane plane = ray_plane(tile, tile_normal(tile, begin, end - 1), begin, end);
        planes->row_spread[row] = plane.spread;
        planes->row_normal[0][row] = plane.normal.x;
        planes->row_normal[1][row] = plane.normal.y;
        planes->row_normal[2][row] = plane.normal.z;
    }
    planes->has_rows = true;
}

// The rays of some rows.
RT_ALWAYS_INLINE uint64_t rows_rays(unsigned rows)
{
    uint64_t rays = 0;
    for (; rows; rows &= rows - 1) {
        rays |= UINT64_C(0xff) << (unsigned)__builtin_ctz(rows) * TILE_ROW;
    }
    return rays;
}

// From where to where a primitive of one of these kinds, a constant of the caller, reaches along some normals, as seen
// from its middle; `own` is what the normals are to the three axes of its space.
RT_ALWAYS_INLINE void primitive_reach(const PreparedPrimitive *primitive, PrimitiveKind kind, const Doubles own[3],
                                      Doubles *low, Doubles *high)
{
    const double *from = &primitive->data[0].x, *to = &primitive->data[1].x;
    Doubles round = doubles_sqrt(own[0] * own[0] + own[1] * own[1]), cap = from[0] * round;
    const Doubles zero = doubles_splat(0.0);
    switch (kind) {
    case PRIMITIVE_BOX:
    case PRIMITIVE_POLYNOMIAL:
    case PRIMITIVE_BLOB:
    case PRIMITIVE_PRISM:
        *low = *high = zero;
        for (int axis = 0; axis < 3; axis++) {
            Doubles a = from[axis] * own[axis], b = to[axis] * own[axis];
            *low += doubles_min(a, b);
            *high += doubles_max(a, b);
        }
        break;
    case PRIMITIVE_CONE:
        *high = doubles_max(round, own[2] + cap);
        *low = doubles_min(-round, own[2] - cap);
        break;
    case PRIMITIVE_TORUS:
        *high = from[0] * doubles_sqrt(own[0] * own[0] + own[2] * own[2]) +
                from[1] * doubles_sqrt(own[0] * own[0] + own[1] * own[1] + own[2] * own[2]);
        *low = -*high;
        break;
    case PRIMITIVE_DISC:
        *high = round;
        *low = -round;
        break;
    default:
        *high = doubles_max(zero, doubles_max(own[0], own[1]));
        *low = doubles_min(zero, doubles_min(own[0], own[1]));
    }
}

// No point of a primitive is farther from a place.
RT_ALWAYS_INLINE double primitive_farthest(const PreparedPrimitive *primitive, PrimitiveKind kind, Vec3 offset)
{
    const double(*m)[3] = primitive->to_world.m, *low = &primitive->data[0].x, *high = &primitive->data[1].x;
    double sum = vec3_sum_abs(offset);
    for (int axis = 0; axis < 3; axis++) {
        bool has_box = kind == PRIMITIVE_BOX || kind == PRIMITIVE_POLYNOMIAL || kind == PRIMITIVE_BLOB ||
                       kind == PRIMITIVE_PRISM;
        double size = has_box                   ? fabs(low[axis]) + fabs(high[axis])
                      : kind == PRIMITIVE_CONE  ? greater_of(1.0, low[0])
                      : kind == PRIMITIVE_TORUS ? low[0] + low[1]
                                                : 1.0;
        sum += size * (fabs(m[axis][0]) + fabs(m[axis][1]) + fabs(m[axis][2]));
    }
    return sum;
}

// Bit i is set where a primitive does not touch a plane.
RT_ALWAYS_INLINE unsigned primitive_planes_apart(const PreparedPrimitive *primitive, PrimitiveKind kind, Vec3 offset,
                                                 double farthest, const Doubles normal[3], Doubles spread)
{
    const double(*m)[3] = primitive->to_world.m;
    Doubles own[3], low, high, away = offset.x * normal[0] + offset.y * normal[1] + offset.z * normal[2];
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
        own[axis] = m[axis][0] * normal[0] + m[axis][1] * normal[1] + m[axis][2] * normal[2];
    }
    primitive_reach(primitive, kind, own, &low, &high);
    Doubles reach = farthest * spread;
    return doubles_ge(away + low, reach) | doubles_ge(-reach, away + high);
}

// The rows that a primitive may touch, a bit for each; `offset` leads to its middle from the origin.
RT_ALWAYS_INLINE unsigned primitive_rows(TilePlanes *planes, const SphereTile *tile, const PreparedPrimitive *primitive,
                                         PrimitiveKind kind, Vec3 offset)
{
    double farthest = primitive_farthest(primitive, kind, offset);
    unsigned apart = 0;
    if (!planes->has_planes) {
        tile_set_planes(planes, tile);
    }
    Vec3 n = planes->across.normal;
    const Doubles across[3] = {doubles_splat(n.x), doubles_splat(n.y), doubles_splat(n.z)};
    if (primitive_planes_apart(primitive, kind, offset, farthest, across, doubles_splat(planes->across.spread))) {
        return 0;
    }
    if (!planes->has_rows) {
        tile_set_rows(planes, tile);
    }
    for (int i = 0; i < ROWS; i += DOUBLES) {
        const Doubles normal[3] = {doubles_load(&planes->row_normal[0][i]), doubles_load(&planes->row_normal[1][i]),
                                   doubles_load(&planes->row_normal[2][i])};
        apart |= primitive_planes_apart(primitive, kind, offset, farthest, normal, doubles_load(&planes->row_spread[i]))
                 << i;
    }
    return ~apart & ((1u << ROWS) - 1);
}

#endif
