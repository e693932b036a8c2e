// Lengths of vectors of any size, as hypot has them to some ulps, without its call where no square overflows or
// vanishes.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_LENGTH_H
#define MATH_LENGTH_H

#include <math.h>

// Off by at most 3 u.
static inline double length_of(double x, double y, double z)
{
    double square = x * x + y * y + z * z;
    return square > 0x1p-900 && square < 0x1p1000 ? sqrt(square) : hypot(hypot(x, y), z);
}

#endif
