// Powers of light: one function that gives the same bits on every machine where it can.
//
// Turns a number and an exponent into a number; knows nothing of what they mean.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_POWER_H
#define RENDER_SHADE_POWER_H

#include <math.h>

#include "base/attributes.h"

// base^exponent, by multiplications for whole exponents, so that the bits do not depend on a machine's pow.
RT_ALWAYS_INLINE double shade_power(double base, double exponent)
{
    if (exponent == 1.0) {
        return base;
    }
    if (!(exponent >= 0.0 && exponent <= 4096.0 && exponent == (double)(int)exponent)) {
        return pow(base, exponent);
    }
    double result = 1.0;
    for (unsigned n = (unsigned)exponent; n; n >>= 1, base *= base) {
        if (n & 1) {
            result *= base;
        }
    }
    return result;
}

#endif
