// Lists of numbers of any length that shapes are made of: outlines, coefficients. Each different list is kept once.
//
// Turns lists that somebody else has into ones that live as long as the scene and stay where they are, so that equal
// lists of one scene are at the same place. Knows nothing of what they mean.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_NUMBERS_H
#define SCENE_NUMBERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/array.h"

// A list that is kept elsewhere.
typedef struct Numbers {
    const double *items;
    uint64_t count;
} Numbers;

typedef struct NumberPool {
    ARRAY(Numbers) lists;  // each its own allocation
    ARRAY(uint32_t) slots; // place in lists + 1, 0 when empty; a power of two of them
    size_t bytes;
} NumberPool;

// *list becomes the pool's own, equal one, which lives until numbers_fini; what it referred to before stays the
// caller's. False when out of memory: *list is as it was.
bool numbers_keep(NumberPool *pool, Numbers *list) RT_MUST_CHECK;

void numbers_fini(NumberPool *pool);

#endif
