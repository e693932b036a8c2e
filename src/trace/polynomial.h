// A ray against the surface where a polynomial in x, y and z is 0 (scene/polynomial.h), of which side 0 is all.
//
// Knows nothing of transforms.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_POLYNOMIAL_H
#define TRACE_POLYNOMIAL_H

#include "math/ray.h"
#include "trace/ray_interval.h"

// The intervals of the line where the polynomial is less than 0, in order, `most` at most: there are order / 2 + 1 or
// less, of a convex quadric one. Returns how many.
unsigned polynomial_intervals(const double *list, const Ray *ray, SideLeft left, unsigned most, RayInterval *intervals);

// A part of a line, from one parameter to another.
typedef struct LineRange {
    double low, high;
} LineRange;

// The same, but crossings that surely lie before `low` or behind `high` may be left out. What is inside there has no
// end. The ends are not less than 0.
unsigned polynomial_intervals_within(const double *list, const Ray *ray, SideLeft left, LineRange range, unsigned most,
                                     RayInterval *intervals);

// Out of what is inside, at most 4 long; where the surface has no normal, along x.
Vec3 polynomial_slope(const double *list, Vec3 point);
// The same of unit length.
Vec3 polynomial_normal(const double *list, Vec3 point);

#endif
