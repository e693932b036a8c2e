// What the readers of literal spheres share: one statement (literal.c), and long runs of them (literal_many.c).
//
// Private to the grammar.
//
// SPDX-License-Identifier: MIT
#ifndef GRAMMAR_LITERAL_H
#define GRAMMAR_LITERAL_H

#include "grammar/lexer.h"

enum {
    LITERAL_TEXT_LONGEST = 4096,      // of what follows the radius
    LITERAL_STATEMENT_LONGEST = 8192, // with its numbers and as many blanks as there are usually
    LITERALS_MANY = 128,              // so many in a buffer: it is worth while to look for more on several threads
};

struct LiteralPattern {
    char *text;          // before the gap, then after it
    size_t before, after;
    Word word;           // before the numbers in the gap; 0: there is none
    bool is_used;        // the evaluator knows what it gives; else such statements are not read here
    GrammarLiteralKind kind;
};

// Reads the statement that begins here, all but its span, into *literal: returns its end, and sets the pattern it is
// like. NULL: it is like none, or not a literal sphere at all, and *text, the text after the radius, is NULL.
const char *literal_read(LiteralPattern *const *patterns, const char *at, const char *end, GrammarLiteral *literal,
                         unsigned *which, const char **text);

// A literal that ends here was taken: as if its tokens had been delivered.
void literal_set_previous(GrammarState *state, uint64_t end);

#endif
