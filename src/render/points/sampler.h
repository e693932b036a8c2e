// Points to sample at: numbers in [0, 1) keyed by (seed, pixel, sample, dimension), two dimensions at a time.
//
// Turns the place of a sample into points of a square. It keeps nothing, so a picture is the same for any number of
// threads and any order of pixels. Each pair of dimensions is the two-dimensional Sobol sequence, scrambled and
// shuffled by hashing, two pairs in orders that make points of four dimensions of them: I. Sobol, "On the distribution
// of points in a cube", 1967, with the direction numbers of S. Joe and F. Kuo, "Constructing Sobol sequences with
// better two-dimensional projections", SIAM J. Sci. Comput. 30, 2008; A. Owen, "Randomly permuted (t,m,s)-nets and
// (t,s)-sequences", 1995; S. Laine and T. Karras, "Stratified sampling for stochastic transparency", EGSR 2011; B.
// Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_POINTS_SAMPLER_H
#define RENDER_POINTS_SAMPLER_H

#include <stdbool.h>
#include <stdint.h>

// The first is the one to use; the others are for comparison.
typedef enum SamplerKind {
    SAMPLER_SOBOL,    // Owen-scrambled
    SAMPLER_HALTON,   // in bases 2 and 3, digits shifted at random; J. Halton, 1960
    SAMPLER_JITTERED, // one point at random in each cell of a grid
    SAMPLER_GRID,     // a regular grid, shifted at random
    SAMPLER_RANDOM,
    SAMPLER_COUNT,
} SamplerKind;

// "sobol", …; NULL for SAMPLER_COUNT.
const char *sampler_name(SamplerKind kind);

// Whether any first part of a pixel's points is as good as a set of its own. The others are made in two halves.
static inline bool sampler_is_sequence(SamplerKind kind)
{
    return kind != SAMPLER_JITTERED && kind != SAMPLER_GRID;
}

typedef struct SamplePoint {
    double x, y; // in [0, 1)
} SamplePoint;

// One sample of one pixel, and how many of its dimensions have been taken.
typedef struct SampleStream {
    SamplerKind kind;
    uint32_t seed;         // sampler_pixel_seed
    uint32_t index;        // of the sample
    uint32_t first, count; // not a sequence: the set that the sample belongs to
    uint32_t pair;         // the next two dimensions
} SampleStream;

uint32_t sampler_pixel_seed(uint64_t seed, uint32_t x, uint32_t y);

// The next two dimensions.
SamplePoint sample_next(SampleStream *stream);

// Dimension 0 or 1 of the Sobol sequence as a fraction of 2^32.
uint32_t sobol_value(uint32_t index, unsigned dimension);

#endif
