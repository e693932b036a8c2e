// Primitives: what messages call them, and how far they reach (the support function of the convex hull).
//
// Serves messages, bounding boxes and the question whether one shape contains another. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_PRIMITIVE_REACH_H
#define SCENE_PRIMITIVE_REACH_H

#include "scene/scene.h"

// What messages call a primitive: as its kind, "cylinder or cone", but a ball may be a "stretched sphere".
const char *primitive_name(const Primitive *primitive);

// Whether it only scales along the axes.
bool primitive_map_is_diagonal(const double (*rows)[3]);

// Whether a ball under the map of these rows is a sphere, with its axes where they were.
bool primitive_map_is_round(const double (*rows)[3]);

// Whether it has no end: a plane, or a polynomial that nothing bounds.
bool primitive_is_endless(const Primitive *primitive);

// The greatest p·direction over the primitive's points, inverse or not; INFINITY for what is endless, save for
// a plane against its own normal.
double primitive_support(const Primitive *primitive, Vec3 direction);

// Between what the primitive's p·direction lies: -primitive_support of the opposite direction, and primitive_support,
// bit for bit.
void primitive_span(const Primitive *primitive, Vec3 direction, double *low, double *high);

// The sum of the magnitudes of all terms of primitive_support, which bounds its rounding error; see docs/numerics.md.
double primitive_reach(const Primitive *primitive, Vec3 direction);

// True when every point of `inner` is surely inside of `outer`, a box, plane, sphere, or cylinder that is closed. False
// for all other kinds, and where it is within rounding, but for two spheres that are the same.
bool primitive_contains(const Primitive *outer, const Primitive *inner);

#endif
