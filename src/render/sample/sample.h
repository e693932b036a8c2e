// What is asked of sampling from outside of the renderer: memory, errors of pixels, threads. Part of render/render.h.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SAMPLE_SAMPLE_H
#define RENDER_SAMPLE_SAMPLE_H

#include <stddef.h>
#include <stdint.h>

#include "render/records/film.h"
#include "render/records/options.h"

// The bytes of the lists of small shapes that a sampled film may need, of so many shapes in all.
uint64_t small_bytes(int width, int height, uint64_t shapes);

// Those of the strata of pixels that edges of spheres cross, of so many shapes in all.
uint64_t share_bytes(int width, int height, uint64_t shapes);

// What a pixel of a sampled film is off by, root mean square in linear light, by its own samples.
double render_pixel_error(const Film *film, const SamplingError *error, size_t pixel);

// How many processors this process may use.
int render_default_threads(void);

#endif
