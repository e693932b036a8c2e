// What a ray meets: the queries, inline, so that a kernel contains only the shapes its scene has.
//
// `features` is a constant of the caller, a set of TraceFeature bits that covers geometry_features(). All queries take
// a finite ray of about unit length; one that is not finite, or has no direction, meets nothing. Thread-safe: they
// write nothing but their result.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_QUERY_H
#define TRACE_QUERY_H

#include "trace/geometry.h"

enum { TRACE_ANY_SPHERES = TRACE_SPHERES | TRACE_SPHERE_BVH };

// The sphere that the ray starts on, or one that equals none. Equal spheres, declared twice, are one surface.
RT_ALWAYS_INLINE Ball query_start_ball(const Geometry *g, RayStart start)
{
    bool on_sphere = start.shape != SHAPE_NONE && shape_kind(start.shape) == SHAPE_SPHERE;
    return on_sphere ? sphere_table_ball(&g->spheres, shape_index(start.shape)) : (Ball){{0.0, 0.0, 0.0}, (double)NAN};
}

RT_ALWAYS_INLINE void query_spheres_closest(const Geometry *g, unsigned features, const SphereRay *ray, RayStart start,
                                            Nearest *nearest)
{
    Ball start_ball = query_start_ball(g, start);
    if (start.inward && !isnan(start_ball.radius_squared)) {
        nearest_offer(nearest, sphere_root_inward(ray, &start_ball), start.shape, true,
                      g->spheres.info[shape_index(start.shape)].order);
    }
    for (uint32_t i = 0; i < g->spheres.loose_count; i++) {
        sphere_slot_closest(&g->spheres, i, ray, &start_ball, nearest);
    }
    if (features & TRACE_SPHERE_BVH) {
        g->kernels->closest(&g->spheres, ray, &start_ball, nearest);
    }
    nearest_settle(&g->spheres, ray, nearest);
}

RT_ALWAYS_INLINE bool query_spheres_occluded(const Geometry *g, unsigned features, const SphereRay *ray,
                                             RayStart start, double t_max)
{
    Ball start_ball = query_start_ball(g, start);
    if (start.inward && !isnan(start_ball.radius_squared)) {
        double t = sphere_root_inward(ray, &start_ball);
        if (t > 0.0 && t < t_max) {
            return true;
        }
    }
    for (uint32_t i = 0; i < g->spheres.loose_count; i++) {
        if (sphere_slot_occludes(&g->spheres, i, ray, &start_ball, t_max)) {
            return true;
        }
    }
    return (features & TRACE_SPHERE_BVH) && g->kernels->occluded(&g->spheres, ray, &start_ball, t_max);
}

// The parameter at which an ellipsoid is met, by the rules for spheres; not positive when it is not.
RT_ALWAYS_INLINE double query_ellipsoid_root(const Geometry *g, uint32_t index, const SphereRay *ray, RayStart start,
                                             bool *inside)
{
    const EllipsoidShape *shape = &g->ellipsoids[index].shape;
    const Ball unit = UNIT_BALL;
    bool on_ellipsoid = start.shape != SHAPE_NONE && shape_kind(start.shape) == SHAPE_ELLIPSOID;
    if (on_ellipsoid && ellipsoid_equal(shape, &g->ellipsoids[shape_index(start.shape)].shape)) {
        if (!start.inward) {
            return 0.0;
        }
        SphereRay object = ellipsoid_ray(shape, ray);
        *inside = true;
        return sphere_root_inward(&object, &unit);
    }
    SphereRay object = ellipsoid_ray(shape, ray);
    return sphere_hit(&object, &unit, inside);
}

// The parameter at which a plane is met; not positive when it is not.
RT_ALWAYS_INLINE double query_plane_root(const Geometry *g, uint32_t index, const SphereRay *ray, RayStart start)
{
    const PlaneShape *shape = &g->planes[index].shape;
    bool on_plane = start.shape != SHAPE_NONE && shape_kind(start.shape) == SHAPE_PLANE;
    if (on_plane && plane_equal(shape, &g->planes[shape_index(start.shape)].shape)) {
        return 0.0;
    }
    return plane_root(shape, ray->origin, ray->direction);
}

// Brings the nearest of the spheres up to date with all other shapes.
RT_ALWAYS_INLINE void query_others_closest(const Geometry *g, unsigned features, const SphereRay *ray, RayStart start,
                                           Nearest *nearest)
{
    if (features & TRACE_PLANES) {
        for (uint32_t i = 0; i < g->plane_count; i++) {
            bool inside = vec3_dot(g->planes[i].shape.normal, ray->direction) > 0.0;
            nearest_offer(nearest, query_plane_root(g, i, ray, start), shape_id(SHAPE_PLANE, i), inside,
                          g->planes[i].info.order);
        }
    }
    if (features & TRACE_ELLIPSOIDS) {
        for (uint32_t i = 0; i < g->ellipsoid_count; i++) {
            bool inside = false;
            double t = query_ellipsoid_root(g, i, ray, start, &inside);
            nearest_offer(nearest, t, shape_id(SHAPE_ELLIPSOID, i), inside, g->ellipsoids[i].info.order);
        }
    }
    if (features & TRACE_PARTS) {
        shapes_closest(&g->shapes, &(Ray){ray->origin, ray->direction}, start, nearest);
    }
}

// The nearest hit with 0 < t < t_max, which may be INFINITY. Of equal distances the shape declared first.
RT_ALWAYS_INLINE bool geometry_closest(const Geometry *g, unsigned features, Ray ray, RayStart start, double t_max,
                                       Hit *hit)
{
    SphereRay sphere_ray = sphere_ray_make(ray.origin, ray.direction);
    if (!sphere_ray_is_usable(&sphere_ray)) {
        return false;
    }
    Nearest nearest = {{t_max, SHAPE_NONE, false}, 0, false};
    if (features & TRACE_ANY_SPHERES) {
        query_spheres_closest(g, features, &sphere_ray, start, &nearest);
    }
    query_others_closest(g, features, &sphere_ray, start, &nearest);
    *hit = nearest.hit;
    return nearest.hit.shape != SHAPE_NONE;
}

// `tile` holds usable rays, the same as `rays`.
RT_ALWAYS_INLINE void query_tile_closest(const Geometry *g, unsigned features, const SphereTile *tile, bool is_usable,
                                         const Ray rays[TILE_RAYS], Hit hits[TILE_RAYS])
{
    Nearest nearest[TILE_RAYS];
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        nearest[i] = (Nearest){{(double)INFINITY, SHAPE_NONE, false}, 0, false};
    }
    bool is_done = is_usable && (features & TRACE_ANY_SPHERES) && g->kernels->closest_tile(&g->spheres, tile, nearest);
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        if (is_done) {
            SphereRay ray = sphere_tile_ray(tile, i);
            query_others_closest(g, features, &ray, RAY_START_CAMERA, &nearest[i]);
            hits[i] = nearest[i].hit;
        } else if (!geometry_closest(g, features, rays[i], RAY_START_CAMERA, (double)INFINITY, &hits[i])) {
            hits[i].shape = SHAPE_NONE;
        }
    }
}

// The nearest hits, SHAPE_NONE where there is none, of rays that are free in space, of about unit length, and start at one
// point: 64 camera rays, in rows of eight neighbours. The same bits as geometry_closest gives ray by ray.
RT_ALWAYS_INLINE void geometry_closest_tile(const Geometry *g, unsigned features, const Ray rays[TILE_RAYS],
                                            Hit hits[TILE_RAYS])
{
    SphereTile tile;
    bool is_usable = true;
    tile.origin = rays[0].origin;
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        SphereRay ray = sphere_ray_make(rays[i].origin, rays[i].direction);
        is_usable = is_usable && sphere_ray_is_usable(&ray) && vec3_equal(rays[i].origin, tile.origin);
        sphere_tile_set(&tile, i, &ray);
    }
    query_tile_closest(g, features, &tile, is_usable, rays, hits);
}

// The same for the rays of a view, which are put into `rays`: each is vec3_normalize of direction + (u right - v up).
RT_ALWAYS_INLINE void geometry_closest_view(const Geometry *g, unsigned features, const TileView *view,
                                            const double u[TILE_RAYS], const double v[TILE_RAYS], Ray rays[TILE_RAYS],
                                            Hit hits[TILE_RAYS])
{
    SphereTile tile;
    bool is_usable = g->kernels->view_tile(view, u, v, &tile);
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        rays[i] = (Ray){tile.origin, {tile.direction[0][i], tile.direction[1][i], tile.direction[2][i]}};
    }
    query_tile_closest(g, features, &tile, is_usable, rays, hits);
}

// True when anything is met at 0 < t < t_max.
RT_ALWAYS_INLINE bool geometry_occluded(const Geometry *g, unsigned features, Ray ray, RayStart start, double t_max)
{
    SphereRay sphere_ray = sphere_ray_make(ray.origin, ray.direction);
    if (!sphere_ray_is_usable(&sphere_ray)) {
        return false;
    }
    if (features & TRACE_PLANES) {
        for (uint32_t i = 0; i < g->plane_count; i++) {
            double t = query_plane_root(g, i, &sphere_ray, start);
            if (t > 0.0 && t < t_max) {
                return true;
            }
        }
    }
    if (features & TRACE_ELLIPSOIDS) {
        for (uint32_t i = 0; i < g->ellipsoid_count; i++) {
            bool inside;
            double t = query_ellipsoid_root(g, i, &sphere_ray, start, &inside);
            if (t > 0.0 && t < t_max) {
                return true;
            }
        }
    }
    if ((features & TRACE_ANY_SPHERES) && query_spheres_occluded(g, features, &sphere_ray, start, t_max)) {
        return true;
    }
    return (features & TRACE_PARTS) && shapes_occluded(&g->shapes, &ray, start, t_max);
}

// Where the ray hit: the point put back onto the surface, its normal and its material.
RT_ALWAYS_INLINE Surface geometry_surface(const Geometry *g, unsigned features, Ray ray, Hit hit)
{
    uint32_t index = shape_index(hit.shape);
    ShapeKind kind = shape_kind(hit.shape);
    if ((features & TRACE_PLANES) && kind == SHAPE_PLANE) {
        const PlaneEntry *plane = &g->planes[index];
        return (Surface){plane_point(&plane->shape, ray, hit.t), plane->shape.normal, plane->info.material,
                         plane->info.order};
    }
    if ((features & TRACE_ELLIPSOIDS) && kind == SHAPE_ELLIPSOID) {
        const EllipsoidEntry *ellipsoid = &g->ellipsoids[index];
        Surface surface = {.material = ellipsoid->info.material, .order = ellipsoid->info.order};
        ellipsoid_surface(&ellipsoid->shape, ray, hit.t, &surface.point, &surface.normal);
        return surface;
    }
    if ((features & TRACE_PARTS) && kind == SHAPE_PART) {
        return shapes_surface(&g->shapes, &ray, &hit);
    }
    Ball ball = sphere_table_ball(&g->spheres, index);
    Vec3 normal = sphere_normal(ray, &ball, hit.t);
    Vec3 point = vec3_add_scaled(ball.centre, sqrt(ball.radius_squared), normal);
    return (Surface){point, normal, g->spheres.info[index].material, g->spheres.info[index].order};
}

#endif
