// Growable arrays: the part that does not depend on the element type.
//
// SPDX-License-Identifier: MIT
#include "base/array.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/pages.h"

enum { CAPACITY_LEAST = 8 };

// The caller's pointer is of another type than void *, so its bytes are copied instead of being read and written as a
// void * (C17 6.5p7).
static void *pointer_load(void *const *from)
{
    void *pointer;
    memcpy(&pointer, (const void *)from, sizeof(pointer));
    return pointer;
}

static void pointer_store(void **to, void *pointer)
{
    memcpy((void *)to, &pointer, sizeof(pointer));
}

bool array_reserve(void **items, size_t *capacity, size_t wanted, size_t element_size)
{
    if (wanted <= *capacity) {
        return true;
    }
    size_t greatest = SIZE_MAX / 2 / element_size;
    if (wanted > greatest) {
        return false;
    }
    size_t grown = *capacity > greatest / 2 ? greatest : *capacity * 2;
    grown = grown < CAPACITY_LEAST && CAPACITY_LEAST <= greatest ? CAPACITY_LEAST : grown;
    grown = grown < wanted ? wanted : grown;
    void *moved = pages_grow(pointer_load(items), *capacity * element_size, grown * element_size);
    if (!moved) {
        return false;
    }
    pointer_store(items, moved);
    *capacity = grown;
    return true;
}

void array_free(void **items, size_t *count, size_t *capacity)
{
    free(pointer_load(items));
    pointer_store(items, NULL);
    *count = 0;
    *capacity = 0;
}
