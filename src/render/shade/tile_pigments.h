// Colours of a tile's surfaces that are found together.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_TILE_PIGMENTS_H
#define RENDER_SHADE_TILE_PIGMENTS_H

#include "render/records/prepared.h"
#include "trace/spheres.h"

typedef struct TilePigments {
    uint64_t known; // of which surfaces
    Rgbft colour[TILE_RAYS];
} TilePigments;

// Those of textures of one layer whose pigments take less time so.
void tile_pigments(const Prepared *p, const TileSurfaces *surfaces, const MaterialIndex material[TILE_RAYS],
                   TilePigments *pigments);

#endif
