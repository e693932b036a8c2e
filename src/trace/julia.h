// Rays and Julia fractals (scene/julia.h): what of a line is inside, by steps along it.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_JULIA_H
#define TRACE_JULIA_H

#include "scene/julia.h"
#include "trace/solid.h"

// As SolidClass has them. Of a fractal that stands alone nothing is known behind the first crossing.
unsigned julia_intervals(const Solid *solid, const Ray *object, SideLeft left, RayInterval *intervals);
Vec3 julia_normal(const Solid *solid, Vec3 point, uint8_t side);

#endif
