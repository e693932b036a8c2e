// Tiles and threads: a picture is cut into tiles, each traced by whichever thread is free.
//
// A tile's pixels depend on the scene and its own place only, so the picture is the same for any number of threads.
//
// SPDX-License-Identifier: MIT
#include <pthread.h>
#include <sched.h>
#include <stdlib.h>
#include <unistd.h>

#include "render/kernel.h"
#include "render/prepared.h"
#include "render/render.h"

enum { TILE_SIZE = 32, THREADS_MAX = 1024 };

typedef struct Work {
    const Prepared *prepared;
    const RenderOptions *options;
    Film *film;
    int columns, tiles;
    atomic_int next, done;
    pthread_mutex_t lock; // of statistics
    RenderStatistics statistics;
} Work;

static Tile tile_at(const Work *work, int index)
{
    int left = index % work->columns * TILE_SIZE, top = index / work->columns * TILE_SIZE;
    int right = left + TILE_SIZE, bottom = top + TILE_SIZE;
    return (Tile){left, top, right < work->film->width ? right : work->film->width,
                  bottom < work->film->height ? bottom : work->film->height};
}

static void statistics_add(RenderStatistics *sum, const RenderStatistics *more)
{
    sum->camera_rays += more->camera_rays;
    sum->shadow_rays += more->shadow_rays;
    sum->reflected_rays += more->reflected_rays;
    sum->transmitted_rays += more->transmitted_rays;
}

static bool is_cancelled(const RenderOptions *options)
{
    return options->cancel && atomic_load_explicit(options->cancel, memory_order_relaxed);
}

static void trace_tiles(Work *work, bool reports)
{
    RenderStatistics sum = {0};
    for (int index; (index = atomic_fetch_add(&work->next, 1)) < work->tiles && !is_cancelled(work->options);) {
        RenderStatistics one;
        work->prepared->kernel->trace(work->prepared, tile_at(work, index), work->film, &one);
        statistics_add(&sum, &one);
        int done = atomic_fetch_add(&work->done, 1) + 1;
        if (reports && work->options->progress) {
            work->options->progress(work->options->client, (double)done / work->tiles);
        }
    }
    pthread_mutex_lock(&work->lock);
    statistics_add(&work->statistics, &sum);
    pthread_mutex_unlock(&work->lock);
}

static void *run_thread(void *work)
{
    trace_tiles(work, false);
    return NULL;
}

RenderResult render_film(const Prepared *prepared, const RenderOptions *options, Film *film,
                         RenderStatistics *statistics)
{
    Work work = {.prepared = prepared, .options = options, .film = film, .lock = PTHREAD_MUTEX_INITIALIZER};
    work.columns = (film->width + TILE_SIZE - 1) / TILE_SIZE;
    work.tiles = work.columns * ((film->height + TILE_SIZE - 1) / TILE_SIZE);
    int wanted = options->threads < work.tiles ? options->threads : work.tiles;
    pthread_t threads[THREADS_MAX];
    int started = 0;
    // The calling thread works too. One that cannot be started is done without.
    while (started < wanted - 1 && started < THREADS_MAX &&
           pthread_create(&threads[started], NULL, run_thread, &work) == 0) {
        started++;
    }
    trace_tiles(&work, true);
    for (int i = 0; i < started; i++) {
        pthread_join(threads[i], NULL);
    }
    pthread_mutex_destroy(&work.lock);
    *statistics = work.statistics;
    return atomic_load(&work.done) == work.tiles ? RENDER_OK : RENDER_CANCELLED;
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
