// The picture of a scene does not depend on the unit of its lengths: bit for bit for powers of two, to 1e-12 for powers
// of ten.
//
// All examples and all scenes that are compared with POV-Ray, put elsewhere by rt_set_world. Usage: test_invariance
// [all]; a few exponents a scene if nothing is said, every one of the lists in `make check-long`.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rtlang/rtlang.h"
#include "unit/scenes.h"
#include "unit/tap.h"

enum { WIDTH = 16, HEIGHT = 12, VALUES = 3 * WIDTH * HEIGHT, SAMPLE = 17 };

#define COUNT_OF(array) (sizeof(array) / sizeof((array)[0]))

static const int twos[] = {-400, 400, -61, 1, 30, -1, -133, 250, -399, 399};
static const int tens[] = {-100, 100, -7, 3, 1, -1, 20, -33};

// Why a scene is left out of the powers of ten, or of both.
typedef struct Exception {
    const char *name, *why;
    bool also_twos;
} Exception;

static const Exception exceptions[] = {
    {"interior_total_reflection", "a border of its checker lies in its plane, so the rounding of 8e20 decides", false},
    {"pattern_cells", "borders of its cells lie in the middle of pixels", false},
    {"pigment_below_zero", "a border of its checker lies in its plane", false},
    {"no_bump_scale", "the depth of its bumps is a length that is not scaled, as in POV-Ray", true},
    {"pattern_noise_marble", "a jump of its map lies in the middle of pixels", false},
};

static const double nowhere[3] = {0.0, 0.0, 0.0};

static rt_session *open_scene(const char *folder, const char *path, double scale, const double shift[3])
{
    rt_session *session = rt_session_new(NULL);
    rt_set_format(session, RT_FORMAT_JSON);
    if (rt_add_include_path(session, folder) || rt_set_size(session, WIDTH, HEIGHT) ||
        rt_set_world(session, scale, shift) || rt_load_file(session, path)) {
        rt_session_free(session);
        return NULL;
    }
    return session;
}

static bool draw(const char *folder, const char *path, double scale, const double shift[3], rt_precision precision,
                 float *values)
{
    int width, height;
    rt_session *session = open_scene(folder, path, scale, shift);
    bool is_drawn = session && rt_set_precision(session, precision) == RT_OK && rt_render(session, 1) == RT_OK;
    if (is_drawn) {
        memcpy(values, rt_pixels(session, &width, &height), VALUES * sizeof *values);
    }
    rt_session_free(session);
    return is_drawn;
}

// Colours in double, which the picture has not, of some of the pixels.
static int colours(const char *folder, const char *path, double scale, double *out)
{
    rt_session *session = open_scene(folder, path, scale, nowhere);
    int count = 0;
    for (int i = 0; session && i < WIDTH * HEIGHT; i += SAMPLE) {
        const char *text = "";
        const char *colour =
            rt_trace_pixel(session, i % WIDTH, i / WIDTH, &text) == RT_OK ? strstr(text, "\"colour\": [") : NULL;
        double *rgb = out + count;
        count += colour && sscanf(colour, "\"colour\": [%lf, %lf, %lf]", &rgb[0], &rgb[1], &rgb[2]) == 3 ? 3 : 0;
    }
    rt_session_free(session);
    return count;
}

static const Exception *exception_of(const char *path)
{
    for (size_t i = 0; i < COUNT_OF(exceptions); i++) {
        if (strstr(path, exceptions[i].name)) {
            return &exceptions[i];
        }
    }
    return NULL;
}

static void check_twos(const char *folder, const char *path, size_t first, size_t count)
{
    static float whole[VALUES], scaled[VALUES];
    bool is_same = draw(folder, path, 1.0, nowhere, RT_PRECISION_DOUBLE, whole);
    int wrong = 0;
    for (size_t i = 0; is_same && i < count; i++) {
        int k = twos[(first + i) % COUNT_OF(twos)];
        is_same = draw(folder, path, ldexp(1.0, k), nowhere, RT_PRECISION_DOUBLE, scaled) &&
                  memcmp(whole, scaled, sizeof whole) == 0;
        wrong = k;
    }
    tap_ok(is_same, "%s: the same bits at %zu powers of two, the last 2^%d", path, count, wrong);
}

static void check_tens(const char *folder, const char *path, size_t first, size_t count)
{
    static double whole[VALUES], scaled[VALUES];
    int values = colours(folder, path, 1.0, whole);
    double worst = 0.0;
    int worst_at = 0;
    for (size_t i = 0; i < count; i++) {
        int k = tens[(first + i) % COUNT_OF(tens)];
        double sum = colours(folder, path, pow(10.0, k), scaled) == values ? 0.0 : (double)INFINITY;
        for (int j = 0; j < values; j++) {
            sum += (whole[j] - scaled[j]) * (whole[j] - scaled[j]);
        }
        double rmse = sqrt(sum / values);
        worst_at = rmse >= worst ? k : worst_at;
        worst = fmax(worst, rmse);
    }
    tap_ok(values > 0 && worst <= 1e-12, "%s: RMSE %.1e at 10^%d, of %zu powers of ten", path, worst, worst_at, count);
}

// Shifted, beside quadruple precision on the same rounded numbers. What remains is that points are rounded to the
// coordinates' own spacing: their light moves by as much. Where an edge goes through the middle of a pixel, more.
static void check_shift(const char *folder, const char *path, int power, int axis)
{
    static float usual[VALUES], quad[VALUES];
    double shift[3] = {0.0, 0.0, 0.0}, sum = 0.0;
    shift[axis] = pow(10.0, power);
    double spacing = nextafter(shift[axis], (double)INFINITY) - shift[axis];
    int off = 0;
    if (!draw(folder, path, 1.0, shift, RT_PRECISION_QUAD, quad)) {
        return; // refused by the reference path
    }
    bool is_drawn = draw(folder, path, 1.0, shift, RT_PRECISION_DOUBLE, usual);
    for (int i = 0; i < VALUES; i++) {
        double error = fabs((double)usual[i] - (double)quad[i]);
        off += !(error <= 1e-6 + 8.0 * spacing);
        sum += error * error;
    }
    tap_ok(is_drawn && off <= (power < 12 ? 0 : VALUES / 50),
           "%s: shifted by 1e%d along %c: %d of %d values are off, RMSE %.1e, spacing %.1e", path, power, "xyz"[axis],
           off, VALUES, sqrt(sum / VALUES), spacing);
}

// *whole: all exponents and shifts.
static void check_scene(void *whole, const char *folder, const char *path, size_t number)
{
    bool is_whole = *(const bool *)whole;
    const Exception *exception = exception_of(path);
    if (exception) {
        tap_skip(path, exception->why);
    }
    if (!exception || !exception->also_twos) {
        check_twos(folder, path, number, is_whole ? COUNT_OF(twos) : 2);
    }
    if (!exception) {
        check_tens(folder, path, number, is_whole ? COUNT_OF(tens) : 2);
    }
    for (int at = 0; at < 9; at++) {
        if (is_whole || at == (int)(number % 9)) {
            check_shift(folder, path, 6 + 3 * (at / 3), at % 3);
        }
    }
}

int main(int argc, char **argv)
{
    bool is_whole = argc > 1 && strcmp(argv[1], "all") == 0;
    scenes_try("examples/*.scn", check_scene, &is_whole);
    scenes_try("tests/povray/*.scn", check_scene, &is_whole);
    return tap_done();
}
