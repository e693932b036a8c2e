// Where a value stands in a list of entries that lie along a pattern.
//
// A scene's entries are records that name the next one; here the values of each list that some record begins with stand
// side by side, so that a place among them is found by counting. Knows nothing of what lies there.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SURFACE_ALONG_H
#define RENDER_SURFACE_ALONG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/attributes.h"

// At `low`, or the share of `high` that is mixed in. As in POV-Ray the way between two entries is of single precision.
typedef struct AlongPlace {
    uint32_t low, high;
    double share;
} AlongPlace;

typedef struct AlongList {
    const double *at;        // of each entry
    const uint32_t *entries; // which one it is
    uint32_t count;
    bool rises;
} AlongList;

// Records of one size, and where in each stands the index of an entry: that of the next one, or of the first of a list.
typedef struct AlongRecords {
    const void *items;
    size_t count, size, index_at;
} AlongRecords;

// The list of each of `records`, NULL when out of memory. An entry begins with its value, a double; a record without
// entries has a list of none. Records that begin with the same entry share their numbers. All is in the arena.
const AlongList *along_lists(Arena *arena, const AlongRecords *records, const AlongRecords *entries) RT_MUST_CHECK;

// How many of numbers that rise are no more than `value`. Long lists are halved first; no branch depends on the value.
RT_ALWAYS_INLINE uint32_t along_count(const double *at, uint32_t count, double value)
{
    enum { COUNTED_MOST = 8 };
    uint32_t low = 0, left = count;
    while (left > COUNTED_MOST) {
        uint32_t half = left / 2;
        low += half & -(uint32_t)(value >= at[low + half - 1]);
        left -= half;
    }
    uint32_t known = low;
    for (uint32_t i = 0; i < left; i++) {
        low += value >= at[known + i];
    }
    return low;
}

// The place of `value` in a list of at least one entry. As in POV-Ray, the last entry counts from its own place on and
// the first one up to its own; between them stands the value before the first entry beyond it. So a list that does not
// rise has its meaning, too.
RT_ALWAYS_INLINE AlongPlace along_find(const AlongList *list, double value)
{
    const double *at = list->at;
    uint32_t last = list->count - 1, low = 0;
    if (list->rises) {
        low = along_count(at + 1, last, value);
    } else {
        while (low < last && value >= at[low + 1]) {
            low++;
        }
    }
    low = value >= at[last] ? last : value > at[0] ? low : 0;
    if (low == last || !(value > at[low])) {
        return (AlongPlace){list->entries[low], list->entries[low], 0.0};
    }
    return (AlongPlace){list->entries[low], list->entries[low + 1],
                        (value - at[low]) / (double)(float)(at[low + 1] - at[low])};
}

#endif
