// What a ray met, as a surface: the point put back onto it, its normal and its material, of one hit or of a tile's.
// Inline, as trace/query.h is.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_QUERY_SURFACE_H
#define TRACE_QUERY_SURFACE_H

#include "trace/query.h"

// Whether two are one surface: the same, or equal ones, declared twice.
RT_ALWAYS_INLINE bool geometry_is_same(const Geometry *g, ShapeId a, ShapeId b)
{
    if (shape_kind(a) != shape_kind(b)) {
        return false;
    }
    uint32_t i = shape_index(a), j = shape_index(b);
    switch (shape_kind(a)) {
    case SHAPE_SPHERE: {
        SphereData ball = sphere_table_ball(&g->spheres, i), other = sphere_table_ball(&g->spheres, j);
        return sphere_data_equal(&ball, &other);
    }
    case SHAPE_PLANE: return plane_equal(&g->planes[i].shape, &g->planes[j].shape);
    case SHAPE_FACE: return i == j;
    default:
        return primitive_equal(&g->shapes.primitives[primitive_index(a)], &g->shapes.primitives[primitive_index(b)]);
    }
}

// The material of a sphere or plane.
RT_ALWAYS_INLINE MaterialIndex geometry_material(const Geometry *g, unsigned features, ShapeId shape)
{
    bool is_plane = (features & TRACE_PLANES) && shape_kind(shape) == SHAPE_PLANE;
    return is_plane ? g->planes[shape_index(shape)].info.material : g->spheres.info[shape_index(shape)].material;
}

// Where the ray hit: the point put back onto the surface, its normal and its material.
RT_ALWAYS_INLINE Surface geometry_surface(const Geometry *g, unsigned features, Ray ray, Hit hit)
{
    uint32_t index = shape_index(hit.shape);
    ShapeKind kind = shape_kind(hit.shape);
    if ((features & TRACE_PLANES) && kind == SHAPE_PLANE) {
        const PlaneEntry *plane = &g->planes[index];
        return (Surface){plane_point(&plane->shape, ray, hit.t), plane->shape.normal, plane->info.material,
                         plane->info.order, 0};
    }
    if ((features & TRACE_PRIMITIVES) && shape_is_on_primitive(hit.shape)) {
        return shapes_surface(&g->shapes, &ray, &hit);
    }
    SphereData ball = sphere_table_ball(&g->spheres, index);
    Vec3 normal = sphere_normal(ray, &ball, hit.t);
    Vec3 point = sphere_point(&ray, &ball, hit.t, normal);
    return (Surface){point, normal, g->spheres.info[index].material, g->spheres.info[index].order, 0};
}

// Begins with the rays of `wanted`, in their order.
RT_ALWAYS_INLINE void query_surfaces_begin(TileSurfaces *surfaces, const TileHits *hits, uint64_t wanted)
{
    surfaces->count = 0;
    surfaces->inside = 0;
    for (; wanted; wanted &= wanted - 1) {
        unsigned ray = (unsigned)__builtin_ctzll(wanted);
        surfaces->inside |= (hits->inside >> ray & 1) << surfaces->count;
        surfaces->ray[surfaces->count++] = (uint8_t)ray;
    }
}

// The material of surface i, which is `done` but for that, or which a ray has met.
RT_ALWAYS_INLINE MaterialIndex query_surface_end(const Geometry *g, unsigned features, uint64_t done, Ray ray,
                                                 const TileHits *hits, TileSurfaces *surfaces, int i)
{
    ShapeId shape = surfaces->shape[i];
    if (RT_LIKELY(done >> i & 1)) {
        bool is_part = (features & TRACE_PRIMITIVES) && shape_kind(shape) == SHAPE_PRIMITIVE;
        return is_part ? g->shapes.primitives[primitive_index(shape)].material
                       : g->spheres.info[shape_index(shape)].material;
    }
    unsigned from = surfaces->ray[i];
    Hit hit = {hits->t[from], hits->shape[from], hits->inside >> from & 1};
    Surface surface = geometry_surface(g, features, ray, hit);
    tile_surface_set(surfaces, i, surface.point, surface.normal);
    return surface.material;
}

// The rest of a tile's surfaces, and of those of other rays, of which the kernels have `done` some.
RT_ALWAYS_INLINE void query_tile_surfaces_end(const Geometry *g, unsigned features, uint64_t done,
                                              const SphereTile *tile, const TileHits *hits, TileSurfaces *surfaces,
                                              MaterialIndex material[TILE_RAYS])
{
    for (int i = 0; i < surfaces->count; i++) {
        Ray ray = {tile->origin, lane_get(tile->direction, surfaces->ray[i])};
        material[i] = query_surface_end(g, features, done, ray, hits, surfaces, i);
    }
}

RT_ALWAYS_INLINE void query_secondary_surfaces_end(const Geometry *g, unsigned features, uint64_t done,
                                                   const SecondaryRays *rays, const TileHits *hits,
                                                   TileSurfaces *surfaces, MaterialIndex material[TILE_RAYS])
{
    for (int i = 0; i < surfaces->count; i++) {
        material[i] = query_surface_end(g, features, done, secondary_ray(rays, surfaces->ray[i]), hits, surfaces, i);
    }
}

// The same with primitives. Not inline, for the stack.
static __attribute__((noinline, unused)) void
query_tile_surfaces_primitives(const Geometry *g, uint64_t done, const SphereTile *tile, const TileHits *hits,
                               TileSurfaces *surfaces, MaterialIndex material[TILE_RAYS])
{
    const double *const origin[3] = {&tile->origin.x, &tile->origin.y, &tile->origin.z};
    done |= g->kernels->shapes_surfaces(&g->shapes, origin, 0, hits, ~done, surfaces);
    query_tile_surfaces_end(g, TRACE_ALL_FEATURES, done, tile, hits, surfaces, material);
}

static __attribute__((noinline, unused)) void
query_secondary_surfaces_primitives(const Geometry *g, uint64_t done, const SecondaryRays *rays, const TileHits *hits,
                                    TileSurfaces *surfaces, MaterialIndex material[TILE_RAYS])
{
    const double *const origin[3] = {rays->origin[0], rays->origin[1], rays->origin[2]};
    done |= g->kernels->shapes_surfaces(&g->shapes, origin, 1, hits, ~done, surfaces);
    query_secondary_surfaces_end(g, TRACE_ALL_FEATURES, done, rays, hits, surfaces, material);
}

// The surfaces that a tile's rays of `wanted`, one at least, have met, and their materials.
RT_ALWAYS_INLINE void geometry_tile_surfaces(const Geometry *g, unsigned features, const SphereTile *tile,
                                             const TileHits *hits, uint64_t wanted, TileSurfaces *surfaces,
                                             MaterialIndex material[TILE_RAYS])
{
    query_surfaces_begin(surfaces, hits, wanted);
    uint64_t done = g->kernels->surfaces(&g->spheres, tile, hits, surfaces);
    if (query_has_primitives(g, features)) {
        query_tile_surfaces_primitives(g, done, tile, hits, surfaces, material);
    } else {
        query_tile_surfaces_end(g, features, done, tile, hits, surfaces, material);
    }
}

// Those that rays which continue have met, one at least.
RT_ALWAYS_INLINE void geometry_secondary_surfaces(const Geometry *g, unsigned features, const SecondaryRays *rays,
                                                  const TileHits *hits, TileSurfaces *surfaces,
                                                  MaterialIndex material[TILE_RAYS])
{
    query_surfaces_begin(surfaces, hits, hits->met);
    uint64_t done = g->kernels->surfaces_secondary(&g->spheres, rays, hits, surfaces);
    if (query_has_primitives(g, features)) {
        query_secondary_surfaces_primitives(g, done, rays, hits, surfaces, material);
    } else {
        query_secondary_surfaces_end(g, features, done, rays, hits, surfaces, material);
    }
}

#endif
