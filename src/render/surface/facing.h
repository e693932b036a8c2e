// How a surface lies where a pattern is looked at: what `slope` and `aoi` ask for, and how they are answered.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SURFACE_FACING_H
#define RENDER_SURFACE_FACING_H

#include "math/vec3.h"
#include "render/surface/pattern.h"

// A point in the scene's lengths, the normal of the surface there, of length 1 and turned to where the ray comes from,
// and the ray's direction, of any length.
typedef struct Facing {
    Vec3 point, normal, direction;
} Facing;

// As PatternFunction. Where there is no surface, as in a sky, 0.
double facing_slope(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double facing_aoi(const Pattern *pattern, const NoiseSource *source, Vec3 p);

#endif
