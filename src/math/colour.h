// Colours: linear sums of light as rgb, and pigments with filter and transmit. Inline, no allocation, no I/O.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_COLOUR_H
#define MATH_COLOUR_H

#include <math.h>
#include <stdbool.h>

#include "math/extreme.h"

typedef struct Rgb {
    double red, green, blue;
} Rgb;

// A pigment: filter is the part of light let through in the pigment's colour, transmit the part let through unchanged.
typedef struct Rgbft {
    double red, green, blue, filter, transmit;
} Rgbft;

// A plain colour beyond this may be one that is like bytes.
enum { COLOUR_USUAL = 63 };

// Whole numbers up to 255, as picture programs have them; equal ones are more likely a bright light.
static inline bool rgb_is_like_bytes(double red, double green, double blue)
{
    const double v[] = {red, green, blue};
    bool is_usual = red <= COLOUR_USUAL && green <= COLOUR_USUAL && blue <= COLOUR_USUAL;
    for (int i = 0; i < 3 && !is_usual; i++) {
        is_usual = !(v[i] >= 0.0 && v[i] <= 255.0 && v[i] == floor(v[i]));
    }
    return !is_usual && (red == 255.0 || red != green || green != blue);
}

static inline Rgb rgb(double red, double green, double blue)
{
    return (Rgb){red, green, blue};
}

static inline Rgb rgb_grey(double level)
{
    return rgb(level, level, level);
}

static inline Rgb rgb_add(Rgb a, Rgb b)
{
    return rgb(a.red + b.red, a.green + b.green, a.blue + b.blue);
}

static inline Rgb rgb_mul(Rgb a, Rgb b)
{
    return rgb(a.red * b.red, a.green * b.green, a.blue * b.blue);
}

static inline Rgb rgb_scale(double s, Rgb a)
{
    return rgb(s * a.red, s * a.green, s * a.blue);
}

// a + s b
static inline Rgb rgb_add_scaled(Rgb a, double s, Rgb b)
{
    return rgb(a.red + s * b.red, a.green + s * b.green, a.blue + s * b.blue);
}

static inline double rgb_max(Rgb a)
{
    return greater_of(a.red, greater_of(a.green, a.blue));
}

static inline double rgb_max_abs(Rgb a)
{
    return greater_of(fabs(a.red), greater_of(fabs(a.green), fabs(a.blue)));
}

// The scene language's grey.
static inline double rgb_luminance(Rgb a)
{
    return 0.297 * a.red + 0.589 * a.green + 0.114 * a.blue;
}

static inline bool rgb_is_black(Rgb a)
{
    return a.red == 0.0 && a.green == 0.0 && a.blue == 0.0;
}

// The sRGB transfer function of IEC 61966-2-1: a stored value to linear light, piecewise, for values >= 0; below 0 the
// linear piece continues.
static inline double rgb_srgb_decode(double stored)
{
    return stored <= 0.04045 ? stored / 12.92 : pow((stored + 0.055) / 1.055, 2.4);
}

// And back.
static inline double rgb_srgb_encode(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

static inline Rgb rgbft_rgb(Rgbft a)
{
    return rgb(a.red, a.green, a.blue);
}

#endif
