// See tile_first.h.
//
// Compiled once, with all features that the light of such surfaces may ask for.
//
// SPDX-License-Identifier: MIT
#include "render/tile_first.h"

enum {
    FEATURES = TRACE_ALL_FEATURES | RENDER_SHADOWS | RENDER_HIGHLIGHTS | RENDER_BRILLIANCE | RENDER_TRANSPARENCY |
               RENDER_LIGHTS | RENDER_PIGMENTS | RENDER_TEXTURES | RENDER_INTERIORS,
    LAYER_FEATURES = FEATURES & ~RENDER_TEXTURES // of what is one layer
};

static MaterialIndex material_of(const Geometry *g, ShapeId shape)
{
    return shape_is_on_primitive(shape) ? shapes_material(&g->shapes, shape) : geometry_material(g, FEATURES, shape);
}

static bool has_plain_finish(const Prepared *p, FinishIndex finish)
{
    return !p->finishes[finish].reflects && !p->finishes[finish].is_special;
}

static bool is_plain(const Prepared *p, MaterialIndex index)
{
    if (p->textures.is_lit_apart) {
        return false;
    }
    if (!(index & MATERIAL_COMPOUND)) {
        const Material *material = &p->materials[index];
        return material->filter == 0.0F && material->transmit == 0.0F && has_plain_finish(p, material->finish);
    }
    const Texture *texture = texture_single(&p->textures, p->compounds[index & ~MATERIAL_COMPOUND].texture);
    return texture && texture_is_opaque(&p->textures, &texture->pigment) && has_plain_finish(p, texture->finish);
}

// The rays, of those that met something, whose surface is shaded here.
static uint64_t find_plain(const Prepared *p, const TileHits *hits, uint64_t met)
{
    uint64_t plain = 0;
    MaterialIndex last = 0;
    bool is_last_plain = false, has_last = false;
    for (; met; met &= met - 1) {
        int i = __builtin_ctzll(met);
        MaterialIndex material = material_of(p->geometry, hits->shape[i]);
        if (!has_last || material != last) {
            last = material;
            is_last_plain = is_plain(p, material);
            has_last = true;
        }
        plain |= (uint64_t)is_last_plain << i;
    }
    return plain;
}

// The light of a ray whose end shines so, and of the fog on its way.
static Rgb through_fog(const Prepared *p, const SphereTile *rays, unsigned i, double way, Rgb own)
{
    if (!scene_has_haze(p->scene)) {
        return rgb_add(rgb_grey(0.0), own);
    }
    SphereRay ray = sphere_tile_ray(rays, i);
    FogShare fog = fog_between(p, &(Ray){ray.origin, ray.direction}, way);
    return rgb_add(rgb_add(rgb_grey(0.0), fog.own), rgb_mul(fog.through, own));
}

// The surfaces that let light through all the same: single points of pictures. Lights are not asked for them.
static uint64_t find_clear(LightTile *tile, const Rgb through[TILE_RAYS])
{
    uint64_t clear = 0;
    for (int i = 0; i < tile->surfaces.count; i++) {
        if (RT_UNLIKELY(!rgb_is_black(through[i]))) {
            tile->takes_light &= ~(UINT64_C(1) << i);
            clear |= UINT64_C(1) << tile->surfaces.ray[i];
        }
    }
    return clear;
}

// Returns the rays that are left after all.
static uint64_t shade_surfaces(const Prepared *p, const TileHits *hits, uint64_t plain, const KernelCall *call)
{
    TileScratch *scratch = &call->scratch->tile;
    MaterialIndex material[TILE_RAYS];
    Rgb through[TILE_RAYS];
    LightTile *tile = &scratch->tile;
    geometry_tile_surfaces(p->geometry, FEATURES, &scratch->rays, hits, plain, &tile->surfaces, material);
    shade_tile_begin(p, LAYER_FEATURES, tile, material, through);
    uint64_t left = find_clear(tile, through);
    shade_tile_lights(p, FEATURES, scratch, call->streams, call->statistics);
    for (int i = 0; i < tile->surfaces.count; i++) {
        unsigned ray = tile->surfaces.ray[i];
        Rgb own = rgb(tile->light[0][i], tile->light[1][i], tile->light[2][i]);
        call->light[ray] = through_fog(p, &scratch->rays, ray, hits->t[ray] * p->textures.scale, own);
    }
    return left;
}

uint64_t tile_first(const Prepared *p, const TileHits *hits, const KernelCall *call)
{
    uint64_t wanted = call->wanted;
    TileScratch *tile = &call->scratch->tile;
    tile->media = &call->scratch->rays.media;
    tile->before = prepared_start(p, p->camera.location, tile->media);
    if (p->is_by_rays || tile->media->nodes[tile->before].is_in_solid) {
        return wanted;
    }
    for (uint64_t missed = wanted & ~hits->met; missed; missed &= missed - 1) {
        unsigned i = (unsigned)__builtin_ctzll(missed);
        Rgb own = sky_light(p, sphere_tile_ray(&tile->rays, i).direction);
        call->light[i] = through_fog(p, &tile->rays, i, (double)INFINITY, own);
    }
    uint64_t plain = find_plain(p, hits, wanted & hits->met);
    uint64_t left = plain ? shade_surfaces(p, hits, plain, call) : 0;
    return (wanted & hits->met & ~plain) | left;
}
