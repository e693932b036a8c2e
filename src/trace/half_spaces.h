// The box around what many half spaces have in common.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_HALF_SPACES_H
#define TRACE_HALF_SPACES_H

#include <stdbool.h>
#include <stdint.h>

#include "base/attributes.h"
#include "trace/bounds.h"

// All points p with p·normal <= distance.
typedef struct HalfSpace {
    Vec3 normal; // of length 1, but for rounding
    double distance;
} HalfSpace;

// A box that holds them, larger by 2^-30 of its coordinates than it need be. False where there is none, where numbers
// do not tell, or where nothing is in common.
bool half_spaces_bounds(const HalfSpace *spaces, uint32_t count, Bounds *bounds) RT_MUST_CHECK;

#endif
