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

// Numbers that differ from statement to statement: of the pigment's colour, or of a transform.
typedef struct LiteralPart {
    size_t before; // bytes of text between the numbers before it, or the radius, and its own
    Word word;     // before its numbers
    unsigned count;
} LiteralPart;

enum { LITERAL_PARTS = GRAMMAR_MOVES_MOST + 1 };

struct LiteralPattern {
    char *text;          // all but the numbers
    LiteralPart parts[LITERAL_PARTS];
    unsigned part_count;
    size_t after;        // bytes of text behind the last numbers
    bool has_moves;      // some are of transforms
    bool is_used;        // the evaluator knows what it gives; else such statements are not read here
    GrammarLiteralKind kind;
};

// Reads the statement that begins here, all but its span, into *literal and *moves: returns its end, and sets the
// pattern it is like. NULL: it is like none, or not a literal sphere at all, and *text, the text after the radius, is
// NULL.
const char *literal_read(LiteralPattern *const *patterns, const char *at, const char *end, GrammarLiteral *literal,
                         GrammarMoves *moves, unsigned *which, const char **text);

// The form of a statement that is like a pattern: all of its text but the numbers (literal_form.c).
typedef struct LiteralGap {
    uint64_t text, mask; // as eight bytes stand in the text; of those behind the gap nothing is asked
    size_t length;
} LiteralGap;

// The digits of the number that stood in a place when its form was learnt, `0.731272` or `12`: the next one there mostly
// has as many, and is read without looking for its point and its end. With its point it has no more than eight bytes.
typedef struct LiteralDigits {
    uint64_t text, mask;   // zeros and the point, as eight bytes stand in the text; of those behind them nothing is asked
    uint64_t whole, point; // the bytes before the point, and that of the point
    unsigned length, shift; // bytes, 0: digits of another kind; bits of those that are left over
    double divisor[2];      // of what the digits are together, and of that with a minus sign
} LiteralDigits;

enum {
    LITERAL_NUMBERS = 9,   // centre, radius and colour
    LITERAL_ODD_MOST = 36, // numbers of other digits: the form is learnt again
};

typedef struct LiteralForm {
    const LiteralPattern *pattern; // NULL: none is known
    char head[32];                 // up to the first number
    size_t head_length, before;    // bytes; of the text between the radius and the numbers of the colour
    LiteralGap gaps[LITERAL_NUMBERS]; // between centre and radius, then between the numbers of the colour
    LiteralDigits digits[LITERAL_NUMBERS]; // of the numbers in the same order
    unsigned colours;                 // numbers of the colour
    bool is_even;                     // the digits are mostly those of before
    unsigned odd, statements, learnt; // numbers of other digits, and statements, since it was learnt; how often that was
} LiteralForm;

// Of a statement that was read by literal_read; one that says a transform has no form.
void literal_form_learn(LiteralForm *form, const LiteralPattern *pattern, const char *begin, const char *end);
// As literal_read, of a statement of this form that the buffer does not end soon after; NULL: it is none.
const char *literal_form_read(LiteralForm *form, const char *at, const char *end, GrammarLiteral *literal);

// A literal that ends here was taken: as if its tokens had been delivered.
void literal_set_previous(GrammarState *state, uint64_t end);

#endif
