// Steps are those of the scene language's manual; when a point has left, and that it counts as left in a magnet where
// it has come to 1, was measured. docs/language.md, "Patterns". Knows nothing of colours.
//
// SPDX-License-Identifier: MIT
#include "render/surface/pattern_fractal.h"

#include <math.h>

typedef struct Complex {
    double re, im;
} Complex;

static Complex plus(Complex a, Complex b)
{
    return (Complex){a.re + b.re, a.im + b.im};
}

static Complex times(Complex a, Complex b)
{
    return (Complex){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

static Complex scaled(double s, Complex a)
{
    return (Complex){s * a.re, s * a.im};
}

static Complex over(Complex a, Complex b)
{
    double square = b.re * b.re + b.im * b.im;
    return (Complex){(a.re * b.re + a.im * b.im) / square, (a.im * b.re - a.re * b.im) / square};
}

static double square_of(Complex a)
{
    return a.re * a.re + a.im * a.im;
}

// How an orbit ended.
typedef struct Orbit {
    Complex z;
    double least; // square of the nearest to 0
    int steps;    // before the one after which it had left
    bool has_left;
} Orbit;

static Complex power_step(Complex z, Complex c, int power)
{
    Complex product = z;
    for (int i = 1; i < power; i++) {
        product = times(product, z);
    }
    return plus(product, c);
}

// C. Beck and F. Schloegl; as the manual of Fractint has them: ((z² + c - 1) / (2z + c - 2))², and
// ((z³ + 3(c - 1)z + (c - 1)(c - 2)) / (3z² + 3(c - 2)z + (c - 1)(c - 2) + 1))².
static Complex magnet_step(Complex z, Complex c, int magnet)
{
    Complex z2 = times(z, z), c1 = {c.re - 1.0, c.im}, c2 = {c.re - 2.0, c.im}, above, below;
    if (magnet == 1) {
        above = plus(z2, c1);
        below = plus(scaled(2.0, z), c2);
    } else {
        Complex both = times(c1, c2);
        above = plus(plus(times(z2, z), scaled(3.0, times(c1, z))), both);
        below = plus(plus(scaled(3.0, z2), scaled(3.0, times(c2, z))), (Complex){both.re + 1.0, both.im});
    }
    Complex quotient = over(above, below);
    return times(quotient, quotient);
}

static bool has_left(Complex z, int magnet)
{
    return magnet == 0 ? square_of(z) > 4.0
                       : square_of(z) > 10000.0 || square_of((Complex){z.re - 1.0, z.im}) < 1.0 / 10000.0;
}

static Orbit orbit_of(const Pattern *pattern, Vec3 p)
{
    bool is_mandel = pattern->type == PATTERN_MANDEL;
    Complex z = {p.x, p.y}, c = is_mandel ? z : (Complex){pattern->vector.x, pattern->vector.y};
    bool is_from_zero = is_mandel && pattern->magnet; // which does not count as near to 0
    if (is_from_zero) {
        z = (Complex){0.0, 0.0};
    }
    Orbit orbit = {.least = is_from_zero ? (double)INFINITY : square_of(z)};
    for (; orbit.steps < pattern->count; orbit.steps++) {
        z = pattern->magnet ? magnet_step(z, c, pattern->magnet) : power_step(z, c, pattern->power);
        orbit.least = fmin(orbit.least, square_of(z));
        if (has_left(z, pattern->magnet)) {
            orbit.has_left = true;
            break;
        }
    }
    orbit.z = z;
    return orbit;
}

static double last_of(Complex z, int what)
{
    switch (what) {
    case 2:
        return z.re;
    case 3:
        return z.im;
    case 4:
        return z.re * z.re;
    case 5:
        return z.im * z.im;
    default:
        return sqrt(square_of(z));
    }
}

bool pattern_is_plain_fractal(const Pattern *pattern)
{
    return pattern->magnet == 0 && pattern->power == 2 && pattern->exterior == 1 && pattern->interior == 0 &&
           pattern->interior_factor == 1.0;
}

double pattern_fractal(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    Orbit orbit = orbit_of(pattern, p);
    (void)source;
    if (orbit.has_left && pattern->exterior == 1) {
        return (double)orbit.steps / pattern->count;
    }
    int what = orbit.has_left ? pattern->exterior : pattern->interior;
    double factor = orbit.has_left ? pattern->exterior_factor : pattern->interior_factor;
    double value = what == 0 ? 1.0 : what == 1 ? sqrt(orbit.least) : last_of(orbit.z, what);
    return isfinite(value) ? factor * value : 0.0;
}
