// Bumps that turn a normal by a vector of their own; private to normal.c.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SURFACE_NORMAL_SPECIAL_H
#define RENDER_SURFACE_NORMAL_SPECIAL_H

#include "render/surface/pattern.h"

// What the normal gains at a point of the pattern's space, which turbulence has moved, for an amount of 1. For patterns
// of is_special_normal.
Vec3 normal_special(const Pattern *pattern, const NoiseSource *source, Vec3 point);

#endif
