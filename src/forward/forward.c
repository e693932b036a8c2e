// Photons, by chunks that are shared among threads; what arrives is added in whole numbers, so that order does not
// matter.
//
// SPDX-License-Identifier: MIT
#include "forward/forward.h"

#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "forward/photon.h"
#include "render/records/linear.h"
#include "render/records/prepared.h"

enum { CHUNK = 1 << 14 };

uint64_t forward_bytes(int width, int height)
{
    return (uint64_t)width * (uint64_t)height * (sizeof(PixelRecord) + 6 * sizeof(int_least64_t));
}

const char *forward_misfit(const Prepared *prepared, const ForwardOptions *options)
{
    const PreparedCamera *camera = &prepared->camera;
    const unsigned unknown =
        (unsigned)RENDER_PIGMENTS | RENDER_TEXTURES | RENDER_NORMALS | RENDER_INTERIORS | RENDER_TRANSPARENCY | RENDER_EXPONENT;
    if (scene_has_haze(prepared->scene)) {
        return "fog or a rainbow";
    }
    if (prepared->features & unknown) {
        return "patterns, bumps, layers, interiors, transparency, or reflection with an exponent";
    }
    if (camera->type != CAMERA_PERSPECTIVE || vec3_dot(camera->direction, camera->right) != 0.0 ||
        vec3_dot(camera->direction, camera->up) != 0.0 || vec3_dot(camera->right, camera->up) != 0.0) {
        return "a camera that is not perspective with direction, right and up at right angles";
    }
    if (!options->connects && !(camera->lens_radius > 0.0)) {
        return "a camera without `aperture`, which no photon can hit";
    }
    if (prepared->has_dome) {
        return "light from all sides";
    }
    if (prepared->textures.is_lit_apart) {
        return "groups of lights, and surfaces that are lit from both sides";
    }
    if (prepared->light_count == 0) {
        return "a scene without light sources";
    }
    for (size_t i = 0; i < prepared->light_count; i++) {
        const PreparedLight *light = &prepared->lights[i];
        if (light->parallel || light->shadowless) {
            return "lights whose rays are parallel, or that are `shadowless`";
        }
        if (light->area.is_oriented) {
            return "area lights with `orient`, which are turned otherwise for each point";
        }
    }
    for (size_t i = 0; i < prepared->finish_count; i++) {
        if (prepared->finishes[i].diffuse_back > 0.0) {
            return "surfaces that let diffuse light through";
        }
        if (prepared->finishes[i].is_special) {
            return "`crand` and `irid`";
        }
    }
    for (size_t i = 0; i < prepared->scene->primitives.count; i++) {
        if (prepared->scene->primitives.items[i].hidden) {
            return "objects that some rays do not see";
        }
    }
    return NULL;
}

typedef struct Forward {
    const Prepared *prepared;
    const ForwardOptions *options;
    PhotonFilm film;
    uint64_t chunks;
    atomic_uint_fast64_t next, done;
    atomic_uint_fast64_t met, arrived;
} Forward;

static bool is_cancelled(const ForwardOptions *options)
{
    return options->cancel && atomic_load_explicit(options->cancel, memory_order_relaxed);
}

// Chunks go to the halves by turns.
static void trace_chunks(void *client, int thread)
{
    Forward *forward = client;
    const ForwardOptions *options = forward->options;
    uint64_t chunk, met = 0, arrived = 0;
    while ((chunk = atomic_fetch_add(&forward->next, 1)) < forward->chunks && !is_cancelled(options)) {
        uint64_t begin = chunk * CHUNK, end = begin + CHUNK < options->photons ? begin + CHUNK : options->photons;
        for (uint64_t i = begin; i < end; i++) {
            Photon photon = {
                .seed = options->seed, .number = i, .half = (unsigned)(chunk & 1), .connects = options->connects};
            photon_trace(forward->prepared, &photon, &forward->film);
            met += photon.met;
            arrived += photon.arrived;
        }
        uint64_t done = atomic_fetch_add(&forward->done, 1) + 1;
        if (thread == 0 && options->progress) {
            options->progress(options->client, (double)done / (double)forward->chunks);
        }
    }
    atomic_fetch_add(&forward->met, met);
    atomic_fetch_add(&forward->arrived, arrived);
}

// How many photons each half has.
static void halves_count(const Forward *forward, double halves[2])
{
    uint64_t photons = forward->options->photons, whole = photons / CHUNK;
    halves[0] = (double)((whole + 1) / 2 * CHUNK);
    halves[1] = (double)(whole / 2 * CHUNK);
    halves[whole & 1] += (double)(photons % CHUNK);
}

// The film, and its error from how far the halves are apart; that of one chunk is not known.
static void film_finish(const Forward *forward, Film *film, SamplingError *error)
{
    const double normal = 1.96;
    size_t pixels = (size_t)film->width * (size_t)film->height;
    double halves[2], sum = 0.0, squares = 0.0;
    halves_count(forward, halves);
    double all = halves[0] + halves[1];
    for (size_t i = 0; i < pixels; i++) {
        double apart[3];
        for (size_t c = 0; c < 3; c++) {
            double first = photon_film_value(&forward->film, 0, 3 * i + c);
            double second = photon_film_value(&forward->film, 1, 3 * i + c);
            film->rgb[3 * i + c] = (float)((first + second) / all);
            apart[c] = halves[1] > 0.0 ? first / halves[0] - second / halves[1] : 0.0;
        }
        Rgb slope = linear_slope(&forward->prepared->scene->settings, &film->rgb[3 * i]);
        double red = apart[0] * slope.red, green = apart[1] * slope.green, blue = apart[2] * slope.blue;
        double square = halves[0] * halves[1] / (all * all) * (red * red + green * green + blue * blue) / 3.0;
        film->records[i] = (PixelRecord){.count = 1, .outer = (float)square};
        sum += square;
        squares += square * square;
    }
    // Squares of normal errors: see render/sample/sampling_estimate.c.
    double spread = sum > 0.0 ? exp(0.5 * normal * sqrt(4.0 / 3.0 * squares) / sum) : 1.0;
    double rmse = sqrt(sum / (double)pixels);
    *error = (SamplingError){.is_known = halves[1] > 0.0,
                             .rmse = rmse,
                             .low = rmse / spread,
                             .high = rmse * spread,
                             .samples = all / (double)pixels,
                             .slope = -0.5};
}

RenderResult forward_film(const Prepared *prepared, const ForwardOptions *options, Film *film, SamplingError *error,
                          ForwardCounts *counts)
{
    Forward forward = {.prepared = prepared, .options = options, .chunks = (options->photons + CHUNK - 1) / CHUNK};
    *error = (SamplingError){0};
    *counts = (ForwardCounts){0};
    film->records = calloc((size_t)film->width * (size_t)film->height, sizeof *film->records);
    if (!film->records || !photon_film_init(&forward.film, prepared, film)) {
        return RENDER_NO_MEMORY;
    }
    uint64_t threads = (uint64_t)options->threads < forward.chunks ? (uint64_t)options->threads : forward.chunks;
    parallel_run((int)threads, trace_chunks, &forward);
    bool is_whole = atomic_load(&forward.done) == forward.chunks;
    if (is_whole) {
        film_finish(&forward, film, error);
        *counts = (ForwardCounts){options->photons, atomic_load(&forward.met), atomic_load(&forward.arrived)};
    }
    photon_film_fini(&forward.film);
    return is_whole ? RENDER_OK : RENDER_CANCELLED;
}
