// Patterns made of noise, one small function for each.
//
// Turns a point into a number; owns constant data only. The formulas are POV-Ray's, found by experiment;
// docs/language.md, "Noise".
//
// SPDX-License-Identifier: MIT
#include "render/pattern_noise.h"

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

double pattern_granite(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    double sum = 0.0, weight = 1.0;
    for (int i = 0; i < 6; i++) {
        double value = noise_spread(source->noise, pattern_generator(pattern, source), vec3_scale(4.0 / weight, p));
        sum += weight * fabs(value - 0.5);
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

double pattern_marble(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    if (pattern->turbulence.x == 0.0) {
        return p.x;
    }
    Octaves octaves = octaves_of(pattern);
    return p.x + pattern->turbulence.x * noise_sum(source->noise, pattern_generator(pattern, source), &octaves, p);
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
    double sum = 0.0, scale = 1.0;
    for (int i = 0; i < 10; i++) {
        sum += noise_spread(source->noise, pattern_generator(pattern, source), vec3_scale(scale, p)) / (2.0 * scale);
        scale *= 2.0;
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

// The length of a way, or for a metric m (|x|^m + |y|^m + |z|^m + |offset|^m)^(1/m).
static double length_of(const Pattern *pattern, Vec3 way)
{
    double m = pattern->metric, x = fabs(way.x), y = fabs(way.y), z = fabs(way.z), w = fabs(pattern->offset);
    if (m == 2.0) {
        return sqrt(x * x + y * y + z * z + w * w);
    }
    return m == 1.0 ? x + y + z + w : pow(pow(x, m) + pow(y, m) + pow(z, m) + pow(w, m), 1.0 / m);
}

// The nearest sites, nearest first.
typedef struct Nearest {
    double way[3];
    Vec3 site; // the nearest of all
} Nearest;

static void keep_nearest(Nearest *nearest, double way, Vec3 site)
{
    if (way < nearest->way[0]) {
        nearest->site = site;
    }
    for (int i = 0; i < 3; i++) {
        if (way < nearest->way[i]) {
            double next = nearest->way[i];
            nearest->way[i] = way;
            way = next;
        }
    }
}

// How far p is from the unit cube that begins at `corner` by one coordinate.
static double gap(double p, double corner)
{
    return fmax(fmax(corner - p, p - corner - 1.0), 0.0);
}

// Cubes up to two away may hold one of the three; most of them are too far to look into.
static Nearest find_nearest(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    static const int order[] = {0, -1, 1, -2, 2};
    Nearest nearest = {.way = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, .site = p};
    Vec3 centre = whole(p);
    for (int i = 0; i < 125; i++) {
        Vec3 corner = vec3_add(centre, vec3(order[i / 25], order[i / 5 % 5], order[i % 5]));
        Vec3 least = vec3(gap(p.x, corner.x), gap(p.y, corner.y), gap(p.z, corner.z));
        if (length_of(pattern, least) < nearest.way[2]) {
            Vec3 site = noise_site(source->noise, corner);
            keep_nearest(&nearest, length_of(pattern, vec3_sub(p, site)), site);
        }
    }
    return nearest;
}

double pattern_crackle(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    Nearest nearest = find_nearest(pattern, source, p);
    if (pattern->is_solid) {
        return noise_value(source->noise, pattern_generator(pattern, source), nearest.site);
    }
    double sum = pattern->form.x * nearest.way[0] + pattern->form.y * nearest.way[1] +
                 pattern->form.z * nearest.way[2];
    return fmin(fmax(sum, 0.0), 1.0);
}
