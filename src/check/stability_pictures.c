// Pictures for --stability: stiff scenes, given scenes put elsewhere, and scenes where POV-Ray's range ends.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check/povray_run.h"
#include "check/stability.h"
#include "rtlang/rtlang.h"

enum { WIDTH = 32, HEIGHT = 24, VALUES = 3 * WIDTH * HEIGHT };

typedef struct StiffScene {
    const char *name, *text; // NULL: the name is that of a file
} StiffScene;

#define HEAD "global_settings { assumed_gamma 1 max_trace_level 40 }\n"

static const StiffScene stiff[] = {
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
    {"pea at 1e9 radii",
     HEAD "camera { location <0, 0, -1e9> direction 8e8 * z right x up y look_at 0 }\nlight_source { <5, 9, -9>, 1 }\n"
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

// How a scene is put elsewhere.
typedef struct Motion {
    double scale, shift[3], camera; // camera: factor of its distance, 1: it stays
    rt_precision precision;
} Motion;

static const Motion still = {1.0, {0.0, 0.0, 0.0}, 1.0, RT_PRECISION_DOUBLE};

// A scene's picture; `text` is NULL for a file.
static bool draw(const Options *options, const char *name, const char *text, const Motion *motion, float *values)
{
    int width, height;
    rt_session *session = rt_session_new(NULL);
    rt_status status = session ? rt_set_size(session, WIDTH, HEIGHT) : RT_FAULT_LIMIT;
    for (int i = 0; !status && i < options->include_path_count; i++) {
        status = rt_add_include_path(session, options->include_paths[i]);
    }
    status = status ? status : rt_set_world(session, motion->scale, motion->shift);
    status = status ? status : rt_set_precision(session, motion->precision);
    status = status ? status : text ? rt_load_text(session, name, text, strlen(text)) : rt_load_file(session, name);
    status = status || motion->camera == 1.0 ? status : rt_move_camera(session, motion->camera);
    status = status ? status : rt_render(session, options->threads);
    if (!status) {
        memcpy(values, rt_pixels(session, &width, &height), VALUES * sizeof *values);
    }
    rt_session_free(session);
    return status == RT_OK;
}

static PictureRow *picture_add(Stability *stability)
{
    if (stability->picture_count == stability->picture_room) {
        size_t room = 2 * stability->picture_room + 16;
        PictureRow *rows = realloc(stability->pictures, room * sizeof *rows);
        if (rows == NULL) {
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

static bool compare(Stability *stability, const Options *options, const StiffScene *scene, const Motion *one,
                    const char *what, const Motion *other, const char *beside)
{
    float *values = malloc(2 * VALUES * sizeof *values);
    PictureRow *row = picture_add(stability);
    bool has_memory = values != NULL && row != NULL;
    if (has_memory) {
        *row = (PictureRow){.scene = scene->name, .beside = beside};
        snprintf(row->what, sizeof row->what, "%s", what);
        if (draw(options, scene->name, scene->text, one, values) &&
            draw(options, scene->name, scene->text, other, values + VALUES)) {
            picture_compare(row, values, values + VALUES);
        }
    }
    free(values);
    return has_memory;
}

// The same in other units: powers of two against bits, powers of ten against a bound.
static bool compare_scales(Stability *stability, const Options *options, const StiffScene *scene)
{
    static const int twos[] = {-400, -61, 1, 400}, tens[] = {-100, -7, 3, 100};
    bool fine = true;
    char what[48];
    for (size_t i = 0; fine && i < sizeof twos / sizeof twos[0]; i++) {
        Motion scaled = still;
        scaled.scale = ldexp(1.0, twos[i]);
        snprintf(what, sizeof what, "times 2^%d", twos[i]);
        fine = compare(stability, options, scene, &scaled, what, &still, "unscaled");
    }
    for (size_t i = 0; fine && i < sizeof tens / sizeof tens[0]; i++) {
        Motion scaled = still;
        scaled.scale = pow(10.0, tens[i]);
        snprintf(what, sizeof what, "times 10^%d", tens[i]);
        fine = compare(stability, options, scene, &scaled, what, &still, "unscaled");
    }
    return fine;
}

// Against quadruple precision on the same numbers.
static bool compare_precisions(Stability *stability, const Options *options, const StiffScene *scene)
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
    for (size_t i = 0; fine && i < sizeof places / sizeof places[0]; i++) {
        Motion exact = places[i].motion;
        exact.precision = RT_PRECISION_QUAD;
        fine = compare(stability, options, scene, &places[i].motion, places[i].what, &exact, "quad");
    }
    return fine;
}

// ---- POV-Ray's limits

static const char break_scene[] =
    "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n#declare S = %.17g;\n#declare O = <%.17g, 0, 0>;\n"
    "camera { location <0, 2, -8> * S + O look_at <0, 0.9, 0> * S + O }\n"
    "light_source { <-5, 8, -6> * S + O, rgb 1 }\nbackground { rgb <0.2, 0.3, 0.5> }\n"
    "sphere { <-1.2, 1, 0> * S + O, 1 * S pigment { rgb <0.9, 0.4, 0.3> } finish { phong 0.5 } }\n"
    "sphere { <1.2, 1, 0> * S + O, 1 * S pigment { rgb <0.4, 0.6, 0.9> } finish { reflection 0.4 } }\n"
    "sphere { <0, -1000, 0> * S + O, 1000 * S pigment { rgb 0.7 } }\n";

static bool image_make(Image *image, const float *values)
{
    *image = (Image){WIDTH, HEIGHT, 3, malloc(VALUES * sizeof *values)};
    if (image->values) {
        memcpy(image->values, values, VALUES * sizeof *values);
    }
    return image->values != NULL;
}

static uint64_t pixels_off(const float *a, const float *b)
{
    uint64_t off = 0;
    for (int i = 0; i < VALUES; i += 3) {
        bool differs = false;
        for (int j = i; j < i + 3; j++) {
            differs = differs || !(fabs((double)a[j] - (double)b[j]) <= 2.0 / 255.0);
        }
        off += differs;
    }
    return off;
}

static bool povray_draw(const Options *options, const char *povray, const char *folder, const char *text, Image *image)
{
    char scene[4096], picture[4096], log[4096], detail[256];
    snprintf(scene, sizeof scene, "%s/break.pov", folder);
    snprintf(picture, sizeof picture, "%s/break.png", folder);
    snprintf(log, sizeof log, "%s/break.log", folder);
    FILE *out = fopen(scene, "wb");
    if (out == NULL || (fputs(text, out) == EOF) | (fclose(out) != 0)) {
        return false;
    }
    PovrayJob job = {.program = povray,
                     .scene = scene,
                     .output = picture,
                     .log = log,
                     .width = WIDTH,
                     .height = HEIGHT,
                     .threads = options->threads};
    ImageError error;
    return povray_run(&job, detail, sizeof detail) && image_read(picture, WIDTH * HEIGHT, image, &error) == IMAGE_OK &&
           image->width == WIDTH && image->height == HEIGHT && image->channels == 3;
}

static bool measure_breaks(Stability *stability, const Options *options, const char *povray, const char *folder)
{
    static const struct {
        const char *what;
        double scale, offset;
    } cases[BREAKS] = {{"as it is", 1.0, 0.0},  {"times 1e-3", 1e-3, 0.0}, {"times 1e-5", 1e-5, 0.0},
                       {"times 1e6", 1e6, 0.0}, {"times 1e7", 1e7, 0.0},   {"shifted by 1e8", 1.0, 1e8}};
    float first[VALUES], values[VALUES];
    for (size_t i = 0; i < BREAKS; i++) {
        char text[2048];
        BreakRow *row = &stability->breaks[stability->break_count];
        *row = (BreakRow){.pixels = WIDTH * HEIGHT};
        snprintf(row->what, sizeof row->what, "%s", cases[i].what);
        snprintf(text, sizeof text, break_scene, cases[i].scale, cases[i].offset);
        if (!draw(options, "break.pov", text, &still, values) || !image_make(&row->ours, values)) {
            return false;
        }
        if (i == 0) {
            memcpy(first, values, sizeof first);
        }
        stability->break_count++;
        row->off = pixels_off(first, values);
        row->has_povray = povray != NULL && povray_draw(options, povray, folder, text, &row->povray);
        row->povray_off = row->has_povray ? pixels_off(first, row->povray.values) : row->pixels;
    }
    return true;
}

bool stability_pictures(Stability *stability, const Options *options, const char *povray, const char *folder)
{
    bool fine = true;
    for (size_t i = 0; fine && i < sizeof stiff / sizeof stiff[0]; i++) {
        fine = compare_scales(stability, options, &stiff[i]) && compare_precisions(stability, options, &stiff[i]);
    }
    for (int i = 0; fine && i < options->scene_count; i++) {
        StiffScene given = {options->scenes[i], NULL};
        fine = compare_scales(stability, options, &given) && compare_precisions(stability, options, &given);
    }
    return fine && measure_breaks(stability, options, povray, folder);
}
