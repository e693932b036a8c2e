// The real roots of a polynomial whose coefficients are known to some error, in order.
//
// The roots of a polynomial lie between those of its derivative, one at most between two neighbours, where the signs
// differ; so from the derivative that is a line up each level is found from the one before, and none is lost. A sign is
// taken from doubles where their error bound lets it be, else from the coefficients as double words, which the owner
// makes when they are asked for first. What double words cannot distinguish from 0 is 0: where the polynomial touches 0
// without going through it there is no root.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_ROOTS_H
#define TRACE_ROOTS_H

#include <stdbool.h>

#include "trace/double_word.h"

enum { ROOTS_DEGREE_MOST = 35, ROOTS_LEVELS = (ROOTS_DEGREE_MOST + 1) * (ROOTS_DEGREE_MOST + 2) / 2 };

// How much all double-word work on a coefficient, and on the value of the polynomial, may lose beside the sizes of all
// terms that make it: degree 35 takes some 300 operations of 7 u² each.
#define ROOTS_EXACT_ERROR 0x1p-94

typedef struct Polynomial Polynomial;
struct Polynomial {
    unsigned degree;
    // Of x^0, x^1, …, and behind them the derivatives of it, each with one less.
    double terms[ROOTS_LEVELS];
    // The value at x is off by no more than the sum of errors[i] |x|^i, Horner's own rounding in it; the sum of
    // sizes[i] |x|^i is no less than that of all terms that make it.
    double errors[ROOTS_DEGREE_MOST + 1], sizes[ROOTS_DEGREE_MOST + 1];
    // Fills in `exact`, once. NULL: nothing better is known, and roots_and_turns alone may be asked.
    void (*refine)(Polynomial *polynomial, const void *owner);
    // The polynomial at a place, as good as `exact` makes it, without making that; NULL: there is no such way.
    DoubleWord (*value)(const void *owner, DoubleWord x);
    const void *owner;
    bool has_levels; // derivatives are in terms[]
    bool is_exact;   // terms[] are the nearest to `exact` then
    DoubleWord exact[ROOTS_DEGREE_MOST + 1];
};

// Makes a polynomial ready whose degree, terms, errors, sizes, refine, value and owner are set. Leading terms of 0 are
// left out.
void roots_start(Polynomial *polynomial);

// The sign of the polynomial at x: -1, 0, 1.
int roots_sign(Polynomial *polynomial, double x);

// Where the sign changes between two places, which may be infinite: in order, into `roots`, which has room for as many
// as the degree. Returns how many; *sign is what it is before the first.
unsigned roots_find(Polynomial *polynomial, double low, double high, double *roots, int *sign);

// The same from -high to high, or with `is_half` from 0 on; sooner where the degree is 4 or less.
unsigned roots_find_about(Polynomial *polynomial, double high, bool is_half, double *roots, int *sign);

// The same by double words throughout, which costs some ten times as much.
unsigned roots_find_exact(Polynomial *polynomial, double low, double high, double *roots, int *sign);

// Between two places, in no order: the roots and those of the derivative, from coefficients as they are. Where doubles
// do not tell the sign there is a place, too. `places` has room for twice the degree.
unsigned roots_and_turns(Polynomial *polynomial, double low, double high, double *places);

// Puts a root right by double words. False: the polynomial is too flat there, and only roots_find_exact knows better.
bool roots_refine(Polynomial *polynomial, double *root);

#endif
