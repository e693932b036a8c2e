// Huge pages by madvise, on the whole pages inside of what malloc gave.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "base/pages.h"

#include <errno.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

static const size_t huge_page = (size_t)2 << 20;

// What is smaller gains nothing.
static bool is_large(size_t bytes)
{
    return bytes >= 2 * huge_page;
}

void pages_prefer_huge(void *memory, size_t bytes)
{
    uintptr_t begin = ((uintptr_t)memory + huge_page - 1) & ~(huge_page - 1);
    uintptr_t end = ((uintptr_t)memory + bytes) & ~(huge_page - 1);
    if (memory != NULL && is_large(bytes) && begin < end) {
        int before = errno;
#ifdef MADV_HUGEPAGE
        (void)madvise((void *)begin, end - begin, MADV_HUGEPAGE); // refused on systems without: nothing is lost
#endif
        errno = before;
    }
}

// realloc would fail to move pages of which some are huge and some are not, and copy them to small ones.
void *pages_grow(void *memory, size_t old_bytes, size_t bytes)
{
    size_t whole = (bytes + huge_page - 1) & ~(huge_page - 1);
    if (!is_large(bytes) || whole < bytes) {
        return realloc(memory, bytes);
    }
    void *moved = aligned_alloc(huge_page, whole);
    if (moved == NULL) {
        return realloc(memory, bytes);
    }
    pages_prefer_huge(moved, whole);
    if (old_bytes > 0) {
        memcpy(moved, memory, old_bytes);
    }
    free(memory);
    return moved;
}
