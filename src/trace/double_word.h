// Double-word arithmetic: a number as the unevaluated sum of two doubles, about 106 bits.
//
// Error-free transforms (Møller, Knuth; Dekker) and the operations of Joldes, Muller, Popescu, "Tight and rigorous
// error bounds for basic building blocks of double-word arithmetic", ACM TOMS 44(2), 2017. An error-free transform has
// one right result, so a fused multiply-add, where the processor has it, gives the same bits as the split without it.
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

// a + b exactly.
RT_ALWAYS_INLINE DoubleWord two_sum(double a, double b)
{
    double sum = a + b;
    double b_part = sum - a;
    double a_part = sum - b_part;
    return (DoubleWord){sum, (a - a_part) + (b - b_part)};
}

// a + b exactly; |a| >= |b|, or a = 0.
RT_ALWAYS_INLINE DoubleWord two_sum_ordered(double a, double b)
{
    double sum = a + b;
    return (DoubleWord){sum, b - (sum - a)};
}

#if defined(__FMA__) || defined(__ARM_FEATURE_FMA)
// a b exactly, when nothing over- or underflows.
RT_ALWAYS_INLINE DoubleWord two_product(double a, double b)
{
    double product = a * b;
    return (DoubleWord){product, __builtin_fma(a, b, -product)};
}
#else
// The upper 26 bits of a; |a| < 2^996.
RT_ALWAYS_INLINE double upper_half(double a)
{
    double scaled = 0x1.0000002p27 * a;
    return scaled - (scaled - a);
}

// a b exactly, when nothing over- or underflows.
RT_ALWAYS_INLINE DoubleWord two_product(double a, double b)
{
    double product = a * b;
    double a_upper = upper_half(a);
    double b_upper = upper_half(b);
    double a_lower = a - a_upper;
    double b_lower = b - b_upper;
    double error = ((a_upper * b_upper - product) + a_upper * b_lower + a_lower * b_upper) + a_lower * b_lower;
    return (DoubleWord){product, error};
}
#endif

// Relative error <= 3 u², also when the terms cancel (their AccurateDWPlusDW).
RT_ALWAYS_INLINE DoubleWord double_word_add(DoubleWord a, DoubleWord b)
{
    DoubleWord high = two_sum(a.hi, b.hi);
    DoubleWord low = two_sum(a.lo, b.lo);
    DoubleWord sum = two_sum_ordered(high.hi, high.lo + low.hi);
    return two_sum_ordered(sum.hi, low.lo + sum.lo);
}

RT_ALWAYS_INLINE DoubleWord double_word_neg(DoubleWord a)
{
    return (DoubleWord){-a.hi, -a.lo};
}

RT_ALWAYS_INLINE DoubleWord double_word_sub(DoubleWord a, DoubleWord b)
{
    return double_word_add(a, double_word_neg(b));
}

// Relative error <= 7 u² (their DWTimesDW1).
RT_ALWAYS_INLINE DoubleWord double_word_mul(DoubleWord a, DoubleWord b)
{
    DoubleWord high = two_product(a.hi, b.hi);
    return two_sum_ordered(high.hi, high.lo + (a.hi * b.lo + a.lo * b.hi));
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
    if (!(root > 0.0)) {
        return (DoubleWord){root, 0.0};
    }
    DoubleWord square = two_product(root, root);
    double rest = ((a.hi - square.hi) - square.lo) + a.lo;
    return two_sum_ordered(root, rest / (2.0 * root));
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
