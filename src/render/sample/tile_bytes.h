// What a tile's work leaves behind, as bytes: for a process that did not trace the tile itself.
//
// One function of each kind of work (TileWork.code) names the values in one order; it counts, writes or reads them, so
// that what is written is what is read. Numbers stand as the machine holds them, which is little endian wherever files
// of them are written (share/partial.h).
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SAMPLE_TILE_BYTES_H
#define RENDER_SAMPLE_TILE_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "render/records/kernel.h"
#include "render/records/film.h"
#include "render/records/options.h"

typedef enum TileBytesWay { TILE_BYTES_COUNT, TILE_BYTES_WRITE, TILE_BYTES_READ } TileBytesWay;

typedef struct TileBytes {
    TileBytesWay way;
    unsigned char *data; // written: owned, released with tile_bytes_fini; read: the caller's
    size_t length;       // counted or written so far; read: all that there is
    size_t capacity, at; // of `data`, when it is written; of what is read next
    bool failed;         // out of memory; read: no tile can have left such bytes
} TileBytes;

void tile_bytes_fini(TileBytes *bytes);

// The next values. What is read stays as it is once something failed.
void tile_bytes_code(TileBytes *bytes, void *values, size_t size);

// The pixels of a tile in a plane with so many bytes each.
void tile_bytes_plane(TileBytes *bytes, void *plane, size_t pixel, int width, Tile tile);

// The film's light, and the share of what is behind the scene, if it has that.
void tile_bytes_light(TileBytes *bytes, Film *film, Tile tile);

#endif
