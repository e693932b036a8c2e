// One ray through the middle of each pixel, and the choice between that, anti-aliasing and sampling.
//
// SPDX-License-Identifier: MIT
#include "render/alpha.h"
#include "render/antialias.h"
#include "render/prepared.h"
#include "render/sampling.h"
#include "render/tiles.h"

typedef struct Single {
    const Prepared *prepared;
    const RenderOptions *options;
    Film *film;
    atomic_bool has_no_memory;
} Single;

// Where the rays of a beam go through the picture; where it is cut off, its last ones are traced again.
static uint64_t beam_places(const Film *film, Tile tile, KernelPlaces *places)
{
    double across[KERNEL_ROW], down[KERNEL_ROW];
    uint64_t wanted = 0;
    int columns = tile.right - tile.left < KERNEL_ROW ? tile.right - tile.left : KERNEL_ROW;
    int rows = tile.bottom - tile.top < KERNEL_ROW ? tile.bottom - tile.top : KERNEL_ROW;
    for (int i = 0; i < KERNEL_ROW; i++) {
        across[i] = film_u(film, tile.left + (i < columns ? i : columns - 1), 0.0);
        down[i] = film_v(film, tile.top + (i < rows ? i : rows - 1), 0.0);
    }
    for (int row = 0; row < KERNEL_ROW; row++) {
        for (int i = 0; i < KERNEL_ROW; i++) {
            places->u[row * KERNEL_ROW + i] = across[i];
            places->v[row * KERNEL_ROW + i] = down[row];
        }
        wanted |= row < rows ? ((UINT64_C(1) << columns) - 1) << (row * KERNEL_ROW) : 0;
    }
    return wanted;
}

// The pixels of one beam.
static void trace_beam(const Single *single, Tile tile, RenderStatistics *counted)
{
    Film *film = single->film;
    KernelPlaces places;
    Rgb light[KERNEL_RAYS];
    double clear[KERNEL_RAYS];
    places.lens = NULL;
    uint64_t wanted = beam_places(film, tile, &places);
    alpha_trace(single->prepared, &places, NULL, wanted, light, clear, counted);
    for (int y = tile.top; y < tile.bottom && y < tile.top + KERNEL_ROW; y++) {
        const Rgb *row = &light[(y - tile.top) * KERNEL_ROW];
        float *pixel = &film->rgb[3 * ((size_t)y * (size_t)film->width + (size_t)tile.left)];
        for (int i = 0; i < KERNEL_ROW && tile.left + i < tile.right; i++) {
            pixel[3 * i] = (float)row[i].red;
            pixel[3 * i + 1] = (float)row[i].green;
            pixel[3 * i + 2] = (float)row[i].blue;
            if (film->clear) {
                size_t at = (size_t)y * (size_t)film->width + (size_t)(tile.left + i);
                film->clear[at] = (float)clear[(y - tile.top) * KERNEL_ROW + i];
            }
        }
    }
}

static void trace_tile(void *client, Tile tile, RenderStatistics *counted)
{
    Single *single = client;
    if (single->options->antialias) {
        if (!antialias_tile(single->prepared, single->options->antialias, tile, single->film, counted)) {
            atomic_store(&single->has_no_memory, true);
        }
        return;
    }
    for (int top = tile.top; top < tile.bottom; top += KERNEL_ROW) {
        for (int left = tile.left; left < tile.right; left += KERNEL_ROW) {
            trace_beam(single, (Tile){left, top, tile.right, tile.bottom}, counted);
        }
    }
}

static void forward_progress(void *client, double done)
{
    const Single *single = client;
    single->options->progress(single->options->client, &(RenderProgress){.done = done, .seconds_left = -1.0});
}

RenderResult render_film(const Prepared *prepared, const RenderOptions *options, Film *film,
                         RenderStatistics *statistics, SamplingError *error)
{
    *statistics = (RenderStatistics){0};
    *error = (SamplingError){0};
    if (options->sampling) {
        return sampling_run(prepared, options, film, statistics, error);
    }
    Single single = {.prepared = prepared, .options = options, .film = film};
    TileWork work = {&single, film->width, film->height, trace_tile, options->progress ? forward_progress : NULL};
    bool is_whole = tiles_run(&work, options, statistics);
    return atomic_load(&single.has_no_memory) ? RENDER_NO_MEMORY : is_whole ? RENDER_OK : RENDER_CANCELLED;
}
