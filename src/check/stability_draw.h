// Pictures for --stability: a scene put elsewhere and drawn by rtlang or by POV-Ray.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_STABILITY_DRAW_H
#define CHECK_STABILITY_DRAW_H

#include "check/options.h"
#include "check/stability.h"
#include "rtlang/rtlang.h"

// A scene by its text, or, for NULL, by its name, which is that of a file.
typedef struct StudyScene {
    const char *name, *text;
} StudyScene;

// How a scene is put elsewhere.
typedef struct Motion {
    double scale, shift[3], camera; // camera: factor of its distance, 1: it stays
    rt_precision precision;
} Motion;

static const Motion motion_none = {1.0, {0.0, 0.0, 0.0}, 1.0, RT_PRECISION_DOUBLE};

// A picture of a scene that was put somewhere.
typedef struct MotionPicture {
    const Options *options;
    const StudyScene *scene;
    const Motion *motion;
    int width, height;
} MotionPicture;

// Its width x height x 3 values. False when the scene cannot be read, or the reference path refuses it.
bool motion_draw(const MotionPicture *picture, float *values);

// The same as an image that is the caller's.
bool motion_image(const MotionPicture *picture, Image *image);

// POV-Ray's picture of the scene after the motion. `folder` is one for temporary files.
bool motion_povray(const MotionPicture *picture, const char *povray, const char *folder, Image *image);

#endif
