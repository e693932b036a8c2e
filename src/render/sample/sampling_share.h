// Pixels that outlines of spheres cross: their samples are summed by stratum, whose shares of the pixel are known.
//
// A stratum is what one outline has of a pixel and none before it has, or what is in none. The mean of each stratum's
// own samples, times its share, is free of the error of how many samples fell on which side of an edge. It is right
// whatever is seen there: what is before what decides only how much it gains. Private to src/render; docs/sampling.md,
// "Edges of spheres".
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SAMPLE_SAMPLING_SHARE_H
#define RENDER_SAMPLE_SAMPLING_SHARE_H

#include "math/colour.h"
#include "render/records/prepared.h"
#include "render/sample/sample.h"
#include "render/sample/sampling_outline.h"

enum { STRATA_MOST = OUTLINES_MOST + 1 };

enum { SHARE_SAMPLES = 8 }; // of each pixel: with fewer it is not worth its cost

typedef struct ShareStratum {
    Outline outline; // around the pixel's middle; the last one has none
    double area;
    uint32_t taken; // samples so far
    float mean[3];  // of these
} ShareStratum;

// How far the strata of a pixel are from each other that have samples: the square, the part of the pixel it counts for,
// and the mean square over the pixel and those around it, in linear light.
typedef struct ShareContrast {
    float square, weight, around;
    float sliver;     // what strata have of the pixel that are too small for its samples
    uint32_t samples; // of the pixel, that the square and the sliver are of
} ShareContrast;

// What is known of a film.
typedef struct Share {
    uint32_t *first; // of each pixel's strata; one more for the end
    uint32_t *pixels; // that have any; of a picture of which some tell of the error, at last those of them that do
    uint32_t pixel_count;
    ShareStratum *strata;
    size_t capacity;
    ShareContrast *contrasts; // of each pixel that has strata, where its first is; 0 before share_set_contrasts
} Share;

// New samples of a pixel: its first and second half.
typedef struct ShareSums {
    ShareStratum *strata;
    int count;
    bool starts; // sums are of quarters
    uint32_t taken[2][STRATA_MOST];
    Rgb sum[2][STRATA_MOST];
} ShareSums;

// NULL where there is nothing to know; sets *has_memory to false when out of memory.
Share *share_new(const Prepared *prepared, const Film *film, bool *has_memory);
void share_free(Share *share);

static inline bool share_has(const Share *share, size_t pixel)
{
    return share && share->first[pixel + 1] > share->first[pixel];
}

// Sums without samples; NULL where the pixel has no strata.
static inline ShareSums *share_begin(const Share *share, size_t pixel, bool starts, ShareSums *sums)
{
    if (!share_has(share, pixel)) {
        return NULL;
    }
    sums->strata = &share->strata[share->first[pixel]];
    sums->count = (int)(share->first[pixel + 1] - share->first[pixel]);
    sums->starts = starts;
    for (int i = 0; i < 2 * sums->count; i++) {
        sums->taken[i % 2][i / 2] = 0;
        sums->sum[i % 2][i / 2] = rgb_grey(0.0);
    }
    return sums;
}

// Adds samples of one part, by their places beside the pixel's corner.
void share_add(ShareSums *sums, uint32_t part, const double *x, const double *y, const Rgb *light, int count);

// Means by shares.
typedef struct ShareMeans {
    Rgb before, fresh, all; // of the samples that were there, of the new ones, and of all
    Rgb halves[2];          // of the new ones
    Rgb between;            // the mean square of the strata's means in the new ones
} ShareMeans;

// The variance of the mean of a pixel's samples, of which there are `count`, that strata bring which are too small to
// be weighted by their shares: as share_set_contrasts knows it. The pixel has strata.
static inline double share_variance(const Share *share, size_t pixel, double count)
{
    const ShareContrast *contrast = &share->contrasts[share->first[pixel]];
    return contrast->sliver > 0.0f ? (double)contrast->around * (double)contrast->sliver / count : 0.0;
}

// The mean of new samples.
Rgb share_mean(const ShareSums *sums);

// Means; of samples that are not judged, that of all only; `between` if it is asked for. Then the new samples are in
// the strata.
void share_close(ShareSums *sums, bool has_before, bool is_judged, bool has_between, ShareMeans *means);

#endif
