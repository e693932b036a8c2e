// TextBuffer: appends, formatted appends, and doubles in their shortest form.
//
// Owns the text. Knows nothing of where it goes.
//
// SPDX-License-Identifier: MIT
#include "base/text.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"

enum {
    CAPACITY_LEAST = 256,
    DIGITS_READ = 19,      // digits asked of snprintf: as many as fit 64 bits
    DIGITS_GREATEST = 17,  // digits that always tell one double from the next
    DIGITS_UNIQUE = 15,    // decimals this short are each the shortest form of their double
    PLAIN_POINT_LEAST = -5 // 0.000001 is written plainly, 0.0000001 as 1e-7
};
#define PLAIN_POINT_GREATEST 21 // 1e20 is written plainly, 1e21 is not
#define INTEGER_EXACT        9007199254740992.0

void text_init(TextBuffer *buffer)
{
    *buffer = (TextBuffer){0};
}

void text_fini(TextBuffer *buffer)
{
    free(buffer->text);
    text_init(buffer);
}

void text_clear(TextBuffer *buffer)
{
    buffer->length = 0;
    buffer->failed = false;
    if (buffer->text) {
        buffer->text[0] = '\0';
    }
}

// Makes room for `more` bytes and the zero at the end.
static bool text_reserve(TextBuffer *buffer, size_t more)
{
    if (more < buffer->capacity - buffer->length) {
        return true;
    }
    if (more >= SIZE_MAX / 4 - buffer->length) {
        buffer->failed = true;
        return false;
    }
    size_t capacity = buffer->capacity < CAPACITY_LEAST ? CAPACITY_LEAST : buffer->capacity;
    while (capacity <= buffer->length + more) {
        capacity *= 2;
    }
    char *moved = realloc(buffer->text, capacity);
    if (!moved) {
        buffer->failed = true;
        return false;
    }
    buffer->text = moved;
    buffer->capacity = capacity;
    return true;
}

void text_append_n(TextBuffer *buffer, const char *text, size_t length)
{
    if (!text_reserve(buffer, length)) {
        return;
    }
    if (length) {
        memcpy(buffer->text + buffer->length, text, length);
    }
    buffer->length += length;
    buffer->text[buffer->length] = '\0';
}

void text_append(TextBuffer *buffer, const char *text)
{
    text_append_n(buffer, text, strlen(text));
}

void text_append_char(TextBuffer *buffer, char c)
{
    text_append_n(buffer, &c, 1);
}

void text_printf(TextBuffer *buffer, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    text_vprintf(buffer, format, arguments);
    va_end(arguments);
}

void text_vprintf(TextBuffer *buffer, const char *format, va_list arguments)
{
    if (!text_reserve(buffer, 1)) {
        return;
    }
    va_list again;
    va_copy(again, arguments);
    size_t room = buffer->capacity - buffer->length;
    int length = vsnprintf(buffer->text + buffer->length, room, format, arguments);
    if (length >= 0 && (size_t)length >= room && text_reserve(buffer, (size_t)length)) {
        room = buffer->capacity - buffer->length;
        length = vsnprintf(buffer->text + buffer->length, room, format, again);
    }
    va_end(again);
    if (length >= 0 && (size_t)length < room) {
        buffer->length += (size_t)length;
    } else {
        buffer->failed = true;
    }
    buffer->text[buffer->length] = '\0';
}

// A decimal: digits * 10^power.
typedef struct Decimal {
    uint64_t digits;
    int power;
} Decimal;

static const double tens[DIGITS_UNIQUE + 1] = {
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
};

// Finds the decimal of a number that has few digits behind its point, as most in a scene have. The product is off by
// less than a quarter while it is below 10^15, so that rounding finds the integer; the quotient of two exact doubles is
// what a reader makes of the decimal.
static bool decimal_find_short(double value, Decimal *decimal)
{
    for (int places = 0; places <= DIGITS_UNIQUE; places++) {
        double scaled = rint(value * tens[places]);
        if (scaled >= tens[DIGITS_UNIQUE]) {
            return false;
        }
        if (scaled / tens[places] == value) {
            *decimal = (Decimal){(uint64_t)scaled, -places};
            return true;
        }
    }
    return false;
}

// The first 19 digits of a positive number, rounded. Steps over the decimal point, which a locale may set.
static Decimal decimal_read(double value)
{
    char text[48];
    Decimal decimal = {0, 0};
    snprintf(text, sizeof(text), "%.*e", DIGITS_READ - 1, value);
    const char *exponent = strchr(text, 'e');
    for (const char *at = text; at < exponent; at++) {
        if (*at >= '0' && *at <= '9') {
            decimal.digits = decimal.digits * 10 + (uint64_t)(*at - '0');
        }
    }
    decimal.power = (int)strtol(exponent + 1, NULL, 10) - (DIGITS_READ - 1);
    return decimal;
}

// Shortens to `drop` digits less. Of the two neighbours, takes the nearer one that reads back as the value: at a power
// of two the gap below is half the gap above, and the nearer one may miss while the other does not.
static bool decimal_shorten(Decimal full, int drop, double value, Decimal *shorter)
{
    uint64_t scale = 1;
    for (int i = 0; i < drop; i++) {
        scale *= 10;
    }
    uint64_t below = full.digits / scale;
    uint64_t rest = full.digits % scale;
    uint64_t nearer = rest * 2 > scale || (rest * 2 == scale && below % 2 == 1);
    for (uint64_t i = 0; i < 2; i++) {
        Decimal candidate = {below + (i ? 1 - nearer : nearer), full.power + drop};
        if (candidate.digits != 0 && number_from_decimal(candidate.digits, candidate.power) == value) {
            *shorter = candidate;
            return true;
        }
    }
    return false;
}

// The shortest decimal that reads back as the value. A decimal that is too short to do so only has shorter ones that
// are too short as well, hence the first failure ends the search.
static Decimal decimal_find(double value)
{
    Decimal shortest;
    if (decimal_find_short(value, &shortest)) {
        return shortest;
    }
    Decimal full = decimal_read(value);
    shortest = full;
    for (int drop = DIGITS_READ - DIGITS_GREATEST; drop < DIGITS_READ; drop++) {
        if (!decimal_shorten(full, drop, value, &shortest)) {
            break;
        }
    }
    return shortest;
}

// Writes the digits so that they end at `end`; their beginning. A format string would cost more than all the rest.
static const char *digits_write(uint64_t value, char *end)
{
    do {
        *--end = (char)('0' + value % 10);
        value /= 10;
    } while (value != 0);
    return end;
}

static void append_integer(TextBuffer *buffer, uint64_t value)
{
    char bytes[24], *end = bytes + sizeof(bytes);
    const char *digits = digits_write(value, end);
    text_append_n(buffer, digits, (size_t)(end - digits));
}

static void append_zeros(TextBuffer *buffer, int count)
{
    for (int i = 0; i < count; i++) {
        text_append_char(buffer, '0');
    }
}

static void append_decimal(TextBuffer *buffer, Decimal decimal)
{
    char bytes[24], *end = bytes + sizeof(bytes);
    while (decimal.digits != 0 && decimal.digits % 10 == 0) {
        decimal.digits /= 10;
        decimal.power++;
    }
    const char *digits = digits_write(decimal.digits, end);
    int count = (int)(end - digits);
    int point = count + decimal.power; // digits before the decimal point
    if (point < PLAIN_POINT_LEAST || point > PLAIN_POINT_GREATEST) {
        text_append_char(buffer, digits[0]);
        if (count > 1) {
            text_append_char(buffer, '.');
            text_append_n(buffer, digits + 1, (size_t)count - 1);
        }
        text_printf(buffer, "e%d", point - 1);
    } else if (point <= 0) {
        text_append(buffer, "0.");
        append_zeros(buffer, -point);
        text_append_n(buffer, digits, (size_t)count);
    } else if (point >= count) {
        text_append_n(buffer, digits, (size_t)count);
        append_zeros(buffer, point - count);
    } else {
        text_append_n(buffer, digits, (size_t)point);
        text_append_char(buffer, '.');
        text_append_n(buffer, digits + point, (size_t)(count - point));
    }
}

void text_append_double(TextBuffer *buffer, double value)
{
    if (isnan(value)) {
        text_append(buffer, "nan");
        return;
    }
    if (signbit(value)) {
        text_append_char(buffer, '-');
        value = -value;
    }
    if (isinf(value)) {
        text_append(buffer, "inf");
    } else if (value < INTEGER_EXACT && value == (double)(uint64_t)value) {
        append_integer(buffer, (uint64_t)value);
    } else {
        append_decimal(buffer, decimal_find(value));
    }
}

void text_append_utf8(TextBuffer *buffer, unsigned point)
{
    if (point < 0x80) {
        text_append_char(buffer, (char)point);
    } else if (point < 0x800) {
        text_append_char(buffer, (char)(0xc0 | point >> 6));
        text_append_char(buffer, (char)(0x80 | (point & 0x3f)));
    } else {
        text_append_char(buffer, (char)(0xe0 | point >> 12));
        text_append_char(buffer, (char)(0x80 | (point >> 6 & 0x3f)));
        text_append_char(buffer, (char)(0x80 | (point & 0x3f)));
    }
}

static bool parse_hex4(const char *text, unsigned *point)
{
    static const char digits[] = "0123456789abcdef";
    *point = 0;
    for (int i = 0; i < 4; i++) {
        char c = text[i] >= 'A' && text[i] <= 'F' ? (char)(text[i] - 'A' + 'a') : text[i];
        const char *digit = c != '\0' ? strchr(digits, c) : NULL;
        if (!digit) {
            return false;
        }
        *point = *point << 4 | (unsigned)(digit - digits);
    }
    return true;
}

size_t text_append_escape(TextBuffer *buffer, const char *text, size_t length)
{
    static const char letters[] = "abfnrtv\\\"'", meanings[] = "\a\b\f\n\r\t\v\\\"'";
    const char *letter = length >= 2 && text[1] != '\0' ? strchr(letters, text[1]) : NULL;
    unsigned point;
    if (letter) {
        text_append_char(buffer, meanings[letter - letters]);
        return 2;
    }
    if (length >= 6 && text[1] == 'u' && parse_hex4(text + 2, &point)) {
        if (point >= 0x80) {
            text_append_char(buffer, TEXT_MARK);
        }
        text_append_utf8(buffer, point);
        return 6;
    }
    return 0;
}

// In UTF-8 a character's further bytes are 10xxxxxx.
static size_t count_characters(const char *text, size_t length)
{
    size_t count = 0;
    for (size_t i = 0; i < length; i++) {
        count += ((unsigned char)text[i] & 0xC0) != 0x80;
    }
    return count;
}

void text_append_wrapped(TextBuffer *buffer, const char *words, size_t column, size_t indent, size_t columns)
{
    for (bool is_first = true; *words != '\0'; is_first = false) {
        size_t length = strcspn(words, " "), width = count_characters(words, length);
        if (!is_first && column + 1 + width > columns) {
            text_printf(buffer, "\n%*s", (int)indent, "");
            column = indent;
        } else if (!is_first) {
            text_append_char(buffer, ' ');
            column++;
        }
        text_append_n(buffer, words, length);
        column += width;
        words += length + strspn(words + length, " ");
    }
    text_append_char(buffer, '\n');
}

const char *text_get(const TextBuffer *buffer)
{
    return buffer->text ? buffer->text : "";
}
