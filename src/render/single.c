// One ray through the middle of each pixel, and the choice between that, anti-aliasing and sampling.
//
// SPDX-License-Identifier: MIT
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

// The pixels of one beam; where it is cut off, its last ones are traced again.
static void trace_beam(const Single *single, Tile tile, RenderStatistics *counted)
{
    Film *film = single->film;
    KernelPlaces places = {.lens = NULL};
    Rgb light[KERNEL_RAYS];
    double across[KERNEL_ROW], down[KERNEL_ROW];
    uint64_t wanted = 0;
    for (int i = 0; i < KERNEL_ROW; i++) {
        int x = tile.left + i < tile.right ? tile.left + i : tile.right - 1;
        int y = tile.top + i < tile.bottom ? tile.top + i : tile.bottom - 1;
        across[i] = film_u(film, x, 0.0);
        down[i] = film_v(film, y, 0.0);
    }
    for (int i = 0; i < KERNEL_RAYS; i++) {
        int x = tile.left + i % KERNEL_ROW, y = tile.top + i / KERNEL_ROW;
        places.u[i] = across[i % KERNEL_ROW];
        places.v[i] = down[i / KERNEL_ROW];
        wanted |= (uint64_t)(x < tile.right && y < tile.bottom) << i;
    }
    single->prepared->kernel->trace(single->prepared, &places, NULL, wanted, light, counted);
    for (; wanted; wanted &= wanted - 1) {
        int i = __builtin_ctzll(wanted);
        size_t pixel = (size_t)(tile.top + i / KERNEL_ROW) * (size_t)film->width + (size_t)(tile.left + i % KERNEL_ROW);
        film->rgb[3 * pixel] = (float)light[i].red;
        film->rgb[3 * pixel + 1] = (float)light[i].green;
        film->rgb[3 * pixel + 2] = (float)light[i].blue;
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
