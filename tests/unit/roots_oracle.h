// An oracle of polynomials in MPFR: all places where one changes its sign, between those of its derivative, and so on
// down. For tests that have MPFR.
//
// SPDX-License-Identifier: MIT
#ifndef UNIT_ROOTS_ORACLE_H
#define UNIT_ROOTS_ORACLE_H

#include <math.h>
#include <mpfr.h>
#include <stdbool.h>

enum { BITS = 500, ORACLE_DEGREE = 8, STEPS = 420 };

typedef struct OraclePolynomial {
    mpfr_t c[ORACLE_DEGREE + 1]; // of t^0, t^1, …
    int degree;
} OraclePolynomial;

typedef struct Roots {
    mpfr_t at[ORACLE_DEGREE];
    int count;
} Roots;

static inline void polynomial_init(OraclePolynomial *p, int degree)
{
    p->degree = degree;
    for (int i = 0; i <= ORACLE_DEGREE; i++) {
        mpfr_init2(p->c[i], BITS);
        mpfr_set_ui(p->c[i], 0, MPFR_RNDN);
    }
}

// The derivative of p, whose degree is not 0; for polynomial_fini.
static inline void slope_init(OraclePolynomial *slope, const OraclePolynomial *p)
{
    polynomial_init(slope, p->degree - 1);
    for (int i = 1; i <= p->degree; i++) {
        mpfr_mul_ui(slope->c[i - 1], p->c[i], (unsigned long)i, MPFR_RNDN);
    }
}

static inline void polynomial_fini(OraclePolynomial *p)
{
    for (int i = 0; i <= ORACLE_DEGREE; i++) {
        mpfr_clear(p->c[i]);
    }
}

static inline void roots_init(Roots *roots)
{
    roots->count = 0;
    for (int i = 0; i < ORACLE_DEGREE; i++) {
        mpfr_init2(roots->at[i], BITS);
    }
}

static inline void roots_fini(Roots *roots)
{
    for (int i = 0; i < ORACLE_DEGREE; i++) {
        mpfr_clear(roots->at[i]);
    }
}

static inline void polynomial_at(const OraclePolynomial *p, mpfr_t x, mpfr_t value)
{
    mpfr_set(value, p->c[p->degree], MPFR_RNDN);
    for (int i = p->degree; i-- > 0;) {
        mpfr_mul(value, value, x, MPFR_RNDN);
        mpfr_add(value, value, p->c[i], MPFR_RNDN);
    }
}

static inline void bisect(const OraclePolynomial *p, mpfr_t low, mpfr_t high, Roots *roots)
{
    mpfr_t a, b, middle, value;
    mpfr_inits2(BITS, a, b, middle, value, (mpfr_ptr)NULL);
    mpfr_set(a, low, MPFR_RNDN);
    mpfr_set(b, high, MPFR_RNDN);
    polynomial_at(p, a, value);
    int sign = mpfr_sgn(value);
    polynomial_at(p, b, value);
    if (sign * mpfr_sgn(value) < 0) {
        for (int i = 0; i < STEPS; i++) {
            mpfr_add(middle, a, b, MPFR_RNDN);
            mpfr_div_2ui(middle, middle, 1, MPFR_RNDN);
            polynomial_at(p, middle, value);
            mpfr_set(mpfr_sgn(value) == sign ? a : b, middle, MPFR_RNDN);
        }
        mpfr_set(roots->at[roots->count++], a, MPFR_RNDN);
    }
    mpfr_clears(a, b, middle, value, (mpfr_ptr)NULL);
}

// Roots where the sign changes, from -bound to bound.
static inline void find_roots(const OraclePolynomial *p, double bound, Roots *roots)
{
    OraclePolynomial slope;
    Roots turns;
    mpfr_t low, high;
    roots_init(roots);
    if (p->degree == 0) {
        return;
    }
    slope_init(&slope, p);
    find_roots(&slope, bound, &turns);
    mpfr_inits2(BITS, low, high, (mpfr_ptr)NULL);
    mpfr_set_d(low, -bound, MPFR_RNDN);
    for (int i = 0; i <= turns.count; i++) {
        if (i < turns.count) {
            mpfr_set(high, turns.at[i], MPFR_RNDN);
        } else {
            mpfr_set_d(high, bound, MPFR_RNDN);
        }
        bisect(p, low, high, roots);
        mpfr_set(low, high, MPFR_RNDN);
    }
    mpfr_clears(low, high, (mpfr_ptr)NULL);
    polynomial_fini(&slope);
    roots_fini(&turns);
}

// What the terms of a polynomial come to at t, by size.
typedef double (*OracleScale)(const void *client, double t);

// Whether no extremum is nearer to 0 than 26 digits of `scale` there: else any class is as good.
static inline bool is_decided(const OraclePolynomial *p, double bound, OracleScale scale, const void *client)
{
    OraclePolynomial slope;
    Roots turns;
    mpfr_t value;
    bool decided = true;
    mpfr_init2(value, BITS);
    slope_init(&slope, p);
    find_roots(&slope, bound, &turns);
    for (int i = 0; i < turns.count; i++) {
        polynomial_at(p, turns.at[i], value);
        double size = scale(client, mpfr_get_d(turns.at[i], MPFR_RNDN));
        decided = decided && !(fabs(mpfr_get_d(value, MPFR_RNDN)) < 1e-26 * size);
    }
    polynomial_fini(&slope);
    roots_fini(&turns);
    mpfr_clear(value);
    return decided;
}

#endif
