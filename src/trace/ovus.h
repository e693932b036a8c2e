// Rays and eggs (scene/ovus.h): what of a line is inside, and normals.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_OVUS_H
#define TRACE_OVUS_H

#include "trace/prepared_primitive.h"

// As PreparedClass has them.
unsigned ovus_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left, RayInterval *intervals);
Vec3 ovus_gradient(const PreparedPrimitive *primitive, Vec3 point, uint8_t side);
Vec3 ovus_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side);

#endif
