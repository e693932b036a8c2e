// Arena: memory that is handed out piece by piece and given back all at once, or back to a mark.
//
// rtlang has three lifetimes, each one arena: parse (the AST of the current statement), program (what the
// scene declares) and scratch (temporaries; mark and rewind). There are no reference counts.
// An arena is used by one thread at a time.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_ARENA_H
#define BASE_ARENA_H

#include <stdbool.h>
#include <stddef.h>

#include "base/attributes.h"

typedef struct ArenaChunk ArenaChunk;

// What several arenas may take together, and have taken.
typedef struct MemoryBudget {
    size_t limit, used;
    bool refused; // something did not fit
} MemoryBudget;

typedef struct Arena {
    ArenaChunk *chunk;     // the newest chunk, which links to the older ones; NULL when empty
    char *next;            // first free byte of the newest chunk
    char *end;             // one past its last byte
    size_t bytes_reserved; // bytes taken from the system by all chunks
    size_t budget;         // bytes_reserved never exceeds this
    MemoryBudget *shared;  // counts the bytes of all arenas that share it; NULL: none does
} Arena;

// A place to come back to. Valid until the arena is rewound to an earlier mark or finished.
typedef struct ArenaMark {
    ArenaChunk *chunk;
    char *next;
} ArenaMark;

// Prepares an empty arena. `budget` is the greatest number of bytes it may take from the system.
void arena_init(Arena *arena, size_t budget);

// The same for an arena that shares a budget with others. The budget must outlive it.
void arena_init_shared(Arena *arena, MemoryBudget *shared);

// Gives all memory back; the arena is empty again and may be used again.
void arena_fini(Arena *arena);

// `size` bytes aligned to 16, not cleared. NULL when memory or budget is exhausted (the arena stays usable).
void *arena_alloc(Arena *arena, size_t size) RT_MUST_CHECK;

// The same for `count` elements of `size` bytes; NULL also when the product overflows.
void *arena_alloc_array(Arena *arena, size_t count, size_t size) RT_MUST_CHECK;

// A copy of `size` bytes, or NULL.
void *arena_copy(Arena *arena, const void *bytes, size_t size) RT_MUST_CHECK;

// A zero-terminated copy of `length` characters, or NULL.
char *arena_copy_text(Arena *arena, const char *text, size_t length) RT_MUST_CHECK;

ArenaMark arena_mark(const Arena *arena);

// Frees everything allocated since the mark. One chunk is kept for reuse, so a loop of mark and rewind
// does not go to the system.
void arena_rewind(Arena *arena, ArenaMark mark);

#endif
