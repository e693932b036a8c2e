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

#include "check/study_render.h"

#define COUNT_OF(array) (sizeof(array) / sizeof((array)[0]))

enum {
    RUNS_MOST = 9,
    REFERENCE_TIMES = 16, // the greatest number of samples of a ladder
    DEEPER = 64,
    REFERENCE_SECONDS = 3, // of a rung of the reference kernels
    PHOTONS_LEAST = 400,   // for each sample of the greatest number
    PHOTONS_TIMES = 100,
};

static void point_add(StudyPoint *point, const StudyMetric *metric, int runs)
{
    point->rmse += metric->rmse * metric->rmse / runs;
    point->relmse += metric->relmse / runs;
    point->greatest = fmax(point->greatest, metric->greatest);
    point->p999 += metric->p999 / runs;
    point->flip += metric->flip / runs;
}

// A rung: the same with several seeds. False when one failed.
static bool rtlang_point(const Study *study, const StudySettings *settings, const Image *reference,
                         const rt_sampling *sampling, rt_precision precision, StudyPoint *point)
{
    double seconds[RUNS_MOST];
    int runs = settings->repeats < RUNS_MOST ? settings->repeats : RUNS_MOST;

    *point = (StudyPoint){0};
    for (int i = 0; i < runs; i++) {
        rt_sampling one = *sampling;
        StudyMetric metric;
        RtlangRun run = {.method = RT_METHOD_BACKWARD};

        one.seed = 100 + (uint64_t)i;
        rtlang_render(study->scene, settings, &one, precision, 1, &run);
        bool fine = run.status == RT_OK && study_compare(&run.image, reference, &metric);
        image_fini(&run.image);
        if (!fine) {
            return false;
        }
        seconds[i] = run.seconds;
        point_add(point, &metric, runs);
        point->samples += fmax(run.error.samples, 1.0) / runs;
        point->estimate += run.error.known != 0 ? run.error.rmse / runs : 0.0;
    }
    point->rmse = sqrt(point->rmse);
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

static bool rtlang_methods(Study *study, const StudySettings *settings, const Image *reference)
{
    static const struct {
        const char *name;
        rt_sampling sampling;
        int least; // samples
    } methods[] = {{"rtlang sobol", {.sampler = "sobol"}, 1},   {"rtlang adaptive", {.adaptive = 1}, 2},
                   {"rtlang halton", {.sampler = "halton"}, 4}, {"rtlang jittered", {.sampler = "jittered"}, 4},
                   {"rtlang grid", {.sampler = "grid"}, 4},     {"rtlang random", {.sampler = "random"}, 4}};

    for (size_t i = 0; i < COUNT_OF(methods); i++) {
        StudyMethod *method = method_begin(study, methods[i].name, STUDY_SAMPLER);
        for (int samples = methods[i].least; samples <= settings->most_samples && method->count < STUDY_POINTS;
             samples *= methods[i].sampling.adaptive != 0 ? 2 : 4) {
            rt_sampling sampling = methods[i].sampling;
            sampling.samples = samples;
            if (*settings->interrupted != 0 || !rtlang_point(study, settings, reference, &sampling, RT_PRECISION_DOUBLE,
                                                             &method->points[method->count])) {
                return false;
            }
            method->count++;
        }
        study_fit(method, study->floor);
    }
    return true;
}

// ---- the reference kernels

// The program's own sampler in each precision, where the scene is known to be drawn in it. A rung that would take long
// is left out: what quadruple precision has to show, the lower ones show.
static bool reference_methods(Study *study, const StudySettings *settings, const Image *reference)
{
    static const struct {
        const char *name;
        rt_precision precision;
    } methods[] = {{"reference float", RT_PRECISION_FLOAT},
                   {"reference double", RT_PRECISION_REFERENCE},
                   {"reference quad", RT_PRECISION_QUAD}};
    StudySettings once = *settings;

    once.repeats = 1;
    for (size_t i = 0; i < COUNT_OF(methods) && !isnan(study->arithmetic); i++) {
        StudyMethod *method = method_begin(study, methods[i].name, STUDY_REFERENCE);
        double seconds = 0.0;
        for (int samples = 4; samples <= settings->most_samples && 4.0 * seconds < REFERENCE_SECONDS; samples *= 4) {
            rt_sampling sampling = {.samples = samples};
            StudyPoint *point = &method->points[method->count];
            if (*settings->interrupted != 0 ||
                !rtlang_point(study, &once, reference, &sampling, methods[i].precision, point)) {
                return false;
            }
            seconds = point->seconds;
            method->count++;
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
    point_add(point, &metric, 1);
    point->rmse = sqrt(point->rmse);
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

    uint64_t least = PHOTONS_LEAST * (uint64_t)settings->most_samples;
    for (uint64_t photons = least; photons <= PHOTONS_TIMES * least; photons *= 10) {
        RtlangRun run = {.method = method, .photons = photons};
        bool misfits = false;
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

static void model_find(Study *study, const StudySettings *settings)
{
    static const rt_sampling one = {0};
    RtlangRun ours = {.method = RT_METHOD_BACKWARD}, exact = ours, single = ours, theirs = {.status = RT_OK};
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
    plain_text(study->arithmetic_why, exact.fault[0] != '\0' ? exact.fault : "built without the reference kernels");
    image_fini(&ours.image);
    image_fini(&theirs.image);
    image_fini(&exact.image);
    image_fini(&single.image);
}

// What a greater depth changes, where some rays were cut.
static void depth_find(Study *study, const StudySettings *settings, const rt_sampling *sampling, const RtlangRun *reference)
{
    rt_sampling deeper = *sampling;
    StudyMetric metric;
    RtlangRun run = {.method = RT_METHOD_BACKWARD};

    study->cut_bias = reference->error.bias;
    study->depth_bias = 0.0;
    if (!(study->cut_bias > 0.0)) {
        return;
    }
    deeper.max_trace_level = DEEPER;
    rtlang_render(study->scene, settings, &deeper, RT_PRECISION_DOUBLE, 0, &run);
    if (run.status == RT_OK && study_compare(&run.image, &reference->image, &metric)) {
        study->depth_bias = metric.rmse;
    }
    image_fini(&run.image);
}

// The ladders of all of rtlang's methods against one reference. False when something failed.
static bool methods_run(Study *study, const StudySettings *settings)
{
    int samples = settings->reference_samples > 0 ? settings->reference_samples
                                                  : REFERENCE_TIMES * settings->most_samples;
    // Not the sampler that is studied.
    rt_sampling sampling = {.sampler = "halton", .samples = samples, .seed = 1};
    RtlangRun reference = {.method = RT_METHOD_BACKWARD};

    study->has_methods = true;
    rtlang_render(study->scene, settings, &sampling, RT_PRECISION_DOUBLE, 0, &reference);
    if (reference.status != RT_OK) {
        snprintf(study->fault, sizeof study->fault, "%s", reference.fault);
        return false;
    }
    study->reference_samples = reference.error.samples;
    study->floor = reference.error.rmse;
    model_find(study, settings);
    depth_find(study, settings, &sampling, &reference);
    bool fine = rtlang_methods(study, settings, &reference.image) &&
                reference_methods(study, settings, &reference.image) &&
                forward_methods(study, settings, &reference.image);
    image_fini(&reference.image);
    return fine;
}

bool study_run(Study *study, const char *scene, const StudySettings *settings)
{
    *study = (Study){.scene = scene, .width = settings->width, .height = settings->height};
    bool fine = settings->only_race || methods_run(study, settings);

    if (fine && settings->povray) {
        study->has_race = fine = race_run(&study->race, scene, settings);
        if (!fine) {
            snprintf(study->fault, sizeof study->fault, "%s", study->race.fault);
        }
    }
    if (!fine && study->fault[0] == '\0') {
        snprintf(study->fault, sizeof study->fault, *settings->interrupted != 0 ? "interrupted" : "a run failed");
    }
    return fine;
}
