// Kernels of scenes of spheres and planes that are shaded ray by ray: layers, sky, fog, glass.
//
// SPDX-License-Identifier: MIT
#include "render/kernel_instance.h"

#define SHADING_LAYERS (SHADING_CLEAR | RENDER_TEXTURES | RENDER_SKY | RENDER_EXPONENT)
#define KERNELS(X)                                                                                                     \
    X(rays, "spheres, ray by ray", GEOMETRY_SPHERES, SHADING_LAYERS)                                                   \
    X(rays_interiors, "spheres, ray by ray, interiors", GEOMETRY_SPHERES, SHADING_LAYERS | RENDER_INTERIORS | RENDER_FOG)

DEFINE_KERNELS(kernels_rays, KERNELS)
