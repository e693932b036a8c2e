// A ray against a sphere in arithmetic that decides every case here exactly: what other formulas are measured against.
//
// MPFR at 1100 bits where it was found when this was built, else pairs of __float128, 226 bits. Knows no formula but
// its own. Not for more than one thread at a time.
//
// SPDX-License-Identifier: MIT
#ifndef STUDY_ORACLE_H
#define STUDY_ORACLE_H

#include <stdbool.h>

#include "base/attributes.h"
#include "study/cases.h"

typedef enum SphereClass { CLASS_MISS, CLASS_NEAR, CLASS_FAR } SphereClass;

typedef struct Oracle Oracle;

// "MPFR at 1100 bits"
const char *oracle_name(void);

// NULL when out of memory.
Oracle *oracle_new(void) RT_MUST_CHECK;
void oracle_free(Oracle *oracle);

// Solves a case; the class, and in *excusable whether the numbers that decide it are within what rounding does to them
// in doubles (docs/numerics.md).
SphereClass oracle_solve(Oracle *oracle, const SphereCase *input, bool *excusable);

// How far t is from the root of the case solved last, in units of its last place.
double oracle_ulps(Oracle *oracle, double t);

// | |P|² - r² | / ( 2 ( r² + Σ|P_i|(|f_i| + |t d_i|) ) ) in units of 2^-53, for the same case.
double oracle_backward(Oracle *oracle, const SphereCase *input, double t);

#endif
