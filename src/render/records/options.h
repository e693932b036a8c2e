// How a picture is requested, and what is reported of it besides its light: options, progress, counts and errors.
//
// Plain data of the caller's; read-only while a picture is traced.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_RECORDS_OPTIONS_H
#define RENDER_RECORDS_OPTIONS_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "render/points/filter.h"
#include "render/points/sampler.h"
#include "render/records/tile_share.h"

// A scene for its kernel (render/records/prepared.h).
typedef struct Prepared Prepared;

typedef struct RenderStatistics {
    uint64_t camera_rays, shadow_rays, reflected_rays, transmitted_rays;
    // Shares of camera rays, in units of 2^-32, that were not followed: beyond max_trace_level, below adc_bailout.
    uint64_t cut_by_level, cut_by_weight;
} RenderStatistics;

// Where a pixel has enough: its mean is taken to be no farther off than the root of `variance`, with a probability of
// `confidence`. Then `samples` is the most that a pixel gets.
typedef struct SamplingStop {
    double variance;   // in the scene's working space; 0: all samples are taken
    double confidence; // between 0 and 1
    int least;         // samples of a pixel
} SamplingStop;

static inline bool stop_is_wanted(const SamplingStop *stop)
{
    return stop->variance > 0.0;
}

// Several rays a pixel; docs/sampling.md describes the method.
typedef struct SamplingOptions {
    SamplerKind sampler;
    FilterKind filter;
    uint64_t seed;
    double samples;      // a pixel, >= 2, a whole number unless adaptive; or 0: as many as the goals want
    bool is_adaptive;    // more where the error is; `samples` is then the mean. Goals need it
    double target_error; // root mean square, in linear light; 0: none
    double time_limit;   // seconds; 0: none
    bool has_no_estimate; // the same picture without its error
    SamplingStop stop;    // of pixels; not with is_adaptive
    bool no_pixel_errors; // render_pixel_error is not asked for: of a large picture some pixels are enough
} SamplingOptions;

// POV-Ray's ways to take more rays where colours differ; see render/sample/antialias.h.
typedef struct AntialiasOptions {
    int method;       // 1: more rays in pixels that differ from a neighbour, 2: squares whose corners differ, parted
    int depth;        // 1 to 9. Method 1: its square is how many more rays; 2: squares are parted one time less
    double threshold; // >= 0, of the sum of the differences of red, green and blue
    double gamma;     // > 0; colours are compared after their 1/gamma-th power
} AntialiasOptions;

// Why a sampled run ended.
typedef enum SamplingEnd { SAMPLING_DONE, SAMPLING_TARGET, SAMPLING_TIME, SAMPLING_INTERRUPTED } SamplingEnd;

// Of what is no more than a few pixels wide and can be seen, what no sample of any pixel met.
enum { SMALL_SHAPE, SMALL_HIGHLIGHT, SMALL_KINDS };
typedef struct UnmetShapes {
    double count, area; // the second in pixels
} UnmetShapes;

// The error of a picture: what sampling leaves, not what its model or its arithmetic do.
typedef struct SamplingError {
    bool is_known;
    double rmse, low, high; // root mean square, linear light, and the ends of its 95 % interval
    double samples;         // a pixel, in the mean
    double slope;           // of the logarithm of rmse in that of samples, as it is taken to continue; < 0
    double pixel_scale;     // of render_pixel_error, so that its mean square is that of rmse
    UnmetShapes unmet[SMALL_KINDS]; // what they would bring is in the error
    bool unmet_is_all;      // they were counted; else there are about so many
    // A detail of whatever kind that samples may have missed in a pixel: its area in pixels at the most, with 95 %, and
    // the rmse that it would bring, were it the picture's whole range from what is around it.
    double missed_area, missed_error;
    double bias;            // what rays that were not followed would add at the least; more samples do not help
    double bias_by_level;   // of it: beyond max_trace_level; the rest is below adc_bailout
    SamplingEnd end;
} SamplingError;

typedef struct RenderProgress {
    double done;                // 0 to 1, of the run, or of what is predicted of it
    const SamplingError *error; // NULL: one ray a pixel
    double seconds_left;        // predicted; < 0: not known
} RenderProgress;

typedef struct RenderOptions {
    int threads; // >= 1; as many are used as there are tiles to share
    // Called now and then by one thread at a time. May be NULL.
    void (*progress)(void *client, const RenderProgress *progress);
    void *client;
    const atomic_bool *cancel;       // when it turns true, work stops soon; may be NULL
    const SamplingOptions *sampling; // NULL: one ray through the middle of each pixel, area lights as grids
    const AntialiasOptions *antialias; // without `sampling`: more rays where needed; NULL: none
    const TileShare *share;            // NULL: all tiles are traced here
} RenderOptions;

typedef enum RenderResult {
    RENDER_OK,
    RENDER_CANCELLED,
    RENDER_NO_MEMORY,
    RENDER_NOT_SHARED, // TILE_SHARE_BROKEN
} RenderResult;

#endif
