// Where the next samples go: to the pixels where the error falls most for a sample.
//
// A pixel whose variance is c n^-p loses about p c n^-p / n for one sample more. What decides is the difference of
// halves' halves, over a pixel and its neighbours, never that of the halves, from which the error is taken: so that
// pixels are not left alone because their error looks small by chance. docs/sampling.md, "Adaptive sampling".
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "render/sample/sampling.h"

enum { BUCKET_SHIFT = 21 }; // bits of a float below a bucket's
// A round that would take less than this of its share takes the next bucket, too, however many pixels are in it: it
// costs a look at all pixels.
static const double ROUND_LEAST = 0.5;

enum { SPREAD_SHIFT = 23, SPREAD_SORTS = 256 }; // by exponent

// Where nothing has been seen, something may be: of the mean of all pixels.
static const double PRIORITY_FLOOR = 1e-3;

// For how many pixels' own constants the mean of those counts that have a like spread.
static const double SORT_COUNT = 2.0;

// As many samples as the neighbours of a pixel count for.
static const double NEIGHBOURS_COUNT = 8.0;

static double mean_log_ratio(const Estimate *estimate)
{
    double sum = 0.0, weight = 0.0;
    for (int level = 2; level < LEVELS; level++) {
        weight += estimate->levels[level].outer_now;
        sum += estimate->levels[level].outer_now * log2(estimate->ratio[level]);
    }
    return weight > 0.0 ? sum / weight : 1.0;
}

static inline uint16_t bucket_of(double priority)
{
    union {
        float value;
        uint32_t bits;
    } number = {.value = (float)priority};
    uint32_t bucket = number.bits >> BUCKET_SHIFT;
    return (uint16_t)(bucket < BUCKETS ? bucket : BUCKETS - 1);
}

// The constants c of all pixels, and what goes from there to a priority.
typedef struct Constants {
    double to_constant[LEVELS], to_priority[LEVELS]; // by level: counts are powers of two
    double floor;
    double of_share;              // from the variance that strata bring to the halves' halves that it would be seen by
    double of_sort[SPREAD_SORTS]; // the mean constant of pixels with such a spread
} Constants;

static inline int spread_sort(float spread)
{
    union {
        float value;
        uint32_t bits;
    } number = {.value = spread};
    return (int)(number.bits >> SPREAD_SHIFT);
}

static void sorts_init(Constants *constants, const Film *film)
{
    double sums[SPREAD_SORTS] = {0.0}, counts[SPREAD_SORTS] = {0.0};
    size_t pixels = (size_t)film->width * (size_t)film->height;
    for (size_t i = 0; i < pixels; i++) {
        const PixelRecord *record = &film->records[i];
        if (record->count > 1) {
            int sort = spread_sort(record->spread);
            sums[sort] += record->inner * constants->to_constant[estimate_level(record->count)];
            counts[sort]++;
        }
    }
    for (int i = 0; i < SPREAD_SORTS; i++) {
        constants->of_sort[i] = counts[i] > 0.0 ? sums[i] / counts[i] : 0.0;
    }
}

// What a pixel's halves' halves would differ by, were its small shapes all that is in it.
static double inner_of_small(const Small *small, size_t pixel, double count)
{
    return small_has(small, pixel)
               ? small_variance(small, pixel, 0.25 * count) - small_variance(small, pixel, 0.5 * count)
               : 0.0;
}

static double constant_of(const Constants *constants, const Round *round, size_t pixel)
{
    const PixelRecord *record = &round->film->records[pixel];
    double seen = (double)record->inner, known = inner_of_small(round->small, pixel, record->count);
    if (share_has(round->share, pixel) && record->count > 1) {
        known = fmax(known, constants->of_share * share_variance(round->share, pixel, record->count));
    }
    double own = (seen > known ? seen : known) * constants->to_constant[estimate_level(record->count)];
    if (record->count == 1) {
        return own;
    }
    return (SORT_COUNT * constants->of_sort[spread_sort(record->spread)] + own) / (SORT_COUNT + 1.0);
}

static void constants_init(Constants *constants, const Estimate *estimate, double pixels, double power)
{
    double sum = 0.0;
    for (int level = 0; level < LEVELS; level++) {
        constants->to_constant[level] = exp2(power * level);
        constants->to_priority[level] = exp2(-(power + 1.0) * level);
        sum += constants->to_constant[level] * estimate->levels[level].inner_now;
    }
    constants->floor = fmax(PRIORITY_FLOOR * sum / pixels, 1e-30);
    constants->of_share = exp2(power) * (exp2(power) - 1.0);
}

// The buckets of a row, from the constants around its pixels. A pixel's own counts the more, the more samples it is
// from.
static void choose_row(Allocation *allocation, const Constants *constants, const Round *round, int y,
                       const double *own, const double *near)
{
    size_t begin = (size_t)y * (size_t)round->film->width;
    for (int x = 0; x < round->film->width; x++) {
        size_t pixel = begin + (size_t)x;
        const PixelRecord *record = &round->film->records[pixel];
        int level = estimate_level(record->count);
        double count = record->count;
        double constant = (NEIGHBOURS_COUNT * near[x] + count * own[x]) / (NEIGHBOURS_COUNT + count);
        constant = constant > constants->floor ? constant : constants->floor;
        bool is_full = record->count > UINT32_MAX / 4;
        uint16_t bucket = is_full ? 0 : bucket_of(constant * constants->to_priority[level]);
        allocation->of_pixel[pixel] = bucket;
        if (round_starts(round, record->count)) {
            allocation->corner_cost[bucket] += START_SAMPLES;
        } else {
            allocation->cost[bucket] += count;
        }
    }
}

void allocation_make(Allocation *allocation, const Estimate *estimate, const Round *round)
{
    const Film *film = round->film;
    Constants constants;
    double spent = 0.0;
    allocation->power = mean_log_ratio(estimate);
    if (round->share) {
        share_set_contrasts(round);
    }
    constants_init(&constants, estimate, (double)film->width * film->height, allocation->power);
    sorts_init(&constants, film);
    allocation->corner_priority = 1.0;
    if (round->has_corners) {
        // Of corners that are followed by START_SAMPLES, as of samples that are doubled.
        double left = exp2(-allocation->power);
        allocation->corner_priority = (1.0 - left * left) / (START_SAMPLES * (1.0 - left));
        constants.to_priority[0] = allocation->corner_priority;
    }
    for (int i = 0; i < BUCKETS; i++) {
        allocation->cost[i] = allocation->corner_cost[i] = 0.0;
    }
    Near near = near_begin(allocation->memory, film->width, film->height);
    double *rows = allocation->memory + (ptrdiff_t)NEAR_ROWS * film->width; // of pixels' own constants
    for (int y = 0; y <= film->height; y++) {
        size_t begin = (size_t)y * (size_t)film->width;
        double *own = rows + (ptrdiff_t)(y % 2) * film->width, *above = rows + (ptrdiff_t)((y + 1) % 2) * film->width;
        for (int x = 0; y < film->height && x < film->width; x++) {
            near.values[x] = own[x] = constant_of(&constants, round, begin + (size_t)x);
        }
        near_give(&near, y);
        if (y > 0) {
            near_take(&near, y - 1);
            choose_row(allocation, &constants, round, y - 1, above, near.values);
        }
    }
    int least = BUCKETS;
    double most = ROUND_SHARE * (double)estimate->samples;
    while (least > 1 && (spent < ROUND_LEAST * most || spent + allocation_cost(allocation, least - 1) <= most)) {
        spent += allocation_cost(allocation, --least);
    }
    allocation->least_bucket = (uint16_t)least;
    allocation->spent = spent;
}

// Adds the steps of a bucket that are below `end`, until there are enough samples; the least key taken.
static uint32_t bucket_cut(const Allocation *allocation, const Round *round, uint32_t bucket, uint32_t end, double most,
                           double *spent)
{
    size_t pixels = (size_t)round->film->width * (size_t)round->film->height;
    double costs[CUT_STEPS] = {0.0};
    for (size_t i = 0; i < pixels; i++) {
        if (allocation->of_pixel[i] == bucket) {
            uint32_t count = round->film->records[i].count;
            costs[round_key(round, i) % CUT_STEPS] += round_starts(round, count) ? START_SAMPLES : count;
        }
    }
    uint32_t key = end;
    while (key > bucket << CUT_BITS && *spent < most) {
        *spent += costs[--key % CUT_STEPS];
    }
    return key;
}

uint32_t allocation_cut(const Allocation *allocation, const Round *round, uint32_t end, double most, double *spent)
{
    uint32_t bucket = end >> CUT_BITS;
    *spent = 0.0;
    if (end % CUT_STEPS != 0) {
        end = bucket_cut(allocation, round, bucket, end, most, spent);
    }
    while (*spent < most && end % CUT_STEPS == 0 && bucket-- > allocation->least_bucket) {
        if (*spent + allocation_cost(allocation, (int)bucket) < most) {
            *spent += allocation_cost(allocation, (int)bucket);
            end = bucket << CUT_BITS;
        } else {
            end = bucket_cut(allocation, round, bucket, end, most, spent);
        }
    }
    return end;
}
