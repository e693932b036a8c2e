// The text of a data file as values: numbers, vectors and strings between commas.
//
// A file is read in blocks and each value once, from the block into the variable. Knows nothing of names.
//
// SPDX-License-Identifier: MIT
#include "eval/run/data_text.h"

#include <errno.h>
#include <string.h>

#include "base/number.h"
#include "base/plain.h"
#include "eval/values/characters.h"
#include "eval/run/scope.h"

enum {
    WORK_OF_A_BYTE = 2,              // of a comment, say
    LONGEST_VALUE = 255,             // characters of a number or a string, as in scenes
    LOOK_AHEAD = LONGEST_VALUE + 33, // at hand wherever a number begins
};

// ---- bytes

// Reads on, keeping what is not used yet. A file that cannot be read any further ends there, with a message.
static void fill(Eval *ev, DataFile *file)
{
    size_t kept = (size_t)(file->end - file->at);
    memmove(file->block, file->at, kept);
    file->at = file->block;
    ptrdiff_t got = source_read(file->source, file->block + kept, DATA_BLOCK_BYTES - kept);
    Span here = {file->end_offset, file->end_offset};
    if (got > 0 && !eval_work(ev, WORK_OF_A_BYTE * (size_t)got, here)) {
        got = 0;
    } else if (got < 0 && errno == ECANCELED) {
        ev->stop = true;
    } else if (got < 0) {
        eval_fault(ev, DIAG_E0502, here, "cannot read any further: %s", strerror(errno));
    }
    file->ended = got <= 0;
    file->end = file->block + kept + (got > 0 ? got : 0);
    file->end_offset += got > 0 ? (uint64_t)got : 0;
    file->block[file->end - file->block] = '\0';
}

static inline void look_ahead(Eval *ev, DataFile *file, size_t bytes)
{
    while (RT_UNLIKELY((size_t)(file->end - file->at) < bytes) && !file->ended) {
        fill(ev, file);
    }
}

static Span span_of(const DataFile *file, const char *begin, const char *end)
{
    return (Span){file->end_offset - (uint64_t)(file->end - begin), file->end_offset - (uint64_t)(file->end - end)};
}

static Span span_here(const DataFile *file)
{
    return span_of(file, file->at, file->at < file->end ? file->at + 1 : file->at);
}

static bool is_blank(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r') || c == '\x1a';
}

static void skip_line(Eval *ev, DataFile *file)
{
    for (;;) {
        const char *newline = memchr(file->at, '\n', (size_t)(file->end - file->at));
        if (newline != NULL || file->ended) {
            file->at = newline != NULL ? newline : file->end;
            return;
        }
        file->at = file->end;
        fill(ev, file);
    }
}

// Comments nest, as in scenes.
static bool skip_comment(Eval *ev, DataFile *file)
{
    Span begin = span_of(file, file->at, file->at + 2);
    for (unsigned depth = 0;;) {
        look_ahead(ev, file, 2);
        if (file->end - file->at < 2) {
            return eval_fault(ev, DIAG_E0103, begin, "this comment has no end `*/`");
        }
        bool opens = file->at[0] == '/' && file->at[1] == '*', closes = file->at[0] == '*' && file->at[1] == '/';
        depth = opens ? depth + 1 : closes ? depth - 1 : depth;
        file->at += opens || closes ? 2 : 1;
        if (depth == 0) {
            return true;
        }
    }
}

// To what is neither blank nor comment: its first character, 0 at the end. False after a fault.
static bool next_character(Eval *ev, DataFile *file, char *c)
{
    for (;;) {
        while (is_blank(*file->at)) {
            file->at++;
        }
        if (RT_UNLIKELY((size_t)(file->end - file->at) < LOOK_AHEAD) && !file->ended) {
            fill(ev, file);
            continue;
        }
        *c = *file->at;
        if (RT_LIKELY(*c != '/' || (file->at[1] != '/' && file->at[1] != '*'))) {
            break;
        }
        if (file->at[1] == '/') {
            skip_line(ev, file);
        } else if (!skip_comment(ev, file)) {
            return false;
        }
    }
    return !ev->stop && (*c != '\0' || file->at == file->end ||
                         eval_fault(ev, DIAG_E0509, span_here(file), "byte 0x00 has no meaning in a data file"));
}

// ---- values

static bool fault_unexpected(Eval *ev, const DataFile *file, const char *wanted)
{
    char c = *file->at;
    bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    if (file->at == file->end) {
        return eval_fault(ev, DIAG_E0509, span_here(file), "expected %s, found the end of the file", wanted);
    }
    if (!eval_report(ev, DIAG_E0509, span_here(file), "expected %s here", wanted)) {
        return false;
    }
    if (is_letter || c == '(') {
        diag_suggest(ev->options.diags, "a data file holds values, not names or expressions");
    } else if (c == '#') {
        diag_suggest(ev->options.diags, "a data file holds values, not directives");
    }
    return false;
}

// A number at hand, without its sign.
static bool read_digits(Eval *ev, DataFile *file, double *number)
{
    size_t used = 0;
    const char *begin = file->at;
    NumberResult result = number_scan(begin, (size_t)(file->end - begin), number, &used);
    if (RT_UNLIKELY(result == NUMBER_MALFORMED)) {
        return fault_unexpected(ev, file, "a number");
    }
    file->at += used;
    Span span = span_of(file, begin, file->at);
    if (RT_UNLIKELY(used > LONGEST_VALUE)) {
        return eval_fault(ev, DIAG_E0509, span, "a number of more than %d characters", LONGEST_VALUE);
    }
    if (RT_UNLIKELY(*file->at == '.')) {
        return eval_fault(ev, DIAG_E0509, span_here(file), "a number has one decimal point");
    }
    return RT_LIKELY(result == NUMBER_OK) ||
           eval_fault(ev, DIAG_E0104, span, "`%.*s` is beyond the greatest number, about 1.8e308",
                      used < 40 ? (int)used : 40, begin);
}

static bool read_number(Eval *ev, DataFile *file, char first, double *number)
{
    bool is_signed = first == '-' || first == '+';
    file->at += is_signed;
    if (is_signed && !next_character(ev, file, &(char){0})) {
        return false;
    }
    if (!read_digits(ev, file, number)) {
        return false;
    }
    *number = first == '-' ? -*number : *number;
    return true;
}

static bool read_vector(Eval *ev, DataFile *file, Value *value)
{
    char c;
    unsigned count = 0;
    Span begin = span_here(file);
    file->at++;
    do {
        double number;
        if (!next_character(ev, file, &c) || !read_number(ev, file, c, &number) || !next_character(ev, file, &c)) {
            return false;
        }
        if (count == 5) {
            return eval_fault(ev, DIAG_E0509, begin, "a vector has at most 5 components");
        }
        value->v[count++] = number;
        if (c == ',') {
            file->at++;
            if (!next_character(ev, file, &c)) {
                return false;
            }
        }
    } while (c != '>');
    file->at++;
    value->kind = VALUE_VECTOR;
    value->components = (uint8_t)count;
    return count >= 2 || eval_fault(ev, DIAG_E0509, begin, "a vector has at least 2 components");
}

// Appends what stands at a backslash.
static bool read_escape(Eval *ev, DataFile *file)
{
    size_t used = text_append_escape(&file->text, file->at, (size_t)(file->end - file->at));
    if (used == 0) {
        return eval_fault(ev, DIAG_E0101, span_of(file, file->at, file->at + 1),
                          "this escape means nothing in a string; a backslash is written `\\\\`");
    }
    file->at += used;
    return true;
}

static bool read_string(Eval *ev, DataFile *file, Value *value)
{
    Span begin = span_here(file);
    text_clear(&file->text);
    for (file->at++;;) {
        look_ahead(ev, file, LOOK_AHEAD);
        if (file->at == file->end) {
            return eval_fault(ev, DIAG_E0102, begin, "this string has no closing `\"`");
        }
        if (*file->at == '"') {
            break;
        }
        if (*file->at != '\\') {
            if (*file->at == TEXT_MARK) {
                text_append_char(&file->text, TEXT_MARK);
            }
            text_append_char(&file->text, *file->at++);
        } else if (!read_escape(ev, file)) {
            return false;
        }
        if (file->text.length > LONGEST_VALUE) {
            return eval_fault(ev, DIAG_E0509, begin, "a string of more than %d characters", LONGEST_VALUE);
        }
    }
    file->at++;
    if (file->text.failed) {
        return eval_no_memory(ev, begin);
    }
    return characters_of_text(ev, text_get(&file->text), file->text.length, begin, value);
}

bool data_read_value(Eval *ev, DataFile *file, Value *value)
{
    char c;
    *value = (Value){.kind = VALUE_NONE};
    if (!next_character(ev, file, &c)) {
        return false;
    }
    if (RT_LIKELY((c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+')) {
        value->kind = VALUE_NUMBER;
        return read_number(ev, file, c, &value->number);
    }
    return c == '\0'  ? true
           : c == '<' ? read_vector(ev, file, value)
           : c == '"' ? read_string(ev, file, value)
                      : fault_unexpected(ev, file, "a number, a vector or a string");
}

// What follows a value is a comma or the end. POV-Ray passes over whatever stands there, a value too.
bool data_read_comma(Eval *ev, DataFile *file, bool *is_end)
{
    char c;
    if (!next_character(ev, file, &c)) {
        return false;
    }
    *is_end = c == '\0';
    if (RT_LIKELY(c == ',')) {
        file->at++;
    } else if (c != '\0') {
        if (eval_report(ev, DIAG_E0510, span_here(file), "expected a `,` between this value and the one before")) {
            diag_suggest(ev->options.diags, "write a `,` after each value, at the ends of lines too");
        }
        return false;
    }
    return true;
}

// ---- values in the most usual form

// A number that is written in the most usual way, and all around it; NULL: anything else.
static const char *read_plainly(const char *at, const char *end, double *number)
{
    at = plain_read_number(at, end, number);
    while (at != NULL && is_blank(*at)) {
        at++;
    }
    return at;
}

static const char *read_three_plainly(const char *at, const char *end, double *three)
{
    for (unsigned i = 0; i < 3; i++) {
        do {
            at++; // a `<`, a comma, a blank
        } while (is_blank(*at));
        at = read_plainly(at, end, &three[i]);
        if (at == NULL || *at != (i < 2 ? ',' : '>')) {
            return NULL;
        }
    }
    do {
        at++;
    } while (is_blank(*at));
    return at;
}

bool data_read_plainly(DataFile *file, Value *value)
{
    const char *at = file->at;
    while (is_blank(*at)) {
        at++;
    }
    if ((size_t)(file->end - at) < LOOK_AHEAD) {
        return false;
    }
    value->kind = *at == '<' ? VALUE_VECTOR : VALUE_NUMBER;
    at = value->kind == VALUE_VECTOR ? read_three_plainly(at, file->end, value->v)
                                     : read_plainly(at, file->end, &value->number);
    if (at == NULL || *at != ',') {
        return false;
    }
    file->at = at + 1;
    return true;
}
