// What a light makes of the surfaces of a tile, some at once: compiled once for each instruction set.
//
// Operations and their order are those of render/shade/shade_light.h, so the bits are the same.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_TILE_LIGHT_H
#define RENDER_SHADE_TILE_LIGHT_H

#include "render/records/prepared.h"
#include "trace/spheres.h"

// Surfaces of a tile being shaded; surfaces.count of each, and what is after them up to a whole vector is unused.
typedef struct LightTile {
    TileSurfaces surfaces;
    _Alignas(64) double normal[3][TILE_RAYS]; // towards the viewer
    double pigment[3][TILE_RAYS];
    double opaque[3][TILE_RAYS];          // the opaque share of that, where something is let through
    const double (*diffuse)[TILE_RAYS];   // one of the two: what the diffuse light of a finish is multiplied with
    const PreparedFinish *finish[TILE_RAYS];
    uint64_t takes_light; // those of which lights make anything, a bit for each
    // Of the light that was aimed last: unit vectors to it and how far it is; N·L.
    SurfaceRays rays;
    _Alignas(64) double cosine[TILE_RAYS];
    // Of lights that are not plain: how strong they are there.
    _Alignas(64) double strength[TILE_RAYS];
    double share[3][TILE_RAYS]; // of what arrives, by colour, what gets there; `is_shared`, else all of it
    bool is_shared;
    uint64_t before; // those on whose side of a parallel light's plane something may throw a shadow
    _Alignas(64) double light[3][TILE_RAYS]; // the sum so far, of linear light
} LightTile;

typedef struct TileLights {
    const char *name; // of the instruction set, as that of SphereKernels
    // Sets what is of the light; returns the surfaces that it may shine on, a bit for each.
    uint64_t (*aim)(LightTile *tile, const PreparedLight *light);
    // Adds the light that was aimed to those that it reaches, and 0 to the others.
    void (*add)(LightTile *tile, const PreparedLight *light, uint64_t lit);
    // Where each surface would mirror its ray, of length 1; `mirrored` is aligned as a vector is.
    void (*mirror)(const LightTile *tile, double mirrored[3][TILE_RAYS]);
} TileLights;

// Those of an instruction set by name; NULL when there is none.
const TileLights *tile_lights_choose(const char *name);

#endif
