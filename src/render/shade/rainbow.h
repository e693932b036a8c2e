// Rainbows on the way of a ray, as fog is: what they leave of the light behind, and what they add.
//
// docs/language.md, "Sky and fog", has the formulas.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_RAINBOW_H
#define RENDER_SHADE_RAINBOW_H

#include "render/shade/sky.h"

// All of them, for `way` in the scene's lengths, which may be INFINITY.
FogShare rainbow_between(const Prepared *p, const Ray *ray, double way);

#endif
