// A ray against the surface where a polynomial in x, y and z is 0 (scene/polynomial.h), of which side 0 is all.
//
// Knows nothing of transforms.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_POLYNOMIAL_H
#define TRACE_POLYNOMIAL_H

#include "math/ray.h"
#include "trace/ray_interval.h"

// The intervals of the line where the polynomial is less than 0, in order: order / 2 + 1 at most. Returns how many.
unsigned polynomial_intervals(const double *list, const Ray *ray, SideLeft left, RayInterval *intervals);

// Of unit length, out of what is inside; where the surface has none, along x.
Vec3 polynomial_normal(const double *list, Vec3 point);

#endif
