// Records in memory and on their way to a file: see store.h.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "share/store.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "image/atomic_file.h"
#include "image/image_error.h"

bool store_init(Store *store)
{
    *store = (Store){.fd = -1};
    text_init(&store->added);
    return pthread_mutex_init(&store->lock, NULL) == 0;
}

void store_fini(Store *store)
{
    if (store->fd >= 0) {
        close(store->fd);
    }
    for (int i = 0; i < store->known_count; i++) {
        partial_fini(&store->known[i]);
    }
    partial_head_fini(&store->head);
    free(store->known);
    free(store->is_known);
    ARRAY_FREE(&store->records);
    ARRAY_FREE(&store->clocks);
    text_fini(&store->added);
    pthread_mutex_destroy(&store->lock);
}

bool store_know(Store *store, const Partial *files, int count)
{
    store->known = malloc((size_t)count * sizeof *store->known);
    if (!store->known) {
        return false;
    }
    memcpy(store->known, files, (size_t)count * sizeof *files);
    store->known_count = count;
    for (int i = 0; i < count; i++) {
        for (size_t k = 0; k < files[i].records.count; k++) {
            PartialRecord record = files[i].records.items[k];
            bool is_clock = record.tile == PARTIAL_CLOCK && record.length == sizeof(double);
            if (is_clock ? !ARRAY_PUSH(&store->clocks, record)
                         : record.tile < PARTIAL_TILES_MOST && !ARRAY_PUSH(&store->records, record)) {
                return false;
            }
        }
    }
    if (store->records.count > 0) {
        qsort(store->records.items, store->records.count, sizeof *store->records.items, partial_record_compare);
    }
    return true;
}

// ---- the file

static void append_known(const Store *store, TextBuffer *file)
{
    for (size_t i = 0; i < store->clocks.count; i++) {
        partial_append(file, &store->clocks.items[i]);
    }
    for (size_t i = 0; i < store->records.count; i++) {
        partial_append(file, &store->records.items[i]);
    }
}

static bool write_file(const TextBuffer *pieces[], int count, const char *path, ImageError *error)
{
    AtomicFile file;
    bool is_whole = atomic_file_open(&file, path, error);
    if (!is_whole) {
        return false;
    }
    for (int i = 0; is_whole && i < count; i++) {
        is_whole = atomic_file_write(&file, text_get(pieces[i]), pieces[i]->length, error);
    }
    if (!is_whole) {
        atomic_file_abandon(&file);
        return false;
    }
    return atomic_file_commit(&file, error);
}

// What was broken at the end of a checkpoint is gone with this.
bool store_keep(Store *store, const char *path, double seconds, ImageError *error)
{
    TextBuffer begin;
    const TextBuffer *pieces[] = {&begin};
    text_init(&begin);
    partial_append_head(&begin, &store->head);
    append_known(store, &begin);
    image_error_clear(error);
    error->no_memory = begin.failed;
    bool is_written = !begin.failed && write_file(pieces, 1, path, error);
    text_fini(&begin);
    if (!is_written) {
        return false;
    }
    store->path = path;
    store->interval = seconds;
    store->written_at = clock_seconds();
    store->fd = open(path, O_WRONLY | O_APPEND | O_CLOEXEC);
    if (store->fd < 0) {
        image_error_system(error, path, errno);
    }
    return store->fd >= 0;
}

static void flush(Store *store)
{
    store->written_at = clock_seconds();
    while (store->fd >= 0 && store->fault == STORE_FINE && store->written < store->added.length) {
        ssize_t count = write(store->fd, store->added.text + store->written, store->added.length - store->written);
        if (count < 0 && errno != EINTR) {
            store->fault = STORE_NOT_WRITTEN;
            store->error = errno;
        }
        store->written += count > 0 ? (size_t)count : 0;
    }
    if (!store->keeps_all && store->written == store->added.length) {
        text_clear(&store->added);
        store->written = 0;
    }
}

void store_flush(Store *store)
{
    pthread_mutex_lock(&store->lock);
    flush(store);
    pthread_mutex_unlock(&store->lock);
}

static void add(Store *store, const PartialRecord *record)
{
    if (store->fd < 0 && !store->keeps_all) {
        return;
    }
    pthread_mutex_lock(&store->lock);
    partial_append(&store->added, record);
    store->added_count++;
    store->fault = store->added.failed ? STORE_NO_MEMORY : store->fault;
    if (store->fd >= 0 && clock_seconds() - store->written_at >= store->interval) {
        flush(store);
    }
    pthread_mutex_unlock(&store->lock);
}

bool store_write_part(Store *store, const char *path, ImageError *error)
{
    TextBuffer begin, end;
    const TextBuffer *pieces[] = {&begin, &store->added, &end};
    uint32_t count = (uint32_t)(store->records.count + store->clocks.count + store->added_count);
    text_init(&begin);
    text_init(&end);
    partial_append_head(&begin, &store->head);
    append_known(store, &begin);
    partial_append(&end, &(PartialRecord){count, PARTIAL_END, NULL, 0});
    image_error_clear(error);
    error->no_memory = begin.failed || end.failed || store->added.failed;
    bool is_written = !error->no_memory && write_file(pieces, 3, path, error);
    text_fini(&begin);
    text_fini(&end);
    return is_written;
}

// ---- passes

// No run writes two records of a tile, or one of a tile that is not there.
int store_begin_pass(Store *store, int tiles)
{
    int count = 0;
    store->pass = store->passes++;
    free(store->is_known);
    store->is_known = NULL;
    for (store->first = store->end;
         store->first < store->records.count && store->records.items[store->first].pass < store->pass; store->first++) {
    }
    for (store->end = store->first;
         store->end < store->records.count && store->records.items[store->end].pass == store->pass; store->end++) {
    }
    if (store->end == store->first) {
        return 0;
    }
    store->is_known = calloc((size_t)tiles, 1);
    store->fault = store->is_known ? store->fault : STORE_NO_MEMORY;
    for (size_t i = store->first; store->is_known && i < store->end; i++) {
        uint32_t tile = store->records.items[i].tile;
        bool fits = tile < (uint32_t)tiles && !store->is_known[tile];
        store->fault = fits || store->fault ? store->fault : STORE_MISFIT;
        count += fits;
        store->is_known[fits ? tile : 0] = fits || store->is_known[0];
    }
    return count;
}

void store_add(Store *store, int tile, const unsigned char *bytes, size_t length)
{
    add(store, &(PartialRecord){store->pass, (uint32_t)tile, bytes, length});
}

// From the last known reading on, time passes as this process's clock shows it.
double store_seconds(Store *store, double own)
{
    double now = own - store->clock_behind;
    if (store->next_clock < store->clocks.count) {
        memcpy(&now, store->clocks.items[store->next_clock++].bytes, sizeof now);
        store->clock_behind = own - now;
    } else {
        add(store, &(PartialRecord){store->clock_count, PARTIAL_CLOCK, (const unsigned char *)&now, sizeof now});
    }
    store->clock_count++;
    return now;
}
