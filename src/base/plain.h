// Plain text in a buffer: blanks, digits, letters and numbers, read without the tables of a scanner.
//
// The buffer ends with a zero. What is not sure to be read alike by those who read all forms of a number, the scanner of
// scenes and the reader of data files, is refused, and left to them.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_PLAIN_H
#define BASE_PLAIN_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/attributes.h"
#include "base/number.h"

enum { PLAIN_NUMBER_LONGEST = 250 }; // a longer one is left to the scanner

static inline bool plain_is_blank(char c)
{
    return c == ' ' || c == '\n' || c == '\t' || c == '\r';
}

static inline const char *plain_skip_blanks(const char *at)
{
    while (plain_is_blank(*at)) {
        at++;
    }
    return at;
}

static inline bool plain_is_digit(char c)
{
    return (unsigned char)(c - '0') < 10;
}

static inline bool plain_is_letter(char c)
{
    return (unsigned char)((c | ' ') - 'a') < 26 || c == '_';
}

// What continues with a number, or makes a word of its end.
static inline bool plain_goes_on(char c)
{
    static const bool table[256] = {
        ['0' ... '9'] = true, ['A' ... 'Z'] = true, ['a' ... 'z'] = true, ['_'] = true, ['.'] = true,
    };
    return table[(unsigned char)c];
}

static inline bool plain_is_in_word(char c)
{
    return plain_goes_on(c) && c != '.';
}

// Of eight bytes less '0' the bits that no digit has: a byte is a digit when its high half is 0 and adding 6 to the low
// half does not carry.
static inline uint64_t plain_others(uint64_t digits)
{
    return (digits | (digits + UINT64_C(0x0606060606060606))) & UINT64_C(0xf0f0f0f0f0f0f0f0);
}

// How many digits eight bytes of text begin with.
static inline unsigned plain_count_digits(uint64_t chunk)
{
    uint64_t others = plain_others(chunk ^ UINT64_C(0x3030303030303030));
    return others != 0 ? (unsigned)__builtin_ctzll(others) / 8 : 8;
}

// The number of eight digits: pairs, pairs of pairs and so on are combined by multiplication.
static inline uint64_t plain_join(uint64_t digits)
{
    digits = digits * 10 + (digits >> 8);
    return ((digits & UINT64_C(0x000000ff000000ff)) * UINT64_C(0x000f424000000064) +
            (digits >> 16 & UINT64_C(0x000000ff000000ff)) * UINT64_C(0x0000271000000001)) >> 32;
}

// Of the first `count` >= 1 of them in a text.
static inline uint64_t plain_join_digits(uint64_t chunk, unsigned count)
{
    return plain_join((chunk ^ UINT64_C(0x3030303030303030)) << (64 - 8 * count)); // zeros before the first digit
}

// A number without its sign, of any form, and where it ends; NULL: it is refused.
static inline const char *plain_read_any(const char *at, const char *end, double *number)
{
    size_t length = (size_t)(end - at), used;
    length = length < PLAIN_NUMBER_LONGEST ? length : PLAIN_NUMBER_LONGEST;
    bool is_number = plain_is_digit(*at) || (*at == '.' && plain_is_digit(at[1]));
    if (!is_number || number_scan(at, length, number, &used) != NUMBER_OK || used >= PLAIN_NUMBER_LONGEST) {
        return NULL;
    }
    at += used;
    return plain_is_digit(at[-1]) || at[-1] == '.' ? at : NULL;
}

// Powers of ten that are integers and doubles; and what divides a number with a minus sign.
static const struct {
    int64_t integer;
    double real[2];
} plain_tens[] = {{1, {1e0, -1e0}},
                  {10, {1e1, -1e1}},
                  {100, {1e2, -1e2}},
                  {1000, {1e3, -1e3}},
                  {10000, {1e4, -1e4}},
                  {100000, {1e5, -1e5}},
                  {1000000, {1e6, -1e6}},
                  {10000000, {1e7, -1e7}},
                  {100000000, {1e8, -1e8}},
                  {1000000000, {1e9, -1e9}},
                  {10000000000, {1e10, -1e10}},
                  {100000000000, {1e11, -1e11}},
                  {1000000000000, {1e12, -1e12}},
                  {10000000000000, {1e13, -1e13}},
                  {100000000000000, {1e14, -1e14}}};

// After `whole` and the point there are `count` digits, which the eight bytes begin with: NULL when the number
// continues.
RT_ALWAYS_INLINE const char *plain_end_number(const char *point, int64_t whole, uint64_t chunk, unsigned count,
                                              bool is_negative, double *number)
{
    whole = whole * plain_tens[count].integer + (int64_t)plain_join_digits(chunk, count);
    *number = (double)whole / plain_tens[count].real[is_negative];
    return plain_goes_on(point[1 + count]) ? NULL : point + 1 + count;
}

// A number with or without a minus sign, and what follows it: neither a letter nor more of a number. NULL: not so.
// A number that is cut off by the end of the buffer is read as if it ended there.
// Signs come as they like, and a branch on them would be foretold badly: they are in what is divided by. How many
// digits a number has is mostly as before: branches on that are foretold well, and reading continues behind it before
// it is counted.
RT_ALWAYS_INLINE const char *plain_read_number(const char *at, const char *end, double *number)
{
    bool is_negative = *at == '-';
    at += is_negative;
#if defined __BYTE_ORDER__ && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    enum { DIGITS_FEW = 8, DIGITS_EXACT = 15, AHEAD = 32 };
    // An integer of up to 15 digits is a double, and so is the power of ten that divides it: one rounding.
    if (RT_LIKELY(end - at >= AHEAD && plain_is_digit(*at))) {
        const char *point = at + 1, *after = NULL;
        uint64_t chunk;
        int64_t whole = *at - '0';
        for (; plain_is_digit(*point) && point - at < DIGITS_FEW; point++) { // few, most of the time
            whole = whole * 10 + (*point - '0');
        }
        memcpy(&chunk, point + 1, sizeof chunk);
        unsigned count = *point == '.' ? plain_count_digits(chunk) : 0;
        switch (count) {
        case 1: after = plain_end_number(point, whole, chunk, 1, is_negative, number); break;
        case 2: after = plain_end_number(point, whole, chunk, 2, is_negative, number); break;
        case 3: after = plain_end_number(point, whole, chunk, 3, is_negative, number); break;
        case 4: after = plain_end_number(point, whole, chunk, 4, is_negative, number); break;
        case 5: after = plain_end_number(point, whole, chunk, 5, is_negative, number); break;
        case 6: after = plain_end_number(point, whole, chunk, 6, is_negative, number); break;
        case 7: after = plain_end_number(point, whole, chunk, 7, is_negative, number); break;
        default: break;
        }
        if (RT_LIKELY(after)) {
            return after;
        }
        if (count == DIGITS_FEW) {
            uint64_t next;
            after = point + 1 + count;
            memcpy(&next, after, sizeof next);
            unsigned more = plain_count_digits(next), fraction = count + more;
            if (more > 0 && (size_t)(point - at) + fraction <= DIGITS_EXACT && !plain_goes_on(after[more])) {
                whole = whole * plain_tens[count].integer + (int64_t)plain_join_digits(chunk, count);
                whole = whole * plain_tens[more].integer + (int64_t)plain_join_digits(next, more);
                *number = (double)whole / plain_tens[fraction].real[is_negative];
                return after + more;
            }
        }
        if (!plain_goes_on(*point)) {
            *number = is_negative ? -(double)whole : (double)whole;
            return point;
        }
    }
#endif
    double size;
    at = plain_read_any(at, end, &size);
    if (!at || plain_goes_on(*at)) {
        return NULL;
    }
    *number = is_negative ? -size : size;
    return at;
}

#endif
