// Points and normals of the balls that some rays have met, a vector at a time: part of spheres_kernel.c.
//
// Operations and their order are those of shapes_surface, so the bits are the same.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SHAPES_SURFACE_H
#define TRACE_SHAPES_SURFACE_H

#include "trace/ball_lanes.h"

// The balls among the surfaces asked for, a bit for each, and where each stands in the table; what is no ball has the
// place of one.
static uint64_t surfaces_balls(const ShapeTable *table, const TileSurfaces *surfaces, uint64_t asked,
                               int64_t index[TILE_RAYS])
{
    uint64_t balls = 0;
    int64_t last = 0;
    for (int i = 0; i < surfaces->count; i++) {
        ShapeId shape = surfaces->shape[i];
        if ((asked >> i & 1) && shape_kind(shape) == SHAPE_PART &&
            table->solids[part_index(shape)].kind == PART_SPHERE) {
            balls |= UINT64_C(1) << i;
            last = part_index(shape);
        }
        index[i] = last;
    }
    for (int i = surfaces->count; i % DOUBLES != 0; i++) {
        index[i] = last;
    }
    return balls;
}

// Fills in point and normal of the surfaces `asked` for that are balls, and returns those. Rays are from one point,
// `apart` = 0, or each from its own, `apart` = 1.
static uint64_t shapes_surfaces(const ShapeTable *table, const double *const origin[3], unsigned apart,
                                const TileHits *hits, uint64_t asked, TileSurfaces *surfaces)
{
    _Alignas(64) int64_t index[TILE_RAYS];
    uint64_t balls = surfaces_balls(table, surfaces, asked, index);
    for (int at = 0; at < surfaces->count; at += DOUBLES) {
        unsigned own = balls >> at & ((1u << DOUBLES) - 1);
        Doubles begin[3], direction[3], point[3], normal[3], t;
        if (!own) {
            continue;
        }
        for (int k = 0; k < DOUBLES; k++) {
            unsigned ray = surfaces->ray[at + k < surfaces->count ? at + k : at];
            t[k] = hits->t[ray];
            for (int axis = 0; axis < 3; axis++) {
                begin[axis][k] = origin[axis][apart * ray];
            }
        }
        lanes_load(surfaces->direction, (unsigned)at, direction);
        balls_surface(table->solids, *(const DoublesMask *)&index[at], begin, direction, t, point, normal);
        for (int axis = 0; axis < 3; axis++) {
            double *points = &surfaces->point[axis][at], *normals = &surfaces->outward[axis][at];
            doubles_store(points, doubles_choose_bits(own, point[axis], doubles_load(points)));
            doubles_store(normals, doubles_choose_bits(own, normal[axis], doubles_load(normals)));
        }
    }
    for (uint64_t rest = balls; rest; rest &= rest - 1) {
        int i = __builtin_ctzll(rest);
        if (table->solids[index[i]].flips) {
            lane_set(surfaces->outward, (unsigned)i, vec3_neg(tile_surface_outward(surfaces, i)));
        }
    }
    return balls;
}

#endif
