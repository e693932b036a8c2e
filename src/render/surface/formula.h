// Formulas: patterns that are functions of a point, and the grey of a pigment.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SURFACE_FORMULA_H
#define RENDER_SURFACE_FORMULA_H

#include "render/surface/pattern.h"

// As PatternFunction.
double formula_value(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double formula_pigment(const Pattern *pattern, const NoiseSource *source, Vec3 p);

#endif
