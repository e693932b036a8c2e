// The error of a picture from independent replicas of some of its pixels.
//
// What the halves of a pixel's samples differ by says how its error falls only as far as one law holds for all scenes.
// So when a run ends, some pixels are sampled again, with the same number of points under another scrambling. The mean
// of such a replica is as far from the true value as the pixel's own, and independent of it: half the mean square of
// their difference is the pixel's variance, whatever is seen and however points and light go together (replicated
// randomised quasi-Monte Carlo: A. Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995). Pixels are drawn
// with probabilities in proportion to what their halves differ by and weighted by the inverse (M. Hansen, W. Hurwitz,
// "On the theory of sampling from finite populations", Ann. Math. Statist. 14, 1943), one after the other along the
// picture (W. Madow, "On the theory of systematic sampling, II", 1949), so that few are enough. docs/sampling.md, "The
// error without a reference".
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "math/extreme.h"
#include "render/sample/sampling.h"

// How many replicas are drawn: one for so many pixels, within these.
enum { AUDIT_LEAST = 96, AUDIT_PIXELS = 256 };

// Of pairs of replicas, which are all of an adaptive run, so many times as many: a product of two scatters more than a
// square does.
enum { AUDIT_PAIRS = 2 };

// How many more for each narrow highlight of a bumpy surface, and at the most: what these bring is much, and few samples
// meet it. Of 96 replicas alone intervals held in 86 to 92 % of runs. Measured.
enum { AUDIT_GLINT = 8, AUDIT_GLINTS = 256 };

// A pixel's share of the draw is what its halves say of it, and so much of the mean for what nothing has shown yet: a
// pixel may look even only because no sample has met what is in it. Mostly it is beside pixels that have: where a
// shadow is soft, all of 4 samples agree in some pixels. So there is a part of the mean of the pixels around, too. With
// 0.7 of the mean of all alone, intervals of a soft shadow held in 68 % of runs of 4 samples.
static const double MEAN_PART = 0.7, NEAR_PART = 0.7;

// A pixel that is drawn so often is drawn for sure: all of its replicas together say what it is off by itself, and not
// what another set of samples would be.
static const double CERTAIN = 4.0;

// Pixels around: a square of two quarters by two, of so many pixels by so many each.
enum { AUDIT_QUARTER = 2, QUARTERS = JUDGED_BLOCK / AUDIT_QUARTER };

// Where pixels end when they seem to have enough, those that seemed so by chance are most of the error, and nothing has
// shown it: then most of the draw is blind, and wants more replicas. Measured.
static const double MEAN_PART_STOP = 8.0;

typedef struct Draw {
    Audit *audit;
    const Round *round;
    double of_outer[LEVELS];     // what goes from a pixel's `outer` and `inner` to what it is taken to be off by,
    double of_inner[LEVELS];     // squared
    double gain[LEVELS];         // the same from `outer` alone
    double floor;                // added to each share
    double near_part;            // of the mean of a pixel's cell, the same
    double step, reached, next;  // between picks, of the cumulated shares; these; where the next pick is
    double blocks, sum, squares; // judged blocks, and what they are taken to be off by
    double own_squares;          // of pixels whose own error is taken to be that of a replica
    int most;
} Draw;

// What a pixel is taken to be off by, squared: as its halves say, or what small shapes that are in it bring to so few
// samples.
static inline double pixel_square(const Draw *draw, const Small *small, size_t pixel)
{
    const PixelRecord *record = &draw->round->film->records[pixel];
    int level = estimate_level(record->count);
    double by_halves = draw->of_outer[level] * (double)record->outer + draw->of_inner[level] * (double)record->inner;
    if (share_has(draw->round->share, pixel) && record->count > 1) {
        by_halves = greater_of(by_halves, share_variance(draw->round->share, pixel, record->count));
    }
    return small_has(small, pixel) ? greater_of(by_halves, small_variance(small, pixel, record->count)) : by_halves;
}

// What own_squares has of a pixel.
static double own_square(const Draw *draw, const Small *small, size_t pixel)
{
    const PixelRecord *record = &draw->round->film->records[pixel];
    bool is_by_pixel = small || draw->round->share;
    return is_by_pixel ? pixel_square(draw, small, pixel) : draw->gain[estimate_level(record->count)] * record->outer;
}

// Whether only halves tell of all pixels of a block, alike: most blocks have no strata and no small shapes.
static bool block_is_plain(const Draw *draw, Tile block)
{
    const Share *share = draw->round->share;
    const Small *small = draw->round->small;
    int width = draw->round->film->width;
    return !draw->round->buckets && !(share && tile_has_entries(share->first, width, block)) &&
           !(small && tile_has_entries(small->first, width, block));
}

// What its halves say of a pixel of a plain block.
static inline double plain_square(const PixelRecord *record, double of_outer, double of_inner)
{
    return of_outer * (double)record->outer + of_inner * (double)record->inner;
}

static void total_block(Draw *draw, Tile block)
{
    const Film *film = draw->round->film;
    const PixelRecord *records = film->records;
    int level = estimate_level(records[(size_t)block.top * (size_t)film->width + (size_t)block.left].count);
    double of_outer = draw->of_outer[level], of_inner = draw->of_inner[level];
    bool is_plain = block_is_plain(draw, block);
    for (int y = block.top; y < block.bottom; y++) {
        for (int x = block.left; x < block.right; x++) {
            size_t pixel = (size_t)y * (size_t)film->width + (size_t)x;
            double square = is_plain ? plain_square(&records[pixel], of_outer, of_inner)
                                     : pixel_square(draw, draw->round->small, pixel);
            draw->sum += square;
            draw->own_squares += round_is_like_replica(draw->round, pixel) ? square * square : 0.0;
        }
    }
}

// What the pixels of a block are taken to be off by, together and by quarters of cells. Each quarter is in a cell of
// each of two grids, the second of which is half a cell aside, so that most neighbours have one in common.
typedef struct BlockSquares {
    double own[JUDGED_BLOCK * JUDGED_BLOCK], sum;
    double quarters[QUARTERS][QUARTERS], counts[QUARTERS][QUARTERS];
} BlockSquares;

// So many of a quarter's two rows or columns are within so many of the block.
static inline double within_quarter(int quarter, int size)
{
    int rest = size - AUDIT_QUARTER * quarter;
    return rest < 0 ? 0.0 : rest < AUDIT_QUARTER ? rest : AUDIT_QUARTER;
}

RT_ALWAYS_INLINE void block_squares(const Draw *draw, Tile block, const Small *small, bool is_plain,
                                    BlockSquares *squares)
{
    const Film *film = draw->round->film;
    const PixelRecord *first = &film->records[(size_t)block.top * (size_t)film->width + (size_t)block.left];
    double of_outer = draw->of_outer[estimate_level(first->count)];
    double of_inner = draw->of_inner[estimate_level(first->count)];
    int width = block.right - block.left, height = block.bottom - block.top;
    if (width < JUDGED_BLOCK || height < JUDGED_BLOCK) {
        memset(squares->own, 0, sizeof squares->own);
    }
    for (int y = 0; y < height; y++) {
        size_t begin = (size_t)(block.top + y) * (size_t)film->width + (size_t)block.left;
        for (int x = 0; x < width; x++) {
            const PixelRecord *record = &film->records[begin + (size_t)x];
            squares->own[y * JUDGED_BLOCK + x] =
                is_plain ? plain_square(record, of_outer, of_inner)
                         : pixel_square(draw, small, begin + (size_t)x);
        }
    }
    squares->sum = 0.0;
    for (int row = 0; row < QUARTERS; row++) {
        double rows = within_quarter(row, height);
        for (int column = 0; column < QUARTERS; column++) {
            const double *own = &squares->own[AUDIT_QUARTER * (row * JUDGED_BLOCK + column)];
            double sum = own[0] + own[1] + (own[JUDGED_BLOCK] + own[JUDGED_BLOCK + 1]);
            squares->quarters[row][column] = sum;
            squares->counts[row][column] = rows * within_quarter(column, width);
            squares->sum += sum;
        }
    }
}

// The sums over the cells of both grids, and how many pixels they have.
typedef struct CellSums {
    double sums[2][QUARTERS / 2 + 1][QUARTERS / 2 + 1], counts[2][QUARTERS / 2 + 1][QUARTERS / 2 + 1];
} CellSums;

static void cells_add(const BlockSquares *squares, CellSums *cells)
{
    memset(cells, 0, sizeof *cells);
    for (int row = 0; row < QUARTERS; row++) {
        for (int column = 0; column < QUARTERS; column++) {
            double sum = squares->quarters[row][column], count = squares->counts[row][column];
            cells->sums[0][row / 2][column / 2] += sum;
            cells->counts[0][row / 2][column / 2] += count;
            cells->sums[1][(row + 1) / 2][(column + 1) / 2] += sum;
            cells->counts[1][(row + 1) / 2][(column + 1) / 2] += count;
        }
    }
}

// Of the pixels around a quarter, the mean over both cells.
static inline double near_mean(const CellSums *cells, int column, int row)
{
    int right = (column + 1) / 2, down = (row + 1) / 2;
    return 0.5 * (cells->sums[0][row / 2][column / 2] / cells->counts[0][row / 2][column / 2] +
                  cells->sums[1][down][right] / cells->counts[1][down][right]);
}

// Picks of a pixel, which has so much of the draw.
RT_ALWAYS_INLINE void pixel_pick(Draw *draw, size_t pixel, const Small *small, double share)
{
    Audit *audit = draw->audit;
    bool is_certain = share >= CERTAIN * draw->step;
    for (uint32_t replica = 1; draw->next < draw->reached && audit->count < draw->most; replica++) {
        audit->picks[audit->count++] =
            (AuditPick){.pixel = pixel, .replica = replica, .weight = 1.0 / share, .is_certain = is_certain};
        draw->next += draw->step;
    }
    if (is_certain && round_is_like_replica(draw->round, pixel)) {
        double own = own_square(draw, small, pixel);
        draw->own_squares -= own * own;
    }
}

// Picks of the pixels of a quarter, each of which has `even` of the draw beside its own.
RT_ALWAYS_INLINE void quarter_pick(Draw *draw, Tile block, const Small *small, const BlockSquares *squares, int column,
                                   int row, double even)
{
    double begin = draw->reached, all = squares->quarters[row][column] + squares->counts[row][column] * even;
    int left = AUDIT_QUARTER * column, top = AUDIT_QUARTER * row;
    for (int i = 0; draw->next < begin + all && i < AUDIT_QUARTER * AUDIT_QUARTER; i++) {
        int x = left + i % AUDIT_QUARTER, y = top + i / AUDIT_QUARTER;
        if (block.left + x < block.right && block.top + y < block.bottom) {
            double share = squares->own[y * JUDGED_BLOCK + x] + even;
            draw->reached += share;
            pixel_pick(draw, (size_t)(block.top + y) * (size_t)draw->round->film->width + (size_t)(block.left + x),
                       small, share);
        }
    }
    draw->reached = begin + all;
}

RT_ALWAYS_INLINE void draw_block_by(Draw *draw, Tile block, const Small *small, bool is_plain)
{
    BlockSquares squares;
    block_squares(draw, block, small, is_plain, &squares);
    double count = (double)(block.right - block.left) * (block.bottom - block.top), begin = draw->reached;
    double all = (1.0 + draw->near_part) * squares.sum + count * draw->floor;
    bool is_picked = draw->next < begin + all;
    CellSums cells;
    if (is_picked) {
        cells_add(&squares, &cells);
    }
    for (int i = 0; is_picked && i < QUARTERS * QUARTERS; i++) {
        int column = i % QUARTERS, row = i / QUARTERS;
        if (squares.counts[row][column] > 0.0) {
            double even = draw->near_part * near_mean(&cells, column, row) + draw->floor;
            quarter_pick(draw, block, small, &squares, column, row, even);
        }
    }
    draw->reached = begin + all;
    draw->blocks++;
    draw->sum += squares.sum;
    draw->squares += squares.sum * squares.sum;
}

// A copy of its own for plain blocks.
static void draw_block(Draw *draw, Tile block)
{
    if (block_is_plain(draw, block)) {
        draw_block_by(draw, block, draw->round->small, true);
    } else {
        draw_block_by(draw, block, draw->round->small, false);
    }
}

static void each_block(Draw *draw, void (*block)(Draw *draw, Tile block))
{
    for (Tile judged = {0}; round_next_judged(draw->round, &judged);) {
        block(draw, judged);
    }
}

// What the choice of the judged blocks does to the mean: the relative variance of a mean of so many of all blocks.
static double blocks_variance(const Draw *draw)
{
    double mean = draw->sum / draw->blocks;
    if (!draw->round->counts_some || draw->blocks < 2.0) {
        return 0.0;
    }
    double spread = (draw->squares / draw->blocks - mean * mean) / (draw->blocks - 1.0);
    return (1.0 - 1.0 / JUDGED_SHARE) * fmax(spread, 0.0) / (mean * mean);
}

// Halves may agree by chance in a pixel whose halves' halves do not: both count alike, where there are both.
static void set_gains(Draw *draw, int level, const LevelSums *sums, double ratio)
{
    bool has_both = level >= 2 && sums->inner_now > 0.0;
    double gain = draw->gain[level] = 1.0 / (ratio - 1.0);
    draw->of_outer[level] = has_both ? 0.5 * gain : gain;
    draw->of_inner[level] = has_both ? 0.5 * gain / ratio : 0.0;
}

int audit_draw(Audit *audit, const Estimate *estimate, const Round *round)
{
    bool stops = stop_has_choice(round->sampling);
    Draw draw = {.audit = audit, .round = round, .near_part = stops ? 0.0 : NEAR_PART};
    double mean_part = stops ? MEAN_PART_STOP : MEAN_PART;
    double picks = stops ? AUDIT_MOST : fmax(estimate->judged / AUDIT_PIXELS, AUDIT_LEAST);
    for (int level = 0; level < LEVELS; level++) {
        const LevelSums *sums = &estimate->levels[level];
        set_gains(&draw, level, sums, estimate->ratio[level]);
        draw.sum += draw.of_outer[level] * sums->outer_now + draw.of_inner[level] * sums->inner_now;
        draw.own_squares += round->buckets ? 0.0 : draw.gain[level] * draw.gain[level] * sums->outer_squares;
    }
    if (round->small || round->share) {
        draw.sum = draw.own_squares = 0.0;
        each_block(&draw, total_block);
    }
    double sum = draw.sum;
    audit->count = 0;
    if (!(sum > 0.0)) {
        return 0;
    }
    double glints = round->small ? fmin(AUDIT_GLINT * (double)round->small->glint_count, AUDIT_GLINTS) : 0.0;
    picks *= round->buckets ? AUDIT_PAIRS : 1.0;
    draw.most = (int)fmin(picks + glints, AUDIT_MOST);
    draw.floor = mean_part * sum / estimate->judged;
    audit->size = (1.0 + draw.near_part + mean_part) * sum;
    draw.sum = 0.0;
    draw.step = audit->step = audit->size / draw.most;
    draw.next = draw.step * sample_unit(sampler_pixel_seed(~round->sampling->seed, AUDIT_MOST, (uint32_t)draw.most));
    each_block(&draw, draw_block);
    // Squares of normal errors have a variance of two thirds of their own mean square.
    audit->own_variance = 2.0 / 3.0 * fmax(draw.own_squares, 0.0) / (sum * sum) + blocks_variance(&draw);
    return audit->count;
}

// Of the replicas that a pixel has got, from picks[begin] on, all products of two: of pairs many more than their own.
// The mean of these, and its variance; sets *end to the first pick of another pixel.
static double pooled_square(const Audit *audit, int begin, int *end, double *variance)
{
    const AuditPick *first = &audit->picks[begin];
    Rgb sum = rgb_grey(0.0), squares = rgb_grey(0.0);
    double count = 0.0;
    int i = begin;
    for (; i < audit->count && audit->picks[i].pixel == first->pixel; i++) {
        for (int k = 0; k < (first->is_pair ? 2 : 1); k++) {
            Rgb apart = audit->picks[i].apart[k];
            sum = rgb_add(sum, apart);
            squares = rgb_add(squares, rgb_mul(apart, apart));
            count++;
        }
    }
    *end = i;
    Rgb products = rgb_add_scaled(rgb_mul(sum, sum), -1.0, squares);
    double square = (products.red + products.green + products.blue) / (3.0 * count * (count - 1.0));
    // That of the mean of the replicas, whose square is the pooled one and this.
    double own = fmax((squares.red + squares.green + squares.blue) / (3.0 * count) - square, 0.0) / count;
    // Where all replicas agree and the pixel does not, what is seldom met was met by one set in all of these.
    own = fmax(own, square / ((count + 1.0) * (count + 1.0)));
    *variance = 4.0 * fmax(square, 0.0) * own + 2.0 * own * own;
    return square;
}

// 95 % of a normal distribution is within 1.96; terms have longer tails, and so few tell less of their own spread.
static const double NORMAL = 2.4;

void error_set_interval(SamplingError *error, double relative)
{
    double most = relative > 1.0 ? exp(0.5 * NORMAL) * sqrt(relative) : exp(0.5 * NORMAL * relative);
    error->low = error->rmse * exp(-0.5 * NORMAL * relative);
    error->high = error->rmse * most;
}

double error_relative(const SamplingError *error)
{
    double factor = error->rmse > 0.0 ? error->high / error->rmse : 1.0, one = exp(0.5 * NORMAL);
    return factor > one ? factor * factor / (one * one) : log(factor) / (0.5 * NORMAL);
}

void audit_judge(const Audit *audit, const Estimate *estimate, SamplingError *error)
{
    // Of pixels that are drawn for sure, their squares; of the others, those of picks, of which each stands for a step.
    double certain = 0.0, certain_variance = 0.0, sum = 0.0, squares = 0.0, within = 0.0, count = 0.0;
    for (int i = 0, end; i < audit->count; i = end) {
        const AuditPick *first = &audit->picks[i];
        double variance = 0.0, term = first->square;
        end = i + 1;
        if (first->is_pair || first->is_certain) {
            term = pooled_square(audit, i, &end, &variance);
        }
        if (first->is_certain) {
            certain += term;
            certain_variance += variance;
            continue;
        }
        double times = end - i;
        term *= first->weight;
        sum += times * term;
        squares += times * term * term;
        within += times * (times - 1.0) * first->weight * first->weight * variance; // beyond what scatters by picks
        count += times;
    }
    double all = certain + audit->step * sum;
    if (!(all > 0.0)) {
        return;
    }
    double scatter = count > 1.0 ? (squares - sum * sum / count) * count / (count - 1.0) : squares;
    double spread = (certain_variance + audit->step * audit->step * (scatter + within)) / (all * all);
    double rmse = sqrt(all / estimate->judged);
    error->pixel_scale = error->rmse > 0.0 ? rmse / error->rmse : 1.0;
    error->rmse = rmse;
    // The error of this picture varies about its expectation, and judged blocks about all, too.
    error_set_interval(error, sqrt(fmax(spread, 0.0) + audit->own_variance));
}
