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
    const double position[3] = {light->position.x, light->position.y, light->position.z};
    const double ahead[3] = {light->towards.x, light->towards.y, light->towards.z};
    uint64_t before = 0, front = 0, behind = 0;
    tile->rays.end = light->position;
    tile->rays.aside = 0.0;
    Doubles farthest = doubles_splat(0.0);
    for (int i = 0; i < surfaces->count; i += DOUBLES) {
        Doubles offset[3], towards[3];
        for (int axis = 0; axis < 3; axis++) {
            offset[axis] = position[axis] - doubles_load(&surfaces->point[axis][i]);
        }
        Doubles distance = light->parallel
                               ? offset[0] * ahead[0] + offset[1] * ahead[1] + offset[2] * ahead[2]
                               : doubles_sqrt(offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]);
        Doubles shrink = 1.0 / distance;
        for (int axis = 0; axis < 3; axis++) {
            towards[axis] = light->parallel ? doubles_splat(ahead[axis]) : shrink * offset[axis];
            doubles_store(&tile->rays.towards[axis][i], towards[axis]);
        }
        Doubles cosine = doubles_load(&tile->normal[0][i]) * towards[0] + doubles_load(&tile->normal[1][i]) * towards[1] +
                         doubles_load(&tile->normal[2][i]) * towards[2];
        doubles_store(&tile->rays.distance[i], distance);
        farthest = doubles_max(distance, farthest);
        doubles_store(&tile->cosine[i], cosine);
        before |= (uint64_t)doubles_gt(distance, doubles_splat(0.0)) << i;
        front |= (uint64_t)doubles_gt(cosine, doubles_splat(0.0)) << i;
        behind |= (uint64_t)doubles_gt(doubles_splat(0.0), cosine) << i;
    }
    tile->rays.farthest = doubles_greatest(farthest);
    uint64_t all = tile_all(tile);
    tile->before = before & all;
    behind &= all;
    return (front & all) | (behind ? behind & tile_backs(tile) : 0);
}

// shade_power of each. A whole exponent below 2^12 is taken by multiplications.
static void tile_power(double base[TILE_RAYS], int count, double exponent)
{
    if (exponent == 1.0) {
        return;
    }
    if (!(exponent >= 0.0 && exponent <= 4096.0 && exponent == (double)(int)exponent)) {
        for (int i = 0; i < count; i++) {
            base[i] = shade_power(base[i], exponent);
        }
        return;
    }
    for (int i = 0; i < count; i += DOUBLES) {
        Doubles result = doubles_splat(1.0), square = doubles_load(&base[i]);
        for (unsigned n = (unsigned)exponent; n; n >>= 1, square *= square) {
            if (n & 1) {
                result *= square;
            }
        }
        doubles_store(&base[i], result);
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
            Doubles d[3], n[3], l[3];
            for (int axis = 0; axis < 3; axis++) {
                d[axis] = doubles_load(&surfaces->direction[axis][i]);
                n[axis] = doubles_load(&tile->normal[axis][i]);
                l[axis] = doubles_load(&tile->rays.towards[axis][i]);
            }
            Doubles of;
            if (kind == 0) {
                Doubles twice = -2.0 * (d[0] * n[0] + d[1] * n[1] + d[2] * n[2]);
                of = (d[0] + twice * n[0]) * l[0] + (d[1] + twice * n[1]) * l[1] + (d[2] + twice * n[2]) * l[2];
            } else {
                Doubles h[3] = {l[0] - d[0], l[1] - d[1], l[2] - d[2]};
                of = (h[0] * n[0] + h[1] * n[1] + h[2] * n[2]) /
                     doubles_sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
            }
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
            Doubles sum = doubles_load(&falloff[i]) * (diffuse * doubles_load(&tile->diffuse[k][i]));
            if (shines) {
                Doubles spot = doubles_load(&shine[i]);
                spot = finish->metallic > 0.0 ? spot * doubles_load(&tint[k][i]) : spot;
                sum = doubles_choose(front, sum + spot, sum);
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
        Doubles d[3], n[3], r[3];
        for (int axis = 0; axis < 3; axis++) {
            d[axis] = doubles_load(&tile->surfaces.direction[axis][i]);
            n[axis] = doubles_load(&tile->normal[axis][i]);
        }
        Doubles twice = -2.0 * (d[0] * n[0] + d[1] * n[1] + d[2] * n[2]);
        for (int axis = 0; axis < 3; axis++) {
            r[axis] = d[axis] + twice * n[axis];
        }
        Doubles shrink = 1.0 / doubles_sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
        for (int axis = 0; axis < 3; axis++) {
            doubles_store(&mirrored[axis][i], shrink * r[axis]);
        }
    }
}

extern const TileLights ISA_NAMED(tile_lights_);
const TileLights ISA_NAMED(tile_lights_) = {ISA_TEXT, tile_aim, tile_add, tile_mirror};
