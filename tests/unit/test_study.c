// The reference path beside the kernels that trace pictures: what it covers looks the same, in double and in quad.
//
// Every example and every scene that is compared with POV-Ray is either refused with a message that has a place, or
// drawn. The reference kernel shares neither formulas nor code of geometry and light with the others, so each holds the
// other.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "math/quad.h"
#include "rtlang/rtlang.h"
#include "unit/scenes.h"
#include "unit/tap.h"

enum { WIDTH = 16, HEIGHT = 12, VALUES = 3 * WIDTH * HEIGHT };

#ifdef WITH_STUDY

typedef struct Told {
    int refusals, without_place;
} Told;

static void on_diagnostic(void *client, const rt_diagnostic *diagnostic)
{
    Told *told = client;
    if (strcmp(diagnostic->code, "E0446") == 0) {
        told->refusals++;
        told->without_place += diagnostic->file == NULL;
    }
}

static rt_status draw(const char *folder, const char *path, rt_precision precision, Told *told, float *values)
{
    int width, height;
    rt_session *session = rt_session_new(&(rt_callbacks){told, on_diagnostic, NULL, NULL});
    rt_status status = rt_add_include_path(session, folder);
    status = status ? status : rt_set_size(session, WIDTH, HEIGHT);
    status = status ? status : rt_set_precision(session, precision);
    status = status ? status : rt_load_file(session, path);
    status = status ? status : rt_render(session, 1);
    if (!status) {
        memcpy(values, rt_pixels(session, &width, &height), VALUES * sizeof *values);
    }
    rt_session_free(session);
    return status;
}

// Values that differ by more than a share of what is there. In double and quad that is one step of the picture's
// floats, in which a number that lies between two of them may be rounded either way.
static int differences(const float *a, const float *b, double share)
{
    int count = 0;
    for (int i = 0; i < VALUES; i++) {
        count += !(fabs((double)a[i] - (double)b[i]) <= share * (1.0 + fabs((double)a[i])));
    }
    return count;
}

// Of all scenes: how many values have the same bits in double, and the greatest difference of any, in double and in
// quad.
static struct {
    int values, same, same_quad;
    double worst, worst_quad, worst_single;
} figures;

static void measure(const float *usual, const float *reference, const float *quad, const float *single)
{
    for (int i = 0; i < VALUES; i++) {
        double scale = 1.0 + fabs((double)usual[i]);
        figures.values++;
        figures.same += memcmp(usual + i, reference + i, sizeof *usual) == 0;
        figures.same_quad += memcmp(usual + i, quad + i, sizeof *usual) == 0;
        figures.worst_single = fmax(figures.worst_single, fabs((double)usual[i] - (double)single[i]) / scale);
        figures.worst = fmax(figures.worst, fabs((double)usual[i] - (double)reference[i]) / scale);
        figures.worst_quad = fmax(figures.worst_quad, fabs((double)usual[i] - (double)quad[i]) / scale);
    }
}

static void check_scene(void *covered, const char *folder, const char *path, size_t number)
{
    (void)number;
    static float usual[VALUES], reference[VALUES], quad[VALUES], single[VALUES];
    Told told = {0, 0};
    rt_status status = draw(folder, path, RT_PRECISION_REFERENCE, &told, reference);
    if (status == RT_FAULT_SCENE && told.refusals > 0) {
        tap_ok(told.without_place == 0, "%s: refused, with a place", path);
        return;
    }
    bool is_drawn = status == RT_OK && draw(folder, path, RT_PRECISION_DOUBLE, &told, usual) == RT_OK &&
                    draw(folder, path, RT_PRECISION_QUAD, &told, quad) == RT_OK &&
                    draw(folder, path, RT_PRECISION_FLOAT, &told, single) == RT_OK;
    ++*(int *)covered;
    if (is_drawn) {
        measure(usual, reference, quad, single);
    }
    int beside_usual = is_drawn ? differences(usual, reference, FLT_EPSILON) : VALUES;
    int beside_quad = is_drawn ? differences(usual, quad, FLT_EPSILON) : VALUES;
    int beside_single = is_drawn ? differences(usual, single, 2e-2) : VALUES;
    tap_ok(is_drawn && beside_usual == 0 && beside_quad == 0 && beside_single <= VALUES / 20,
           "%s: of %d values %d differ in double, %d in quad, %d in float", path, VALUES, beside_usual, beside_quad,
           beside_single);
}

static void check_scenes(const char *pattern, int least)
{
    int covered = 0;
    size_t count = scenes_try(pattern, check_scene, &covered);
    tap_ok(covered >= least, "%d of %zu scenes %s are covered", covered, count, pattern);
}

// Identities that no double could hold to 1e-30, and double's own results to its last bits.
static void check_quad_functions(void)
{
    double worst = 0.0, beside_double = 0.0;
    for (int i = 1; i < 1000; i++) {
        Quad x = (Quad)i / 1000 + (Quad)i * (Quad)0x1p-70, sine, cosine;
        Quad root = quad_sqrt(x), angle = quad_acos(x);
        quad_sine_cosine(angle, &sine, &cosine);
        Quad errors[] = {root * root / x - 1, quad_exp(quad_log(x)) / x - 1, cosine - x,
                         quad_pow(x, (Quad)5 / 2) / (x * x * root) - 1};
        for (int k = 0; k < 4; k++) {
            worst = fmax(worst, fabs((double)errors[k]));
        }
        double y = (double)x;
        beside_double = fmax(beside_double, fabs((double)quad_acos((Quad)y) / acos(y) - 1.0));
        beside_double = fmax(beside_double, fabs((double)quad_exp((Quad)(-100.0 * y)) / exp(-100.0 * y) - 1.0));
        beside_double = fmax(beside_double, fabs((double)quad_pow((Quad)y, (Quad)1.7) / pow(y, 1.7) - 1.0));
    }
    tap_ok(worst < 1e-30, "functions in quadruple precision hold their identities to %.1e", worst);
    tap_ok(beside_double < 4e-16, "and agree with those of double to %.1e", beside_double);
    tap_ok((double)quad_sqrt(0) == 0.0 && isnan((double)quad_sqrt(-1)) && (double)quad_pow(0, 2) == 0.0 &&
               (double)quad_exp(-1000) == 0.0 && (double)quad_acos(1) == 0.0,
           "and are what they should be at their ends");
}

int main(void)
{
    check_quad_functions();
    check_scenes("examples/*.scn", 5);
    check_scenes("tests/povray/*.scn", 40);
    tap_ok(figures.same >= figures.values - figures.values / 1000 &&
               figures.same_quad >= figures.values - figures.values / 1000 && figures.worst_single > 0.0,
           "of %d values %d have the same bits by the reference path in double, %d in quad; the greatest differences "
           "are %.1e, "
           "%.1e and, in float, %.1e",
           figures.values, figures.same, figures.same_quad, figures.worst, figures.worst_quad, figures.worst_single);
    return tap_done();
}

#else

int main(void)
{
    rt_session *session = rt_session_new(NULL);
    tap_ok(rt_set_precision(session, RT_PRECISION_QUAD) == RT_FAULT_USAGE &&
               rt_set_precision(session, RT_PRECISION_DOUBLE) == RT_OK,
           "built without the reference path: only double is there");
    rt_session_free(session);
    return tap_done();
}

#endif
