// Sampled pictures: rounds of samples, what each says of the error, and when it is enough. Private to src/render.
//
// A round gives each chosen pixel as many samples as it has, or nearly so, so that old and new ones are two halves
// whose difference tells of the error. Everything is decided between rounds from the pixels' records, in one order, so
// pictures and figures are the same for any number of threads. docs/sampling.md tells of the method.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SAMPLING_H
#define RENDER_SAMPLING_H

#include "render/prepared.h"
#include "render/render.h"

RenderResult sampling_run(const Prepared *prepared, const RenderOptions *options, Film *film,
                          RenderStatistics *statistics, SamplingError *error) RT_MUST_CHECK;

// ---- sampling_round.c: one round

typedef struct Round {
    const Prepared *prepared;
    const SamplingOptions *sampling;
    Film *film;
    Filter filter;
    const uint16_t *buckets; // by priority, of each pixel; NULL: all pixels take part
    uint16_t least_bucket;   // of those that take part
    uint32_t count;          // how many samples they shall have; 0: twice as many as they have
} Round;

static inline bool round_has(const Round *round, size_t pixel)
{
    return !round->buckets || round->buckets[pixel] >= round->least_bucket;
}

// The samples that a pixel gets in a round.
uint32_t round_samples(const Round *round, size_t pixel);

// Traces the samples of a tile's pixels.
void round_trace(const Round *round, Tile tile, RenderStatistics *counted);

// ---- sampling_estimate.c: figures

enum { LEVELS = 33 };

// Sums over pixels that have between 2^level and 2^(level+1) - 1 samples.
typedef struct LevelSums {
    double outer, inner;             // of pixels that came to it, as they came: nothing was chosen by these
    double outer_now, outer_squares; // of those that are there now
} LevelSums;

typedef struct Estimate {
    LevelSums levels[LEVELS];
    double ratio[LEVELS]; // by which variance is taken to fall when samples are doubled
    uint64_t samples;
} Estimate;

// After a round, which is whole unless it was cancelled: what it says of the ratios, and what all pixels say of the
// error.
void estimate_update(Estimate *estimate, const Film *film, const Round *round, bool is_whole, SamplingError *error);

// The level of a pixel with so many samples.
static inline int estimate_level(uint32_t count)
{
    return count > 1 ? 31 - __builtin_clz(count) : 0;
}

// ---- sampling_choice.c: where the next samples go, and how many it will take

// Pixels in classes of like priority; a finer one is of greater priority, by a factor of 2^(1/4).
enum { BUCKETS = 1024 };
typedef struct Choice {
    uint16_t *of_pixel;    // width * height; owned by the caller
    double cost[BUCKETS];  // samples that its pixels have
    double power;          // p: variances fall as n^-p
    uint16_t least_bucket; // of the next round
} Choice;

// Sorts all pixels and chooses the next round's.
void choice_make(Choice *choice, const Estimate *estimate, const Film *film);

// Samples in all that it takes to bring `high` to the target, predicted; 0 when it cannot be told.
double choice_predict(const Choice *choice, const Estimate *estimate, const SamplingError *error, double target);

#endif
