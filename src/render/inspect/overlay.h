// What is drawn over the light of a picture: lines around shapes, and far things turned to one colour (depth cue).
//
// Both follow from what surface is seen, apart from the light, by rays through the middles of pixels, and through
// OVERLAY_PARTS by OVERLAY_PARTS places of those where neighbours differ. A pixel depends on its surroundings in the
// whole picture only, so parts of pictures, tiles and threads change nothing. There is no chance in it: the light's
// error is no more than it was.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_INSPECT_OVERLAY_H
#define RENDER_INSPECT_OVERLAY_H

#include "math/colour.h"
#include "render/records/film.h"
#include "render/records/options.h"
#include "scene/scene.h"

enum { OVERLAY_PARTS = 4, OUTLINE_WIDEST = 16 };

typedef struct OverlayOptions {
    double outline_width; // in pixels, up to OUTLINE_WIDEST; 0: no lines
    Rgb outline_color;    // of linear light, as the film is by then
    double cue_strength;  // how much of the colour is at cue_far and beyond, up to 1; 0: no depth cue
    Rgb cue_color;
    double cue_near, cue_far; // along the camera's direction, in the scene's lengths; both 0: see overlay_find_reach
} OverlayOptions;

static inline bool overlay_is_wanted(const OverlayOptions *options)
{
    return options->outline_width > 0.0 || options->cue_strength > 0.0;
}

// Sets the depths of a cue that has none to those that the scene's shapes reach, before the scene is given up for its
// picture.
void overlay_find_reach(OverlayOptions *options, const Scene *scene);

// Draws over a film, and covers what is behind the scene with lines. Not to be cancelled: pictures that are shown early
// have lines, too.
RenderResult render_overlay(const Prepared *prepared, int threads, const OverlayOptions *options,
                            Film *film) RT_MUST_CHECK;

#endif
