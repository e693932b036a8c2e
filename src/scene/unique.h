// Finds the equal of a record in an array that keeps each different record once.
//
// A hash table of places in the array; the array belongs to the caller. Records are compared and hashed bit by bit, so
// they must have no padding.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_UNIQUE_H
#define SCENE_UNIQUE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/array.h"
#include "base/attributes.h"

typedef struct UniqueIndex {
    ARRAY(uint32_t) slots; // place in the array + 1, 0 when empty; a power of two of them
    uint32_t last;         // the place that was returned last
    size_t found;          // records that had an equal
    bool is_given_up;      // only the record that was added last is looked at
} UniqueIndex;

// The place of an equal record among `count` ones of `size` bytes (a multiple of 4). When there is none, *place is
// `count`, where the caller must then append it. False when out of memory or beyond 2^32 - 2 records.
bool unique_place(UniqueIndex *index, const void *records, size_t count, size_t size, const void *record,
                  uint32_t *place) RT_MUST_CHECK;

// The same as long as that pays: after so many records of which next to none had an equal, the table is given up, and
// only a record that equals the one added last is not kept again. What is kept twice depends on the order of the records
// alone.
bool unique_place_if_worth(UniqueIndex *index, const void *records, size_t count, size_t size, const void *record,
                           uint32_t *place) RT_MUST_CHECK;

// From now on only a record that equals the one added last is not kept again, and there is none such yet.
void unique_give_up(UniqueIndex *index);

void unique_fini(UniqueIndex *index);

#endif
