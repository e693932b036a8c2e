// Patterns made of noise; private to pattern.c and normal_special.c.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SURFACE_PATTERN_NOISE_H
#define RENDER_SURFACE_PATTERN_NOISE_H

#include "render/surface/pattern.h"

// A pattern's value before frequency, phase and wave, at a point that turbulence has moved.
typedef double (*PatternFunction)(const Pattern *pattern, const NoiseSource *source, Vec3 p);

// Where the unit cubes of a point are counted from: POV-Ray's end 1e-10 before whole numbers, so that a surface that lies
// in whole numbers but for rounding is of one kind. Measured by halving, for checker, brick and cells; in the pattern's
// own space, so that the unit of a scene's lengths is nothing to it.
static inline Vec3 pattern_nudged(Vec3 p)
{
    const double before = 1e-10;
    return vec3(p.x + before, p.y + before, p.z + before);
}

double pattern_noise(const Pattern *pattern, const NoiseSource *source, Vec3 p);
// The same of many points.
void pattern_noises(const Pattern *pattern, const NoiseSource *source, unsigned count, const Vec3 *points,
                    double *values);
double pattern_granite(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double pattern_agate(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double pattern_marble(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double pattern_spiral1(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double pattern_spiral2(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double pattern_wood(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double pattern_wrinkles(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double pattern_dents(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double pattern_ripples(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double pattern_waves(const Pattern *pattern, const NoiseSource *source, Vec3 p);

double pattern_cells(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double pattern_crackle(const Pattern *pattern, const NoiseSource *source, Vec3 p);
NoiseGenerator pattern_generator(const Pattern *pattern, const NoiseSource *source);

// Where turbulence moves a point to.
Vec3 pattern_turbulent(const Pattern *pattern, const NoiseSource *source, Vec3 p);

#endif
