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

// The sphere of the table that the ray starts on, and whether it goes into it.
typedef struct StartSphere {
    uint32_t slot; // SLOT_NONE: none
    bool inward;
    Ball ball; // equals none when there is none
} StartSphere;

// Equal spheres, declared twice, are one surface, also where one of them is clipped or in a composite.
RT_ALWAYS_INLINE StartSphere query_start_sphere(const Geometry *g, unsigned features, RayStart start)
{
    StartSphere on = {SLOT_NONE, start.inward, {{0.0, 0.0, 0.0}, (double)NAN}};
    if (start.shape != SHAPE_NONE && shape_kind(start.shape) == SHAPE_SPHERE) {
        on.slot = shape_index(start.shape);
    } else if ((features & TRACE_PARTS) && starts_on_part(start)) {
        const Solid *solid = &g->shapes.solids[part_index(start.shape)];
        on.slot = solid->twin;
        on.inward = start.inward != solid->flips;
    }
    if (on.slot != SLOT_NONE) {
        on.ball = sphere_table_ball(&g->spheres, on.slot);
    }
    return on;
}

RT_ALWAYS_INLINE void query_spheres_closest(const Geometry *g, unsigned features, const SphereRay *ray, RayStart start,
                                            Nearest *nearest)
{
    StartSphere on = query_start_sphere(g, features, start);
    if (on.inward && on.slot != SLOT_NONE) {
        nearest_offer(nearest, sphere_root_inward(ray, &on.ball), shape_id(SHAPE_SPHERE, on.slot), true,
                      g->spheres.info[on.slot].order);
    }
    for (uint32_t i = 0; i < g->spheres.loose_count; i++) {
        sphere_slot_closest(&g->spheres, i, ray, &on.ball, nearest);
    }
    if (features & TRACE_SPHERE_BVH) {
        g->kernels->closest(&g->spheres, ray, &on.ball, nearest);
    }
    nearest_settle(&g->spheres, ray, nearest);
}

RT_ALWAYS_INLINE bool query_spheres_occluded(const Geometry *g, unsigned features, const SphereRay *ray,
                                             RayStart start, double t_max)
{
    StartSphere on = query_start_sphere(g, features, start);
    if (on.inward && on.slot != SLOT_NONE) {
        double t = sphere_root_inward(ray, &on.ball);
        if (t > 0.0 && t < t_max) {
            return true;
        }
    }
    for (uint32_t i = 0; i < g->spheres.loose_count; i++) {
        if (sphere_slot_occludes(&g->spheres, i, ray, &on.ball, t_max)) {
            return true;
        }
    }
    return (features & TRACE_SPHERE_BVH) && g->kernels->occluded(&g->spheres, ray, &on.ball, t_max);
}

// Whether the ray starts on another surface that an ellipsoid, or a plane, may coincide with but for rounding. It has
// passed what lies within rounding of its start.
RT_ALWAYS_INLINE bool query_starts_beside(const Geometry *g, unsigned features, RayStart start, ShapeKind kind)
{
    if (start.shape == SHAPE_NONE) {
        return false;
    }
    if ((features & TRACE_PARTS) && starts_on_part(start)) {
        bool is_round = g->shapes.solids[part_index(start.shape)].kind == PART_BALL;
        return is_round == (kind == SHAPE_ELLIPSOID);
    }
    return shape_kind(start.shape) == kind;
}

// How far along the ray its start may be off the surface that it starts on, where others may coincide with that.
RT_ALWAYS_INLINE double query_start_error(const Geometry *g, unsigned features, const SphereRay *ray, RayStart start)
{
    Ray own = {ray->origin, ray->direction};
    if ((features & TRACE_PARTS) && starts_on_part(start)) {
        return shapes_start_error(&g->shapes, &own, start);
    }
    bool is_plane = (features & TRACE_PLANES) && start.shape != SHAPE_NONE && shape_kind(start.shape) == SHAPE_PLANE;
    bool may_coincide = (features & TRACE_PARTS) || g->plane_count > 1;
    return is_plane && may_coincide ? plane_crossing_error(&g->planes[shape_index(start.shape)].shape, own, 0.0) : 0.0;
}

// The root of an ellipsoid that the ray may start on but for rounding, as `object` in its space: a start on it goes in
// or out.
RT_ALWAYS_INLINE double query_ellipsoid_beside(const EllipsoidShape *shape, const SphereRay *ray,
                                               const SphereRay *object, double start_error, double t, bool *inside)
{
    const Ball unit = UNIT_BALL;
    Ray own = {ray->origin, ray->direction};
    if (!(t > 0.0) || t > ellipsoid_crossing_error(shape, &own, t) + start_error) {
        return t;
    }
    double far_side = *inside ? 0.0 : sphere_root_inward(object, &unit);
    *inside = true;
    return far_side > 0.0 && far_side > ellipsoid_crossing_error(shape, &own, far_side) + start_error
               ? far_side
               : 0.0;
}

// The parameter at which an ellipsoid is met, by the rules for spheres; not positive when it is not. `beside`: the
// start's error, NULL when the ray starts on nothing that may coincide with it.
RT_ALWAYS_INLINE double query_ellipsoid_root(const Geometry *g, uint32_t index, const SphereRay *ray, RayStart start,
                                             const double *beside, bool *inside)
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
    double t = sphere_hit(&object, &unit, inside);
    return beside ? query_ellipsoid_beside(shape, ray, &object, *beside, t, inside) : t;
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

// What rounding may do to a plane's or an ellipsoid's root. Only where there is something that they may coincide with:
// 0 else.
RT_ALWAYS_INLINE double query_plane_error(const Geometry *g, unsigned features, uint32_t index, const SphereRay *ray,
                                          double t)
{
    bool may_coincide = (features & TRACE_PARTS) || g->plane_count > 1;
    return may_coincide ? plane_crossing_error(&g->planes[index].shape, (Ray){ray->origin, ray->direction}, t) : 0.0;
}

RT_ALWAYS_INLINE double query_ellipsoid_error(const Geometry *g, unsigned features, uint32_t index,
                                              const SphereRay *ray, double t)
{
    bool may_coincide = (features & TRACE_PARTS) || g->ellipsoid_count > 1;
    Ray own = {ray->origin, ray->direction};
    return may_coincide && t > 0.0 ? ellipsoid_crossing_error(&g->ellipsoids[index].shape, &own, t) : 0.0;
}

// Brings the nearest of the spheres up to date with all other shapes.
RT_ALWAYS_INLINE void query_others_closest(const Geometry *g, unsigned features, const SphereRay *ray, RayStart start,
                                           Nearest *nearest)
{
    double start_error = query_start_error(g, features, ray, start);
    if (features & TRACE_PLANES) {
        bool is_beside = query_starts_beside(g, features, start, SHAPE_PLANE);
        for (uint32_t i = 0; i < g->plane_count; i++) {
            bool inside = vec3_dot(g->planes[i].shape.normal, ray->direction) > 0.0;
            double t = query_plane_root(g, i, ray, start);
            double error = query_plane_error(g, features, i, ray, t);
            if (!is_beside || t > error + start_error) {
                nearest_offer_within(nearest, t, error, shape_id(SHAPE_PLANE, i), inside, g->planes[i].info.order);
            }
        }
    }
    if (features & TRACE_ELLIPSOIDS) {
        bool is_beside = query_starts_beside(g, features, start, SHAPE_ELLIPSOID);
        for (uint32_t i = 0; i < g->ellipsoid_count; i++) {
            bool inside = false;
            double t = query_ellipsoid_root(g, i, ray, start, is_beside ? &start_error : NULL, &inside);
            double error = query_ellipsoid_error(g, features, i, ray, t);
            nearest_offer_within(nearest, t, error, shape_id(SHAPE_ELLIPSOID, i), inside,
                                 g->ellipsoids[i].info.order);
        }
    }
    if (features & TRACE_PARTS) {
        shapes_closest(&g->shapes, &(Ray){ray->origin, ray->direction}, start, start_error, nearest);
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
    Nearest nearest = {{t_max, SHAPE_NONE, false}, 0, false, 0.0};
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
        nearest[i] = (Nearest){{(double)INFINITY, SHAPE_NONE, false}, 0, false, 0.0};
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

// The nearest hits, SHAPE_NONE where there is none, of rays that are free in space, of about unit length, and start at
// one point: 64 camera rays, in rows of eight neighbours. The same bits as geometry_closest gives ray by ray.
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
    double start_error = query_start_error(g, features, &sphere_ray, start);
    if (features & TRACE_PLANES) {
        bool is_beside = query_starts_beside(g, features, start, SHAPE_PLANE);
        for (uint32_t i = 0; i < g->plane_count; i++) {
            double t = query_plane_root(g, i, &sphere_ray, start);
            if (t > (is_beside ? query_plane_error(g, features, i, &sphere_ray, t) + start_error : 0.0) && t < t_max) {
                return true;
            }
        }
    }
    if (features & TRACE_ELLIPSOIDS) {
        bool is_beside = query_starts_beside(g, features, start, SHAPE_ELLIPSOID);
        for (uint32_t i = 0; i < g->ellipsoid_count; i++) {
            bool inside;
            double t = query_ellipsoid_root(g, i, &sphere_ray, start, is_beside ? &start_error : NULL, &inside);
            if (t > 0.0 && t < t_max) {
                return true;
            }
        }
    }
    if ((features & TRACE_ANY_SPHERES) && query_spheres_occluded(g, features, &sphere_ray, start, t_max)) {
        return true;
    }
    return (features & TRACE_PARTS) && shapes_occluded(&g->shapes, &ray, start, start_error, t_max);
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
