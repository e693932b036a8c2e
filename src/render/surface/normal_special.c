// Bumps that turn a normal by a vector of their own: one small function for each.
//
// Turns a point into a vector; owns constant data only. The formulas are POV-Ray's, found by experiment;
// docs/language.md, "Bumps".
//
// SPDX-License-Identifier: MIT
#include "render/surface/normal_special.h"

#include <math.h>

#include "render/surface/pattern_noise.h"

static const double two_pi = 6.28318530717958647693;

static Vec3 bumps(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)pattern;
    return noise_vector(source->noise, p);
}

static Vec3 dents(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    double value = noise_value(source->noise, pattern_generator(pattern, source), p);
    return vec3_scale(value * value * value, noise_vector(source->noise, p));
}

static Vec3 wrinkles(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)pattern;
    enum { OCTAVES = 10 };
    Vec3 points[OCTAVES], vectors[OCTAVES], sum = vec3(0.0, 0.0, 0.0);
    for (int i = 0; i < OCTAVES; i++) {
        points[i] = vec3_scale((double)(1 << i), p);
    }
    noise_vectors(source->noise, OCTAVES, points, vectors);
    for (int i = 0; i < OCTAVES; i++) {
        Vec3 size = vec3(fabs(vectors[i].x), fabs(vectors[i].y), fabs(vectors[i].z));
        sum = vec3_add_scaled(sum, 1.0 / (double)(1 << i), size);
    }
    return sum;
}

// Away from each source by the wave's height.
static Vec3 waves_of(const Pattern *pattern, const NoiseSource *source, Vec3 p, bool has_frequencies)
{
    Vec3 sum = vec3(0.0, 0.0, 0.0);
    for (unsigned i = 0; i < source->wave_count; i++) {
        Vec3 offset = vec3_sub(p, source->waves[i].place);
        double way = vec3_length(offset), frequency = has_frequencies ? source->waves[i].frequency : 1.0;
        if (way > 0.0) {
            double height = sin(two_pi * (way * pattern->frequency * frequency + pattern->phase)) / frequency;
            sum = vec3_add_scaled(sum, height / (source->wave_count * way), offset);
        }
    }
    return sum;
}

static Vec3 ripples(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    return waves_of(pattern, source, p, false);
}

static Vec3 waves(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    return waves_of(pattern, source, p, true);
}

// Below zero a whole number belongs to the cube below it. Measured.
static double in_cube(double x)
{
    return x < 0.0 ? x + floor(-x) + 1.0 : x - floor(x);
}

// 2 / sqrt(3) with as many digits as POV-Ray has of it. Measured.
static const double quilt_steepness = 1.154700538;

// Away from the middle of each unit cube, by a cubic of the distance.
static Vec3 quilted(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)source;
    Vec3 offset = vec3(in_cube(p.x) - 0.5, in_cube(p.y) - 0.5, in_cube(p.z) - 0.5);
    double t = vec3_length(offset), rest = 1.0 - t;
    double height = t * (t * (t + 3.0 * rest * pattern->vector.y) + 3.0 * rest * rest * pattern->vector.x);
    return vec3_scale(quilt_steepness * height, offset);
}

typedef Vec3 (*NormalFunction)(const Pattern *pattern, const NoiseSource *source, Vec3 p);

static const NormalFunction functions[PATTERN_COUNT] = {
    [PATTERN_BUMPS] = bumps,     [PATTERN_DENTS] = dents, [PATTERN_WRINKLES] = wrinkles,
    [PATTERN_RIPPLES] = ripples, [PATTERN_WAVES] = waves, [PATTERN_QUILTED] = quilted,
};

Vec3 normal_special(const Pattern *pattern, const NoiseSource *source, Vec3 point)
{
    return functions[pattern->type](pattern, source, point);
}
