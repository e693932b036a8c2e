// What the rows of the table of primitives share; private to scene/primitive*.c.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_PRIMITIVE_ROWS_H
#define SCENE_PRIMITIVE_ROWS_H

#include "scene/primitive.h"

// Of what reaches as far as its bounds.
double primitive_box_support(const Primitive *primitive, Vec3 n);
void primitive_box_measure(const Primitive *primitive, Vec3 *half, Vec3 *middle);

// primitive_listed.c
extern const PrimitiveClass primitive_class_polynomial;
extern const PrimitiveClass primitive_class_blob;
extern const PrimitiveClass primitive_class_prism;
extern const PrimitiveClass primitive_class_polygon;
extern const PrimitiveClass primitive_class_lathe;
extern const PrimitiveClass primitive_class_sor;
extern const PrimitiveClass primitive_class_superellipsoid;
extern const PrimitiveClass primitive_class_sweep;
extern const PrimitiveClass primitive_class_julia;
extern const PrimitiveClass primitive_class_isosurface;
extern const PrimitiveClass primitive_class_parametric;
extern const PrimitiveClass primitive_class_mesh;
extern const PrimitiveClass primitive_class_mesh_solid;

#endif
