// What a thread works in while it renders: all that is too large for its stack, in one block that it owns.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SAMPLE_SCRATCH_H
#define RENDER_SAMPLE_SCRATCH_H

#include "render/sample/sampling.h"
#include "render/shade/shade_tile.h"

// A ray's share of light, by colour, and the one number that counts for alpha: a product of greys
// (render/sample/alpha.c).
typedef struct AlphaThrough {
    Rgb colour;
    double grey;
} AlphaThrough;

// The reference path's levels, of each of its types of numbers (render/reference/reference_kernel.h).
enum { STUDY_LEVEL_BYTES = 512 };

struct RenderScratch {
    RayStack rays;
    TileScratch tile;
    RoundScratch round;
    AlphaThrough through[RAY_STACK_MAX]; // of each ray of `rays`
    _Alignas(64) unsigned char study_levels[TRACE_LEVEL_MAX + 1][STUDY_LEVEL_BYTES];
    MediumNode nodes[RAY_STACK_NODES];   // rays.media
};

RenderScratch *scratch_new(void) RT_MUST_CHECK; // NULL when out of memory
void scratch_free(RenderScratch *scratch);

#endif
