// Threads started, run and joined.
//
// SPDX-License-Identifier: MIT
#include "base/parallel.h"

#include <pthread.h>

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
    Worker workers[PARALLEL_THREADS_MAX];
    int started = 1;
    while (started < threads && started < PARALLEL_THREADS_MAX) {
        Worker *worker = &workers[started];
        *worker = (Worker){.work = work, .client = client, .number = started};
        if (pthread_create(&worker->thread, NULL, worker_run, worker) != 0) {
            break;
        }
        started++;
    }
    work(client, 0);
    for (int i = 1; i < started; i++) {
        pthread_join(workers[i].thread, NULL);
    }
    return started;
}
