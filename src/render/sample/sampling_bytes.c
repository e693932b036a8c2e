// What the passes of a sampled run leave of a tile, as bytes: see tile_bytes.h.
//
// Which pixels, corners and picks there are follows from what was decided before the pass, which each process decides
// alike. What is read is held to what a tile may leave, where something is counted or found by it.
//
// SPDX-License-Identifier: MIT
#include "render/sample/sampling.h"
#include "render/sample/tile_bytes.h"

// How many samples a pixel has, after a pass that it takes part in.
static bool is_count(const Round *round, uint32_t before, uint32_t now)
{
    if (stop_has_choice(round->sampling)) {
        return now > 0 && now <= 2 * round->count;
    }
    if (round->count > 0) {
        return now == round->count;
    }
    return now == (round_starts(round, before) ? START_SAMPLES : 2 * before);
}

static void code_record(const Round *round, PixelRecord *record, TileBytes *bytes)
{
    PixelRecord now = *record;
    tile_bytes_code(bytes, &now, sizeof now);
    if (bytes->way == TILE_BYTES_READ && !bytes->failed) {
        bytes->failed = !is_count(round, record->count, now.count) || !(now.spread >= 0.0f);
        *record = bytes->failed ? *record : now;
    }
}

static void code_strata(Share *share, size_t pixel, TileBytes *bytes)
{
    for (uint32_t i = share->first[pixel]; i < share->first[pixel + 1]; i++) {
        tile_bytes_code(bytes, &share->strata[i].taken, sizeof share->strata[i].taken);
        tile_bytes_code(bytes, share->strata[i].mean, sizeof share->strata[i].mean);
    }
}

// Puts an entry of the pixel's from `begin` on at that place; false where there is none.
static bool bring_forward(SmallEntry *entries, int begin, int count, ShapeId shape)
{
    for (int i = begin; i < count; i++) {
        if (entries[i].shape == shape) {
            SmallEntry entry = entries[i];
            entries[i] = entries[begin];
            entries[begin] = entry;
            return true;
        }
    }
    return false;
}

// How many of a pixel's small shapes were met by none of its samples, and their order, in which sums are made.
static void code_small(Small *small, size_t pixel, TileBytes *bytes)
{
    SmallEntry *entries = &small->entries[small->first[pixel]];
    int count = (int)(small->first[pixel + 1] - small->first[pixel]);
    uint8_t open = small->open[pixel];
    tile_bytes_code(bytes, &open, sizeof open);
    for (int i = 0; i < count; i++) {
        ShapeId shape = entries[i].shape;
        tile_bytes_code(bytes, &shape, sizeof shape);
        if (bytes->way == TILE_BYTES_READ && !bytes->failed) {
            bytes->failed = open > small->open[pixel] || !bring_forward(entries, i, count, shape);
        }
    }
    small->open[pixel] = bytes->failed ? small->open[pixel] : open;
}

static void code_pixel(const Round *round, size_t pixel, TileBytes *bytes)
{
    Film *film = round->film;
    tile_bytes_code(bytes, &film->rgb[3 * pixel], 3 * sizeof *film->rgb);
    if (film_background(film)) {
        tile_bytes_code(bytes, &film_background(film)[pixel], sizeof(float));
    }
    code_record(round, &film->records[pixel], bytes);
    if (share_has(round->share, pixel)) {
        code_strata(round->share, pixel, bytes);
    }
    if (small_has(round->small, pixel)) {
        code_small(round->small, pixel, bytes);
    }
}

void round_code(const Round *round, Tile tile, TileBytes *bytes)
{
    for (int y = tile.top; y < tile.bottom; y++) {
        for (int x = tile.left; x < tile.right; x++) {
            size_t pixel = (size_t)y * (size_t)round->film->width + (size_t)x;
            if (round_has(round, pixel)) {
                code_pixel(round, pixel, bytes);
            }
        }
    }
}

void round_code_corners(const Round *round, Tile tile, TileBytes *bytes)
{
    tile_bytes_plane(bytes, round->corners, 3 * sizeof *round->corners, round->film->width + 1, tile);
}

void audit_code(Audit *audit, int begin, int end, TileBytes *bytes)
{
    for (int i = begin; i < end; i++) {
        AuditPick *pick = &audit->picks[i];
        uint8_t is_pair = pick->is_pair;
        tile_bytes_code(bytes, &is_pair, sizeof is_pair);
        tile_bytes_code(bytes, &pick->square, sizeof pick->square);
        tile_bytes_code(bytes, pick->apart, sizeof pick->apart);
        pick->is_pair = is_pair != 0;
    }
}

// What a look found of the shapes of its pixel: how much they differ from it, and which were shown.
static void code_looked_at(Small *small, size_t pixel, TileBytes *bytes)
{
    for (uint32_t i = small->first[pixel]; i < small->first[pixel] + small->open[pixel]; i++) {
        SmallEntry *entry = &small->entries[i];
        uint32_t place = small_place(small, entry->shape);
        // Other tiles may have been shown it meanwhile, which changes nothing of what all tiles show.
        uint8_t is_seen = __atomic_load_n(&small->seen[place / 64], __ATOMIC_RELAXED) >> (place % 64) & 1;
        tile_bytes_code(bytes, &entry->contrast, sizeof entry->contrast);
        tile_bytes_code(bytes, &is_seen, sizeof is_seen);
        if (bytes->way == TILE_BYTES_READ && is_seen) {
            small->seen[place / 64] |= UINT64_C(1) << (place % 64);
        }
    }
}

void look_code(const Round *round, Looks *looks, Tile tile, TileBytes *bytes)
{
    for (int i = 0; i < looks->count; i++) {
        LookPick *pick = &looks->picks[i];
        int x = (int)(pick->pixel % (size_t)round->film->width), y = (int)(pick->pixel / (size_t)round->film->width);
        if (x >= tile.left && x < tile.right && y >= tile.top && y < tile.bottom) {
            tile_bytes_code(bytes, pick->sums, sizeof pick->sums);
            code_looked_at(round->small, pick->pixel, bytes);
        }
    }
}
