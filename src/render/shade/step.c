// What has all features, once for all who need it: a step of a ray's path, and the light of a surface.
//
// SPDX-License-Identifier: MIT
#include "render/shade/shade.h"

void shade_step_all(const Prepared *p, RayStack *stack, SampleStream *stream, RenderStatistics *statistics,
                    ShadeStep *step)
{
    shade_path_step(p, SHADE_ALL_FEATURES, stack, stream, statistics, step);
}

Rgb shade_local_all(const Prepared *p, const ShadeMaterial *material, const ShadingPoint *at,
                    RenderStatistics *statistics)
{
    return shade_local_of(p, SHADE_ALL_FEATURES, material, at, statistics);
}
