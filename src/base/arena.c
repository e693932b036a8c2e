// Arena: hands out memory from chunks that grow with the arena, and frees them back to a mark.
//
// Owns its chunks, linked from the newest to the oldest. The chunk that a rewind keeps hangs on the chunk that is
// then the newest. Built with AddressSanitizer, all that is not handed out is hidden. Knows nothing of what is stored.
//
// SPDX-License-Identifier: MIT
#include "base/arena.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/hidden.h"
#include "base/pages.h"

enum { ALIGNMENT = 16 };
#define CHUNK_LEAST    ((size_t)64 << 10)
#define CHUNK_GREATEST ((size_t)64 << 20)
// What holds that much will hold more, for most of which huge pages save the faults.
#define HUGE_FROM      ((size_t)512 << 10)
#define HUGE_PAGE      ((size_t)2 << 20)

struct ArenaChunk {
    ArenaChunk *older;
    ArenaChunk *spare; // kept by a rewind to this chunk, or NULL
    size_t size;       // bytes in all, this header included
};

#define HEADER_SIZE ((sizeof(ArenaChunk) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT)

static char *chunk_begin(ArenaChunk *chunk)
{
    return (char *)chunk + HEADER_SIZE;
}

static void chunk_free(Arena *arena, ArenaChunk *chunk)
{
    if (chunk) {
        arena->bytes_reserved -= chunk->size;
        if (arena->shared) {
            arena->shared->used -= chunk->size;
        }
        free(chunk);
    }
}

static void arena_use_chunk(Arena *arena, ArenaChunk *chunk, ArenaChunk *older)
{
    chunk->older = older;
    chunk->spare = NULL;
    arena->chunk = chunk;
    arena->next = chunk_begin(chunk);
    arena->end = (char *)chunk + chunk->size;
    hidden_put(arena->next, (size_t)(arena->end - arena->next));
}

static size_t bytes_left(const Arena *arena)
{
    size_t left = arena->budget - arena->bytes_reserved;
    if (!arena->shared) {
        return left;
    }
    size_t shared = arena->shared->limit > arena->shared->used ? arena->shared->limit - arena->shared->used : 0;
    return left < shared ? left : shared;
}

// A chunk for at least `least` bytes, header included: as much as the arena holds already, within bounds and budget.
static ArenaChunk *chunk_new(Arena *arena, size_t least)
{
    size_t left = bytes_left(arena);
    size_t size = arena->bytes_reserved;
    if (least > left) {
        if (arena->shared) {
            arena->shared->refused = true;
        }
        return NULL;
    }
    size = size < CHUNK_LEAST ? CHUNK_LEAST : size > CHUNK_GREATEST ? CHUNK_GREATEST : size;
    size = size < HUGE_FROM ? size : (size + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE;
    size = size > left ? left : size;
    size = size < least ? least : size;
    ArenaChunk *chunk = pages_grow(NULL, 0, size);
    if (!chunk && size > least) {
        size = least;
        chunk = malloc(size);
    }
    if (chunk) {
        chunk->size = size;
        arena->bytes_reserved += size;
        if (arena->shared) {
            arena->shared->used += size;
        }
    }
    return chunk;
}

static bool arena_grow(Arena *arena, size_t size)
{
    if (size > SIZE_MAX - HEADER_SIZE) {
        return false;
    }
    ArenaChunk *newest = arena->chunk;
    ArenaChunk *chunk = newest ? newest->spare : NULL;
    if (chunk && chunk->size - HEADER_SIZE < size) {
        chunk_free(arena, chunk);
        newest->spare = NULL;
        chunk = NULL;
    }
    if (!chunk) {
        chunk = chunk_new(arena, HEADER_SIZE + size);
    }
    if (!chunk) {
        return false;
    }
    if (newest) {
        newest->spare = NULL;
    }
    arena_use_chunk(arena, chunk, newest);
    return true;
}

void arena_init(Arena *arena, size_t budget)
{
    *arena = (Arena){.budget = budget};
}

void arena_init_shared(Arena *arena, MemoryBudget *shared)
{
    *arena = (Arena){.budget = SIZE_MAX, .shared = shared};
}

void arena_fini(Arena *arena)
{
    while (arena->chunk) {
        ArenaChunk *chunk = arena->chunk;
        arena->chunk = chunk->older;
        chunk_free(arena, chunk->spare);
        chunk_free(arena, chunk);
    }
    *arena = (Arena){.budget = arena->budget, .shared = arena->shared};
}

void *arena_alloc(Arena *arena, size_t size)
{
    if (RT_UNLIKELY(size > SIZE_MAX - ALIGNMENT)) {
        return NULL;
    }
    size_t rounded = size ? (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT : ALIGNMENT;
    if (RT_UNLIKELY(!arena->chunk || (size_t)(arena->end - arena->next) < rounded)) {
        if (!arena_grow(arena, rounded)) {
            return NULL;
        }
    }
    char *bytes = arena->next;
    arena->next += rounded;
    hidden_take(bytes, size);
    return bytes;
}

void *arena_alloc_array(Arena *arena, size_t count, size_t size)
{
    size_t bytes;
    return __builtin_mul_overflow(count, size, &bytes) ? NULL : arena_alloc(arena, bytes);
}

void *arena_copy(Arena *arena, const void *bytes, size_t size)
{
    void *copy = arena_alloc(arena, size);
    if (copy && size) {
        memcpy(copy, bytes, size);
    }
    return copy;
}

char *arena_copy_text(Arena *arena, const char *text, size_t length)
{
    char *copy = length < SIZE_MAX ? arena_alloc(arena, length + 1) : NULL;
    if (copy) {
        if (length) {
            memcpy(copy, text, length);
        }
        copy[length] = '\0';
    }
    return copy;
}

ArenaMark arena_mark(const Arena *arena)
{
    return (ArenaMark){arena->chunk, arena->next};
}

void arena_rewind(Arena *arena, ArenaMark mark)
{
    ArenaChunk *kept = NULL; // the greatest of the freed ones, so that the loop that comes again finds room
    // A mark taken while the arena was empty has no chunk: the whole list is walked.
    while (arena->chunk != mark.chunk) {
        ArenaChunk *chunk = arena->chunk;
        ArenaChunk *candidates[] = {chunk->spare, chunk};
        arena->chunk = chunk->older;
        for (size_t i = 0; i < RT_COUNT_OF(candidates); i++) {
            ArenaChunk *candidate = candidates[i];
            if (!kept || (candidate && candidate->size > kept->size)) {
                chunk_free(arena, kept);
                kept = candidate;
            } else {
                chunk_free(arena, candidate);
            }
        }
    }
    if (mark.chunk) {
        char *end = (char *)mark.chunk + mark.chunk->size;
        const char *used = arena->end == end ? arena->next : end;
        hidden_put(mark.next, (size_t)(used - mark.next));
        arena->next = mark.next;
        arena->end = end;
        if (kept) {
            mark.chunk->spare = kept;
        }
    } else if (kept) {
        arena_use_chunk(arena, kept, NULL);
    }
}
