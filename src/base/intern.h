// InternTable: each distinct piece of text becomes one small number, its Symbol, for the life of the table.
//
// Symbols are dense and start at 1, in order of first appearance, so that tables can be indexed by them.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_INTERN_H
#define BASE_INTERN_H

#include <stddef.h>
#include <stdint.h>

#include "base/attributes.h"

typedef uint32_t Symbol;
#define SYMBOL_NONE ((Symbol)0)

typedef struct InternTable InternTable;

// NULL when out of memory. `budget` is the greatest number of bytes of text it may hold, a zero at the
// end of each included.
InternTable *intern_new(size_t budget) RT_MUST_CHECK;
void intern_free(InternTable *table);

// The symbol of `length` bytes (which may hold zeros), made if it is new; SYMBOL_NONE when out of memory or budget.
Symbol intern_text(InternTable *table, const char *text, size_t length) RT_MUST_CHECK;

// The symbol of a text that is already known, or SYMBOL_NONE. Makes nothing.
Symbol intern_find(const InternTable *table, const char *text, size_t length);

// The zero-terminated text of a symbol, valid for the life of the table; "" for SYMBOL_NONE.
const char *intern_get(const InternTable *table, Symbol symbol);
size_t intern_length(const InternTable *table, Symbol symbol);

// One more than the greatest symbol made so far.
size_t intern_count(const InternTable *table);

#endif
