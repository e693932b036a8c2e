// One ray through the middle of each pixel, and the choice between that, anti-aliasing and sampling.
//
// SPDX-License-Identifier: MIT
#include "render/records/prepared.h"
#include "render/render.h"
#include "render/sample/alpha.h"
#include "render/sample/antialias.h"
#include "render/sample/sampling.h"
#include "render/sample/tiles.h"

typedef struct Single {
    const Prepared *prepared;
    const RenderOptions *options;
    Film *film;
    atomic_bool has_no_memory;
} Single;

RT_ALWAYS_INLINE void store_row(const Rgb *light, int count, float *pixels)
{
    for (int i = 0; i < count; i++) {
        pixels[3 * i] = (float)light[i].red;
        pixels[3 * i + 1] = (float)light[i].green;
        pixels[3 * i + 2] = (float)light[i].blue;
    }
}

static void trace_block(const Single *single, Tile block, RenderScratch *scratch, RenderStatistics *counted)
{
    Film *film = single->film;
    KernelPlaces places;
    Rgb light[KERNEL_RAYS];
    double clear[KERNEL_RAYS];
    places.lens = NULL;
    uint64_t wanted = block_places(film, block, 0.0, &places);
    const KernelCall call = {&places, wanted, NULL, light, scratch, counted};
    alpha_trace(single->prepared, &call, clear);
    int columns = block.right - block.left;
    for (int y = block.top; y < block.bottom; y++) {
        int first = (y - block.top) * KERNEL_ROW;
        size_t at = (size_t)y * (size_t)film->width + (size_t)block.left;
        if (columns == KERNEL_ROW) { // almost always: a constant
            store_row(&light[first], KERNEL_ROW, &film->rgb[3 * at]);
        } else {
            store_row(&light[first], columns, &film->rgb[3 * at]);
        }
        float *background = film_background(film);
        for (int i = 0; background && i < columns; i++) {
            background[at + (size_t)i] = (float)clear[first + i];
        }
    }
}

static void trace_tile(void *client, Tile tile, RenderScratch *scratch, RenderStatistics *counted)
{
    Single *single = client;
    if (single->options->antialias) {
        if (!antialias_tile(single->prepared, single->options->antialias, tile, single->film, scratch, counted)) {
            atomic_store(&single->has_no_memory, true);
        }
        return;
    }
    for (int top = tile.top; top < tile.bottom; top += KERNEL_ROW) {
        for (int left = tile.left; left < tile.right; left += KERNEL_ROW) {
            trace_block(single, tile_block(tile, left, top), scratch, counted);
        }
    }
}

static void code_tile(void *client, Tile tile, TileBytes *bytes)
{
    const Single *single = client;
    tile_bytes_light(bytes, single->film, tile);
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
    prepared->abandon->cancel = options->cancel;
    atomic_store(&prepared->abandon->keeps, false);
    if (options->sampling) {
        return sampling_run(prepared, options, film, statistics, error);
    }
    Single single = {.prepared = prepared, .options = options, .film = film};
    TileWork work = {.client = &single,
                     .prepared = prepared,
                     .width = film->width,
                     .height = film->height,
                     .trace = trace_tile,
                     .progress = options->progress ? forward_progress : NULL,
                     .code = code_tile,
                     .is_last = true};
    RenderResult result = tiles_run(&work, options, statistics);
    return atomic_load(&single.has_no_memory) ? RENDER_NO_MEMORY : result;
}
