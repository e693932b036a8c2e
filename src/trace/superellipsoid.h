// A ray against a superellipsoid (scene/superellipsoid.h), of which side 0 is all.
//
// Knows nothing of transforms.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SUPERELLIPSOID_H
#define TRACE_SUPERELLIPSOID_H

#include "math/ray.h"
#include "trace/ray_interval.h"

// The intervals of the line inside, in order: SUPERELLIPSOID_INTERVALS at most. Returns how many.
unsigned superellipsoid_intervals(Vec3 exponents, const Ray *ray, SideLeft left, RayInterval *intervals);

// Out of it; of any length.
Vec3 superellipsoid_gradient(Vec3 exponents, Vec3 point);

// A point near it, put onto it, along the line to 0.
Vec3 superellipsoid_point(Vec3 exponents, Vec3 point);

#endif
