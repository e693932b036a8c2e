// What lies around the scene: the light of the sky, and what fog does on the way.
//
// Functions of their own, not inline: a kernel of a scene that has neither holds no call. Measured beside POV-Ray;
// docs/language.md, "Sky and fog", has the formulas.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_SKY_H
#define RENDER_SHADE_SKY_H

#include "math/colour.h"
#include "math/ray.h"
#include "render/records/prepared.h"

// What a ray sees that meets nothing: the layers of the sky, and the background through them. `direction` is of unit
// length.
Rgb sky_light(const Prepared *p, Vec3 direction);

// What the layers let through of the background, in scenes of version 3.7.
Rgb sky_through(const Prepared *p, Vec3 direction);

// Fog on a way: what light from its end is multiplied with, and the light of the fog.
typedef struct FogShare {
    Rgb through, own;
} FogShare;

// All fogs from the ray's origin on, in prepared space, for `way` in the scene's lengths, which may be INFINITY.
FogShare fog_between(const Prepared *p, const Ray *ray, double way);

#endif
