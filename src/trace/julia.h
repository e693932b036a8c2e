// Rays and Julia fractals (scene/julia.h): what of a line is inside, by steps along it.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_JULIA_H
#define TRACE_JULIA_H

#include "scene/julia.h"
#include "trace/prepared_primitive.h"

// As PreparedClass has them. Of a fractal that stands alone nothing is known behind the first crossing.
unsigned julia_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left, RayInterval *intervals);
Vec3 julia_normal(const PreparedPrimitive *primitive, Vec3 point, uint8_t side);

#endif
