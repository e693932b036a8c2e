// Superellipsoids: the balls of a size of points,
//
//     N = (M^q + |z|^q)^(1/q), M = (|x|^p + |y|^p)^(1/p), p = 2/e, q = 2/n,
//
// which is as much larger as a point is farther from 0. It is taken in parts of the greatest coordinate, so that no
// power is out of range.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_SUPERELLIPSOID_H
#define SCENE_SUPERELLIPSOID_H

#include "math/vec3.h"

enum { SUPERELLIPSOID_INTERVALS = 8 };

// Of a point; the exponents are e and n in x and y of the first argument.
double superellipsoid_size(Vec3 exponents, Vec3 point);

// The same, and its gradient, of which a coordinate may be infinite where the surface has an edge.
double superellipsoid_size_and_gradient(Vec3 exponents, Vec3 point, Vec3 *gradient);

#endif
