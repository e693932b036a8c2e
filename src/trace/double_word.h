// Double-word arithmetic: a number as the unevaluated sum of two doubles, about 106 bits.
//
// trace/double_word.inc has what is the same for some numbers at once (double_words.h); this, what is for one only.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_DOUBLE_WORD_H
#define TRACE_DOUBLE_WORD_H

#include <math.h>

#include "base/attributes.h"

// hi + lo with |lo| <= u |hi|
typedef struct DoubleWord {
    double hi, lo;
} DoubleWord;

#include "math/lane_double.h"
#include "trace/double_word.inc"

RT_ALWAYS_INLINE DoubleWord double_word_neg(DoubleWord a)
{
    return (DoubleWord){-a.hi, -a.lo};
}

RT_ALWAYS_INLINE DoubleWord double_word_sub(DoubleWord a, DoubleWord b)
{
    return double_word_add(a, double_word_neg(b));
}

// Relative error <= 3 u² (their DWTimesFP1, less its last bit).
RT_ALWAYS_INLINE DoubleWord double_word_scale(DoubleWord a, double b)
{
    DoubleWord high = two_product(a.hi, b);
    return two_sum_ordered(high.hi, high.lo + a.lo * b);
}

// The root of a number that is not negative; relative error some u².
RT_ALWAYS_INLINE DoubleWord double_word_sqrt(DoubleWord a)
{
    double root = sqrt(a.hi);
    return root > 0.0 ? double_word_root(a) : (DoubleWord){root, 0.0};
}

// a / b rounded to double; relative error u and some u².
RT_ALWAYS_INLINE double double_word_quotient(DoubleWord a, DoubleWord b)
{
    double quotient = a.hi / b.hi;
    DoubleWord back = two_product(quotient, b.hi);
    double rest = (((a.hi - back.hi) - back.lo) + a.lo) - quotient * b.lo;
    return quotient + rest / b.hi;
}

#endif
