// Forms: the numbers of a shape become a fixed shape under an affine map (PrimitiveKind), as the tracer wants it.
//
// Whoever makes parts makes them here, from text or from arrays, so that the same numbers are the same part, bit for
// bit. A form sets kind, flags, data and to_world of a part; part_finish adds the inverse. Nothing is reported.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_FORM_H
#define SCENE_FORM_H

#include "base/attributes.h"
#include "scene/scene.h"

// A part that is nothing yet, alone, written at an offset.
Primitive part_empty(uint64_t source);

// Why a shape has no extent, so that it is not drawn; NULL when it has one.
const char *primitive_make_ball(Primitive *primitive, Vec3 centre, double radius) RT_MUST_CHECK; // radius >= 0
const char *primitive_make_cylinder(Primitive *primitive, Vec3 base, Vec3 cap, double radius,
                                    bool is_open) RT_MUST_CHECK;
const char *primitive_make_cone(Primitive *primitive, Vec3 base, double base_radius, Vec3 cap, double cap_radius,
                                bool is_open) RT_MUST_CHECK; // radii >= 0, ends apart, as of a cylinder
const char *primitive_make_disc(Primitive *primitive, Vec3 centre, Vec3 normal, double radius,
                                double hole) RT_MUST_CHECK;
const char *primitive_make_triangle(Primitive *primitive, const Vec3 corners[3]) RT_MUST_CHECK;
const char *primitive_make_smooth_triangle(Primitive *primitive, const Vec3 corners[3],
                                           const Vec3 normals[3]) RT_MUST_CHECK;
void primitive_make_box(Primitive *primitive, Vec3 corner, Vec3 other);

// What is left of a primitive when its to_world is known. False: its map is flat or infinite.
bool part_finish(Primitive *primitive) RT_MUST_CHECK;

// A vector's length and the vector of length 1 along it (zero for zero), without overflow; one whose length is 1 to
// rounding stays as it is.
double vector_length(Vec3 vector);
Vec3 vector_unit(Vec3 vector);

#endif
