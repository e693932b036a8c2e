// The reference path in quadruple precision, by the compiler's __float128.
//
// SPDX-License-Identifier: MIT
#include "math/quad.h"

typedef Quad Real;
#define REAL_SQRT quad_sqrt
#define REAL_FABS quad_abs
#define REAL_POW  quad_pow
#define REAL_ACOS quad_acos
#define REAL_EXP  quad_exp

#include "render/reference/reference_kernel.h"

Rgb study_colour_quad(const Prepared *p, double u, double v, RenderScratch *scratch, RenderStatistics *statistics)
{
    return real_colour(p, u, v, scratch, statistics);
}
