// Patterns made of noise, one small function for each.
//
// Turns a point into a number; owns constant data only. The formulas are POV-Ray's, found by experiment;
// docs/language.md, "Noise".
//
// SPDX-License-Identifier: MIT
#include "render/surface/pattern_noise.h"

#include <math.h>

static const double two_pi = 6.28318530717958647693;

NoiseGenerator pattern_generator(const Pattern *pattern, const NoiseSource *source)
{
    return pattern->generator != 0 ? noise_generator(pattern->generator) : source->generator;
}

static Octaves octaves_of(const Pattern *pattern)
{
    return (Octaves){pattern->lambda, pattern->omega, (unsigned)pattern->octaves};
}

static double sine_wave(double x)
{
    return (1.0 + sin(two_pi * x)) / 2.0;
}

double pattern_noise(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    return noise_value(source->noise, pattern_generator(pattern, source), p);
}

void pattern_noises(const Pattern *pattern, const NoiseSource *source, unsigned count, const Vec3 *points,
                    double *values)
{
    noise_values(source->noise, pattern_generator(pattern, source), count, points, values);
}

double pattern_granite(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    enum { OCTAVES = 6 };
    Vec3 points[OCTAVES];
    double values[OCTAVES], sum = 0.0, weight = 1.0;
    for (int i = 0; i < OCTAVES; i++) {
        points[i] = vec3_scale((double)(4 << i), p);
    }
    noise_spreads(source->noise, pattern_generator(pattern, source), OCTAVES, points, values);
    for (int i = 0; i < OCTAVES; i++) {
        sum += weight * fabs(values[i] - 0.5);
        weight /= 2.0;
    }
    return sum;
}

double pattern_agate(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    Octaves octaves = octaves_of(pattern);
    double sum = noise_sum(source->noise, pattern_generator(pattern, source), &octaves, p);
    return pow(sine_wave(1.3 * pattern->agate_turb * sum + 1.1 * p.z), 0.77);
}

// What turbulence adds to the value of some patterns.
static double turbulent_part(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    if (pattern->turbulence.x == 0.0) {
        return 0.0;
    }
    Octaves octaves = octaves_of(pattern);
    return pattern->turbulence.x * noise_sum(source->noise, pattern_generator(pattern, source), &octaves, p);
}

double pattern_marble(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    return p.x + turbulent_part(pattern, source, p);
}

// The arms begin at -y and turn towards +x. Turbulence has moved the point, and adds to the value there. Measured.
double pattern_spiral1(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    double turn = atan2(p.y, p.x) / two_pi + 0.25;
    double arms = pattern->count * (turn < 0.0 ? turn + 1.0 : turn);
    return p.z + sqrt(p.x * p.x + p.y * p.y) + arms + turbulent_part(pattern, source, p);
}

static double triangle_wave(double x)
{
    x -= floor(x);
    return x < 0.5 ? 2.0 * x : 2.0 - 2.0 * x;
}

// Rings, and the arms of spiral1 upon them. Measured.
double pattern_spiral2(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    return triangle_wave(sqrt(p.x * p.x + p.y * p.y)) + triangle_wave(pattern_spiral1(pattern, source, p));
}

double pattern_wood(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    if (vec3_max_abs(pattern->turbulence) > 0.0) {
        Octaves octaves = octaves_of(pattern);
        Vec3 noise = noise_vector_sum(source->noise, &octaves, p);
        p.x += sin(two_pi * pattern->turbulence.x * (p.x + noise.x));
        p.y += sin(two_pi * pattern->turbulence.y * (p.y + noise.y));
    }
    return sqrt(p.x * p.x + p.y * p.y);
}

double pattern_wrinkles(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    enum { OCTAVES = 10 };
    Vec3 points[OCTAVES];
    double values[OCTAVES], sum = 0.0;
    for (int i = 0; i < OCTAVES; i++) {
        points[i] = vec3_scale((double)(1 << i), p);
    }
    noise_spreads(source->noise, pattern_generator(pattern, source), OCTAVES, points, values);
    for (int i = 0; i < OCTAVES; i++) {
        sum += values[i] / (double)(2 << i);
    }
    return sum;
}

double pattern_dents(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    double value = noise_value(source->noise, pattern_generator(pattern, source), p);
    return value * value * value;
}

// Frequency and phase change the waves, too, before they change the map.
double pattern_ripples(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    double sum = 0.0;
    for (unsigned i = 0; i < source->wave_count; i++) {
        double way = vec3_length(vec3_sub(p, source->waves[i].place));
        sum += sine_wave(way * pattern->frequency + pattern->phase);
    }
    return sum / source->wave_count;
}

double pattern_waves(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    double sum = 0.0;
    for (unsigned i = 0; i < source->wave_count; i++) {
        double way = vec3_length(vec3_sub(p, source->waves[i].place)), frequency = source->waves[i].frequency;
        sum += sin(two_pi * (way * pattern->frequency * frequency + pattern->phase)) / frequency;
    }
    return 0.5 + 0.2 * sum / source->wave_count;
}

Vec3 pattern_turbulent(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    Octaves octaves = octaves_of(pattern);
    return vec3_add(p, vec3_mul(pattern->turbulence, noise_vector_sum(source->noise, &octaves, p)));
}

// ---- cells

static Vec3 whole(Vec3 p)
{
    return vec3(floor(p.x), floor(p.y), floor(p.z));
}

double pattern_cells(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)pattern;
    return noise_cell(source->noise, whole(pattern_nudged(p)));
}
