// Storage of texts and arrays that variables own.
//
// Small blocks come from the program arena and return to lists by size; large ones are the system's. Each block has a
// header before it with the number of its storing. Built with AddressSanitizer, everything that is retired is looked at
// at each step, and what is given back is poisoned and not taken again. Knows nothing of names.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "base/hidden.h"
#include "eval/values/kept.h"

enum {
    GRAIN = 16,
    GRAINS_FEW = 8,     // so many sizes are each a class; above them there are eight to a factor of two
    SMALL_MOST = 32768, // bytes of a block from the arena, with its header
    SETTLE_LEAST = 65536,
    BIRTH_BITS = 55,
};

struct KeptBlock {
    KeptBlock *next; // in the list of free ones, or of retired ones
    uint64_t birth : BIRTH_BITS;
    uint64_t is_array : 1;
    uint64_t class : 8; // 0: large
};

// Of the system's memory; all are in a list.
typedef struct LargeBlock LargeBlock;
struct LargeBlock {
    LargeBlock *before, *after;
    size_t size; // with this head
    uint64_t unused;
    KeptBlock block;
};
_Static_assert(sizeof(KeptBlock) == GRAIN, "what follows the header is aligned");
_Static_assert(sizeof(LargeBlock) == 3 * GRAIN, "there, too");

static LargeBlock *large_of(KeptBlock *block)
{
    return (LargeBlock *)((char *)block - offsetof(LargeBlock, block));
}

// The class of the least block that holds so many grains, and how many it holds.
static unsigned class_of(unsigned grains, unsigned *held)
{
    if (grains <= GRAINS_FEW) {
        *held = grains;
        return grains;
    }
    unsigned shift = 28 - (unsigned)__builtin_clz(grains - 1), eighths = ((grains - 1) >> shift) + 1;
    *held = eighths << shift;
    return shift * GRAINS_FEW + eighths;
}

static size_t size_of(const KeptBlock *block)
{
    if (block->class == 0) {
        return large_of((KeptBlock *)block)->size - offsetof(LargeBlock, block);
    }
    unsigned class = block->class, shift = class <= 2 * GRAINS_FEW ? 0 : (class - GRAINS_FEW - 1) / GRAINS_FEW;
    return (size_t)((class - shift * GRAINS_FEW) << shift) * GRAIN;
}

// ---- large blocks

static KeptBlock *take_large(Eval *ev, size_t size)
{
    MemoryBudget *memory = &ev->memory;
    size_t left = memory->limit > memory->used ? memory->limit - memory->used : 0;
    if (size > left) {
        memory->refused = true;
        return NULL;
    }
    LargeBlock *large = malloc(size);
    if (large == NULL) {
        return NULL;
    }
    memory->used += size;
    *large = (LargeBlock){.after = ev->kept.large, .size = size};
    if (large->after != NULL) {
        large->after->before = large;
    }
    ev->kept.large = large;
    return &large->block;
}

static void free_large(Eval *ev, LargeBlock *large)
{
    if (large->before != NULL) {
        large->before->after = large->after;
    } else {
        ev->kept.large = large->after;
    }
    if (large->after != NULL) {
        large->after->before = large->before;
    }
    ev->memory.used -= large->size;
    free(large);
}

// ---- all blocks

static KeptBlock *take_small(Eval *ev, size_t size)
{
    unsigned held, class = class_of((unsigned)((size + GRAIN - 1) / GRAIN), &held);
    KeptBlock **list = &ev->kept.free[class], *block = *list;
    if (block != NULL) {
        *list = block->next;
        hidden_take(block + 1, (held - 1) * sizeof *block);
    } else {
        block = arena_alloc(&ev->program, (size_t)held * GRAIN);
    }
    if (block != NULL) {
        block->class = class & UINT8_MAX;
    }
    return block;
}

void *kept_take(Eval *ev, size_t size, bool is_array)
{
    if (size > SIZE_MAX - sizeof(LargeBlock)) {
        return NULL;
    }
    bool is_small = size <= SMALL_MOST - sizeof(KeptBlock);
    KeptBlock *block = is_small ? take_small(ev, sizeof *block + size) : take_large(ev, sizeof(LargeBlock) + size);
    if (block == NULL) {
        return NULL;
    }
    block->next = NULL;
    block->birth = ++ev->kept.births & (((uint64_t)1 << BIRTH_BITS) - 1);
    block->is_array = is_array;
    return block + 1;
}

static void free_block(Eval *ev, KeptBlock *block)
{
    if (block->class == 0) {
        free_large(ev, large_of(block));
        return;
    }
    hidden_put(block + 1, size_of(block) - sizeof *block);
    if (!HIDDEN_IS_ON) {
        block->next = ev->kept.free[block->class];
        ev->kept.free[block->class] = block;
    }
}

static KeptBlock *block_of(const Value *value)
{
    const void *begin = value->kind == VALUE_STRING ? (const void *)value->text : (const void *)value->array;
    return (KeptBlock *)begin - 1;
}

static void retire(Eval *ev, KeptBlock *block)
{
    block->next = ev->kept.retired;
    ev->kept.retired = block;
    ev->kept.retired_bytes += size_of(block);
}

// Blocks in a list, each with what its elements own, however deep they nest.
static void give_back(Eval *ev, KeptBlock *list)
{
    while (list != NULL) {
        KeptBlock *block = list;
        list = block->next;
        const ValueArray *array = block->is_array ? (const ValueArray *)(block + 1) : NULL;
        if (array != NULL && array->reference_count > 0) {
            retire(ev, block);
            continue;
        }
        bool has_owners = array != NULL && kept_is_owned(&array->first);
        for (size_t i = 0; has_owners && i < array->count; i++) {
            if (kept_is_owned(&array->elements[i])) {
                KeptBlock *own = block_of(&array->elements[i]);
                own->next = list;
                list = own;
            }
        }
        free_block(ev, block);
    }
}

void kept_give_back(Eval *ev, const Value *value)
{
    KeptBlock *block = block_of(value);
    block->next = NULL;
    give_back(ev, block);
}

void kept_retire(Eval *ev, const Value *value)
{
    retire(ev, block_of(value));
}

void kept_settle(Eval *ev, uint64_t since)
{
    KeptBlock *block = ev->kept.retired, *next;
    ev->kept.retired = NULL;
    ev->kept.retired_bytes = 0;
    for (; block != NULL; block = next) {
        next = block->next;
        if (block->birth > since) {
            block->next = NULL;
            give_back(ev, block);
        } else {
            retire(ev, block);
        }
    }
    size_t twice = 2 * ev->kept.retired_bytes;
    ev->kept.settle_at = HIDDEN_IS_ON ? 0 : twice < SETTLE_LEAST ? SETTLE_LEAST : twice;
}

void kept_init(Eval *ev)
{
    kept_settle(ev, 0);
}

void kept_fini(Eval *ev)
{
    while (ev->kept.large != NULL) {
        free_large(ev, ev->kept.large); // NOLINT(clang-analyzer-unix.Malloc): nothing is before the first one
    }
}
