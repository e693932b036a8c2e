// Vectors of three doubles: points, directions and normals. Inline, no allocation, no I/O.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_VEC3_H
#define MATH_VEC3_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "math/extreme.h"

typedef struct Vec3 {
    double x, y, z;
} Vec3;

#include "math/lane_double.h"
#include "math/vec3.inc"

static inline Vec3 vec3(double x, double y, double z)
{
    return (Vec3){x, y, z};
}

static inline Vec3 vec3_mul(Vec3 a, Vec3 b)
{
    return vec3(a.x * b.x, a.y * b.y, a.z * b.z);
}

static inline Vec3 vec3_neg(Vec3 a)
{
    return vec3(-a.x, -a.y, -a.z);
}

static inline Vec3 vec3_cross(Vec3 a, Vec3 b)
{
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline double vec3_max_abs(Vec3 a)
{
    return greater_of(fabs(a.x), greater_of(fabs(a.y), fabs(a.z)));
}

static inline double vec3_sum_abs(Vec3 a)
{
    return fabs(a.x) + fabs(a.y) + fabs(a.z);
}

// Component by component.
static inline Vec3 vec3_least(Vec3 a, Vec3 b)
{
    return vec3(a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z);
}

static inline Vec3 vec3_greatest(Vec3 a, Vec3 b)
{
    return vec3(a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z);
}

static inline bool vec3_is_finite(Vec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

static inline bool vec3_equal(Vec3 a, Vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

// Multiplied with the power where that is a number, which rounds as ldexp does.
static inline Vec3 vec3_ldexp(Vec3 a, int exponent)
{
    if (exponent > -1000 && exponent < 1000) {
        uint64_t bits = (uint64_t)(exponent + 1023) << 52;
        double power;
        memcpy(&power, &bits, sizeof power);
        return vec3_scale(power, a);
    }
    return vec3(ldexp(a.x, exponent), ldexp(a.y, exponent), ldexp(a.z, exponent));
}

#endif
