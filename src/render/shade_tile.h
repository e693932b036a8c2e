// Light along the camera rays of a tile: the same as render/shade.h gives ray by ray, bit for bit, with the arithmetic
// of the first surface done for some rays at once.
//
// For surfaces of one layer that let nothing through. What mirrors send on is traced ray by ray; what all of it meets is
// the tile's next surfaces. Everything is always-inline and takes the kernel's features as a constant.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_TILE_H
#define RENDER_SHADE_TILE_H

#include "render/sampler_many.h"
#include "render/shade.h"
#include "render/tile_light.h"

// What a kernel may have for its tiles to be shaded so.
enum {
    SHADE_TILE_FEATURES = TRACE_SPHERES | TRACE_SPHERE_BVH | TRACE_PLANES | RENDER_SHADOWS | RENDER_HIGHLIGHTS |
                          RENDER_BRILLIANCE | RENDER_REFLECTION | RENDER_LIGHTS | RENDER_PIGMENTS
};

// Materials, glow, and normals towards the viewer.
RT_ALWAYS_INLINE void shade_tile_begin(const Prepared *p, unsigned features, LightTile *tile,
                                       const MaterialIndex material[TILE_RAYS])
{
    const TileSurfaces *surfaces = &tile->surfaces;
    for (int i = 0; i < surfaces->count; i++) {
        ShadeLayer layer;
        shade_one_layer(p, features, material[i], tile_surface_point(surfaces, i), &layer);
        const PreparedFinish *finish = &p->finishes[layer.finish];
        Rgb pigment = rgbft_rgb(layer.pigment);
        Rgb glow = rgb_mul(pigment, finish->glow);
        const double colour[3] = {pigment.red, pigment.green, pigment.blue};
        const double light[3] = {glow.red, glow.green, glow.blue};
        double sign = surfaces->inside >> i & 1 ? -1.0 : 1.0;
        tile->finish[i] = finish;
        for (int k = 0; k < 3; k++) {
            tile->pigment[k][i] = colour[k];
            tile->light[k][i] = light[k];
            tile->normal[k][i] = sign * surfaces->outward[k][i];
        }
    }
}

// A surface as the functions for single rays want it.
RT_ALWAYS_INLINE ShadePoint shade_tile_point(const LightTile *tile, int i, MaterialIndex material, SampleStream *stream)
{
    const TileSurfaces *from = &tile->surfaces;
    return (ShadePoint){.point = tile_surface_point(from, i),
                        .normal = vec3(tile->normal[0][i], tile->normal[1][i], tile->normal[2][i]),
                        .outward = tile_surface_outward(from, i),
                        .direction = vec3(from->direction[0][i], from->direction[1][i], from->direction[2][i]),
                        .shape = from->shape[i],
                        .material = material,
                        .interior = RECORD_NONE,
                        .ior_ratio = 1.0,
                        .inside = from->inside >> i & 1,
                        .stream = stream};
}

// How strong a light is that is not plain, for those of `lit`; returns those where it is anything.
RT_ALWAYS_INLINE uint64_t shade_tile_strengths(LightTile *tile, const PreparedLight *light, uint64_t lit)
{
    uint64_t left = 0;
    for (; lit; lit &= lit - 1) {
        int i = __builtin_ctzll(lit);
        Vec3 offset = vec3_sub(light->position, tile_surface_point(&tile->surfaces, i));
        tile->strength[i] = light_strength(light, offset, tile->rays.distance[i]);
        tile->share[i] = 1.0;
        left |= (uint64_t)(tile->strength[i] > 0.0) << i;
    }
    return left;
}

// One place of an area for each surface of `asked`, by its stream.
RT_ALWAYS_INLINE void shade_tile_places(const Prepared *p, const LightTile *tile, const PreparedLight *light, uint64_t asked,
                                        SampleStream *streams, SurfaceRays *rays)
{
    uint8_t surface[TILE_RAYS], ray[TILE_RAYS];
    double x[TILE_RAYS], y[TILE_RAYS];
    uint32_t count = 0;
    rays->end = light->position;
    rays->aside = light->area_radius;
    for (; asked; asked &= asked - 1, count++) {
        surface[count] = (uint8_t)__builtin_ctzll(asked);
        ray[count] = tile->surfaces.ray[surface[count]];
    }
    sample_next_of(p->points, streams, ray, count, x, y);
    for (uint32_t k = 0; k < count; k++) {
        int i = surface[k];
        Vec3 point = tile_surface_point(&tile->surfaces, i);
        Vec3 aside = light_area_sample(light, point, (SamplePoint){x[k], y[k]});
        Vec3 offset = vec3_sub(vec3_add(light->position, aside), point);
        rays->distance[i] = vec3_length(offset);
        lane_set(rays->towards, (unsigned)i, vec3_scale(1.0 / rays->distance[i], offset));
    }
}

// The surfaces of `asked` that nothing of an area light reaches; what reaches the others is noted.
RT_ALWAYS_INLINE uint64_t shade_tile_area(const Prepared *p, unsigned features, LightTile *tile,
                                          const PreparedLight *light, uint64_t asked, SampleStream *streams,
                                          RenderStatistics *statistics)
{
    uint64_t dark = 0;
    if (streams) {
        SurfaceRays rays;
        shade_tile_places(p, tile, light, asked, streams, &rays);
        statistics->shadow_rays += (uint64_t)__builtin_popcountll(asked);
        return geometry_occluded_surfaces(p->geometry, features, &tile->surfaces, &rays, true, asked);
    }
    for (; asked; asked &= asked - 1) {
        int i = __builtin_ctzll(asked);
        ShadePoint at = shade_tile_point(tile, i, 0, NULL);
        Rgb arriving = light->is_plain ? light->colour : rgb_scale(tile->strength[i], light->colour);
        tile->share[i] = shade_area_grid(p, features, &at, light, arriving, statistics).red; // it is grey
        dark |= (uint64_t)(tile->share[i] == 0.0) << i;
    }
    return dark;
}

// What all lights add.
RT_ALWAYS_INLINE void shade_tile_lights(const Prepared *p, unsigned features, LightTile *tile, SampleStream *streams,
                                        RenderStatistics *statistics)
{
    for (size_t i = 0; i < p->light_count; i++) {
        const PreparedLight *light = &p->lights[i];
        uint64_t lit = p->tile_lights->aim(tile, light);
        if ((features & RENDER_LIGHTS) && !light->is_plain) {
            lit = shade_tile_strengths(tile, light, lit);
        }
        uint64_t asked = (features & RENDER_SHADOWS) && !light->shadowless ? lit & tile->before : 0;
        if (asked && (features & RENDER_LIGHTS) && light->area.size1 > 0) {
            lit &= ~shade_tile_area(p, features, tile, light, asked, streams, statistics);
        } else if (asked) {
            statistics->shadow_rays += (uint64_t)__builtin_popcountll(asked);
            lit &= ~geometry_occluded_surfaces(p->geometry, features, &tile->surfaces, &tile->rays, !light->parallel,
                                               asked);
        }
        p->tile_lights->add(tile, light, lit);
    }
}

// Rays of a tile on their way: as in PendingRay.
typedef struct TilePaths {
    Rgb share[TILE_RAYS];
    double weight[TILE_RAYS];
} TilePaths;

// Adds what the surfaces shine; the first ones, which the camera sees, have all of it.
RT_ALWAYS_INLINE void shade_tile_gather(const LightTile *tile, const TilePaths *paths, bool is_first, Rgb *light)
{
    for (int i = 0; i < tile->surfaces.count; i++) {
        unsigned ray = tile->surfaces.ray[i];
        Rgb own = rgb(tile->light[0][i], tile->light[1][i], tile->light[2][i]);
        light[ray] = is_first ? rgb_add(rgb_grey(0.0), own) : rgb_add(light[ray], rgb_mul(paths->share[ray], own));
    }
}

// Whether a surface mirrors its ray, at a level, and that is followed: then its share is what goes on.
RT_ALWAYS_INLINE bool shade_tile_mirrors(const Prepared *p, unsigned features, const LightTile *tile, int i, int level,
                                         TilePaths *paths, RenderStatistics *statistics)
{
    unsigned ray = tile->surfaces.ray[i];
    Rgb pigment = rgb(tile->pigment[0][i], tile->pigment[1][i], tile->pigment[2][i]);
    ShadeMaterial material = {pigment, pigment, tile->finish[i]};
    ShadePoint at = shade_tile_point(tile, i, 0, NULL);
    ShadeOnward onward = {.reflection_weight = 0.0};
    if (!tile->finish[i]->reflects) {
        return false;
    }
    shade_set_mirror(features, &material, &at, &onward);
    paths->share[ray] = rgb_mul(level == 1 ? rgb_grey(1.0) : paths->share[ray], onward.reflectance);
    paths->weight[ray] = (level == 1 ? 1.0 : paths->weight[ray]) * onward.reflection_weight;
    if (!shade_is_followed(p, level, paths->weight[ray])) {
        shade_note_cut(p, level, paths->share[ray], statistics);
        return false;
    }
    statistics->reflected_rays++;
    return true;
}

// Takes what the mirrored rays meet for the tile's surfaces. Adds the light of those that meet nothing.
RT_ALWAYS_INLINE void shade_tile_bounce(const Prepared *p, unsigned features, LightTile *tile,
                                        MaterialIndex material[TILE_RAYS], TilePaths *paths, int level, Rgb *light,
                                        RenderStatistics *statistics)
{
    TileSurfaces *surfaces = &tile->surfaces;
    _Alignas(64) double mirrored[3][TILE_RAYS];
    uint8_t own[TILE_RAYS]; // of the rays that go on, which of the tile's they are
    OnwardRays rays;
    TileHits hits;
    rays.count = 0;
    rays.inward = 0;
    for (int i = 0; i < surfaces->count; i++) {
        if (shade_tile_mirrors(p, features, tile, i, level, paths, statistics)) {
            if (rays.count == 0) {
                p->tile_lights->mirror(tile, mirrored);
            }
            own[rays.count] = surfaces->ray[i];
            onward_ray_add(&rays, tile_surface_point(surfaces, i), lane_get(mirrored, (unsigned)i),
                           surfaces->shape[i], surfaces->inside >> i & 1);
        }
    }
    surfaces->count = 0;
    if (rays.count == 0) {
        return;
    }
    geometry_closest_onward(p->geometry, features, &rays, &hits);
    for (uint64_t missed = ~hits.met & ~UINT64_C(0) >> (TILE_RAYS - rays.count); missed; missed &= missed - 1) {
        unsigned ray = own[__builtin_ctzll(missed)];
        light[ray] = rgb_add(light[ray], rgb_mul(paths->share[ray], p->background));
    }
    if (hits.met) {
        geometry_onward_surfaces(p->geometry, features, &rays, &hits, surfaces, material);
    }
    for (int i = 0; i < surfaces->count; i++) {
        surfaces->ray[i] = own[surfaces->ray[i]];
    }
}

// The light of what the rays have met, and of what mirrors show.
RT_ALWAYS_INLINE void shade_tile_paths(const Prepared *p, unsigned features, LightTile *tile,
                                       MaterialIndex material[TILE_RAYS], SampleStream *streams, Rgb *light,
                                       RenderStatistics *statistics)
{
    TilePaths paths;
    for (int level = 1; tile->surfaces.count > 0; level++) {
        shade_tile_begin(p, features, tile, material);
        shade_tile_lights(p, features, tile, streams, statistics);
        shade_tile_gather(tile, &paths, level == 1, light);
        if (!(features & RENDER_REFLECTION)) {
            return;
        }
        shade_tile_bounce(p, features, tile, material, &paths, level, light, statistics);
    }
}

// The light of the rays of a view.
RT_ALWAYS_INLINE void shade_tile(const Prepared *p, unsigned features, const TileView *view, const KernelPlaces *places,
                                 SampleStream *streams, uint64_t wanted, Rgb *light, RenderStatistics *statistics)
{
    SphereTile rays;
    TileHits hits;
    Rgb background = rgb_add(rgb_grey(0.0), p->background);
    for (int i = 0; i < TILE_RAYS; i++) {
        light[i] = background;
    }
    if (geometry_view_passes(p->geometry, features, view, places->u, places->v)) {
        return;
    }
    geometry_closest_view(p->geometry, features, view, places->u, places->v, &rays, &hits);
    uint64_t met = hits.met & wanted;
    if (!met) {
        return;
    }
    LightTile tile;
    MaterialIndex material[TILE_RAYS];
    geometry_tile_surfaces(p->geometry, features, &rays, &hits, met, &tile.surfaces, material);
    shade_tile_paths(p, features, &tile, material, streams, light, statistics);
}

#endif
