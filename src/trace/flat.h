// A ray against what is flat: a disc of radius 1 with a hole, and the triangle of x, y >= 0, x + y <= 1, both in z = 0.
//
// A flat shape has no inside; a ray that starts on it never meets it again. Knows nothing of transforms.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_FLAT_H
#define TRACE_FLAT_H

#include <math.h>
#include <stdbool.h>

#include "base/attributes.h"
#include "math/vec3.h"

// Where the line crosses z = 0, and where in x and y. False when it runs along.
RT_ALWAYS_INLINE bool flat_root(Vec3 o, Vec3 d, double *t, double *x, double *y)
{
    if (d.z == 0.0) {
        return false;
    }
    *t = -o.z / d.z;
    *x = o.x + *t * d.x;
    *y = o.y + *t * d.y;
    return true;
}

RT_ALWAYS_INLINE bool disc_has(double hole, double x, double y)
{
    double square = x * x + y * y;
    return square <= 1.0 && square >= hole * hole;
}

RT_ALWAYS_INLINE bool triangle_has(double x, double y)
{
    return x >= 0.0 && y >= 0.0 && x + y <= 1.0;
}

#endif
