// What is known of a picture's tiles from before, and the file in which more of them are kept.
//
// Known records are those of parts or of a checkpoint. What is added is kept for a part's file, and written now and
// then to a checkpoint's, each record once, at its end: a process that is killed leaves all but what it had not
// written.
//
// SPDX-License-Identifier: MIT
#ifndef SHARE_STORE_H
#define SHARE_STORE_H

#include <pthread.h>
#include <stdatomic.h>

#include "image/image.h"
#include "share/partial.h"

typedef enum StoreFault {
    STORE_FINE,
    STORE_NO_MEMORY,
    STORE_MISFIT,     // what a record holds, no tile can have left
    STORE_NOT_WRITTEN // `error` says why
} StoreFault;

typedef struct Store {
    PartialHead head; // of what is written; owned
    Partial *known;   // as many files; owned
    int known_count;
    PartialRecords records; // of all of them, by pass and tile, but for …
    PartialRecords clocks;  // … the readings of the clock, in their order
    size_t next_clock;
    uint32_t clock_count; // readings so far
    double clock_behind;  // of that of this process
    // The pass.
    uint32_t pass, passes;
    size_t first, end;       // of its records
    unsigned char *is_known; // of each tile; owned
    // What is added.
    pthread_mutex_t lock;
    TextBuffer added;
    size_t written, added_count; // of its bytes, and its records
    bool keeps_all;              // for store_write_part
    const char *path;            // of the checkpoint; the caller's; NULL: none
    int fd;
    double interval, written_at; // seconds
    _Atomic(StoreFault) fault;   // the first
    int error;                   // errno
} Store;

// False: no lock could be made; nothing is to be released.
bool store_init(Store *store) RT_MUST_CHECK;
void store_fini(Store *store);

// Takes over what files have, of which none has another head. False when out of memory.
bool store_know(Store *store, const Partial *files, int count) RT_MUST_CHECK;

// From now on, what is added is in the file at `path` after as many seconds, beside what is known. False when it cannot
// be written; `error` says why.
bool store_keep(Store *store, const char *path, double seconds, ImageError *error) RT_MUST_CHECK;

// The next pass, over so many tiles. Returns how many of them are known.
int store_begin_pass(Store *store, int tiles);

static inline bool store_knows(const Store *store, int tile)
{
    return store->is_known && store->is_known[tile];
}

// A tile of the pass was traced. By any thread.
void store_add(Store *store, int tile, const unsigned char *bytes, size_t length);

// The clock by which rounds are chosen; its readings are known and kept as tiles are.
double store_seconds(Store *store, double own);

// Writes what waits to the checkpoint.
void store_flush(Store *store);

// All that is known and was added, as a part's file.
bool store_write_part(Store *store, const char *path, ImageError *error) RT_MUST_CHECK;

#endif
