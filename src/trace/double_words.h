// Double-word arithmetic, some numbers at once: part of files that are compiled once for each instruction set.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_DOUBLE_WORDS_H
#define TRACE_DOUBLE_WORDS_H

#include "trace/simd.h"

typedef struct DoubleWords {
    Doubles hi, lo;
} DoubleWords;

#include "trace/lane_doubles.h"
#include "trace/double_word.inc"

// o + t d of each.
RT_ALWAYS_INLINE DoubleWords double_words_along(Doubles o, Doubles d, DoubleWords t)
{
    DoubleWords product = two_products(d, t.hi);
    DoubleWords along = two_sums(product.hi, product.lo + d * t.lo);
    return double_words_add(along, (DoubleWords){o, doubles_splat(0.0)});
}

#endif
