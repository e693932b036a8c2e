// Arrays that are all 0 and are written from one end to the other: of the pixels of a picture, say. As calloc, but on
// huge pages where they are large: a fault for each small page takes longer than clearing twice.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_CLEARED_H
#define BASE_CLEARED_H

#include <stdint.h>
#include <string.h>

#include "base/pages.h"

// For `free`. NULL when out of memory.
static inline void *cleared_new(size_t count, size_t size)
{
    size_t bytes = count * size;
    if (size > 0 && count > SIZE_MAX / size) {
        return NULL;
    }
    void *memory = pages_grow(NULL, 0, bytes > 0 ? bytes : 1);
    return memory ? memset(memory, 0, bytes) : NULL;
}

#endif
