// Sampled pictures: rounds of samples, what each says of the error, and when it is enough. Private to src/render.
//
// A round gives each chosen pixel as many samples as it has, or nearly so, so that old and new ones are two halves
// whose difference tells of the error. Everything is decided between rounds from the pixels' records, in one order, so
// pictures and figures are the same for any number of threads. docs/sampling.md tells of the method.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SAMPLE_SAMPLING_H
#define RENDER_SAMPLE_SAMPLING_H

#include "render/points/sampler_many.h"
#include "render/points/sobol.h"
#include "render/records/film.h"
#include "render/records/options.h"
#include "render/records/prepared.h"
#include "render/sample/sample.h"
#include "render/sample/sampling_share.h"
#include "render/sample/sampling_small.h"
#include "render/sample/tiles.h"

RenderResult sampling_run(const Prepared *prepared, const RenderOptions *options, Film *film,
                          RenderStatistics *statistics, SamplingError *error) RT_MUST_CHECK;

// ---- sampling_round.c: one round

typedef struct Round {
    const Prepared *prepared;
    const SamplingOptions *sampling;
    Film *film;
    Filter filter;
    const uint16_t *buckets; // by priority, of each pixel; NULL: all pixels take part
    const uint16_t *blocks;  // the greatest of each block of KERNEL_ROW by KERNEL_ROW pixels; NULL: not known
    uint16_t least_bucket;   // of those that take part
    bool is_cut;             // only pixels with keys from least_key up to end_key take part (round_key)
    uint32_t least_key, end_key;
    uint32_t count;          // how many samples they shall have; 0: twice as many as they have
    float *corners;          // of the picture's pixels, rows of width + 1 colours; NULL: not kept any more
    Share *share;            // NULL: no pixel has strata
    Small *small;            // NULL: there are no small shapes, or nobody asks for the error
    bool has_corners; // a pixel with one sample has the mean of its corners: what continues from there starts anew
    bool draws_more;         // than the place in the pixel: for area lights or a lens
    bool is_corners;         // these rays
    bool is_corner_pass;           // pixels that start are to say how good their corners were
    bool counts_some;        // the error is taken from those of one block in JUDGED_SHARE, chosen by chance
} Round;

enum { JUDGED_SHARE = 8, JUDGED_BLOCK = KERNEL_ROW };

// Whether a pixel tells of the error. Blocks are those of the whole picture.
static inline bool round_counts_for_error(const Round *round, int left, int top)
{
    uint32_t x = (uint32_t)(round->film->left + left) / JUDGED_BLOCK,
             y = (uint32_t)(round->film->top + top) / JUDGED_BLOCK;
    return !round->counts_some ||
           sample_hash_add((uint32_t)round->sampling->seed, y << 16 ^ x) % JUDGED_SHARE == 0;
}

// The film's part of the next block of the picture that tells of the error, in rows, after {0}; false after the last.
bool round_next_judged(const Round *round, Tile *block);

// Whether a pixel is as far off as another set of samples would be. One that is made of corners is not, nor one of
// which it is known that it has met all small shapes that are in it, since another set may not have; nor is any where
// samples went by what was seen: one that was left with few seemed better than it is.
static inline bool round_is_like_replica(const Round *round, size_t pixel)
{
    return !round->buckets && round->film->records[pixel].count > 1 && !small_has(round->small, pixel);
}

// Takes round->share->contrasts from the samples that strata have so far.
void share_set_contrasts(const Round *round);

enum { START_SAMPLES = 4 };

// Whether a pixel that has so many samples starts anew.
static inline bool round_starts(const Round *round, uint32_t count)
{
    return round->has_corners && count == 1 && round->count == 0;
}

// A round that is cut short goes by bucket and within a bucket by chance, in so many steps. The greatest keys are first.
enum { CUT_BITS = 8, CUT_STEPS = 1 << CUT_BITS };
static inline uint32_t round_key(const Round *round, size_t pixel)
{
    uint32_t chance = sample_hash_add((uint32_t)round->sampling->seed, (uint32_t)pixel) >> (32 - CUT_BITS);
    return (uint32_t)round->buckets[pixel] << CUT_BITS | chance;
}

static inline bool round_has(const Round *round, size_t pixel)
{
    if (!round->buckets) {
        return true;
    }
    if (round->buckets[pixel] < round->least_bucket || !round->is_cut) {
        return round->buckets[pixel] >= round->least_bucket;
    }
    uint32_t key = round_key(round, pixel);
    return key >= round->least_key && key < round->end_key;
}

// How many blocks, whole or not, are along so many pixels.
static inline size_t round_blocks(int pixels)
{
    return ((size_t)pixels + KERNEL_ROW - 1) / KERNEL_ROW;
}

// A pixel that takes part.
typedef struct ChosenPixel {
    int x, y;
    size_t index;
    uint32_t count; // samples that it gets
    bool starts;    // anew
    bool is_judged; // its samples are to tell of its error
    bool has_open;  // small shapes that none of its samples has met
    uint32_t replica; // another set of points than the pixel's own; 0: that
} ChosenPixel;

// Sums over the halves of a pixel's new samples; over their quarters where the pixel starts.
typedef struct SampleSums {
    Rgb sum[START_SAMPLES];
    Rgb squares;  // over all
    double clear; // the same of the shares of what is behind the scene; with has_alpha
    ShareSums *shares; // by stratum; NULL: the pixel has none
} SampleSums;

// A pixel that ends where it has enough: two sets of samples of their own.
typedef struct StopPixel {
    int x, y;
    size_t index;
    uint32_t replica;  // as of a ChosenPixel
    uint32_t count[2]; // of each set
} StopPixel;

enum { STOP_PIXELS = TILE_SIZE * TILE_SIZE / 2 }; // at once

// What a thread needs for a tile.
typedef struct RoundScratch {
    ChosenPixel chosen[TILE_SIZE * TILE_SIZE];
    SampleSums sums[TILE_SIZE * TILE_SIZE];
    ShareSums shares[TILE_SIZE * TILE_SIZE]; // of those
    StopPixel stop[STOP_PIXELS];
} RoundScratch;

// Traces the rays through the corners of pixels: a tile of the picture that these make.
void round_trace_corners(const Round *round, Tile tile, RenderScratch *scratch, RenderStatistics *counted);

// Traces the samples of a tile's pixels.
void round_trace(const Round *round, Tile tile, RenderScratch *scratch, RenderStatistics *counted);

// sampling_bytes.c: what these left of a tile, which is the same for stop_trace, below.
void round_code_corners(const Round *round, Tile tile, TileBytes *bytes);
void round_code(const Round *round, Tile tile, TileBytes *bytes);

// ---- sampling_stop.c: pixels that end where they have enough

// Whether the samples that are wanted suffice to choose by: else all are taken.
bool stop_has_choice(const SamplingOptions *sampling);

// Traces all samples of a tile's pixels, of a round whose `count` is the most.
void stop_trace(const Round *round, Tile tile, RenderScratch *scratch, RenderStatistics *counted);

// ---- sampling_estimate.c: figures

enum { LEVELS = 33, CORNER_PASS_SORTS = 32 };

// Sums over pixels that have between 2^level and 2^(level+1) - 1 samples.
typedef struct LevelSums {
    double outer, inner;             // of pixels that came to it, as they came: nothing was chosen by these
    double squares;                  // of these outer ones
    double outer_now, outer_squares; // of those that are there now
    double inner_now;
} LevelSums;

typedef struct Estimate {
    LevelSums levels[LEVELS];
    double ratio[LEVELS]; // by which variance is taken to fall when samples are doubled
    uint64_t samples;
    double judged;  // pixels that tell of the error
    double corners; // rays through them, which are in no pixel's count
    // Of pixels that have their corners only, by sort: what each is taken to be off by, squared, the sum of these, and
    // its relative variance.
    double sort_mean[CORNER_PASS_SORTS], sort_sum[CORNER_PASS_SORTS], sort_variance[CORNER_PASS_SORTS];
} Estimate;

// Before the first round: which pixels tell of the error.
void estimate_begin(Estimate *estimate, const Round *round);

// After a round, which is whole unless it was cancelled: what it says of the ratios, and what all pixels say of the
// error.
void estimate_update(Estimate *estimate, const Film *film, const Round *round, bool is_whole, SamplingError *error);

// The same after pixels were judged otherwise.
void estimate_now(Estimate *estimate, const Film *film, const Round *round, SamplingError *error);

// The level of a pixel with so many samples.
static inline int estimate_level(uint32_t count)
{
    return count > 1 ? 31 - __builtin_clz(count) : 0;
}

// ---- sampling_audit.c: what the picture is off by, from pixels that are sampled once more

enum {
    AUDIT_MOST = 512,    // picks
    AUDIT_SAMPLES = 16, // of a replica of a pixel that has its corners only
};

// A replica of a pixel: as many samples as it has, under another scrambling.
typedef struct AuditPick {
    size_t pixel;
    uint32_t replica; // from 1, of several of one pixel
    double weight;    // the inverse of the pixel's share of the draw
    double square;    // what the replica says that the pixel is off by, squared; may be below 0 by chance
    bool is_certain;  // the pixel is drawn for sure, several times
    bool is_pair;     // it is the product of how far two replicas are from the pixel:
    Rgb apart[2];     // these
} AuditPick;

typedef struct Audit {
    AuditPick picks[AUDIT_MOST];
    int count;
    double size;         // the sum of all pixels' shares
    double step;         // of that, what a pick stands for
    double own_variance; // of the picture's mean square error about its expectation, relative
} Audit;

// Draws pixels from what is known of all; returns how many, 0 when no pixel is taken to be off by anything.
int audit_draw(Audit *audit, const Estimate *estimate, const Round *round);

// The interval of 95 % of the root of a mean square that is known to so much of itself, as a standard deviation: a
// factor, since errors are never below 0; of more than the whole, the upper end grows as the root does.
void error_set_interval(SamplingError *error, double relative);

// That of an error which has an interval.
double error_relative(const SamplingError *error);

// When round_trace_replicas has put in the squares: sets the error and its interval.
void audit_judge(const Audit *audit, const Estimate *estimate, SamplingError *error);

// sampling_round.c: traces the replicas of the picks from `begin` on, which changes no pixel.
void round_trace_replicas(const Round *round, Audit *audit, int begin, int end, RenderScratch *scratch,
                          RenderStatistics *counted);

// sampling_bytes.c: what this left of the picks from `begin` on.
void audit_code(Audit *audit, int begin, int end, TileBytes *bytes);

// ---- sampling_look.c: what small shapes would bring that no sample has met

enum { LOOK_MOST = 1024 };

// A pixel that holds such shapes. May be drawn more than once.
typedef struct LookPick {
    size_t pixel;
    uint32_t number; // of the pixel's picks
    double weight;   // the inverse of the pixel's share of the draw
    Rgb sums[2];   // how far the shapes' light is from the pixel's, times their shares: by first rays, and by second
} LookPick;

typedef struct Looks {
    LookPick picks[LOOK_MOST];
    int count;
    uint32_t pass;
    bool sees_all;           // each pixel with such shapes is among them
    double square, variance; // the sum of the squares of what pixels are off by for such shapes; of that
    UnmetShapes unmet[SMALL_KINDS];
} Looks;

// Draws pixels; returns how many, 0 when samples have met all small shapes. `samples`: taken so far.
int look_draw(Looks *looks, const Round *round, double samples);

// Looks at the shapes of a tile's pixels, which changes no pixel.
void look_trace(const Round *round, Looks *looks, Tile tile, RenderScratch *scratch, RenderStatistics *counted);

// sampling_bytes.c: what this left of a tile.
void look_code(const Round *round, Looks *looks, Tile tile, TileBytes *bytes);

// When all tiles are done.
void look_judge(Looks *looks, const Round *round);

// Adds what they say to the error of all else, of so many pixels.
void look_tell(const Looks *looks, double pixels, SamplingError *error);

// When a run ends: the same for each pixel's own error.
void look_show(const Looks *looks, const Small *small, Film *film, const SamplingError *error);

// sampling_stop.c: the same of pixels that end where they have enough, and so do their replicas.
void stop_trace_replicas(const Round *round, Audit *audit, int begin, int end, RenderScratch *scratch,
                         RenderStatistics *counted);

// ---- sampling_near.c: means over a pixel and its neighbours

// Rows of values are given from the top; then those of a row are weighted 4, 2 and 1 by nearness, once the row below is
// given. Beyond the picture's sides the pixel beside them stands.
typedef struct Near {
    double *values;  // of a row, to be filled in; then its means
    double *widened; // of the last three rows
    int width, height;
} Near;

enum { NEAR_ROWS = 4 };
// `memory`: NEAR_ROWS rows of a picture.
Near near_begin(double *memory, int width, int height);
// Takes near->values as row y.
void near_give(Near *near, int y);
// Puts the means of row y into near->values.
void near_take(Near *near, int y);

// ---- sampling_corners.c: what one ray a pixel is worth

// Makes pixels from their corners, and sorts them by how much these differ from what those around let expect.
// Of each square of pixels one is chosen by chance: those have buckets from CORNER_PASS_PROBE on, the others below. So have
// those that hold small shapes, with CORNER_PASS_SMALL; they tell nothing of others.
enum { CORNER_PASS_PROBE = 0x8000, CORNER_PASS_SMALL = 0x4000 };
// Returns the number of those from CORNER_PASS_PROBE on.
uint32_t corner_pass_sort(const Round *round, uint16_t *buckets, double *memory);

// When the chosen ones have started: what they differ from their corners by is taken for what those of their sort are
// off by.
void corner_pass_judge(Estimate *estimate, Film *film, const uint16_t *buckets);

// ---- sampling_allocation.c: where the next samples go

// Pixels in classes of like priority, four for a factor of two: exponent and two bits of a float.
enum { BUCKETS = 1020, BUCKET_FINE = 4 };

// A round takes about this share of all samples taken before it: what a run may spend too much.
static const double ROUND_SHARE = 1.0 / 3.0;

enum { ALLOCATION_ROWS = NEAR_ROWS + 2 };

typedef struct Allocation {
    uint16_t *of_pixel;                         // width * height; owned by the caller
    uint16_t *of_block;                         // as round->blocks; owned by the caller
    double *memory;                             // ALLOCATION_ROWS * width; owned by the caller
    double cost[BUCKETS], corner_cost[BUCKETS]; // samples that pixels get next; those that have their corners only
    double corner_priority;                     // of such a pixel, over what it is off by
    double spent;                               // samples of the next round
    double power;                               // p: variances fall as n^-p
    uint16_t least_bucket;                      // of the next round
} Allocation;

// Samples that the pixels of a bucket get next.
static inline double allocation_cost(const Allocation *allocation, int bucket)
{
    return allocation->cost[bucket] + allocation->corner_cost[bucket];
}

enum { CHOICE_END = BUCKETS << CUT_BITS }; // above all keys

// Of the pixels of the chosen round with keys below `end`, which has those above behind it: takes keys from the greatest
// down until they get `most` samples or just more. Returns the least one taken and puts their samples into *spent.
uint32_t allocation_cut(const Allocation *allocation, const Round *round, uint32_t end, double most, double *spent);

// Sorts all pixels and chooses the next round's.
void allocation_make(Allocation *allocation, const Estimate *estimate, const Round *round);

// ---- sampling_predict.c: how many samples it will take

typedef struct Predictor Predictor;

// NULL when out of memory.
Predictor *predictor_new(size_t pixels);
void predictor_free(Predictor *predictor);

// After corner_pass_judge: keeps the sorts of all pixels.
void predictor_keep_sorts(Predictor *predictor, const uint16_t *buckets, size_t pixels);

// When the first round after that is chosen: what pixels become that start.
void predictor_see_starts(Predictor *predictor, const Allocation *allocation, const Round *round);

typedef struct Forecast {
    double samples;      // of the whole run; 0: unknown
    double pixels;       // each as often as it will take part in a round still to come
    double round_pixels; // that take part in the next
    double rounds;       // after that
} Forecast;

// What it takes to bring the error to the target, before a round that is chosen.
Forecast predictor_run(Predictor *predictor, const Allocation *allocation, const Estimate *estimate, const Round *round,
                       double target);

#endif
