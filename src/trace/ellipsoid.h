// A ray against an ellipsoid: the unit sphere under an affine map. The ray is taken to object space, where parameters
// of the ray mean the same as outside; its direction is not of unit length there.
//
// The map is kept as a centre and two linear parts, so that no digits are lost far from the origin. Knows nothing of
// scenes or materials.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_ELLIPSOID_H
#define TRACE_ELLIPSOID_H

#include <stdbool.h>
#include <string.h>

#include "math/transform.h"
#include "trace/sphere.h"

typedef struct EllipsoidShape {
    Vec3 centre;
    Transform to_world, to_object; // linear parts; the last rows are 0
} EllipsoidShape;

#define UNIT_BALL ((Ball){{0.0, 0.0, 0.0}, 1.0})

RT_ALWAYS_INLINE SphereRay ellipsoid_ray(const EllipsoidShape *ellipsoid, const SphereRay *ray)
{
    Vec3 origin = transform_direction(&ellipsoid->to_object, vec3_sub(ray->origin, ellipsoid->centre));
    return sphere_ray_make(origin, transform_direction(&ellipsoid->to_object, ray->direction));
}

// True when two ellipsoids are the same surface.
RT_ALWAYS_INLINE bool ellipsoid_equal(const EllipsoidShape *a, const EllipsoidShape *b)
{
    return vec3_equal(a->centre, b->centre) && memcmp(&a->to_object, &b->to_object, sizeof(a->to_object)) == 0;
}

// The point put back onto the surface, and the outward unit normal there.
RT_ALWAYS_INLINE void ellipsoid_surface(const EllipsoidShape *ellipsoid, Ray ray, double t, Vec3 *point, Vec3 *normal)
{
    SphereRay world = sphere_ray_make(ray.origin, ray.direction);
    SphereRay object = ellipsoid_ray(ellipsoid, &world);
    Vec3 unit = vec3_normalize(vec3_add_scaled(object.origin, t, object.direction));
    *point = vec3_add(ellipsoid->centre, transform_direction(&ellipsoid->to_world, unit));
    *normal = vec3_normalize(transform_normal(&ellipsoid->to_object, unit));
}

#endif
