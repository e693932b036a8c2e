// The noise of the lattice: compiled once for each instruction set. Private to noise*.c.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_NOISE_KERNEL_H
#define MATH_NOISE_KERNEL_H

#include "math/noise.h"

// What the functions of math/noise.h do that are named so; all give the same bits.
struct NoiseKernel {
    const char *name; // of the instruction set
    bool (*is_supported)(void);
    double (*value)(const Noise *noise, NoiseGenerator generator, Vec3 p);
    double (*spread)(const Noise *noise, NoiseGenerator generator, Vec3 p);
    Vec3 (*vector)(const Noise *noise, Vec3 p);
    void (*values)(const Noise *noise, NoiseGenerator generator, unsigned count, const Vec3 *points, double *values);
    void (*vectors)(const Noise *noise, unsigned count, const Vec3 *points, Vec3 *vectors);
    double (*sum)(const Noise *noise, NoiseGenerator generator, const Octaves *octaves, Vec3 p);
    Vec3 (*vector_sum)(const Noise *noise, const Octaves *octaves, Vec3 p);
};

// At a lattice point whose hash is h, half of noise_numbers[h] is the value and the three numbers after it are the
// gradient; of the second and third component of noise_vector, the same from h + 4 and h + 8 on.
extern const double noise_numbers[NOISE_LATTICE + 8];

static inline double noise_cut(double x)
{
    return x > 0.0 ? x < 1.0 ? x : 1.0 : 0.0;
}

static inline double noise_spread_of(NoiseGenerator generator, double value)
{
    return generator == NOISE_ORIGINAL ? value : noise_cut(2.0 * value - 0.5);
}

#endif
