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

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/attributes.h"
#include "scene/scene.h"
#include "trace/trace.h"

typedef struct Prepared Prepared;

// What is left of a valid scene for rendering; refers to the scene, which must outlive it. The options say how geometry is
// prepared and traced. NULL when out of memory.
Prepared *prepared_new(const Scene *scene, const GeometryOptions *options) RT_MUST_CHECK;
void prepared_free(Prepared *prepared);

// Name of the kernel that was chosen, for example "spheres+shadows".
const char *prepared_kernel_name(const Prepared *prepared);

// A picture in the scene's working space: rows from the top, pixels from the left, red green blue each.
typedef struct Film {
    int width, height;
    float *rgb; // width * height * 3; owned
} Film;

bool film_init(Film *film, int width, int height) RT_MUST_CHECK; // false when out of memory; cleared to 0
void film_fini(Film *film);

typedef struct RenderStatistics {
    uint64_t camera_rays, shadow_rays, reflected_rays, transmitted_rays;
} RenderStatistics;

typedef struct RenderOptions {
    int threads; // >= 1; as many are used as there are tiles to share
    // Called now and then by one thread at a time with the part that is done, 0 to 1. May be NULL.
    void (*progress)(void *client, double done);
    void *client;
    const atomic_bool *cancel; // when it turns true, work stops soon; may be NULL
} RenderOptions;

typedef enum RenderResult { RENDER_OK, RENDER_CANCELLED, RENDER_NO_MEMORY } RenderResult;

RenderResult render_film(const Prepared *prepared, const RenderOptions *options, Film *film,
                         RenderStatistics *statistics) RT_MUST_CHECK;

// How many processors this process may use.
int render_default_threads(void);

#endif
