// What whole periods leave of a number: fmod without a call where numbers are of ordinary size.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_REST_H
#define MATH_REST_H

#include <math.h>
#include <stdint.h>

// fmod, to the bit, of what is mostly less than two periods: that difference is exact.
static inline double rest_of(double x, double period)
{
    double size = fabs(x);
    if (size < period) {
        return x;
    }
    return size < 2.0 * period ? copysign(size - period, x) : fmod(x, period);
}

// fmod (x, 1), to the bit.
static inline double fraction_of(double x)
{
    const double most = 0x1p52; // beyond, all are whole
    return fabs(x) < most ? copysign(x - (double)(int64_t)x, x) : fmod(x, 1.0);
}

#endif
