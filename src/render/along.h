// Where a value stands in a list of entries that lie along a pattern.
//
// Lists are those of the scene's records: `at` and the index of the next entry. Knows nothing of what lies there.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_ALONG_H
#define RENDER_ALONG_H

#include <stdbool.h>
#include <stdint.h>

// At `low`, or the share of `high` that is mixed in. As in POV-Ray the way between two entries is of single precision.
typedef struct AlongPlace {
    uint32_t low, high;
    double share;
} AlongPlace;

// Finds the place of `value` in the list that begins with items[first]. As in POV-Ray, the last entry counts from its own
// place on and the first one up to its own; between them stands the value before the first entry beyond it. So a list
// that does not rise has its meaning, too.
#define ALONG_FIND(items, first, value, place)                                                                         \
    do {                                                                                                               \
        uint32_t along_at = (first), along_last = (first);                                                             \
        bool along_is_found = false;                                                                                   \
        for (uint32_t along_i = (items)[along_at].next; along_i != RECORD_NONE; along_i = (items)[along_i].next) {     \
            along_is_found = along_is_found || (value) < (items)[along_i].at;                                          \
            along_at = along_is_found ? along_at : along_i;                                                            \
            along_last = along_i;                                                                                      \
        }                                                                                                              \
        along_at = (value) >= (items)[along_last].at ? along_last                                                      \
                   : (value) > (items)[(first)].at   ? along_at                                                        \
                                                     : (first);                                                        \
        *(place) = (AlongPlace){along_at, along_at, 0.0};                                                              \
        if ((value) > (items)[along_at].at && (items)[along_at].next != RECORD_NONE) {                                 \
            uint32_t along_next = (items)[along_at].next;                                                              \
            *(place) = (AlongPlace){                                                                                   \
                along_at, along_next,                                                                                  \
                ((value) - (items)[along_at].at) / (double)(float)((items)[along_next].at - (items)[along_at].at)};    \
        }                                                                                                              \
    } while (0)

#endif
