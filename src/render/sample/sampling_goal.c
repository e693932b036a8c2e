// What is left of a run's goal: a number of samples, an error or a time; and the rounds that may come to it.
//
// SPDX-License-Identifier: MIT
#include "render/sample/sampling_run.h"

#include <math.h>

#include "base/clock.h"

static const double AUDIT_COST = 1.0;    // samples between audits, for each that an audit took
static const double AUDIT_CHANCE = 1.05; // how much less the error must be, since audits fail by chance; measured
static const double COST_FADE = 0.8; // of what is known from earlier rounds

static double cost_by_corner_pass(const Cost *cost, double samples, double pixels)
{
    return cost->sample * samples + cost->pixel * pixels;
}

static double cost_of(const Cost *cost, double samples, double pixels)
{
    double seconds = cost_by_corner_pass(cost, samples, pixels);
    return cost->by_corner_pass > 0.0 ? seconds * cost->seconds / cost->by_corner_pass : seconds;
}

void goal_count_round(Sampling *s)
{
    Cost *cost = &s->cost;
    cost->seconds = COST_FADE * cost->seconds + s->round_samples * s->sample_seconds;
    cost->by_corner_pass =
        COST_FADE * cost->by_corner_pass + cost_by_corner_pass(cost, s->round_samples, s->round_pixels);
}

void goal_predict(Sampling *s)
{
    const SamplingOptions *wanted = s->wanted;
    double had = (double)s->estimate.samples, round = s->round_samples;
    double all = wanted->samples > 0.0 ? wanted->samples * pixel_count(s) : HUGE_VAL;
    if (wanted->time_limit > 0.0 && s->sample_seconds > 0.0) {
        double left = fmax(wanted->time_limit - (sampling_seconds(s) - s->start), 0.0);
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
    if (!sampling_audit(s)) {
        return false;
    }
    s->audit_next = samples + AUDIT_COST * (double)(s->audited.camera_rays - before);
    if (by_rounds > 0.0) {
        s->audit_scale = sqrt(s->audit_scale * s->error->high / by_rounds);
        s->audit_least = AUDIT_WIDTH * s->error->low / by_rounds;
    }
    return s->error->high <= target;
}

bool goal_is_reached(Sampling *s)
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
    if (s->wanted->has_no_estimate || !s->error->is_known || !sampling_has_audit(s->wanted)) {
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

double goal_seconds(Sampling *s)
{
    double limit = s->wanted->time_limit, gone = sampling_seconds(s) - s->start;
    if (!(limit > 0.0) || s->error->samples == 0.0) {
        return HUGE_VAL;
    }
    // The audit is small: far from the end it decides nothing.
    bool is_near = gone + s->round_samples * s->sample_seconds > 0.5 * limit;
    return limit - gone - (is_near ? audit_seconds(s) : 0.0);
}

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
        double left = until - sampling_seconds(s), want = samples - had, spent;
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
        is_whole = spent == 0.0 || sampling_trace(s);
        seconds += spent * s->sample_seconds;
        had += spent;
    }
    s->sliced_samples = 0.0;
    s->round_samples = had;
    s->round.end_key = CHOICE_END;
    s->round.least_key = end;
    if (had > 0.0) {
        estimate_update(&s->estimate, s->film, &s->round, is_whole, s->error);
        sampling_find_bias(s);
        s->sample_seconds = seconds / had;
    }
    s->round.is_cut = false;
    return !is_whole ? LAST_INTERRUPTED : had >= samples ? LAST_DONE : end > least_key ? LAST_TIME : LAST_NOT;
}

Last goal_run_chosen(Sampling *s)
{
    double samples = samples_left(s), seconds = goal_seconds(s);
    // Before that, errors of pixels left out are known too little: in test_sampling's even light, by 2 samples a pixel,
    // intervals held in 5 of 10 runs.
    bool may_cut = (double)s->estimate.samples >= START_SAMPLES * pixel_count(s);
    if (!may_cut && samples > 0.0 && seconds > 0.0) {
        return sampling_round(s) ? LAST_NOT : LAST_INTERRUPTED;
    }
    if (s->round_samples <= samples && s->round_samples * s->sample_seconds <= seconds) {
        return sampling_round(s) ? LAST_NOT : LAST_INTERRUPTED;
    }
    double all = fmin(samples, s->round_samples);
    Last last = run_slices(s, all, sampling_seconds(s) + seconds);
    return last == LAST_DONE && all < samples ? LAST_NOT : last;
}
