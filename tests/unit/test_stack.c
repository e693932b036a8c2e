// A client's thread with a stack of 128 kB: all that the library does there is what it does elsewhere, down to scenes that
// nest as deep as may be, and deeper.
//
// SPDX-License-Identifier: MIT
#include <glob.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/attributes.h"
#include "rtlang/rtlang.h"
#include "unit/tap.h"

enum { SMALL_BYTES = 128 << 10, WIDTH = 48, HEIGHT = 36, TEXT_MOST = 1 << 16 };

typedef struct Job {
    const char *path, *text; // one of them
    const char *includes;    // a folder
    rt_precision precision;
    rt_status status;
    char message[400]; // the first
    float *pixels;
    char *dumped, *followed;
} Job;

static void keep_message(void *client, const rt_diagnostic *diagnostic)
{
    Job *job = client;
    if (diagnostic->severity == RT_ERROR && !job->message[0]) {
        snprintf(job->message, sizeof job->message, "%.*s", (int)strcspn(diagnostic->text, "\n"), diagnostic->text);
    }
}

static void *job_run(void *argument)
{
    Job *job = argument;
    const char *text;
    rt_session *session = rt_session_new(&(rt_callbacks){.client = job, .diagnostic = keep_message});
    rt_set_size(session, WIDTH, HEIGHT);
    rt_add_include_path(session, job->includes);
    job->status = job->path ? rt_load_file(session, job->path)
                            : rt_load_text(session, "deep.scn", job->text, strlen(job->text));
    if (job->status == RT_OK && rt_dump_scene(session, &text) == RT_OK) {
        job->dumped = strdup(text);
    }
    if (job->status == RT_OK && rt_trace_pixel(session, WIDTH / 2, HEIGHT / 2, &text) == RT_OK) {
        job->followed = strdup(text);
    }
    if (job->status == RT_OK) {
        rt_set_precision(session, job->precision);
        job->status = rt_render(session, 2);
    }
    if (job->status == RT_OK) {
        int width, height;
        const float *pixels = rt_pixels(session, &width, &height);
        size_t bytes = 3 * (size_t)width * (size_t)height * sizeof *pixels;
        job->pixels = malloc(bytes);
        memcpy(job->pixels, pixels, bytes);
    }
    rt_session_free(session);
    return NULL;
}

static void job_free(Job *job)
{
    free(job->pixels);
    free(job->dumped);
    free(job->followed);
}

static bool texts_equal(const char *a, const char *b)
{
    return a && b ? strcmp(a, b) == 0 : a == b;
}

// The same on this thread and on a small one.
static void test_alike(const char *name, Job job)
{
    job.includes = job.includes ? job.includes : ".";
    Job here = job, there = job;
    pthread_attr_t attributes;
    pthread_t thread;
    job_run(&here);
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, SMALL_BYTES);
    bool is_started = pthread_create(&thread, &attributes, job_run, &there) == 0;
    pthread_attr_destroy(&attributes);
    if (is_started) {
        pthread_join(thread, NULL);
    }
    bool same = is_started && here.status == there.status && strcmp(here.message, there.message) == 0 &&
                !here.pixels == !there.pixels && texts_equal(here.dumped, there.dumped) &&
                texts_equal(here.followed, there.followed);
    same = same && (!here.pixels || memcmp(here.pixels, there.pixels, sizeof(float) * 3 * WIDTH * HEIGHT) == 0);
    tap_ok(same, "%s: status %d, `%s`", name, there.status, there.message);
    job_free(&here);
    job_free(&there);
}

// A scene in which `open` and `close` stand `levels` times around something.
static void test_nested(const char *name, int levels, const char *before, const char *open, const char *middle,
                        const char *close, const char *after)
{
    static char text[TEXT_MOST * 8];
    char title[80];
    size_t at = (size_t)snprintf(text, sizeof text, "camera { location -5*z }\nlight_source { 9, rgb 1 }\n%s", before);
    for (int i = 0; i < levels; i++) {
        at += (size_t)snprintf(text + at, sizeof text - at, "%s", open);
    }
    at += (size_t)snprintf(text + at, sizeof text - at, "%s", middle);
    for (int i = 0; i < levels; i++) {
        at += (size_t)snprintf(text + at, sizeof text - at, "%s", close);
    }
    snprintf(text + at, sizeof text - at, "%s\n", after);
    snprintf(title, sizeof title, "%d %s", levels, name);
    test_alike(title, (Job){.text = text});
}

static void test_deep(void)
{
    static const int levels[] = {300, 900, 5000};
    const char *sphere = "sphere { 0, 1 pigment { rgb 1 } }";
    for (size_t i = 0; i < RT_COUNT_OF(levels); i++) {
        test_nested("unions", levels[i], "", "union { ", sphere, " }", "");
        test_nested("intersections", levels[i], "", "intersection { sphere { 0, 2 } ", sphere, " }", "");
        test_nested("maps", levels[i], "sphere { 0, 1 texture { ",
                    "gradient x texture_map { [0 pigment { rgb 1 }] [1 ", "pigment { rgb 0 }", "] }", " } }");
        test_nested("brackets", levels[i], "#declare A = ", "(1+", "1", ")", "; sphere { 0, A }");
        test_nested("calls", levels[i], "#macro F(X) X+1 #end\n#declare A = ", "F(", "1", ")", "; sphere { 0, 1 }");
        test_nested("torn unions", levels[i], "#macro O() union { #end #macro C() } #end ", "O() ", sphere, " C()", "");
    }
    test_alike("macros in each other",
               (Job){.text = "#macro M(N) union { sphere { N, 1 } M(N + 1) } #end camera { } M(0)"});
    test_alike("maps declared one by one",
               (Job){.text = "camera { location -5*z } light_source { 9, rgb 1 } #declare P = texture { pigment { rgb 1 } }"
                             "#for (I, 1, 900) #declare P = texture { gradient x texture_map { [0 P] [1 pigment { rgb 0 "
                             "}] } } #end sphere { 0, 1 texture { P } }"});
}

static void test_mirrors(void)
{
    static const rt_precision precisions[] = {RT_PRECISION_DOUBLE, RT_PRECISION_QUAD, RT_PRECISION_REFERENCE};
    for (size_t i = 0; i < RT_COUNT_OF(precisions); i++) {
        char name[40];
        snprintf(name, sizeof name, "256 levels of mirrors, precision %d", (int)precisions[i]);
        test_alike(name, (Job){.text = "global_settings { max_trace_level 256 adc_bailout 0 } camera { location <0, 0, -5> }"
                                       "plane { y, -1 pigment { rgb 1 } finish { reflection 1 ambient 0.1 } }"
                                       "plane { -y, -1 pigment { rgb 1 } finish { reflection 0.9 ambient 0.1 } }",
                               .precision = precisions[i]});
    }
}

static void test_examples(void)
{
    const char *top = getenv("top_srcdir");
    char pattern[4000], includes[4000];
    glob_t found;
    snprintf(pattern, sizeof pattern, "%s/examples/*.scn", top ? top : ".");
    snprintf(includes, sizeof includes, "%s/share/rtlang", top ? top : ".");
    if (!tap_ok(glob(pattern, 0, NULL, &found) == 0, "examples are there")) {
        return;
    }
    for (size_t i = 0; i < found.gl_pathc; i++) {
        test_alike(strrchr(found.gl_pathv[i], '/') + 1, (Job){.path = found.gl_pathv[i], .includes = includes});
    }
    globfree(&found);
}

int main(void)
{
    test_examples();
    test_mirrors();
    test_deep();
    return tap_done();
}
