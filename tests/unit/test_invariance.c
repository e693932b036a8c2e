// The picture of a scene does not depend on the unit of its lengths: bit for bit for powers of two, to 1e-12 for powers
// of ten.
//
// All examples and all scenes that are compared with POV-Ray, put elsewhere by rt_set_world. Usage: test_invariance
// [all]; two exponents a scene if nothing is said, ten of twos and eight of tens in `make check-long`: one end of the
// range and random ones, with a new seed each time (unit/random.h). What comes last are the figures of
// docs/numerics.md.
//
// No pixel's middle may lie on a border of a pattern, where rounding decides. Of 16 by 12 pixels some do: at x = 0.45,
// where marble's wave is 0.9 and its map jumps.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/attributes.h"
#include "rtlang/rtlang.h"
#include "unit/random.h"
#include "unit/scenes.h"
#include "unit/tap.h"

enum { WIDTH = 22, HEIGHT = 14, VALUES = 3 * WIDTH * HEIGHT, SAMPLE = 17 };

enum { TWOS_MOST = 400, TENS_MOST = 100 }; // greatest exponents

// What `make check-long` tells of all scenes.
typedef struct Figures {
    int scenes, compared[3]; // by shifts
    double worst_ten, worst_shift[3];
    int worst_off[3];
} Figures;

static Figures figures;

// The exponents of a scene: at first one end of the range, then any.
static int exponent_at(Random *random, size_t scene, size_t i, int most)
{
    return i == 0 ? (scene % 2 ? most : -most) : (int)(random_bits(random) % (unsigned)(2 * most + 1)) - most;
}

// Scenes that say a length which is not scaled, as in POV-Ray: the depth of their bumps, and the turbulence of irid, whose
// noise lies in the scene and not in a texture. Other pictures at each scale.
static const char *const exceptions[] = {"no_bump_scale", "finish_irid"};
// Surfaces at whole numbers of a pattern that steps there: powers of two keep them, what rounds does not.
static const char *const steps[] = {"quilted_whole_numbers", "pattern_object_surfaces"};

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

static bool is_among(const char *path, const char *const *names, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (strstr(path, names[i])) {
            return true;
        }
    }
    return false;
}

static void check_differs(const char *folder, const char *path)
{
    static float whole[VALUES], scaled[VALUES];
    tap_ok(draw(folder, path, 1.0, nowhere, RT_PRECISION_DOUBLE, whole) &&
               draw(folder, path, 8.0, nowhere, RT_PRECISION_DOUBLE, scaled) && memcmp(whole, scaled, sizeof whole) != 0,
           "%s: another picture at another scale, as its bumps are not scaled", path);
}

static void check_twos(const char *folder, const char *path, size_t scene, size_t count, Random *random)
{
    static float whole[VALUES], scaled[VALUES];
    bool is_same = draw(folder, path, 1.0, nowhere, RT_PRECISION_DOUBLE, whole);
    int wrong = 0;
    for (size_t i = 0; is_same && i < count; i++) {
        int k = exponent_at(random, scene, i, TWOS_MOST);
        is_same = draw(folder, path, ldexp(1.0, k), nowhere, RT_PRECISION_DOUBLE, scaled) &&
                  memcmp(whole, scaled, sizeof whole) == 0;
        wrong = k;
    }
    tap_ok(is_same, "%s: the same bits at %zu powers of two, the last 2^%d", path, count, wrong);
}

static void check_tens(const char *folder, const char *path, size_t scene, size_t count, Random *random)
{
    static double whole[VALUES], scaled[VALUES];
    int values = colours(folder, path, 1.0, whole);
    double worst = 0.0;
    int worst_at = 0;
    for (size_t i = 0; i < count; i++) {
        int k = exponent_at(random, scene, i, TENS_MOST);
        double sum = colours(folder, path, pow(10.0, k), scaled) == values ? 0.0 : (double)INFINITY;
        for (int j = 0; j < values; j++) {
            sum += (whole[j] - scaled[j]) * (whole[j] - scaled[j]);
        }
        double rmse = sqrt(sum / values);
        worst_at = rmse >= worst ? k : worst_at;
        worst = fmax(worst, rmse);
    }
    figures.worst_ten = fmax(figures.worst_ten, worst);
    tap_ok(values > 0 && worst <= 1e-12, "%s: RMSE %.1e at 10^%d, of %zu powers of ten", path, worst, worst_at, count);
}

// Shifted, beside quadruple precision on the same rounded numbers. What remains is that points are rounded to the
// coordinates' own spacing: their light moves by as much. (No edge may go through the middle of a pixel.)
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
    int at = power / 3 - 2;
    figures.compared[at]++;
    figures.worst_off[at] = off > figures.worst_off[at] ? off : figures.worst_off[at];
    figures.worst_shift[at] = fmax(figures.worst_shift[at], sqrt(sum / VALUES));
    tap_ok(is_drawn && off == 0,
           "%s: shifted by 1e%d along %c: %d of %d values are off, RMSE %.1e, spacing %.1e", path, power, "xyz"[axis],
           off, VALUES, sqrt(sum / VALUES), spacing);
}

typedef struct Extent {
    bool is_whole; // all exponents and shifts
    Random random;
} Extent;

static void check_scene(void *client, const char *folder, const char *path, size_t number)
{
    Extent *extent = client;
    bool is_whole = extent->is_whole;
    bool has_steps = is_among(path, steps, RT_COUNT_OF(steps));
    if (is_among(path, exceptions, RT_COUNT_OF(exceptions))) {
        check_differs(folder, path);
    } else {
        check_twos(folder, path, number, is_whole ? 10 : 2, &extent->random);
        figures.scenes++;
    }
    if (!has_steps && !is_among(path, exceptions, RT_COUNT_OF(exceptions))) {
        check_tens(folder, path, number, is_whole ? 8 : 2, &extent->random);
    }
    for (int at = 0; !has_steps && at < 9; at++) {
        if (is_whole || at == (int)(number % 9)) {
            check_shift(folder, path, 6 + 3 * (at / 3), at % 3);
        }
    }
}

int main(int argc, char **argv)
{
    bool is_whole = argc > 1 && strcmp(argv[1], "all") == 0;
    Extent extent = {is_whole, {random_seed(NULL)}};
    scenes_try("examples/*.scn", check_scene, &extent);
    scenes_try("tests/povray/*.scn", check_scene, &extent);
    printf("# %d scenes, worst RMSE at powers of ten %.1e\n", figures.scenes, figures.worst_ten);
    for (int at = 0; at < 3; at++) {
        printf("# shifted by 1e%d: %d pictures beside quad, worst RMSE %.1e, at most %d of %d values off\n", 6 + 3 * at,
               figures.compared[at], figures.worst_shift[at], figures.worst_off[at], VALUES);
    }
    return tap_done();
}
