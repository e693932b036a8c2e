// Open addressing over hashes of the lists' bits, at most half full, as in scene/unique.c, whose records are of one
// size.
//
// SPDX-License-Identifier: MIT
#include "scene/numbers.h"

#include <stdlib.h>
#include <string.h>

enum { SLOTS_LEAST = 16 };

static uint64_t hash_list(const Numbers *list)
{
    uint64_t hash = list->count, word;
    for (size_t i = 0; i < list->count; i++) {
        memcpy(&word, &list->items[i], sizeof word);
        hash = (hash ^ word) * UINT64_C(0xff51afd7ed558ccd);
        hash ^= hash >> 33;
    }
    return hash;
}

static bool is_equal(const Numbers *a, const Numbers *b)
{
    return a->count == b->count && (a->count == 0 || memcmp(a->items, b->items, a->count * sizeof *a->items) == 0);
}

// The slot of an equal list, or the empty one where it belongs.
static uint32_t *find_slot(NumberPool *pool, const Numbers *list)
{
    size_t mask = pool->slots.count - 1;
    for (size_t at = (size_t)hash_list(list) & mask;; at = (at + 1) & mask) {
        uint32_t *slot = &pool->slots.items[at];
        if (*slot == 0 || is_equal(&pool->lists.items[*slot - 1], list)) {
            return slot;
        }
    }
}

static bool grow(NumberPool *pool)
{
    size_t slots = pool->slots.count ? 2 * pool->slots.count : SLOTS_LEAST;
    if (!ARRAY_RESERVE(&pool->slots, slots)) {
        return false;
    }
    pool->slots.count = slots;
    memset(pool->slots.items, 0, slots * sizeof *pool->slots.items);
    for (size_t i = 0; i < pool->lists.count; i++) {
        *find_slot(pool, &pool->lists.items[i]) = (uint32_t)i + 1;
    }
    return true;
}

bool numbers_keep(NumberPool *pool, Numbers *list)
{
    if ((2 * (pool->lists.count + 1) > pool->slots.count && !grow(pool)) ||
        !ARRAY_RESERVE(&pool->lists, pool->lists.count + 1) || list->count > SIZE_MAX / sizeof *list->items) {
        return false;
    }
    uint32_t *slot = find_slot(pool, list);
    if (*slot == 0) {
        size_t bytes = (size_t)list->count * sizeof *list->items;
        double *items = malloc(bytes + 1);
        if (!items) {
            return false;
        }
        memcpy(items, list->items, bytes);
        pool->lists.items[pool->lists.count++] = (Numbers){items, list->count};
        pool->bytes += bytes;
        *slot = (uint32_t)pool->lists.count;
    }
    *list = pool->lists.items[*slot - 1];
    return true;
}

void numbers_fini(NumberPool *pool)
{
    for (size_t i = 0; i < pool->lists.count; i++) {
        free((double *)pool->lists.items[i].items);
    }
    ARRAY_FREE(&pool->lists);
    ARRAY_FREE(&pool->slots);
    *pool = (NumberPool){0};
}
