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

enum {
    HEAD_NUMBERS = 4, // before the colour: of the centre, and the radius
    LEARNT_MOST = 3,  // so many times it is tried whether digits stay what they are
};

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

// That no text has.
static const LiteralDigits any_digits = {.mask = UINT64_MAX, .point = UINT64_MAX};

static void digits_learn(LiteralDigits *digits, const char *begin, const char *end)
{
    *digits = any_digits;
#if defined __BYTE_ORDER__ && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    begin += *begin == '-';
    size_t length = (size_t)(end - begin), whole = 0;
    while (whole < length && plain_is_digit(begin[whole])) {
        whole++;
    }
    size_t fraction = length > whole ? length - whole - 1 : 0;
    bool has_point = length > whole && begin[whole] == '.';
    if (length > sizeof digits->text || whole == 0 || (length > whole && (!has_point || fraction == 0))) {
        return;
    }
    for (size_t i = 1; i <= fraction; i++) {
        if (!plain_is_digit(begin[whole + i])) {
            return;
        }
    }
    *digits = (LiteralDigits){.length = (unsigned)length, .shift = (unsigned)(64 - 8 * (whole + fraction))};
    digits->divisor[0] = plain_tens[fraction].real[0];
    digits->divisor[1] = plain_tens[fraction].real[1];
    for (size_t i = 0; i < length; i++) {
        digits->mask |= UINT64_C(0xff) << 8 * i;
        digits->text |= (uint64_t)(i == whole ? '.' : '0') << 8 * i;
        digits->point |= i == whole ? UINT64_C(0xff) << 8 * i : 0;
        digits->whole |= i < whole ? UINT64_C(0xff) << 8 * i : 0;
    }
#endif
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
static const char *row_learn(LiteralGap *gaps, LiteralDigits *digits, const char *at, const char *end, unsigned count)
{
    double number;
    for (unsigned i = 0; i < count; i++) {
        const char *after = plain_read_number(at, end, &number);
        if (after != NULL) {
            digits_learn(&digits[i], at, after);
        }
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

// What LiteralPattern leaves open, blanks around the numbers of the colour, belongs to no form.
static bool form_take_apart(LiteralForm *form, const LiteralPattern *pattern, const char *begin, const char *end)
{
    const char *first = memchr(begin, '{', (size_t)(end - begin));
    first = first != NULL ? plain_skip_blanks(first + 1) : end;
    if (pattern->has_moves || *first != '<') {
        return false;
    }
    first = plain_skip_blanks(first + 1);
    form->head_length = (size_t)(first - begin);
    if (form->head_length > sizeof form->head) {
        return false;
    }
    memcpy(form->head, begin, form->head_length);
    const char *at = row_learn(form->gaps, form->digits, first, end, HEAD_NUMBERS);
    form->colours = pattern->part_count > 0 ? pattern->parts[0].count : 0;
    form->before = pattern->part_count > 0 ? pattern->parts[0].before : 0;
    if (at == NULL || form->colours == 0) {
        return at != NULL;
    }
    at = row_learn(form->gaps + HEAD_NUMBERS, form->digits + HEAD_NUMBERS, at + form->before, end, form->colours);
    return at != NULL && *at == pattern->text[form->before];
}

void literal_form_learn(LiteralForm *form, const LiteralPattern *pattern, const char *begin, const char *end)
{
    form->pattern = form_take_apart(form, pattern, begin, end) ? pattern : NULL;
    unsigned count = HEAD_NUMBERS + form->colours, known = 0;
    for (unsigned i = 0; i < count; i++) {
        known += form->digits[i].length > 0;
    }
    // Where digits come as they like, in more than half of the statements, nothing is expected of them in the end.
    bool is_in_vain = ++form->learnt > LEARNT_MOST && 2 * form->odd > form->statements;
    form->is_even = 2 * known > count && !is_in_vain;
    form->odd = form->statements = 0;
}

// A number of other digits; apart, so that those that are expected are read without it.
__attribute__((noinline)) static const char *other_read(LiteralForm *form, const char *at, const char *end,
                                                        double *number)
{
    form->odd++;
    return plain_read_number(at, end, number);
}

// As plain_read_number gives it: where the digits are those that are expected, with no step that waits for the text but
// to compare it.
RT_ALWAYS_INLINE const char *digits_read(LiteralForm *form, const LiteralDigits *digits, const char *at,
                                         const char *end, double *number)
{
    bool is_negative = *at == '-';
    const char *first = at + is_negative, *after = first + digits->length;
    uint64_t text;
    memcpy(&text, first, sizeof text);
    text = (text ^ digits->text) & digits->mask;
    if (RT_UNLIKELY((plain_others(text) | (text & digits->point)) != 0 || plain_goes_on(*after))) {
        return other_read(form, at, end, number);
    }
    text = (text & digits->whole) | (text >> 8 & ~digits->whole);
    *number = (double)(int64_t)plain_join(text << digits->shift) / digits->divisor[is_negative];
    return after;
}

// `count` numbers with the gaps between them, the first of which is that of a place in the form.
RT_ALWAYS_INLINE const char *row_read(LiteralForm *form, bool is_even, unsigned first, const char *at,
                                      const char *end, unsigned count, double *numbers)
{
    const LiteralGap *gaps = form->gaps + first;
    for (unsigned i = 0; i < count; i++) {
        at = is_even ? digits_read(form, &form->digits[first + i], at, end, &numbers[i])
                     : plain_read_number(at, end, &numbers[i]);
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

RT_ALWAYS_INLINE const char *colour_read(LiteralForm *form, bool is_even, const char *at, const char *end,
                                         GrammarLiteral *literal)
{
    double colour[5];
    at = row_read(form, is_even, HEAD_NUMBERS, at, end, form->colours, colour);
    if (at == NULL) {
        return NULL;
    }
    Word word = form->pattern->parts[0].word;
    bool has_transmit = word == W_rgbt;
    literal->colours = word == W_rgb ? 3 : 5;
    for (unsigned i = 0; i < 3; i++) {
        literal->kind.colour[i] = (float)colour[i];
    }
    if (literal->colours == 5) {
        literal->kind.colour[3] = has_transmit ? 0.0F : (float)colour[3];
        literal->kind.colour[4] = has_transmit ? (float)colour[3] : form->colours == 5 ? (float)colour[4] : 0.0F;
    }
    return at;
}

RT_ALWAYS_INLINE const char *form_read(LiteralForm *form, bool is_even, const char *at, const char *end,
                                       GrammarLiteral *literal)
{
    const LiteralPattern *pattern = form->pattern;
    double numbers[HEAD_NUMBERS];
    if (pattern == NULL || end - at < LITERAL_STATEMENT_LONGEST || memcmp(at, form->head, form->head_length) != 0) {
        return NULL;
    }
    at = row_read(form, is_even, 0, at + form->head_length, end, HEAD_NUMBERS, numbers);
    if (at == NULL || !(numbers[3] > 0.0) || memcmp(at, pattern->text, form->before) != 0) {
        return NULL;
    }
    memcpy(literal->centre, numbers, sizeof literal->centre);
    literal->radius = numbers[3];
    literal->kind = pattern->kind;
    literal->colours = 0;
    at += form->before;
    at = form->colours > 0 ? colour_read(form, is_even, at, end, literal) : at;
    form->statements++;
    bool is_like = at != NULL && memcmp(at, pattern->text + form->before, pattern->after) == 0;
    return is_like ? at + pattern->after : NULL;
}

const char *literal_form_read(LiteralForm *form, const char *at, const char *end, GrammarLiteral *literal)
{
    return form->is_even ? form_read(form, true, at, end, literal) : form_read(form, false, at, end, literal);
}
