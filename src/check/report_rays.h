// What the page has for those who ask why a pixel differs: a viewer of both pictures, the ray logs of pixels that
// differ most, and the scene's text.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_REPORT_RAYS_H
#define CHECK_REPORT_RAYS_H

#include <stdio.h>

#include "check/options.h"
#include "image/image.h"
#include "rtlang/rtlang.h"

// What both programs made of a scene, which `session` has loaded.
typedef struct ComparedScene {
    int number; // distinguishes scenes of a report
    const char *scene;
    rt_session *session;
    const Image *ours, *theirs;
} ComparedScene;

void report_rays(FILE *out, const ComparedScene *compared, const Options *options);

#endif
