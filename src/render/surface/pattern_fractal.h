// Patterns of points that stay near 0, or leave, under steps in the complex plane: mandel and julia, of any power, and
// the magnets.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SURFACE_PATTERN_FRACTAL_H
#define RENDER_SURFACE_PATTERN_FRACTAL_H

#include "render/surface/pattern.h"

// As PatternFunction.
double pattern_fractal(const Pattern *pattern, const NoiseSource *source, Vec3 p);

// Whether it is the share of the steps z -> z^2 + c that a point takes to leave, or 1.
bool pattern_is_plain_fractal(const Pattern *pattern);

#endif
