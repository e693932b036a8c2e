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

#include "base/clock.h"
#include "base/parallel.h"
#include "render/records/prepared.h"
#include "render/sample/scratch.h"

typedef struct Run {
    const TileWork *work;
    const RenderOptions *options;
    const TileShare *share;     // NULL: the pass is not shared
    int columns, tiles, before; // tiles that were traced before
    double start;
    atomic_int next, done, tracing; // tiles, tiles and threads
    atomic_bool has_failed;         // for want of memory
    pthread_mutex_t lock;           // of statistics
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

static int next_tile(Run *run)
{
    if (run->share) {
        return run->share->next(run->share->client);
    }
    int index = atomic_fetch_add(&run->next, 1);
    return index < run->tiles ? index : -1;
}

// ---- what other processes are to know of a tile

static void code_tile(const Run *run, int index, RenderStatistics *counted, TileBytes *bytes)
{
    tile_bytes_code(bytes, counted, sizeof *counted);
    run->work->code(run->work->client, tile_at(run, index), bytes);
}

static void give_tile(Run *run, int index, RenderStatistics *counted)
{
    TileBytes bytes = {.way = TILE_BYTES_WRITE};
    code_tile(run, index, counted, &bytes);
    if (bytes.failed) {
        atomic_store(&run->has_failed, true);
    } else {
        run->share->give(run->share->client, index, bytes.data, bytes.length);
    }
    tile_bytes_fini(&bytes);
}

static bool take_tile(void *client, int index, const unsigned char *data, size_t length)
{
    Run *run = client;
    RenderStatistics counted = {0};
    TileBytes expected = {.way = TILE_BYTES_COUNT};
    TileBytes bytes = {.way = TILE_BYTES_READ, .data = (unsigned char *)data, .length = length};
    if (index < 0 || index >= run->tiles) {
        return false;
    }
    code_tile(run, index, &counted, &expected);
    if (expected.length != length) {
        return false;
    }
    code_tile(run, index, &counted, &bytes);
    statistics_add(&run->statistics, &counted);
    atomic_fetch_add(&run->done, 1);
    return !bytes.failed;
}

static void tell_done(void *client, int tiles)
{
    const Run *run = client;
    if (run->work->progress) {
        run->work->progress(run->work->client, (double)tiles / run->tiles);
    }
}

static bool is_to_stop(void *client)
{
    Run *run = client;
    return is_cancelled(run->options) || atomic_load(&run->has_failed);
}

// While one thread serves, others trace: where none could be started, nothing would ever end.
static bool is_to_stop_serving(void *client)
{
    enum { SECONDS_TO_START = 10 };
    Run *run = client;
    if (atomic_load(&run->tracing) == 0 && clock_seconds() - run->start > SECONDS_TO_START) {
        atomic_store(&run->has_failed, true);
    }
    return is_to_stop(run);
}

// ---- threads

// False: the tile is not done.
static bool trace_tile(Run *run, int index, RenderScratch *scratch, RenderStatistics *counted)
{
    TileSettled settled;
    do {
        *counted = (RenderStatistics){0};
        run->work->trace(run->work->client, tile_at(run, index), scratch, counted);
        if (prepared_is_abandoned(run->work->prepared)) {
            return false; // rays of the tile were left out
        }
        settled = run->share && run->share->settle ? run->share->settle(run->share->client) : TILE_SETTLED;
    } while (settled == TILE_AGAIN);
    return settled == TILE_SETTLED;
}

static void trace_tiles(void *client, int thread)
{
    Run *run = client;
    RenderStatistics sum = {0};
    if (thread == 0 && run->share && run->share->serves) {
        run->share->serve(run->share->client, tell_done, is_to_stop_serving, run);
        return;
    }
    RenderScratch *scratch = scratch_new();
    if (!scratch) {
        return;
    }
    atomic_fetch_add(&run->tracing, 1);
    for (int index; !is_to_stop(run) && (index = next_tile(run)) >= 0;) {
        RenderStatistics own;
        if (!trace_tile(run, index, scratch, &own)) {
            break;
        }
        statistics_add(&sum, &own);
        if (run->share) {
            give_tile(run, index, &own);
        }
        int done = atomic_fetch_add(&run->done, 1) + 1;
        if (thread == 0) {
            tell_done(run, run->before + done);
        }
    }
    scratch_free(scratch);
    pthread_mutex_lock(&run->lock);
    statistics_add(&run->statistics, &sum);
    pthread_mutex_unlock(&run->lock);
}

static RenderResult end_shared(Run *run)
{
    const TileShare *share = run->share;
    bool is_stopped = is_to_stop(run);
    TileShareResult result = share->end(share->client, is_stopped, take_tile, run);
    return atomic_load(&run->has_failed)                                             ? RENDER_NO_MEMORY
           : result == TILE_SHARE_BROKEN                                             ? RENDER_NOT_SHARED
           : result == TILE_SHARE_STOPPED                                            ? RENDER_CANCELLED
           : result == TILE_SHARE_ELSEWHERE || atomic_load(&run->done) == run->tiles ? RENDER_OK
           : is_stopped                                                              ? RENDER_CANCELLED
                                                                                     : RENDER_NO_MEMORY;
}

static RenderResult run_shared(Run *run)
{
    const TileShare *share = run->share = run->options->share;
    int threads = run->options->threads < run->tiles ? run->options->threads : run->tiles;
    run->before = share->begin(share->client, run->tiles, run->work->is_last);
    run->start = clock_seconds();
    parallel_run(threads + share->serves, trace_tiles, run);
    return end_shared(run);
}

static RenderResult run_alone(Run *run)
{
    parallel_run(run->options->threads < run->tiles ? run->options->threads : run->tiles, trace_tiles, run);
    return atomic_load(&run->done) == run->tiles ? RENDER_OK
           : is_cancelled(run->options)          ? RENDER_CANCELLED
                                                 : RENDER_NO_MEMORY;
}

RenderResult tiles_run(const TileWork *work, const RenderOptions *options, RenderStatistics *statistics)
{
    Run run = {.work = work, .options = options, .lock = PTHREAD_MUTEX_INITIALIZER};
    run.columns = (work->width + TILE_SIZE - 1) / TILE_SIZE;
    run.tiles = run.columns * ((work->height + TILE_SIZE - 1) / TILE_SIZE);
    RenderResult result = options->share && work->code ? run_shared(&run) : run_alone(&run);
    pthread_mutex_destroy(&run.lock);
    statistics_add(statistics, &run.statistics);
    return result;
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
