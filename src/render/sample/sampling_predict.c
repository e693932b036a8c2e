// How many samples a run to a goal will take.
//
// Pixels go into classes by the number of their samples and by priority, and the coming rounds are played on these, in
// the order in which pixels would be chosen. Pixels that start become what those became that were chosen by chance for
// the corner pass; errors of others fall as has been seen, or is expected, at such numbers of samples, and pixels of a
// class become unlike each other. What is predicted is what will be reported, not what will be true. docs/sampling.md,
// "What is left".
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/sample/sampling.h"

enum {
    SHIFT_MOST = 120,  // buckets by which a pixel may rise or fall when it starts
    SPREAD = 4,        // buckets by which pixels of a class part when they are doubled; measured
    START_LEVEL = 2,   // of START_SAMPLES
    LEAST_BUCKET = 64, // pixels below it are left alone: 1e-33
};

// Where light is smooth, variance falls by the greatest ratio that is believed; at hard edges as n^-(1 + 1/d) in d
// dimensions. What is seen may be off from what the two let expect by so much, as a standard deviation of logarithms.
static const double SMOOTH_POWER = 3.0, EDGE_POWER = 1.5, EDGE_POWER_MORE = 1.25, POWER_DEVIATION = 0.25;

// How much of its share a round takes in the mean.
static const double ROUND_USED = 0.8;

// Pixels of a class, and the sum of what the last halves of these differ by (PixelRecord.outer).
typedef struct Class {
    double count, outer;
} Class;

struct Predictor {
    // When pixels start: into which bucket they come, over that of pixels that are left with corners as bad, weighted
    // by what these are off by; and of what those are off by, how large `outer` is then.
    double start_count[2 * SHIFT_MOST + 1], start_outer[2 * SHIFT_MOST + 1];
    Class classes[BUCKETS][LEVELS];
    uint8_t sorts[]; // of all pixels
};

Predictor *predictor_new(size_t pixels)
{
    return calloc(1, sizeof(Predictor) + pixels);
}

void predictor_free(Predictor *predictor)
{
    free(predictor);
}

// ---- what pixels become that start

void predictor_keep_sorts(Predictor *predictor, const uint16_t *buckets, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++) {
        predictor->sorts[i] = (uint8_t)(buckets[i] & ~(CORNER_PASS_PROBE | CORNER_PASS_SMALL));
    }
}

typedef struct SortMean {
    double count, bucket, off; // sums
} SortMean;

void predictor_see_starts(Predictor *predictor, const Allocation *allocation, const Round *round)
{
    const Film *film = round->film;
    SortMean sorts[CORNER_PASS_SORTS] = {{0.0, 0.0, 0.0}};
    size_t pixels = (size_t)film->width * (size_t)film->height;
    double weight = 0.0;
    memset(predictor->start_count, 0, sizeof predictor->start_count);
    memset(predictor->start_outer, 0, sizeof predictor->start_outer);
    for (size_t i = 0; i < pixels; i++) {
        const PixelRecord *record = &film->records[i];
        if (record->count == 1) {
            SortMean *sort = &sorts[predictor->sorts[i]];
            sort->count++;
            sort->bucket += allocation->of_pixel[i];
            sort->off += (double)record->outer;
        }
    }
    for (size_t i = 0; i < pixels; i++) {
        const PixelRecord *record = &film->records[i];
        const SortMean *sort = &sorts[predictor->sorts[i]];
        if (record->count > 1 && sort->count > 0.0 && !small_has(round->small, i)) { // one that was chosen by chance
            int shift = allocation->of_pixel[i] - (int)lround(sort->bucket / sort->count) + SHIFT_MOST;
            shift = shift < 0 ? 0 : shift > 2 * SHIFT_MOST ? 2 * SHIFT_MOST : shift;
            predictor->start_count[shift] += sort->off / sort->count;
            predictor->start_outer[shift] += (double)record->outer;
            weight += sort->off / sort->count;
        }
    }
    for (int i = 0; i <= 2 * SHIFT_MOST; i++) {
        predictor->start_count[i] /= weight > 0.0 ? weight : 1.0;
        predictor->start_outer[i] /= weight > 0.0 ? weight : 1.0;
    }
    if (!(weight > 0.0)) {
        predictor->start_count[SHIFT_MOST] = 1.0; // nothing is off
    }
}

// ---- the coming rounds, played

typedef struct Play {
    Predictor *predictor;
    int lowest, highest, top; // buckets and levels that have pixels

    double gain[LEVELS];  // what goes from `outer` to the error
    double stays[LEVELS]; // of `outer`, when pixels come to a level,
    int fall[LEVELS];     // by how many buckets they fall then,
    double count[LEVELS]; // and how many samples they have

    // Shares of pixels that part.
    double worse_count, worse_outer, better_count, better_outer;

    double samples, visits;            // of pixels, in rounds
    double square; // the sum of the squares of errors
} Play;

// The logarithm of the ratio of the next level: each part falls by its own, and the smooth one is soon gone. From below
// that of edges halfway to it.
static double next_power(double power, double edges)
{
    if (power <= edges) {
        return 0.5 * (power + edges);
    }
    double edge = exp2(-edges), smooth = exp2(-SMOOTH_POWER), both = exp2(-power);
    double part = (edge - both) / (edge - smooth) * smooth / both;
    return -log2(edge - (edge - smooth) * part);
}

// The logarithms of the ratios that are expected to be reported. What was seen of these counts as far as it is sure: by the
// spread of what it was seen from.
static void play_powers(Play *play, const Estimate *estimate, const Round *round)
{
    const double sure = 2.0 * 2.0 / 3.0 / (0.6931 * 0.6931); // of the logarithm of a quotient of sums of squares
    double edges = round->draws_more ? EDGE_POWER_MORE : EDGE_POWER, power = edges, variance = 1.0, powers[LEVELS];
    for (int level = START_LEVEL; level < LEVELS; level++) {
        const LevelSums *sums = &estimate->levels[level];
        power = next_power(power, edges);
        if (sums->outer > 0.0 && sums->inner > 0.0) {
            double own = sure * sums->squares / (sums->outer * sums->outer);
            power += variance / (variance + own) * (log2(estimate->ratio[level]) - power);
            variance = POWER_DEVIATION * POWER_DEVIATION;
        }
        powers[level] = power;
    }
    powers[0] = powers[1] = powers[START_LEVEL];
    for (int level = 0; level < LEVELS; level++) {
        play->stays[level] = exp2(-powers[level]);
        play->gain[level] = level == 0 && round->has_corners ? 1.0 : 1.0 / (exp2(powers[level]) - 1.0);
        play->fall[level] = (int)lround(BUCKET_FINE * (powers[level] + 1.0));
        play->count[level] = exp2(level);
    }
    double factor = exp2((double)SPREAD / BUCKET_FINE), worse = (1.0 - 1.0 / factor) / (factor - 1.0 / factor);
    play->worse_count = worse;
    play->worse_outer = worse * factor;
    play->better_count = 1.0 - worse;
    play->better_outer = (1.0 - worse) / factor;
}

static void play_put(Play *play, int bucket, int level, double count, double outer)
{
    bucket = bucket > 0 ? bucket : 0;
    play->lowest = bucket < play->lowest ? bucket : play->lowest;
    play->top = level > play->top ? level : play->top;
    Class *class = &play->predictor->classes[bucket][level];
    class->count += count;
    class->outer += outer;
    play->square += outer * play->gain[level];
}

// Fills the classes, which are empty.
static void play_begin(Play *play, const Allocation *allocation, const Estimate *estimate, const Round *round)
{
    const Film *film = round->film;
    size_t pixels = (size_t)film->width * (size_t)film->height;
    play_powers(play, estimate, round);
    play->lowest = 0;
    play->highest = BUCKETS - 1;
    play->samples = (double)estimate->samples;
    uint32_t counts = 1;
    for (size_t i = 0; i < pixels; i++) {
        const PixelRecord *record = &film->records[i];
        Class *class = &play->predictor->classes[allocation->of_pixel[i]][estimate_level(record->count)];
        class->count++;
        class->outer += (double)record->outer;
        counts |= record->count;
    }
    play->top = estimate_level(counts);
    while (play->highest > 0 && allocation_cost(allocation, play->highest) == 0.0) {
        play->highest--;
    }
    while (play->lowest < play->highest && allocation_cost(allocation, play->lowest) == 0.0) {
        play->lowest++;
    }
    for (int bucket = play->lowest; bucket <= play->highest; bucket++) {
        for (int level = 0; level <= play->top; level++) {
            const Class *class = &play->predictor->classes[bucket][level];
            play->square += class->outer * play->gain[level];
        }
    }
}

static void play_end(Play *play)
{
    for (int bucket = play->lowest; bucket <= play->highest; bucket++) {
        memset(play->predictor->classes[bucket], 0, (size_t)(play->top + 1) * sizeof(Class));
    }
}

// How many pixels are in some buckets.
static double play_pixels(const Play *play, int least, int highest)
{
    double count = 0.0;
    for (int bucket = least; bucket <= highest; bucket++) {
        for (int level = 0; level <= play->top; level++) {
            count += play->predictor->classes[bucket][level].count;
        }
    }
    return count;
}

// Pixels of a bucket start: the highest bucket into which some of them come.
static int play_start(Play *play, int bucket, const Class *class)
{
    const Predictor *predictor = play->predictor;
    int last = bucket;
    for (int i = 0; i <= 2 * SHIFT_MOST; i++) {
        if (predictor->start_count[i] > 0.0) {
            int to = bucket + i - SHIFT_MOST;
            to = to < BUCKETS ? to : BUCKETS - 1;
            play_put(play, to, START_LEVEL, class->count * predictor->start_count[i],
                     class->outer * predictor->start_outer[i]);
            last = to > last ? to : last;
        }
    }
    play->samples += START_SAMPLES * class->count;
    play->highest = last > play->highest ? last : play->highest;
    return last;
}

// Pixels of a bucket get as many samples as they have. Some turn out to be worse, some better, the same in the mean.
static void play_double(Play *play, int bucket, int level, const Class *class)
{
    int next = level + 1 < LEVELS ? level + 1 : level, to = bucket - play->fall[next];
    double outer = class->outer * play->stays[next];
    play->samples += play->count[level] * class->count;
    play_put(play, to + SPREAD, next, play->worse_count * class->count, play->worse_outer * outer);
    play_put(play, to - SPREAD, next, play->better_count * class->count, play->better_outer * outer);
}

// One bucket; where to continue from.
static int play_bucket(Play *play, int bucket, bool has_corners)
{
    int next = bucket;
    for (int level = play->top; level >= 0; level--) {
        Class class = play->predictor->classes[bucket][level];
        bool is_corner = level == 0 && has_corners;
        if (class.count > 0.0) {
            play->predictor->classes[bucket][level] = (Class){0.0, 0.0};
            play->square -= class.outer * play->gain[level];
            play->visits += class.count;
            if (is_corner) {
                next = play_start(play, bucket, &class);
            } else {
                play_double(play, bucket, level, &class);
            }
        }
    }
    return next;
}

// Plays until the goal is reached; false when it is not.
static bool play_run(Play *play, const Estimate *estimate, bool has_corners, double target)
{
    int bucket = play->highest;
    while (play->square > target * target * estimate->judged) {
        if (bucket < LEAST_BUCKET) {
            return false;
        }
        bucket = play_bucket(play, bucket, has_corners);
        while (bucket >= LEAST_BUCKET && play_pixels(play, bucket, bucket) == 0.0) {
            bucket--;
        }
    }
    return true;
}

Forecast predictor_run(Predictor *predictor, const Allocation *allocation, const Estimate *estimate, const Round *round,
                       double target)
{
    Play play = {.predictor = predictor};
    play_begin(&play, allocation, estimate, round);
    double begin = play.samples, next = begin + allocation->spent;
    Forecast forecast = {.round_pixels = play_pixels(&play, allocation->least_bucket, play.highest)};
    if (play_run(&play, estimate, round->has_corners, target)) {
        // Rounds are done as wholes: the last goes beyond by half of it in the mean.
        double beyond = play.samples * (1.0 + 0.5 * ROUND_SHARE);
        bool is_next = beyond <= next || play.samples == begin;
        forecast.samples = is_next ? next : beyond;
        forecast.pixels = is_next ? forecast.round_pixels : play.visits * (beyond - begin) / (play.samples - begin);
        forecast.rounds = is_next ? 0.0 : log(beyond / next) / log1p(ROUND_USED * ROUND_SHARE);
    }
    play_end(&play);
    return forecast;
}
