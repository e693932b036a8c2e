// Powers of light, with the same bits on every machine where that can be.
//
// Turns a number and an exponent into a number; knows nothing of what they mean.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_POWER_H
#define RENDER_SHADE_POWER_H

#include <math.h>
#include <stdbool.h>

#include "base/attributes.h"
#include "math/lane_double.h"
#include "render/shade/power.inc"

// Whether an exponent is one for multiplications.
RT_ALWAYS_INLINE bool power_is_whole(double exponent)
{
    return exponent >= 0.0 && exponent <= 4096.0 && exponent == (double)(int)exponent;
}

// base^exponent.
RT_ALWAYS_INLINE double shade_power(double base, double exponent)
{
    if (exponent == 1.0) {
        return base;
    }
    return power_is_whole(exponent) ? power_whole(base, (unsigned)exponent) : pow(base, exponent);
}

#endif
