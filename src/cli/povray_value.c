// Values of POV-Ray's options: from text to a field of the settings, by the kind and range of the table's row.
//
// SPDX-License-Identifier: MIT
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/attributes.h"
#include "cli/povray_text.h"

rt_status povray_fault(const PovrayText *text, const char *code, PovraySpan span, const char *advice,
                       const char *format, ...)
{
    char message[POVRAY_MESSAGE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return rt_report_in(text->session, code, text->name, text->text, span.begin, span.end, message,
                        advice && advice[0] ? advice : NULL);
}

static PovraySpan unquoted(const PovrayText *text, PovraySpan span)
{
    const char *first = text->text + span.begin;
    bool is_quote = *first == '"' || *first == '\'';
    bool is_quoted = is_quote && span.end > span.begin + 1 && text->text[span.end - 1] == *first;
    return is_quoted ? (PovraySpan){span.begin + 1, span.end - 1} : span;
}

static const char *keep(PovraySettings *settings, const char *begin, size_t length)
{
    char **texts = realloc(settings->texts, (settings->text_count + 1) * sizeof *texts);
    char *copy = texts ? strndup(begin, length) : NULL;
    settings->texts = texts ? texts : settings->texts;
    if (copy) {
        settings->texts[settings->text_count++] = copy;
    }
    return copy;
}

const char *povray_keep(const PovrayText *text, PovraySpan span)
{
    PovraySpan inner = unquoted(text, span);
    return keep(text->settings, text->text + inner.begin, inner.end - inner.begin);
}

static rt_status no_memory(const PovrayText *text)
{
    return rt_report(text->session, "E0602", "out of memory reading options", NULL);
}

static bool is_word(const PovrayText *text, PovraySpan value, const char *const *words)
{
    size_t length = value.end - value.begin;
    for (; *words; words++) {
        if (strlen(*words) == length && strncasecmp(text->text + value.begin, *words, length) == 0) {
            return true;
        }
    }
    return false;
}

static bool is_true(const PovrayText *text, PovraySpan value)
{
    static const char *const words[] = {"true", "yes", "on", "1", NULL};
    return is_word(text, value, words);
}

static bool is_false(const PovrayText *text, PovraySpan value)
{
    static const char *const words[] = {"false", "no", "off", "0", NULL};
    return is_word(text, value, words);
}

static bool read_number(const PovrayText *text, PovraySpan value, double *number)
{
    char digits[64], *end;
    size_t length = value.end - value.begin;
    if (length == 0 || length >= sizeof digits) {
        return false;
    }
    memcpy(digits, text->text + value.begin, length);
    digits[length] = '\0';
    *number = strtod(digits, &end);
    return strspn(digits, "+-.0123456789eE") == length && end != digits && !*end && isfinite(*number);
}

// "a number from 1 to 9, found `x`"
static rt_status fault_value(const PovrayText *text, const PovrayRow *row, PovraySpan value, const char *expected)
{
    size_t length = value.end - value.begin;
    return povray_fault(text, "E0705", value, row->refusal, "`%s` wants %s, found `%.*s`", row->key, expected,
                        (int)(length < 40 ? length : 40), text->text + value.begin);
}

static rt_status set_number(const PovrayText *text, const PovrayRow *row, PovraySpan value)
{
    char expected[128];
    double number;
    bool is_integer = row->kind == POVRAY_INTEGER;
    bool fine = read_number(text, value, &number);
    number = fine && is_integer ? trunc(number) : number;
    if (!fine || number < row->low || number > row->high) {
        if (isinf(row->high)) {
            snprintf(expected, sizeof expected, "a %snumber", is_integer ? "whole " : "");
        } else {
            snprintf(expected, sizeof expected, "a %snumber from %.9g to %.9g", is_integer ? "whole " : "", row->low,
                     row->high);
        }
        return fault_value(text, row, value, expected);
    }
    void *field = (char *)text->settings + row->field;
    if (row->is_followed && is_integer) {
        *(int *)field = (int)number;
    } else if (row->is_followed) {
        *(double *)field = number;
    }
    return RT_OK;
}

static rt_status set_bits(const PovrayText *text, const PovrayRow *row, PovraySpan value)
{
    double bits;
    if (!read_number(text, value, &bits) || (trunc(bits) != 8.0 && trunc(bits) != 16.0)) {
        return fault_value(text, row, value, "8 or 16 bits");
    }
    text->settings->bits = (int)bits;
    return RT_OK;
}

static rt_status set_gamma(const PovrayText *text, const PovrayRow *row, PovraySpan value)
{
    static const char *const names[] = {"srgb", NULL};
    double gamma = 0.0;
    if (!is_word(text, value, names) && !(read_number(text, value, &gamma) && gamma > 0.0)) {
        return fault_value(text, row, value, "sRGB or a number above 0");
    }
    if (row->is_followed) {
        *(double *)((char *)text->settings + row->field) = gamma;
    }
    return RT_OK;
}

// The names that `true` stands for.
static const char *usual_file(const PovrayRow *row)
{
    static const struct {
        const char *key, *name;
    } names[] = {{"Debug_File", "debug.out"},     {"Fatal_File", "fatal.out"},     {"Render_File", "render.out"},
                 {"Statistic_File", "stats.out"}, {"Warning_File", "warning.out"}, {"All_File", "alltext.out"}};
    for (size_t i = 0; i < RT_COUNT_OF(names); i++) {
        if (strcmp(row->key, names[i].key) == 0) {
            return names[i].name;
        }
    }
    return ""; // Create_Ini: by the scene's name, which is known later
}

// Where the scene is named: whether there is one is known when all options have been read.
static bool keep_place(const PovrayText *text, PovraySpan value)
{
    PovrayPlace *place = &text->settings->input_place;
    place->name = keep(text->settings, text->name, strlen(text->name));
    place->text = keep(text->settings, text->text, strlen(text->text));
    place->begin = value.begin;
    place->end = value.end;
    return place->name && place->text;
}

static rt_status set_text(const PovrayText *text, const PovrayRow *row, PovraySpan value)
{
    const char **field = (const char **)((char *)text->settings + row->field);
    bool is_file = row->kind == POVRAY_FILE;
    if (!row->is_followed) {
        return RT_OK;
    }
    if (is_file && (is_true(text, value) || is_false(text, value))) {
        *field = is_true(text, value) ? usual_file(row) : NULL;
        return RT_OK;
    }
    if (value.begin == value.end) {
        return fault_value(text, row, value, "a name");
    }
    const char *copy = povray_keep(text, value);
    *field = copy;
    return copy && (field != &text->settings->input || keep_place(text, value)) ? RT_OK : no_memory(text);
}

static rt_status add_text(const PovrayText *text, PovraySpan value, const char ***list, size_t *count)
{
    const char *copy = povray_keep(text, value);
    const char **more = realloc(*list, (*count + 1) * sizeof *more);
    *list = more ? more : *list;
    if (!copy || !more) {
        return no_memory(text);
    }
    more[(*count)++] = copy;
    return RT_OK;
}

static rt_status add_library(const PovrayText *text, const PovrayRow *row, PovraySpan value)
{
    PovraySettings *settings = text->settings;
    if (text->is_unnamed) {
        return povray_fault(text, "W0701", value, "+L and an .ini file that is named add folders",
                            "`Library_Path` is not followed in a povray.ini of the current folder, which could let a "
                            "scene beside it read what it should not");
    }
    if (value.begin == value.end) {
        return fault_value(text, row, value, "a folder");
    }
    settings->usual_count += text->is_usual;
    return add_text(text, value, &settings->libraries, &settings->library_count);
}

static rt_status add_declaration(const PovrayText *text, const PovrayRow *row, PovraySpan value)
{
    PovraySettings *settings = text->settings;
    const char *found = text->text + value.begin, *equals = memchr(found, '=', value.end - value.begin);
    double number;
    size_t length = equals ? (size_t)(equals - found) : 0;
    size_t number_begin = equals ? value.begin + length + 1 : value.end;
    // POV-Ray takes a blank before the sign for a part of the name, which no scene can then ask for.
    if (length == 0 || isspace((unsigned char)found[length - 1]) ||
        !read_number(text, (PovraySpan){number_begin, value.end}, &number)) {
        return fault_value(text, row, value, "NAME=NUMBER without blanks");
    }
    char joined[256];
    int size = snprintf(joined, sizeof joined, "%.*s=%.17g", (int)(length < 200 ? length : 200), found, number);
    PovrayText copy = *text;
    copy.text = joined;
    return add_text(&copy, (PovraySpan){0, (size_t)size}, &settings->declarations, &settings->declaration_count);
}

static rt_status set_type(const PovrayText *text, const PovrayRow *row, PovraySpan value)
{
    static const char known[] = "NTCPJBEH";
    int letter = value.begin < value.end ? toupper((unsigned char)text->text[value.begin]) : 0;
    if (!letter || !strchr(known, letter)) {
        return fault_value(text, row, value, "a letter of a picture format: N, T, C, P, J, B, E or H");
    }
    text->settings->type = (char)letter;
    return RT_OK;
}

rt_status povray_set_flag(const PovrayText *text, const PovrayRow *row, PovraySpan key, bool on)
{
    bool is_refused = row->refusal && on != (row->low > 0.0);
    if (is_refused) {
        return povray_fault(text, "E0706", key, NULL, "`%s` cannot be followed: %s", row->key, row->refusal);
    }
    if (row->kind == POVRAY_ALL_ON) {
        for (int i = 0; i < POVRAY_ALL; i++) {
            text->settings->consoles[i] = on;
        }
    } else if (row->is_followed) {
        *(bool *)((char *)text->settings + row->field) = on;
    }
    return RT_OK;
}

rt_status povray_set(const PovrayText *text, const PovrayRow *row, PovraySpan key, PovraySpan value)
{
    PovraySpan inner = unquoted(text, value);
    switch (row->kind) {
    case POVRAY_BOOL:
    case POVRAY_ALL_ON:
        return povray_set_flag(text, row, key, is_true(text, inner));
    case POVRAY_INTEGER:
    case POVRAY_NUMBER:
        return set_number(text, row, inner);
    case POVRAY_BITS:
        return set_bits(text, row, inner);
    case POVRAY_GAMMA:
        return set_gamma(text, row, inner);
    case POVRAY_TEXT:
    case POVRAY_FILE:
        return row->refusal ? povray_set_flag(text, row, key, true) : set_text(text, row, inner);
    case POVRAY_TYPE:
        return set_type(text, row, inner);
    case POVRAY_LIBRARY:
        return add_library(text, row, inner);
    case POVRAY_DECLARE:
        return add_declaration(text, row, inner);
    case POVRAY_INI:
        return povray_read_file(text, inner);
    }
    return RT_OK;
}
