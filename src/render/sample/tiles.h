// Tiles and threads: something is done once for each tile of a picture, by whichever thread is free.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SAMPLE_TILES_H
#define RENDER_SAMPLE_TILES_H

#include "render/records/film.h"
#include "render/records/kernel.h"
#include "render/records/options.h"
#include "render/sample/sample.h"
#include "render/sample/tile_bytes.h"

enum { TILE_SIZE = 32 };

// What is done. What it does for a tile depends on nothing that is done for another.
typedef struct TileWork {
    void *client;
    const Prepared *prepared;
    int width, height; // of the picture
    // In the thread's own scratch; adds to what was counted.
    void (*trace)(void *client, Tile tile, RenderScratch *scratch, RenderStatistics *counted);
    void (*progress)(void *client, double done); // 0 to 1; by one thread at a time; may be NULL
    // What `trace` left of a tile, but for what it counted. NULL: it is traced in each process that needs it.
    void (*code)(void *client, Tile tile, TileBytes *bytes);
    bool is_last; // no tile of another pass needs what this one leaves
} TileWork;

// The part of a tile, of KERNEL_ROW by KERNEL_ROW pixels or less, that begins at a pixel.
static inline Tile tile_block(Tile tile, int left, int top)
{
    return (Tile){left, top, left + KERNEL_ROW < tile.right ? left + KERNEL_ROW : tile.right,
                  top + KERNEL_ROW < tile.bottom ? top + KERNEL_ROW : tile.bottom};
}

// Places `aside` from the middle of a block's pixels in both directions, in rows; where the block is cut off, its last
// ones again. Returns those of the block, a bit for each. The lens is left as it is.
uint64_t block_places(const Film *film, Tile block, double aside, KernelPlaces *places);

// Whether a pixel of a tile has entries of a list by pixels: where in it each pixel's are, in `first`, and the next one's.
static inline bool tile_has_entries(const uint32_t *first, int width, Tile tile)
{
    bool has_entries = false;
    for (int y = tile.top; y < tile.bottom && !has_entries; y++) {
        const uint32_t *row = &first[(size_t)y * (size_t)width];
        has_entries = row[tile.left] < row[tile.right];
    }
    return has_entries;
}

void statistics_add(RenderStatistics *sum, const RenderStatistics *more);

// Runs on options->threads threads, or as many of them as memory is found for, and as options->share says; adds to the
// statistics, which are those of all tiles, whoever traced them.
RenderResult tiles_run(const TileWork *work, const RenderOptions *options, RenderStatistics *statistics) RT_MUST_CHECK;

#endif
