// InternTable: text to symbol by an open hash table of symbols, symbol to text by an array.
//
// Owns the texts, in an arena. A slot holds a symbol only; the hash stands with the text, so that growing the table
// reads no text.
//
// SPDX-License-Identifier: MIT
#include "base/intern.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/array.h"

enum { SLOTS_LEAST = 256 };

typedef struct Entry {
    const char *text;
    size_t length;
    uint64_t hash;
} Entry;

struct InternTable {
    Arena arena;
    ARRAY(Entry) entries; // entry 0 is SYMBOL_NONE
    Symbol *slots;        // linear probing; SYMBOL_NONE is a free slot
    size_t slot_count;    // a power of two, at least 4/3 of the entries
    size_t text_bytes, budget;
};

// FNV-1a (Fowler, Noll, Vo), then a multiply and shift, since the table takes the low bits.
static uint64_t text_hash(const char *text, size_t length)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t i = 0; i < length; i++) {
        hash = (hash ^ (unsigned char)text[i]) * 0x100000001b3u;
    }
    hash ^= hash >> 32;
    hash *= 0x9e3779b97f4a7c15u;
    return hash ^ (hash >> 29);
}

// The slot that holds the text, or the free slot where it belongs.
static size_t intern_slot(const InternTable *table, const char *text, size_t length, uint64_t hash)
{
    size_t mask = table->slot_count - 1;
    for (size_t slot = hash & mask;; slot = (slot + 1) & mask) {
        Symbol symbol = table->slots[slot];
        if (symbol == SYMBOL_NONE) {
            return slot;
        }
        const Entry *entry = &table->entries.items[symbol];
        if (entry->hash == hash && entry->length == length && (length == 0 || memcmp(entry->text, text, length) == 0)) {
            return slot;
        }
    }
}

static bool intern_grow(InternTable *table)
{
    size_t slot_count = table->slot_count ? table->slot_count * 2 : SLOTS_LEAST;
    Symbol *slots = calloc(slot_count, sizeof(*slots));
    if (!slots) {
        return false;
    }
    size_t mask = slot_count - 1;
    for (size_t symbol = 1; symbol < table->entries.count; symbol++) {
        size_t slot = table->entries.items[symbol].hash & mask;
        while (slots[slot] != SYMBOL_NONE) {
            slot = (slot + 1) & mask;
        }
        slots[slot] = (Symbol)symbol;
    }
    free(table->slots);
    table->slots = slots;
    table->slot_count = slot_count;
    return true;
}

InternTable *intern_new(size_t budget)
{
    InternTable *table = calloc(1, sizeof(*table));
    if (!table) {
        return NULL;
    }
    arena_init(&table->arena, SIZE_MAX);
    table->budget = budget;
    if (!ARRAY_PUSH(&table->entries, (Entry){.text = ""}) || !intern_grow(table)) {
        intern_free(table);
        return NULL;
    }
    return table;
}

void intern_free(InternTable *table)
{
    if (table) {
        free(table->slots);
        ARRAY_FREE(&table->entries);
        arena_fini(&table->arena);
        free(table);
    }
}

static Symbol intern_add(InternTable *table, const char *text, size_t length, uint64_t hash, size_t slot)
{
    size_t symbol = table->entries.count;
    if (length >= table->budget - table->text_bytes || symbol > UINT32_MAX) {
        return SYMBOL_NONE;
    }
    if (symbol >= table->slot_count / 4 * 3) {
        if (!intern_grow(table)) {
            return SYMBOL_NONE;
        }
        slot = intern_slot(table, text, length, hash);
    }
    const char *copy = arena_copy_text(&table->arena, text, length);
    if (!copy || !ARRAY_PUSH(&table->entries, (Entry){copy, length, hash})) {
        return SYMBOL_NONE;
    }
    table->text_bytes += length + 1;
    table->slots[slot] = (Symbol)symbol;
    return (Symbol)symbol;
}

Symbol intern_text(InternTable *table, const char *text, size_t length)
{
    uint64_t hash = text_hash(text, length);
    size_t slot = intern_slot(table, text, length, hash);
    Symbol known = table->slots[slot];
    return known != SYMBOL_NONE ? known : intern_add(table, text, length, hash, slot);
}

Symbol intern_find(const InternTable *table, const char *text, size_t length)
{
    return table->slots[intern_slot(table, text, length, text_hash(text, length))];
}

const char *intern_get(const InternTable *table, Symbol symbol)
{
    return symbol < table->entries.count ? table->entries.items[symbol].text : "";
}

size_t intern_length(const InternTable *table, Symbol symbol)
{
    return symbol < table->entries.count ? table->entries.items[symbol].length : 0;
}

size_t intern_count(const InternTable *table)
{
    return table->entries.count;
}
