// The kernels of the reference path, one for each real type; private to render/study.c and what it is made of.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_STUDY_KERNELS_H
#define RENDER_STUDY_KERNELS_H

#include "render/kernel.h"
#include "render/render.h"

typedef Rgb (*StudyKernel)(const Prepared *p, double u, double v, RenderScratch *scratch, RenderStatistics *statistics);

Rgb study_colour_float(const Prepared *p, double u, double v, RenderScratch *scratch, RenderStatistics *statistics);
Rgb study_colour_double(const Prepared *p, double u, double v, RenderScratch *scratch, RenderStatistics *statistics);
Rgb study_colour_quad(const Prepared *p, double u, double v, RenderScratch *scratch, RenderStatistics *statistics);

#endif
