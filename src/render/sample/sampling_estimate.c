// The error of a picture from what its halves differ by.
//
// With V(n) the variance of a pixel's mean of n samples, the mean square of half the difference of two halves of n is
// V(n/2) - V(n): all of V(n) when samples are independent, less when halves complete each other. The same of the
// halves' halves is V(n/4) - V(n/2); were V to fall by one ratio r in each step, r would be the quotient of the two,
// and V(n) the first over r - 1. Sums over many pixels and the last steps make it sharp. docs/sampling.md, "The error
// without a reference".
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "render/sample/sampling.h"

// No ratio below that of independent samples is believed, none above that of smooth light.
static const double RATIO_LEAST = 2.0, RATIO_MOST = 8.0;

enum { STEPS_MOST = 2 };

// Where the picture's block ends, in the film, that holds a column or row of it.
static inline int block_end(int at, int origin, int end)
{
    int next = at + JUDGED_BLOCK - (origin + at) % JUDGED_BLOCK;
    return next < end ? next : end;
}

bool round_next_judged(const Round *round, Tile *block)
{
    const Film *film = round->film;
    int left = block->right, top = block->top;
    for (; top < film->height; left = 0, top = block_end(top, film->top, film->height)) {
        for (int right; left < film->width; left = right) {
            right = block_end(left, film->left, film->width);
            if (round_counts_for_error(round, left, top)) {
                *block = (Tile){left, top, right, block_end(top, film->top, film->height)};
                return true;
            }
        }
    }
    return false;
}

// Whether halves complete each other; if not, they are independent.
static bool has_halves(const Round *round)
{
    return sampler_is_sequence(round->sampling->sampler) && !stop_has_choice(round->sampling);
}

static bool has_ratio(const Round *round, int level)
{
    return has_halves(round) && level >= 2;
}

// The last step's ratio, or its geometric mean with that of the step before, whichever is less: ratios go up and down
// with the shapes of the nets, and fall where light is sampled. How many steps it was taken from in *steps.
static double ratio_of(const Estimate *estimate, const Round *round, int level, int *steps)
{
    double sum = 0.0, least = HUGE_VAL;
    *steps = 0;
    for (int i = 1; i <= STEPS_MOST && has_ratio(round, level); i++, level--) {
        const LevelSums *sums = &estimate->levels[level];
        if (!(sums->outer > 0.0) || !(sums->inner > 0.0)) {
            break;
        }
        sum += log2(sums->inner / sums->outer);
        *steps = sum / i < least ? i : *steps;
        least = fmin(least, sum / i);
    }
    return *steps > 0 ? fmin(fmax(exp2(least), RATIO_LEAST), RATIO_MOST) : RATIO_LEAST;
}

// Pixels that were doubled just now: nothing has been chosen by what they say.
static inline void fresh_add(LevelSums *sums, const PixelRecord *record, bool is_chosen, bool *has_level)
{
    if (!*has_level && !is_chosen) {
        sums->outer = sums->inner = sums->squares = 0.0;
    }
    *has_level = true;
    sums->outer += record->outer;
    sums->squares += (double)record->outer * record->outer;
    sums->inner += is_chosen ? record->fresh : record->inner;
}

static void now_clear(Estimate *estimate)
{
    for (int level = 0; level < LEVELS; level++) {
        LevelSums *sums = &estimate->levels[level];
        sums->outer_now = sums->outer_squares = sums->inner_now = 0.0;
    }
}

// What so many pixels of each sort that have their corners only bring: all of a sort the same.
static void add_corners(Estimate *estimate, const uint32_t counts[CORNER_PASS_SORTS])
{
    LevelSums *sums = &estimate->levels[0];
    for (int sort = 0; sort < CORNER_PASS_SORTS; sort++) {
        double mean = estimate->sort_mean[sort], sum = counts[sort] * mean;
        estimate->sort_sum[sort] = sum;
        sums->outer_now += sum;
        sums->inner_now += sum;
        sums->outer_squares += sum * mean;
    }
}

// All pixels, and, if a round was just traced, what those say that had a part in it.
static void add_now(Estimate *estimate, const Film *film, const Round *round, bool has_fresh)
{
    size_t pixels = (size_t)film->width * (size_t)film->height;
    const PixelRecord *records = film->records;
    bool has_level[LEVELS] = {false}, is_chosen = round->buckets != NULL, has_corners = round->has_corners;
    uint32_t by_sort[CORNER_PASS_SORTS] = {0};
    uint64_t samples = (uint64_t)estimate->corners;
    now_clear(estimate);
    for (size_t i = 0; i < pixels; i++) {
        const PixelRecord *record = &records[i];
        if (has_corners && record->count == 1) {
            by_sort[(int)record->fresh]++;
            continue;
        }
        int level = estimate_level(record->count);
        LevelSums *sums = &estimate->levels[level];
        double outer = record->outer;
        samples += record->count;
        sums->outer_now += outer;
        sums->inner_now += record->inner;
        sums->outer_squares += outer * outer;
        if (has_fresh && round_has(round, i)) {
            fresh_add(sums, record, is_chosen, &has_level[level]);
        }
    }
    estimate->samples = samples;
    add_corners(estimate, by_sort);
}

static void add_pixels(LevelSums *sums, const Film *film, Tile part)
{
    for (int y = part.top; y < part.bottom; y++) {
        const PixelRecord *row = &film->records[(size_t)y * (size_t)film->width];
        for (int x = part.left; x < part.right; x++) {
            double outer = row[x].outer;
            sums->outer += outer;
            sums->inner += row[x].inner;
            sums->outer_squares += outer * outer;
        }
    }
}

// Both at once, where all pixels have just come to one number of samples.
static void add_alike(Estimate *estimate, const Film *film, const Round *round)
{
    LevelSums sums = {0};
    for (Tile block = {0}; round_next_judged(round, &block);) {
        add_pixels(&sums, film, block);
    }
    sums.squares = sums.outer_squares;
    sums.outer_now = sums.outer;
    sums.inner_now = sums.inner;
    now_clear(estimate);
    estimate->levels[estimate_level(round->count)] = sums;
    estimate->samples = (uint64_t)round->count * (uint64_t)film->width * (uint64_t)film->height;
}

// The square of the relative error of a level's share of the mean square. Squares of normal errors have a variance of
// two thirds of their own mean square. What the picture is off by varies as much as its outer sum does.
static double relative_variance(const LevelSums *sums, double ratio, int steps)
{
    if (!(sums->outer_now > 0.0)) {
        return 0.0;
    }
    double outer = 2.0 / 3.0 * sums->outer_squares / (sums->outer_now * sums->outer_now);
    if (steps == 0 || ratio <= RATIO_LEAST) {
        return 2.0 * outer;
    }
    double by_ratio = ratio / (ratio - 1.0) / steps;
    return ((1.0 + by_ratio) * (1.0 + by_ratio) + by_ratio * by_ratio + 1.0) * outer;
}

// The same of pixels that have their corners only.
static double corners_variance(const Estimate *estimate)
{
    double variance = 0.0, sum = 0.0;
    for (int sort = 0; sort < CORNER_PASS_SORTS; sort++) {
        double part = estimate->sort_sum[sort];
        sum += part;
        variance += part * part * estimate->sort_variance[sort];
    }
    return sum > 0.0 ? variance / (sum * sum) : 0.0;
}

// By how much the law of the ratios may be wrong, by level: less, the more steps were seen, and the least where all
// sets are nets. Where samples went by what was seen, some pixels are left that seemed better than they are; where
// lights or a lens draw numbers, too, points are nets of more dimensions at some numbers only. Measured.
static double law_error(const Round *round, int level)
{
    static const double errors[] = {0.35, 0.35, 0.25, 0.25, 0.12, 0.08}, not_net = 0.12, chosen = 0.18, more = 0.25;
    if (!has_halves(round)) {
        return 0.0;
    }
    double error = errors[level < 5 ? level : 5];
    error = (round->count & (round->count - 1)) != 0 ? fmax(error, not_net) : error;
    error = round->buckets ? fmax(error, chosen) : error;
    return round->draws_more ? hypot(error, more) : error;
}

static void tell(Estimate *estimate, const Film *film, const Round *round, SamplingError *error)
{
    const double normal = 1.96; // 95 % of a normal distribution is within
    double pixels = (double)film->width * film->height, sum = 0.0, variance = 0.0, slope = 0.0, law = 0.0;
    for (int level = 0; level < LEVELS; level++) {
        const LevelSums *sums = &estimate->levels[level];
        int steps;
        double ratio = estimate->ratio[level] = ratio_of(estimate, round, level, &steps);
        double part = sums->outer_now / (ratio - 1.0);
        sum += part;
        slope += part * log2(ratio);
        bool is_corners = level == 0 && round->has_corners;
        variance += part * part * (is_corners ? corners_variance(estimate) : relative_variance(sums, ratio, steps));
        law += part * law_error(round, level);
    }
    double relative = sum > 0.0 ? normal * 0.5 * sqrt(variance) / sum : 0.0, wrong = sum > 0.0 ? law / sum : 0.0;
    double spread = exp(sqrt(relative * relative + wrong * wrong));
    error->samples = (double)estimate->samples / pixels;
    error->is_known = round->has_corners ? !round->is_corner_pass : error->samples >= 2.0;
    error->rmse = sqrt(sum / estimate->judged);
    error->pixel_scale = 1.0;
    error->low = error->rmse / spread;
    error->high = error->rmse * spread;
    error->slope = sum > 0.0 ? -0.5 * slope / sum : -0.5;
}

void estimate_begin(Estimate *estimate, const Round *round)
{
    estimate->judged = 0.0;
    for (Tile block = {0}; round_next_judged(round, &block);) {
        estimate->judged += (double)(block.right - block.left) * (block.bottom - block.top);
    }
}

void estimate_update(Estimate *estimate, const Film *film, const Round *round, bool is_whole, SamplingError *error)
{
    if (is_whole && !round->buckets) {
        add_alike(estimate, film, round);
    } else {
        add_now(estimate, film, round, true);
    }
    tell(estimate, film, round, error);
}

void estimate_now(Estimate *estimate, const Film *film, const Round *round, SamplingError *error)
{
    add_now(estimate, film, round, false);
    tell(estimate, film, round, error);
}

double render_pixel_error(const Film *film, const SamplingError *error, size_t pixel)
{
    return error->pixel_scale * sqrt(film->records[pixel].outer / (exp2(-2.0 * error->slope) - 1.0));
}
