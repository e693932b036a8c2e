// One process that traces all tiles, or those of one part, but for what is known from before: parts of a job, their
// joining, and runs that are continued.
//
// SPDX-License-Identifier: MIT
#ifndef SHARE_ALONE_H
#define SHARE_ALONE_H

#include <stdatomic.h>

#include "render/records/tile_share.h"
#include "share/store.h"

typedef struct Alone {
    TileShare table; // for RenderOptions.share
    Store *store;    // the caller's
    int part, parts; // of the tiles; 1 of 1: all
    int tiles;       // of the pass
    atomic_int next, given;
    int own; // tiles that are to be traced
} Alone;

void alone_init(Alone *alone, Store *store, int part, int parts);

#endif
