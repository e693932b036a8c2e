// A ray against what is flat: a disc of radius 1 with a hole, and the triangle of x, y >= 0, x + y <= 1, both in z = 0.
//
// A flat shape has no inside; a ray that starts on it never meets it again. Knows nothing of transforms.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_FLAT_H
#define TRACE_FLAT_H

#include "math/vec3.h"

#include "math/lane_double.h"
#include "trace/flat.inc"

#endif
