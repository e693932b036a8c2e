// Kernels of scenes of few spheres, with or without planes, by tiles.
//
// SPDX-License-Identifier: MIT
#include "render/kernel_instance.h"

#define KERNELS(X)                                                                                                     \
    X(few_opaque, "few spheres, opaque", GEOMETRY_FEW, SHADING_OPAQUE)                                                 \
    X(few_clear, "few spheres, clear", GEOMETRY_FEW, SHADING_CLEAR)

DEFINE_KERNELS(kernels_few, KERNELS)
