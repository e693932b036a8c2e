// Open addressing with linear probing, at most half full, so that runs of taken slots stay short.
//
// Turns a record's bytes into a place; owns the slots only.
//
// SPDX-License-Identifier: MIT
#include "scene/unique.h"

#include <string.h>

enum {
    SLOTS_LEAST = 16,
    TRIED_LEAST = 1 << 16, // records after which it is seen whether they repeat
    FOUND_SHARE = 8,       // one of so many must have had an equal; a slot costs less than what it spares then
};

// A multiplication by an odd constant and a shift that carries high bits down, as in the finalizer of MurmurHash3
// (A. Appleby, public domain).
static inline uint64_t hash_word(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * UINT64_C(0xff51afd7ed558ccd);
    return hash ^ hash >> 33;
}

// Eight bytes at a time, and four that are left.
static uint64_t hash_bytes(const void *record, size_t size)
{
    const unsigned char *bytes = record;
    uint64_t hash = 0, wide;
    uint32_t word;
    size_t i = 0;
    for (; i + sizeof wide <= size; i += sizeof wide) {
        memcpy(&wide, bytes + i, sizeof wide);
        hash = hash_word(hash, wide);
    }
    if (i + sizeof word <= size) {
        memcpy(&word, bytes + i, sizeof word);
        hash = hash_word(hash, word);
    }
    return hash;
}

// The slot that holds an equal record, or the empty one where it belongs. The table is never full.
static uint32_t *find_slot(const UniqueIndex *index, const void *records, size_t size, const void *record)
{
    size_t mask = index->slots.count - 1;
    for (size_t at = (size_t)hash_bytes(record, size) & mask;; at = (at + 1) & mask) {
        uint32_t *slot = &index->slots.items[at];
        if (*slot == 0 || memcmp((const char *)records + (*slot - 1) * size, record, size) == 0) {
            return slot;
        }
    }
}

static bool grow(UniqueIndex *index, const void *records, size_t count, size_t size)
{
    size_t slots = index->slots.count ? 2 * index->slots.count : SLOTS_LEAST;
    if (!ARRAY_RESERVE(&index->slots, slots)) {
        return false;
    }
    index->slots.count = slots;
    memset(index->slots.items, 0, slots * sizeof *index->slots.items);
    for (size_t i = 0; i < count; i++) {
        *find_slot(index, records, size, (const char *)records + i * size) = (uint32_t)i + 1;
    }
    return true;
}

// The record that was added last, which most are like; compared word by word, for they are short.
static inline bool is_last(const UniqueIndex *index, const void *records, size_t count, size_t size, const void *record)
{
    if (index->last >= count) {
        return false;
    }
    const char *one = (const char *)records + index->last * size, *other = record;
    size_t at = 0;
    for (; at + sizeof(uint64_t) <= size; at += sizeof(uint64_t)) {
        uint64_t a, b;
        memcpy(&a, one + at, sizeof a);
        memcpy(&b, other + at, sizeof b);
        if (a != b) {
            return false;
        }
    }
    return at == size || memcmp(one + at, other + at, size - at) == 0;
}

bool unique_place(UniqueIndex *index, const void *records, size_t count, size_t size, const void *record,
                  uint32_t *place)
{
    if (is_last(index, records, count, size, record)) {
        *place = index->last;
        return true;
    }
    if (2 * (count + 1) > index->slots.count && !grow(index, records, count, size)) {
        return false;
    }
    uint32_t *slot = find_slot(index, records, size, record);
    if (*slot == 0) {
        if (count >= UINT32_MAX - 1) {
            return false;
        }
        *slot = (uint32_t)count + 1;
    }
    *place = index->last = *slot - 1;
    return true;
}

void unique_give_up(UniqueIndex *index)
{
    ARRAY_FREE(&index->slots);
    index->is_given_up = true;
    index->last = UINT32_MAX;
}

bool unique_place_if_worth(UniqueIndex *index, const void *records, size_t count, size_t size, const void *record,
                           uint32_t *place)
{
    if (!index->is_given_up) {
        if (count < TRIED_LEAST || index->found >= count / FOUND_SHARE) {
            if (is_last(index, records, count, size, record)) {
                index->found++;
                *place = index->last;
                return true;
            }
            bool is_placed = unique_place(index, records, count, size, record, place);
            index->found += is_placed && *place < count;
            return is_placed;
        }
        ARRAY_FREE(&index->slots);
        index->is_given_up = true;
    }
    if (is_last(index, records, count, size, record)) {
        *place = index->last;
        return true;
    }
    if (count >= UINT32_MAX - 1) {
        return false;
    }
    *place = index->last = (uint32_t)count;
    return true;
}

void unique_fini(UniqueIndex *index)
{
    ARRAY_FREE(&index->slots);
    *index = (UniqueIndex){0};
}
