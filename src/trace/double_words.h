// The arithmetic of double_word.h, some numbers at once.
//
// Operations and their order are those there, so the bits are the same. Part of files that are compiled once for each
// instruction set.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_DOUBLE_WORDS_H
#define TRACE_DOUBLE_WORDS_H

#include "trace/simd.h"

typedef struct DoubleWords {
    Doubles hi, lo;
} DoubleWords;

RT_ALWAYS_INLINE DoubleWords two_sums(Doubles a, Doubles b)
{
    Doubles sum = a + b;
    Doubles b_part = sum - a;
    Doubles a_part = sum - b_part;
    return (DoubleWords){sum, (a - a_part) + (b - b_part)};
}

RT_ALWAYS_INLINE DoubleWords two_products(Doubles a, Doubles b)
{
    Doubles product = a * b;
    return (DoubleWords){product, doubles_product_error(a, b, product)};
}

RT_ALWAYS_INLINE DoubleWords two_sums_ordered(Doubles a, Doubles b)
{
    Doubles sum = a + b;
    return (DoubleWords){sum, b - (sum - a)};
}

RT_ALWAYS_INLINE DoubleWords double_words_add(DoubleWords a, DoubleWords b)
{
    DoubleWords high = two_sums(a.hi, b.hi), low = two_sums(a.lo, b.lo);
    DoubleWords sum = two_sums_ordered(high.hi, high.lo + low.hi);
    return two_sums_ordered(sum.hi, low.lo + sum.lo);
}

RT_ALWAYS_INLINE DoubleWords double_words_square(DoubleWords a)
{
    DoubleWords high = two_products(a.hi, a.hi);
    return two_sums_ordered(high.hi, high.lo + (a.hi * a.lo + a.lo * a.hi));
}

RT_ALWAYS_INLINE DoubleWords double_words_sqrt(DoubleWords a)
{
    Doubles root = doubles_sqrt(a.hi);
    DoubleWords square = two_products(root, root);
    Doubles rest = ((a.hi - square.hi) - square.lo) + a.lo;
    return two_sums_ordered(root, rest / (2.0 * root));
}

// o + t d of each.
RT_ALWAYS_INLINE DoubleWords double_words_along(Doubles o, Doubles d, DoubleWords t)
{
    DoubleWords product = two_products(d, t.hi);
    DoubleWords along = two_sums(product.hi, product.lo + d * t.lo);
    return double_words_add(along, (DoubleWords){o, doubles_splat(0.0)});
}

#endif
