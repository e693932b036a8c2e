// Huge pages by madvise, on the whole pages inside of what malloc gave or what was mapped.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "base/pages.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "base/cleared.h"

static const size_t huge_page = (size_t)2 << 20;

// What is smaller would waste more memory than the faults are worth, which a huge page saves.
static bool is_large(size_t bytes)
{
    return bytes >= huge_page / 4;
}

// Asks the system to back fresh memory with huge pages, where it is large enough to gain by it. Only a wish: contents
// and addresses stay as they are. NULL is allowed.
static void pages_prefer_huge(void *memory, size_t bytes)
{
    uintptr_t begin = ((uintptr_t)memory + huge_page - 1) & ~(huge_page - 1);
    uintptr_t end = ((uintptr_t)memory + bytes) & ~(huge_page - 1);
    if (memory && is_large(bytes) && begin < end) {
        int before = errno;
#ifdef MADV_HUGEPAGE
        (void)madvise((void *)begin, end - begin, MADV_HUGEPAGE); // refused on systems without: nothing is lost
#endif
        errno = before;
    }
}

// Takes the whole huge pages of memory that begins on one to others, instead of their contents; malloc, which still has
// the old addresses, gives them back to the system itself, so nobody else can get them before. How many bytes it was.
static size_t move_huge_pages(void *to, void *from, size_t bytes)
{
#ifdef MREMAP_DONTUNMAP
    size_t whole = ((uintptr_t)from & (huge_page - 1)) == 0 ? bytes & ~(huge_page - 1) : 0;
    int before = errno, how = MREMAP_MAYMOVE | MREMAP_FIXED | MREMAP_DONTUNMAP;
    if (whole > 0 && mremap(from, whole, whole, how, to) == MAP_FAILED) {
        errno = before;
        return 0;
    }
    return whole;
#else
    (void)to, (void)from, (void)bytes;
    return 0;
#endif
}

// The last page is a huge one, too: the faults of a few hundred small ones take longer than clearing it.
static size_t whole_pages(size_t bytes)
{
    return (bytes + huge_page - 1) & ~(huge_page - 1);
}

// realloc would fail to move pages of which some are huge and some are not, and copy them to small ones.
void *pages_grow(void *memory, size_t old_bytes, size_t bytes)
{
    size_t whole = whole_pages(bytes);
    if (!is_large(bytes) || whole < bytes) {
        return realloc(memory, bytes);
    }
    void *moved = aligned_alloc(huge_page, whole);
    if (!moved) {
        return realloc(memory, bytes);
    }
    pages_prefer_huge(moved, whole);
    if (old_bytes > 0) {
        size_t done = move_huge_pages(moved, memory, old_bytes);
        memcpy((char *)moved + done, (const char *)memory + done, old_bytes - done);
    }
    free(memory);
    return moved;
}

// The memory begins on a huge page, which is looked for in a mapping that is larger by one.
static bool map_pages(Pages *pages, size_t bytes)
{
    size_t whole = whole_pages(bytes);
    if (whole < bytes || whole > SIZE_MAX - huge_page) {
        return false;
    }
    int before = errno;
    char *begin = mmap(NULL, whole + huge_page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    errno = before;
    if (begin == MAP_FAILED) {
        return false;
    }
    size_t aside = (huge_page - ((uintptr_t)begin & (huge_page - 1))) & (huge_page - 1);
    if (aside > 0) {
        munmap(begin, aside);
    }
    if (aside < huge_page) {
        munmap(begin + aside + whole, huge_page - aside);
    }
    *pages = (Pages){begin + aside, whole};
    pages_prefer_huge(pages->memory, whole);
    return true;
}

bool pages_take(Pages *pages, size_t bytes)
{
    enum { LINE = 64 };
    if (is_large(bytes)) {
        return map_pages(pages, bytes);
    }
    *pages = (Pages){.memory = aligned_alloc(LINE, (bytes + LINE - 1) / LINE * LINE)};
    return pages->memory != NULL;
}

void pages_trim(Pages *pages, size_t bytes)
{
    size_t whole = pages->mapped > 0 ? whole_pages(bytes) : 0;
    if (whole < pages->mapped) {
        munmap((char *)pages->memory + whole, pages->mapped - whole);
        pages->mapped = whole;
    }
}

void pages_give(Pages *pages)
{
    if (pages->mapped > 0) {
        munmap(pages->memory, pages->mapped);
    } else {
        free(pages->memory);
    }
    *pages = (Pages){0};
}

void *cleared_new(size_t count, size_t size)
{
    static const size_t at_once = (size_t)64 << 20;
    if (size > 0 && count > SIZE_MAX / size) {
        return NULL;
    }
    size_t bytes = count * size > 0 ? count * size : 1;
    if (bytes > at_once) {
        void *touched_later = calloc(bytes, 1);
        pages_prefer_huge(touched_later, bytes);
        return touched_later;
    }
    void *memory = pages_grow(NULL, 0, bytes);
    return memory ? memset(memory, 0, bytes) : NULL;
}
