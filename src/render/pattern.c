// Patterns: one small function for each, in a table.
//
// Turns a point into a number; owns constant data only.
//
// SPDX-License-Identifier: MIT
#include "render/pattern.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

// ---- values

static double gradient(const Pattern *pattern, Vec3 p)
{
    return vec3_dot(pattern->vector, p);
}

static double radial(const Pattern *pattern, Vec3 p)
{
    (void)pattern;
    return p.x == 0.0 && p.z == 0.0 ? 0.25 : 0.25 + (atan2(p.x, p.z) + pi) / (2.0 * pi);
}

static double onion(const Pattern *pattern, Vec3 p)
{
    (void)pattern;
    return vec3_length(p);
}

static double leopard(const Pattern *pattern, Vec3 p)
{
    (void)pattern;
    double mean = (sin(p.x) + sin(p.y) + sin(p.z)) / 3.0;
    return mean * mean;
}

static double spherical(const Pattern *pattern, Vec3 p)
{
    (void)pattern;
    return fmax(1.0 - vec3_length(p), 0.0);
}

static double planar(const Pattern *pattern, Vec3 p)
{
    (void)pattern;
    return fmax(1.0 - fabs(p.y), 0.0);
}

static double boxed(const Pattern *pattern, Vec3 p)
{
    (void)pattern;
    return fmax(1.0 - vec3_max_abs(p), 0.0);
}

static double cylindrical(const Pattern *pattern, Vec3 p)
{
    (void)pattern;
    return fmax(1.0 - sqrt(p.x * p.x + p.z * p.z), 0.0);
}

typedef double (*ValueFunction)(const Pattern *pattern, Vec3 p);

static const ValueFunction values[PATTERN_COUNT] = {
    [PATTERN_GRADIENT] = gradient,       [PATTERN_RADIAL] = radial, [PATTERN_ONION] = onion,
    [PATTERN_LEOPARD] = leopard,         [PATTERN_SPHERICAL] = spherical, [PATTERN_PLANAR] = planar,
    [PATTERN_BOXED] = boxed,             [PATTERN_CYLINDRICAL] = cylindrical,
};

static double wave(const Pattern *pattern, double x)
{
    switch ((WaveType)pattern->wave) {
    case WAVE_RAMP: return x;
    case WAVE_TRIANGLE: return x < 0.5 ? 2.0 * x : 2.0 - 2.0 * x;
    case WAVE_SINE: return (1.0 + sin(2.0 * pi * x)) / 2.0;
    case WAVE_SCALLOP: return fabs(sin(pi * x));
    case WAVE_CUBIC: return x * x * (3.0 - 2.0 * x);
    case WAVE_POLY: return pow(x, pattern->exponent);
    }
    return x;
}

double pattern_value(const Pattern *pattern, Vec3 point)
{
    double x = values[pattern->type](pattern, point) * pattern->frequency + pattern->phase;
    return wave(pattern, x - floor(x));
}

// ---- blocks

static unsigned checker(const Pattern *pattern, Vec3 p)
{
    (void)pattern;
    double sum = floor(p.x) + floor(p.y) + floor(p.z);
    return (unsigned)fabs(fmod(sum, 2.0));
}

static unsigned hexagon(const Pattern *pattern, Vec3 p)
{
    (void)pattern;
    (void)p;
    return 0;
}

static unsigned brick(const Pattern *pattern, Vec3 p)
{
    (void)pattern;
    (void)p;
    return 0;
}

typedef unsigned (*BlockFunction)(const Pattern *pattern, Vec3 p);

static const BlockFunction blocks[PATTERN_COUNT] = {
    [PATTERN_CHECKER] = checker,
    [PATTERN_HEXAGON] = hexagon,
    [PATTERN_BRICK] = brick,
};

unsigned pattern_block(const Pattern *pattern, Vec3 point)
{
    return blocks[pattern->type](pattern, point);
}
