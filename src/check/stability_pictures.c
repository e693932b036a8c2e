// Pictures for --stability: stiff scenes and given ones, put elsewhere and compared.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check/stability_draw.h"

enum { WIDTH = 32, HEIGHT = 24, VALUES = 3 * WIDTH * HEIGHT, SHOWN_WIDTH = 128, SHOWN_HEIGHT = 96 };

#define HEAD "global_settings { assumed_gamma 1 max_trace_level 40 }\n"

static const StudyScene stiff[STIFF_SCENES] = {
    {"mirrors nearly touching",
     HEAD "camera { location <0, 0.4, -3> look_at 0 }\nlight_source { <5, 9, -9>, 1 }\n"
          "#default { finish { reflection 0.9 ambient 0.02 } }\nbackground { rgb <0.2, 0.3, 0.5> }\n"
          "sphere { <-1.0000000001, 0, 0>, 1 pigment { rgb <1, 0.4, 0.3> } }\n"
          "sphere { <1.0000000001, 0, 0>, 1 pigment { rgb <0.3, 1, 0.4> } }\n"},
    {"nested shells", HEAD "camera { location <0, 0, -3> look_at 0 }\nlight_source { <5, 9, -9>, 1 }\n#declare I = 0;\n"
                           "#while (I < 12)\n  sphere { 0, 1 - pow(10, -16 + I) pigment { rgbf <1, 0.9, 0.8, 0.9> } "
                           "}\n  #declare I = I + 1;\n#end\n"
                           "sphere { 0, 0.5 pigment { rgb x } }\n"},
    {"radius ratio 1e12",
     HEAD "camera { location <0, 1e-6, -4e-6> look_at <0, 1e-6, 0> }\nlight_source { <5, 9, -9>, 1 }\n"
          "sphere { <0, -1e6, 0>, 1e6 pigment { rgb <0.4, 0.6, 0.3> } finish { reflection 0.3 } }\n"
          "sphere { <0, 1e-6, 0>, 1e-6 pigment { rgb <0.9, 0.5, 0.3> } }\n"},
    {"planet from one metre",
     HEAD "camera { location <0, 1, 0> look_at <0, 0.9, 5> }\nlight_source { <1e9, 1e9, -1e9>, 1 }\n"
          "sphere { <0, -6371000, 0>, 6371000 pigment { rgb <0.3, 0.5, 0.3> } }\n"
          "sphere { <0, 0.5, 6>, 0.5 pigment { rgb <0.9, 0.5, 0.3> } }\n"},
    {"pea at 1e9 radii", HEAD
     "camera { location <0, 0, -1e9> direction 3e8 * z right 4/3 * x up y look_at 0 }\nlight_source { <5, 9, -9>, 1 }\n"
     "sphere { 0, 1 pigment { rgb <0.4, 0.9, 0.3> } }\nsphere { <0.7, 0.6, -0.8>, 0.2 pigment { rgb <0.9, 0.4, "
     "0.3> } }\n"},
    {"grazing light",
     HEAD "camera { location <0, 3, -6> look_at 0 }\nlight_source { <1e6, 1.0001, 0>, 1 parallel point_at <0, 1, 0> }\n"
          "plane { y, 0 pigment { rgb 0.8 } }\nsphere { <0, 1, 0>, 1 pigment { rgb <0.9, 0.4, 0.3> } }\n"
          "sphere { <3, 0.5, 0>, 0.5 pigment { rgb <0.3, 0.4, 0.9> } }\n"},
    {"total reflection at the threshold", HEAD
     "camera { location <0, 0, -2> look_at 0 }\nlight_source { <5, 9, -9>, 1 }\nbackground { rgb <0.3, 0.5, 0.9> }\n"
     "sphere { 0, 1 pigment { rgbf <1, 1, 1, 0.95> } interior { ior 0.75 } }\n"
     "sphere { <0, 0, 6>, 2 pigment { rgb <0.9, 0.4, 0.3> } }\n"},
};

static PictureRow *picture_add(Stability *stability)
{
    if (stability->picture_count == stability->picture_room) {
        size_t room = 2 * stability->picture_room + 16;
        PictureRow *rows = realloc(stability->pictures, room * sizeof *rows);
        if (!rows) {
            return NULL;
        }
        stability->pictures = rows;
        stability->picture_room = room;
    }
    return &stability->pictures[stability->picture_count++];
}

static void picture_compare(PictureRow *row, const float *a, const float *b)
{
    double sum = 0.0;
    row->is_made = true;
    row->is_same = memcmp(a, b, VALUES * sizeof *a) == 0;
    row->values = VALUES;
    for (int i = 0; i < VALUES; i++) {
        double error = fabs((double)a[i] - (double)b[i]);
        row->off += !(error <= 1e-6);
        sum += error * error;
    }
    row->rmse = sqrt(sum / VALUES);
}

// A way to draw a scene, and its name in the report.
typedef struct Drawn {
    const Motion *motion;
    const char *name;
} Drawn;

static bool compare(Stability *stability, const Options *options, const StudyScene *scene, Drawn one, Drawn other)
{
    float *values = malloc(2 * VALUES * sizeof *values);
    PictureRow *row = picture_add(stability);
    bool has_memory = values && row;
    if (has_memory) {
        *row = (PictureRow){.scene = scene->name, .beside = other.name};
        snprintf(row->what, sizeof row->what, "%s", one.name);
        if (motion_draw(&(MotionPicture){options, scene, one.motion, WIDTH, HEIGHT}, values) &&
            motion_draw(&(MotionPicture){options, scene, other.motion, WIDTH, HEIGHT}, values + VALUES)) {
            picture_compare(row, values, values + VALUES);
        }
    }
    free(values);
    return has_memory;
}

// The same in other units: powers of two against bits, powers of ten against a bound.
static bool compare_scales(Stability *stability, const Options *options, const StudyScene *scene)
{
    static const int twos[] = {-400, -61, 1, 400}, tens[] = {-100, -7, 3, 100};
    bool fine = true;
    char what[48];
    for (size_t i = 0; fine && i < RT_COUNT_OF(twos); i++) {
        Motion scaled = motion_none;
        scaled.scale = ldexp(1.0, twos[i]);
        snprintf(what, sizeof what, "times 2^%d", twos[i]);
        fine = compare(stability, options, scene, (Drawn){&scaled, what}, (Drawn){&motion_none, "unscaled"});
    }
    for (size_t i = 0; fine && i < RT_COUNT_OF(tens); i++) {
        Motion scaled = motion_none;
        scaled.scale = pow(10.0, tens[i]);
        snprintf(what, sizeof what, "times 10^%d", tens[i]);
        fine = compare(stability, options, scene, (Drawn){&scaled, what}, (Drawn){&motion_none, "unscaled"});
    }
    return fine;
}

// Against quadruple precision on the same numbers.
static bool compare_precisions(Stability *stability, const Options *options, const StudyScene *scene)
{
    static const struct {
        const char *what;
        Motion motion;
    } places[] = {
        {"as it is", {1.0, {0.0, 0.0, 0.0}, 1.0, RT_PRECISION_DOUBLE}},
        {"as it is, in float", {1.0, {0.0, 0.0, 0.0}, 1.0, RT_PRECISION_FLOAT}},
        {"shifted by 1e6 along x", {1.0, {1e6, 0.0, 0.0}, 1.0, RT_PRECISION_DOUBLE}},
        {"shifted by 1e9 along y", {1.0, {0.0, 1e9, 0.0}, 1.0, RT_PRECISION_DOUBLE}},
        {"shifted by 1e12 along z", {1.0, {0.0, 0.0, 1e12}, 1.0, RT_PRECISION_DOUBLE}},
        {"camera 1e6 times as far", {1.0, {0.0, 0.0, 0.0}, 1e6, RT_PRECISION_DOUBLE}},
        {"camera at a tenth", {1.0, {0.0, 0.0, 0.0}, 0.1, RT_PRECISION_DOUBLE}},
    };
    bool fine = true;
    for (size_t i = 0; fine && i < RT_COUNT_OF(places); i++) {
        Motion exact = places[i].motion;
        exact.precision = RT_PRECISION_QUAD;
        fine = compare(stability, options, scene, (Drawn){&places[i].motion, places[i].what}, (Drawn){&exact, "quad"});
    }
    return fine;
}

// Large enough to be looked at, in each precision and by POV-Ray.
static void show(Stability *stability, const Options *options, const StudyScene *scene, const char *povray,
                 const char *folder)
{
    static const rt_precision precisions[] = {
        [SHOWN_FLOAT] = RT_PRECISION_FLOAT, [SHOWN_DOUBLE] = RT_PRECISION_DOUBLE, [SHOWN_QUAD] = RT_PRECISION_QUAD};
    ShownRow *row = &stability->shown[stability->shown_count++];
    row->scene = scene->name;
    for (int way = 0; way < SHOWN_POVRAY; way++) {
        Motion motion = motion_none;
        motion.precision = precisions[way];
        const MotionPicture picture = {options, scene, &motion, SHOWN_WIDTH, SHOWN_HEIGHT};
        row->has[way] = motion_image(&picture, &row->in[way]);
    }
    const MotionPicture still = {options, scene, &motion_none, SHOWN_WIDTH, SHOWN_HEIGHT};
    row->has[SHOWN_POVRAY] = povray && motion_povray(&still, povray, folder, &row->in[SHOWN_POVRAY]);
}

bool stability_pictures(Stability *stability, const Options *options, const char *povray, const char *folder)
{
    bool fine = true;
    for (size_t i = 0; fine && i < RT_COUNT_OF(stiff); i++) {
        fine = compare_scales(stability, options, &stiff[i]) && compare_precisions(stability, options, &stiff[i]);
        show(stability, options, &stiff[i], povray, folder);
    }
    for (int i = 0; fine && i < options->scene_count; i++) {
        StudyScene given = {options->scenes[i], NULL};
        fine = compare_scales(stability, options, &given) && compare_precisions(stability, options, &given);
    }
    return fine && stability_breaks(stability, options, povray, folder);
}
