// Kernels of scenes with any shape.
//
// SPDX-License-Identifier: MIT
#include "render/kernel_instance.h"

#define SHADING_FLAT                                                                                                   \
    (SHADING_ANY | RENDER_EXPONENT | RENDER_PIGMENTS | RENDER_TEXTURES | RENDER_INTERIORS | RENDER_LIGHTS | RENDER_SKY | RENDER_FOG)
#define KERNELS(X)                                                                                                     \
    X(any_shadows, "all shapes+shadows", GEOMETRY_ANY, SHADING_SHADOWS)                                                \
    X(any_flat, "everything but bumps", GEOMETRY_ANY, SHADING_FLAT)                                                    \
    X(any_any, "everything", GEOMETRY_ANY, SHADING_FLAT | RENDER_NORMALS)

DEFINE_KERNELS(kernels_any, KERNELS)
