// Kernels of scenes of few spheres, with or without planes, by tiles.
//
// SPDX-License-Identifier: MIT
#include "render/kernel_instance.h"

#define KERNELS(X)                                                                                                     \
    X(small_opaque, "few spheres, opaque", GEOMETRY_SMALL, SHADING_OPAQUE)                                             \
    X(small_clear, "few spheres, clear", GEOMETRY_SMALL, SHADING_CLEAR)

DEFINE_KERNELS(kernels_few, KERNELS)
