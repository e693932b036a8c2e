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

#include "render/sampling.h"

// How many replicas are drawn: one for so many pixels, within these.
enum { AUDIT_LEAST = 128, AUDIT_PIXELS = 128 };

// A pixel's share of the draw: half its own difference, half that of its surroundings, since a pixel may look even only
// because no sample has met what its neighbours show; and a part of the mean for what nothing has shown yet.
static const double NEAR_PART = 0.5, MEAN_PART = 0.7;

static bool is_corners_only(const Round *round, const PixelRecord *record)
{
    return round->has_corners && record->count == 1;
}

// What a pixel is taken to be off by before it is audited.
static double expected_of(const Estimate *estimate, const Round *round, size_t pixel)
{
    const PixelRecord *record = &round->film->records[pixel];
    return record->outer / (estimate->ratio[estimate_level(record->count)] - 1.0);
}

// Calls `visit` for each judged pixel with what it and what its surroundings are taken to be off by, squared.
typedef void Visit(void *client, size_t pixel, double own, double near);

static void visit_row(const Estimate *estimate, const Round *round, const Near *near, int y, Visit *visit, void *client)
{
    const Film *film = round->film;
    for (int x = 0; x < film->width; x++) {
        size_t pixel = (size_t)y * (size_t)film->width + (size_t)x;
        if (round_judges(round, x, y)) {
            visit(client, pixel, expected_of(estimate, round, pixel), near->values[x]);
        }
    }
}

static void visit_pixels(const Estimate *estimate, const Round *round, double *memory, Visit *visit, void *client)
{
    const Film *film = round->film;
    Near near = near_begin(memory, film->width, film->height);
    for (int y = 0; y <= film->height; y++) {
        for (int x = 0; y < film->height && x < film->width; x++) {
            size_t pixel = (size_t)y * (size_t)film->width + (size_t)x;
            near.values[x] = round_judges(round, x, y) ? expected_of(estimate, round, pixel) : 0.0;
        }
        near_give(&near, y);
        if (y > 0) {
            near_take(&near, y - 1);
            visit_row(estimate, round, &near, y - 1, visit, client);
        }
    }
}

typedef struct Draw {
    AuditPick *picks;
    double sum, squares, sizes; // over all pixels: what they are taken to be off by, its squares, their shares
    double floor;               // added to each share
    double step, reached, next; // between picks, of the cumulated shares; these; where the next pick is
    int count, most;
} Draw;

static void add_size(void *client, size_t pixel, double own, double near)
{
    Draw *draw = client;
    (void)pixel;
    draw->sum += own;
    draw->sizes += (1.0 - NEAR_PART) * own + NEAR_PART * near;
    draw->squares += own * own;
}

static void pick(void *client, size_t pixel, double own, double near)
{
    Draw *draw = client;
    double size = (1.0 - NEAR_PART) * own + NEAR_PART * near + draw->floor;
    draw->reached += size;
    for (uint32_t replica = 1; draw->next < draw->reached && draw->count < draw->most; replica++) {
        draw->picks[draw->count++] = (AuditPick){.pixel = pixel, .replica = replica, .weight = 1.0 / size};
        draw->next += draw->step;
    }
}

int audit_draw(Audit *audit, const Estimate *estimate, const Round *round)
{
    Draw draw = {.picks = audit->picks};
    visit_pixels(estimate, round, audit->memory, add_size, &draw);
    if (!(draw.sum > 0.0)) {
        return audit->count = 0;
    }
    double share = estimate->judged / AUDIT_PIXELS;
    draw.most = share < AUDIT_LEAST ? AUDIT_LEAST : share > AUDIT_MOST ? AUDIT_MOST : (int)share;
    draw.floor = MEAN_PART * draw.sum / estimate->judged;
    audit->size = draw.sizes + MEAN_PART * draw.sum;
    // Squares of normal errors have a variance of two thirds of their own mean square.
    audit->own_variance = 2.0 / 3.0 * draw.squares / (draw.sum * draw.sum);
    draw.step = audit->size / draw.most;
    draw.next = draw.step * sample_unit(sampler_pixel_seed(~round->sampling->seed, AUDIT_MOST, (uint32_t)draw.most));
    visit_pixels(estimate, round, audit->memory, pick, &draw);
    audit->samples = 0.0;
    for (int i = 0; i < draw.count; i++) {
        const PixelRecord *record = &round->film->records[draw.picks[i].pixel];
        audit->samples += is_corners_only(round, record) ? 2.0 * AUDIT_SAMPLES : record->count;
    }
    return audit->count = draw.count;
}

void audit_judge(const Audit *audit, const Estimate *estimate, SamplingError *error)
{
    // 95 % of a normal distribution is within 1.96; terms have longer tails, and so few tell less of their own spread.
    const double normal = 2.2;
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
    // The error of this picture varies about its expectation, too.
    double factor = exp(normal * 0.5 * sqrt(spread + audit->own_variance));
    error->rmse = sqrt(mean * audit->size / estimate->judged);
    error->low = error->rmse / factor;
    error->high = error->rmse * factor;
}
