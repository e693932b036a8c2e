// Arrays that are all 0 and are written from one end to the other: of the pixels of a picture, say. As calloc, but on
// huge pages where they are large: a fault for each small page takes longer than clearing twice.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_CLEARED_H
#define BASE_CLEARED_H

#include <stddef.h>

// For `free`. NULL when out of memory. What is too large to be cleared within a moment is cleared as it is touched.
void *cleared_new(size_t count, size_t size);

#endif
