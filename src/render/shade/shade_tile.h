// The light of the surfaces that a tile's rays have met: the same as render/shade/shade_light.h gives point by point,
// bit for bit, with the arithmetic done for some at once.
//
// For surfaces of one layer, and no interiors. Everything is always-inline and takes the kernel's features as a
// constant.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_SHADE_TILE_H
#define RENDER_SHADE_SHADE_TILE_H

#include "math/extreme.h"
#include "render/points/sampler_many.h"
#include "render/shade/shade.h"
#include "render/shade/tile_light.h"
#include "render/shade/tile_pigments.h"

// What a kernel may have for its tiles to be shaded so.
enum {
    SHADE_TILE_FEATURES = TRACE_ALL_FEATURES | RENDER_SHADOWS | RENDER_HIGHLIGHTS | RENDER_BRILLIANCE |
                          RENDER_REFLECTION | RENDER_TRANSPARENCY | RENDER_LIGHTS | RENDER_PIGMENTS
};

// Rays of a tile that may wait while what is mirrored is followed; each is on a level of its own.
enum { SHADE_WAITING_MOST = 12 };

// A ray through a surface, which waits.
typedef struct TileWaiting {
    Ray ray;
    ShapeId start;
    bool inward;
    Rgb share;
    double weight;
    int level;
    uint64_t passed;
} TileWaiting;

// The rays of a tile on their way: as in StackedRay, and what waits of each.
typedef struct TilePaths {
    Rgb share[TILE_RAYS];
    double weight[TILE_RAYS];
    int level[TILE_RAYS];
    uint64_t passed[TILE_RAYS];
    Rgb through[TILE_RAYS]; // by the tile's surfaces, where they may let light through: what is multiplied with that
    uint64_t resting; // a bit for each ray: it continues with what waits
    int count[TILE_RAYS];
    TileWaiting waiting[SHADE_WAITING_MOST][TILE_RAYS];
} TilePaths;

// What is too large for a stack.
typedef struct TileScratch {
    SphereTile rays;
    LightTile tile;
    TilePaths paths;
    TileCrossings crossings;
    // What a shadow ray is inside of at its start, where there are interiors: as of ShadingPoint.
    MediumTable *media;
    MediumStack before;
} TileScratch;

// What the rays of a tile are shaded with, and where their light goes.
typedef struct TileShading {
    TileScratch *scratch;
    MaterialIndex material[TILE_RAYS]; // of the tile's surfaces
    SampleStream *streams;             // NULL: area lights are grids
    Rgb *light;                        // of each ray
    RenderStatistics *statistics;
} TileShading;

// Materials, glow, and normals towards the viewer. `through` is set where something may be let through.
RT_ALWAYS_INLINE void shade_tile_begin(const Prepared *p, unsigned features, LightTile *tile,
                                       const MaterialIndex material[TILE_RAYS], Rgb through[TILE_RAYS])
{
    const TileSurfaces *surfaces = &tile->surfaces;
    tile->diffuse = features & RENDER_TRANSPARENCY ? tile->opaque : tile->pigment;
    tile->is_shared = false;
    tile->takes_light = 0;
    TilePigments pigments;
    pigments.known = 0;
    if ((features & (RENDER_TEXTURES | RENDER_PIGMENTS)) && RT_UNLIKELY(p->textures.goes_abreast)) {
        tile_pigments(p, surfaces, material, &pigments);
    }
    for (int i = 0; i < surfaces->count; i++) {
        ShadeLayer layer;
        if (RT_UNLIKELY(pigments.known >> i & 1)) {
            uint32_t texture = p->compounds[material[i] & ~MATERIAL_COMPOUND].texture;
            layer = (ShadeLayer){pigments.colour[i], p->scene->textures.items[texture].finish, false};
        } else {
            shade_one_layer(p, features, material[i], tile_surface_point(surfaces, i), &layer);
        }
        const PreparedFinish *finish = &p->finishes[layer.finish];
        Rgb pigment = rgbft_rgb(layer.pigment), opaque = pigment;
        if (features & RENDER_TRANSPARENCY) {
            opaque = rgb_scale(texture_pigment_opaque(p->is_old, layer.pigment), pigment);
            lane_set(tile->opaque, (unsigned)i, vec3(opaque.red, opaque.green, opaque.blue));
            through[i] = texture_pigment_through(layer.pigment);
        }
        Rgb glow = rgb_mul(opaque, finish->glow);
        tile->takes_light |= (uint64_t)shade_takes_light(finish, opaque) << i;
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
RT_ALWAYS_INLINE ShadingPoint shade_tile_point(const LightTile *tile, int i, MaterialIndex material,
                                               SampleStream *stream)
{
    const TileSurfaces *from = &tile->surfaces;
    return (ShadingPoint){.point = tile_surface_point(from, i),
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

// A surface whose light is computed.
RT_ALWAYS_INLINE ShadingPoint shade_tile_lit_point(unsigned features, const TileScratch *scratch, int i)
{
    ShadingPoint at = shade_tile_point(&scratch->tile, i, 0, NULL);
    if (features & RENDER_INTERIORS) {
        at.media = scratch->media;
        at.before = scratch->before;
    }
    return at;
}

// How strong a light is that is not plain, for those of `lit`; returns those where it is anything.
RT_ALWAYS_INLINE uint64_t shade_tile_strengths(LightTile *tile, const PreparedLight *light, uint64_t lit)
{
    uint64_t left = 0;
    for (; lit; lit &= lit - 1) {
        int i = __builtin_ctzll(lit);
        Vec3 offset = vec3_sub(light->position, tile_surface_point(&tile->surfaces, i));
        tile->strength[i] = light_strength(light, offset, tile->rays.distance[i]);
        left |= (uint64_t)(tile->strength[i] > 0.0) << i;
    }
    return left;
}

// One place of an area for each surface of `asked`, by its stream: `end`.
RT_ALWAYS_INLINE void shade_tile_places(const Prepared *p, const LightTile *tile, const PreparedLight *light, uint64_t asked,
                                        SampleStream *streams, SurfaceRays *rays, double end[3][TILE_RAYS])
{
    uint8_t surface[TILE_RAYS], ray[TILE_RAYS];
    double x[TILE_RAYS], y[TILE_RAYS];
    uint32_t count = 0;
    rays->end = light->position;
    rays->end_radius = light->area_radius;
    rays->farthest = 0.0;
    for (; asked; asked &= asked - 1, count++) {
        surface[count] = (uint8_t)__builtin_ctzll(asked);
        ray[count] = tile->surfaces.ray[surface[count]];
    }
    sample_next_of(p->points, streams, ray, count, x, y);
    for (uint32_t k = 0; k < count; k++) {
        int i = surface[k];
        Vec3 point = tile_surface_point(&tile->surfaces, i);
        Vec3 aside = light_area_sample(light, point, (SamplePoint){x[k], y[k]});
        Vec3 place = vec3_add(light->position, aside), offset = vec3_sub(place, point);
        lane_set(end, (unsigned)i, place);
        rays->distance[i] = vec3_length(offset);
        rays->farthest = greater_of(rays->farthest, rays->distance[i]);
        lane_set(rays->towards, (unsigned)i, vec3_scale(1.0 / rays->distance[i], offset));
    }
}

// Whether light may come through something.
RT_ALWAYS_INLINE bool shade_tile_is_clear(const Prepared *p, unsigned features)
{
    return (features & RENDER_TRANSPARENCY) && (p->features & RENDER_TRANSPARENCY);
}

RT_ALWAYS_INLINE void shade_tile_set_share(LightTile *tile, int i, Rgb share)
{
    lane_set(tile->share, (unsigned)i, vec3(share.red, share.green, share.blue));
}

// Notes what of the light gets to the surfaces `asked` for; returns those that nothing reaches. Those that nothing is
// before need no walk, nor those of few spheres.
RT_ALWAYS_INLINE uint64_t shade_tile_through(const Prepared *p, unsigned features, TileScratch *scratch,
                                             const SurfaceRays *rays, bool together, uint64_t asked)
{
    LightTile *tile = &scratch->tile;
    TileCrossings *crossings = &scratch->crossings;
    const TileSurfaces *from = &tile->surfaces;
    uint64_t dark = 0, known = geometry_crossed(p->geometry, features, from, rays, asked, crossings), clear = 0;
    if ((features & TRACE_SPHERE_BVH) && !known) {
        clear = asked & ~geometry_occluded_surfaces(p->geometry, features, from, rays, together, asked);
    }
    for (; asked; asked &= asked - 1) {
        int i = __builtin_ctzll(asked);
        Rgb share = rgb_grey(1.0);
        bool is_even = (known >> i & 1) &&
                       shade_even_share(p, features, crossings->shape[i], crossings->count[i], &share);
        if (!is_even && !(clear >> i & 1)) {
            ShadingPoint at = shade_tile_lit_point(features, scratch, i);
            Ray ray = {at.point, lane_get(rays->towards, (unsigned)i)};
            RayStart start = {at.shape, vec3_dot(at.outward, ray.direction) < 0.0, HIDDEN_SHADOW};
            share = shade_light_through(p, features, &at, ray, start, rays->distance[i]);
        }
        shade_tile_set_share(tile, i, share);
        dark |= (uint64_t)rgb_is_black(share) << i;
    }
    return dark;
}

// The surfaces of `asked` that nothing of an area light's grid reaches; what reaches the others is noted.
RT_ALWAYS_INLINE uint64_t shade_tile_grid(const Prepared *p, unsigned features, TileScratch *scratch,
                                          const PreparedLight *light, uint64_t asked, RenderStatistics *statistics)
{
    LightTile *tile = &scratch->tile;
    uint64_t dark = 0;
    for (; asked; asked &= asked - 1) {
        int i = __builtin_ctzll(asked);
        ShadingPoint at = shade_tile_lit_point(features, scratch, i);
        Rgb arriving = light->is_plain ? light->colour : rgb_scale(tile->strength[i], light->colour);
        Rgb share = shade_area_grid(p, features, &at, light, arriving, statistics);
        shade_tile_set_share(tile, i, share);
        dark |= (uint64_t)rgb_is_black(share) << i;
    }
    return dark;
}

// Takes the surfaces out of `asked` that are too far from their light to be asked from where they are; returns those
// that nothing reaches. `end`: where each one's light is, NULL if that is the end of all.
RT_SELDOM uint64_t shade_tile_far(const Prepared *p, unsigned features, TileScratch *scratch, const SurfaceRays *rays,
                                  double end[3][TILE_RAYS], uint64_t *asked)
{
    LightTile *tile = &scratch->tile;
    uint64_t dark = 0;
    for (uint64_t rest = *asked; rest; rest &= rest - 1) {
        int i = __builtin_ctzll(rest);
        Vec3 light = end ? lane_get(end, (unsigned)i) : rays->end;
        if (!shade_is_far(p, tile_surface_point(&tile->surfaces, i), light, rays->distance[i])) {
            continue;
        }
        ShadingPoint at = shade_tile_lit_point(features, scratch, i);
        Rgb share = shade_far_light(p, &at, light, lane_get(rays->towards, (unsigned)i), rays->distance[i]);
        shade_tile_set_share(tile, i, share);
        dark |= (uint64_t)rgb_is_black(share) << i;
        *asked &= ~(UINT64_C(1) << i);
    }
    return dark;
}

// The surfaces of `asked` that nothing of a light reaches; what reaches the others is noted where it may not be all.
RT_ALWAYS_INLINE uint64_t shade_tile_shadows(const Prepared *p, unsigned features, TileScratch *scratch,
                                             const PreparedLight *light, uint64_t asked, SampleStream *streams,
                                             RenderStatistics *statistics)
{
    LightTile *tile = &scratch->tile;
    bool is_area = (features & RENDER_LIGHTS) && light->area.size1 > 0;
    const SurfaceRays *rays = &tile->rays;
    SurfaceRays places;
    double end[3][TILE_RAYS];
    uint64_t dark = 0;
    if (is_area && !streams) {
        return shade_tile_grid(p, features, scratch, light, asked, statistics);
    }
    if (is_area) {
        shade_tile_places(p, tile, light, asked, streams, &places, end);
        rays = &places;
    }
    statistics->shadow_rays += (uint64_t)__builtin_popcountll(asked);
    bool together = is_area || !light->parallel;
    if (RT_UNLIKELY(rays->farthest > p->near_light) && together) {
        dark = shade_tile_far(p, features, scratch, rays, is_area ? end : NULL, &asked);
    }
    return dark | (shade_tile_is_clear(p, features)
                       ? shade_tile_through(p, features, scratch, rays, together, asked)
                       : geometry_occluded_surfaces(p->geometry, features, &tile->surfaces, rays, together, asked));
}

// What the sky adds that is requested besides the scene.
RT_SELDOM void shade_tile_dome(const Prepared *p, unsigned features, TileScratch *scratch, SampleStream *streams,
                               RenderStatistics *statistics)
{
    LightTile *tile = &scratch->tile;
    for (uint64_t rest = tile->takes_light; rest; rest &= rest - 1) {
        int i = __builtin_ctzll(rest);
        ShadingPoint at = shade_tile_lit_point(features, scratch, i);
        at.stream = streams ? &streams[tile->surfaces.ray[i]] : NULL;
        ShadeMaterial material = {rgb(tile->pigment[0][i], tile->pigment[1][i], tile->pigment[2][i]),
                                  rgb(tile->diffuse[0][i], tile->diffuse[1][i], tile->diffuse[2][i]), tile->finish[i],
                                  0};
        Rgb own = dome_light(p, &material, &at, statistics);
        tile->light[0][i] += own.red;
        tile->light[1][i] += own.green;
        tile->light[2][i] += own.blue;
    }
}

// What all lights add.
RT_ALWAYS_INLINE void shade_tile_lights(const Prepared *p, unsigned features, TileScratch *scratch,
                                        SampleStream *streams, RenderStatistics *statistics)
{
    LightTile *tile = &scratch->tile;
    for (size_t i = 0; i < p->light_count; i++) {
        const PreparedLight *light = &p->lights[i];
        uint64_t lit = p->tile_lights->aim(tile, light) & tile->takes_light;
        if ((features & RENDER_LIGHTS) && !light->is_plain) {
            lit = shade_tile_strengths(tile, light, lit);
        }
        uint64_t asked = (features & RENDER_SHADOWS) && !light->shadowless ? lit & tile->before : 0;
        tile->is_shared = asked && (shade_tile_is_clear(p, features) ||
                                    ((features & RENDER_LIGHTS) && light->area.size1 > 0 && !streams));
        for (uint64_t whole = tile->is_shared ? lit & ~asked : 0; whole; whole &= whole - 1) {
            shade_tile_set_share(tile, __builtin_ctzll(whole), rgb_grey(1.0));
        }
        if (asked) {
            lit &= ~shade_tile_shadows(p, features, scratch, light, asked, streams, statistics);
        }
        p->tile_lights->add(tile, light, lit);
    }
    if (RT_UNLIKELY(p->has_dome)) {
        shade_tile_dome(p, features, scratch, streams, statistics);
    }
}

#endif
