// Kernels of scenes of many spheres, with or without planes, by tiles.
//
// SPDX-License-Identifier: MIT
#include "render/kernel_instance.h"

#define KERNELS(X)                                                                                                     \
    X(many_opaque, "tree of spheres, opaque", GEOMETRY_MANY, SHADING_OPAQUE)                                           \
    X(many_clear, "tree of spheres, clear", GEOMETRY_MANY, SHADING_CLEAR)

DEFINE_KERNELS(kernels_many, KERNELS)
