// Points and normals of the primitives that some rays have met, a vector at a time: part of spheres_kernel.c.
//
// Operations and their order are those of shapes_surface, so the bits are the same.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SHAPES_SURFACE_H
#define TRACE_SHAPES_SURFACE_H

#include "trace/primitive_lanes_surface.h"

// The surfaces of one kind, a bit for each, where the primitives stand in the table, and the sides of them.
typedef struct KindSurfaces {
    uint64_t own;
    _Alignas(64) int64_t index[TILE_RAYS], side[TILE_RAYS];
} KindSurfaces;

// A bit for each kind with a test in lanes that is among the surfaces asked for.
static unsigned surfaces_kinds(const ShapeTable *table, const TileSurfaces *surfaces, uint64_t asked)
{
    unsigned kinds = 0;
    for (int i = 0; i < surfaces->count; i++) {
        ShapeId shape = surfaces->shape[i];
        if ((asked >> i & 1) && shape_kind(shape) == SHAPE_PRIMITIVE) {
            kinds |= 1u << table->primitives[primitive_index(shape)].kind;
        }
    }
    return kinds;
}

// What is of another kind has the place of one that is not.
static void surfaces_of_kind(const ShapeTable *table, const TileSurfaces *surfaces, uint64_t asked, PrimitiveKind kind,
                             KindSurfaces *of)
{
    int64_t last = 0;
    of->own = 0;
    for (int i = 0; i < surfaces->count; i++) {
        ShapeId shape = surfaces->shape[i];
        of->side[i] = primitive_side(shape);
        if ((asked >> i & 1) && shape_kind(shape) == SHAPE_PRIMITIVE &&
            table->primitives[primitive_index(shape)].kind == kind) {
            of->own |= UINT64_C(1) << i;
            last = primitive_index(shape);
        }
        of->index[i] = last;
    }
    for (int i = surfaces->count; i % DOUBLES != 0; i++) {
        of->index[i] = last;
        of->side[i] = 0;
    }
}

// Fills in point and normal of those of one kind. Rays as of shapes_surfaces.
RT_ALWAYS_INLINE void surfaces_fill(const ShapeTable *table, const double *const origin[3], unsigned apart,
                                    const TileHits *hits, PrimitiveKind kind, const KindSurfaces *of,
                                    TileSurfaces *surfaces)
{
    for (int at = 0; at < surfaces->count; at += DOUBLES) {
        unsigned own = of->own >> at & ((1u << DOUBLES) - 1);
        _Alignas(64) double begin[3][DOUBLES], t[DOUBLES];
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
        DoublesMask index = *(const DoublesMask *)&of->index[at], side = *(const DoublesMask *)&of->side[at];
        PrimitivesRay rays = primitives_ray(table->primitives, index, vec3s_load(begin, 0),
                                            vec3s_load(surfaces->direction, at));
        PlaceLanes place;
        primitives_surface(table->primitives, kind, index, side, &rays, doubles_load(t), &place);
        DoublesMask is_own = doubles_bits_mask(own);
        vec3s_store(surfaces->point, at, vec3s_choose(is_own, place.point, vec3s_load(surfaces->point, at)));
        vec3s_store(surfaces->outward, at, vec3s_choose(is_own, place.normal, vec3s_load(surfaces->outward, at)));
    }
    for (uint64_t rest = of->own; rest; rest &= rest - 1) {
        int i = __builtin_ctzll(rest);
        if (table->primitives[of->index[i]].flips) {
            lane_set(surfaces->outward, (unsigned)i, vec3_neg(tile_surface_outward(surfaces, i)));
        }
    }
}

// Fills in point and normal of the surfaces `asked` for whose kind has a test in lanes, and returns those. Rays are
// from one point, `apart` = 0, or each from its own, `apart` = 1.
static uint64_t shapes_surfaces(const ShapeTable *table, const double *const origin[3], unsigned apart,
                                const TileHits *hits, uint64_t asked, TileSurfaces *surfaces)
{
    uint64_t done = 0;
    for (unsigned kinds = surfaces_kinds(table, surfaces, asked); kinds; kinds &= kinds - 1) {
        PrimitiveKind kind = (PrimitiveKind)__builtin_ctz(kinds);
        KindSurfaces of; // not cleared
        if (!kind_has_surface_lanes(kind)) {
            continue;
        }
        surfaces_of_kind(table, surfaces, asked, kind, &of);
        switch (kind) {
        case PRIMITIVE_SPHERE:
            surfaces_fill(table, origin, apart, hits, PRIMITIVE_SPHERE, &of, surfaces);
            break;
        case PRIMITIVE_BOX:
            surfaces_fill(table, origin, apart, hits, PRIMITIVE_BOX, &of, surfaces);
            break;
        case PRIMITIVE_CONE:
            surfaces_fill(table, origin, apart, hits, PRIMITIVE_CONE, &of, surfaces);
            break;
        case PRIMITIVE_TORUS:
            surfaces_fill(table, origin, apart, hits, PRIMITIVE_TORUS, &of, surfaces);
            break;
        case PRIMITIVE_SMOOTH_TRIANGLE:
            surfaces_fill(table, origin, apart, hits, PRIMITIVE_SMOOTH_TRIANGLE, &of, surfaces);
            break;
        default:
            surfaces_fill(table, origin, apart, hits, PRIMITIVE_TRIANGLE, &of, surfaces); // a disc, too
        }
        done |= of.own;
    }
    return done;
}

#endif
