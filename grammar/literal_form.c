// The form of a literal sphere: all of its text but the numbers, so that the next one of the same form is compared with
// it piece by piece, and nothing but its numbers is read.
//
// Programs write statements that differ in their numbers only, blanks and all. What literal.c has read is taken apart
// here; what is of its form is then read alike, and anything else is refused and left to literal.c.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "base/plain.h"
#include "grammar/literal.h"

// The numbers before the colour: of the centre, and the radius.
enum { HEAD_NUMBERS = 4 };

// What stands between a number and the next one.
static bool gap_learn(LiteralGap *gap, const char *begin, const char *end)
{
    static const char ones[sizeof gap->text] = {-1, -1, -1, -1, -1, -1, -1, -1};
    size_t length = (size_t)(end - begin);
    if (length > sizeof gap->text) {
        return false;
    }
    *gap = (LiteralGap){.length = length};
    memcpy(&gap->text, begin, length);
    memcpy(&gap->mask, ones, length);
    return true;
}

// Passes over what may stand between two numbers.
static const char *find_number(const char *at)
{
    while (plain_is_blank(*at) || *at == ',' || *at == '>') {
        at++;
    }
    return at;
}

// The gaps between `count` numbers, the first of which begins here; returns the end of the last. NULL: no form.
static const char *row_learn(LiteralGap *gaps, const char *at, const char *end, unsigned count)
{
    double number;
    for (unsigned i = 0; i < count; i++) {
        const char *after = plain_read_number(at, end, &number);
        if (after == NULL || i + 1 == count) {
            return after;
        }
        at = find_number(after);
        if (!gap_learn(&gaps[i], after, at)) {
            return NULL;
        }
    }
    return at;
}

static unsigned colour_numbers(Word word)
{
    return word == 0 ? 0 : word == W_rgb ? 3 : word == W_rgbft ? 5 : 4;
}

// What LiteralPattern leaves open, blanks around the numbers of the colour, belongs to no form.
static bool form_take_apart(LiteralForm *form, const LiteralPattern *pattern, const char *begin, const char *end)
{
    const char *first = memchr(begin, '<', (size_t)(end - begin));
    first = first != NULL ? plain_skip_blanks(first + 1) : end;
    form->head_length = (size_t)(first - begin);
    if (form->head_length > sizeof form->head) {
        return false;
    }
    memcpy(form->head, begin, form->head_length);
    const char *at = row_learn(form->gaps, first, end, HEAD_NUMBERS);
    form->colours = colour_numbers(pattern->word);
    if (at == NULL || pattern->word == 0) {
        return at != NULL;
    }
    at = row_learn(form->gaps + HEAD_NUMBERS, at + pattern->before, end, form->colours);
    return at != NULL && *at == pattern->text[pattern->before];
}

void literal_form_learn(LiteralForm *form, const LiteralPattern *pattern, const char *begin, const char *end)
{
    form->pattern = form_take_apart(form, pattern, begin, end) ? pattern : NULL;
}

// `count` numbers with the gaps between them.
RT_ALWAYS_INLINE const char *row_read(const LiteralGap *gaps, const char *at, const char *end, unsigned count,
                                      double *numbers)
{
    for (unsigned i = 0; i < count; i++) {
        at = plain_read_number(at, end, &numbers[i]);
        if (at == NULL || i + 1 == count) {
            return at;
        }
        uint64_t text;
        memcpy(&text, at, sizeof text);
        if ((text & gaps[i].mask) != gaps[i].text) {
            return NULL;
        }
        at += gaps[i].length;
    }
    return at;
}

static const char *colour_read(const LiteralForm *form, const char *at, const char *end, GrammarLiteral *literal)
{
    double colour[5];
    at = row_read(form->gaps + HEAD_NUMBERS, at, end, form->colours, colour);
    if (at == NULL) {
        return NULL;
    }
    bool has_transmit = form->pattern->word == W_rgbt;
    literal->colours = form->pattern->word == W_rgb ? 3 : 5;
    for (unsigned i = 0; i < 3; i++) {
        literal->kind.colour[i] = (float)colour[i];
    }
    if (literal->colours == 5) {
        literal->kind.colour[3] = has_transmit ? 0.0F : (float)colour[3];
        literal->kind.colour[4] = has_transmit ? (float)colour[3] : form->colours == 5 ? (float)colour[4] : 0.0F;
    }
    return at;
}

const char *literal_form_read(const LiteralForm *form, const char *at, const char *end, GrammarLiteral *literal)
{
    const LiteralPattern *pattern = form->pattern;
    double numbers[HEAD_NUMBERS];
    if (pattern == NULL || end - at < LITERAL_STATEMENT_LONGEST || memcmp(at, form->head, form->head_length) != 0) {
        return NULL;
    }
    at = row_read(form->gaps, at + form->head_length, end, HEAD_NUMBERS, numbers);
    if (at == NULL || !(numbers[3] > 0.0) || memcmp(at, pattern->text, pattern->before) != 0) {
        return NULL;
    }
    memcpy(literal->centre, numbers, sizeof literal->centre);
    literal->radius = numbers[3];
    literal->kind = pattern->kind;
    literal->colours = 0;
    at += pattern->before;
    at = form->colours > 0 ? colour_read(form, at, end, literal) : at;
    bool is_like = at != NULL && memcmp(at, pattern->text + pattern->before, pattern->after) == 0;
    return is_like ? at + pattern->after : NULL;
}
