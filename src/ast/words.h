// The reserved words of the language: all of POV-Ray 3.7's, so that every file that rtlang accepts is one that POV-Ray
// accepts. A word is its Symbol; the reserved ones are interned first, in the order of ast/words.def, so the class of a
// symbol is a table look-up.
//
// SPDX-License-Identifier: MIT
#ifndef AST_WORDS_H
#define AST_WORDS_H

#include <stdbool.h>

#include "base/attributes.h"
#include "base/intern.h"

typedef enum WordClass {
    WORD_IDENTIFIER, // not reserved
    WORD_PLAIN,      // starts a block or names a property or a flag: sphere, ambient, no_shadow
    WORD_COLOUR,     // color, rgb, red, filter, …
    WORD_TEXTURE,    // texture, which may be layered on the right of a #declare
    WORD_ARRAY,      // array
    WORD_FUNCTION,   // function
    WORD_TERM,       // xyz, of the coefficients of a polynomial
    WORD_BUILTIN,    // a function with parentheses: sin, vlength, concat
    WORD_CONSTANT,   // a value by itself: x, pi, yes, clock
    WORD_DIRECTIVE,  // reserved because it follows `#`
} WordClass;

typedef enum Word {
    WORD_NONE, // symbol 0
#define WORD(name, class) W_##name,
#include "ast/words.def"
#undef WORD
    WORD_COUNT
} Word;

// Makes every reserved word's symbol equal to its Word. Call first on a fresh table. False when out of memory.
bool words_intern(InternTable *table) RT_MUST_CHECK;

WordClass word_class(Symbol symbol);

#endif
