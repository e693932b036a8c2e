// Vectors of three numbers, some at once: what math/vec3.h is for one.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_VEC3S_H
#define TRACE_VEC3S_H

#include "math/transform.h"
#include "trace/simd.h"

typedef struct Vec3s {
    Doubles x, y, z;
} Vec3s;

// A linear map for each, or the same for all.
typedef struct Linears {
    Doubles m[3][3];
} Linears;

#include "trace/lane_doubles.h"
#include "math/vec3.inc"

RT_ALWAYS_INLINE Vec3s vec3s(Doubles x, Doubles y, Doubles z)
{
    return (Vec3s){x, y, z};
}

// The same for all.
RT_ALWAYS_INLINE Vec3s vec3s_splat(Vec3 a)
{
    return vec3s(doubles_splat(a.x), doubles_splat(a.y), doubles_splat(a.z));
}

RT_ALWAYS_INLINE Vec3s vec3s_choose(DoublesMask mask, Vec3s a, Vec3s b)
{
    return vec3s(doubles_choose(mask, a.x, b.x), doubles_choose(mask, a.y, b.y), doubles_choose(mask, a.z, b.z));
}

// Rows of numbers, from the one of that number on; aligned to a vector's size.
#define vec3s_load(rows, at)                                                                                           \
    vec3s(doubles_load(&(rows)[0][at]), doubles_load(&(rows)[1][at]), doubles_load(&(rows)[2][at]))
#define vec3s_store(rows, at, a)                                                                                       \
    (doubles_store(&(rows)[0][at], (a).x), doubles_store(&(rows)[1][at], (a).y), doubles_store(&(rows)[2][at], (a).z))

RT_ALWAYS_INLINE Linears linears_splat(const Linear *linear)
{
    Linears all;
#pragma GCC unroll 3
    for (int row = 0; row < 3; row++) {
#pragma GCC unroll 3
        for (int column = 0; column < 3; column++) {
            all.m[row][column] = doubles_splat(linear->m[row][column]);
        }
    }
    return all;
}

RT_ALWAYS_INLINE Vec3s linears_direction(const Linears *linear, Vec3s v)
{
    return rows_directions(linear->m, v);
}

RT_ALWAYS_INLINE Vec3s linears_normal(const Linears *inverse, Vec3s v)
{
    return rows_normals(inverse->m, v);
}

#endif
