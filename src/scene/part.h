// Parts: what messages call them, and how far they reach (the support function of the convex hull).
//
// Serves messages, bounding boxes and the question whether one shape contains another. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_PART_H
#define SCENE_PART_H

#include "scene/scene.h"

// What messages call a part: as its kind, "cylinder or cone", but a ball may be a "stretched sphere".
const char *part_name(const Part *part);

// Whether it only scales along the axes.
bool part_map_is_diagonal(const double (*rows)[3]);

// Whether a ball under the map of these rows is a sphere, with its axes where they were.
bool part_map_is_round(const double (*rows)[3]);

// Whether it has no end: a plane, or a polynomial that nothing bounds.
bool part_is_endless(const Part *part);

// The greatest p·direction over the part's points, inverse or not; INFINITY for what is endless, save for
// a plane against its own normal.
double part_support(const Part *part, Vec3 direction);

// Between what the part's p·direction lies: -part_support of the opposite direction, and part_support, bit for bit.
void part_span(const Part *part, Vec3 direction, double *low, double *high);

// The sum of the magnitudes of all terms of part_support, which bounds its rounding error; see docs/numerics.md.
double part_reach(const Part *part, Vec3 direction);

// True when every point of `inner` is surely inside of `outer`, a box or plane. False for all other kinds, and where it
// is within rounding.
bool part_contains(const Part *outer, const Part *inner);

#endif
