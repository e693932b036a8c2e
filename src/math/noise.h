// Noise: smooth random numbers over space, the same as POV-Ray's three generators give.
//
// A point becomes a number, or a vector of three. How each generator works was found by evaluating POV-Ray's functions
// at chosen points; docs/language.md, "Noise", says how, and what the numbers of noise.c are. The tables are computed
// once by whoever needs noise, and only read afterwards.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_NOISE_H
#define MATH_NOISE_H

#include <stdint.h>

#include "math/vec3.h"

enum {
    NOISE_CELLS = 4096,     // period of the first two generators, of the shuffled numbers below it
    NOISE_GRADIENTS = 2048, // period of the third
    NOISE_SITES = NOISE_CELLS + 2,
    NOISE_LATTICE = 256 + 3, // numbers of the first two generators at their lattice points
};

typedef enum NoiseGenerator {
    NOISE_ORIGINAL = 1, // gradients and values at lattice points, cut to 0 and 1
    NOISE_CORRECTED,    // the same, stretched so that nothing is cut
    NOISE_PERLIN,       // gradients only, as in K. Perlin, "An Image Synthesizer", SIGGRAPH 1985
} NoiseGenerator;

typedef struct NoiseKernel NoiseKernel; // private to noise*.c

typedef struct Noise {
    const NoiseKernel *kernel;
    _Alignas(16) double lattice[NOISE_LATTICE][4]; // of each number that of each component, and 0
    uint16_t hash[NOISE_CELLS];
    uint16_t order[NOISE_GRADIENTS];
    Vec3 gradients[NOISE_GRADIENTS]; // of unit length
    double sites[NOISE_SITES];       // from 0 to 1, see noise_site
} Noise;

// `isa`: the name of the instruction set to use, which this processor must have; NULL for its best one.
void noise_init(Noise *noise, const char *isa);

// The nearest generator to a number of the language; 0 stands for none.
NoiseGenerator noise_generator(double number);

// From 0 to 1.
double noise_value(const Noise *noise, NoiseGenerator generator, Vec3 p);
// Of many points, four at a time.
void noise_values(const Noise *noise, NoiseGenerator generator, unsigned count, const Vec3 *points, double *values);

// The same with its middle half stretched to fill 0 to 1, but for the first generator, which is as it is.
double noise_spread(const Noise *noise, NoiseGenerator generator, Vec3 p);

// Of many points, likewise.
void noise_spreads(const Noise *noise, NoiseGenerator generator, unsigned count, const Vec3 *points, double *spreads);

// Three independent numbers around 0, the first generator's first.
Vec3 noise_vector(const Noise *noise, Vec3 p);
// Of many points, likewise.
void noise_vectors(const Noise *noise, unsigned count, const Vec3 *points, Vec3 *vectors);

// Of the unit cube from `corner`, whose coordinates are whole, to <1, 1, 1> beyond: a number from 0 to 1, and a point
// in it.
double noise_cell(const Noise *noise, Vec3 corner);
Vec3 noise_site(const Noise *noise, Vec3 corner);

// How noise is added up: octave i (from 0) is finer by lambda^i and weighs omega^i.
typedef struct Octaves {
    double lambda, omega;
    unsigned count; // at least 1
} Octaves;

// A sum of numbers that are mostly from 0 to 1.
double noise_sum(const Noise *noise, NoiseGenerator generator, const Octaves *octaves, Vec3 p);
// A sum of noise_vector.
Vec3 noise_vector_sum(const Noise *noise, const Octaves *octaves, Vec3 p);

// Where waves of `ripples` and `waves` come from.
typedef struct WaveSource {
    Vec3 place;       // at distance 1 from the origin
    double frequency; // of `waves`: waves per unit length, from 0.01 to 1.01
} WaveSource;

// The first `count` sources of an endless list.
void noise_wave_sources(const Noise *noise, unsigned count, WaveSource *sources);

#endif
