// One power of many values in single precision: each the float that pow, rounded, gives, in a fraction of pow's time.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_FLOAT_POWER_H
#define MATH_FLOAT_POWER_H

#include <stddef.h>

// Each value, at least 0 or else taken for 0, becomes (float)pow(value, exponent), to the bit.
void float_power_all(double exponent, float *values, size_t count);

#endif
