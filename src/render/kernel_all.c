// Kernels of scenes with any shape.
//
// SPDX-License-Identifier: MIT
#include "render/kernel_instance.h"

#define KERNELS(X)                                                                                                     \
    X(all_opaque, "all shapes, opaque", TRACE_ALL_FEATURES, SHADING_OPAQUE)                                            \
    X(all_flat, "all shapes, no bumps", TRACE_ALL_FEATURES, RENDER_ALL_FEATURES & ~RENDER_NORMALS)                     \
    X(any, "everything", TRACE_ALL_FEATURES, RENDER_ALL_FEATURES)

DEFINE_KERNELS(kernels_any, KERNELS)
