// The shading of surfaces that are more than one material: patterns, layers and maps of textures.
//
// Walks what is seen at the point and adds up the light of each, by its share, and what goes on from there. One function
// with all features: next to the walk, a test for a feature that is not there costs little.
//
// SPDX-License-Identifier: MIT
#include "render/shade.h"

typedef struct LayerSum {
    const Prepared *p;
    const ShadePoint *at;
    ShadeOnward *onward;
    RenderStatistics *statistics;
    Rgb light;
} LayerSum;

static void add_layer(void *client, const TextureLayer *layer)
{
    LayerSum *sum = client;
    unsigned features = RENDER_ALL_FEATURES | (unsigned)TRACE_ALL_FEATURES;
    ShadeOnward *onward = sum->onward;
    ShadeMaterial material = shade_material(sum->p, features, layer->pigment, layer->finish);
    Rgb reflectance;
    if (shade_mirror(features, &material, sum->at, &reflectance)) {
        onward->reflectance = rgb_add(onward->reflectance, rgb_mul(layer->share, reflectance));
        onward->reflection_weight += rgb_max(layer->share) * material.finish->reflection_weight;
        onward->reflection_exponent = material.finish->reflection_exponent;
    }
    onward->conserves_energy |= material.finish->conserves_energy;
    Rgb light = shade_local(sum->p, features, &material, sum->at, sum->statistics);
    sum->light = rgb_add(sum->light, rgb_mul(layer->share, light));
}

Rgb shade_compound(const Prepared *p, const ShadePoint *at, ShadeOnward *onward, RenderStatistics *statistics)
{
    const Compound *compound = &p->compounds[at->material & ~MATERIAL_COMPOUND];
    LayerSum sum = {.p = p, .at = at, .onward = onward, .statistics = statistics, .light = rgb_grey(0.0)};
    onward->through = texture_walk(&p->textures, compound->texture, at->point, add_layer, &sum);
    return sum.light;
}
