// Where a value stands in a list of entries that lie along a pattern.
//
// Lists are those of the scene's records: `at` and the index of the next entry. Knows nothing of what lies there.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_ALONG_H
#define RENDER_ALONG_H

#include <stdint.h>

// At `low`, or the share of `high` that is mixed in. As in POV-Ray the way between two entries is of single precision.
typedef struct AlongPlace {
    uint32_t low, high;
    double share;
} AlongPlace;

// Finds the place of `value` in the list that begins with items[first]: from its start to the first entry beyond the
// value.
#define ALONG_FIND(items, first, value, place)                                                                         \
    do {                                                                                                               \
        uint32_t along_at = (first);                                                                                   \
        while ((items)[along_at].next != RECORD_NONE && (value) >= (items)[(items)[along_at].next].at) {               \
            along_at = (items)[along_at].next;                                                                         \
        }                                                                                                              \
        *(place) = (AlongPlace){along_at, along_at, 0.0};                                                              \
        if ((value) > (items)[along_at].at && (items)[along_at].next != RECORD_NONE) {                                 \
            uint32_t along_next = (items)[along_at].next;                                                              \
            *(place) = (AlongPlace){                                                                                   \
                along_at, along_next,                                                                                  \
                ((value) - (items)[along_at].at) / (double)(float)((items)[along_next].at - (items)[along_at].at)};    \
        }                                                                                                              \
    } while (0)

#endif
