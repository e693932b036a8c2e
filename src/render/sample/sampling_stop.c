// Samples of pixels that end where they have enough, as a camera's `confidence` and `variance` say.
//
// A pixel has two sets of samples, scrambled apart. A few of each come first; what those of one set spread by says how
// many the other gets, by Student's distribution (C. Stein, "A two-sample test for a linear hypothesis whose power is
// independent of the variance", Ann. Math. Statist. 16, 1945). So no set ends because of what it has seen itself, and
// the mean of the two means has no bias, whatever is seen: a pixel that ends by its own samples is darker in the mean,
// since it ends where none has met what is small and bright. docs/sampling.md, "Where a pixel has enough".
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "render/sample/sampling_batch.h"
#include "render/sample/scratch.h"

enum { PILOT_LEAST = 6 }; // of each set

// So that the second set of a pixel draws other numbers than the first.
static const uint32_t SECOND_SEED = UINT32_C(0x85ebca6b);

// How many samples sets get.
typedef struct StopRule {
    uint32_t pilot;   // of each set
    uint32_t most[2];
    double factor;    // of the spread of a pilot, to the number of samples of the other set
} StopRule;

// The share of Student's distribution below t >= 0, with n >= 1 degrees of freedom: M. Abramowitz, I. Stegun, "Handbook
// of Mathematical Functions", 1964, 26.7.3 and 26.7.4.
static double student_below(double t, uint32_t n)
{
    const double pi = 3.14159265358979323846;
    double angle = atan(t / sqrt(n)), cosine = cos(angle), square = cosine * cosine, sum = 0.0;
    bool is_odd = n & 1;
    double term = is_odd ? cosine : 1.0;
    for (uint32_t k = is_odd ? 3 : 2; k <= n; k += 2) {
        sum += term;
        term *= square * (k - 1.0) / k;
    }
    sum *= sin(angle);
    return 0.5 + 0.5 * (is_odd ? 2.0 / pi * (angle + sum) : sum);
}

// Where that share is reached, by halving.
static double student_quantile(double share, uint32_t n)
{
    double low = 0.0, high = 1.0;
    while (student_below(high, n) < share && high < 0x1p40) {
        high *= 2.0;
    }
    for (int i = 0; i < 60; i++) {
        double middle = 0.5 * (low + high);
        *(student_below(middle, n) < share ? &low : &high) = middle;
    }
    return high;
}

static uint32_t pilot_of(const SamplingStop *stop)
{
    uint32_t half = ((uint32_t)stop->least + 1) / 2;
    return half > PILOT_LEAST ? half : PILOT_LEAST;
}

bool stop_has_choice(const SamplingOptions *sampling)
{
    return stop_is_wanted(&sampling->stop) && !sampling->is_adaptive &&
           2.0 * pilot_of(&sampling->stop) < sampling->samples;
}

static StopRule rule_of(const Round *round)
{
    const SamplingStop *stop = &round->sampling->stop;
    StopRule rule = {.pilot = pilot_of(stop), .most = {(round->count + 1) / 2, round->count / 2}};
    double t = student_quantile(0.5 * (1.0 + stop->confidence), rule.pilot - 1);
    rule.factor = t * t / (2.0 * stop->variance); // the mean of both has half the variance of one
    return rule;
}

// What a set gets, by the pilot of the other one.
static uint32_t count_by(const StopRule *rule, const SampleSums *other, uint32_t most)
{
    double n = rule->pilot;
    Rgb sum = rgb_add(other->sum[0], other->sum[1]);
    Rgb squares = rgb_add_scaled(other->squares, -1.0 / n, rgb_mul(sum, sum));
    double wanted = ceil(rule->factor * rgb_max(squares) / (n - 1.0));
    return !(wanted > rule->pilot) ? rule->pilot : wanted < most ? (uint32_t)wanted : most; // a NaN is no number
}

// Samples from `first` on, up to `end`, of one of a pixel's sets.
typedef struct SetPart {
    int set;
    uint32_t first, end;
} SetPart;

static void add_set(const Round *round, Batch *batch, const StopPixel *pixel, SetPart part, SampleSums *sums,
                    RenderStatistics *counted)
{
    uint32_t own = pixel_seed(round, pixel->x, pixel->y);
    uint32_t seed = pixel->replica > 0 ? sample_hash_add(own, pixel->replica) : own;
    ChosenPixel chosen = {.x = pixel->x, .y = pixel->y, .index = pixel->index, .count = part.end - part.first};
    if (part.end > part.first) {
        seed = part.set == 0 ? seed : sample_hash_add(seed, SECOND_SEED);
        pixel_add_set(round, batch, &chosen, seed, part.first, sums, counted);
    }
}

// The sums of both sets of each pixel.
static void trace_pixels(const Round *round, StopPixel *pixels, int count, SampleSums (*sums)[2],
                         RenderScratch *scratch, RenderStatistics *counted)
{
    StopRule rule = rule_of(round);
    Batch batch;
    batch_init(&batch, round, scratch);
    for (int i = 0; i < count; i++) {
        for (int set = 0; set < 2; set++) {
            sums[i][set] = (SampleSums){.squares = rgb_grey(0.0)};
            add_set(round, &batch, &pixels[i], (SetPart){set, 0, rule.pilot}, &sums[i][set], counted);
        }
    }
    batch_flush(round, &batch, counted);
    for (int i = 0; i < count; i++) {
        for (int set = 0; set < 2; set++) {
            pixels[i].count[set] = count_by(&rule, &sums[i][1 - set], rule.most[set]);
        }
    }
    for (int i = 0; i < count; i++) {
        for (int set = 0; set < 2; set++) {
            SetPart rest = {set, rule.pilot, pixels[i].count[set]};
            add_set(round, &batch, &pixels[i], rest, &sums[i][set], counted);
        }
    }
    batch_flush(round, &batch, counted);
}

static Rgb set_mean(const StopPixel *pixel, const SampleSums sums[2], int set)
{
    return rgb_scale(1.0 / pixel->count[set], rgb_add(sums[set].sum[0], sums[set].sum[1]));
}

static void pixel_finish(const Round *round, const StopPixel *pixel, const SampleSums sums[2])
{
    Film *film = round->film;
    PixelRecord *record = &film->records[pixel->index];
    float *value = &film->rgb[3 * pixel->index];
    Rgb one = set_mean(pixel, sums, 0), other = set_mean(pixel, sums, 1), place;
    value_put(value, rgb_scale(0.5, rgb_add(one, other)));
    if (film_background(film)) {
        double clear = 0.5 * (sums[0].clear / pixel->count[0] + sums[1].clear / pixel->count[1]);
        film_background(film)[pixel->index] = (float)fmin(fmax(clear, 0.0), 1.0);
    }
    record->count = pixel->count[0] + pixel->count[1];
    record->fresh = record->outer = square_apart(rgb_add_scaled(one, -1.0, other), slope_at(round, value, &place),
                                                 apart_factor(1.0, 1.0));
}

void stop_trace(const Round *round, Tile tile, RenderScratch *scratch, RenderStatistics *counted)
{
    SampleSums(*sums)[2] = (void *)scratch->round.sums;
    StopPixel *pixels = scratch->round.stop;
    int count = 0;
    for (int y = tile.top; y < tile.bottom; y++) {
        for (int x = tile.left; x < tile.right; x++) {
            size_t index = (size_t)y * (size_t)round->film->width + (size_t)x;
            pixels[count++] = (StopPixel){.x = x, .y = y, .index = index};
            bool is_last = y == tile.bottom - 1 && x == tile.right - 1;
            if (count < STOP_PIXELS && !is_last) {
                continue;
            }
            trace_pixels(round, pixels, count, sums, scratch, counted);
            for (int i = 0; i < count; i++) {
                pixel_finish(round, &pixels[i], sums[i]);
            }
            count = 0;
        }
    }
}

void stop_trace_replicas(const Round *round, Audit *audit, int begin, int end, RenderScratch *scratch,
                         RenderStatistics *counted)
{
    const Film *film = round->film;
    SampleSums(*sums)[2] = (void *)scratch->round.sums;
    StopPixel *pixels = scratch->round.stop;
    _Static_assert((int)AUDIT_MOST <= (int)STOP_PIXELS, "there is room for all replicas");
    for (int i = begin; i < end; i++) {
        const AuditPick *pick = &audit->picks[i];
        int x = (int)(pick->pixel % (size_t)film->width), y = (int)(pick->pixel / (size_t)film->width);
        pixels[i - begin] = (StopPixel){.x = x, .y = y, .index = pick->pixel, .replica = pick->replica};
    }
    trace_pixels(round, pixels, end - begin, sums, scratch, counted);
    for (int i = 0; i < end - begin; i++) {
        const float *value = &film->rgb[3 * pixels[i].index];
        Rgb mean = rgb_scale(0.5, rgb_add(set_mean(&pixels[i], sums[i], 0), set_mean(&pixels[i], sums[i], 1))), place;
        Rgb apart = rgb_add_scaled(mean, -1.0, rgb(value[0], value[1], value[2]));
        const Rgb *slope = slope_at(round, value, &place);
        audit->picks[begin + i].square = square_apart(apart, slope, 0.5 / 3.0);
        audit->picks[begin + i].apart[0] = slope ? rgb_mul(apart, *slope) : apart;
    }
}
