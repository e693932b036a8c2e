// Pictures of hard scenes beside exact arithmetic: no pixel is wrong without a word.
//
// Families of scenes (families.c) are drawn with a new seed each run, rendered by the library, and compared pixel by
// pixel with a reference in MPFR (reference.c). A pixel is wrong when a colour is off by more than TOLERANCE and
// rounding the eye, the ray and the lights does not explain it: the reference is asked again with each of these numbers
// off by up to 4 u, and the pixel must lie among what comes out. Shapes are never shaken: they are tested as they are
// given. Wrong pixels of a scene with a warning of the range of numbers are told of, others are not.
// Usage: test_exact [pixels a family [seed [part of a family's name]]].
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "exact/families.h"
#include "rtlang/rtlang.h"
#include "unit/random.h"
#include "study/optional.h"
#include "unit/tap.h"

#ifdef WITH_MPFR

enum { SIZE = 16, TEXT_MOST = 1 << 16, SHAKEN = 24 };
static const double TOLERANCE = 1e-4;

// ---- a scene as text

static char text[TEXT_MOST];
static size_t length;

__attribute__((format(printf, 1, 2))) static void put(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    length += (size_t)vsnprintf(text + length, TEXT_MOST - length, format, arguments);
    va_end(arguments);
}

static void put_vector(const char *before, const double v[3])
{
    put("%s<%.17g, %.17g, %.17g>", before, v[0], v[1], v[2]);
}

static void write_scene(const ExactScene *scene)
{
    length = 0;
    put("#version 3.7;\nglobal_settings { assumed_gamma 1 max_trace_level 20 adc_bailout 0 }\n"
        "#default { finish { ambient %g diffuse %g phong_size %g } }\ncamera {",
        EXACT_AMBIENT, EXACT_DIFFUSE, EXACT_PHONG_SIZE);
    put_vector(" location ", scene->location);
    put_vector(" direction ", scene->direction);
    put_vector(" right ", scene->right);
    put_vector(" up ", scene->up);
    put(" }\n");
    for (int i = 0; i < scene->light_count; i++) {
        put_vector("light_source { ", scene->lights[i].position);
        put_vector(", rgb ", scene->lights[i].rgb);
        put(" }\n");
    }
    for (int i = 0; i < scene->shape_count; i++) {
        const ExactShape *shape = &scene->shapes[i];
        if (shape->is_plane) {
            put("plane { %c, %.17g", "xyz"[shape->axis], shape->distance);
        } else {
            put_vector("sphere { ", shape->centre);
            put(", %.17g", shape->radius);
        }
        put_vector(" pigment { rgb ", shape->rgb);
        put(" } finish { reflection %.17g phong %.17g } }\n", shape->mirror, shape->phong);
    }
}

// ---- the judge

typedef struct Counts {
    int pixels, seen, explained, told, wrong, unread;
    double worst;
} Counts;

static void on_diagnostic(void *client, const rt_diagnostic *diagnostic)
{
    *(bool *)client |= diagnostic->severity == RT_WARNING && strncmp(diagnostic->code, "W044", 4) == 0;
}

static void shake(Random *random, double v[3])
{
    for (int i = 0; i < 3; i++) {
        v[i] *= 1.0 + 4.0 * (DBL_EPSILON / 2) * random_between(random, -1.0, 1.0);
    }
}

static bool is_within(const double value[3], const double low[3], const double high[3])
{
    bool is_in = true;
    for (int i = 0; i < 3; i++) {
        double slack = TOLERANCE + 0.5 * (high[i] - low[i]);
        is_in = is_in && value[i] >= low[i] - slack && value[i] <= high[i] + slack;
    }
    return is_in;
}

// Whether shaken numbers give colours about this one, too.
static bool is_explained(const ExactScene *scene, double u, double v, const double value[3], const double exact[3],
                         Random *random)
{
    double low[3], high[3];
    memcpy(low, exact, sizeof low);
    memcpy(high, exact, sizeof high);
    for (int k = 0; k < SHAKEN; k++) {
        ExactScene other = *scene;
        double rgb[3];
        shake(random, other.location);
        shake(random, other.direction);
        shake(random, other.right);
        shake(random, other.up);
        for (int i = 0; i < other.light_count; i++) {
            shake(random, other.lights[i].position);
        }
        exact_colour(&other, u, v, rgb);
        for (int i = 0; i < 3; i++) {
            low[i] = fmin(low[i], rgb[i]);
            high[i] = fmax(high[i], rgb[i]);
        }
        if (is_within(value, low, high)) {
            return true;
        }
    }
    return false;
}

static void judge(const ExactScene *scene, const float *pixels, bool is_told, Random *random, Counts *counts)
{
    for (int at = 0; at < SIZE * SIZE; at++) {
        double u = (at % SIZE + 0.5) / SIZE - 0.5, v = 0.5 - (at / SIZE + 0.5) / SIZE, exact[3];
        double value[3] = {pixels[3 * at], pixels[3 * at + 1], pixels[3 * at + 2]}, off = 0.0;
        exact_colour(scene, u, v, exact);
        for (int i = 0; i < 3; i++) {
            off = fmax(off, fabs(value[i] - exact[i]));
        }
        counts->pixels++;
        counts->seen += exact[0] > 0.0;
        if (off <= TOLERANCE) {
            continue;
        }
        if (is_told) {
            counts->told++;
        } else if (is_explained(scene, u, v, value, exact, random)) {
            counts->explained++;
        } else {
            counts->worst = fmax(counts->worst, off);
            if (counts->wrong++ == 0) {
                printf("# column %d, row %d: %.6f %.6f %.6f, exact %.6f %.6f %.6f\n%s", at % SIZE, at / SIZE, value[0],
                       value[1], value[2], exact[0], exact[1], exact[2], getenv("EXACT_SHOW") ? text : "");
            }
        }
    }
}

static void test_family(const Family *family, int pixels, Random *random)
{
    Counts counts = {0};
    while (counts.pixels + counts.unread * SIZE * SIZE < pixels) {
        ExactScene scene;
        bool is_told = false;
        rt_session *session = rt_session_new(&(rt_callbacks){&is_told, on_diagnostic, NULL, NULL});
        int width, height;
        family->draw(random, &scene);
        write_scene(&scene);
        rt_set_size(session, SIZE, SIZE);
        if (rt_load_text(session, "exact.scn", text, length) == RT_OK && rt_render(session, 1) == RT_OK) {
            judge(&scene, rt_pixels(session, &width, &height), is_told, random, &counts);
        } else {
            counts.unread++;
        }
        rt_session_free(session);
    }
    tap_ok(counts.wrong == 0 && counts.unread == 0 && counts.seen > counts.pixels / 20,
           "%s: of %d pixels, %d of them of shapes, %d are wrong without a word (by up to %.2g), %d as rounding of the "
           "eye explains, %d told",
           family->name, counts.pixels, counts.seen, counts.wrong, counts.worst, counts.explained, counts.told);
}

int main(int argc, char **argv)
{
    int pixels = argc > 1 ? atoi(argv[1]) : 2048;
    uint64_t seed = random_seed(argc > 2 ? argv[2] : NULL);
    exact_begin();
    for (int i = 0; i < family_count; i++) {
        Random random = {seed + (uint64_t)i * UINT64_C(0x9e3779b97f4a7c15)};
        if (argc <= 3 || strstr(families[i].name, argv[3])) {
            test_family(&families[i], pixels, &random);
        }
    }
    exact_end();
    return tap_done();
}

#else

int main(void)
{
    tap_skip("pictures beside exact arithmetic", "built without MPFR (apt-get install libmpfr-dev)");
    return tap_done();
}

#endif
