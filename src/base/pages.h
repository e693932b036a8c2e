// Pages for large arrays: huge ones, since memory that is touched for the first time costs a fault for each page, and
// such as go back to the system at once, where malloc would keep them.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_PAGES_H
#define BASE_PAGES_H

#include <stdbool.h>
#include <stddef.h>

#include "base/attributes.h"

// Memory that is grown to `bytes`: as realloc, but that large memory is moved at once, to where all of it can be huge
// pages.
void *pages_grow(void *memory, size_t old_bytes, size_t bytes);

// Memory of a size that is not known before it is filled: what is not touched costs nothing.
typedef struct Pages {
    void *memory;
    size_t mapped; // bytes, 0: of malloc
} Pages;

// Fresh memory for `bytes` > 0, on a line of cache; its contents are undefined. False when out of memory.
bool pages_take(Pages *pages, size_t bytes) RT_MUST_CHECK;
// The first `bytes` > 0 are kept where they are.
void pages_trim(Pages *pages, size_t bytes);
// Gives all of it back; {0} is allowed, and is left.
void pages_give(Pages *pages);

#endif
