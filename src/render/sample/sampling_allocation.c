// Where the next samples go: to the pixels where the error falls most for a sample.
//
// A pixel whose variance is c n^-p loses about p c n^-p / n for one sample more. What decides is the difference of
// halves' halves, over a pixel and its neighbours, never that of the halves, from which the error is taken: so that
// pixels are not left alone because their error looks small by chance. docs/sampling.md, "Adaptive sampling".
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

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

// The constants c of all pixels, and what goes from there to a priority. Counts are powers of two, so that what goes by
// them is in tables by level.
typedef struct Constants {
    double to_constant[LEVELS], to_priority[LEVELS]; // the last ones are 0 for pixels that can get no more
    double of_inner[LEVELS];                         // to_constant, where that of the sort counts beside
    double of_near[LEVELS], of_own[LEVELS];          // of the mean constant around, and of the pixel's own
    double floor;
    double of_share;              // from the variance that strata bring to the halves' halves that it would be seen by
    double of_sort[SPREAD_SORTS]; // the mean constant of pixels with such a spread, as far as it counts
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
    double sums[SPREAD_SORTS] = {0.0};
    uint64_t counts[SPREAD_SORTS] = {0};
    size_t pixels = (size_t)film->width * (size_t)film->height;
    for (const PixelRecord *record = film->records, *end = record + pixels; record < end; record++) {
        if (record->count > 1) {
            int sort = spread_sort(record->spread);
            sums[sort] += record->inner * constants->to_constant[estimate_level(record->count)];
            counts[sort]++;
        }
    }
    const double part = SORT_COUNT / (SORT_COUNT + 1.0);
    for (int i = 0; i < SPREAD_SORTS; i++) {
        constants->of_sort[i] = counts[i] > 0 ? part * sums[i] / (double)counts[i] : 0.0;
    }
}

// What a pixel's halves' halves would differ by, were its small shapes and slivers all that is in it.
static double inner_known(const Constants *constants, const Round *round, size_t pixel, double count)
{
    const Small *small = round->small;
    double known = 0.0;
    if (small_has(small, pixel)) {
        known = small_variance(small, pixel, 0.25 * count) - small_variance(small, pixel, 0.5 * count);
    }
    if (share_has(round->share, pixel) && count > 1.0) {
        known = fmax(known, constants->of_share * share_variance(round->share, pixel, count));
    }
    return known;
}

// The constants of a row of pixels.
static void constants_of(const Constants *constants, const Round *round, size_t begin, double *own, double *copy)
{
    const PixelRecord *records = &round->film->records[begin];
    for (int x = 0; x < round->film->width; x++) {
        const PixelRecord *record = &records[x];
        double inner = (double)record->inner;
        if (round->small || (round->share && record->count > 1)) {
            double known = inner_known(constants, round, begin + (size_t)x, record->count);
            inner = inner > known ? inner : known;
        }
        own[x] = inner * constants->of_inner[estimate_level(record->count)];
        own[x] += record->count > 1 ? constants->of_sort[spread_sort(record->spread)] : 0.0;
        copy[x] = own[x];
    }
}

static void constants_init(Constants *constants, const Estimate *estimate, const Round *round, Allocation *allocation)
{
    double power = allocation->power, sum = 0.0, pixels = (double)round->film->width * round->film->height;
    for (int level = 0; level < LEVELS; level++) {
        double count = exp2(level);
        constants->to_constant[level] = exp2(power * level);
        constants->of_inner[level] = constants->to_constant[level] / (level > 0 ? SORT_COUNT + 1.0 : 1.0);
        constants->to_priority[level] = count < UINT32_MAX / 4 ? exp2(-(power + 1.0) * level) : 0.0;
        constants->of_near[level] = NEIGHBOURS_COUNT / (NEIGHBOURS_COUNT + count);
        constants->of_own[level] = count / (NEIGHBOURS_COUNT + count);
        sum += constants->to_constant[level] * estimate->levels[level].inner_now;
    }
    allocation->corner_priority = 1.0;
    if (round->has_corners) {
        // Of corners that are followed by START_SAMPLES, as of samples that are doubled.
        double left = exp2(-power);
        allocation->corner_priority = (1.0 - left * left) / (START_SAMPLES * (1.0 - left));
        constants->to_priority[0] = allocation->corner_priority;
    }
    constants->floor = fmax(PRIORITY_FLOOR * sum / pixels, 1e-30);
    constants->of_share = exp2(power) * (exp2(power) - 1.0);
}

// The buckets of a row, from the constants around its pixels. A pixel's own counts the more, the more samples it is
// from.
static void choose_row(Allocation *allocation, const Constants *constants, const Round *round, int y,
                       const double *own, const double *near)
{
    int width = round->film->width;
    size_t begin = (size_t)y * (size_t)width;
    const PixelRecord *records = &round->film->records[begin];
    uint16_t *of_pixel = &allocation->of_pixel[begin];
    uint16_t *of_block = &allocation->of_block[(size_t)(y / KERNEL_ROW) * round_blocks(width)];
    for (int x = 0; x < width; x++) {
        uint32_t count = records[x].count;
        int level = estimate_level(count);
        double constant = constants->of_near[level] * near[x] + constants->of_own[level] * own[x];
        constant = constant > constants->floor ? constant : constants->floor;
        uint16_t bucket = bucket_of(constant * constants->to_priority[level]), *most = &of_block[x / KERNEL_ROW];
        of_pixel[x] = bucket;
        *most = *most > bucket ? *most : bucket;
        if (round_starts(round, count)) {
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
    constants_init(&constants, estimate, round, allocation);
    sorts_init(&constants, film);
    memset(allocation->cost, 0, sizeof allocation->cost);
    memset(allocation->corner_cost, 0, sizeof allocation->corner_cost);
    memset(allocation->of_block, 0, round_blocks(film->width) * round_blocks(film->height) * sizeof(uint16_t));
    Near near = near_begin(allocation->memory, film->width, film->height);
    double *rows = allocation->memory + (ptrdiff_t)NEAR_ROWS * film->width; // of pixels' own constants
    for (int y = 0; y <= film->height; y++) {
        double *own = rows + (ptrdiff_t)(y % 2) * film->width, *above = rows + (ptrdiff_t)((y + 1) % 2) * film->width;
        if (y < film->height) {
            constants_of(&constants, round, (size_t)y * (size_t)film->width, own, near.values);
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
