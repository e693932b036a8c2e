// The light of a tile's camera rays and of all that continues from what they meet, level by level.
//
// What the rays that continue from the tile's surfaces meet is the tile's next surfaces: a ray is mirrored first, and
// what went through waits. Everything is always-inline and takes the kernel's features as a constant.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_SHADE_TILE_PATHS_H
#define RENDER_SHADE_SHADE_TILE_PATHS_H

#include "render/records/camera.h"
#include "render/shade/shade.h"
#include "render/shade/shade_tile.h"

// Whether rays of a scene are shaded by tiles.
RT_ALWAYS_INLINE bool shade_tile_may(const Prepared *p, unsigned features)
{
    unsigned both = RENDER_TRANSPARENCY | RENDER_REFLECTION;
    bool may_wait = (features & both) == both && (p->features & both) == both;
    return !(features & ~(unsigned)SHADE_TILE_FEATURES) && (!may_wait || p->max_trace_level <= SHADE_WAITING_MOST);
}

// Begins with camera rays, which show all of what their surfaces shine.
RT_ALWAYS_INLINE void shade_paths_begin(unsigned features, const TileSurfaces *surfaces, TilePaths *paths)
{
    paths->resting = 0;
    for (int i = 0; i < surfaces->count; i++) {
        unsigned ray = surfaces->ray[i];
        paths->share[ray] = rgb_grey(1.0);
        paths->weight[ray] = 1.0;
        paths->level[ray] = 1;
        if (features & RENDER_TRANSPARENCY) {
            paths->passed[ray] = 0;
            paths->count[ray] = 0;
        }
    }
}

// Adds what the surfaces shine.
RT_ALWAYS_INLINE void shade_paths_gather(const LightTile *tile, const TilePaths *paths, bool is_first, Rgb *light)
{
    for (int i = 0; i < tile->surfaces.count; i++) {
        unsigned ray = tile->surfaces.ray[i];
        Rgb own = rgb(tile->light[0][i], tile->light[1][i], tile->light[2][i]);
        light[ray] = is_first ? rgb_add(rgb_grey(0.0), own) : rgb_add(light[ray], rgb_mul(paths->share[ray], own));
    }
}

// What a surface sends on: shade_plain says the same of single rays.
RT_ALWAYS_INLINE ScatterRecord shade_tile_secondary(const Prepared *p, unsigned features, const LightTile *tile,
                                                    const TilePaths *paths, int i)
{
    bool is_clear = features & RENDER_TRANSPARENCY;
    ScatterRecord scatter = {.through = is_clear ? paths->through[i] : rgb_grey(0.0),
                             .reflectance = rgb_grey(0.0),
                             .reflection_exponent = 1.0,
                             .part = 1.0,
                             .refraction = tile->finish[i]->refraction,
                             .conserves_energy = tile->finish[i]->conserves_energy};
    if ((features & RENDER_REFLECTION) && tile->finish[i]->reflects) {
        Rgb pigment = rgb(tile->pigment[0][i], tile->pigment[1][i], tile->pigment[2][i]);
        ShadeMaterial material = {pigment, pigment, tile->finish[i], 0};
        ShadingPoint at = shade_tile_point(tile, i, 0, NULL);
        shade_set_mirror(p, features, &material, &at, &scatter);
    }
    return scatter;
}

// Whether light continues through a surface: then as what waits.
RT_ALWAYS_INLINE bool shade_paths_pass(const Prepared *p, const LightTile *tile, const TilePaths *paths, int i,
                                       const ScatterRecord *scatter, RenderStatistics *statistics,
                                       TileWaiting *through)
{
    const TileSurfaces *surfaces = &tile->surfaces;
    unsigned ray = surfaces->ray[i];
    Rgb share;
    if (rgb_is_black(shade_sent_through(scatter))) {
        return false;
    }
    const RayAge age = {paths->weight[ray], paths->level[ray], paths->passed[ray]};
    if (!shade_goes_on(p, scatter, age, &share, &through->weight)) {
        shade_note_cut(p, paths->level[ray], rgb_mul(paths->share[ray], shade_sent_through(scatter)), statistics);
        return false;
    }
    through->ray = (Ray){tile_surface_point(surfaces, i), lane_get(surfaces->direction, (unsigned)i)};
    through->start = surfaces->shape[i];
    through->inward = !(surfaces->inside >> i & 1);
    through->share = rgb_mul(paths->share[ray], share);
    through->level = paths->level[ray];
    through->passed = paths->passed[ray] + 1;
    statistics->transmitted_rays++;
    return true;
}

// Whether a surface mirrors its ray and that is followed: then its share and weight are those of what continues.
RT_ALWAYS_INLINE bool shade_paths_reflect(const Prepared *p, unsigned features, unsigned ray,
                                          const ScatterRecord *scatter, TilePaths *paths, RenderStatistics *statistics)
{
    if (scatter->reflection_weight == 0.0) {
        return false;
    }
    Rgb share = rgb_mul(paths->share[ray], scatter->reflectance);
    double weight = paths->weight[ray] * scatter->reflection_weight;
    if (!shade_is_followed(p, paths->level[ray], weight)) {
        shade_note_cut(p, paths->level[ray], share, statistics);
        return false;
    }
    paths->share[ray] = share;
    paths->weight[ray] = weight;
    paths->level[ray]++;
    if (features & RENDER_TRANSPARENCY) {
        paths->passed[ray] = 0;
    }
    statistics->reflected_rays++;
    return true;
}

// A ray that goes through a surface now.
RT_ALWAYS_INLINE void shade_paths_resume(const TileWaiting *through, unsigned ray, TilePaths *paths,
                                         SecondaryRays *rays)
{
    paths->share[ray] = through->share;
    paths->weight[ray] = through->weight;
    paths->level[ray] = through->level;
    paths->passed[ray] = through->passed;
    secondary_ray_add(rays, through->ray.origin, through->ray.direction, through->start, through->inward);
}

// The rays that continue from the tile's surfaces, and of those that meet nothing more, what waited last; `own` says
// which of the tile's they are.
RT_ALWAYS_INLINE void shade_paths_send(const Prepared *p, unsigned features, TileScratch *scratch,
                                       RenderStatistics *statistics, SecondaryRays *rays, uint8_t own[TILE_RAYS])
{
    const LightTile *tile = &scratch->tile;
    TilePaths *paths = &scratch->paths;
    const TileSurfaces *surfaces = &tile->surfaces;
    _Alignas(64) double mirrored[3][TILE_RAYS];
    bool has_mirrored = false, is_clear = features & RENDER_TRANSPARENCY;
    for (int i = 0; i < surfaces->count; i++) {
        unsigned ray = surfaces->ray[i];
        if (!is_clear && !tile->finish[i]->reflects) {
            continue;
        }
        TileWaiting through;
        ScatterRecord scatter = shade_tile_secondary(p, features, tile, paths, i);
        bool passes = is_clear && shade_paths_pass(p, tile, paths, i, &scatter, statistics, &through);
        own[rays->count] = (uint8_t)ray;
        if ((features & RENDER_REFLECTION) && shade_paths_reflect(p, features, ray, &scatter, paths, statistics)) {
            if (!has_mirrored) {
                p->tile_lights->mirror(tile, mirrored);
                has_mirrored = true;
            }
            if (passes) {
                paths->waiting[paths->count[ray]++][ray] = through;
            }
            secondary_ray_add(rays, tile_surface_point(surfaces, i), lane_get(mirrored, (unsigned)i),
                              surfaces->shape[i], surfaces->inside >> i & 1);
        } else if (passes) {
            shade_paths_resume(&through, ray, paths, rays);
        } else {
            paths->resting |= UINT64_C(1) << ray;
        }
    }
    for (; is_clear && (features & RENDER_REFLECTION) && paths->resting; paths->resting &= paths->resting - 1) {
        unsigned ray = (unsigned)__builtin_ctzll(paths->resting);
        if (paths->count[ray] > 0) {
            own[rays->count] = (uint8_t)ray;
            shade_paths_resume(&paths->waiting[--paths->count[ray]][ray], ray, paths, rays);
        }
    }
}

// The surfaces that rays have met, of which `own` says which of the tile's they are.
RT_ALWAYS_INLINE void shade_paths_meet(const Prepared *p, unsigned features, const SecondaryRays *rays,
                                       const TileHits *hits, const uint8_t own[TILE_RAYS], TileShading *shading)
{
    TileSurfaces *surfaces = &shading->scratch->tile.surfaces;
    surfaces->count = 0;
    if (hits->met) {
        geometry_secondary_surfaces(p->geometry, features, rays, hits, surfaces, shading->material);
    }
    for (int i = 0; i < surfaces->count; i++) {
        surfaces->ray[i] = own[surfaces->ray[i]];
    }
}

// Takes what the rays that continue meet for the tile's surfaces. Adds the light of those that meet nothing. False when
// none continues.
RT_ALWAYS_INLINE bool shade_paths_next(const Prepared *p, unsigned features, TileShading *shading)
{
    TilePaths *paths = &shading->scratch->paths;
    Rgb *light = shading->light;
    uint8_t own[TILE_RAYS];
    SecondaryRays rays;
    TileHits hits;
    rays.count = 0;
    rays.inward = 0;
    shade_paths_send(p, features, shading->scratch, shading->statistics, &rays, own);
    if (rays.count == 0) {
        return false;
    }
    geometry_closest_secondary(p->geometry, features, HIDDEN_MIRROR, &rays, &hits);
    paths->resting = 0;
    for (uint64_t missed = ~hits.met & ~UINT64_C(0) >> (TILE_RAYS - rays.count); missed; missed &= missed - 1) {
        unsigned ray = own[__builtin_ctzll(missed)];
        light[ray] = rgb_add(light[ray], rgb_mul(paths->share[ray], p->background));
        paths->resting |= UINT64_C(1) << ray;
    }
    shade_paths_meet(p, features, &rays, &hits, own, shading);
    return true;
}

// The light of what the camera rays have met, and of all that continues from there.
RT_ALWAYS_INLINE void shade_paths(const Prepared *p, unsigned features, TileShading *shading)
{
    TileScratch *scratch = shading->scratch;
    LightTile *tile = &scratch->tile;
    TilePaths *paths = &scratch->paths;
    unsigned onward = features & p->features & (RENDER_TRANSPARENCY | RENDER_REFLECTION);
    for (bool is_first = true;; is_first = false) {
        if (tile->surfaces.count > 0) {
            shade_tile_begin(p, features, tile, shading->material, paths->through);
            shade_tile_lights(p, features, scratch, shading->streams, shading->statistics);
            shade_paths_gather(tile, paths, is_first, shading->light);
        }
        if (is_first && onward) {
            shade_paths_begin(features, &tile->surfaces, paths);
        }
        if (!onward || !shade_paths_next(p, features, shading)) {
            return;
        }
    }
}

// What rays of a view meet; false when nothing.
RT_ALWAYS_INLINE bool shade_tile_view(const Prepared *p, unsigned features, const TileView *view,
                                      const KernelPlaces *places, uint64_t wanted, TileShading *shading)
{
    SphereTile *rays = &shading->scratch->rays;
    TileHits hits;
    Rgb background = rgb_add(rgb_grey(0.0), p->background);
    for (int i = 0; i < TILE_RAYS; i++) {
        shading->light[i] = background;
    }
    if (geometry_view_passes(p->geometry, features, view, places->u, places->v)) {
        return false;
    }
    geometry_closest_view(p->geometry, features, view, places->u, places->v, rays, &hits);
    uint64_t met = hits.met & wanted;
    if (!met) {
        return false;
    }
    geometry_tile_surfaces(p->geometry, features, rays, &hits, met, &shading->scratch->tile.surfaces,
                           shading->material);
    return true;
}

// What rays of other cameras meet, each of which starts at a place of its own; false when nothing.
RT_ALWAYS_INLINE bool shade_tile_apart(const Prepared *p, unsigned features, const KernelPlaces *places,
                                       uint64_t wanted, TileShading *shading)
{
    uint8_t own[TILE_RAYS];
    SecondaryRays rays;
    TileHits hits;
    rays.count = 0;
    rays.inward = 0;
    for (; wanted; wanted &= wanted - 1) {
        int i = __builtin_ctzll(wanted);
        Ray ray;
        bool is_seen = camera_place_ray(&p->camera, places, i, &ray);
        shading->light[i] = is_seen ? rgb_add(rgb_grey(0.0), p->background) : rgb_grey(0.0);
        if (is_seen) {
            own[rays.count] = (uint8_t)i;
            secondary_ray_add(&rays, ray.origin, ray.direction, SHAPE_NONE, false);
        }
    }
    if (rays.count == 0) {
        return false;
    }
    geometry_closest_secondary(p->geometry, features, HIDDEN_CAMERA, &rays, &hits);
    shade_paths_meet(p, features, &rays, &hits, own, shading);
    return hits.met;
}

// The light of camera rays. `view`: of a perspective camera without a lens; NULL: of another one.
RT_ALWAYS_INLINE void shade_tile(const Prepared *p, unsigned features, const TileView *view, const KernelPlaces *places,
                                 uint64_t wanted, TileShading *shading)
{
    if (view ? shade_tile_view(p, features, view, places, wanted, shading)
             : shade_tile_apart(p, features, places, wanted, shading)) {
        shade_paths(p, features, shading);
    }
}

#endif
