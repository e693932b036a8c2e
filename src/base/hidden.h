// What AddressSanitizer learns of memory that is ours but nobody's at the moment: a build without it does nothing.
//
// A block that goes back to a list, or the part of a chunk that is not handed out, is hidden: who reads or writes there
// is reported. Whoever hands it out shows it. Knows nothing of who owns the memory.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_HIDDEN_H
#define BASE_HIDDEN_H

#include <stddef.h>

#ifdef __SANITIZE_ADDRESS__
#define HIDDEN_IS_ON 1
#elif defined __has_feature
#if __has_feature(address_sanitizer)
#define HIDDEN_IS_ON 1
#endif
#endif
#ifdef HIDDEN_IS_ON
#include <sanitizer/asan_interface.h>
#else
#define HIDDEN_IS_ON 0
#endif

static inline void hidden_put(const void *memory, size_t bytes)
{
#if HIDDEN_IS_ON
    ASAN_POISON_MEMORY_REGION(memory, bytes);
#else
    (void)memory;
    (void)bytes;
#endif
}

static inline void hidden_take(const void *memory, size_t bytes)
{
#if HIDDEN_IS_ON
    ASAN_UNPOISON_MEMORY_REGION(memory, bytes);
#else
    (void)memory;
    (void)bytes;
#endif
}

#endif
