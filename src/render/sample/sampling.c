// Runs of rounds: how many samples are taken, and when that is enough.
//
// SPDX-License-Identifier: MIT
#include "render/sample/sampling.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "render/sample/tiles.h"

enum {
    ALIKE_SAMPLES = 4,  // of every pixel, before some get more than others, where corners say little
    FIRST_MOST = 16,    // in the first round: soon there is a picture, and a first word on its error
    PIXELS_MANY = 16384, // of a picture, from which some tell of its error as well as all
};

// What is known of the time that rounds take, for what is shown. Rays of one pixel go together, those of others less:
// the rays through corners go together as those of one pixel do, those of the corner pass's pixels are the least
// together.
typedef struct Cost {
    double sample, pixel;           // seconds of the corner pass for each sample, and for each pixel that takes part
    double seconds, by_corner_pass; // of the rounds since, and as the corner pass lets expect; the last counts most
} Cost;

static const double AUDIT_FACTOR = 1.25; // the width of an audit's interval, as a factor, before one was made
static const double AUDIT_WIDTH = 1.15;  // the same of a narrow one
static const double AUDIT_COST = 1.0;    // samples between audits, for each that an audit took
static const double AUDIT_CHANCE = 1.05; // how much less the error must be, since audits fail by chance; measured
static const double COST_FADE = 0.8; // of what is known from earlier rounds

// What a tile's work is.
typedef enum Traces { TRACES_ROUND, TRACES_REPLICAS, TRACES_LOOKS } Traces;

typedef struct Sampling {
    const Prepared *prepared;
    const RenderOptions *options;
    const SamplingOptions *wanted;
    Film *film;
    RenderStatistics *statistics;
    SamplingError *error;
    Round round;
    Estimate estimate;
    Allocation allocation;
    Audit audit;
    Looks looks;
    Traces traces;
    RenderStatistics audited; // their rays: no part of what the picture's own say
    double audit_scale;    // the upper end of an audit's interval, over what the rounds say of the error: expected,
    double audit_least;    // and as low as may be; below it no audit finds the goal reached
    double audit_next;     // samples before which another one would cost too much
    Predictor *predictor;  // NULL: nobody asks
    Cost cost;
    float *corners;        // owned by the caller; NULL: there is no such pilot
    double start;          // by the clock
    double round_end;      // when the last one had been traced
    double sample_seconds; // of a sample, as the last round had it
    double round_samples;  // of this round, or of a slice of it
    double sliced_samples; // of the slices before
    double all_samples;    // of the run, as far as can be told; 0: not
    double round_pixels;   // that take part, if anybody asks
    double round_seconds;  // predicted of this round
    double later_seconds;  // and of those after it
    RenderResult result;   // of the last round
} Sampling;

static double cost_by_pilot(const Cost *cost, double samples, double pixels)
{
    return cost->sample * samples + cost->pixel * pixels;
}

static double cost_of(const Cost *cost, double samples, double pixels)
{
    double seconds = cost_by_pilot(cost, samples, pixels);
    return cost->by_corner_pass > 0.0 ? seconds * cost->seconds / cost->by_corner_pass : seconds;
}

static void cost_add(Cost *cost, double samples, double pixels, double seconds)
{
    cost->seconds = COST_FADE * cost->seconds + seconds;
    cost->by_corner_pass = COST_FADE * cost->by_corner_pass + cost_by_pilot(cost, samples, pixels);
}

static double pixel_count(const Sampling *s)
{
    return (double)s->film->width * s->film->height;
}

static void forward_progress(void *client, double done)
{
    const Sampling *s = client;
    double now = (double)s->estimate.samples + s->sliced_samples + done * s->round_samples;
    bool is_known = s->all_samples > 0.0, has_time = is_known && s->sample_seconds > 0.0;
    RenderProgress progress = {is_known ? fmin(now / s->all_samples, 1.0) : 0.0, s->error,
                               has_time ? s->later_seconds + (1.0 - done) * s->round_seconds : -1.0};
    s->options->progress(s->options->client, &progress);
}

static void trace_tile(void *client, Tile tile, RenderScratch *scratch, RenderStatistics *counted)
{
    Sampling *s = client;
    bool stops = stop_has_choice(s->wanted);
    if (s->traces == TRACES_REPLICAS && stops) {
        stop_trace_replicas(&s->round, &s->audit, tile.left, tile.right, scratch, counted);
    } else if (stops) {
        stop_trace(&s->round, tile, scratch, counted);
    } else if (s->traces == TRACES_REPLICAS) {
        round_trace_replicas(&s->round, &s->audit, tile.left, tile.right, scratch, counted);
    } else if (s->traces == TRACES_LOOKS) {
        look_trace(&s->round, &s->looks, tile, scratch, counted);
    } else if (s->round.is_corners) {
        round_trace_corners(&s->round, tile, scratch, counted);
    } else {
        round_trace(&s->round, tile, scratch, counted);
    }
}

// What trace_tile left; see tile_bytes.h.
static void code_tile(void *client, Tile tile, TileBytes *bytes)
{
    Sampling *s = client;
    if (s->traces == TRACES_REPLICAS) {
        audit_code(&s->audit, tile.left, tile.right, bytes);
    } else if (s->traces == TRACES_LOOKS) {
        look_code(&s->round, &s->looks, tile, bytes);
    } else if (s->round.is_corners) {
        round_code_corners(&s->round, tile, bytes);
    } else {
        round_code(&s->round, tile, bytes);
    }
}

// What rounds are chosen by where time is one of the goals: the same in all processes that share the work.
static double seconds_now(const Sampling *s)
{
    const TileShare *share = s->wanted->time_limit > 0.0 ? s->options->share : NULL;
    double own = clock_seconds();
    return share ? share->seconds(share->client, own) : own;
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
    double start = seconds_now(s);
    int more = s->round.is_corners ? 1 : 0; // there are more corners than pixels
    TileWork work = {.client = s,
                     .prepared = s->prepared,
                     .width = s->film->width + more,
                     .height = s->film->height + more,
                     .trace = trace_tile,
                     .progress = s->options->progress ? forward_progress : NULL,
                     .code = code_tile};
    s->result = tiles_run(&work, s->options, s->statistics);
    bool is_whole = s->result == RENDER_OK;
    s->round_end = seconds_now(s);
    if (is_whole) {
        s->sample_seconds = (s->round_end - start) / s->round_samples;
    }
    return is_whole;
}

// Whether a round of all pixels is too early to be judged: halves of one sample say little, and no ratio goes by it.
static bool is_early(const Sampling *s)
{
    bool is_last = !s->wanted->is_adaptive && s->round.count >= s->wanted->samples;
    return s->round.count > 0 && s->round.count < START_SAMPLES && !is_last;
}

// One round; false when it was cancelled, which leaves pixels with and without it.
static bool run_round(Sampling *s)
{
    bool is_whole = trace_round(s);
    if (is_whole) {
        atomic_store(&s->prepared->abandon->keeps, true);
    } else if (!atomic_load(&s->prepared->abandon->keeps)) {
        return false; // rays were left out of what is there
    }
    if (stop_has_choice(s->wanted)) {
        estimate_now(&s->estimate, s->film, &s->round, s->error);
        s->error->is_known = s->error->is_known && !s->wanted->has_no_estimate;
        find_bias(s);
    } else if (!s->wanted->has_no_estimate && !(is_whole && is_early(s))) {
        estimate_update(&s->estimate, s->film, &s->round, is_whole, s->error);
        find_bias(s);
    } else {
        s->estimate.samples += (uint64_t)s->round_samples;
        s->error->samples = (double)s->estimate.samples / pixel_count(s);
    }
    return is_whole;
}

// Traces what changes no pixel, so that any ray may be left out; false when it was cancelled.
static bool trace_beside(Sampling *s, Traces traces)
{
    bool keeps = atomic_exchange(&s->prepared->abandon->keeps, false);
    TileWork work = {.client = s,
                     .prepared = s->prepared,
                     .width = s->film->width,
                     .height = s->film->height,
                     .trace = trace_tile,
                     .code = code_tile};
    if (traces == TRACES_REPLICAS) { // a row of picks, which are anywhere
        work.width = s->audit.count;
        work.height = 1;
    }
    s->traces = traces;
    RenderResult result = tiles_run(&work, s->options, &s->audited);
    s->traces = TRACES_ROUND;
    atomic_store(&s->prepared->abandon->keeps, keeps);
    s->result = result == RENDER_NO_MEMORY || result == RENDER_NOT_SHARED ? result : s->result;
    return result == RENDER_OK;
}

// Sets that are no sequences are two independent halves, which need no audit.
static bool has_audit(const SamplingOptions *wanted)
{
    return sampler_is_sequence(wanted->sampler) || stop_has_choice(wanted);
}

// Looks at small shapes that no sample has met; false when it was cancelled.
static bool run_looks(Sampling *s)
{
    s->looks.count = 0;
    s->looks.square = s->looks.variance = 0.0;
    s->looks.sees_all = true;
    memset(s->looks.unmet, 0, sizeof s->looks.unmet);
    if (!s->round.small || look_draw(&s->looks, &s->round, (double)s->estimate.samples) == 0) {
        return true;
    }
    bool is_whole = trace_beside(s, TRACES_LOOKS);
    if (is_whole) {
        look_judge(&s->looks, &s->round);
    }
    return is_whole;
}

// Judges the picture by replicas of some pixels, and by what small shapes would bring that no sample has met; false
// when it was cancelled.
static bool run_audit(Sampling *s)
{
    if (!s->error->is_known) {
        return true;
    }
    if (!run_looks(s)) {
        return false;
    }
    if (s->round.share) {
        share_set_contrasts(&s->round);
    }
    if (has_audit(s->wanted) && audit_draw(&s->audit, &s->estimate, &s->round) > 0) {
        if (!trace_beside(s, TRACES_REPLICAS)) {
            return false;
        }
        audit_judge(&s->audit, &s->estimate, s->error);
    }
    if (s->round.small) {
        look_tell(&s->looks, pixel_count(s), s->error);
    }
    return true;
}

// What is left of a goal: samples of the whole run, and seconds.
static void predict(Sampling *s)
{
    const SamplingOptions *wanted = s->wanted;
    double had = (double)s->estimate.samples, round = s->round_samples;
    double all = wanted->samples > 0.0 ? wanted->samples * pixel_count(s) : HUGE_VAL;
    if (wanted->time_limit > 0.0 && s->sample_seconds > 0.0) {
        double left = fmax(wanted->time_limit - (seconds_now(s) - s->start), 0.0);
        all = fmin(all, had + left / s->sample_seconds);
    }
    s->round_seconds = fmin(round, fmax(all - had, 0.0)) * s->sample_seconds;
    s->later_seconds = fmax(all - had - round, 0.0) * s->sample_seconds;
    if (s->predictor && s->allocation.power > 0.0) {
        Forecast to_goal = predictor_run(s->predictor, &s->allocation, &s->estimate, &s->round,
                                         wanted->target_error / (AUDIT_CHANCE * s->audit_scale));
        double between = clock_seconds() - s->round_end;
        s->round_pixels = to_goal.round_pixels;
        if (to_goal.samples > 0.0 && to_goal.samples <= all) {
            all = to_goal.samples;
            s->round_seconds = cost_of(&s->cost, round, to_goal.round_pixels);
            s->later_seconds = cost_of(&s->cost, all - had - round, to_goal.pixels - to_goal.round_pixels) +
                               to_goal.rounds * between;
        }
    }
    s->all_samples = isfinite(all) ? all : 0.0;
}

// Whether an audit finds the goal reached. What one says is as wide as its heaviest replicas make it, so when the next
// is made goes by its lower end: that rounds fall by as much as one failed would take several times the samples where
// a heavy replica made it fail.
static bool is_on_target(Sampling *s)
{
    double by_rounds = s->error->rmse, target = s->wanted->target_error, samples = (double)s->estimate.samples;
    if (!(target > 0.0) || s->allocation.power <= 0.0 || by_rounds * s->audit_least > target ||
        samples < s->audit_next) {
        return false;
    }
    uint64_t before = s->audited.camera_rays;
    if (!run_audit(s)) {
        return false;
    }
    s->audit_next = samples + AUDIT_COST * (double)(s->audited.camera_rays - before);
    if (by_rounds > 0.0) {
        s->audit_scale = sqrt(s->audit_scale * s->error->high / by_rounds);
        s->audit_least = AUDIT_WIDTH * s->error->low / by_rounds;
    }
    return s->error->high <= target;
}

// Whether one of the goals is reached.
static bool is_enough(Sampling *s)
{
    const SamplingOptions *wanted = s->wanted;
    SamplingError *error = s->error;
    if (is_on_target(s)) {
        error->end = SAMPLING_TARGET;
        return true;
    }
    if (wanted->samples > 0.0 && error->samples >= wanted->samples) {
        error->end = SAMPLING_DONE;
        return true;
    }
    return false;
}

// ---- the last round

// Samples that are left of those that are wanted.
static double samples_left(const Sampling *s)
{
    double all = floor(s->wanted->samples * pixel_count(s) + 0.5);
    return s->wanted->samples > 0.0 ? all - (double)s->estimate.samples : HUGE_VAL;
}

// What the audit at the end of the run will take, when some pixels have been doubled.
static double audit_seconds(Sampling *s)
{
    const double doubled = 1.25;
    double samples = 0.0;
    if (s->wanted->has_no_estimate || !s->error->is_known || !has_audit(s->wanted)) {
        return 0.0;
    }
    int count = audit_draw(&s->audit, &s->estimate, &s->round);
    for (int i = 0; i < count; i++) {
        size_t pixel = s->audit.picks[i].pixel;
        uint32_t had = s->film->records[pixel].count;
        double replicas = round_is_like_replica(&s->round, pixel) ? 1.0 : 2.0;
        samples += replicas * (had > 1 ? doubled * had : AUDIT_SAMPLES);
    }
    return samples * s->sample_seconds;
}

// Seconds that rounds may still take; HUGE_VAL without a limit.
static double seconds_left(Sampling *s)
{
    double limit = s->wanted->time_limit, gone = seconds_now(s) - s->start;
    if (!(limit > 0.0) || s->error->samples == 0.0) {
        return HUGE_VAL;
    }
    // The audit is small: far from the end it decides nothing.
    bool is_near = gone + s->round_samples * s->sample_seconds > 0.5 * limit;
    return limit - gone - (is_near ? audit_seconds(s) : 0.0);
}

typedef enum Last {
    LAST_NOT,  // there will be another round
    LAST_DONE, // as many samples as are wanted
    LAST_TIME,
    LAST_INTERRUPTED,
} Last;

// A round that may be the last, slice by slice: the pixels that come first in it, until the samples or the time that are
// left have been used. What slices there are changes nothing: the samples alone say which pixels have had theirs.
static Last run_slices(Sampling *s, double samples, double until)
{
    const double part = 0.5, least = 0.004; // of the time that is left, to a slice; of the limit, not worth another
    uint32_t end = CHOICE_END, least_key = (uint32_t)s->allocation.least_bucket << CUT_BITS;
    double limit = s->wanted->time_limit, had = 0.0, seconds = 0.0;
    bool is_whole = true;
    s->round.is_cut = true;
    while (is_whole && had < samples && end > least_key) {
        double left = until - seconds_now(s), want = samples - had, spent;
        if (until < HUGE_VAL) {
            want = fmin(want, fmax(left, 0.0) * (left > 5.0 * least * limit ? part : 1.0) / s->sample_seconds);
        }
        if (left < least * limit || want < 1.0) {
            break;
        }
        s->round.end_key = end;
        s->round.least_key = end = allocation_cut(&s->allocation, &s->round, end, want, &spent);
        s->sliced_samples = had;
        s->round_samples = spent;
        is_whole = spent == 0.0 || trace_round(s);
        seconds += spent * s->sample_seconds;
        had += spent;
    }
    s->sliced_samples = 0.0;
    s->round_samples = had;
    s->round.end_key = CHOICE_END;
    s->round.least_key = end;
    if (had > 0.0) {
        estimate_update(&s->estimate, s->film, &s->round, is_whole, s->error);
        find_bias(s);
        s->sample_seconds = seconds / had;
    }
    s->round.is_cut = false;
    return !is_whole ? LAST_INTERRUPTED : had >= samples ? LAST_DONE : end > least_key ? LAST_TIME : LAST_NOT;
}

// The round that was chosen; in slices where it may be the last.
static Last run_chosen(Sampling *s)
{
    double samples = samples_left(s), seconds = seconds_left(s);
    // Before that, errors of pixels left out are known too little: in test_sampling's even light, by 2 samples a pixel,
    // intervals held in 5 of 10 runs.
    bool may_cut = (double)s->estimate.samples >= START_SAMPLES * pixel_count(s);
    if (!may_cut && samples > 0.0 && seconds > 0.0) {
        return run_round(s) ? LAST_NOT : LAST_INTERRUPTED;
    }
    if (s->round_samples <= samples && s->round_samples * s->sample_seconds <= seconds) {
        return run_round(s) ? LAST_NOT : LAST_INTERRUPTED;
    }
    double all = fmin(samples, s->round_samples);
    Last last = run_slices(s, all, seconds_now(s) + seconds);
    return last == LAST_DONE && all < samples ? LAST_NOT : last;
}

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
        predict(s);
        if (count > 0 && is_enough(s)) {
            return false;
        }
        if (count > 0 && s->round_samples * s->sample_seconds > seconds_left(s)) {
            s->error->end = SAMPLING_TIME;
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
    round->corners = s->corners;
    round->count = 1;
    round->has_corners = round->is_corners = round->is_pilot = true;
    s->round_samples = s->estimate.corners = (s->film->width + 1.0) * (s->film->height + 1.0);
    predict(s);
    if (!trace_round(s)) {
        return false;
    }
    s->cost.sample = s->sample_seconds;
    uint32_t probes = pilot_sort(round, s->allocation.of_pixel, s->allocation.memory);
    round->is_corners = false;
    round->count = 0;
    round->buckets = s->allocation.of_pixel;
    round->least_bucket = PILOT_PROBE;
    s->round_samples = START_SAMPLES * (double)probes;
    if (!trace_round(s)) {
        return false;
    }
    round->is_pilot = false;
    s->cost.pixel = START_SAMPLES * fmax(s->sample_seconds - s->cost.sample, 0.0);
    pilot_judge(&s->estimate, s->film, s->allocation.of_pixel);
    if (s->predictor) {
        predictor_keep_sorts(s->predictor, s->allocation.of_pixel, (size_t)pixel_count(s));
    }
    estimate_now(&s->estimate, s->film, round, s->error);
    find_bias(s);
    atomic_store(&s->prepared->abandon->keeps, true);
    return run_looks(s);
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
        predict(s);
        if (is_enough(s)) {
            return;
        }
        Last last = s->round_samples > 0.0 ? run_chosen(s) : LAST_DONE;
        if (last != LAST_NOT) {
            static const SamplingEnd ends[] = {[LAST_DONE] = SAMPLING_DONE,
                                               [LAST_TIME] = SAMPLING_TIME,
                                               [LAST_INTERRUPTED] = SAMPLING_INTERRUPTED};
            s->error->end = ends[last];
            return;
        }
        cost_add(&s->cost, s->round_samples, s->round_pixels, s->round_samples * s->sample_seconds);
    }
}

// A goal is reached or not by what all pixels say.
static bool judges_some(const SamplingOptions *wanted, const Film *film)
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
    bool has_pilot = wanted->is_adaptive && wanted->filter == FILTER_BOX;
    bool predicts = wanted->is_adaptive && wanted->target_error > 0.0 && has_progress;
    Sampling *s = calloc(1, sizeof *s);
    film->records = calloc(width * height, sizeof *film->records);
    if (s && wanted->is_adaptive) {
        s->allocation.of_pixel = calloc(width * height, sizeof *s->allocation.of_pixel);
        s->allocation.of_block =
            calloc(round_blocks(film->width) * round_blocks(film->height), sizeof *s->allocation.of_block);
        s->allocation.memory = calloc(width, ALLOCATION_ROWS * sizeof *s->allocation.memory);
    }
    if (s && has_pilot) {
        s->corners = calloc((width + 1) * (height + 1), 3 * sizeof *s->corners);
    }
    if (s && predicts) {
        s->predictor = predictor_new(width * height);
    }
    bool is_whole =
        s && film->records && (!has_pilot || s->corners) && (!predicts || s->predictor) &&
        (!wanted->is_adaptive || (s->allocation.of_pixel && s->allocation.of_block && s->allocation.memory));
    if (!is_whole) {
        sampling_free(s);
        return NULL;
    }
    return s;
}

typedef struct Range {
    float low[3], high[3];
    uint32_t samples; // the fewest of a pixel
} Range;

static void range_add(Range *range, const Film *film, Tile part, int step)
{
    for (int y = part.top; y < part.bottom; y += step) {
        for (int x = part.left; x < part.right; x++) {
            size_t pixel = (size_t)y * (size_t)film->width + (size_t)x;
            const float *value = &film->rgb[3 * pixel];
            uint32_t count = film->records[pixel].count;
            range->samples = count < range->samples ? count : range->samples;
            for (int c = 0; c < 3; c++) {
                range->low[c] = value[c] < range->low[c] ? value[c] : range->low[c];
                range->high[c] = value[c] > range->high[c] ? value[c] : range->high[c];
            }
        }
    }
}

// N samples miss what takes 3 / N of a pixel in no more than 5 % of cases: (1 - 3 / N)^N < exp(-3).
static void find_missed(Sampling *s)
{
    const Film *film = s->film;
    Range range = {{HUGE_VALF, HUGE_VALF, HUGE_VALF}, {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF}, UINT32_MAX};
    for (int top = 0, bottom; top < film->height; top = bottom) {
        bottom = round_block_end(top, film->top, film->height);
        for (int left = 0, right; left < film->width; left = right) {
            right = round_block_end(left, film->left, film->width);
            if (round_judges(&s->round, left, top)) {
                // Where some pixels stand for all, one row of a block does for it.
                range_add(&range, film, (Tile){left, top, right, bottom}, s->round.judges_some ? JUDGED_BLOCK : 1);
            }
        }
    }
    double contrast = 0.0;
    for (int c = 0; c < 3; c++) {
        contrast = fmax(contrast, (double)(range.high[c] - range.low[c]));
    }
    s->error->missed_area = fmin(3.0 / range.samples, 1.0);
    s->error->missed_error = s->error->missed_area * contrast / sqrt(pixel_count(s));
}

RenderResult sampling_run(const Prepared *prepared, const RenderOptions *options, Film *film,
                          RenderStatistics *statistics, SamplingError *error)
{
    const SamplingOptions *wanted = options->sampling;
    size_t pixels = (size_t)film->width * (size_t)film->height;
    uint32_t alike = wanted->is_adaptive ? ALIKE_SAMPLES : (uint32_t)wanted->samples;
    Sampling *s = sampling_new(wanted, options->progress != NULL, film);
    bool has_memory = s != NULL;
    // A pixel that ends where it has enough says by its replicas what it may have missed.
    if (has_memory && !wanted->has_no_estimate && !stop_has_choice(wanted)) {
        s->round.small = small_new(prepared, options, film, &has_memory);
    }
    // Of fewer samples strata are hardly ever weighted; of a run to a goal, which may be made again by its number of
    // samples, all pixels are.
    bool has_shares = wanted->is_adaptive || wanted->samples >= SHARE_SAMPLES;
    if (has_memory && has_shares && wanted->filter == FILTER_BOX && !stop_has_choice(wanted)) {
        s->round.share = share_new(prepared, film, &has_memory);
    }
    if (!has_memory) {
        sampling_free(s);
        return RENDER_NO_MEMORY;
    }
    s->prepared = prepared;
    s->options = options;
    s->wanted = wanted;
    s->film = film;
    s->statistics = statistics;
    s->error = error;
    s->start = s->round_end = seconds_now(s);
    s->audit_scale = AUDIT_FACTOR;
    s->audit_least = AUDIT_WIDTH;
    s->round.prepared = prepared;
    s->round.sampling = wanted;
    s->round.film = film;
    s->round.draws_more = draws_more(prepared);
    s->round.judges_some = judges_some(wanted, film);
    estimate_begin(&s->estimate, &s->round);
    filter_init(&s->round.filter, wanted->filter);
    if (s->corners && !run_pilot(s)) {
        error->end = SAMPLING_INTERRUPTED;
    } else if ((s->corners || run_alike(s, alike)) && wanted->is_adaptive) {
        if (s->corners || run_looks(s)) {
            run_adaptive(s);
        } else {
            error->end = SAMPLING_INTERRUPTED;
        }
    }
    bool is_part = options->share && options->share->is_part; // which knows of no others
    if (error->end != SAMPLING_INTERRUPTED && error->end != SAMPLING_TARGET && !wanted->has_no_estimate && !is_part) {
        if (run_audit(s) && s->looks.count > 0) {
            look_show(&s->looks, s->round.small, film, error);
        }
        find_missed(s);
    }
    statistics_add(statistics, &s->audited);
    bool is_whole = error->end != SAMPLING_INTERRUPTED;
    for (size_t i = 0; !is_whole && i < pixels; i++) {
        if (film->records[i].count == 0) {
            error->samples = 0.0; // no picture
        }
    }
    RenderResult result = s->result;
    sampling_free(s);
    return result;
}
