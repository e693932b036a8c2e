// A ray against a plane. A plane is flat, so a ray that starts on it never meets it again.
//
// Surfaces coincide where rounding cannot tell them apart; plane_crossing_error says how near that is.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_PLANE_H
#define TRACE_PLANE_H

#include <float.h>
#include <math.h>
#include <stdbool.h>

#include "base/attributes.h"
#include "math/ray.h"
#include "math/transform.h"

// All points p with p·normal = distance.
typedef struct PlaneShape {
    Vec3 normal; // unit length
    double distance;
} PlaneShape;

#include "math/lane_double.h"
#include "trace/plane.inc"

// True when two planes are the same surface, whatever side of it they call their inside.
RT_ALWAYS_INLINE bool plane_equal(const PlaneShape *a, const PlaneShape *b)
{
    return (a->distance == b->distance && vec3_equal(a->normal, b->normal)) ||
           (a->distance == -b->distance && vec3_equal(a->normal, vec3_neg(b->normal)));
}

// p(t) put back onto the plane: exactly, when the normal is along an axis.
RT_ALWAYS_INLINE Vec3 plane_point(const PlaneShape *plane, Ray ray, double t)
{
    Vec3 point = ray_at(ray, t);
    return vec3_add_scaled(point, plane->distance - vec3_dot(plane->normal, point), plane->normal);
}

#endif
