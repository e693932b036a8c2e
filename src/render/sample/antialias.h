// Anti-aliasing as POV-Ray 3.7 does it without jitter, so that pictures made with `+A -J` can be compared.
//
// Both methods take more rays where colours differ, and both are as measured: docs/language.md, "Anti-aliasing". A tile
// follows from the scene, the size of the picture and its own place. Knows nothing of threads.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SAMPLE_ANTIALIAS_H
#define RENDER_SAMPLE_ANTIALIAS_H

#include "render/records/film.h"
#include "render/records/kernel.h"
#include "render/records/options.h"

// The pixels of a tile of at most TILE_SIZE a side, into the film. False when out of memory.
bool antialias_tile(const Prepared *prepared, const AntialiasOptions *options, Tile tile, Film *film,
                    RenderScratch *scratch, RenderStatistics *counted) RT_MUST_CHECK;

#endif
