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

// The parameter at which the ray crosses the plane; not positive, infinite or NaN when it does not.
RT_ALWAYS_INLINE double plane_root(const PlaneShape *plane, Vec3 origin, Vec3 direction)
{
    return (plane->distance - vec3_dot(plane->normal, origin)) / vec3_dot(plane->normal, direction);
}

// How far the parameter at which a plane is crossed may be off by rounding, that of the plane's own place with it. A
// normal is known to u of its length, but for components that are 0. Infinite along the plane.
RT_ALWAYS_INLINE double plane_crossing_error(const PlaneShape *plane, Ray ray, double t)
{
    Vec3 n = plane->normal, o = ray.origin, d = ray.direction;
    double x = n.x != 0.0 ? fabs(o.x) + fabs(t * d.x) : 0.0;
    double y = n.y != 0.0 ? fabs(o.y) + fabs(t * d.y) : 0.0;
    double z = n.z != 0.0 ? fabs(o.z) + fabs(t * d.z) : 0.0;
    double reach = sqrt(x * x + y * y + z * z) + fabs(plane->distance);
    return TRANSFORM_ROUNDING * reach / fabs(vec3_dot(n, d));
}

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
