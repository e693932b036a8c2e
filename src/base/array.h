// Growable arrays: a plain struct of items, count and capacity for any element type.
//
//     ARRAY(double) weights = {0};
//     if (!ARRAY_PUSH(&weights, 0.5)) ... out of memory ...
//     ARRAY_FREE(&weights);
//
// SPDX-License-Identifier: MIT
#ifndef BASE_ARRAY_H
#define BASE_ARRAY_H

#include <stdbool.h>
#include <stddef.h>

#include "base/attributes.h"

#define ARRAY(type)                                                                                                    \
    struct {                                                                                                           \
        type *items;                                                                                                   \
        size_t count, capacity;                                                                                        \
    }

// Makes room for `wanted` elements in all. False when out of memory; the array is then unchanged.
#define ARRAY_RESERVE(array, wanted)                                                                                   \
    array_reserve((void **)&(array)->items, &(array)->capacity, (wanted), sizeof(*(array)->items))

// Appends one element. False when out of memory; the array is then unchanged.
#define ARRAY_PUSH(array, ...)                                                                                         \
    (((array)->count < (array)->capacity || ARRAY_RESERVE((array), (array)->count + 1))                                \
         ? ((array)->items[(array)->count++] = (__VA_ARGS__), true)                                                    \
         : false)

// Gives the memory back and leaves an empty array.
#define ARRAY_FREE(array) array_free((void **)&(array)->items, &(array)->count, &(array)->capacity)

bool array_reserve(void **items, size_t *capacity, size_t wanted, size_t element_size) RT_MUST_CHECK;
void array_free(void **items, size_t *count, size_t *capacity);

#endif
