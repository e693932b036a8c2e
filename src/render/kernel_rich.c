// Kernels of scenes of many spheres with patterns, layers, glass, bumps, sky or fog.
//
// SPDX-License-Identifier: MIT
#include "render/kernel_instance.h"

#define KERNELS(X)                                                                                                     \
    X(few_pigments, "spheres+planes+shadows+mirrors+pigments", GEOMETRY_FEW_PLANES, SHADING_MIRRORS | RENDER_PIGMENTS) \
    X(many_pigments, "tree+planes+shadows+mirrors+pigments", GEOMETRY_MANY, SHADING_MIRRORS | RENDER_PIGMENTS)         \
    X(many_pigment_lights, "tree+planes+shadows+mirrors+pigments+lights", GEOMETRY_MANY,                               \
      SHADING_MIRRORS | RENDER_PIGMENTS | RENDER_LIGHTS)                                                               \
    X(many_textures, "tree+planes+textures", GEOMETRY_MANY, SHADING_TEXTURES)                             \
    X(many_glass, "tree+planes+textures+glass", GEOMETRY_MANY, SHADING_TEXTURES | RENDER_INTERIORS)       \
    X(many_bumps, "tree+planes+textures+glass+bumps", GEOMETRY_MANY,                                                   \
      SHADING_TEXTURES | RENDER_INTERIORS | RENDER_NORMALS)                                               \
    X(many_sky, "tree+planes+textures+sky", GEOMETRY_MANY, SHADING_TEXTURES | RENDER_SKY)                 \
    X(many_fog, "tree+planes+textures+glass+fog", GEOMETRY_MANY,                                                       \
      SHADING_TEXTURES | RENDER_INTERIORS | RENDER_FOG)

DEFINE_KERNELS(kernels_rich, KERNELS)
