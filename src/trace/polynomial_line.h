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

// A quadric along o + t d, for the greatest coordinates `far` of o and `step` of d: its discriminant, and how much
// rounding may make of that. Where it is less than minus that, the line surely has no root: most lines pass most
// surfaces by. *value: at o.
RT_ALWAYS_INLINE LINE_REAL quadric_discriminant(const double *list, const LINE_REAL o[3], const LINE_REAL d[3],
                                                LINE_REAL far, LINE_REAL step, LINE_REAL *value, LINE_REAL *rounding)
{
    const double *c = polynomial_terms(list), *sizes = polynomial_sizes(list);
    const LINE_REAL slope[3] = {2.0 * c[0] * d[0] + c[1] * d[1] + c[2] * d[2],
                                c[1] * d[0] + 2.0 * c[4] * d[1] + c[5] * d[2],
                                c[2] * d[0] + c[5] * d[1] + 2.0 * c[7] * d[2]};
    *value = (c[0] * o[0] + c[1] * o[1] + c[2] * o[2] + c[3]) * o[0] + (c[4] * o[1] + c[5] * o[2] + c[6]) * o[1] +
             (c[7] * o[2] + c[8]) * o[2] + c[9];
    LINE_REAL a = d[0] * slope[0] + d[1] * slope[1] + d[2] * slope[2];
    LINE_REAL b = o[0] * slope[0] + o[1] * slope[1] + o[2] * slope[2] + (c[3] * d[0] + c[6] * d[1] + c[8] * d[2]);
    LINE_REAL most = 2.0 * sizes[2] * far + sizes[1], all = (sizes[2] * far + sizes[1]) * far + sizes[0];
    *rounding = 0x1p-44 * step * step * (most * most + 4.0 * sizes[2] * all);
    return b * b - 2.0 * a * *value;
}

#define QUADRIC_ROUNDING_LEAST 0x1p-940 // below it something may have underflowed

#endif
