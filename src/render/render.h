// The renderer: a scene becomes a film of linear light.
//
// prepared_new turns scene records into everything that rays need, once: lengths scaled by an exact power of two,
// geometry built, materials and lights reduced to what shading uses, and the smallest kernel chosen that covers the
// scene's features. render_film then traces tiles on all threads. Same scene and size, same bits: for any number of
// threads and any order of tiles. Knows nothing of the language or of files.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_RENDER_H
#define RENDER_RENDER_H

#include <stddef.h>
#include <stdint.h>

#include "base/attributes.h"
#include "render/inspect/planes.h"
#include "render/records/film.h"
#include "render/records/options.h"
#include "render/records/tile_share.h"
#include "render/sample/sample.h"
#include "scene/scene.h"
#include "trace/trace.h"

// What is left of a valid scene for rendering; refers to the scene, which must outlive it. The options say how geometry
// is prepared and traced. NULL when out of memory.
Prepared *prepared_new(const Scene *scene, const GeometryOptions *options) RT_MUST_CHECK;
void prepared_free(Prepared *prepared);
// Other numbers for the `jitter` of area lights, 0 being those of the beginning.
void prepared_seed(Prepared *prepared, uint64_t seed);
// Films get FILM_BACKGROUND from here on.
void prepared_want_alpha(Prepared *prepared);

// Name of the kernel that was chosen, for example "spheres+shadows".
const char *prepared_kernel_name(const Prepared *prepared);
// The TraceFeature and RenderFeature bits (trace/trace.h, render/records/kernel.h) that the scene needs.
unsigned prepared_features(const Prepared *prepared);
size_t prepared_geometry_bytes(const Prepared *prepared);

// How threads ask other processes, of a scene that is shared (GeometryOptions.is_shared).
TileAsking prepared_asking(const Prepared *prepared);

// `error` is set when options->sampling is, and a cancelled run then leaves a picture, if each pixel has a sample
// (error->samples > 0).
RenderResult render_film(const Prepared *prepared, const RenderOptions *options, Film *film,
                         RenderStatistics *statistics, SamplingError *error) RT_MUST_CHECK;

#endif
