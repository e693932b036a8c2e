// Preloaded into a program: one of its allocations fails, or all from one on, and how many there were is written down.
//
// FAIL_AT=n makes the n-th call of malloc, calloc, realloc and aligned_alloc fail, counted over all threads from 1;
// with FAIL_ON=1 all after it fail, too. At the end the number of calls and of blocks that are still held is written to
// the file FAIL_LOG. Knows nothing of the program.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *memory, size_t size);
void *__libc_memalign(size_t alignment, size_t size);
void __libc_free(void *memory);

static atomic_long calls, held;
static long first, last; // of the calls that fail

__attribute__((constructor)) static void begin(void)
{
    const char *at = getenv("FAIL_AT"), *on = getenv("FAIL_ON");
    first = at ? atol(at) : 0;
    last = on ? __LONG_MAX__ : first;
    calls = held = 0; // what the loader took before is not the program's
}

__attribute__((destructor)) static void end(void)
{
    char text[64];
    const char *log = getenv("FAIL_LOG");
    int length = snprintf(text, sizeof text, "%ld %ld\n", (long)calls, (long)held);
    int fd = log ? open(log, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666) : -1;
    if (fd >= 0 && write(fd, text, (size_t)length) != length) {
        abort();
    }
}

static int fails(void)
{
    long call = ++calls;
    int is_failing = first > 0 && call >= first && call <= last;
    errno = is_failing ? ENOMEM : errno;
    return is_failing;
}

static void *taken(void *memory)
{
    held += memory != NULL;
    return memory;
}

void *malloc(size_t size)
{
    return fails() ? NULL : taken(__libc_malloc(size));
}

void *calloc(size_t count, size_t size)
{
    return fails() ? NULL : taken(__libc_calloc(count, size));
}

void *realloc(void *memory, size_t size)
{
    if (fails()) {
        return NULL;
    }
    void *moved = __libc_realloc(memory, size);
    return memory ? moved : taken(moved);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return fails() ? NULL : taken(__libc_memalign(alignment, size));
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
    *memory = aligned_alloc(alignment, size);
    return *memory ? 0 : ENOMEM;
}

void free(void *memory)
{
    held -= memory != NULL;
    __libc_free(memory);
}
