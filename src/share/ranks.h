// Ranks that share the tiles of a picture: rank 0 deals them on request, gathers what they left, and gives
// it to all where they decide by it.
//
// One thread of each rank talks to the others, by a module that knows how (share/mpi_module.h), while the others trace.
// What each rank then knows is the same, so all of them come to the same next pass; rank 0 has the picture.
//
// SPDX-License-Identifier: MIT
#ifndef SHARE_RANKS_H
#define SHARE_RANKS_H

#include <pthread.h>

#include "render/records/tile_share.h"
#include "share/asking.h"
#include "share/mpi_module.h"
#include "share/store.h"

typedef struct RankTile {
    int tile;
    TextBuffer bytes; // what it left; moved on where it is handed on
} RankTile;

typedef ARRAY(RankTile) RankTiles;

typedef struct Ranks {
    TileShare table; // for RenderOptions.share
    const MpiModule *module;
    Store *store; // the caller's; of rank 0, others keep nothing
    int rank, ranks;
    // The pass.
    int tiles;
    bool is_last;
    unsigned char *is_here; // of each tile: what it left needs not be taken from elsewhere; owned
    pthread_mutex_t lock;   // of all below
    int next_tile;          // rank 0: the next to be dealt
    int done;               // rank 0: tiles that are done
    int *queue;             // others: tiles that are to be traced; owned
    int queue_begin, queue_end;
    bool is_asking, is_over, is_stopped, has_failed;
    Asking asking;     // where each rank has a part of the scene
    RankTiles results; // rank 0: of all tiles; others: traced here and not yet sent
} Ranks;

// The module is the caller's, and stays. False: no lock could be made; nothing is to be released.
bool ranks_init(Ranks *ranks, const MpiModule *module, int rank, int count) RT_MUST_CHECK;
void ranks_fini(Ranks *ranks);

// Before each picture. The store, which stays the caller's, is that of the picture's head.
void ranks_use(Ranks *ranks, Store *store);

// How threads ask others, where each rank has a part of the scene; NULL: each has all of it.
void ranks_ask(Ranks *ranks, const TileAsking *asking);

// What the ranks think of each other before a picture: whether each of them is `ready`, and has the head that rank 0
// has. The first rank for which that does not hold, or -1; *differs: how, PARTIAL_RESULTS: it is not ready. All ranks
// call it.
int ranks_agree(Ranks *ranks, bool ready, const PartialHead *head, PartialField *differs);

#endif
