// Kernels of scenes of many spheres, whose surfaces are of one colour each.
//
// SPDX-License-Identifier: MIT
#include "render/kernel_instance.h"

// Looking for planes where there are none is 2 to 5 in 100 of the instructions.
#define GEOMETRY_TREE TRACE_SPHERE_BVH

#define KERNELS(X)                                                                                                     \
    X(tree_plain, "tree", GEOMETRY_TREE, SHADING_PLAIN)                                                                \
    X(tree_dull, "tree+shadows, no highlights", GEOMETRY_TREE, RENDER_SHADOWS)                                         \
    X(tree_shadows, "tree+shadows", GEOMETRY_TREE, SHADING_SHADOWS)                                                    \
    X(tree_mirrors, "tree+shadows+mirrors", GEOMETRY_TREE, SHADING_MIRRORS)                                            \
    X(tree_clear, "tree+shadows+transparency", GEOMETRY_TREE, SHADING_SHADOWS | RENDER_TRANSPARENCY)                   \
    X(tree_any, "tree+shadows+mirrors+transparency", GEOMETRY_TREE, SHADING_ANY)                                       \
    X(many_plain, "tree+planes", GEOMETRY_MANY, SHADING_PLAIN)                                                         \
    X(many_shadows, "tree+planes+shadows", GEOMETRY_MANY, SHADING_SHADOWS)                                             \
    X(many_mirrors, "tree+planes+shadows+mirrors", GEOMETRY_MANY, SHADING_MIRRORS)                                     \
    X(many_any, "tree+planes+shadows+mirrors+transparency", GEOMETRY_MANY, SHADING_ANY)                                \
    X(many_mirror_lights, "tree+planes+shadows+mirrors+lights", GEOMETRY_MANY, SHADING_MIRRORS | RENDER_LIGHTS)        \
    X(many_lights, "tree+planes+lights", GEOMETRY_MANY, SHADING_ANY | RENDER_LIGHTS)

DEFINE_KERNELS(kernels_many, KERNELS)
