// A tile's values as bytes and back: see tile_bytes.h.
//
// SPDX-License-Identifier: MIT
#include "render/sample/tile_bytes.h"

#include <stdlib.h>
#include <string.h>

void tile_bytes_fini(TileBytes *bytes)
{
    if (bytes->way == TILE_BYTES_WRITE) {
        free(bytes->data);
        bytes->data = NULL;
    }
}

static bool has_room(TileBytes *bytes, size_t size)
{
    if (size <= bytes->capacity - bytes->length) {
        return true;
    }
    size_t capacity = 2 * bytes->capacity > bytes->length + size ? 2 * bytes->capacity : bytes->length + size;
    unsigned char *data = realloc(bytes->data, capacity);
    if (!data) {
        return false;
    }
    bytes->data = data;
    bytes->capacity = capacity;
    return true;
}

void tile_bytes_code(TileBytes *bytes, void *values, size_t size)
{
    if (bytes->way == TILE_BYTES_READ) {
        bytes->failed = bytes->failed || size > bytes->length - bytes->at;
        if (!bytes->failed) {
            memcpy(values, bytes->data + bytes->at, size);
            bytes->at += size;
        }
        return;
    }
    bytes->failed = bytes->failed || (bytes->way == TILE_BYTES_WRITE && !has_room(bytes, size));
    if (!bytes->failed && bytes->way == TILE_BYTES_WRITE) {
        memcpy(bytes->data + bytes->length, values, size);
    }
    bytes->length += bytes->failed ? 0 : size;
}

void tile_bytes_plane(TileBytes *bytes, void *plane, size_t pixel, int width, Tile tile)
{
    for (int y = tile.top; y < tile.bottom; y++) {
        size_t at = (size_t)y * (size_t)width + (size_t)tile.left;
        tile_bytes_code(bytes, (unsigned char *)plane + at * pixel, (size_t)(tile.right - tile.left) * pixel);
    }
}

void tile_bytes_light(TileBytes *bytes, Film *film, Tile tile)
{
    tile_bytes_plane(bytes, film->rgb, 3 * sizeof *film->rgb, film->width, tile);
    if (film_background(film)) {
        tile_bytes_plane(bytes, film_background(film), sizeof(float), film->width, tile);
    }
}
