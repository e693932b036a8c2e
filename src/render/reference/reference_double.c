// The reference path in double precision.
//
// SPDX-License-Identifier: MIT
#include "render/reference/reference_kernel.h"

Rgb study_colour_double(const Prepared *p, double u, double v, RenderScratch *scratch, RenderStatistics *statistics)
{
    return real_colour(p, u, v, scratch, statistics);
}
