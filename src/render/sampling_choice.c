// Where the next samples go: to the pixels where the error falls most for a sample.
//
// A pixel whose variance is c n^-p loses about p c n^-p / n for one sample more. What decides is the difference of
// halves' halves, over a pixel and its neighbours, never that of the halves, from which the error is taken: so that
// pixels are not left alone because their error looks small by chance. docs/sampling.md, "Adaptive sampling".
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "render/sampling.h"

enum { BUCKET_FINE = 4, BUCKET_MIDDLE = 700 }; // buckets for a factor of two; that of priority 1

// A round takes about this share of all samples taken before it: what a run may spend too much.
static const double ROUND_SHARE = 0.25;

// Where nothing has been seen, something may be: of the mean of all pixels.
static const double PRIORITY_FLOOR = 1e-3;

// What is predicted is taken between what was seen, which is told with caution, and what hard edges mostly have; the
// interval gets narrower on the way, to this power of its width now. Measured.
static const double USUAL_POWER = 1.4, WIDTH_POWER = 0.7;

static double mean_log_ratio(const Estimate *estimate)
{
    double sum = 0.0, weight = 0.0;
    for (int level = 2; level < LEVELS; level++) {
        weight += estimate->levels[level].outer_now;
        sum += estimate->levels[level].outer_now * log2(estimate->ratio[level]);
    }
    return weight > 0.0 ? sum / weight : 1.0;
}

static double bucket_priority(int bucket)
{
    return exp2((bucket + 0.5 - BUCKET_MIDDLE) / BUCKET_FINE);
}

static uint16_t bucket_of(double priority)
{
    double bucket = BUCKET_FINE * log2(priority) + BUCKET_MIDDLE;
    return (uint16_t)(bucket < 0.0 ? 0.0 : bucket >= BUCKETS ? BUCKETS - 1.0 : bucket);
}

// The constants c of all pixels, and what goes from there to a priority.
typedef struct Constants {
    const Film *film;
    double to_constant[LEVELS], to_priority[LEVELS]; // by level: counts are powers of two
    double floor;
} Constants;

static double constant_at(const Constants *constants, size_t pixel)
{
    const PixelRecord *record = &constants->film->records[pixel];
    return record->inner * constants->to_constant[estimate_level(record->count)];
}

static void constants_init(Constants *constants, const Film *film, double power)
{
    double sum = 0.0;
    size_t pixels = (size_t)film->width * (size_t)film->height;
    constants->film = film;
    for (int level = 0; level < LEVELS; level++) {
        constants->to_constant[level] = exp2(power * level);
        constants->to_priority[level] = exp2(-(power + 1.0) * level);
    }
    for (size_t i = 0; i < pixels; i++) {
        sum += constant_at(constants, i);
    }
    constants->floor = fmax(PRIORITY_FLOOR * sum / (double)pixels, 1e-30);
}

// Weighted 4, 2 and 1 by nearness; beyond the picture's sides the pixel beside them stands.
static double constant_near(const Constants *constants, int x, int y)
{
    const Film *film = constants->film;
    double sum = 0.0;
    for (int dy = -1; dy <= 1; dy++) {
        for (int dx = -1; dx <= 1; dx++) {
            int at_x = x + dx >= 0 && x + dx < film->width ? x + dx : x;
            int at_y = y + dy >= 0 && y + dy < film->height ? y + dy : y;
            double weight = (2 - abs(dx)) * (2 - abs(dy)) / 16.0;
            sum += weight * constant_at(constants, (size_t)at_y * (size_t)film->width + (size_t)at_x);
        }
    }
    return fmax(sum, constants->floor);
}

void choice_make(Choice *choice, const Estimate *estimate, const Film *film)
{
    Constants constants;
    double spent = 0.0;
    choice->power = mean_log_ratio(estimate);
    constants_init(&constants, film, choice->power);
    for (int i = 0; i < BUCKETS; i++) {
        choice->cost[i] = 0.0;
    }
    for (int y = 0; y < film->height; y++) {
        for (int x = 0; x < film->width; x++) {
            size_t pixel = (size_t)y * (size_t)film->width + (size_t)x;
            uint32_t count = film->records[pixel].count;
            double priority = constant_near(&constants, x, y) * constants.to_priority[estimate_level(count)];
            bool is_full = count > UINT32_MAX / 4;
            choice->of_pixel[pixel] = is_full ? 0 : bucket_of(priority);
            choice->cost[choice->of_pixel[pixel]] += count;
        }
    }
    int least = BUCKETS;
    while (least > 1 && (spent == 0.0 || spent + choice->cost[least - 1] <= ROUND_SHARE * (double)estimate->samples)) {
        spent += choice->cost[--least];
    }
    choice->least_bucket = (uint16_t)least;
}

// Plays the rounds that are to come on the buckets alone.
double choice_predict(const Choice *choice, const Estimate *estimate, const SamplingError *error, double target)
{
    double cost[BUCKETS], square[BUCKETS], known = 0.0, samples = (double)estimate->samples;
    for (int i = 0; i < BUCKETS; i++) {
        cost[i] = choice->cost[i];
        square[i] = cost[i] * bucket_priority(i);
        known += square[i];
    }
    // In units of what is known now.
    double power = 0.5 * (choice->power + USUAL_POWER);
    double high = error->rmse * pow(error->high / error->rmse, WIDTH_POWER);
    double goal = known * (target / high) * (target / high);
    int fall = (int)lround(BUCKET_FINE * (power + 1.0));
    double share = exp2(-power);
    for (int least = BUCKETS - 1; known > goal && least > fall; least--) {
        samples += cost[least];
        known -= square[least] * (1.0 - share);
        cost[least - fall] += 2.0 * cost[least];
        square[least - fall] += square[least] * share;
    }
    return known <= goal ? samples * (1.0 + 0.5 * ROUND_SHARE) : 0.0; // the last round goes beyond
}
