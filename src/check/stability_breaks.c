// Where POV-Ray's range ends: a scene, and those that were given, in other units and places, drawn by both programs.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check/stability_draw.h"

enum { WIDTH = 128, HEIGHT = 96, VALUES = 3 * WIDTH * HEIGHT };

static const char break_scene[] =
    "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n"
    "camera { location <0, 2, -8> look_at <0, 0.9, 0> }\n"
    "light_source { <-5, 8, -6>, rgb 1 }\nbackground { rgb <0.2, 0.3, 0.5> }\n"
    "sphere { <-1.2, 1, 0>, 1 pigment { rgb <0.9, 0.4, 0.3> } finish { phong 0.5 } }\n"
    "sphere { <1.2, 1, 0>, 1 pigment { rgb <0.4, 0.6, 0.9> } finish { reflection 0.4 } }\n"
    "sphere { <0, -1000, 0>, 1000 pigment { rgb 0.7 } }\n";

// As a file holds it, which is what POV-Ray gives.
static double shown(float value)
{
    return fmin(fmax((double)value, 0.0), 1.0);
}

static uint64_t pixels_off(const float *a, const float *b)
{
    uint64_t off = 0;
    for (int i = 0; i < VALUES; i += 3) {
        bool differs = false;
        for (int j = i; j < i + 3; j++) {
            differs = differs || !(fabs(shown(a[j]) - shown(b[j])) <= 2.0 / 255.0);
        }
        off += differs;
    }
    return off;
}

static bool measure_scene(Stability *stability, const Options *options, const StudyScene *scene, const char *povray,
                          const char *folder)
{
    static const struct {
        const char *what;
        double scale, shift[3];
    } cases[BREAKS] = {
        {"as it is", 1.0, {0.0}},
        {"times 1e-3", 1e-3, {0.0}},
        {"times 1e-5", 1e-5, {0.0}},
        {"times 1e6", 1e6, {0.0}},
        {"times 1e7", 1e7, {0.0}},
        {"shifted by 1e8", 1.0, {1e8}},
        {"shifted by 1e6 along x", 1.0, {1e6}},
        {"shifted by 1e6 along y", 1.0, {0.0, 1e6}},
        {"shifted by 1e6 along z", 1.0, {0.0, 0.0, 1e6}},
    };
    const BreakRow *first = &stability->breaks[stability->break_count];
    for (size_t i = 0; i < BREAKS; i++) {
        BreakRow *row = &stability->breaks[stability->break_count];
        Motion motion = motion_none;
        motion.scale = cases[i].scale;
        memcpy(motion.shift, cases[i].shift, sizeof motion.shift);
        *row = (BreakRow){.scene = scene->name, .what = cases[i].what, .pixels = WIDTH * HEIGHT};
        const MotionPicture picture = {options, scene, &motion, WIDTH, HEIGHT};
        if (!motion_image(&picture, &row->ours)) {
            return i == 0; // what cannot be read is reported among the pictures
        }
        stability->break_count++;
        row->off = pixels_off(first->ours.values, row->ours.values);
        row->has_povray = povray && motion_povray(&picture, povray, folder, &row->povray);
        row->povray_off = row->has_povray ? pixels_off(first->ours.values, row->povray.values) : row->pixels;
    }
    return true;
}

bool stability_breaks(Stability *stability, const Options *options, const char *povray, const char *folder)
{
    stability->breaks = calloc(BREAKS * (1 + (size_t)options->scene_count), sizeof *stability->breaks);
    StudyScene own = {"three spheres", break_scene};
    bool fine = stability->breaks && measure_scene(stability, options, &own, povray, folder);
    for (int i = 0; fine && i < options->scene_count; i++) {
        StudyScene given = {options->scenes[i], NULL};
        fine = measure_scene(stability, options, &given, povray, folder);
    }
    return fine;
}
