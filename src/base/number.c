// Numbers from text: digits into a 64-bit mantissa and a power of ten, and from there to the nearest double.
//
// Three ways, from fast to slow: one floating-point operation, one exact 128-bit integer operation, and strtod on a
// form of the literal that has no decimal point, so that no locale can matter.
//
// SPDX-License-Identifier: MIT
#include "base/number.h"

#include <inttypes.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

__extension__ typedef unsigned __int128 Wide;

enum {
    MANTISSA_DIGITS = 19,   // as many decimal digits always fit 64 bits
    EXACT_POWER = 22,       // 10^22 is the greatest power of ten that is a double
    INTEGER_POWER = 27,     // 5^27 is the greatest power of five below 2^64
    DIGITS_THAT_COUNT = 768 // no double, nor the middle of two, has more; a digit beyond only breaks a tie
};

#define MANTISSA_EXACT ((uint64_t)1 << 53)
#define POWER_GREATEST ((int64_t)1 << 62) // exponents saturate here, far beyond the length of any text

static const double tens[EXACT_POWER + 1] = {
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
};

static const uint64_t fives[INTEGER_POWER + 1] = {
    1u,
    5u,
    25u,
    125u,
    625u,
    3125u,
    15625u,
    78125u,
    390625u,
    1953125u,
    9765625u,
    48828125u,
    244140625u,
    1220703125u,
    6103515625u,
    30517578125u,
    152587890625u,
    762939453125u,
    3814697265625u,
    19073486328125u,
    95367431640625u,
    476837158203125u,
    2384185791015625u,
    11920928955078125u,
    59604644775390625u,
    298023223876953125u,
    1490116119384765625u,
    7450580596923828125u,
};

// A literal taken apart. The digits are those of both runs, the point left out.
typedef struct Literal {
    const char *whole, *whole_end;
    const char *fraction, *fraction_end;
    int64_t exponent;  // as written
    uint64_t mantissa; // all digits as one integer, modulo 2^64
} Literal;

// The nearest double to mantissa * 10^power by integers alone: numerator or denominator are exact, the quotient has 63
// or 64 bits, and the remainder only matters as "not zero", which the lowest bit takes. The conversion rounds once.
static double decimal_by_integers(uint64_t mantissa, int power)
{
    if (power >= 0) {
        return ldexp((double)((Wide)mantissa * fives[power]), power);
    }
    int up = __builtin_clzll(mantissa);
    int divisor_up = __builtin_clzll(fives[-power]);
    Wide numerator = (Wide)(mantissa << up) << 63;
    uint64_t divisor = fives[-power] << divisor_up;
    uint64_t quotient = (uint64_t)(numerator / divisor);
    uint64_t rest = (uint64_t)(numerator % divisor);
    return ldexp((double)(quotient | (rest != 0)), power + divisor_up - up - 63);
}

double number_from_decimal(uint64_t mantissa, int power)
{
    if (mantissa <= MANTISSA_EXACT && power >= -EXACT_POWER && power <= EXACT_POWER) {
        return power < 0 ? (double)mantissa / tens[-power] : (double)mantissa * tens[power];
    }
    if (mantissa == 0) {
        return 0.0;
    }
    if (power >= -INTEGER_POWER && power <= INTEGER_POWER) {
        return decimal_by_integers(mantissa, power);
    }
    char text[48];
    snprintf(text, sizeof(text), "%" PRIu64 "e%d", mantissa, power);
    return strtod(text, NULL);
}

static bool is_digit(char c)
{
    return (unsigned char)(c - '0') < 10;
}

static const char *digits_read(const char *at, const char *end, uint64_t *mantissa)
{
    uint64_t value = *mantissa;
    while (at < end && is_digit(*at)) {
        value = value * 10 + (uint64_t)(*at++ - '0');
    }
    *mantissa = value;
    return at;
}

// Reads what follows the `e`, and says where it ends; an exponent without digits is 0.
static const char *exponent_read(const char *at, const char *end, int64_t *exponent)
{
    bool is_negative = at < end && *at == '-';
    at += at < end && (*at == '-' || *at == '+');
    int64_t value = 0;
    for (; at < end && is_digit(*at); at++) {
        value = value > POWER_GREATEST / 10 - 1 ? POWER_GREATEST : value * 10 + (*at - '0');
    }
    *exponent = is_negative ? -value : value;
    return at;
}

// Where the literal at the beginning of the text ends; NULL when there is none.
static const char *literal_read(const char *text, const char *end, Literal *literal)
{
    literal->mantissa = 0;
    literal->exponent = 0;
    literal->whole = text;
    const char *at = literal->whole_end = digits_read(text, end, &literal->mantissa);
    at += at < end && *at == '.';
    literal->fraction = at;
    at = literal->fraction_end = digits_read(at, end, &literal->mantissa);
    if (literal->whole == literal->whole_end && literal->fraction == literal->fraction_end) {
        return NULL;
    }
    return at < end && (*at == 'e' || *at == 'E') ? exponent_read(at + 1, end, &literal->exponent) : at;
}

// For literals of any length: their digits from the first that is not zero, as many as count, then a last 1 in place of
// all others if one of them is not zero, then the exponent. strtod reads this correctly rounded in every locale.
static double literal_by_strtod(const Literal *literal)
{
    char text[DIGITS_THAT_COUNT + 32];
    size_t kept = 0;
    int64_t dropped = 0; // digits that did not fit
    bool is_tie_broken = false;
    const char *runs[][2] = {{literal->whole, literal->whole_end}, {literal->fraction, literal->fraction_end}};
    for (size_t i = 0; i < RT_COUNT_OF(runs); i++) {
        for (const char *at = runs[i][0]; at < runs[i][1]; at++) {
            if (kept < DIGITS_THAT_COUNT) {
                text[kept] = *at;
                kept += kept > 0 || *at != '0';
            } else {
                dropped++;
                is_tie_broken |= *at != '0';
            }
        }
    }
    if (kept == 0) {
        return 0.0;
    }
    int64_t power = literal->exponent + dropped - (literal->fraction_end - literal->fraction);
    if (is_tie_broken) {
        text[kept++] = '1';
        power--;
    }
    // Beyond these every literal of this many digits is zero or too great, so that the number stays short.
    power = power > 400 ? 400 : power < -2000 ? -2000 : power;
    snprintf(text + kept, sizeof(text) - kept, "e%d", (int)power);
    return strtod(text, NULL);
}

static NumberResult literal_value(const Literal *literal, double *value)
{
    const char *first = literal->whole;
    ptrdiff_t fraction_digits = literal->fraction_end - literal->fraction;
    ptrdiff_t digits = literal->whole_end - literal->whole + fraction_digits;
    if (RT_UNLIKELY(digits > MANTISSA_DIGITS)) {
        for (; first < literal->fraction_end && (*first == '0' || *first == '.'); first++) {
            digits -= *first == '0';
        }
    }
    int64_t power = literal->exponent - fraction_digits;
    if (RT_LIKELY(digits <= MANTISSA_DIGITS && power >= -1000 && power <= 1000)) {
        *value = number_from_decimal(literal->mantissa, (int)power);
    } else {
        *value = literal_by_strtod(literal);
    }
    return isinf(*value) ? NUMBER_OVERFLOW : NUMBER_OK;
}

NumberResult number_scan(const char *text, size_t length, double *value, size_t *used)
{
    Literal literal;
    const char *end = literal_read(text, text + length, &literal);
    if (!end) {
        return NUMBER_MALFORMED;
    }
    *used = (size_t)(end - text);
    return literal_value(&literal, value);
}

NumberResult number_parse(const char *text, size_t length, double *value)
{
    Literal literal;
    const char *end = literal_read(text, text + length, &literal);
    if (!end || end != text + length || (!is_digit(end[-1]) && end[-1] != '.')) {
        return NUMBER_MALFORMED;
    }
    return literal_value(&literal, value);
}

double number_to_int(double number)
{
    // A whole number has no negative zero.
    return number > -2147483649.0 && number < 2147483648.0 ? trunc(number) + 0.0 : -2147483648.0;
}

// Rounded as POV-Ray does it, measured on 400 numbers.
double number_degrees(double radians)
{
    return radians / (NUMBER_PI / 180.0);
}

double number_radians(double degrees)
{
    return degrees * (NUMBER_PI / 180.0);
}
