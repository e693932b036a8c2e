// What a polynomial in three variables is along a line, in LINE_REAL: double, or a vector of them for as many lines.
// Operations and their order are the same.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_POLYNOMIAL_LINE_H
#define TRACE_POLYNOMIAL_LINE_H

#include "base/attributes.h"
#include "scene/polynomial.h"

#ifndef LINE_REAL
#define LINE_REAL double
#endif

// Of loops whose bounds are constants where it counts. clang unrolls these by itself, and warns of those that have
// none.
#ifdef __clang__
#define UNROLLED
#else
#define UNROLLED _Pragma("GCC unroll 5")
#endif

enum { LINE_TERMS_MOST = POLYNOMIAL_ORDER_MOST + 1 };

// A polynomial of a degree, times b + d s, plus a number; a degree less than 0: it is 0.
RT_ALWAYS_INLINE int times_line(LINE_REAL *p, int degree, LINE_REAL b, LINE_REAL d)
{
    if (degree < 0) {
        return degree;
    }
    p[degree + 1] = p[degree] * d;
    UNROLLED
    for (int i = degree; i > 0; i--) {
        p[i] = p[i] * b + p[i - 1] * d;
    }
    p[0] *= b;
    return degree + 1;
}

RT_ALWAYS_INLINE int plus(LINE_REAL *p, int degree, const LINE_REAL *q, int q_degree)
{
    UNROLLED
    for (int i = 0; i <= q_degree; i++) {
        p[i] = i <= degree ? p[i] + q[i] : q[i];
    }
    return q_degree > degree ? q_degree : degree;
}

// The coefficients along base + s along; `whole` has room for order + 1. Where the order is no constant, leading
// coefficients of the surface that are 0 cost a comparison; the sum is the same.
RT_ALWAYS_INLINE void compose_of(const double *list, const LINE_REAL base[3], const LINE_REAL along[3], int order,
                                 bool skips, LINE_REAL *whole)
{
    LINE_REAL row[LINE_TERMS_MOST], part[LINE_TERMS_MOST];
    int whole_degree = -1;
    const double *c = polynomial_terms(list);
    UNROLLED
    for (int i = order; i >= 0; i--) {
        int row_degree = -1;
        UNROLLED
        for (int j = order - i; j >= 0; j--) {
            int part_degree = -1;
            UNROLLED
            for (int k = order - i - j; k >= 0; k--) {
                double number = *c++;
                LINE_REAL term = number - (LINE_REAL){0};
                part_degree = times_line(part, part_degree, base[2], along[2]);
                part_degree =
                    !skips || number != 0.0 || part_degree >= 0 ? plus(part, part_degree, &term, 0) : part_degree;
            }
            row_degree = times_line(row, row_degree, base[1], along[1]);
            row_degree = plus(row, row_degree, part, part_degree);
        }
        whole_degree = times_line(whole, whole_degree, base[0], along[0]);
        whole_degree = plus(whole, whole_degree, row, row_degree);
    }
    for (int i = whole_degree + 1; i <= order; i++) {
        whole[i] = (LINE_REAL){0};
    }
}

#endif
