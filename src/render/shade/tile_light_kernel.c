// A light on the surfaces of a tile: compiled once for each instruction set, with ISA_NAME the name of the table.
//
// Surfaces that share one finish, as those of a tile mostly do, are done in vectors; others, and powers that are not
// whole, one by one where it must be.
//
// SPDX-License-Identifier: MIT
#include "base/isa.h"
#include "render/shade/shade_light.h"
#include "render/shade/tile_light.h"
#include "trace/simd.h"
#include "trace/vec3s.h"

#include "trace/lane_doubles.h"
#include "render/shade/lighting.inc"
#include "render/shade/power.inc"

static uint64_t tile_all(const LightTile *tile)
{
    return ~UINT64_C(0) >> (TILE_RAYS - tile->surfaces.count);
}

// Those whose diffuse light comes from behind, too.
static uint64_t tile_backs(const LightTile *tile)
{
    uint64_t backs = 0;
    for (int i = 0; i < tile->surfaces.count; i++) {
        backs |= (uint64_t)(tile->finish[i]->diffuse_back > 0.0) << i;
    }
    return backs;
}

static uint64_t tile_aim(LightTile *tile, const PreparedLight *light)
{
    const TileSurfaces *surfaces = &tile->surfaces;
    uint64_t before = 0, front = 0, behind = 0;
    tile->rays.end = light->position;
    tile->rays.end_radius = 0.0;
    Doubles farthest = doubles_splat(0.0);
    for (int i = 0; i < surfaces->count; i += DOUBLES) {
        LightAims aim = lights_aim(light, vec3s_load(surfaces->point, i), vec3s_load(tile->normal, i));
        vec3s_store(tile->rays.towards, i, aim.towards);
        doubles_store(&tile->rays.distance[i], aim.distance);
        doubles_store(&tile->cosine[i], aim.cosine);
        farthest = doubles_max(aim.distance, farthest);
        before |= (uint64_t)doubles_gt(aim.distance, doubles_splat(0.0)) << i;
        front |= (uint64_t)doubles_gt(aim.cosine, doubles_splat(0.0)) << i;
        behind |= (uint64_t)doubles_gt(doubles_splat(0.0), aim.cosine) << i;
    }
    tile->rays.farthest = doubles_greatest(farthest);
    uint64_t all = tile_all(tile);
    tile->before = before & all;
    behind &= all;
    return (front & all) | (behind ? behind & tile_backs(tile) : 0);
}

// shade_power of each.
static void tile_power(double base[TILE_RAYS], int count, double exponent)
{
    if (exponent == 1.0) {
        return;
    }
    if (!power_is_whole(exponent)) {
        for (int i = 0; i < count; i++) {
            base[i] = shade_power(base[i], exponent);
        }
        return;
    }
    for (int i = 0; i < count; i += DOUBLES) {
        doubles_store(&base[i], powers_whole(doubles_load(&base[i]), (unsigned)exponent));
    }
}

// Highlights of surfaces of one finish.
static void tile_highlights(const LightTile *tile, const PreparedFinish *finish, double shine[TILE_RAYS])
{
    const TileSurfaces *surfaces = &tile->surfaces;
    int count = surfaces->count;
    _Alignas(64) double cosine[TILE_RAYS];
    for (int i = 0; i < count; i += DOUBLES) {
        doubles_store(&shine[i], doubles_splat(0.0));
    }
    for (int kind = 0; kind < 2; kind++) {
        double amount = kind == 0 ? finish->phong : finish->specular;
        if (!(amount > 0.0)) {
            continue;
        }
        for (int i = 0; i < count; i += DOUBLES) {
            Vec3s d = vec3s_load(surfaces->direction, i), n = vec3s_load(tile->normal, i);
            Vec3s l = vec3s_load(tile->rays.towards, i);
            Doubles of = kind == 0 ? phong_cosines(d, n, l) : specular_cosines(d, n, l);
            doubles_store(&cosine[i], of);
        }
        uint64_t ahead = 0;
        for (int i = 0; i < count; i += DOUBLES) {
            ahead |= (uint64_t)doubles_gt(doubles_load(&cosine[i]), doubles_splat(0.0)) << i;
        }
        if (!(ahead & tile_all(tile))) {
            continue;
        }
        tile_power(cosine, count, kind == 0 ? finish->phong_size : finish->shininess);
        for (int i = 0; i < count; i += DOUBLES) {
            Doubles more = amount * doubles_load(&cosine[i]);
            DoublesMask mask = doubles_bits_mask(ahead >> i);
            doubles_store(&shine[i], doubles_load(&shine[i]) + (Doubles)(mask & (DoublesMask)more));
        }
    }
}

// By how much a metallic finish colours the highlights of those that are lit.
static void tile_tint(const LightTile *tile, const PreparedFinish *finish, uint64_t lit, double tint[3][TILE_RAYS])
{
    for (; lit; lit &= lit - 1) {
        int i = __builtin_ctzll(lit);
        Rgb pigment = rgb(tile->pigment[0][i], tile->pigment[1][i], tile->pigment[2][i]);
        Rgb own = shade_metallic(0, finish->metallic, pigment, tile->cosine[i]);
        tint[0][i] = own.red;
        tint[1][i] = own.green;
        tint[2][i] = own.blue;
    }
}

// What the light adds to the `own` surfaces, which share a finish: 0 where it does not reach.
static void tile_add_finish(LightTile *tile, const PreparedLight *light, const PreparedFinish *finish, uint64_t own,
                            uint64_t lit)
{
    int count = tile->surfaces.count;
    const double colour[3] = {light->colour.red, light->colour.green, light->colour.blue};
    bool shines = finish->shines && !light->shadowless;
    _Alignas(64) double falloff[TILE_RAYS];
    _Alignas(64) double shine[TILE_RAYS];
    _Alignas(64) double tint[3][TILE_RAYS];
    for (int i = 0; i < count; i += DOUBLES) {
        doubles_store(&falloff[i], doubles_abs(doubles_load(&tile->cosine[i])));
    }
    if (finish->diffuse > 0.0 || finish->diffuse_back > 0.0) {
        tile_power(falloff, count, finish->brilliance);
    }
    if (shines) {
        tile_highlights(tile, finish, shine);
    }
    if (shines && finish->metallic > 0.0) {
        tile_tint(tile, finish, lit, tint);
    }
    for (int i = 0; i < count; i += DOUBLES) {
        DoublesMask mine = doubles_bits_mask(own >> i), reached = doubles_bits_mask(lit >> i);
        Doubles cosine = doubles_load(&tile->cosine[i]);
        DoublesMask front = cosine > 0.0;
        Doubles diffuse = doubles_choose(front, doubles_splat(finish->diffuse), doubles_splat(finish->diffuse_back));
        for (int k = 0; k < 3; k++) {
            Doubles sum = lit_diffusely_all(doubles_load(&falloff[i]), diffuse, doubles_load(&tile->diffuse[k][i]));
            if (shines) {
                Doubles metal = finish->metallic > 0.0 ? doubles_load(&tint[k][i]) : doubles_splat(1.0);
                sum = doubles_choose(front, lit_shiny_all(sum, doubles_load(&shine[i]), metal), sum);
            }
            Doubles before = doubles_load(&tile->light[k][i]);
            Doubles arriving = doubles_splat(colour[k]);
            if (!light->is_plain) {
                arriving = doubles_load(&tile->strength[i]) * arriving;
            }
            if (tile->is_shared) {
                arriving = arriving * doubles_load(&tile->share[k][i]);
            }
            Doubles after = before + (Doubles)(reached & (DoublesMask)(sum * arriving));
            doubles_store(&tile->light[k][i], doubles_choose(mine, after, before));
        }
    }
}

// One finish of the tile's after the other; mostly there is one.
static void tile_add(LightTile *tile, const PreparedLight *light, uint64_t lit)
{
    for (uint64_t rest = tile_all(tile); rest;) {
        const PreparedFinish *finish = tile->finish[__builtin_ctzll(rest)];
        uint64_t own = 0;
        for (uint64_t others = rest; others; others &= others - 1) {
            int i = __builtin_ctzll(others);
            own |= (uint64_t)(tile->finish[i] == finish) << i;
        }
        tile_add_finish(tile, light, finish, own, lit & own);
        rest &= ~own;
    }
}

// shade_mirrored of each.
static void tile_mirror(const LightTile *tile, double mirrored[3][TILE_RAYS])
{
    for (int i = 0; i < tile->surfaces.count; i += DOUBLES) {
        Vec3s direction = vec3s_load(tile->surfaces.direction, i), normal = vec3s_load(tile->normal, i);
        vec3s_store(mirrored, i, vec3s_normalize(vec3s_reflect(direction, normal)));
    }
}

extern const TileLights ISA_NAMED(tile_lights_);
const TileLights ISA_NAMED(tile_lights_) = {ISA_TEXT, tile_aim, tile_add, tile_mirror};
