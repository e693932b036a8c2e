// Light from all sides through the public interface: closed forms, as many parallel lights, the error told beside the
// true one, and that nothing depends on threads, instruction sets and parts of the picture. Seeds are constants, so
// that three standard errors decide the same each time.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rtlang/rtlang.h"
#include "unit/tap.h"

enum { SIDE = 16, NUMBERS = 3 * SIDE * SIDE };

typedef struct Drawing {
    const char *scene;
    double sky[3];
    rt_sampling sampling;
    int threads;
    const char *isa;
    int crop[4];
} Drawing;

static rt_session *draw(const Drawing *drawing)
{
    rt_session *session = rt_session_new(NULL);
    bool is_fine = session && rt_set_sky_light(session, drawing->sky) == RT_OK &&
                   rt_set_size(session, SIDE, SIDE) == RT_OK && rt_set_sampling(session, &drawing->sampling) == RT_OK &&
                   (!drawing->isa || rt_set_isa(session, drawing->isa) == RT_OK) &&
                   rt_load_text(session, "scene", drawing->scene, strlen(drawing->scene)) == RT_OK;
    const int *crop = drawing->crop;
    is_fine = is_fine && (crop[2] == 0 || rt_set_crop(session, crop[0], crop[1], crop[2], crop[3]) == RT_OK) &&
              rt_render(session, drawing->threads ? drawing->threads : 2) == RT_OK;
    if (!is_fine) {
        printf("# cannot draw\n%s\n", drawing->scene);
        abort();
    }
    return session;
}

static void draw_into(const Drawing *drawing, float *pixels, rt_error *error)
{
    int width, height;
    rt_session *session = draw(drawing);
    memcpy(pixels, rt_pixels(session, &width, &height), NUMBERS * sizeof *pixels);
    if (error) {
        rt_get_error(session, error);
    }
    rt_session_free(session);
}

#define BEGIN                                                                                                          \
    "#version 3.7; global_settings { assumed_gamma 1 } #default { finish { ambient 0 diffuse 1 } pigment { rgb 1 } } "
// Looks at one point only, as a camera without size does.
#define AT(place, from) "camera { orthographic location " from " right 1e-6*x up 1e-6*y look_at " place " } "

// ---- closed forms

static void check_exact(const char *name, const char *scene, double red, double green, double blue)
{
    const double wanted[] = {red, green, blue};
    float pixels[NUMBERS];
    int wrong = 0;
    for (int samples = 1; samples <= 4; samples += 3) {
        draw_into(&(Drawing){.scene = scene, .sky = {0.5, 0.75, 1}, .sampling = {.samples = samples}}, pixels, NULL);
        for (int i = 0; i < NUMBERS; i++) {
            wrong += !(fabs((double)pixels[i] - wanted[i % 3]) <= 1e-6);
        }
    }
    tap_ok(wrong == 0, "%s: %.4g, %.4g, %.4g (%d of %d values are not)", name, red, green, blue, wrong, 2 * NUMBERS);
    if (wrong) {
        printf("# %.9g, %.9g, %.9g\n", (double)pixels[0], (double)pixels[1], (double)pixels[2]);
    }
}

static void test_exact(void)
{
    check_exact("nothing in the way", BEGIN AT("0", "<1, 2, 3>") "plane { y, 0 }", 0.5, 0.75, 1);
    check_exact("brilliance", BEGIN AT("0", "<1, 2, 3>") "plane { y, 0 finish { brilliance 3 } }", 0.25, 0.375, 0.5);
    check_exact("both sides", BEGIN AT("0", "<1, 2, 3>") "disc { 0, y, 1 finish { diffuse 0.5, 0.25 } }", 0.375, 0.5625,
                0.75);
    check_exact("the back is covered",
                BEGIN AT("0", "<1, 2, 3>") "disc { 0, y, 1 finish { diffuse 0.5, 0.25 } } plane { y, -1e-3 } ", 0.25,
                0.375, 0.5);
    check_exact("a clear shell",
                BEGIN AT("0", "<0.1, 0.2, 0.3>") "plane { y, 0 } sphere { 0, 1 pigment { rgb <1, 0.5, 0.25> filter 0.8 "
                                                 "} finish { diffuse 0 } }",
                0.4, 0.3, 0.2);
    check_exact("two clear shells",
                BEGIN AT("0", "<0.1, 0.2, 0.3>") "plane { y, 0 } sphere { 0, 1 pigment { rgbt 0.5 } } sphere { 0, 2 "
                                                 "pigment { rgbt 0.5 } }",
                0.125, 0.1875, 0.25);
    check_exact("closed all around", BEGIN AT("<0, -1, 0>", "<0.1, 0.2, 0.3>") "sphere { 0, 1 }", 0, 0, 0);
    check_exact("who casts no shadow", BEGIN AT("0", "<0.1, 0.2, 0.3>") "plane { y, 0 } sphere { 0, 1 no_shadow }", 0.5,
                0.75, 1);
    check_exact("in a mirror",
                BEGIN AT("0", "<0, 1, -1>") "plane { z, 0 inverse pigment { rgb 0 } finish { diffuse 0 reflection 0.5 "
                                            "} } plane { y, -1 }",
                0.125, 0.1875, 0.25);
}

// The mean of alike pixels, and its standard error.
static double mean_of(const Drawing *drawing, int seeds, double *error)
{
    float pixels[NUMBERS];
    double sum = 0.0, squares = 0.0, count = (double)seeds * SIDE * SIDE;
    Drawing own = *drawing;
    for (int seed = 0; seed < seeds; seed++) {
        own.sampling.seed = 100u + (unsigned)seed;
        draw_into(&own, pixels, NULL);
        for (int i = 0; i < NUMBERS; i += 3) {
            sum += (double)pixels[i];
            squares += (double)pixels[i] * (double)pixels[i];
        }
    }
    double mean = sum / count;
    *error = sqrt(fmax(squares / count - mean * mean, 0.0) / count);
    return mean;
}

static void check_mean(const char *name, const char *scene, double wanted)
{
    for (int samples = 1; samples <= 16; samples += 15) {
        double error,
            mean = mean_of(&(Drawing){.scene = scene, .sky = {1, 1, 1}, .sampling = {.samples = samples}}, 4, &error);
        tap_ok(
            fabs(mean - wanted) <= 3.0 * error + 1e-7 &&
                    error<0.006, "%s, %d samples: %.5f, %.2f standard errors from %.5f", name, samples, mean, error> 0.0
                ? (mean - wanted) / error
                : 0.0,
            wanted);
    }
}

static void test_means(void)
{
    double far = sqrt(0.8 * 0.8 + 1.5 * 1.5);
    check_mean("a plane below a sphere",
               BEGIN AT("<0.8, 0, 0>", "<0.8, 0.2, 0.1>") "plane { y, 0 } sphere { 1.5*y, 1 }",
               1.0 - 1.5 / (far * far * far));
    check_mean(
        "a plane below a clear sphere",
        BEGIN AT("<0.8, 0, 0>",
                 "<0.8, 0.2, 0.1>") "plane { y, 0 } sphere { 1.5*y, 1 pigment { rgbt 0.5 } finish { diffuse 0 } }",
        1.0 - 0.75 * 1.5 / (far * far * far));
    // What a point of a sphere's inside sees of an opening is the opening's share of the sphere.
    check_mean("inside of a dome, below",
               BEGIN AT("<0, -1, 0>", "<0.1, 0, 0.1>") "sphere { 0, 1 clipped_by { plane { y, 0.5 } } }", 0.25);
    check_mean("inside of a dome, aside",
               BEGIN AT("<0.6, 0, 0.8>", "<0.1, 0, 0.1>") "sphere { 0, 1 clipped_by { plane { y, 0.5 } } }", 0.25);
    check_mean("inside of a dome, as a difference",
               BEGIN AT("<0.6, 0, 0.8>",
                        "<0.1, 0, 0.1>") "difference { sphere { 0, 1.01 } sphere { 0, 1 } plane { -y, -0.5 } }",
               0.25);
    check_mean("the floor of a well", BEGIN AT("0", "<0.1, 0.9, 0>") "plane { y, 0 } cylinder { 0, 2*y, 1 open }", 0.2);
}

// ---- as many lights

#define CLUSTER                                                                                                        \
    "camera { location <1, 3, -7> look_at 0 angle 50 right x } background { rgb 0.1 } plane { y, -1.2 } "              \
    "#declare R = seed(5); #for (I, 1, 40) sphere { <rand(R), rand(R), rand(R)>*3 - 1.5, 0.3 "                         \
    "pigment { rgbt <rand(R), rand(R), rand(R), (I < 8 ? 0.6 : 0)> } finish { diffuse 0.7 brilliance (I > 30 ? 2 : "   \
    "1) } } #end "                                                                                                     \
    "box { <-2, -1.2, 1>, <2, 1, 1.5> } "

// Parallel lights spread over the sphere, one in each of 200 belts of equal area around y, whose colours add up to 4.
#define LIGHTS                                                                                                         \
    "#declare L = seed(%d); #declare T = rand(L); #for (I, 1, 200) #declare Y = (I - rand(L))/100 - 1; "               \
    "#declare A = 2*pi*(T + I*0.6180339887); light_source { <cos(A)*sqrt(1 - Y*Y), Y, sin(A)*sqrt(1 - Y*Y)>*100, "     \
    "4/200 "                                                                                                           \
    "parallel point_at 0 } #end "

static double picture_mean(const char *scene, double sky, unsigned seed)
{
    float pixels[NUMBERS];
    double sum = 0.0;
    draw_into(&(Drawing){.scene = scene, .sky = {sky, sky, sky}, .sampling = {.seed = seed}}, pixels, NULL);
    for (int i = 0; i < NUMBERS; i++) {
        sum += (double)pixels[i] / NUMBERS;
    }
    return sum;
}

static void test_as_lights(void)
{
    enum { RUNS = 24 };
    double sum[2] = {0.0, 0.0}, squares[2] = {0.0, 0.0}, error = 0.0;
    for (unsigned i = 0; i < RUNS; i++) {
        char lit[2048];
        snprintf(lit, sizeof lit, BEGIN CLUSTER LIGHTS, (int)i + 1);
        for (int k = 0; k < 2; k++) {
            double mean = picture_mean(k ? lit : BEGIN CLUSTER, k ? 0.0 : 1.0, i + 1);
            sum[k] += mean / RUNS;
            squares[k] += mean * mean / RUNS;
        }
    }
    for (int k = 0; k < 2; k++) {
        error += fmax(squares[k] - sum[k] * sum[k], 0.0) / (RUNS - 1);
    }
    error = sqrt(error);
    tap_ok(fabs(sum[0] - sum[1]) <= 3.0 * error && error < 0.003,
           "as 200 parallel lights, %d times: %.5f beside %.5f, %.2f standard errors", RUNS, sum[0], sum[1],
           (sum[0] - sum[1]) / error);
}

// ---- the error, and what nothing depends on

static void test_error(void)
{
    enum { SEEDS = 20 };
    static float reference[NUMBERS], pixels[NUMBERS];
    Drawing drawing = {
        .scene = BEGIN CLUSTER, .sky = {1, 1, 1}, .sampling = {.sampler = "halton", .samples = 4096, .seed = 9}};
    draw_into(&drawing, reference, NULL);
    int held = 0;
    double squares[2] = {0.0, 0.0}, told = 0.0;
    for (unsigned run = 0; run < 2 * SEEDS; run++) {
        rt_error error;
        double square = 0.0;
        drawing.sampling = (rt_sampling){.samples = run % 2 ? 64 : 8, .seed = 50 + run};
        draw_into(&drawing, pixels, &error);
        for (int i = 0; i < NUMBERS; i++) {
            double off = (double)pixels[i] - (double)reference[i];
            square += off * off / NUMBERS;
        }
        held += sqrt(square) >= error.low && sqrt(square) <= error.high;
        squares[run % 2] += square / SEEDS;
        told += run % 2 ? error.rmse * error.rmse / SEEDS : 0.0;
    }
    double ratio = sqrt(told / squares[1]), slope = log(squares[1] / squares[0]) / 2.0 / log(8.0);
    tap_ok(held >= 34 && ratio > 0.85 && ratio < 1.2, "the interval holds the error in %d of %d runs, told %.3f of it",
           held, 2 * SEEDS, ratio);
    tap_ok(slope < -0.55, "error falls with the samples' power of %.3f", slope);
}

static void test_same(void)
{
    float whole[NUMBERS], other[NUMBERS];
    int differ = 0, drawn = 0;
    for (int samples = 1; samples <= 5; samples += 4) {
        Drawing drawing = {
            .scene = BEGIN CLUSTER, .sky = {1, 0.5, 0.2}, .sampling = {.samples = samples, .seed = 3}, .threads = 1};
        draw_into(&drawing, whole, NULL);
        for (size_t i = 0; rt_isa(i); i++, drawn++) {
            drawing.isa = rt_isa(i);
            drawing.threads = 1 + (int)i;
            draw_into(&drawing, other, NULL);
            differ += memcmp(whole, other, sizeof whole) != 0;
        }
        int width, height;
        memcpy(drawing.crop, (int[]){3, 5, 9, 7}, sizeof drawing.crop);
        rt_session *part = draw(&drawing);
        const float *pixels = rt_pixels(part, &width, &height);
        for (int y = 0; y < height; y++) {
            differ += memcmp(&pixels[3 * y * width], &whole[3 * ((y + 5) * SIDE + 3)],
                             3 * sizeof(float) * (size_t)width) != 0;
        }
        rt_session_free(part);
    }
    tap_ok(differ == 0, "the same picture by all instruction sets, threads and parts: %d of %d differ", differ,
           drawn + 2);
    draw_into(&(Drawing){.scene = BEGIN CLUSTER "light_source { <3, 9, -8>, 1 }"}, whole, NULL);
    rt_session *session = draw(&(Drawing){.scene = BEGIN CLUSTER "light_source { <3, 9, -8>, 1 }", .sky = {1, 1, 1}});
    int width, height;
    bool is_other = memcmp(whole, rt_pixels(session, &width, &height), sizeof whole) != 0;
    bool is_off = rt_set_sky_light(session, (double[]){0, 0, 0}) == RT_OK && rt_render(session, 1) == RT_OK;
    tap_ok(is_other && is_off && memcmp(whole, rt_pixels(session, &width, &height), sizeof whole) == 0,
           "a session that has had a sky and has none any more");
    rt_session_free(session);
}

// ---- what is told and refused

static void keep(void *client, const rt_diagnostic *diagnostic)
{
    char *told = client;
    snprintf(told, 1024, "%s %s", diagnostic->code, diagnostic->message);
}

static void check_refused(rt_precision precision, rt_method method, const char *wanted)
{
    char told[1024] = "";
    rt_session *session = rt_session_new(&(rt_callbacks){.client = told, .diagnostic = keep});
    const char scene[] =
        BEGIN "camera { location -5*z aperture 0.1 focal_point 0 } sphere { 0, 1 } light_source { 9, 1 }";
    bool is_refused =
        session && rt_set_precision(session, precision) == RT_OK && rt_set_method(session, method, 100) == RT_OK &&
        rt_set_sky_light(session, (double[]){1, 1, 1}) == RT_OK &&
        rt_load_text(session, "scene", scene, strlen(scene)) == RT_OK && rt_render(session, 1) == RT_FAULT_SCENE;
    tap_ok(is_refused && strcmp(told, wanted) == 0, "refused: %s", told);
    rt_session_free(session);
}

static void test_refusals(void)
{
    char told[1024] = "";
    const double wrong[][3] = {{-1, 0, 0}, {0, (double)NAN, 0}, {0, 0, (double)INFINITY}};
    rt_session *session = rt_session_new(&(rt_callbacks){.client = told, .diagnostic = keep});
    int refused = 0;
    for (int i = 0; i < 3; i++) {
        refused += rt_set_sky_light(session, wrong[i]) == RT_FAULT_USAGE;
    }
    tap_ok(refused == 3, "numbers below 0 and not finite are refused");
    const char scene[] = "camera { location -5*z } sphere { 0, 1 }";
    bool is_silent = rt_set_sky_light(session, (double[]){1, 1, 1}) == RT_OK &&
                     rt_load_text(session, "scene", scene, strlen(scene)) == RT_OK && told[0] == '\0';
    tap_ok(is_silent, "a scene without lights is lit by the sky: %s", told);
    rt_session_free(session);
    check_refused(RT_PRECISION_DOUBLE, RT_METHOD_FORWARD_CONNECT,
                  "E0449 the forward tracer does not know light from all sides");
    rt_session *probe = rt_session_new(NULL);
    if (rt_set_precision(probe, RT_PRECISION_REFERENCE) == RT_OK) {
        check_refused(RT_PRECISION_REFERENCE, RT_METHOD_BACKWARD,
                      "E0446 light from all sides is not in the reference path");
    }
    rt_session_free(probe);
}

// The colour that a watched ray adds up to, and that of the picture.
static void test_watched(void)
{
    Drawing drawing = {
        .scene = BEGIN CLUSTER "light_source { <3, 9, -8>, 1 }", .sky = {1, 0.5, 0.2}, .sampling = {.seed = 3}};
    float pixels[NUMBERS];
    draw_into(&drawing, pixels, NULL);
    rt_session *session = draw(&drawing);
    int same = 0, skies = 0;
    rt_set_format(session, RT_FORMAT_JSON);
    for (int i = 0; i < SIDE * SIDE; i += 7) {
        const char *text;
        double found[3] = {-1, -1, -1};
        bool is_told = rt_trace_pixel(session, i % SIDE, i / SIDE, &text) == RT_OK;
        const char *linear = is_told ? strstr(text, "\"linear\": [") : NULL;
        same += linear && sscanf(linear, "\"linear\": [%lf, %lf, %lf]", &found[0], &found[1], &found[2]) == 3 &&
                (float)found[0] == pixels[3 * i] && (float)found[1] == pixels[3 * i + 1] &&
                (float)found[2] == pixels[3 * i + 2];
        skies += is_told && strstr(text, "\"sky_light\": [") != NULL;
    }
    tap_ok(same == 37 && skies > 15,
           "a watched ray has the picture's colour in %d of 37 pixels, %d with light of the sky", same, skies);
    rt_session_free(session);
}

int main(void)
{
    test_exact();
    test_means();
    test_as_lights();
    test_error();
    test_same();
    test_refusals();
    test_watched();
    return tap_done();
}
