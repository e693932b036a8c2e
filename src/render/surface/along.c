// The lists of values along patterns, from records that are chained.
//
// Owns nothing: what it makes is in the caller's arena.
//
// SPDX-License-Identifier: MIT
#include "render/surface/along.h"

#include <stdlib.h>
#include <string.h>

#include "scene/scene.h"

static uint32_t index_in(const AlongRecords *records, size_t i)
{
    uint32_t index;
    memcpy(&index, (const char *)records->items + i * records->size + records->index_at, sizeof index);
    return index;
}

static bool fill_list(Arena *arena, const AlongRecords *entries, uint32_t first, AlongList *list)
{
    uint32_t count = 0;
    for (uint32_t i = first; i != RECORD_NONE; i = index_in(entries, i)) {
        count++;
    }
    double *at = arena_alloc_array(arena, count, sizeof *at);
    uint32_t *numbers = arena_alloc_array(arena, count, sizeof *numbers);
    if (!at || !numbers) {
        return false;
    }
    *list = (AlongList){at, numbers, count, true};
    for (uint32_t i = first, n = 0; n < count; i = index_in(entries, i), n++) {
        memcpy(&at[n], (const char *)entries->items + i * entries->size, sizeof at[n]);
        numbers[n] = i;
        list->rises = list->rises && (n == 0 || at[n] >= at[n - 1]);
    }
    return true;
}

const AlongList *along_lists(Arena *arena, const AlongRecords *records, const AlongRecords *entries)
{
    AlongList *lists = arena_alloc_array(arena, records->count + 1, sizeof *lists);
    uint32_t *made_for = calloc(entries->count + 1, sizeof *made_for); // of an entry: 1 + a record
    bool is_made = lists && made_for;
    for (size_t i = 0; i < records->count && is_made; i++) {
        uint32_t first = index_in(records, i);
        lists[i] = (AlongList){0};
        if (first == RECORD_NONE) {
            continue;
        }
        if (made_for[first] != 0) {
            lists[i] = lists[made_for[first] - 1];
        } else {
            is_made = fill_list(arena, entries, first, &lists[i]);
            made_for[first] = (uint32_t)i + 1;
        }
    }
    free(made_for);
    return is_made ? lists : NULL;
}
