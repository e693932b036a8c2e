// Runs of rounds: how many samples are taken, and when that is enough.
//
// SPDX-License-Identifier: MIT
#include "render/sampling.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "render/tiles.h"

enum {
    ALIKE_SAMPLES = 4,  // of every pixel, before some get more than others, where corners say little
    FIRST_MOST = 16,    // in the first round: soon there is a picture, and a first word on its error
    PIXELS_MANY = 16384, // of a picture, from which some tell of its error as well as all
};

typedef struct Sampling {
    const Prepared *prepared;
    const RenderOptions *options;
    const SamplingOptions *wanted;
    Film *film;
    RenderStatistics *statistics;
    SamplingError *error;
    Round round;
    Estimate estimate;
    Choice choice;
    float *corners;        // owned by the caller; NULL: there is no such pilot
    double start;          // by the clock
    double sample_seconds; // of a sample, as the last round had it
    double round_samples;  // of this round
    double all_samples;    // of the run, as far as can be told; 0: not
} Sampling;

static double clock_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double pixel_count(const Sampling *s)
{
    return (double)s->film->width * s->film->height;
}

static void forward_progress(void *client, double done)
{
    const Sampling *s = client;
    double now = (double)s->estimate.samples + done * s->round_samples;
    bool is_known = s->all_samples > 0.0;
    RenderProgress progress = {is_known ? fmin(now / s->all_samples, 1.0) : 0.0, s->error,
                               is_known ? fmax(s->all_samples - now, 0.0) * s->sample_seconds : -1.0};
    s->options->progress(s->options->client, &progress);
}

static void trace_tile(void *client, Tile tile, RenderStatistics *counted)
{
    const Sampling *s = client;
    if (s->round.is_corners) {
        round_trace_corners(&s->round, tile, counted);
    } else {
        round_trace(&s->round, tile, counted);
    }
}

// What rays would have brought that were not followed, if they were as bright as the picture is in the mean.
static void find_bias(Sampling *s)
{
    double by_level = (double)s->statistics->cut_by_level, by_weight = (double)s->statistics->cut_by_weight, sum = 0.0;
    if (by_level + by_weight == 0.0) {
        return;
    }
    for (size_t i = 0; i < 3 * (size_t)pixel_count(s); i++) {
        sum += s->film->rgb[i];
    }
    double mean = sum / (3.0 * pixel_count(s)), unit = 0x1p-32 / (double)s->statistics->camera_rays;
    s->error->bias = (by_level + by_weight) * unit * mean;
    s->error->bias_by_level = by_level * unit * mean;
}

static bool trace_round(Sampling *s)
{
    double start = clock_seconds();
    int more = s->round.is_corners ? 1 : 0; // there are more corners than pixels
    TileWork work = {s, s->film->width + more, s->film->height + more, trace_tile,
                     s->options->progress ? forward_progress : NULL};
    bool is_whole = tiles_run(&work, s->options, s->statistics);
    if (is_whole) {
        s->sample_seconds = (clock_seconds() - start) / s->round_samples;
    }
    return is_whole;
}

// One round; false when it was cancelled, which leaves pixels with and without it.
static bool run_round(Sampling *s)
{
    bool is_whole = trace_round(s);
    if (!s->wanted->has_no_estimate) {
        estimate_update(&s->estimate, s->film, &s->round, is_whole, s->error);
        find_bias(s);
    } else {
        s->estimate.samples += (uint64_t)s->round_samples;
        s->error->samples = (double)s->estimate.samples / pixel_count(s);
    }
    return is_whole;
}

// What is left of a goal, in samples of the whole run.
static double predict(const Sampling *s)
{
    const SamplingOptions *wanted = s->wanted;
    double all = wanted->samples > 0.0 ? wanted->samples * pixel_count(s) : HUGE_VAL;
    if (wanted->time_limit > 0.0 && s->sample_seconds > 0.0) {
        double left = fmax(wanted->time_limit - (clock_seconds() - s->start), 0.0);
        all = fmin(all, (double)s->estimate.samples + left / s->sample_seconds);
    }
    if (wanted->target_error > 0.0 && s->choice.power > 0.0) {
        double samples = choice_predict(&s->choice, &s->estimate, &s->round, s->error, wanted->target_error);
        all = samples > 0.0 ? fmin(all, samples) : all;
    }
    return isfinite(all) ? all : 0.0;
}

// Whether one of the goals is reached, or a round more would miss one.
static bool is_enough(Sampling *s)
{
    const SamplingOptions *wanted = s->wanted;
    SamplingError *error = s->error;
    if (wanted->target_error > 0.0 && s->choice.power > 0.0 && error->high <= wanted->target_error) {
        error->end = SAMPLING_TARGET;
        return true;
    }
    if (wanted->samples > 0.0 && error->samples >= wanted->samples) {
        error->end = SAMPLING_DONE;
        return true;
    }
    double next_end = clock_seconds() - s->start + s->round_samples * s->sample_seconds;
    if (wanted->time_limit > 0.0 && error->samples > 0.0 && next_end > wanted->time_limit) {
        error->end = SAMPLING_TIME;
        return true;
    }
    return false;
}

// All pixels alike, by doubling: a quarter of them, or FIRST_MOST where that is less, …, half of them, all: two steps
// tell by what ratio the error falls. Sets that are no sequence are two halves.
static uint32_t next_count(const Sampling *s, uint32_t count, uint32_t all)
{
    uint32_t next = all;
    if (!sampler_is_sequence(s->wanted->sampler)) {
        return count == 0 ? (all + 1) / 2 : all;
    }
    uint32_t first = all / 4 < 2 ? 2 : all / 4 < FIRST_MOST ? all / 4 : FIRST_MOST;
    while ((next + 1) / 2 > count && (next + 1) / 2 >= first) {
        next = (next + 1) / 2;
    }
    return next;
}

static bool run_alike(Sampling *s, uint32_t all)
{
    for (uint32_t count = 0; count < all;) {
        uint32_t next = next_count(s, count, all);
        s->round.count = next;
        s->round_samples = (double)(next - count) * pixel_count(s);
        s->all_samples = predict(s);
        if (count > 0 && is_enough(s)) {
            return false;
        }
        if (!run_round(s)) {
            s->error->end = SAMPLING_INTERRUPTED;
            return false;
        }
        count = next;
    }
    return true;
}

// One ray through each corner, and some pixels that tell what that is worth. False when it was cancelled.
static bool run_pilot(Sampling *s)
{
    Round *round = &s->round;
    *round = (Round){.prepared = round->prepared,
                     .sampling = round->sampling,
                     .film = round->film,
                     .filter = round->filter,
                     .draws_more = round->draws_more,
                     .corners = s->corners,
                     .count = 1,
                     .has_corners = true,
                     .is_corners = true,
                     .is_pilot = true};
    s->round_samples = s->estimate.corners = (s->film->width + 1.0) * (s->film->height + 1.0);
    s->all_samples = predict(s);
    if (!trace_round(s)) {
        return false;
    }
    pilot_sort(round, s->choice.of_pixel, s->choice.memory);
    round->is_corners = false;
    round->count = 0;
    round->buckets = s->choice.of_pixel;
    round->least_bucket = PILOT_PROBE;
    if (!trace_round(s)) {
        return false;
    }
    round->is_pilot = false;
    pilot_judge(&s->estimate, s->film, s->choice.of_pixel);
    estimate_now(&s->estimate, s->film, round, s->error);
    find_bias(s);
    return true;
}

static void run_adaptive(Sampling *s)
{
    s->round.buckets = s->choice.of_pixel;
    s->round.count = 0;
    for (;;) {
        choice_make(&s->choice, &s->estimate, &s->round);
        s->round.least_bucket = s->choice.least_bucket;
        s->round_samples = s->choice.spent;
        s->all_samples = predict(s);
        if (is_enough(s)) {
            return;
        }
        if (s->round_samples == 0.0 || !run_round(s)) {
            s->error->end = s->round_samples == 0.0 ? SAMPLING_DONE : SAMPLING_INTERRUPTED;
            return;
        }
    }
}

// A goal is reached or not by what all pixels say.
static bool judges_some(const SamplingOptions *wanted, const Film *film)
{
    return wanted->no_pixel_errors && !wanted->is_adaptive &&
           (double)film->whole_width * film->whole_height >= PIXELS_MANY;
}

static bool draws_more(const Prepared *prepared)
{
    bool has_area = false;
    for (size_t i = 0; i < prepared->light_count; i++) {
        has_area = has_area || prepared->lights[i].area.size1 > 0;
    }
    return has_area || prepared->camera.lens_radius > 0.0;
}

static void sampling_free(Sampling *s)
{
    if (s) {
        free(s->choice.of_pixel);
        free(s->choice.memory);
        free(s->corners);
        free(s);
    }
}

// NULL when out of memory. The film keeps its records.
static Sampling *sampling_new(const SamplingOptions *wanted, Film *film)
{
    size_t width = (size_t)film->width, height = (size_t)film->height;
    bool has_pilot = wanted->is_adaptive && wanted->filter == FILTER_BOX;
    Sampling *s = calloc(1, sizeof *s);
    film->records = calloc(width * height, sizeof *film->records);
    if (s && wanted->is_adaptive) {
        s->choice.of_pixel = calloc(width * height, sizeof *s->choice.of_pixel);
        s->choice.memory = calloc(width, NEAR_ROWS * sizeof *s->choice.memory);
    }
    if (s && has_pilot) {
        s->corners = calloc((width + 1) * (height + 1), 3 * sizeof *s->corners);
    }
    bool is_whole = s && film->records && (!has_pilot || s->corners) &&
                    (!wanted->is_adaptive || (s->choice.of_pixel && s->choice.memory));
    if (!is_whole) {
        sampling_free(s);
        return NULL;
    }
    return s;
}

RenderResult sampling_run(const Prepared *prepared, const RenderOptions *options, Film *film,
                          RenderStatistics *statistics, SamplingError *error)
{
    const SamplingOptions *wanted = options->sampling;
    size_t pixels = (size_t)film->width * (size_t)film->height;
    uint32_t alike = wanted->is_adaptive ? ALIKE_SAMPLES : (uint32_t)wanted->samples;
    Sampling *s = sampling_new(wanted, film);
    if (!s) {
        return RENDER_NO_MEMORY;
    }
    s->prepared = prepared;
    s->options = options;
    s->wanted = wanted;
    s->film = film;
    s->statistics = statistics;
    s->error = error;
    s->start = clock_seconds();
    s->round = (Round){.prepared = prepared,
                       .sampling = wanted,
                       .film = film,
                       .draws_more = draws_more(prepared),
                       .judges_some = judges_some(wanted, film)};
    estimate_begin(&s->estimate, &s->round);
    filter_init(&s->round.filter, wanted->filter);
    if (s->corners && !run_pilot(s)) {
        error->end = SAMPLING_INTERRUPTED;
    } else if ((s->corners || run_alike(s, alike)) && wanted->is_adaptive) {
        run_adaptive(s);
    }
    bool is_whole = error->end != SAMPLING_INTERRUPTED;
    for (size_t i = 0; !is_whole && i < pixels; i++) {
        if (film->records[i].count == 0) {
            error->samples = 0.0; // no picture
        }
    }
    sampling_free(s);
    return is_whole ? RENDER_OK : RENDER_CANCELLED;
}
