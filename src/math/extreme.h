// The greater and the lesser of two numbers, as fmax and fmin have it, NaN included: compilers make calls of those.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_EXTREME_H
#define MATH_EXTREME_H

static inline double greater_of(double a, double b)
{
    return a > b ? a : b == b ? b : a;
}

static inline double less_of(double a, double b)
{
    return a < b ? a : b == b ? b : a;
}

#endif
