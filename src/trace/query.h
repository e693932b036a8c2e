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

// Whether there are primitives: also where a kernel may have some, a scene without them takes the ways of spheres and
// planes.
RT_ALWAYS_INLINE bool query_has_primitives(const Geometry *g, unsigned features)
{
    return (features & TRACE_PRIMITIVES) && (g->features & TRACE_PRIMITIVES);
}

// The sphere of the table that the ray starts on, and whether it goes into it.
typedef struct StartSphere {
    uint32_t slot; // SLOT_NONE: none
    bool inward;
    SphereData ball; // equals none when there is none
} StartSphere;

// Equal spheres, declared twice, are one surface, also where one of them is clipped or in a composite.
RT_ALWAYS_INLINE StartSphere query_start_sphere(const Geometry *g, unsigned features, RayStart start)
{
    StartSphere on = {SLOT_NONE, start.inward, {{0.0, 0.0, 0.0}, (double)NAN}};
    if (start.shape != SHAPE_NONE && shape_kind(start.shape) == SHAPE_SPHERE) {
        on.slot = shape_index(start.shape);
    } else if ((features & TRACE_PRIMITIVES) && starts_on_primitive(start)) {
        const PreparedPrimitive *primitive = table_primitive(&g->shapes, start.shape);
        on.slot = primitive->twin;
        on.inward = start.inward != primitive->flips;
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
    g->kernels->closest(&g->spheres, ray, on.slot, nearest);
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
    return g->kernels->occluded(&g->spheres, ray, on.slot, t_max);
}

// Whether the ray starts on another surface that a plane may coincide with but for rounding. It has passed what lies
// within rounding of its start.
RT_ALWAYS_INLINE bool query_starts_beside_plane(const Geometry *g, unsigned features, RayStart start)
{
    if (start.shape == SHAPE_NONE) {
        return false;
    }
    if ((features & TRACE_PRIMITIVES) && starts_on_primitive(start)) {
        return table_primitive(&g->shapes, start.shape)->family & FAMILY_STRAIGHT;
    }
    return shape_kind(start.shape) == SHAPE_PLANE;
}

// How far along the ray its start may be off the surface that it starts on, where others may coincide with that. Less
// than 0 where only primitives may, which ask for it when they need it.
RT_ALWAYS_INLINE double query_start_error(const Geometry *g, unsigned features, const SphereRay *ray, RayStart start)
{
    Ray own = {ray->origin, ray->direction};
    if ((features & TRACE_PRIMITIVES) && starts_on_primitive(start)) {
        return g->plane_count > 0 ? shapes_start_error(&g->shapes, &own, start) : -1.0;
    }
    bool is_plane = (features & TRACE_PLANES) && start.shape != SHAPE_NONE && shape_kind(start.shape) == SHAPE_PLANE;
    bool may_coincide = query_has_primitives(g, features) || g->plane_count > 1;
    return is_plane && may_coincide ? plane_crossing_error(&g->planes[shape_index(start.shape)].shape, own.origin, own.direction, 0.0) : 0.0;
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

// What rounding may do to a plane's root. Only where there is something that it may coincide with: 0 else.
RT_ALWAYS_INLINE double query_plane_error(const Geometry *g, unsigned features, uint32_t index, const SphereRay *ray,
                                          double t)
{
    bool may_coincide = query_has_primitives(g, features) || g->plane_count > 1;
    return may_coincide ? plane_crossing_error(&g->planes[index].shape, ray->origin, ray->direction, t) : 0.0;
}

// Whether a plane that is crossed at t is met on a way to t_max: it is not when the end lies on it but for rounding.
RT_ALWAYS_INLINE bool query_plane_before(const PlaneShape *shape, const SphereRay *ray, double t, double t_max)
{
    return t_max < (double)INFINITY
               ? t + plane_crossing_error(shape, ray->origin, ray->direction, t) <= way_end(t_max)
               : t < t_max;
}

RT_ALWAYS_INLINE void query_planes_offer(const Geometry *g, unsigned features, const SphereRay *ray, RayStart start,
                                         double start_error, double t_max, Foremost *first)
{
    bool is_beside = query_starts_beside_plane(g, features, start);
    for (uint32_t i = 0; i < g->plane_count; i++) {
        const PlaneShape *shape = &g->planes[i].shape;
        bool inside = vec3_dot(shape->normal, ray->direction) > 0.0;
        double t = query_plane_root(g, i, ray, start);
        double error = query_plane_error(g, features, i, ray, t);
        if (t > (is_beside ? error + start_error : 0.0) && query_plane_before(shape, ray, t, t_max)) {
            foremost_offer(first, t, root_span(t, error), shape_id(SHAPE_PLANE, i), inside, g->planes[i].info.order);
        }
    }
}

// Brings the nearest of the spheres, which has an order if it is one, up to date with all other shapes.
RT_ALWAYS_INLINE void query_others_closest(const Geometry *g, unsigned features, const SphereRay *ray, RayStart start, double t_max, uint32_t order, Hit *hit)
{
    if (!(features & (TRACE_PLANES | TRACE_PRIMITIVES))) {
        return;
    }
    bool has_primitives = query_has_primitives(g, features);
    double start_error = query_start_error(g, features, ray, start);
    Foremost first = foremost_start(hit, order, t_max);
    for (;;) {
        if (features & TRACE_PLANES) {
            query_planes_offer(g, features, ray, start, start_error, t_max, &first);
        }
        if (has_primitives) {
            g->kernels->shapes_closest(&g->shapes, &(Ray){ray->origin, ray->direction}, start, start_error, &first);
        }
        if (RT_LIKELY(!first.is_torn)) {
            break;
        }
        first = foremost_restart(hit, order, t_max, first.limit);
    }
    *hit = first.hit;
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
    query_others_closest(g, features, &sphere_ray, start, t_max, nearest.order, &nearest.hit);
    *hit = nearest.hit;
    return nearest.hit.shape != SHAPE_NONE;
}

// The only other shape is a plane, which nothing coincides with.
RT_ALWAYS_INLINE bool query_has_one_plane(const Geometry *g, unsigned features)
{
    return !query_has_primitives(g, features) && (features & TRACE_PLANES) && g->plane_count == 1;
}

// Brings the hit of a tile's ray up to date with all shapes but spheres.
RT_ALWAYS_INLINE void query_tile_ray_others(const Geometry *g, unsigned features, const SphereTile *tile, unsigned i,
                                            TileHits *hits)
{
    bool is_met = hits->met >> i & 1;
    uint32_t order = is_met ? g->spheres.info[shape_index(hits->shape[i])].order : 0;
    Hit hit = {hits->t[i], hits->shape[i], hits->inside >> i & 1};
    SphereRay ray = sphere_tile_ray(tile, i);
    query_others_closest(g, features, &ray, RAY_START_CAMERA, (double)INFINITY, order, &hit);
    tile_hit_set(hits, i, &hit);
}

// The first of the spheres and planes that a tile's ray meets.
RT_ALWAYS_INLINE void query_tile_ray_planes(const Geometry *g, const SphereTile *tile, unsigned i, TileForemost *all)
{
    TileHits *hits = all->hits;
    Hit hit = {hits->t[i], hits->shape[i], hits->inside >> i & 1};
    SphereRay ray = sphere_tile_ray(tile, i);
    Foremost first = foremost_start(&hit, all->order[i], (double)INFINITY);
    query_planes_offer(g, TRACE_ALL_FEATURES, &ray, RAY_START_CAMERA, 0.0, (double)INFINITY, &first);
    all->torn |= (uint64_t)first.is_torn << i;
    all->from[i] = first.from;
    all->limit[i] = first.limit;
    all->beaten[i] = first.beaten;
    all->order[i] = first.order;
    tile_hit_set(hits, i, &first.hit);
}

// Brings the hits of a tile up to date with primitives, and planes if there are any. Not inline, for its size.
static __attribute__((noinline, unused)) void query_tile_primitives(const Geometry *g, const SphereTile *tile,
                                                                    TileHits *hits)
{
    TileForemost first; // not cleared as a whole
    TileHits known = *hits;
    first.hits = hits;
    first.torn = 0;
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        first.from[i] = first.limit[i] = hits->t[i];
        first.beaten[i] = (double)INFINITY;
        first.order[i] = 0;
    }
    for (uint64_t met = hits->met; met; met &= met - 1) {
        unsigned i = (unsigned)__builtin_ctzll(met);
        first.order[i] = g->spheres.info[shape_index(hits->shape[i])].order;
    }
    uint64_t open = g->plane_count > 0 ? UINT64_MAX : 0;
    if (g->plane_count == 1) {
        const PlaneEntry *plane = &g->planes[0];
        open = g->kernels->plane_foremost(&plane->shape, shape_id(SHAPE_PLANE, 0), plane->info.order, tile, &first);
    }
    for (; open; open &= open - 1) {
        query_tile_ray_planes(g, tile, (unsigned)__builtin_ctzll(open), &first);
    }
    g->kernels->shapes_closest_tile(&g->shapes, tile, &first);
    for (uint64_t torn = first.torn; RT_UNLIKELY(torn); torn &= torn - 1) {
        unsigned i = (unsigned)__builtin_ctzll(torn);
        Hit hit = {known.t[i], known.shape[i], known.inside >> i & 1};
        tile_hit_set(hits, i, &hit);
        query_tile_ray_others(g, TRACE_ALL_FEATURES, tile, i, hits);
    }
}

// Brings the hits of a tile up to date with all shapes but spheres.
RT_ALWAYS_INLINE void query_tile_others(const Geometry *g, unsigned features, const SphereTile *tile, TileHits *hits)
{
    if (query_has_primitives(g, features)) {
        query_tile_primitives(g, tile, hits);
        return;
    }
    uint64_t open = (features & TRACE_PLANES) && g->plane_count > 0 ? UINT64_MAX : 0;
    if (query_has_one_plane(g, features)) {
        open = g->kernels->plane_closest(&g->planes[0].shape, shape_id(SHAPE_PLANE, 0), tile, hits);
    }
    for (; open; open &= open - 1) {
        query_tile_ray_others(g, features, tile, (unsigned)__builtin_ctzll(open), hits);
    }
}

// What the rays of a tile, which may not be usable, meet of anything.
RT_ALWAYS_INLINE void query_tile_closest(const Geometry *g, unsigned features, const SphereTile *tile, bool is_usable,
                                         TileHits *hits)
{
    if (is_usable && (features & TRACE_ANY_SPHERES) && g->kernels->closest_tile(&g->spheres, tile, hits)) {
        query_tile_others(g, features, tile, hits);
        return;
    }
    hits->met = hits->inside = 0;
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        SphereRay ray = sphere_tile_ray(tile, i);
        Hit hit = {(double)INFINITY, SHAPE_NONE, false};
        if (!geometry_closest(g, features, (Ray){ray.origin, ray.direction}, RAY_START_CAMERA, (double)INFINITY,
                              &hit)) {
            hit.shape = SHAPE_NONE;
        }
        tile_hit_set(hits, i, &hit);
    }
}

// Whether it is certain that the rays of a view meet nothing.
RT_ALWAYS_INLINE bool geometry_view_passes(const Geometry *g, unsigned features, const TileView *view,
                                           const double u[TILE_RAYS], const double v[TILE_RAYS])
{
    bool has_others = query_has_primitives(g, features) || ((features & TRACE_PLANES) && g->plane_count > 0);
    return (features & TRACE_SPHERES) && !has_others && g->kernels->view_passes(&g->spheres, view, u, v);
}

// What 64 camera rays meet: those of a view, in rows of eight neighbours, which are put into `tile`: each is
// vec3_normalize of direction + (u right - v up). The same bits as geometry_closest gives ray by ray.
RT_ALWAYS_INLINE void geometry_closest_view(const Geometry *g, unsigned features, const TileView *view,
                                            const double u[TILE_RAYS], const double v[TILE_RAYS], SphereTile *tile,
                                            TileHits *hits)
{
    bool is_usable = g->kernels->view_tile(view, u, v, tile);
    query_tile_closest(g, features, tile, is_usable, hits);
}

// Whether there are but few spheres, and a plane at most.
RT_ALWAYS_INLINE bool query_is_few(const Geometry *g, unsigned features)
{
    bool has_others = query_has_primitives(g, features) || ((features & TRACE_PLANES) && g->plane_count > 1);
    return !has_others && sphere_table_is_few(&g->spheres);
}

// What rays that start apart from each other meet, as geometry_closest says of each; there is at least one. `use`: as of
// a RayStart, of all.
RT_ALWAYS_INLINE void geometry_closest_secondary(const Geometry *g, unsigned features, uint8_t use,
                                                 SecondaryRays *rays, TileHits *hits)
{
    uint64_t open = ~UINT64_C(0) >> (TILE_RAYS - rays->count);
    hits->met = hits->inside = 0;
    bool has_plane = query_has_one_plane(g, features);
    if (query_is_few(g, features)) {
        open &= ~g->kernels->closest_secondary(&g->spheres, has_plane ? &g->planes[0].shape : NULL,
                                               shape_id(SHAPE_PLANE, 0), rays, hits);
    }
    for (; open; open &= open - 1) {
        unsigned i = (unsigned)__builtin_ctzll(open);
        RayStart start = {rays->start[i], rays->inward >> i & 1, use};
        Hit hit;
        if (!geometry_closest(g, features, secondary_ray(rays, i), start, (double)INFINITY, &hit)) {
            hit = (Hit){(double)INFINITY, SHAPE_NONE, false};
        }
        tile_hit_set(hits, i, &hit);
    }
}

RT_ALWAYS_INLINE bool query_planes_occluded(const Geometry *g, unsigned features, const SphereRay *ray, RayStart start,
                                            double start_error, double t_max)
{
    bool is_beside = query_starts_beside_plane(g, features, start);
    for (uint32_t i = 0; i < g->plane_count; i++) {
        double t = query_plane_root(g, i, ray, start);
        if (t > (is_beside ? query_plane_error(g, features, i, ray, t) + start_error : 0.0) &&
            query_plane_before(&g->planes[i].shape, ray, t, t_max)) {
            return true;
        }
    }
    return false;
}

// A ray from a start to something at t_max.
typedef struct ShadowRay {
    Ray ray;
    RayStart start;
    double t_max;
} ShadowRay;

// True when anything is met at 0 < t < t_max; `asks_spheres` and `asks_primitives` when that may be one. *blocker, a
// primitive or a composite, is asked first: nothing but time depends on it.
RT_ALWAYS_INLINE bool query_occluded(const Geometry *g, unsigned features, bool asks_spheres, bool asks_primitives,
                                     const ShadowRay *asked, uint32_t *blocker)
{
    const Ray ray = asked->ray;
    const RayStart start = asked->start;
    const double t_max = asked->t_max;
    SphereRay sphere_ray = sphere_ray_make(ray.origin, ray.direction);
    if (!sphere_ray_is_usable(&sphere_ray)) {
        return false;
    }
    double start_error = query_start_error(g, features, &sphere_ray, start);
    if ((features & TRACE_PRIMITIVES) && *blocker != NO_BLOCKER &&
        g->kernels->shape_blocks(&g->shapes, &ray, start, start_error, t_max, *blocker)) {
        return true;
    }
    if ((features & TRACE_PLANES) && query_planes_occluded(g, features, &sphere_ray, start, start_error, t_max)) {
        return true;
    }
    if ((features & TRACE_ANY_SPHERES) && asks_spheres && query_spheres_occluded(g, features, &sphere_ray, start, t_max)) {
        return true;
    }
    return query_has_primitives(g, features) && asks_primitives &&
           g->kernels->shapes_occluded(&g->shapes, &ray, start, start_error, t_max, blocker);
}

// True when anything is met at 0 < t < t_max.
RT_ALWAYS_INLINE bool geometry_occluded(const Geometry *g, unsigned features, Ray ray, RayStart start, double t_max)
{
    uint32_t blocker = NO_BLOCKER;
    return query_occluded(g, features, true, true, &(ShadowRay){ray, start, t_max}, &blocker);
}

// The same of one of several ways that have much in common: what was in the way of one is likely in that of the next.
// *blocker keeps that from one to the next; NO_BLOCKER before the first.
RT_ALWAYS_INLINE bool geometry_occluded_again(const Geometry *g, unsigned features, Ray ray, RayStart start,
                                              double t_max, uint32_t *blocker)
{
    return query_occluded(g, features, true, true, &(ShadowRay){ray, start, t_max}, blocker);
}

// Of surfaces that a plane is before, those whose way does not end on it.
RT_ALWAYS_INLINE uint64_t query_plane_before_surfaces(const PlaneShape *shape, const TileSurfaces *from,
                                                      const SurfaceRays *rays, uint64_t occluded)
{
    uint64_t before = 0;
    for (; occluded; occluded &= occluded - 1) {
        int i = __builtin_ctzll(occluded);
        Vec3 direction = vec3(rays->towards[0][i], rays->towards[1][i], rays->towards[2][i]);
        SphereRay ray = sphere_ray_make(tile_surface_point(from, i), direction);
        double t = plane_root(shape, ray.origin, ray.direction);
        before |= (uint64_t)query_plane_before(shape, &ray, t, rays->distance[i]) << i;
    }
    return before;
}

// The surfaces of `asked` that are on no primitive which equals a sphere.
RT_ALWAYS_INLINE uint64_t query_without_twins(const Geometry *g, const TileSurfaces *from, uint64_t asked)
{
    uint64_t others = asked;
    for (; asked; asked &= asked - 1) {
        int i = __builtin_ctzll(asked);
        bool has_twin =
            shape_is_on_primitive(from->shape[i]) && table_primitive(&g->shapes, from->shape[i])->twin != SLOT_NONE;
        others &= ~((uint64_t)has_twin << i);
    }
    return others;
}

// The surfaces, of those asked for, that spheres or primitives are known to be before. Spheres of those that are
// `left`, and parts of `left_primitives`, are to be asked one by one. Not inline: rare, and large.
static __attribute__((noinline, unused)) uint64_t query_primitives_occluded(const Geometry *g, const TileSurfaces *from,
                                                                            const SurfaceRays *rays, uint64_t asked,
                                                                            uint64_t *left, uint64_t *left_primitives)
{
    uint64_t occluded = 0;
    double start_error[TILE_RAYS];
    *left = 0;
    if (g->spheres.count > 0) {
        // Where a primitive equals a sphere, that is passed over: ray by ray.
        uint64_t grouped = query_without_twins(g, from, asked);
        occluded = g->kernels->occluded_surfaces(&g->spheres, from, rays, grouped, left);
        *left |= asked & ~grouped;
    }
    for (uint64_t rest = asked & ~occluded; rest; rest &= rest - 1) {
        int i = __builtin_ctzll(rest);
        Vec3 direction = lane_get(rays->towards, (unsigned)i);
        SphereRay ray = sphere_ray_make(tile_surface_point(from, i), direction);
        RayStart start = {from->shape[i], false, HIDDEN_SHADOW};
        start_error[i] = starts_on_primitive(start) ? -1.0 : query_start_error(g, TRACE_ALL_FEATURES, &ray, start);
    }
    uint64_t open = asked & ~occluded;
    return occluded | g->kernels->shapes_occluded_surfaces(&g->shapes, from, rays, start_error, open, left_primitives);
}

// The surfaces, of those asked for, that planes may be before. Beside primitives less may be met of a plane than lies
// between the ends of a way, never more.
RT_ALWAYS_INLINE uint64_t query_planes_may_occlude(const Geometry *g, unsigned features, const TileSurfaces *from,
                                                   const SurfaceRays *rays, uint64_t asked)
{
    if (!(features & TRACE_PLANES) || g->plane_count == 0 || !asked) {
        return 0;
    }
    return g->plane_count == 1
               ? asked & g->kernels->plane_occluded(&g->planes[0].shape, shape_id(SHAPE_PLANE, 0), from, rays)
               : asked;
}

// The surfaces, of those asked for, that anything is before on their way to a point; `together` when that is the same
// one. The same as geometry_occluded says of each.
RT_ALWAYS_INLINE uint64_t geometry_occluded_surfaces(const Geometry *g, unsigned features, const TileSurfaces *from,
                                                     const SurfaceRays *rays, bool together, uint64_t asked)
{
    uint64_t occluded = 0, left = asked;
    bool has_one_plane = query_has_one_plane(g, features);
    if (has_one_plane) {
        occluded = asked & g->kernels->plane_occluded(&g->planes[0].shape, shape_id(SHAPE_PLANE, 0), from, rays);
        occluded = query_plane_before_surfaces(&g->planes[0].shape, from, rays, occluded);
        left &= ~occluded;
    }
    bool has_primitives = query_has_primitives(g, features);
    uint64_t left_primitives = has_primitives ? asked : 0;
    if (together && !has_primitives) {
        occluded |= g->kernels->occluded_surfaces(&g->spheres, from, rays, left, &left);
    } else if (together) {
        occluded |= query_primitives_occluded(g, from, rays, asked, &left, &left_primitives);
    }
    uint64_t left_planes = query_planes_may_occlude(g, features, from, rays, has_one_plane ? 0 : asked);
    uint32_t blocker = NO_BLOCKER;
    for (uint64_t open = (left | left_primitives | left_planes) & ~occluded; open; open &= open - 1) {
        int i = __builtin_ctzll(open);
        Vec3 direction = vec3(rays->towards[0][i], rays->towards[1][i], rays->towards[2][i]);
        bool is_inward = vec3_dot(tile_surface_outward(from, i), direction) < 0.0;
        const ShadowRay ray = {{tile_surface_point(from, i), direction},
                               {from->shape[i], is_inward, HIDDEN_SHADOW},
                               rays->distance[i]};
        occluded |= (uint64_t)query_occluded(g, features, left >> i & 1, left_primitives >> i & 1, &ray, &blocker) << i;
    }
    return occluded;
}

// What lies on the ways of surfaces that are asked for; returns those for which that is known. The others are to be
// walked.
RT_ALWAYS_INLINE uint64_t geometry_crossed(const Geometry *g, unsigned features, const TileSurfaces *from,
                                           const SurfaceRays *rays, uint64_t asked, TileCrossings *crossings)
{
    if (!query_is_few(g, features)) {
        return 0;
    }
    const PlaneShape *plane = query_has_one_plane(g, features) ? &g->planes[0].shape : NULL;
    return g->kernels->crossed(&g->spheres, plane, shape_id(SHAPE_PLANE, 0), from, rays, asked, crossings);
}

// The same of one ray: whether that is known.
RT_ALWAYS_INLINE bool geometry_ray_crossed(const Geometry *g, unsigned features, Ray ray, RayStart start, double t_max,
                                           RayCrossings *crossings)
{
    if (!query_is_few(g, features)) {
        return false;
    }
    const PlaneShape *plane = query_has_one_plane(g, features) ? &g->planes[0].shape : NULL;
    return g->kernels->ray_crossed(&g->spheres, plane, shape_id(SHAPE_PLANE, 0), &ray, start, t_max, crossings);
}

#endif
