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

#include "render/sampling.h"

// How many replicas are drawn: one for so many pixels, within these.
enum { AUDIT_LEAST = 96, AUDIT_PIXELS = 256 };

// A pixel's share of the draw is what its halves say of it, and so much of the mean for what nothing has shown yet: a
// pixel may look even only because no sample has met what is in it.
static const double MEAN_PART = 0.7;

typedef struct Draw {
    Audit *audit;
    const Round *round;
    double gain[LEVELS];         // what goes from `outer` to what a pixel is taken to be off by, squared
    double floor;                // added to each share
    double step, reached, next;  // between picks, of the cumulated shares; these; where the next pick is
    double blocks, sum, squares; // judged blocks, and what they are taken to be off by
    int most;
} Draw;

static void draw_block(Draw *draw, Tile block)
{
    const Film *film = draw->round->film;
    Audit *audit = draw->audit;
    double sum = 0.0;
    for (int y = block.top; y < block.bottom; y++) {
        for (int x = block.left; x < block.right; x++) {
            size_t pixel = (size_t)y * (size_t)film->width + (size_t)x;
            const PixelRecord *record = &film->records[pixel];
            double own = record->outer * draw->gain[estimate_level(record->count)], share = own + draw->floor;
            sum += own;
            draw->reached += share;
            for (uint32_t replica = 1; draw->next < draw->reached && audit->count < draw->most; replica++) {
                audit->picks[audit->count++] =
                    (AuditPick){.pixel = pixel, .replica = replica, .weight = 1.0 / share};
                draw->next += draw->step;
            }
        }
    }
    draw->blocks++;
    draw->sum += sum;
    draw->squares += sum * sum;
}

static void draw_blocks(Draw *draw)
{
    const Film *film = draw->round->film;
    for (int top = 0, bottom; top < film->height; top = bottom) {
        bottom = round_block_end(top, film->top, film->height);
        for (int left = 0, right; left < film->width; left = right) {
            right = round_block_end(left, film->left, film->width);
            if (round_judges(draw->round, left, top)) {
                draw_block(draw, (Tile){left, top, right, bottom});
            }
        }
    }
}

// What the choice of the judged blocks does to the mean: the relative variance of a mean of so many of all blocks.
static double blocks_variance(const Draw *draw)
{
    double mean = draw->sum / draw->blocks;
    if (!draw->round->judges_some || draw->blocks < 2.0) {
        return 0.0;
    }
    double spread = (draw->squares / draw->blocks - mean * mean) / (draw->blocks - 1.0);
    return (1.0 - 1.0 / JUDGED_SHARE) * fmax(spread, 0.0) / (mean * mean);
}

int audit_draw(Audit *audit, const Estimate *estimate, const Round *round)
{
    Draw draw = {.audit = audit, .round = round};
    double sum = 0.0, squares = 0.0, picks = estimate->judged / AUDIT_PIXELS;
    for (int level = 0; level < LEVELS; level++) {
        const LevelSums *sums = &estimate->levels[level];
        double gain = draw.gain[level] = 1.0 / (estimate->ratio[level] - 1.0);
        sum += gain * sums->outer_now;
        squares += gain * gain * sums->outer_squares;
    }
    audit->count = 0;
    if (!(sum > 0.0)) {
        return 0;
    }
    draw.most = picks < AUDIT_LEAST ? AUDIT_LEAST : picks > AUDIT_MOST ? AUDIT_MOST : (int)picks;
    draw.floor = MEAN_PART * sum / estimate->judged;
    audit->size = (1.0 + MEAN_PART) * sum;
    draw.step = audit->size / draw.most;
    draw.next = draw.step * sample_unit(sampler_pixel_seed(~round->sampling->seed, AUDIT_MOST, (uint32_t)draw.most));
    draw_blocks(&draw);
    // Squares of normal errors have a variance of two thirds of their own mean square.
    audit->own_variance = 2.0 / 3.0 * squares / (sum * sum) + blocks_variance(&draw);
    return audit->count;
}

void audit_judge(const Audit *audit, const Estimate *estimate, SamplingError *error)
{
    // 95 % of a normal distribution is within 1.96; terms have longer tails, and so few tell less of their own spread.
    const double normal = 2.4;
    double sum = 0.0, squares = 0.0, count = audit->count;
    for (int i = 0; i < audit->count; i++) {
        double term = audit->picks[i].square * audit->picks[i].weight;
        sum += term;
        squares += term * term;
    }
    double mean = sum / count;
    if (!(mean > 0.0)) {
        return;
    }
    double spread = (squares / count - mean * mean) / (count - 1.0) / (mean * mean);
    // The error of this picture varies about its expectation, and judged blocks about all, too.
    double factor = exp(normal * 0.5 * sqrt(spread + audit->own_variance));
    double rmse = sqrt(mean * audit->size / estimate->judged);
    error->pixel_scale = rmse / error->rmse;
    error->rmse = rmse;
    error->low = error->rmse / factor;
    error->high = error->rmse * factor;
}
