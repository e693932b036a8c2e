// Numbers from text, independent of the locale and correctly rounded.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_NUMBER_H
#define BASE_NUMBER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/attributes.h"

typedef enum NumberResult {
    NUMBER_OK,        // the nearest double (a denormal or zero for a tiny literal is still the nearest)
    NUMBER_OVERFLOW,  // beyond the greatest double; *value is then HUGE_VAL
    NUMBER_MALFORMED, // not a number from first to last character
} NumberResult;

// Reads `length` characters of the form digits[.digits][(e|E)[+|-]digits], where one of the digit runs of the
// mantissa may be empty (`.5`, `1.`). No sign, no blanks, no hexadecimal.
// Short literals take an exact path: at most 15 significant digits and a power of ten up to 22 make one correctly
// rounded operation (W. Clinger, "How to read floating point numbers accurately", PLDI 1990).
// Up to 19 digits and a power of ten up to 27 make one exact integer operation; all others go to strtod.
NumberResult number_parse(const char *text, size_t length, double *value) RT_MUST_CHECK;

// The same for a number at the beginning of the text: *used is its length. `1e` and `1e+` are 1, as in scenes, and all
// of their characters are used. NUMBER_MALFORMED when no number stands there.
NumberResult number_scan(const char *text, size_t length, double *value, size_t *used) RT_MUST_CHECK;

// The nearest double to mantissa * 10^power; HUGE_VAL when that is beyond the greatest double.
double number_from_decimal(uint64_t mantissa, int power) RT_MUST_CHECK;

// A number rounded to single precision. GCC 12 drops such a conversion there and back of two neighbours in memory when
// it turns both into one vector (seen at -O2), hence volatile.
static inline double number_single(double number)
{
    volatile float single = (float)number;
    return single;
}

// What the language's functions of these names give; also in formulas that the renderer does.
#define NUMBER_PI 3.14159265358979323846
double number_to_int(double number); // as a C conversion to int does it on x86: what does not fit is the least int
double number_degrees(double radians);
double number_radians(double degrees);

#endif
