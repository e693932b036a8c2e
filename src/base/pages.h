// Huge pages for large arrays: memory that is touched for the first time costs a fault for each page.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_PAGES_H
#define BASE_PAGES_H

#include <stddef.h>

// Asks the system to back fresh memory with huge pages, where it is large enough to gain by it. Only a wish: contents
// and addresses stay as they are. NULL is allowed.
void pages_prefer_huge(void *memory, size_t bytes);

// Memory that is grown to `bytes`: as realloc, but that large memory is moved at once, to where all of it can be huge
// pages.
void *pages_grow(void *memory, size_t old_bytes, size_t bytes);

#endif
