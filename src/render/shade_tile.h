// Light along the camera rays of a tile: the same as render/shade.h gives ray by ray, bit for bit, with the arithmetic
// of the first surface done for some rays at once.
//
// For surfaces of one colour that let nothing through; what goes on from a mirror is traced ray by ray. Everything is always-inline and takes the kernel's features as a constant.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_TILE_H
#define RENDER_SHADE_TILE_H

#include "render/shade.h"
#include "render/tile_light.h"

// What a kernel may have for its tiles to be shaded so.
enum {
    SHADE_TILE_FEATURES = TRACE_SPHERES | TRACE_SPHERE_BVH | TRACE_PLANES | RENDER_SHADOWS | RENDER_HIGHLIGHTS |
                          RENDER_BRILLIANCE | RENDER_REFLECTION | RENDER_LIGHTS
};

// Materials, glow, and normals towards the viewer.
RT_ALWAYS_INLINE void shade_tile_begin(const Prepared *p, LightTile *tile, const MaterialIndex material[TILE_RAYS])
{
    const TileSurfaces *surfaces = &tile->surfaces;
    for (int i = 0; i < surfaces->count; i++) {
        const Material *own = &p->materials[material[i]];
        const PreparedFinish *finish = &p->finishes[own->finish];
        Rgb pigment = rgbft_rgb(material_pigment(own));
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
RT_ALWAYS_INLINE void shade_tile_places(const LightTile *tile, const PreparedLight *light, uint64_t asked,
                                        SampleStream *streams, SurfaceRays *rays)
{
    rays->end = light->position;
    rays->aside = light->area_radius;
    for (; asked; asked &= asked - 1) {
        int i = __builtin_ctzll(asked);
        Vec3 point = tile_surface_point(&tile->surfaces, i);
        Vec3 aside = light_area_sample(light, point, sample_next(&streams[tile->surfaces.ray[i]]));
        Vec3 offset = vec3_sub(vec3_add(light->position, aside), point);
        rays->distance[i] = vec3_length(offset);
        Vec3 towards = vec3_scale(1.0 / rays->distance[i], offset);
        rays->towards[0][i] = towards.x;
        rays->towards[1][i] = towards.y;
        rays->towards[2][i] = towards.z;
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
        shade_tile_places(tile, light, asked, streams, &rays);
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

// Where a surface mirrors: what the ray brings back in all. `light` is the surface's own.
RT_ALWAYS_INLINE Rgb shade_tile_mirror(const Prepared *p, unsigned features, ShadePath path, const ShadePoint *at,
                                       Rgb light, SampleStream *stream, RenderStatistics *statistics)
{
    PendingRay first = {.ray = {p->camera.location, at->direction},
                        .start = RAY_START_CAMERA,
                        .share = rgb_grey(1.0),
                        .weight = 1.0,
                        .level = 1};
    const Material *material = &p->materials[at->material];
    ShadeMaterial own = shade_material(p, features, material_pigment(material), material->finish);
    ShadeOnward onward = {.through = rgb_grey(0.0), .reflection_exponent = 1.0, .part = 1.0};
    Pending pending;
    shade_set_mirror(features, &own, at, &onward);
    pending_begin(&pending);
    pending_add(&pending, &first, light);
    shade_go_on(p, features, &onward, at, &first, NULL, NULL, &pending, statistics);
    return path(p, &pending, stream, statistics);
}

// The light of the rays of a view.
RT_ALWAYS_INLINE void shade_tile(const Prepared *p, unsigned features, ShadePath path, const TileView *view,
                                 const KernelPlaces *places, SampleStream *streams, uint64_t wanted, Rgb *light,
                                 RenderStatistics *statistics)
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
    shade_tile_begin(p, &tile, material);
    shade_tile_lights(p, features, &tile, streams, statistics);
    for (int i = 0; i < tile.surfaces.count; i++) {
        Rgb *out = &light[tile.surfaces.ray[i]];
        *out = rgb_add(rgb_grey(0.0), rgb(tile.light[0][i], tile.light[1][i], tile.light[2][i]));
        if ((features & RENDER_REFLECTION) && tile.finish[i]->reflects) {
            SampleStream *stream = (features & RENDER_LIGHTS) && streams ? &streams[tile.surfaces.ray[i]] : NULL;
            ShadePoint at = shade_tile_point(&tile, i, material[i], stream);
            *out = shade_tile_mirror(p, features, path, &at, *out, stream, statistics);
        }
    }
}

#endif
