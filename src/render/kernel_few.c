// Kernels of scenes of few spheres, with or without planes.
//
// SPDX-License-Identifier: MIT
#include "render/kernel_instance.h"

#define KERNELS(X)                                                                                                     \
    X(few_plain, "spheres", GEOMETRY_FEW, SHADING_PLAIN)                                                               \
    X(few_dull, "spheres+shadows, no highlights", GEOMETRY_FEW, RENDER_SHADOWS)                                        \
    X(few_shadows, "spheres+shadows", GEOMETRY_FEW, SHADING_SHADOWS)                                                   \
    X(few_planes_plain, "spheres+planes", GEOMETRY_FEW_PLANES, SHADING_PLAIN)                                          \
    X(few_planes_shadows, "spheres+planes+shadows", GEOMETRY_FEW_PLANES, SHADING_SHADOWS)                              \
    X(few_mirrors, "spheres+shadows+mirrors", GEOMETRY_FEW, SHADING_MIRRORS)                                           \
    X(few_mirrors_only, "spheres+shadows+mirrors, no brilliance", GEOMETRY_FEW, SHADING_SHADOWS | RENDER_REFLECTION)     \
    X(few_planes_mirrors, "spheres+planes+shadows+mirrors", GEOMETRY_FEW_PLANES, SHADING_MIRRORS)                      \
    X(few_planes_any, "spheres+planes+shadows+mirrors+transparency", GEOMETRY_FEW_PLANES, SHADING_ANY)

DEFINE_KERNELS(kernels_few, KERNELS)
