// Colours of a thin layer, `irid`.
//
// The formula was found by fitting POV-Ray's pictures to 1/65535; docs/language.md, "Lighting model".
//
// SPDX-License-Identifier: MIT
#include "render/shade/shade_light.h"

#include <math.h>

Rgb shade_thin_layer(const Prepared *p, const PreparedFinish *finish, const ShadingPoint *at, double cosine)
{
    double thickness = finish->irid_thickness;
    if (finish->irid_turbulence != 0.0) {
        Octaves octaves = {2.0, 0.5, 5};
        const NoiseSource *source = &p->textures.source;
        double sum = noise_sum(source->noise, source->generator, &octaves, vec3_scale(p->textures.scale, at->point));
        thickness *= 1.0 + finish->irid_turbulence * (2.0 * sum - 1.0);
    }
    double ahead = thickness * (cosine + fabs(vec3_dot(at->normal, at->direction)));
    Rgb waves = finish->irid_waves;
    return rgb(1.0 + finish->irid * cos(waves.red * ahead), 1.0 + finish->irid * cos(waves.green * ahead),
               1.0 + finish->irid * cos(waves.blue * ahead));
}
