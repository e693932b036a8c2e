// A ray against what a curve in x and y draws when it is turned about y: a lathe, whose curve is an outline
// (scene/outline.h), and a surface of revolution, whose radius squared is a cubic of the height (scene/sor.h).
//
// Of a lathe side 0 is the curve, and side 1 are the pieces that close it, which are not seen; of a surface of
// revolution 0 is the curve, and 1 and 2 are the discs at its ends, the lower one first. Knows nothing of transforms.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_REVOLVED_H
#define TRACE_REVOLVED_H

#include "math/ray.h"
#include "scene/numbers.h"
#include "trace/ray_interval.h"

enum { REVOLVED_CURVE, REVOLVED_LOW, REVOLVED_HIGH };

// The intervals of the line inside, between its bounds, in order; as many as lathe_crossings_most or
// sor_crossings_most, halved, and 1, at most.
unsigned lathe_intervals(const Numbers *outline, Vec3 low, Vec3 high, const Ray *ray, SideLeft left,
                         RayInterval *intervals);
unsigned sor_intervals(const Numbers *list, Vec3 low, Vec3 high, const Ray *ray, SideLeft left, RayInterval *intervals);

// A vector along the normal at a point of a side. Of a lathe it may be turned in or out, as the curve takes its way.
Vec3 lathe_gradient(const Numbers *outline, Vec3 point, uint8_t side);
Vec3 sor_gradient(const Numbers *list, Vec3 point, uint8_t side);

// A point near the side, put onto it.
Vec3 lathe_point(const Numbers *outline, Vec3 point, uint8_t side);
Vec3 sor_point(const Numbers *list, Vec3 point, uint8_t side);

// The surface coordinate of a point along the curve, from 0 to 1.
double lathe_along(const Numbers *outline, Vec3 point);
double sor_along(const Numbers *list, Vec3 point, uint8_t side);

#endif
