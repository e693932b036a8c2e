// Square roots and the transcendental functions of the reference path in quadruple precision (the compiler's
// __float128).
//
// Each takes the double function's result and corrects it: one step of an iteration whose error is the cube of the
// first one's, so 53 bits become more than 113; the series underneath are summed until nothing changes. Here, and not
// in libquadmath, so that no program has a library more to look for when it starts.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_QUAD_H
#define MATH_QUAD_H

#include <math.h>

#include "base/attributes.h"

typedef __float128 Quad;

static inline Quad quad_abs(Quad x)
{
    return x < 0 ? -x : x;
}

// Heron's step twice: 53, 106, all bits. The argument is brought into the range of double first.
static inline Quad quad_sqrt(Quad x)
{
    Quad scale = 1;
    if (!(x > 0) || x > (Quad)0x1p1023 * (Quad)0x1p1000) {
        return x == 0 ? x : (Quad)sqrt((double)x);
    }
    for (; x < (Quad)0x1p-900; scale *= (Quad)0x1p-400) {
        x *= (Quad)0x1p800;
    }
    for (; x > (Quad)0x1p900; scale *= (Quad)0x1p400) {
        x *= (Quad)0x1p-800;
    }
    Quad root = (Quad)sqrt((double)x);
    root = (root + x / root) / 2;
    return scale * ((root + x / root) / 2);
}

// e^x: x = k ln 2 + r, e^r = (e^(r/256))^256.
static inline Quad quad_exp(Quad x)
{
    const Quad ln2 = (Quad)0x1.62e42fefa39efp-1 + (Quad)0x1.abc9e3b39803fp-56 + (Quad)0x1.7b57a079a1934p-111;
    if (!(quad_abs(x) < 700)) {
        return (Quad)exp((double)x);
    }
    int k = (int)lrint((double)x * 0x1.71547652b82fep+0);
    Quad r = (x - k * ln2) / 256;
    Quad term = 1, sum = 1;
    for (int n = 1; n < 20; n++) {
        term *= r / n;
        sum += term;
    }
    for (int i = 0; i < 8; i++) {
        sum *= sum;
    }
    return sum * (Quad)ldexp(1.0, k);
}

// Halley's step.
static inline Quad quad_log(Quad x)
{
    Quad first = (Quad)log((double)x);
    if (!(x > 0) || !isfinite((double)first)) {
        return first;
    }
    Quad power = quad_exp(first);
    return first + 2 * (x - power) / (x + power);
}

static inline Quad quad_pow(Quad base, Quad exponent)
{
    return base > 0 ? quad_exp(exponent * quad_log(base)) : (Quad)pow((double)base, (double)exponent);
}

// Sine and cosine for |x| <= 2.
static inline void quad_sine_cosine(Quad x, Quad *sine, Quad *cosine)
{
    Quad term = 1;
    *sine = 0;
    *cosine = 0;
    for (int n = 0; n < 40; n += 2) {
        *cosine += term;
        term *= x / (n + 1);
        *sine += term;
        term *= -x / (n + 2);
    }
}

// 2 arctan sqrt((1 - x) / (1 + x)); of the angle a whose tangent is t the first guess b is off by tan (a - b) =
// (t cos b - sin b) / (cos b + t sin b), but for its cube.
static inline Quad quad_acos(Quad x)
{
    if (!(x > -1 && x <= 1)) {
        return (Quad)acos((double)x);
    }
    Quad tangent = quad_sqrt((1 - x) / (1 + x)), sine, cosine;
    Quad angle = (Quad)atan((double)tangent);
    quad_sine_cosine(angle, &sine, &cosine);
    angle += (tangent * cosine - sine) / (cosine + tangent * sine);
    return 2 * angle;
}

#endif
