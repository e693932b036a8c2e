// Light from all sides: what a uniform sky, which is requested besides the scene, makes of a surface.
//
// A sky of strength s gives a surface that nothing covers the light s: as many parallel lights of all directions would
// whose colours add up to 4 s, without their highlights. Beside that only what is in the way counts, so this is what
// viewers of molecules call ambient occlusion. One way for each sample of a sampled picture, DOME_WAYS for each surface
// that a single ray finds. docs/sampling.md, "Light from all sides", has the formulas.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_DOME_H
#define RENDER_SHADE_DOME_H

#include "render/shade/shade_light.h"

enum { DOME_WAYS = 16 };

// What the sky adds at a point. One function for all kernels, not inline: scenes without a sky hold no more than a
// test.
Rgb dome_light(const Prepared *p, const ShadeMaterial *material, const ShadingPoint *at, RenderStatistics *statistics);

#endif
