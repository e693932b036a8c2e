// Tiles dealt in turn to as many parts, each of which leaves out what is known: see alone.h.
//
// SPDX-License-Identifier: MIT
#include "share/alone.h"

static bool is_own(const Alone *alone, int tile)
{
    return tile % alone->parts == alone->part - 1 && !store_knows(alone->store, tile);
}

static int begin(void *client, int tiles, bool is_last)
{
    Alone *alone = client;
    (void)is_last;
    int known = store_begin_pass(alone->store, tiles);
    alone->tiles = tiles;
    alone->own = 0;
    for (int i = 0; i < tiles; i++) {
        alone->own += is_own(alone, i);
    }
    atomic_store(&alone->next, 0);
    atomic_store(&alone->given, 0);
    return alone->parts > 1 ? tiles - alone->own : known;
}

static int next(void *client)
{
    Alone *alone = client;
    for (int tile; (tile = atomic_fetch_add(&alone->next, 1)) < alone->tiles;) {
        if (is_own(alone, tile)) {
            return alone->store->fault ? -1 : tile;
        }
    }
    return -1;
}

static void give(void *client, int tile, const unsigned char *bytes, size_t length)
{
    Alone *alone = client;
    store_add(alone->store, tile, bytes, length);
    atomic_fetch_add(&alone->given, 1);
}

static TileShareResult end(void *client, bool is_stopped, TileTake *take, void *run)
{
    Alone *alone = client;
    Store *store = alone->store;
    if (is_stopped) {
        store_flush(store);
    }
    for (size_t i = store->first; i < store->end && !store->fault; i++) {
        const PartialRecord *record = &store->records.items[i];
        if (!take(run, (int)record->tile, record->bytes, record->length)) {
            store->fault = STORE_MISFIT;
        }
    }
    if (store->fault) {
        return TILE_SHARE_BROKEN;
    }
    return alone->parts > 1 && atomic_load(&alone->given) == alone->own ? TILE_SHARE_ELSEWHERE : TILE_SHARE_HERE;
}

static double seconds(void *client, double own)
{
    Alone *alone = client;
    return store_seconds(alone->store, own);
}

void alone_init(Alone *alone, Store *store, int part, int parts)
{
    *alone = (Alone){.store = store, .part = part, .parts = parts};
    alone->table = (TileShare){.client = alone,
                               .is_part = parts > 1,
                               .begin = begin,
                               .next = next,
                               .give = give,
                               .end = end,
                               .seconds = seconds};
}
