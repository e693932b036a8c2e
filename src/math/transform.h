// Affine transforms in the scene language's convention: p' = p M + t with row vectors, so that `matrix <m00,m01,m02,
// m10,…,m32>` is stored as it is written and transforms are composed in the order in which they are written.
// Rotations are left-handed, in degrees, about x, then y, then z, as the language has them.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_TRANSFORM_H
#define MATH_TRANSFORM_H

#include <float.h>
#include <stdbool.h>

#include "math/vec3.h"

// What rounding may have done to the terms of a surface's place in the scene, beside the sum of their magnitudes: a
// coordinate in a shape's space is a difference and a product of three terms (4 u), its matrix is the inverse (6 u) of
// up to six transforms (5 u each, as in transform_is_similarity), and the root of a ray adds at most 8 u. See
// docs/numerics.md, "Composites".
#define TRANSFORM_ROUNDING (48.0 * (DBL_EPSILON / 2))

typedef struct Transform {
    double m[4][3]; // rows 0 to 2: images of x, y and z; row 3: image of the origin
} Transform;

// The linear part of one.
typedef struct Linear {
    double m[3][3];
} Linear;

Transform transform_identity(void);
// Whether it is that, bit for bit.
bool transform_is_identity(const Transform *transform);
Transform transform_translate(Vec3 by);
Transform transform_scale(Vec3 by);
Transform transform_rotate(Vec3 degrees);

// First `first`, then `second`.
Transform transform_compose(Transform first, Transform second);

// False when the linear part is singular or its inverse is not finite; *inverse is then unchanged.
bool transform_invert(const Transform *transform, Transform *inverse);

static inline Vec3 transform_direction(const Transform *transform, Vec3 direction)
{
    return rows_direction(transform->m, direction);
}

static inline Vec3 linear_direction(const Linear *linear, Vec3 direction)
{
    return rows_direction(linear->m, direction);
}

static inline Vec3 transform_point(const Transform *transform, Vec3 point)
{
    const double(*m)[3] = transform->m;
    return vec3_add(transform_direction(transform, point), vec3(m[3][0], m[3][1], m[3][2]));
}

// The image of a normal of a surface: `inverse` is the inverse of the surface's transform. Not normalised.
static inline Vec3 transform_normal(const Transform *inverse, Vec3 normal)
{
    return rows_normal(inverse->m, normal);
}

static inline Vec3 linear_normal(const Linear *inverse, Vec3 normal)
{
    return rows_normal(inverse->m, normal);
}

bool transform_is_finite(const Transform *transform);

// True when the linear part is a uniform scale times a rotation or reflection whose products with itself are exact to
// rounding, so that a sphere stays a sphere; *factor is then the scale.
bool transform_is_similarity(const Transform *transform, double *factor);

#endif
