// One round: samples are gathered into calls of the kernel, their light is summed by pixel and half, and what the
// halves say goes into the pixels' records.
//
// SPDX-License-Identifier: MIT
#include "render/records/camera.h"
#include "render/sample/sampling_batch.h"
#include "render/sample/scratch.h"
#include "render/sample/tiles.h"

// So that rays through corners draw other numbers than the samples of their pixel.
static const uint32_t CORNER_SEED = UINT32_C(0x9e3779b9);

// The samples that a pixel gets in a round.
static uint32_t round_samples(const Round *round, size_t pixel)
{
    if (!round_has(round, pixel)) {
        return 0; // most pixels of most rounds: their records are not read
    }
    uint32_t count = round->film->records[pixel].count;
    return round->count > 0 ? round->count - count : round_starts(round, count) ? START_SAMPLES : count;
}

// The mean of the shares with those that were there before, if any.
static void clear_put(float *clear, double before, uint32_t count, const SampleSums *parts)
{
    *clear = (float)fmin(fmax((before * (double)*clear + parts->clear) / (before + count), 0.0), 1.0);
}

// The spread of new samples.
static inline double spread_of(const SampleSums *parts, Rgb mean, const Rgb *slope, double count)
{
    Rgb square = rgb_add_scaled(rgb_scale(1.0 / count, parts->squares), -1.0, rgb_mul(mean, mean));
    Rgb own = slope ? rgb_mul(square, rgb_mul(*slope, *slope)) : square;
    double sum = own.red + own.green + own.blue;
    return sum > 0.0 ? sum / 3.0 : 0.0;
}

// Puts the means by shares for those of new samples, and their sums for the sums of halves; returns the mean of all.
static Rgb sums_weight(const ChosenPixel *chosen, bool has_before, bool has_spread, SampleSums *parts, Rgb *before,
                       Rgb *mean)
{
    ShareMeans means;
    share_close(parts->shares, has_before, chosen->is_judged, has_spread, &means);
    double count = chosen->count, first = (chosen->count + 1) / 2;
    if (!chosen->starts) {
        parts->sum[0] = rgb_scale(first, means.halves[0]);
        parts->sum[1] = rgb_scale(count - first, means.halves[1]);
    }
    // So that spread_of is what samples spread by within the strata.
    if (has_spread) {
        Rgb spread_out = rgb_add_scaled(rgb_mul(means.fresh, means.fresh), -1.0, means.between);
        parts->squares = rgb_add_scaled(parts->squares, count, spread_out);
    }
    *before = means.before;
    *mean = means.fresh;
    return means.all;
}

// A pixel that had its corners only, which are left out of its mean. How far the two are apart is kept for
// sampling_corners.c.
static void pixel_start(const Round *round, const ChosenPixel *chosen, SampleSums *parts)
{
    size_t pixel = chosen->index;
    PixelRecord *record = &round->film->records[pixel];
    float *value = &round->film->rgb[3 * pixel];
    const Rgb *sum = parts->sum;
    const double alike = apart_factor(1.0, 1.0);
    Rgb before = rgb(value[0], value[1], value[2]), place;
    Rgb halves[2] = {rgb_scale(0.5, rgb_add(sum[0], sum[1])), rgb_scale(0.5, rgb_add(sum[2], sum[3]))};
    Rgb mean = rgb_scale(0.5, rgb_add(halves[0], halves[1])), none;
    if (parts->shares) {
        (void)sums_weight(chosen, false, true, parts, &none, &mean);
    }
    value_put(value, mean);
    const Rgb *slope = slope_at(round, value, &place);
    float first = square_apart(rgb_add_scaled(sum[0], -1.0, sum[1]), slope, alike);
    float second = square_apart(rgb_add_scaled(sum[2], -1.0, sum[3]), slope, alike);
    float off = square_apart(rgb_add_scaled(before, -1.0, mean), slope, 1.0 / 3.0);
    *record = (PixelRecord){.count = START_SAMPLES,
                            .outer = square_apart(rgb_add_scaled(halves[0], -1.0, halves[1]), slope, alike),
                            .inner = 0.5f * (first + second),
                            .fresh = round->is_corner_pass ? off : second,
                            .spread = (float)spread_of(parts, mean, slope, START_SAMPLES)};
}

// What goes for all pixels that get so many samples.
typedef struct Shares {
    uint32_t before, count;
    bool is_linear, is_adaptive;    // linear: slope_at is NULL
    double of_new, of_old, of_mean; // of a sum of samples, of the old mean and of the new one
    double first, second;           // of the sums of halves
    double fresh, outer;            // apart_factor
} Shares;

static void shares_set(const Round *round, Shares *shares, uint32_t had, uint32_t count)
{
    double first = (count + 1) / 2, second = count / 2, before = had, now = before + count;
    *shares = (Shares){.before = had,
                       .count = count,
                       .is_linear = !linear_is_needed(&round->prepared->scene->settings),
                       .is_adaptive = round->sampling->is_adaptive,
                       .of_new = 1.0 / count,
                       .of_old = before / now,
                       .of_mean = count / now,
                       .first = 1.0 / first,
                       .second = second > 0.0 ? 1.0 / second : 0.0,
                       .fresh = apart_factor(first, second),
                       .outer = apart_factor(before, count)};
}

// What the samples of a pixel say of its error; `old` and `mean` are the means of those that it had and of the new. It is
// the cost of the estimate, so each caller's `slope` makes a copy of its own.
RT_ALWAYS_INLINE void pixel_judge_by(const Shares *shares, PixelRecord *record, const SampleSums *parts, Rgb old, Rgb mean,
                                     const Rgb *slope)
{
    Rgb apart = rgb_add_scaled(rgb_scale(shares->first, parts->sum[0]), -shares->second, parts->sum[1]);
    float fresh = square_apart(apart, slope, shares->fresh), outer = fresh, inner = 0.0f;
    if (shares->before > 0) {
        inner = 0.5f * (record->outer + fresh);
        outer = square_apart(rgb_add_scaled(old, -1.0, mean), slope, shares->outer);
    }
    if (shares->is_adaptive) {
        double spread = spread_of(parts, mean, slope, shares->count);
        record->spread = (float)(shares->of_old * record->spread + shares->of_mean * spread) + outer;
    }
    record->fresh = fresh;
    record->inner = inner;
    record->outer = outer;
}

static inline void pixel_judge(const Round *round, const Shares *shares, size_t pixel, const SampleSums *parts, Rgb old,
                               Rgb mean)
{
    PixelRecord *record = &round->film->records[pixel];
    Rgb place;
    if (shares->is_linear) {
        pixel_judge_by(shares, record, parts, old, mean, NULL);
    } else {
        pixel_judge_by(shares, record, parts, old, mean, slope_at(round, &round->film->rgb[3 * pixel], &place));
    }
}

static inline void pixel_finish(const Round *round, Shares *shares, const ChosenPixel *chosen, SampleSums *parts)
{
    size_t pixel = chosen->index;
    PixelRecord *record = &round->film->records[pixel];
    float *value = &round->film->rgb[3 * pixel];
    if (film_background(round->film)) {
        clear_put(&film_background(round->film)[pixel], chosen->starts ? 0.0 : record->count, chosen->count, parts);
    }
    if (chosen->starts) {
        pixel_start(round, chosen, parts);
        return;
    }
    if (shares->before != record->count || shares->count != chosen->count) {
        shares_set(round, shares, record->count, chosen->count);
    }
    Rgb mean = rgb_scale(shares->of_new, rgb_add(parts->sum[0], parts->sum[1]));
    Rgb old = rgb(value[0], value[1], value[2]);
    Rgb all = rgb_add(rgb_scale(shares->of_old, old), rgb_scale(shares->of_mean, mean));
    if (parts->shares) {
        all = sums_weight(chosen, shares->before > 0, shares->is_adaptive, parts, &old, &mean);
    }
    value_put(value, all);
    record->count += chosen->count;
    if (chosen->is_judged) {
        pixel_judge(round, shares, pixel, parts, old, mean);
    }
}

// The pixels of a block that take part, a quarter after the other.
static ChosenPixel *block_choose(const Round *round, Tile block, ChosenPixel *chosen)
{
    enum { QUARTER = KERNEL_ROW / 2, ROWS = 4 * QUARTER };
    const Film *film = round->film;
    bool has_estimate = !round->sampling->has_no_estimate;
    bool is_whole = film->left % JUDGED_BLOCK == 0 && film->top % JUDGED_BLOCK == 0; // one block of the picture
    bool is_judged = has_estimate && round_counts_for_error(round, block.left, block.top);
    bool has_small = round->small && tile_has_entries(round->small->first, film->width, block);
    ChosenPixel *first = chosen;
    for (int row = 0; row < ROWS; row++) {
        int y = block.top + row % QUARTER + row / (2 * QUARTER) * QUARTER;
        int left = block.left + row / QUARTER % 2 * QUARTER;
        int right = left + QUARTER < block.right ? left + QUARTER : block.right;
        size_t begin = (size_t)y * (size_t)film->width;
        for (int x = left; y < block.bottom && x < right; x++) {
            uint32_t count = round_samples(round, begin + (size_t)x);
            if (count > 0) {
                uint32_t had = film->records[begin + (size_t)x].count;
                is_judged = is_whole ? is_judged : has_estimate && round_counts_for_error(round, x, y);
                *chosen++ = (ChosenPixel){.x = x,
                                          .y = y,
                                          .index = begin + (size_t)x,
                                          .count = count,
                                          .starts = round_starts(round, had),
                                          .is_judged = is_judged};
            }
        }
    }
    for (ChosenPixel *pixel = first; has_small && pixel < chosen; pixel++) {
        pixel->has_open = small_open(round->small, pixel->index) > 0;
    }
    return chosen;
}

// Whether some pixel of a block may take part.
static inline bool block_takes_part(const Round *round, int left, int top)
{
    size_t row = round_blocks(round->film->width) * (size_t)(top / KERNEL_ROW);
    return !round->blocks || round->blocks[row + (size_t)(left / KERNEL_ROW)] >= round->least_bucket;
}

// Blocks of pixels, each beside the last, four by four, so that rays of one call stay near each other.
static ChosenPixel *tile_choose(const Round *round, Tile tile, ChosenPixel *chosen)
{
    enum { BLOCKS = TILE_SIZE / KERNEL_ROW };
    _Static_assert(BLOCKS == 4, "two bits for a column and a row");
    for (int i = 0; i < BLOCKS * BLOCKS; i++) {
        int left = tile.left + KERNEL_ROW * ((i & 1) | (i >> 1 & 2));
        int top = tile.top + KERNEL_ROW * ((i >> 1 & 1) | (i >> 2 & 2));
        if (left < tile.right && top < tile.bottom && block_takes_part(round, left, top)) {
            chosen = block_choose(round, tile_block(tile, left, top), chosen);
        }
    }
    return chosen;
}

void round_trace(const Round *round, Tile tile, RenderScratch *scratch, RenderStatistics *counted)
{
    ChosenPixel *chosen = scratch->round.chosen, *end = chosen;
    SampleSums *parts = scratch->round.sums;
    Shares shares = {0};
    Batch batch;
    batch_init(&batch, round, scratch);
    end = tile_choose(round, tile, end);
    for (const ChosenPixel *pixel = chosen; pixel < end; pixel++) {
        SampleSums *sums = &parts[pixel - chosen];
        *sums = (SampleSums){.squares = rgb_grey(0.0),
                             .shares = share_begin(round->share, pixel->index, pixel->starts,
                                                   &scratch->round.shares[pixel - chosen])};
        batch.meets = (batch.meets && batch.count > 0) || pixel->has_open;
        pixel_add(round, &batch, pixel, sums, counted);
    }
    batch_flush(round, &batch, counted);
    for (const ChosenPixel *pixel = chosen; pixel < end; pixel++) {
        pixel_finish(round, &shares, pixel, &parts[pixel - chosen]);
    }
}

// Of a pixel that is like its replica, half the square of how far that is from it: its variance. Of others the product
// of how far two replicas are, which leaves out their own errors.
static void replica_judge(const Round *round, AuditPick *pick, const SampleSums sets[2])
{
    const float *value = &round->film->rgb[3 * pick->pixel];
    uint32_t count = round->film->records[pick->pixel].count;
    Rgb place, own = rgb(value[0], value[1], value[2]), apart[2];
    bool is_single = round_is_like_replica(round, pick->pixel);
    for (int i = 0; i < 2; i++) {
        Rgb sum = rgb_add(sets[i].sum[0], sets[i].sum[1]);
        Rgb mean = rgb_scale(1.0 / (count > 1 ? (double)count : (double)AUDIT_SAMPLES), sum);
        if (sets[i].shares && (i == 0 || !is_single)) {
            mean = share_mean(sets[i].shares);
        }
        apart[i] = rgb_add_scaled(mean, -1.0, own);
    }
    const Rgb *slope = slope_at(round, value, &place);
    Rgb product = rgb_mul(apart[0], apart[is_single ? 0 : 1]);
    product = slope ? rgb_mul(product, rgb_mul(*slope, *slope)) : product;
    pick->square = (is_single ? 0.5 : 1.0) / 3.0 * (product.red + product.green + product.blue);
    pick->is_pair = !is_single;
    for (int i = 0; i < 2; i++) {
        pick->apart[i] = slope ? rgb_mul(apart[i], *slope) : apart[i];
    }
}

// The replicas go through batches together.
void round_trace_replicas(const Round *round, Audit *audit, int begin, int end, RenderScratch *scratch,
                          RenderStatistics *counted)
{
    const Film *film = round->film;
    _Static_assert(2 * AUDIT_MOST <= TILE_SIZE * TILE_SIZE, "a tile's sums hold two sets of each pick");
    SampleSums(*sets)[2] = (void *)scratch->round.sums;
    Batch batch;
    batch_init(&batch, round, scratch);
    batch.avoids = round->small != NULL;
    for (int next = begin; next < end; next++) {
        const AuditPick *pick = &audit->picks[next];
        int x = (int)(pick->pixel % (size_t)film->width), y = (int)(pick->pixel / (size_t)film->width);
        uint32_t had = film->records[pick->pixel].count;
        SampleSums *own = sets[next - begin];
        for (int i = 0; i < 2; i++) {
            ShareSums *shares = &scratch->round.shares[2 * (next - begin) + i];
            own[i] = (SampleSums){.squares = rgb_grey(0.0),
                                  .shares = share_begin(round->share, pick->pixel, false, shares)};
        }
        for (uint32_t i = 0; i < (round_is_like_replica(round, pick->pixel) ? 1u : 2u); i++) {
            ChosenPixel chosen = {.x = x, .y = y, .index = pick->pixel, .count = had > 1 ? had : AUDIT_SAMPLES,
                                  .replica = 2 * pick->replica + i};
            pixel_add(round, &batch, &chosen, &own[i], counted);
        }
    }
    batch_flush(round, &batch, counted);
    for (int i = begin; i < end; i++) {
        replica_judge(round, &audit->picks[i], sets[i - begin]);
    }
}

// The corners of a block; where it is cut off, its last ones are traced again.
static void block_corners(const Round *round, Tile block, Batch *batch, RenderStatistics *counted)
{
    const Film *film = round->film;
    uint64_t wanted = block_places(film, block, -0.5, &batch->places);
    for (int i = 0; batch->draws && i < KERNEL_RAYS; i++) {
        int x = block.left + i % KERNEL_ROW, y = block.top + i / KERNEL_ROW;
        x = x < block.right ? x : block.right - 1;
        y = y < block.bottom ? y : block.bottom - 1;
        batch->streams[i] = (SampleStream){
            .kind = round->sampling->sampler, .seed = pixel_seed(round, x, y) ^ CORNER_SEED, .count = 1, .pair = 1};
        if (batch->places.lens) {
            batch->lens[i] = camera_lens_point(&round->prepared->camera, sample_next(&batch->streams[i]));
        }
    }
    batch_trace(round, batch, wanted, counted);
    for (; wanted; wanted &= wanted - 1) {
        int i = __builtin_ctzll(wanted);
        size_t y = (size_t)(block.top + i / KERNEL_ROW), x = (size_t)(block.left + i % KERNEL_ROW);
        value_put(&round->corners[3 * (y * ((size_t)film->width + 1) + x)], batch->light[i]);
    }
}

void round_trace_corners(const Round *round, Tile tile, RenderScratch *scratch, RenderStatistics *counted)
{
    Batch batch;
    batch_init(&batch, round, scratch);
    for (int top = tile.top; top < tile.bottom; top += KERNEL_ROW) {
        for (int left = tile.left; left < tile.right; left += KERNEL_ROW) {
            block_corners(round, tile_block(tile, left, top), &batch, counted);
        }
    }
}
