// Templates: how they are made of a text, and matched.
//
// SPDX-License-Identifier: MIT
#include "grammar/template.h"

#include <stdlib.h>
#include <string.h>

#include "ast/words.h"
#include "base/plain.h"

enum { TEXT_LONGEST = 4096 };

// ---- taking a text apart

// Behind these a number may stand, with a sign that is its own.
static bool may_precede_number(char last, WordClass class)
{
    return plain_is_in_word(last) ? class == WORD_PLAIN || class == WORD_COLOUR
                                  : last == ',' || last == '{' || last == '<' || last == '(';
}

// A word of the language that always means the same; WORD_IDENTIFIER: something else.
static WordClass class_of(const GrammarContext *context, const char *word, size_t length)
{
    Symbol symbol = intern_find(context->names, word, length);
    WordClass class = symbol != SYMBOL_NONE && symbol < WORD_COUNT ? word_class(symbol) : WORD_IDENTIFIER;
    return class == WORD_DIRECTIVE || class == WORD_BUILTIN ? WORD_IDENTIFIER : class;
}

static const char *end_of_word(const char *at)
{
    while (plain_is_in_word(*at)) {
        at++;
    }
    return at;
}

size_t template_survey(const GrammarContext *context, const char *text, const char *end, uint64_t offset,
                       GrammarSlot *slots, unsigned *count)
{
    const char *at = plain_skip_blanks(end_of_word(text)), *limit = end - text > TEXT_LONGEST ? text + TEXT_LONGEST : end;
    char opens = *at, closes = opens == '(' ? ')' : '}', last = '\0'; // the last one that is no blank
    WordClass class = WORD_PLAIN;
    unsigned depth = 0;
    *count = 0;
    while (at < limit) {
        const char *begin = at;
        if (plain_is_letter(*at)) {
            at = end_of_word(at);
            class = class_of(context, begin, (size_t)(at - begin));
            if (class == WORD_IDENTIFIER || last == '\0') {
                return 0;
            }
            last = at[-1];
        } else if (plain_is_digit(*at) || *at == '.' || *at == '-') {
            double number;
            at = plain_read_number(at, limit, &number);
            if (at == NULL || *count == GRAMMAR_SLOTS_MOST || !may_precede_number(last, class) ||
                plain_is_in_word(begin[-1])) {
                return 0;
            }
            slots[(*count)++] = (GrammarSlot){
                .span = {offset + (uint64_t)(begin - text), offset + (uint64_t)(at - text)}, .number = number, .is_used = true};
            last = '.'; // no number may follow
        } else if (*at != '\0' && strchr("{}()<>, \n\t\r", *at) != NULL) {
            depth += (*at == opens) - (unsigned)(*at == closes);
            if (depth == 0) {
                return *at == closes ? (size_t)(at + 1 - text) : 0;
            }
            last = plain_is_blank(*at) ? last : *at;
            at++;
        } else {
            return 0;
        }
    }
    return 0;
}

static void piece_set(TemplatePiece *piece, const char *bytes, size_t length)
{
    static const char ones[sizeof piece->text] = {-1, -1, -1, -1, -1, -1, -1, -1};
    size_t first = length < sizeof piece->text ? length : sizeof piece->text;
    *piece = (TemplatePiece){.bytes = bytes, .length = length, .digits = {.mask = UINT64_MAX, .point = UINT64_MAX}};
    memcpy(&piece->text, bytes, first);
    memcpy(&piece->mask, ones, first);
}

Template *template_new(const char *text, size_t length, uint64_t offset, const GrammarSlot *slots, unsigned count)
{
    Template *template = calloc(1, sizeof *template + (count + 1) * sizeof *template->pieces);
    char *copy = malloc(length);
    if (template == NULL || copy == NULL) {
        free(template);
        free(copy);
        return NULL;
    }
    memcpy(copy, text, length);
    template->text = copy;
    size_t begin = 0;
    for (unsigned i = 0; i < count; i++) {
        if (slots[i].is_used) {
            piece_set(&template->pieces[template->slots++], copy + begin, (size_t)(slots[i].span.begin - offset) - begin);
            begin = (size_t)(slots[i].span.end - offset);
        }
    }
    piece_set(&template->pieces[template->slots], copy + begin, length - begin);
    template->is_call = copy[length - 1] == ')';
    return template;
}

void template_free(Template *template)
{
    if (template != NULL) {
        free(template->text);
        free(template);
    }
}

Template *template_copy(const Template *template)
{
    size_t size = sizeof *template + (template->slots + 1) * sizeof *template->pieces;
    Template *copy = malloc(size);
    return copy != NULL ? memcpy(copy, template, size) : NULL;
}

// ---- numbers

static void digits_learn(TemplateDigits *digits, const char *begin, size_t length, size_t whole)
{
#if defined __BYTE_ORDER__ && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    size_t fraction = length > whole ? length - whole - 1 : 0;
    bool is_usual = length <= sizeof digits->text && whole > 0 && (length == whole || fraction > 0);
    for (size_t i = 0; i < length && is_usual; i++) {
        is_usual = i == whole ? begin[i] == '.' : plain_is_digit(begin[i]);
    }
    if (!is_usual) {
        return;
    }
    *digits = (TemplateDigits){.length = (unsigned)length, .shift = (unsigned)(64 - 8 * (whole + fraction))};
    digits->divisor[0] = plain_tens[fraction].real[0];
    digits->divisor[1] = plain_tens[fraction].real[1];
    for (size_t i = 0; i < length; i++) {
        digits->mask |= UINT64_C(0xff) << 8 * i;
        digits->text |= (uint64_t)(i == whole ? '.' : '0') << 8 * i;
        digits->point |= i == whole ? UINT64_C(0xff) << 8 * i : 0;
        digits->whole |= i < whole ? UINT64_C(0xff) << 8 * i : 0;
    }
#else
    (void)digits;
    (void)begin;
    (void)length;
    (void)whole;
#endif
}

// A number of other digits. When the second one in a row is written alike, the next is expected to be so, too.
__attribute__((noinline)) static const char *other_number(TemplateDigits *digits, const char *at, const char *end,
                                                          double *number)
{
    const char *after = plain_read_number(at, end, number), *first = at + (*at == '-');
    if (after == NULL) {
        return NULL;
    }
    size_t length = (size_t)(after - first), whole = 0;
    while (whole < length && plain_is_digit(first[whole])) {
        whole++;
    }
    unsigned form = (unsigned)(length << 8 | whole);
    if (form == digits->missed) {
        digits_learn(digits, first, length, whole);
    }
    digits->missed = form;
    return after;
}

// As plain_read_number gives it: where the digits are those that are expected, with no step that waits for the text but
// to compare it.
RT_ALWAYS_INLINE const char *number_read(TemplateDigits *digits, const char *at, const char *end, double *number)
{
    bool is_negative = *at == '-';
    const char *first = at + is_negative, *after = first + digits->length;
    uint64_t text;
    memcpy(&text, first, sizeof text);
    text = (text ^ digits->text) & digits->mask;
    if (RT_UNLIKELY((plain_others(text) | (text & digits->point)) != 0 || plain_goes_on(*after))) {
        return other_number(digits, at, end, number);
    }
    text = (text & digits->whole) | (text >> 8 & ~digits->whole);
    *number = (double)(int64_t)plain_join(text << digits->shift) / digits->divisor[is_negative];
    return after;
}

// ---- matching

// The same text with other blanks at its ends.
__attribute__((noinline)) static const char *match_loosely(const TemplatePiece *piece, const char *at, const char *end,
                                                           bool is_last)
{
    const char *from = piece->bytes, *to = piece->bytes + piece->length;
    while (from < to && plain_is_blank(*from)) {
        from++;
    }
    while (from < to && plain_is_blank(to[-1])) {
        to--;
    }
    size_t length = (size_t)(to - from);
    at = plain_skip_blanks(at);
    if ((size_t)(end - at) <= length || memcmp(at, from, length) != 0) {
        return NULL;
    }
    at += length;
    bool needs_blank = !is_last && length > 0 && plain_is_in_word(to[-1]);
    return is_last || (needs_blank && !plain_is_blank(*at)) ? (is_last ? at : NULL) : plain_skip_blanks(at);
}

RT_ALWAYS_INLINE const char *match_piece(const TemplatePiece *piece, const char *at, const char *end, bool is_last)
{
    uint64_t text;
    memcpy(&text, at, sizeof text);
    size_t length = piece->length;
    if (RT_LIKELY((text & piece->mask) == piece->text) &&
        (length <= sizeof text || ((size_t)(end - at) >= length && memcmp(at + sizeof text, piece->bytes + sizeof text,
                                                                          length - sizeof text) == 0))) {
        return at + length;
    }
    return match_loosely(piece, at, end, is_last);
}

RT_ALWAYS_INLINE const char *match(Template *template, const char *at, const char *end, double *numbers,
                                   TemplatePlace *places)
{
    TemplatePiece *piece = template->pieces;
    for (unsigned i = 0; i < template->slots; i++, piece++) {
        const char *begin = match_piece(piece, at, end, false);
        at = begin != NULL ? number_read(&piece->digits, begin, end, &numbers[i]) : NULL;
        if (at == NULL) {
            return NULL;
        }
        if (places != NULL) {
            places[i] = (TemplatePlace){begin, at};
        }
    }
    at = match_piece(piece, at, end, true);
    return at != NULL && template->is_call && !plain_is_letter(*plain_skip_blanks(at)) ? NULL : at;
}

const char *template_match(Template *template, const char *at, const char *end, double *numbers)
{
    return match(template, at, end, numbers, NULL);
}

const char *template_find(Template *template, const char *at, const char *end, double *numbers, TemplatePlace *places)
{
    return match(template, at, end, numbers, places);
}
