// Kernels of scenes of many spheres, whose surfaces are of one colour each.
//
// SPDX-License-Identifier: MIT
#include "render/kernel_instance.h"

#define KERNELS(X)                                                                                                     \
    X(many_plain, "tree+planes", GEOMETRY_MANY, SHADING_PLAIN)                                                         \
    X(many_shadows, "tree+planes+shadows", GEOMETRY_MANY, SHADING_SHADOWS)                                             \
    X(many_mirrors, "tree+planes+shadows+mirrors", GEOMETRY_MANY, SHADING_MIRRORS)                                     \
    X(many_any, "tree+planes+shadows+mirrors+transparency", GEOMETRY_MANY, SHADING_ANY)                                \
    X(many_lights, "tree+planes+lights", GEOMETRY_MANY, SHADING_ANY | RENDER_LIGHTS)

DEFINE_KERNELS(kernels_many, KERNELS)
