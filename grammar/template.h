// Templates: the text of a statement with numbered slots, where the numbers stand that differ from time to time.
//
// A template is made of a text that was read before; text that is the same but for the numbers in its slots, and the
// blanks around them, is matched without tokens, a parser or a tree, and gives the numbers. Private to the grammar;
// knows nothing of what words mean.
//
// SPDX-License-Identifier: MIT
#ifndef GRAMMAR_TEMPLATE_H
#define GRAMMAR_TEMPLATE_H

#include "grammar/grammar.h"

// How the number in a slot was written last, `0.731272` or `12`: the next one mostly has as many digits, and is read
// without looking for its point and its end. With its point it has no more than eight bytes.
typedef struct TemplateDigits {
    uint64_t text, mask;    // zeros and the point, as eight bytes stand in the text; those behind them do not count
    uint64_t whole, point;  // the bytes before the point, and that of the point
    unsigned length, shift; // bytes, 0: digits of another kind; bits of those that are left over
    unsigned missed;        // how one was written that was not so
    double divisor[2];      // of what the digits are together, and of that with a minus sign
} TemplateDigits;

// Text that stands before a number, or behind the last one.
typedef struct TemplatePiece {
    uint64_t text, mask; // its first eight bytes
    const char *bytes;
    size_t length;
    TemplateDigits digits; // of the number behind it
} TemplatePiece;

typedef struct Template {
    const GrammarPlan *plan; // what the evaluator makes of its numbers; NULL: such a text is parsed
    bool is_batched;         // see GrammarHooks
    bool is_call;            // what follows must begin another item
    unsigned slots;
    char *text; // all pieces
    TemplatePiece pieces[]; // slots + 1
} Template;

// Takes the text apart that begins here with a word: to the brace, or of a call the parenthesis, that closes it. Returns
// its length and the numbers in it, all of them slots. 0: it holds anything but words of the language, numbers, commas
// and brackets, or is too long.
size_t template_survey(const GrammarContext *context, const char *text, const char *end, uint64_t offset,
                       GrammarSlot *slots, unsigned *count);

// Of a text at an offset, with the slots that are used; NULL when out of memory.
Template *template_new(const char *text, size_t length, uint64_t offset, const GrammarSlot *slots,
                       unsigned count) RT_MUST_CHECK;
void template_free(Template *template);
Template *template_copy(const Template *template) RT_MUST_CHECK; // shares the text; to be freed by free()

// Where a text ends that is like the template, with the numbers of its slots; NULL: it is not. WINDOW_PADDING zeros stand
// behind `end`.
const char *template_match(Template *template, const char *at, const char *end, double *numbers);

// The same, and where each number stands.
typedef struct TemplatePlace {
    const char *begin, *end; // with its sign
} TemplatePlace;
const char *template_find(Template *template, const char *at, const char *end, double *numbers, TemplatePlace *places);

#endif
