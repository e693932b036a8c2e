// Runs of rounds: how many samples are taken, and when that is enough.
//
// SPDX-License-Identifier: MIT
#include "render/sample/sampling_run.h"

#include <math.h>
#include <stdlib.h>

#include "base/cleared.h"

enum {
    ALIKE_SAMPLES = 4,  // of every pixel, before some get more than others, where corners say little
    FIRST_MOST = 16,    // in the first round: soon there is a picture, and a first word on its error
    PIXELS_MANY = 16384, // of a picture, from which some tell of its error as well as all
};

// All pixels alike, by doubling: a quarter of them, or FIRST_MOST where that is less, …, half of them, all: two steps
// tell by what ratio the error falls. Sets that are no sequence are two halves.
static uint32_t next_count(const Sampling *s, uint32_t count, uint32_t all)
{
    uint32_t next = all;
    if (stop_has_choice(s->wanted)) {
        return all; // each pixel by itself
    }
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
        goal_predict(s);
        if (count > 0 && goal_is_reached(s)) {
            return false;
        }
        if (count > 0 && s->round_samples * s->sample_seconds > goal_seconds(s)) {
            s->error->end = SAMPLING_TIME;
            return false;
        }
        if (!sampling_round(s)) {
            s->error->end = SAMPLING_INTERRUPTED;
            return false;
        }
        count = next;
    }
    return true;
}

// One ray through each corner, and some pixels that tell what that is worth. False when it was cancelled.
static bool run_corner_pass(Sampling *s)
{
    Round *round = &s->round;
    round->corners = s->corners;
    round->count = 1;
    round->has_corners = round->is_corners = round->is_corner_pass = true;
    s->round_samples = s->estimate.corners = (s->film->width + 1.0) * (s->film->height + 1.0);
    goal_predict(s);
    if (!sampling_trace(s)) {
        return false;
    }
    s->cost.sample = s->sample_seconds;
    uint32_t probes = corner_pass_sort(round, s->allocation.of_pixel, s->allocation.memory);
    round->is_corners = false;
    round->count = 0;
    round->buckets = s->allocation.of_pixel;
    round->least_bucket = CORNER_PASS_PROBE;
    s->round_samples = START_SAMPLES * (double)probes;
    if (!sampling_trace(s)) {
        return false;
    }
    round->is_corner_pass = false;
    s->cost.pixel = START_SAMPLES * fmax(s->sample_seconds - s->cost.sample, 0.0);
    corner_pass_judge(&s->estimate, s->film, s->allocation.of_pixel);
    if (s->predictor) {
        predictor_keep_sorts(s->predictor, s->allocation.of_pixel, (size_t)pixel_count(s));
    }
    estimate_now(&s->estimate, s->film, round, s->error);
    sampling_find_bias(s);
    atomic_store(&s->prepared->abandon->keeps, true);
    return sampling_look(s);
}

static void run_adaptive(Sampling *s)
{
    s->round.buckets = s->allocation.of_pixel;
    s->round.blocks = s->allocation.of_block;
    s->round.count = 0;
    s->cost.sample = s->corners ? s->cost.sample : s->sample_seconds;
    for (bool is_first = true;; is_first = false) {
        allocation_make(&s->allocation, &s->estimate, &s->round);
        if (is_first && s->predictor && s->corners) {
            predictor_see_starts(s->predictor, &s->allocation, &s->round);
        }
        s->round.least_bucket = s->allocation.least_bucket;
        s->round_samples = s->allocation.spent;
        goal_predict(s);
        if (goal_is_reached(s)) {
            return;
        }
        Last last = s->round_samples > 0.0 ? goal_run_chosen(s) : LAST_DONE;
        if (last != LAST_NOT) {
            static const SamplingEnd ends[] = {[LAST_DONE] = SAMPLING_DONE,
                                               [LAST_TIME] = SAMPLING_TIME,
                                               [LAST_INTERRUPTED] = SAMPLING_INTERRUPTED};
            s->error->end = ends[last];
            return;
        }
        goal_count_round(s);
    }
}

// A goal is reached or not by what all pixels say.
static bool counts_some(const SamplingOptions *wanted, const Film *film)
{
    return wanted->no_pixel_errors && !wanted->is_adaptive && !stop_has_choice(wanted) &&
           (double)film->whole_width * film->whole_height >= PIXELS_MANY;
}

static bool draws_more(const Prepared *prepared)
{
    bool has_area = false;
    for (size_t i = 0; i < prepared->light_count; i++) {
        has_area = has_area || prepared->lights[i].area.size1 > 0;
    }
    return has_area || prepared->has_dome || prepared->camera.lens_radius > 0.0;
}

static void sampling_free(Sampling *s)
{
    if (s) {
        free(s->allocation.of_pixel);
        free(s->allocation.of_block);
        free(s->allocation.memory);
        free(s->corners);
        predictor_free(s->predictor);
        share_free(s->round.share);
        small_free(s->round.small);
        free(s);
    }
}

// NULL when out of memory. The film keeps its records.
static Sampling *sampling_new(const SamplingOptions *wanted, bool has_progress, Film *film)
{
    size_t width = (size_t)film->width, height = (size_t)film->height;
    bool has_corner_pass = wanted->is_adaptive && wanted->filter == FILTER_BOX;
    bool predicts = wanted->is_adaptive && wanted->target_error > 0.0 && has_progress;
    Sampling *s = calloc(1, sizeof *s);
    film->records = cleared_new(width * height, sizeof *film->records);
    if (s && wanted->is_adaptive) {
        s->allocation.of_pixel = cleared_new(width * height, sizeof *s->allocation.of_pixel);
        s->allocation.of_block =
            cleared_new(round_blocks(film->width) * round_blocks(film->height), sizeof *s->allocation.of_block);
        s->allocation.memory = calloc(width, ALLOCATION_ROWS * sizeof *s->allocation.memory);
    }
    if (s && has_corner_pass) {
        // One more: sampling_corners.c reads them by fours.
        s->corners = cleared_new(3 * (width + 1) * (height + 1) + 1, sizeof *s->corners);
    }
    if (s && predicts) {
        s->predictor = predictor_new(width * height);
    }
    bool is_whole =
        s && film->records && (!has_corner_pass || s->corners) && (!predicts || s->predictor) &&
        (!wanted->is_adaptive || (s->allocation.of_pixel && s->allocation.of_block && s->allocation.memory));
    if (!is_whole) {
        sampling_free(s);
        return NULL;
    }
    return s;
}

// Lists of small shapes and strata, for a run that has them; false when out of memory.
static bool add_shapes(Sampling *s, const Prepared *prepared, const RenderOptions *options, Film *film)
{
    const SamplingOptions *wanted = options->sampling;
    bool has_memory = true;
    // A pixel that ends where it has enough says by its replicas what it may have missed.
    if (!wanted->has_no_estimate && !stop_has_choice(wanted)) {
        s->round.small = small_new(prepared, options, film, &has_memory);
    }
    // Of fewer samples strata are hardly ever weighted; of a run to a goal, which may be made again by its number of
    // samples, all pixels are.
    bool has_shares = wanted->is_adaptive || wanted->samples >= SHARE_SAMPLES;
    if (has_memory && has_shares && wanted->filter == FILTER_BOX && !stop_has_choice(wanted)) {
        s->round.share = share_new(prepared, film, &has_memory);
    }
    return has_memory;
}

// All rounds; sets the error's `end` where they end before all samples are taken.
static void run_rounds(Sampling *s)
{
    const SamplingOptions *wanted = s->wanted;
    if (!s->corners && !run_alike(s, wanted->is_adaptive ? ALIKE_SAMPLES : (uint32_t)wanted->samples)) {
        return;
    }
    if (!wanted->is_adaptive) {
        return;
    }
    if (s->corners ? run_corner_pass(s) : sampling_look(s)) {
        run_adaptive(s);
    } else {
        s->error->end = SAMPLING_INTERRUPTED;
    }
}

// What the finished picture is off by.
static void judge(Sampling *s)
{
    SamplingError *error = s->error;
    bool is_part = s->options->share && s->options->share->is_part; // which knows of no others
    if (error->end != SAMPLING_INTERRUPTED && error->end != SAMPLING_TARGET && !s->wanted->has_no_estimate &&
        !is_part) {
        if (sampling_audit(s) && s->looks.count > 0) {
            look_show(&s->looks, s->round.small, s->film, error);
        }
        sampling_find_missed(s);
    }
    statistics_add(s->statistics, &s->audited);
    bool is_whole = error->end != SAMPLING_INTERRUPTED;
    for (size_t i = 0; !is_whole && i < (size_t)pixel_count(s); i++) {
        if (s->film->records[i].count == 0) {
            error->samples = 0.0; // no picture
        }
    }
}

RenderResult sampling_run(const Prepared *prepared, const RenderOptions *options, Film *film,
                          RenderStatistics *statistics, SamplingError *error)
{
    const SamplingOptions *wanted = options->sampling;
    Sampling *s = sampling_new(wanted, options->progress != NULL, film);
    if (!s || !add_shapes(s, prepared, options, film)) {
        sampling_free(s);
        return RENDER_NO_MEMORY;
    }
    s->prepared = prepared;
    s->options = options;
    s->wanted = wanted;
    s->film = film;
    s->statistics = statistics;
    s->error = error;
    s->start = s->round_end = sampling_seconds(s);
    s->audit_scale = AUDIT_FACTOR;
    s->audit_least = AUDIT_WIDTH;
    s->round.prepared = prepared;
    s->round.sampling = wanted;
    s->round.film = film;
    s->round.draws_more = draws_more(prepared);
    s->round.counts_some = counts_some(wanted, film);
    estimate_begin(&s->estimate, &s->round);
    filter_init(&s->round.filter, wanted->filter);
    run_rounds(s);
    judge(s);
    RenderResult result = s->result;
    sampling_free(s);
    return result;
}
