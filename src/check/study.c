// The runs of a study, and what is worked out of them.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "check/study.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "check/povray_run.h"
#include "rtlang/rtlang.h"

#define COUNT_OF(array) (sizeof(array) / sizeof((array)[0]))

enum {
    RUNS_MOST = 9,
    REFERENCE_TIMES = 16, // the greatest number of samples of a ladder
    DEEPER = 64,
    LONG_SECONDS = 15,
    REFERENCE_SECONDS = 3, // of a rung of the reference kernels
    PHOTONS_LEAST = 400,   // for each sample of the greatest number
    PHOTONS_TIMES = 100,
};

typedef struct Run {
    rt_method method; // of the run to be made, as is …
    uint64_t photons;
    rt_photons counts;
    Image image;
    double seconds;
    rt_error error;
    rt_status status;
    char fault[STUDY_TEXT];
} Run;

static double processor_seconds(void)
{
    struct timespec now;

    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void on_diagnostic(void *client, const rt_diagnostic *diagnostic)
{
    Run *run = client;

    if (diagnostic->severity == RT_ERROR && run->fault[0] == '\0') {
        snprintf(run->fault, sizeof run->fault, "%.*s", (int)strcspn(diagnostic->text, "\n"), diagnostic->text);
    }
}

static bool picture_take(const rt_session *session, Image *image)
{
    int width, height;
    const float *pixels = rt_pixels(session, &width, &height);

    if (pixels == NULL || !image_init(image, width, height, 3)) {
        return false;
    }
    memcpy(image->values, pixels, (size_t)width * (size_t)height * 3 * sizeof *pixels);
    return true;
}

static rt_status session_ready(rt_session *session, const char *scene, const StudySettings *settings,
                               const rt_sampling *sampling, rt_precision precision)
{
    rt_status status = rt_set_size(session, settings->width, settings->height);

    for (int i = 0; status == RT_OK && i < settings->include_path_count; i++) {
        status = rt_add_include_path(session, settings->include_paths[i]);
    }
    status = status != RT_OK || settings->clock == NULL ? status : rt_set_clock(session, *settings->clock);
    status = status != RT_OK ? status : rt_set_sampling(session, sampling);
    status = status != RT_OK ? status : rt_set_precision(session, precision);
    return status != RT_OK ? status : rt_load_file(session, scene);
}

// One picture by rtlang; to be released with image_fini. The time is that of preparing and tracing.
static void rtlang_render(const char *scene, const StudySettings *settings, const rt_sampling *sampling,
                          rt_precision precision, int threads, Run *run)
{
    *run = (Run){.status = RT_FAULT_LIMIT, .method = run->method, .photons = run->photons};
    rt_callbacks callbacks = {.client = run, .diagnostic = on_diagnostic};
    rt_session *session = rt_session_new(&callbacks);

    if (session == NULL) {
        return;
    }
    run->status = session_ready(session, scene, settings, sampling, precision);
    run->status = run->status != RT_OK ? run->status : rt_set_method(session, run->method, run->photons);
    if (run->status == RT_OK) {
        double start = processor_seconds();
        run->status = rt_render(session, threads);
        run->seconds = processor_seconds() - start;
    }
    rt_get_error(session, &run->error);
    rt_get_photons(session, &run->counts);
    if (run->status == RT_OK && !picture_take(session, &run->image)) {
        run->status = RT_FAULT_LIMIT;
    }
    rt_session_free(session);
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return x < y ? -1 : x > y;
}

static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, by_size);
    return count % 2 != 0 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

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
        Run run = {.method = RT_METHOD_BACKWARD};

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
    point->seconds = median(seconds, runs);
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
                          Run *run, bool *misfits)
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
        Run run = {.method = method, .photons = photons};
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

// ---- POV-Ray

static bool povray_image(const Study *study, const StudySettings *settings, const char *const *switches, Image *image,
                         PovrayCost *cost)
{
    char output[4096], log[4096], detail[512];
    uint64_t pixels = (uint64_t)settings->width * (uint64_t)settings->height;
    ImageError error = {""};

    snprintf(output, sizeof output, "%s/study.png", settings->folder);
    snprintf(log, sizeof log, "%s/study.log", settings->folder);
    PovrayJob job = {.program = settings->povray,
                     .scene = study->scene,
                     .output = output,
                     .log = log,
                     .include_paths = settings->include_paths,
                     .include_path_count = settings->include_path_count,
                     .width = settings->width,
                     .height = settings->height,
                     .clock = settings->clock,
                     .threads = 1,
                     .switches = switches};
    if (!povray_run(&job, detail, sizeof detail) || image_read(output, pixels, image, &error) != IMAGE_OK) {
        return false;
    }
    *cost = povray_cost(log);
    return true;
}

static bool povray_point(const Study *study, const StudySettings *settings, const Image *reference,
                         const char *const *switches, StudyPoint *point)
{
    double seconds[RUNS_MOST], enough = 1.0;
    int count = 0;
    StudyMetric metric = {0};
    PovrayCost cost;

    *point = (StudyPoint){0};
    do { // the picture is the same each time, and what takes long need not be measured often
        Image image = {0};
        bool fine = povray_image(study, settings, switches, &image, &cost) &&
                    (count > 0 || study_compare(&image, reference, &metric));
        image_fini(&image);
        if (!fine) {
            return false;
        }
        seconds[count] = cost.seconds;
    } while (seconds[count++] < enough && count < settings->repeats && count < RUNS_MOST);
    point_add(point, &metric, 1);
    point->rmse = sqrt(point->rmse);
    point->seconds = median(seconds, count);
    point->samples = cost.rays / ((double)study->width * study->height);
    return true;
}

// A ladder for each method and threshold: its depths, until one takes long. What stays at some depth is the
// threshold's.
static bool povray_methods(Study *study, const StudySettings *settings, const Image *reference)
{
    static const char *const thresholds[] = {"0.3", "0.03", "0.0"};
    static const int depths[2][4] = {{2, 3, 5, 9}, {1, 2, 3, 4}}; // +AM1 takes the depth's square, +AM2 up to 4^depth

    for (int method = 1; method <= 2; method++) {
        for (size_t i = 0; i < COUNT_OF(thresholds); i++) {
            char name[48];
            snprintf(name, sizeof name, "POV-Ray +AM%d +A%s", method, thresholds[i]);
            StudyMethod *ladder = method_begin(study, name, STUDY_POVRAY);
            for (size_t j = 0; j < COUNT_OF(depths[0]) && !(j > 0 && ladder->points[j - 1].seconds > LONG_SECONDS);
                 j++) {
                char am[8], a[16], r[8];
                StudyPoint *point = &ladder->points[ladder->count];
                snprintf(am, sizeof am, "+AM%d", method);
                snprintf(a, sizeof a, "+A%s", thresholds[i]);
                snprintf(r, sizeof r, "+R%d", depths[method - 1][j]);
                if (*settings->interrupted != 0 ||
                    !povray_point(study, settings, reference, (const char *const[]){am, a, r, NULL}, point)) {
                    return false;
                }
                snprintf(point->setting, sizeof point->setting, "%s %s %s", am, a, r);
                point->effort = method == 1 ? pow(depths[0][j], 2.0) : pow(4.0, depths[1][j]);
                ladder->count++;
            }
            study_fit(ladder, study->floor);
        }
    }
    return true;
}

// ---- what is not sampling

// The distance of a picture of one ray a pixel from another; NAN where one of them is missing.
static double distance_of(const Run *picture, const Run *reference)
{
    StudyMetric metric;
    bool fine = picture->status == RT_OK && reference->status == RT_OK &&
                study_compare(&picture->image, &reference->image, &metric);

    return fine ? metric.rmse : (double)NAN;
}

static void model_find(Study *study, const StudySettings *settings)
{
    static const rt_sampling one = {0};
    Run ours = {.method = RT_METHOD_BACKWARD}, exact = ours, single = ours, theirs = {.status = RT_OK};
    PovrayCost cost;

    study->model = (double)NAN;
    rtlang_render(study->scene, settings, &one, RT_PRECISION_DOUBLE, 1, &ours);
    if (settings->povray != NULL && povray_image(study, settings, NULL, &theirs.image, &cost)) {
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
static void depth_find(Study *study, const StudySettings *settings, const rt_sampling *sampling, const Run *reference)
{
    rt_sampling deeper = *sampling;
    StudyMetric metric;
    Run run = {.method = RT_METHOD_BACKWARD};

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

bool study_run(Study *study, const char *scene, const StudySettings *settings)
{
    // Not the sampler that is studied, and 16 times its greatest number.
    rt_sampling sampling = {.sampler = "halton", .samples = REFERENCE_TIMES * settings->most_samples, .seed = 1};
    Run reference = {.method = RT_METHOD_BACKWARD};

    *study = (Study){.scene = scene,
                     .width = settings->width,
                     .height = settings->height,
                     .reference_samples = REFERENCE_TIMES * settings->most_samples};
    rtlang_render(scene, settings, &sampling, RT_PRECISION_DOUBLE, 0, &reference);
    if (reference.status != RT_OK) {
        snprintf(study->fault, sizeof study->fault, "%s", reference.fault);
        return false;
    }
    study->floor = reference.error.rmse;
    model_find(study, settings);
    depth_find(study, settings, &sampling, &reference);
    bool fine = rtlang_methods(study, settings, &reference.image) &&
                reference_methods(study, settings, &reference.image) &&
                forward_methods(study, settings, &reference.image) &&
                (settings->povray == NULL || povray_methods(study, settings, &reference.image));
    if (!fine) {
        snprintf(study->fault, sizeof study->fault, *settings->interrupted != 0 ? "interrupted" : "a run failed");
    }
    image_fini(&reference.image);
    return fine;
}

// ---- equal error, equal time

// The value of y at x on the lines through a ladder's points, in logarithms; beyond them, on the nearest one's; NAN for
// less than two points.
static double interpolate(const double *x, const double *y, int count, double at, bool *is_beyond)
{
    int i = 1;

    if (count < 2) {
        *is_beyond = true;
        return (double)NAN;
    }
    while (i < count - 1 && (x[i] - at) * (x[count - 1] - x[0]) < 0.0) {
        i++;
    }
    double share = (log(at) - log(x[i - 1])) / (log(x[i]) - log(x[i - 1]));
    *is_beyond = !(share >= 0.0 && share <= 1.0); // also where there is no error
    return exp(log(y[i - 1]) + share * (log(y[i]) - log(y[i - 1])));
}

int study_ratios(const Study *study, StudyRatio *ratios, int room)
{
    const StudyMethod *ours = &study->methods[0]; // the program's own choice, and the adaptive one
    double error[2][STUDY_POINTS], seconds[2][STUDY_POINTS];
    int count = 0, points[2];

    for (int k = 0; k < 2; k++) {
        points[k] = 0;
        for (int i = 0; i < ours[k].count; i++) {
            // One ray a pixel asks all of an area light: where that takes longer than four that do not, it is no rung.
            if (i + 1 < ours[k].count && ours[k].points[i].seconds >= ours[k].points[i + 1].seconds) {
                continue;
            }
            error[k][points[k]] = ours[k].points[i].rmse;
            seconds[k][points[k]++] = ours[k].points[i].seconds;
        }
    }
    for (int i = 0; i < study->count; i++) {
        const StudyMethod *method = &study->methods[i];
        for (int j = 0; method->kind == STUDY_POVRAY && j < method->count && count < room; j++) {
            StudyRatio *ratio = &ratios[count++];
            bool beyond[2], unused;
            double time[2], same[2];
            *ratio = (StudyRatio){.povray = &method->points[j], .povray_method = method};
            for (int k = 0; k < 2; k++) {
                time[k] = interpolate(error[k], seconds[k], points[k], method->points[j].rmse, &beyond[k]);
                same[k] = interpolate(seconds[k], error[k], points[k], fmax(method->points[j].seconds, 1e-4), &unused);
            }
            // The adaptive one begins with some rays for all pixels: where its ladder does not reach, the other counts.
            int best = !beyond[1] && time[1] < time[0] ? 1 : 0;
            ratio->seconds = time[best];
            ratio->is_extrapolated = beyond[best];
            ratio->rmse = fmin(same[0], same[1]);
        }
    }
    for (int i = 0; i < count; i++) {
        ratios[i].is_best = true;
        for (int j = 0; j < count; j++) {
            ratios[i].is_best = ratios[i].is_best && !(ratios[j].povray->seconds < ratios[i].povray->seconds &&
                                                       ratios[j].povray->rmse < ratios[i].povray->rmse);
        }
    }
    return count;
}

void study_total_add(StudyTotal *total, const Study *study)
{
    StudyRatio ratios[STUDY_METHODS * STUDY_POINTS];
    int best, count = study_ratios(study, ratios, STUDY_METHODS * STUDY_POINTS);
    double ratio = study_best_ratio(ratios, count, &best);

    if (best > 0) {
        total->scenes++;
        total->logarithms += log(ratio);
    }
}

double study_best_ratio(const StudyRatio *ratios, int count, int *best)
{
    double sum = 0.0;

    *best = 0;
    for (int i = 0; i < count; i++) {
        if (ratios[i].is_best && !ratios[i].is_extrapolated) {
            sum += log(ratios[i].povray->seconds / ratios[i].seconds);
            (*best)++;
        }
    }
    return *best > 0 ? exp(sum / *best) : (double)NAN;
}
