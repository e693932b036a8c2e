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
    LITERALS_MANY = 128,              // so many in a buffer: it is worth while to look for more piece by piece
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

// The form of a statement that is like a pattern: all of its text but the numbers (literal_form.c).
typedef struct LiteralGap {
    uint64_t text, mask; // as eight bytes stand in the text; of those behind the gap nothing is asked
    size_t length;
} LiteralGap;

typedef struct LiteralForm {
    const LiteralPattern *pattern; // NULL: none is known
    char head[32];                 // up to the first number
    size_t head_length;
    LiteralGap gaps[9];            // between centre and radius, then between the numbers of the colour
    unsigned colours;              // numbers of the colour
} LiteralForm;

// Of a statement that was read by literal_read.
void literal_form_learn(LiteralForm *form, const LiteralPattern *pattern, const char *begin, const char *end);
// As literal_read, of a statement of this form that the buffer does not end soon after; NULL: it is none.
const char *literal_form_read(const LiteralForm *form, const char *at, const char *end, GrammarLiteral *literal);

// A literal that ends here was taken: as if its tokens had been delivered.
void literal_set_previous(GrammarState *state, uint64_t end);

#endif
