// The reference path in single precision.
//
// SPDX-License-Identifier: MIT
#include <math.h>

typedef float Real;
#define REAL_SQRT sqrtf
#define REAL_FABS fabsf
#define REAL_POW  powf
#define REAL_ACOS acosf
#define REAL_EXP  expf

#include "render/reference/reference_kernel.h"

Rgb study_colour_float(const Prepared *p, double u, double v, RenderScratch *scratch, RenderStatistics *statistics)
{
    return real_colour(p, u, v, scratch, statistics);
}
