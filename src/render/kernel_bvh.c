// Kernels of scenes of many spheres, with or without planes, by tiles.
//
// SPDX-License-Identifier: MIT
#include "render/kernel_instance.h"

#define KERNELS(X)                                                                                                     \
    X(bvh_opaque, "tree of spheres, opaque", GEOMETRY_BVH, SHADING_OPAQUE)                                             \
    X(bvh_clear, "tree of spheres, clear", GEOMETRY_BVH, SHADING_CLEAR)

DEFINE_KERNELS(kernels_many, KERNELS)
