// The runs of a study, and what is computed of them.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "check/study.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "check/study_render.h"

enum {
    RUNS_MOST = 9,
    REFERENCE_TIMES = 16, // the greatest number of samples of a ladder
    REFERENCE_TIMES_LEAST = 4,
    LADDER_LEAST = 16,
    DEEPER = 64,
    REFERENCE_SECONDS = 3, // of a rung of the reference kernels
    PHOTONS_LEAST = 400,   // for each sample of the greatest number
    PHOTONS_TIMES = 100,
};

static void point_add(StudyPoint *point, const StudyMetric *metric)
{
    point->rmse += metric->rmse * metric->rmse;
    point->relmse += metric->relmse;
    point->greatest = fmax(point->greatest, metric->greatest);
    point->p999 += metric->p999;
    point->flip += metric->flip;
}

static void point_mean(StudyPoint *point, int runs)
{
    point->rmse = sqrt(point->rmse / runs);
    point->relmse /= runs;
    point->p999 /= runs;
    point->flip /= runs;
    point->samples /= runs;
    point->estimate /= runs;
}

typedef struct Rung {
    rt_sampling sampling;
    rt_precision precision;
} Rung;

// The same with several seeds, fewer of them when the budget's stage ends. *expected is how long each took by the
// clock. False when one failed.
static bool rtlang_point(const Study *study, const StudySettings *settings, const Image *reference, const Rung *rung,
                         StudyPoint *point, double *expected)
{
    const rt_sampling *sampling = &rung->sampling;
    double seconds[RUNS_MOST], begin = clock_seconds();
    int most = settings->repeats < RUNS_MOST ? settings->repeats : RUNS_MOST, runs = 0;

    *point = (StudyPoint){0};
    do {
        rt_sampling one = *sampling;
        StudyMetric metric;
        RtlangRun run = {.method = RT_METHOD_BACKWARD};

        one.seed = 100 + (uint64_t)runs;
        rtlang_render(study->scene, settings, &one, rung->precision, 1, &run);
        bool fine = run.status == RT_OK && study_compare(&run.image, reference, &metric);
        image_fini(&run.image);
        if (!fine) {
            return false;
        }
        seconds[runs++] = run.seconds;
        point_add(point, &metric);
        point->samples += fmax(run.error.samples, 1.0);
        point->estimate += run.error.known != 0 ? run.error.rmse : 0.0;
        *expected = (clock_seconds() - begin) / runs;
    } while (runs < most && *expected <= budget_left(settings->budget));
    point_mean(point, runs);
    point->seconds = study_median(seconds, runs);
    point->effort = sampling->samples;
    snprintf(point->setting, sizeof point->setting,
             sampling->adaptive != 0 ? "--adaptive --samples=%g" : "--samples=%g", sampling->samples);
    return true;
}

static StudyMethod *method_begin(Study *study, const char *name, StudyKind kind)
{
    StudyMethod *method = &study->methods[study->count++];

    *method = (StudyMethod){.kind = kind};
    snprintf(method->name, sizeof method->name, "%s", name);
    return method;
}

typedef struct Ladder {
    const char *name;
    rt_sampling sampling;
    int least, factor; // samples
    StudyMethod *method;
    double expected; // seconds of a run of the next rung
    int ends_before; // samples; 0: it is not over
} Ladder;

// One rung more, unless the budget's stage would end before it. False when it failed.
static bool ladder_climb(Study *study, const StudySettings *settings, const Image *reference, Ladder *ladder,
                         int samples)
{
    StudyMethod *method = ladder->method;
    Rung rung = {ladder->sampling, RT_PRECISION_DOUBLE};
    double one;

    if (ladder->expected > budget_left(settings->budget)) {
        ladder->ends_before = samples;
        return true;
    }
    rung.sampling.samples = samples;
    budget_say(settings->budget, study->scene, ladder->name, samples, study->ladder_top);
    if (*settings->interrupted != 0 ||
        !rtlang_point(study, settings, reference, &rung, &method->points[method->count], &one)) {
        return false;
    }
    method->count++;
    ladder->expected = ladder->factor * one;
    return true;
}

// One sentence for all ladders that end before the same rung.
static void ladders_note(const Study *study, const StudySettings *settings, const Ladder *ladders, size_t count)
{
    for (int samples = 1; samples <= study->ladder_top; samples *= 2) {
        char names[BUDGET_TEXT] = "";
        size_t length = 0;

        for (size_t i = 0; i < count; i++) {
            if (ladders[i].ends_before == samples && length < sizeof names) {
                length += (size_t)snprintf(names + length, sizeof names - length, "%s%s", length > 0 ? ", " : "",
                                           ladders[i].name);
            }
        }
        if (length > 0) {
            budget_leave_out(settings->budget, "runs of %d samples a pixel and more: %s", samples, names);
        }
    }
}

// Rung by rung over all ladders: what the budget leaves out is the dearest.
static bool rtlang_methods(Study *study, const StudySettings *settings, const Image *reference)
{
    Ladder ladders[] = {{.name = "rtlang sobol", .sampling = {.sampler = "sobol"}, .least = 1, .factor = 4},
                        {.name = "rtlang adaptive", .sampling = {.adaptive = 1}, .least = 2, .factor = 2},
                        {.name = "rtlang halton", .sampling = {.sampler = "halton"}, .least = 4, .factor = 4},
                        {.name = "rtlang jittered", .sampling = {.sampler = "jittered"}, .least = 4, .factor = 4},
                        {.name = "rtlang grid", .sampling = {.sampler = "grid"}, .least = 4, .factor = 4},
                        {.name = "rtlang random", .sampling = {.sampler = "random"}, .least = 4, .factor = 4}};
    int next[RT_COUNT_OF(ladders)]; // samples

    for (size_t i = 0; i < RT_COUNT_OF(ladders); i++) {
        ladders[i].method = method_begin(study, ladders[i].name, STUDY_SAMPLER);
        next[i] = ladders[i].least;
    }
    for (int samples = 1; samples <= study->ladder_top; samples *= 2) {
        for (size_t i = 0; i < RT_COUNT_OF(ladders); i++) {
            if (next[i] != samples || ladders[i].ends_before > 0) {
                continue;
            }
            if (i > 1 && ladders[i].method->count == 0) {
                ladders[i].expected = ladders[0].expected / ladders[0].factor; // of the first, for as many samples
            }
            if (!ladder_climb(study, settings, reference, &ladders[i], samples)) {
                return false;
            }
            next[i] *= ladders[i].factor;
        }
    }
    ladders_note(study, settings, ladders, RT_COUNT_OF(ladders));
    for (size_t i = 0; i < RT_COUNT_OF(ladders); i++) {
        study_fit(ladders[i].method, study->floor);
    }
    return true;
}

// ---- the reference kernels

// The program's own sampler in each precision, where the scene is known to be drawn in it. A rung that would take long
// is left out: what quadruple precision has to show, the lower ones show.
static bool reference_methods(Study *study, const StudySettings *settings, const Image *reference, double quad_seconds)
{
    static const struct {
        const char *name;
        rt_precision precision;
    } methods[] = {{"reference float", RT_PRECISION_FLOAT},
                   {"reference double", RT_PRECISION_REFERENCE},
                   {"reference quad", RT_PRECISION_QUAD}};
    StudySettings once = *settings;

    once.repeats = 1;
    for (size_t i = 0; i < RT_COUNT_OF(methods) && !isnan(study->arithmetic); i++) {
        StudyMethod *method = method_begin(study, methods[i].name, STUDY_REFERENCE);
        double seconds = 0.0, one = 0.0;
        if (methods[i].precision == RT_PRECISION_QUAD && 4.0 * quad_seconds > budget_left(settings->budget)) {
            budget_leave_out(settings->budget, "all runs: %s", methods[i].name);
            break;
        }
        budget_say(settings->budget, study->scene, methods[i].name, (int)i + 1, (int)RT_COUNT_OF(methods));
        for (int samples = 4; samples <= study->ladder_top && 4.0 * seconds < REFERENCE_SECONDS; samples *= 4) {
            const Rung rung = {{.samples = samples}, methods[i].precision};
            StudyPoint *point = &method->points[method->count];
            if (*settings->interrupted != 0 || !rtlang_point(study, &once, reference, &rung, point, &one)) {
                return false;
            }
            seconds = point->seconds;
            method->count++;
            if (4.0 * one > budget_left(settings->budget)) {
                budget_leave_out(settings->budget, "runs of %d samples a pixel and more: %s", 4 * samples,
                                 methods[i].name);
                break;
            }
        }
        study_fit(method, study->floor);
    }
    return true;
}

// ---- forward

static void plain_text(char *text, const char *from)
{
    snprintf(text, STUDY_TEXT, "%s", from);
    for (char *c = text; *c != '\0'; c++) {
        *c = strchr("<>&\"", *c) != NULL ? '\'' : *c; // it goes into HTML, too
    }
}

// One rung. False when it failed; *misfits when the scene has what the method does not know.
static bool forward_point(Study *study, const StudySettings *settings, const Image *reference, StudyMethod *ladder,
                          RtlangRun *run, bool *misfits)
{
    static const rt_sampling seed = {.seed = 100};
    StudyPoint *point = &ladder->points[ladder->count];
    StudyMetric metric;

    rtlang_render(study->scene, settings, &seed, RT_PRECISION_DOUBLE, 1, run);
    bool fine = run->status == RT_OK && study_compare(&run->image, reference, &metric);
    image_fini(&run->image);
    *misfits = run->status == RT_FAULT_SCENE;
    if (!fine) {
        plain_text(study->forward_why, run->fault);
        return *misfits;
    }
    *point = (StudyPoint){.seconds = run->seconds,
                          .estimate = run->error.rmse,
                          .effort = (double)run->photons,
                          .samples = (double)run->photons / ((double)study->width * study->height)};
    point_add(point, &metric);
    point_mean(point, 1);
    snprintf(point->setting, sizeof point->setting, "--photons=%llu", (unsigned long long)run->photons);
    ladder->photons_an_arrival = (double)run->counts.emitted / (double)run->counts.arrived;
    ladder->count++;
    return true;
}

// A ladder of photons, or none.
static bool forward_ladder(Study *study, const StudySettings *settings, const Image *reference, rt_method method,
                           const char *name)
{
    StudyMethod *ladder = method_begin(study, name, STUDY_FORWARD);

    uint64_t least = PHOTONS_LEAST * (uint64_t)study->ladder_top;
    for (uint64_t photons = least; photons <= PHOTONS_TIMES * least; photons *= 10) {
        RtlangRun run = {.method = method, .photons = photons};
        bool misfits = false;
        double seconds = ladder->count > 0 ? ladder->points[ladder->count - 1].seconds : 0.0;
        if (10.0 * seconds > budget_left(settings->budget)) {
            budget_leave_out(settings->budget, "runs of %g photons and more: %s", (double)photons, name);
            break;
        }
        budget_say(settings->budget, study->scene, name, ladder->count + 1, 3);
        if (*settings->interrupted != 0 || !forward_point(study, settings, reference, ladder, &run, &misfits)) {
            return false;
        }
        if (misfits) {
            study->count--;
            return true;
        }
    }
    study_fit(ladder, study->floor);
    return true;
}

static bool forward_methods(Study *study, const StudySettings *settings, const Image *reference)
{
    return forward_ladder(study, settings, reference, RT_METHOD_FORWARD_CONNECT, "rtlang forward-connect") &&
           forward_ladder(study, settings, reference, RT_METHOD_FORWARD, "rtlang forward");
}

// ---- what is not sampling

// The distance of a picture of one ray a pixel from another; NAN where one of them is missing.
static double distance_of(const RtlangRun *picture, const RtlangRun *reference)
{
    StudyMetric metric;
    bool fine = picture->status == RT_OK && reference->status == RT_OK &&
                study_compare(&picture->image, &reference->image, &metric);

    return fine ? metric.rmse : (double)NAN;
}

// *quad_seconds: what a ray a pixel takes in quadruple precision, by the clock.
static void model_find(Study *study, const StudySettings *settings, double *quad_seconds)
{
    static const rt_sampling one = {0};
    RtlangRun ours = {.method = RT_METHOD_BACKWARD}, exact = {.method = RT_METHOD_BACKWARD, .is_optional = true},
              single = ours, theirs = {.status = RT_OK};
    PovrayRun povray = {.name = "model", .threads = 1};

    study->model = (double)NAN;
    rtlang_render(study->scene, settings, &one, RT_PRECISION_DOUBLE, 1, &ours);
    if (settings->povray && povray_render(study->scene, settings, &povray)) {
        theirs.image = povray.image;
        study->model = distance_of(&theirs, &ours);
    }
    rtlang_render(study->scene, settings, &one, RT_PRECISION_QUAD, 0, &exact);
    rtlang_render(study->scene, settings, &one, RT_PRECISION_FLOAT, 0, &single);
    study->arithmetic = distance_of(&ours, &exact);
    study->arithmetic_float = distance_of(&single, &exact);
    *quad_seconds = exact.wall;
    if (exact.status == RT_CANCELLED && *settings->interrupted == 0) {
        budget_leave_out(settings->budget, "arithmetic in quadruple precision");
    }
    plain_text(study->arithmetic_why, exact.status == RT_CANCELLED ? "the budget left it out"
                                      : exact.fault[0] != '\0'     ? exact.fault
                                                                   : "built without the reference kernels");
    image_fini(&ours.image);
    image_fini(&theirs.image);
    image_fini(&exact.image);
    image_fini(&single.image);
}

// What a greater depth changes, where some rays were cut.
static void depth_find(Study *study, const StudySettings *settings, const rt_sampling *sampling,
                       const RtlangRun *reference)
{
    rt_sampling deeper = *sampling;
    StudyMetric metric;
    RtlangRun run = {.method = RT_METHOD_BACKWARD};

    study->cut_bias = reference->error.bias;
    study->depth_bias = 0.0;
    if (!(study->cut_bias > 0.0)) {
        return;
    }
    if (2.0 * reference->wall > budget_left(settings->budget)) {
        budget_leave_out(settings->budget, "what more levels would change");
        return;
    }
    deeper.max_trace_level = DEEPER;
    rtlang_render(study->scene, settings, &deeper, RT_PRECISION_DOUBLE, 0, &run);
    if (run.status == RT_OK && study_compare(&run.image, &reference->image, &metric)) {
        study->depth_bias = metric.rmse;
    }
    image_fini(&run.image);
}

// The picture that all are compared with.
static bool reference_make(Study *study, const StudySettings *settings, rt_sampling *sampling, RtlangRun *reference)
{
    int asked = settings->reference_samples, most = REFERENCE_TIMES * settings->most_samples;

    budget_say(settings->budget, study->scene, "the reference", 1, 2);
    budget_stage(settings->budget, settings->povray ? 0.1 : 0.2);
    // Not the sampler that is studied.
    *sampling = (rt_sampling){
        .sampler = "halton",
        .samples = asked > 0 ? asked : study_reference_samples(study->scene, settings, most, "the reference"),
        .seed = 1};
    *reference = (RtlangRun){.method = RT_METHOD_BACKWARD};
    rtlang_render(study->scene, settings, sampling, RT_PRECISION_DOUBLE, 0, reference);
    if (reference->status != RT_OK) {
        snprintf(study->fault, sizeof study->fault, "%s", reference->fault);
        return false;
    }
    study->reference_samples = reference->error.samples;
    study->floor = reference->error.rmse;
    study->ladder_top = settings->most_samples;
    while (study->ladder_top > LADDER_LEAST && REFERENCE_TIMES_LEAST * study->ladder_top > sampling->samples) {
        study->ladder_top /= 4;
    }
    if (study->ladder_top < settings->most_samples) {
        budget_leave_out(settings->budget, "runs of more than %d samples a pixel, in place of %d", study->ladder_top,
                         settings->most_samples);
    }
    return true;
}

// The ladders of all of rtlang's methods against one reference. False when something failed.
static bool methods_run(Study *study, const StudySettings *settings)
{
    rt_sampling sampling;
    RtlangRun reference = {.method = RT_METHOD_BACKWARD};
    double left = settings->povray ? 0.4 : 1.0; // of the budget, for all that is not the race

    study->has_methods = true;
    if (!reference_make(study, settings, &sampling, &reference)) {
        return false;
    }
    budget_stage(settings->budget, 0.2 * left);
    double quad_seconds;
    model_find(study, settings, &quad_seconds);
    depth_find(study, settings, &sampling, &reference);
    budget_stage(settings->budget, 0.6 * left);
    bool fine = rtlang_methods(study, settings, &reference.image);
    budget_stage(settings->budget, 0.3 * left);
    fine = fine && reference_methods(study, settings, &reference.image, quad_seconds);
    budget_stage(settings->budget, 0.5 * left);
    fine = fine && forward_methods(study, settings, &reference.image);
    study->picture = reference.image;
    return fine;
}

// What was computed is the study's, also of one that failed.
static bool study_all(Study *study, const StudySettings *settings)
{
    bool fine = settings->only_race || methods_run(study, settings);

    if (fine && settings->povray) {
        budget_stage(settings->budget, 1.0);
        study->has_race = fine = race_run(&study->race, study->scene, settings);
        if (!fine) {
            snprintf(study->fault, sizeof study->fault, "%s", study->race.fault);
        }
    }
    return fine;
}

bool study_run(Study *study, const char *scene, const StudySettings *settings)
{
    StudySettings own = *settings;

    *study = (Study){.scene = scene, .width = settings->width, .height = settings->height};
    budget_begin(&study->budget, settings->seconds, settings->shows_progress);
    own.budget = &study->budget;
    bool fine = study_all(study, &own);
    budget_end(&study->budget);

    if (!fine && study->fault[0] == '\0') {
        snprintf(study->fault, sizeof study->fault, *settings->interrupted != 0 ? "interrupted" : "a run failed");
    }
    if (!study->picture.values) {
        study->picture = study->race.picture;
        study->race.picture = (Image){0};
    }
    study->seconds = clock_seconds() - study->budget.begin;
    return fine;
}

void study_fini(Study *study)
{
    image_fini(&study->picture);
    image_fini(&study->race.picture);
}
