// Warps: where a point is seen from behind them.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SURFACE_WARP_H
#define RENDER_SURFACE_WARP_H

#include "render/surface/pattern.h"
#include "scene/warp.h"

// A point of the space around a pattern's warps, in the pattern's own.
Vec3 warp_point(const Pattern *pattern, const NoiseSource *source, Vec3 point);

bool warp_needs_noise(const Warp *warp);

#endif
