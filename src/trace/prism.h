// A ray against a prism: an outline in x and z (scene/outline.h) from one height to another, the same at each or as
// large as the height; and against a polygon, an outline in x and y at z = 0.
//
// Side 0 is the wall, 1 and 2 are the ends, the lower one first. Knows nothing of transforms.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_PRISM_H
#define TRACE_PRISM_H

#include "math/ray.h"
#include "scene/outline.h"
#include "trace/ray_interval.h"

enum { PRISM_WALL, PRISM_LOW, PRISM_HIGH };

// The intervals of the line inside of the prism between its bounds, in order; as many as half of
// outline_crossings_most, and 2, at most.
unsigned prism_intervals(const Numbers *outline, Vec3 low, Vec3 high, const Ray *ray, SideLeft left,
                         RayInterval *intervals);

// A vector along the normal at a point of a side. Of a wall it may be turned in or out: which one depends on the way
// that the outline takes.
Vec3 prism_gradient(const Numbers *outline, Vec3 point, uint8_t side);

// A point near the side, put onto it.
Vec3 prism_point(const Numbers *outline, double low, double high, Vec3 point, uint8_t side);

#endif
