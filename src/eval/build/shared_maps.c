// Maps that were visited, by their address.
//
// SPDX-License-Identifier: MIT
#include "eval/build/shared_maps.h"

bool shared_maps_place(SharedMaps *shared, const PatternMap *map, uint32_t *place, bool *is_new)
{
    size_t count = shared->maps.count;
    if (!ARRAY_RESERVE(&shared->maps, count + 1) || !ARRAY_RESERVE(&shared->made, count + 1) ||
        !unique_place(&shared->index, shared->maps.items, count, sizeof map, &map, place)) {
        return false;
    }
    *is_new = *place == count;
    return !*is_new || (ARRAY_PUSH(&shared->maps, map) && ARRAY_PUSH(&shared->made, (SharedMap){0}));
}

void shared_maps_fini(SharedMaps *shared)
{
    unique_fini(&shared->index);
    ARRAY_FREE(&shared->maps);
    ARRAY_FREE(&shared->made);
}
