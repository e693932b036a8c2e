// Huge pages by madvise, on the whole pages inside of what malloc gave.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "base/pages.h"

#include <errno.h>
#include <stdint.h>
#include <sys/mman.h>

static const size_t huge_page = (size_t)2 << 20;

void pages_prefer_huge(void *memory, size_t bytes)
{
    uintptr_t begin = ((uintptr_t)memory + huge_page - 1) & ~(huge_page - 1);
    uintptr_t end = ((uintptr_t)memory + bytes) & ~(huge_page - 1);
    if (memory != NULL && bytes >= 2 * huge_page && begin < end) {
        int before = errno;
#ifdef MADV_HUGEPAGE
        (void)madvise((void *)begin, end - begin, MADV_HUGEPAGE); // refused on systems without: nothing is lost
#endif
        errno = before;
    }
}
