// Rays p(t) = origin + t direction.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_RAY_H
#define MATH_RAY_H

#include "math/vec3.h"

typedef struct Ray {
    Vec3 origin;
    Vec3 direction; // of unit length, unless said otherwise
} Ray;

static inline Vec3 ray_at(Ray ray, double t)
{
    return vec3_add_scaled(ray.origin, t, ray.direction);
}

#endif
