// The built-in functions of strings.
//
// Strings are characters with a length in bytes, made in the scratch arena. Numbers are written and read as in C, whatever the
// locale. Knows nothing of names.
//
// SPDX-License-Identifier: MIT
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/number.h"
#include "eval/values/characters.h"
#include "eval/values/values.h"

enum {
    NUMBER_MAX = 254,     // characters of a number as text
    DIGITS_MAX = 1100,    // more than any number has, before the point or after it
    FORMAT_MAX = 4000,    // width and precision
    DATE_MAX = 256,       // characters of a date as text, with the zero at its end
    SECONDS_A_DAY = 86400,
};

static bool fault_long(Eval *ev, const AstNode *node)
{
    char most[LIMITS_BYTES_TEXT];
    limits_bytes_text(ev->options.limits->string_bytes, most);
    eval_fault(ev, DIAG_E0610, node->span, "a string of more than %s", most);
    ev->stop = true;
    return false;
}

static bool give_string(Eval *ev, const AstNode *node, Value *value, const char *text, size_t length)
{
    if (length > ev->options.limits->string_bytes) {
        return fault_long(ev, node);
    }
    if (!eval_work(ev, length, node->span)) {
        return false;
    }
    char *copy = arena_copy_text(&ev->scratch, text, length);
    if (copy == NULL) {
        return eval_no_memory(ev, node->span);
    }
    *value = (Value){.kind = VALUE_STRING};
    value->text = copy;
    value->length = length;
    return true;
}

static const AstNode *argument(const AstNode *node, unsigned index)
{
    const AstNode *found = node->a;
    while (index-- > 0) {
        found = found->next;
    }
    return found;
}

static void use_point(char *text)
{
    const char *point = localeconv()->decimal_point;
    char *at = strcmp(point, ".") != 0 ? strstr(text, point) : NULL;
    if (at != NULL) {
        size_t length = strlen(point);
        *at = '.';
        memmove(at + 1, at + length, strlen(at + length) + 1);
    }
}

// Appends a number as printf's %f or %g does: width < 0 fills with zeros, precision < 0 is six digits. False, and
// nothing is appended: it takes more than `most` characters.
static bool append_number(TextBuffer *out, double number, int width, int precision, bool is_short, int most)
{
    static const char *const formats[2][2] = {{"%*.*f", "%0*.*f"}, {"%*.*g", "%0*.*g"}};
    char text[2 * FORMAT_MAX];
    int length = snprintf(text, sizeof text, formats[is_short][width < 0], abs(width), precision, number);
    if (length > most) {
        return false;
    }
    use_point(text);
    text_append(out, text);
    return true;
}

static bool format_argument(Eval *ev, const AstNode *node, const char *what, int *out)
{
    double number;
    if (!ask_number(ev, node, &number)) {
        return false;
    }
    if (!(fabs(number) < FORMAT_MAX + 1)) {
        return eval_fault(ev, DIAG_E0304, node->span, "%s of %g is beyond %d", what, number, FORMAT_MAX);
    }
    *out = (int)number;
    return true;
}

static bool give_buffer(Eval *ev, const AstNode *node, Value *value, TextBuffer *buffer)
{
    bool fine = buffer->failed ? eval_no_memory(ev, node->span)
                               : give_string(ev, node, value, text_get(buffer), buffer->length);
    text_fini(buffer);
    return fine;
}

bool builtin_str(Eval *ev, const AstNode *node, Value *value)
{
    double number;
    int width, precision;
    if (!ask_number(ev, node->a, &number) || !format_argument(ev, argument(node, 1), "a width", &width) ||
        !format_argument(ev, argument(node, 2), "a precision", &precision)) {
        return false;
    }
    TextBuffer out;
    text_init(&out);
    // As POV-Ray: what is too long is written with an exponent, and if that is too long, too, it is no number.
    precision = precision < DIGITS_MAX ? precision : DIGITS_MAX;
    if (abs(width) > NUMBER_MAX || (!append_number(&out, number, width, precision, false, NUMBER_MAX) &&
                                    !append_number(&out, number, width, precision, true, NUMBER_MAX))) {
        text_append(&out, "<invalid>");
    }
    return give_buffer(ev, node, value, &out);
}

bool builtin_vstr(Eval *ev, const AstNode *node, Value *value)
{
    double count;
    Value vector, separator;
    int width, precision;
    if (!ask_number(ev, node->a, &count) || !ask_expression(ev, argument(node, 1), &vector) ||
        !ask_string(ev, argument(node, 2), &separator) ||
        !format_argument(ev, argument(node, 3), "a width", &width) ||
        !format_argument(ev, argument(node, 4), "a precision", &precision)) {
        return false;
    }
    double v[5];
    if (!value_is_tuple(&vector) && !value_number(ev, &vector, argument(node, 1)->span, &v[0])) {
        return false;
    }
    (void)value_components(&vector, v);
    TextBuffer out;
    text_init(&out);
    unsigned components = (unsigned)fmin(fmax(count, 2.0), 5.0);
    for (unsigned i = 0; i < components; i++) {
        if (i > 0) {
            text_append_n(&out, separator.text, separator.length);
        }
        (void)append_number(&out, v[i], width, precision, false, 2 * FORMAT_MAX);
    }
    return give_buffer(ev, node, value, &out);
}

bool builtin_concat(Eval *ev, const AstNode *node, Value *value)
{
    TextBuffer out;
    bool fine = true;
    text_init(&out);
    for (const AstNode *part = node->a; part != NULL; part = part->next) {
        Value string;
        if (fine && out.length > ev->options.limits->string_bytes) {
            fine = fault_long(ev, node);
        } else if (ask_string(ev, part, &string)) {
            text_append_n(&out, string.text, string.length);
        } else {
            fine = false;
        }
    }
    if (!fine) {
        text_fini(&out);
        return false;
    }
    return give_buffer(ev, node, value, &out);
}

bool builtin_chr(Eval *ev, const AstNode *node, Value *value)
{
    double code;
    if (!ask_number(ev, node->a, &code)) {
        return false;
    }
    if (!(code > -1.0 && code < 65536.0)) {
        return eval_fault(ev, DIAG_E0304, node->a->span, "`chr` takes 0 to 65535, not %g", code);
    }
    TextBuffer out;
    text_init(&out);
    if (code >= 1.0) { // a 0 ends a string
        text_append_utf8(&out, (unsigned)code);
    }
    return give_buffer(ev, node, value, &out);
}

bool builtin_asc(Eval *ev, const AstNode *node, Value *value)
{
    Value string;
    if (!ask_string(ev, node->a, &string)) {
        return false;
    }
    size_t bytes;
    *value = value_of_number(string.length > 0 ? character_at(string.text, string.text + string.length, &bytes) : 0);
    return true;
}

// The decimal number that a text begins with: its length, 0 when there is none.
static size_t decimal_length(const char *text)
{
    static const char digits[] = "0123456789";
    size_t whole = strspn(text, digits), length = whole;
    if (text[length] == '.') {
        size_t fraction = strspn(text + length + 1, digits);
        if (whole + fraction == 0) {
            return 0;
        }
        length += 1 + fraction;
    }
    if (length > 0 && (text[length] == 'e' || text[length] == 'E')) {
        size_t sign = text[length + 1] == '+' || text[length + 1] == '-' ? 1 : 0;
        size_t exponent = strspn(text + length + 1 + sign, digits);
        length += exponent > 0 ? 1 + sign + exponent : 0;
    }
    return length;
}

bool builtin_val(Eval *ev, const AstNode *node, Value *value)
{
    Value string;
    if (!ask_string(ev, node->a, &string)) {
        return false;
    }
    const char *text = string.text + strspn(string.text, " \t\n\v\f\r");
    const char *unsigned_text = text + (*text == '-' || *text == '+' ? 1 : 0);
    bool is_hexadecimal = unsigned_text[0] == '0' && (unsigned_text[1] == 'x' || unsigned_text[1] == 'X');
    size_t length = is_hexadecimal ? 0 : decimal_length(unsigned_text);
    double number;
    if (length == 0) {
        number = strtod(text, NULL); // hexadecimal, inf, nan, or zero for no number
    } else {
        if (number_parse(unsigned_text, length, &number) == NUMBER_MALFORMED) {
            number = 0.0;
        }
        number = *text == '-' ? -number : number;
    }
    *value = value_of_number(number);
    return true;
}

enum { CHARACTER_WORK = 4 }; // counting characters takes as long as copying so many times their bytes

bool builtin_strlen(Eval *ev, const AstNode *node, Value *value)
{
    Value string;
    if (!ask_string(ev, node->a, &string)) {
        return false;
    }
    if (!eval_work(ev, CHARACTER_WORK * string.length, node->span)) {
        return false;
    }
    *value = value_of_number((double)characters_count(string.text, string.length));
    return true;
}

bool builtin_strcmp(Eval *ev, const AstNode *node, Value *value)
{
    Value one, other;
    bool fine = ask_string(ev, node->a, &one);
    if (!ask_string(ev, node->a->next, &other) || !fine) {
        return false;
    }
    const char *a = one.text, *b = other.text, *a_end = a + one.length, *b_end = b + other.length;
    unsigned first = 0, second = 0;
    // As POV-Ray: how far the first characters that differ are apart.
    while (first == second && (a < a_end || b < b_end)) {
        size_t a_bytes = 0, b_bytes = 0;
        first = a < a_end ? character_at(a, a_end, &a_bytes) : 0;
        second = b < b_end ? character_at(b, b_end, &b_bytes) : 0;
        a += a_bytes;
        b += b_bytes;
    }
    if (!eval_work(ev, (size_t)(a - one.text), node->span)) {
        return false;
    }
    *value = value_of_number((double)first - (double)second);
    return true;
}

bool builtin_substr(Eval *ev, const AstNode *node, Value *value)
{
    Value string;
    double start, count;
    if (!ask_string(ev, node->a, &string) || !ask_number(ev, argument(node, 1), &start) ||
        !ask_number(ev, argument(node, 2), &count)) {
        return false;
    }
    start = trunc(start) - 1.0;
    count = trunc(count);
    if (!eval_work(ev, CHARACTER_WORK * string.length, node->span)) {
        return false;
    }
    size_t length = characters_count(string.text, string.length);
    if (!(start >= -1.0 && count >= 0.0 && start + count <= (double)length)) {
        return eval_fault(ev, DIAG_E0304, node->span, "%g characters from number %g on are not in a string of %zu",
                          count, start + 1.0, length);
    }
    if (start < 0.0) {
        return give_string(ev, node, value, "", 0); // as POV-Ray: from number 0 on there are none
    }
    size_t begin = characters_offset(string.text, string.length, (size_t)start);
    size_t bytes = characters_offset(string.text + begin, string.length - begin, (size_t)count);
    return give_string(ev, node, value, string.text + begin, bytes);
}

static bool change_case(Eval *ev, const AstNode *node, Value *value, char first, char last, int change)
{
    Value string;
    if (!ask_string(ev, node->a, &string) || !eval_work(ev, CHARACTER_WORK * string.length, node->span)) {
        return false;
    }
    char *copy = arena_copy_text(&ev->scratch, string.text, string.length);
    if (copy == NULL) {
        return eval_no_memory(ev, node->span);
    }
    for (size_t i = 0; i < string.length; i++) {
        if (copy[i] >= first && copy[i] <= last) {
            copy[i] = (char)(copy[i] + change);
        }
    }
    *value = string;
    value->text = copy;
    return true;
}

bool builtin_strupr(Eval *ev, const AstNode *node, Value *value)
{
    return change_case(ev, node, value, 'a', 'z', 'A' - 'a');
}

bool builtin_strlwr(Eval *ev, const AstNode *node, Value *value)
{
    return change_case(ev, node, value, 'A', 'Z', 'a' - 'A');
}

// A form of a date without its time zones, `%z` and `%Z`: POV-Ray's moments have none.
static void append_without_zones(TextBuffer *out, const char *format)
{
    while (*format != '\0') {
        size_t length = strcspn(format, "%");
        text_append_n(out, format, length);
        format += length;
        length = *format == '%' ? 1 + strspn(format + 1, "_-0^#123456789") : 0;
        length += length > 0 ? strspn(format + length, "EO") : 0;
        length += length > 0 && format[length] != '\0' ? 1 : 0;
        if (length > 0 && format[length - 1] != 'z' && format[length - 1] != 'Z') {
            text_append_n(out, format, length);
        }
        format += length;
    }
}

// The moment of `seconds` since 1970, UTC, as strftime writes it in the C locale; false: it has no room or no year that
// POV-Ray takes.
static bool append_moment(TextBuffer *out, double seconds, const char *format)
{
    struct tm moment;
    char text[DATE_MAX];
    time_t time = (time_t)seconds;
    if (gmtime_r(&time, &moment) == NULL) {
        return false;
    }
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (plain == (locale_t)0) {
        return false;
    }
    size_t length = strftime_l(text, sizeof text, format, &moment, plain);
    freelocale(plain);
    text_append_n(out, text, length);
    return length > 0;
}

bool builtin_datetime(Eval *ev, const AstNode *node, Value *value)
{
    static const double first = -219145.0, last = 2921939.0; // the years 1400 to 9999
    double days;
    Value format = {.text = "%Y-%m-%d %H:%M:%SZ"};
    if (!ask_number(ev, node->a, &days) || (node->count > 1 && !ask_string(ev, argument(node, 1), &format))) {
        return false;
    }
    double seconds = floor(days * SECONDS_A_DAY + 0.5);
    if (!(seconds >= first * SECONDS_A_DAY && seconds < last * SECONDS_A_DAY)) {
        return eval_fault(ev, DIAG_E0304, node->a->span, "%g days after 2000-01-01 are not in the years 1400 to 9999",
                          days);
    }
    TextBuffer out;
    text_init(&out);
    TextBuffer form;
    text_init(&form);
    append_without_zones(&form, format.text);
    bool is_written = append_moment(&out, seconds + EPOCH_2000, text_get(&form));
    text_fini(&form);
    if (!is_written) {
        text_fini(&out);
        return eval_fault(ev, DIAG_E0304, node->span, "this form gives no text, or more than %d characters",
                          DATE_MAX - 1);
    }
    return give_buffer(ev, node, value, &out);
}
