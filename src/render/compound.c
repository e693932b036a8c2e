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
    double weight; // of the ray
    ShadeOnward *onward;
    RenderStatistics *statistics;
    double refraction; // the least of the layers
    Rgb light;
} LayerSum;

// A mirror is seen undimmed through the layers above, unless the ray would be worth too little; measured.
static void add_mirror(LayerSum *sum, const TextureLayer *layer, const ShadeMaterial *material)
{
    Rgb reflectance;
    if (!shade_mirror(RENDER_ALL_FEATURES, material, sum->at, &reflectance)) {
        return;
    }
    double weight = rgb_luminance(layer->above) * shade_mirror_weight(RENDER_ALL_FEATURES, material->finish, reflectance);
    if (sum->weight * weight < sum->p->adc_bailout) {
        return;
    }
    ShadeOnward *onward = sum->onward;
    onward->reflectance = rgb_add_scaled(onward->reflectance, layer->part, reflectance);
    onward->reflection_weight = fmax(onward->reflection_weight, weight);
    onward->reflection_exponent = material->finish->reflection_exponent;
}

static void add_layer(void *client, const TextureLayer *layer)
{
    LayerSum *sum = client;
    unsigned features = RENDER_ALL_FEATURES | (unsigned)TRACE_ALL_FEATURES;
    ShadeMaterial material = shade_material(sum->p, features, layer->pigment, layer->finish);
    add_mirror(sum, layer, &material);
    sum->onward->conserves_energy |= material.finish->conserves_energy;
    sum->refraction = fmin(sum->refraction, material.finish->refraction);
    Rgb light = shade_local(sum->p, features, &material, sum->at, sum->statistics);
    sum->light = rgb_add(sum->light, rgb_mul(rgb_scale(layer->part, layer->above), light));
}

Rgb shade_compound(const Prepared *p, const ShadePoint *at, double weight, ShadeOnward *onward,
                   RenderStatistics *statistics)
{
    const Compound *compound = &p->compounds[at->material & ~MATERIAL_COMPOUND];
    LayerSum sum = {p, at, weight, onward, statistics, HUGE_VAL, rgb_grey(0.0)};
    TextureThrough through = texture_walk(&p->textures, compound->texture, at->point, p->adc_bailout, add_layer, &sum);
    onward->through = rgb_scale(sum.refraction, through.light);
    onward->through_weight = sum.refraction * through.weight;
    return sum.light;
}
