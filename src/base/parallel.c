// Threads started, run and joined.
//
// SPDX-License-Identifier: MIT
#include "base/parallel.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "base/stack.h"

typedef struct Worker {
    pthread_t thread;
    void (*work)(void *client, int number);
    void *client;
    int number;
} Worker;

static void *worker_run(void *argument)
{
    Worker *worker = argument;
    worker->work(worker->client, worker->number);
    return NULL;
}

int parallel_run(int threads, void (*work)(void *client, int number), void *client)
{
    int most = threads < PARALLEL_THREADS_MAX ? threads : PARALLEL_THREADS_MAX, started = 1;
    Worker *workers = most > 1 ? malloc((size_t)most * sizeof *workers) : NULL;
    while (workers && started < most) {
        Worker *worker = &workers[started];
        *worker = (Worker){.work = work, .client = client, .number = started};
        if (!stack_thread(&worker->thread, worker_run, worker)) {
            break;
        }
        started++;
    }
    work(client, 0);
    for (int i = 1; i < started; i++) {
        pthread_join(workers[i].thread, NULL);
    }
    free(workers);
    return started;
}

typedef struct Shared {
    size_t count, run;
    void (*work)(void *client, size_t begin, size_t end);
    void *client;
    atomic_size_t next;
} Shared;

static void shared_work(void *client, int number)
{
    Shared *shared = client;
    (void)number;
    for (size_t begin; (begin = atomic_fetch_add(&shared->next, shared->run)) < shared->count;) {
        size_t left = shared->count - begin;
        shared->work(shared->client, begin, begin + (left < shared->run ? left : shared->run));
    }
}

void parallel_share(int threads, size_t count, size_t run, void (*work)(void *client, size_t begin, size_t end),
                    void *client)
{
    Shared shared = {.count = count, .run = run, .work = work, .client = client};
    size_t runs = (count + run - 1) / run;
    parallel_run(runs < (size_t)threads ? (int)runs : threads, shared_work, &shared);
}
