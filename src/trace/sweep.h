// A ray against a sphere sweep (scene/sweep.h): an interval for each piece of the line that some ball covers.
//
// The ball at s covers t where |o + t d - m(s)|² < r(s)². It covers some where F(s) = |d|² r² - |(m - o) × d|² is not
// less than 0, and then from (a - √F) / |d|² to (a + √F) / |d|² with a = (m - o)·d. F is a polynomial of degree 6, 2 of
// a straight segment; between two of its roots that are neighbours balls follow one another, and what they cover
// together is one interval, which ends at an end of these s or where a' = ± (√F)', among the roots of 4 F a'² - F'².
// One side, 0. Knows nothing of transforms.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SWEEP_H
#define TRACE_SWEEP_H

#include "math/ray.h"
#include "trace/ray_interval.h"

// What of the line is inside, in order: of what lies behind its start only where it reaches that. As many as
// sweep_interval_most, at most.
unsigned sweep_intervals(const double *list, const Ray *ray, SideLeft left, RayInterval *intervals);

// A vector along the normal at a point, out of the sweep, and a point near the surface put onto it.
Vec3 sweep_gradient(const double *list, Vec3 point);
Vec3 sweep_point(const double *list, Vec3 point);

#endif
