// Runs of both programs for a study.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "check/study_render.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"

enum { REFERENCE_TRIAL = 4, REFERENCE_LEAST = 64 };

static void on_diagnostic(void *client, const rt_diagnostic *diagnostic)
{
    RtlangRun *run = client;

    if (diagnostic->severity == RT_ERROR && run->fault[0] == '\0') {
        snprintf(run->fault, sizeof run->fault, "%.*s", (int)strcspn(diagnostic->text, "\n"), diagnostic->text);
    }
}

static bool picture_take(const rt_session *session, Image *image)
{
    int width, height;
    const float *pixels = rt_pixels(session, &width, &height);

    if (!pixels || !image_init(image, width, height, 3)) {
        return false;
    }
    memcpy(image->values, pixels, (size_t)width * (size_t)height * 3 * sizeof *pixels);
    return true;
}

// An interrupt ends a run at once, and the end of the stage one that may be left out.
static void on_progress(void *client, double done)
{
    const RtlangRun *run = client;

    (void)done;
    budget_tick(run->settings->budget);
    bool is_late = run->is_optional && budget_left(run->settings->budget) < 0.0;
    if (is_late || *run->settings->interrupted != 0) {
        rt_cancel(run->session);
    }
}

static rt_status session_ready(rt_session *session, const char *scene, const StudySettings *settings,
                               const rt_sampling *sampling, rt_precision precision)
{
    rt_status status = rt_set_size(session, settings->width, settings->height);

    for (int i = 0; status == RT_OK && i < settings->include_path_count; i++) {
        status = rt_add_include_path(session, settings->include_paths[i]);
    }
    status = status != RT_OK || !settings->clock ? status : rt_set_clock(session, *settings->clock);
    status = status != RT_OK ? status : rt_set_sampling(session, sampling);
    status = status != RT_OK ? status : rt_set_precision(session, precision);
    return status != RT_OK ? status : rt_load_file(session, scene);
}

void rtlang_render(const char *scene, const StudySettings *settings, const rt_sampling *sampling,
                   rt_precision precision, int threads, RtlangRun *run)
{
    static const rt_output linear = {.depth = RT_DEPTH_16, .file_gamma = 1.0};

    *run = (RtlangRun){
        .status = RT_FAULT_LIMIT, .method = run->method, .photons = run->photons, .output = run->output,
        .is_optional = run->is_optional, .settings = settings};
    rt_callbacks callbacks = {.client = run, .diagnostic = on_diagnostic, .progress = on_progress};
    double begin = clock_seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    rt_session *session = rt_session_new(&callbacks);

    if (!session) {
        return;
    }
    run->session = session;
    run->status = session_ready(session, scene, settings, sampling, precision);
    run->status = run->status != RT_OK ? run->status : rt_set_method(session, run->method, run->photons);
    if (run->status == RT_OK) {
        double start = clock_seconds_of(CLOCK_PROCESS_CPUTIME_ID), wall_start = clock_seconds_of(CLOCK_MONOTONIC);
        run->status = rt_render(session, threads);
        run->wall = clock_seconds_of(CLOCK_MONOTONIC) - wall_start;
        run->seconds = clock_seconds_of(CLOCK_PROCESS_CPUTIME_ID) - start;
    }
    if (run->status == RT_OK && run->output) {
        run->status = rt_write(session, run->output, &linear);
    }
    run->whole = clock_seconds_of(CLOCK_PROCESS_CPUTIME_ID) - begin;
    rt_get_error(session, &run->error);
    rt_get_photons(session, &run->counts);
    if (run->status == RT_OK && !picture_take(session, &run->image)) {
        run->status = RT_FAULT_LIMIT;
    }
    rt_session_free(session);
}

bool povray_render(const char *scene, const StudySettings *settings, PovrayRun *run)
{
    char output[4096], log[4096], detail[512];
    uint64_t pixels = (uint64_t)settings->width * (uint64_t)settings->height;
    ImageError error = {.no_memory = false};

    snprintf(output, sizeof output, "%s/study-%s.png", settings->folder, run->name);
    snprintf(log, sizeof log, "%s/study-%s.log", settings->folder, run->name);
    PovrayJob job = {.program = settings->povray,
                     .scene = scene,
                     .output = output,
                     .log = log,
                     .include_paths = settings->include_paths,
                     .include_path_count = settings->include_path_count,
                     .width = settings->width,
                     .height = settings->height,
                     .clock = settings->clock,
                     .threads = run->threads,
                     .switches = run->switches,
                     .process_seconds = &run->whole};
    if (!povray_run(&job, detail, sizeof detail) || image_read(output, pixels, &run->image, &error) != IMAGE_OK) {
        return false;
    }
    run->cost = povray_cost(log);
    return true;
}

int study_reference_samples(const char *scene, const StudySettings *settings, int most, const char *name)
{
    rt_sampling few = {.sampler = "halton", .samples = REFERENCE_TRIAL, .seed = 1};
    RtlangRun run = {.method = RT_METHOD_BACKWARD};
    int samples = most;

    if (!budget_is_limited(settings->budget)) {
        return most;
    }
    rtlang_render(scene, settings, &few, RT_PRECISION_DOUBLE, 0, &run);
    image_fini(&run.image);
    while (samples > REFERENCE_LEAST && run.wall / REFERENCE_TRIAL * samples > budget_left(settings->budget)) {
        samples /= 2;
    }
    if (samples < most) {
        budget_leave_out(settings->budget, "%s has %d samples a pixel in place of %d", name, samples, most);
    }
    return samples;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return x < y ? -1 : x > y;
}

double study_median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, by_size);
    return count % 2 != 0 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}
