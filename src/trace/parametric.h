// Rays and parametric surfaces (scene/parametric.h): where one is met, and what is there.
//
// A ray meets at most one point of a surface, as in POV-Ray: the first, whatever clips it.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_PARAMETRIC_H
#define TRACE_PARAMETRIC_H

#include "scene/parametric.h"
#include "trace/prepared_primitive.h"

enum { PARAMETRIC_SIDE }; // its only one, a film

// As PreparedClass has them.
unsigned parametric_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                              RayInterval *intervals);
Vec3 parametric_met(const PreparedPrimitive *primitive, const Ray *object, double t);

// The surface coordinates of a point that a ray of this direction met, both in the scene as it is traced.
void parametric_uv(const PreparedPrimitive *primitive, Vec3 point, Vec3 direction, double uv[2]);

#endif
