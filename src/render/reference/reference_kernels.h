// The kernels of the reference path, one for each real type; private to render/reference/reference.c and what it is
// made of.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_REFERENCE_REFERENCE_KERNELS_H
#define RENDER_REFERENCE_REFERENCE_KERNELS_H

#include "render/records/kernel.h"
#include "render/records/options.h"

typedef Rgb (*StudyKernel)(const Prepared *p, double u, double v, RenderScratch *scratch, RenderStatistics *statistics);

Rgb study_colour_float(const Prepared *p, double u, double v, RenderScratch *scratch, RenderStatistics *statistics);
Rgb study_colour_double(const Prepared *p, double u, double v, RenderScratch *scratch, RenderStatistics *statistics);
Rgb study_colour_quad(const Prepared *p, double u, double v, RenderScratch *scratch, RenderStatistics *statistics);

#endif
