// Tiles and threads: a picture is cut into tiles, each traced by whichever thread is free.
//
// A tile's pixels depend on the scene and its own place only, so the picture is the same for any number of threads.
//
// SPDX-License-Identifier: MIT
#include "render/sample/tiles.h"

#include <pthread.h>
#include <sched.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/parallel.h"
#include "render/records/prepared.h"
#include "render/sample/scratch.h"

typedef struct Run {
    const TileWork *work;
    const RenderOptions *options;
    int columns, tiles;
    atomic_int next, done;
    pthread_mutex_t lock; // of statistics
    RenderStatistics statistics;
} Run;

uint64_t block_places(const Film *film, Tile block, double aside, KernelPlaces *places)
{
    double across[KERNEL_ROW], down[KERNEL_ROW];
    uint64_t own = 0;
    int columns = block.right - block.left, rows = block.bottom - block.top;
    for (int i = 0; i < KERNEL_ROW; i++) {
        across[i] = film_u(film, block.left + (i < columns ? i : columns - 1), aside);
        down[i] = film_v(film, block.top + (i < rows ? i : rows - 1), aside);
    }
    for (int row = 0; row < KERNEL_ROW; row++) {
        for (int i = 0; i < KERNEL_ROW; i++) {
            places->u[row * KERNEL_ROW + i] = across[i];
            places->v[row * KERNEL_ROW + i] = down[row];
        }
        own |= row < rows ? ((UINT64_C(1) << columns) - 1) << (row * KERNEL_ROW) : 0;
    }
    return own;
}

static Tile tile_at(const Run *run, int index)
{
    int left = index % run->columns * TILE_SIZE, top = index / run->columns * TILE_SIZE;
    int right = left + TILE_SIZE, bottom = top + TILE_SIZE;
    return (Tile){left, top, right < run->work->width ? right : run->work->width,
                  bottom < run->work->height ? bottom : run->work->height};
}

void statistics_add(RenderStatistics *sum, const RenderStatistics *more)
{
    sum->camera_rays += more->camera_rays;
    sum->shadow_rays += more->shadow_rays;
    sum->reflected_rays += more->reflected_rays;
    sum->transmitted_rays += more->transmitted_rays;
    sum->cut_by_level += more->cut_by_level;
    sum->cut_by_weight += more->cut_by_weight;
}

static bool is_cancelled(const RenderOptions *options)
{
    return options->cancel && atomic_load_explicit(options->cancel, memory_order_relaxed);
}

static void trace_tiles(void *client, int thread)
{
    Run *run = client;
    RenderStatistics sum = {0};
    RenderScratch *scratch = scratch_new();
    if (!scratch) {
        return;
    }
    for (int index; (index = atomic_fetch_add(&run->next, 1)) < run->tiles && !is_cancelled(run->options);) {
        run->work->trace(run->work->client, tile_at(run, index), scratch, &sum);
        if (prepared_is_abandoned(run->work->prepared)) {
            break; // rays of the tile were left out
        }
        int done = atomic_fetch_add(&run->done, 1) + 1;
        if (thread == 0 && run->work->progress) {
            run->work->progress(run->work->client, (double)done / run->tiles);
        }
    }
    scratch_free(scratch);
    pthread_mutex_lock(&run->lock);
    statistics_add(&run->statistics, &sum);
    pthread_mutex_unlock(&run->lock);
}

RenderResult tiles_run(const TileWork *work, const RenderOptions *options, RenderStatistics *statistics)
{
    Run run = {.work = work, .options = options, .lock = PTHREAD_MUTEX_INITIALIZER};
    run.columns = (work->width + TILE_SIZE - 1) / TILE_SIZE;
    run.tiles = run.columns * ((work->height + TILE_SIZE - 1) / TILE_SIZE);
    parallel_run(options->threads < run.tiles ? options->threads : run.tiles, trace_tiles, &run);
    pthread_mutex_destroy(&run.lock);
    statistics_add(statistics, &run.statistics);
    return atomic_load(&run.done) == run.tiles ? RENDER_OK
           : is_cancelled(options)             ? RENDER_CANCELLED
                                               : RENDER_NO_MEMORY;
}

int render_default_threads(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0 && CPU_COUNT(&set) > 0) {
        return CPU_COUNT(&set);
    }
    long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online > 0 ? (int)online : 1;
}
