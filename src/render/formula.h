// Formulas: patterns that are functions of a point, and the grey of a pigment.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_FORMULA_H
#define RENDER_FORMULA_H

#include "render/pattern.h"

// As PatternFunction.
double formula_value(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double formula_pigment(const Pattern *pattern, const NoiseSource *source, Vec3 p);

#endif
