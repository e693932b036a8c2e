// A ray against a torus about y: all points at distance `minor` from the circle of radius `major` in y = 0.
//
// Side 0 is what is seen from outside. Of a torus with minor > major the tube goes through itself: the surface within,
// about the axis, is side 1. It bounds nothing: all within side 0 is inside. Knows nothing of transforms.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_TORUS_H
#define TRACE_TORUS_H

#include "math/ray.h"
#include "trace/ray_interval.h"

enum { TORUS_OUTER, TORUS_INNER };
enum { TORUS_INTERVALS = 2 };

// The intervals of the line inside of side 0, in order, and then the one between two crossings of side 1, at most two in
// all; major and minor > 0, their sum at most 1 or so. Returns how many.
unsigned torus_intervals(double major, double minor, const Ray *ray, SideLeft left,
                         RayInterval intervals[TORUS_INTERVALS]);

// A vector along the normal at a point of the side, out of the tube, and that of unit length.
Vec3 torus_gradient(double major, Vec3 point, uint8_t side);
Vec3 torus_normal(double major, Vec3 point, uint8_t side);

// A point near the side, put onto it.
Vec3 torus_point(double major, double minor, Vec3 point, uint8_t side);

#endif
