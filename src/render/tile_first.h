// The first surfaces of a tile's camera rays in scenes that are traced ray by ray: those that need nothing of what asks
// for that are shaded together.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_TILE_FIRST_H
#define RENDER_TILE_FIRST_H

#include "render/records/prepared.h"
#include "render/sample/scratch.h"

// The light of those wanted that meet nothing, or one opaque layer without bumps that mirrors nothing, whatever
// else the scene holds: bit for bit that of shade_ray. The scratch's tile.rays are the rays that have met `hits`. Returns
// the rays that are left.
uint64_t tile_first(const Prepared *p, const TileHits *hits, const KernelCall *call);

#endif
