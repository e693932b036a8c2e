// Formulas: patterns that are functions of a point, and the grey of a pigment.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SURFACE_FORMULA_H
#define RENDER_SURFACE_FORMULA_H

#include "render/surface/pattern.h"

// As PatternFunction.
double formula_value(const Pattern *pattern, const NoiseSource *source, Vec3 p);

// Lets formulas of shapes ask the patterns of these textures, as long as these live, and no more.
void formula_paint(FormulaHost *host, const NoiseSource *source);
void formula_unpaint(FormulaHost *host, const NoiseSource *source);

// What a picture tells, what a cube of values, and the number of a texture.
double formula_picture(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double formula_density(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double formula_material(const Pattern *pattern, const NoiseSource *source, Vec3 p);
double formula_pigment(const Pattern *pattern, const NoiseSource *source, Vec3 p);

#endif
