// Who traces which tiles of a picture, and how the others' results come here: the one table of functions by which the
// work of a picture is shared, by parts of a job, by one process after the other, or by ranks.
//
// A picture is a sequence of passes over tiles (tiles_run). What is decided between two of them follows from what all
// tiles left behind, in one order; so processes that know that decide alike, and each makes the picture that one alone
// would. Rendering knows nothing of files, processes and networks; who implements this knows nothing of light.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_RECORDS_TILE_SHARE_H
#define RENDER_RECORDS_TILE_SHARE_H

#include <stdbool.h>
#include <stddef.h>

typedef enum TileShareResult {
    TILE_SHARE_HERE,      // what was traced of the pass is here, or has been handed over
    TILE_SHARE_ELSEWHERE, // each tile was traced, but others keep what they left
    TILE_SHARE_STOPPED,   // another process stopped the work
    TILE_SHARE_BROKEN,    // results cannot be had or kept; the one who shares knows why
} TileShareResult;

// Takes the bytes that a tile left in the process that traced it; false where no tile can have left them.
typedef bool TileTake(void *client, int tile, const unsigned char *bytes, size_t length);

typedef enum TileSettled { TILE_SETTLED, TILE_AGAIN, TILE_GIVEN_UP } TileSettled;

typedef struct TileShare {
    void *client;
    bool is_part; // most tiles are never handed over: what follows from all of them is left out
    bool serves;  // `serve` is to be called
    // A pass over so many tiles begins, the next one of the picture. `is_last`: nothing is decided by what it leaves,
    // so only who keeps the picture needs it. Returns how many have been traced before.
    int (*begin)(void *client, int tiles, bool is_last);
    // A tile to be traced here; -1: there is none left. Called by any thread.
    int (*next)(void *client);
    // Whether what the calling thread has traced of a tile follows from the whole scene, where processes share that: if
    // not, it is known now and traced again. NULL: it always does.
    TileSettled (*settle)(void *client);
    // What a tile left that was traced here. Called by any thread.
    void (*give)(void *client, int tile, const unsigned char *bytes, size_t length);
    // Runs in the thread that called tiles_run, while others trace, until `end` may be called; calls `done` now and
    // then with how many tiles are done. `stops` turns true when the work is to stop.
    void (*serve)(void *client, void (*done)(void *run, int tiles), bool (*stops)(void *run), void *run);
    // The threads are done. Hands over what other processes traced.
    TileShareResult (*end)(void *client, bool is_stopped, TileTake *take, void *run);
    // The clock that all decide by, where this process's own shows `own` seconds.
    double (*seconds)(void *client, double own);
} TileShare;

// How a thread that traces asks other processes of the spheres that they have, as bytes that only the two ends know
// (trace/elsewhere.h).
typedef struct TileAsking {
    void *client;
    size_t question_bytes, answer_bytes;
    // What the calling thread must know of others; 0: nothing. They stay until `learn`.
    size_t (*questions)(void *client, const void **questions);
    // The answers of all others, one list each, on end.
    void (*learn)(void *client, const void *answers, size_t lists);
    // False: it had to leave questions out.
    bool (*forget)(void *client);
    // Answers others. Called by threads that trace. False: more than were announced do.
    bool (*answer)(void *client, const void *questions, size_t count, void *answers);
} TileAsking;

#endif
