// What the page has for those who ask why a pixel differs: a viewer of both pictures, the ray logs of pixels that differ
// most, and the scene's text.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_REPORT_RAYS_H
#define CHECK_REPORT_RAYS_H

#include <stdio.h>

#include "check/options.h"
#include "image/image.h"
#include "rtlang/rtlang.h"

// `number` distinguishes scenes; `session` has the scene loaded.
void report_rays(FILE *out, int number, const char *scene, const Options *options, rt_session *session,
                 const Image *ours, const Image *theirs);

#endif
