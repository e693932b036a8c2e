// The shading of surfaces that are more than one material: patterns, layers and maps of textures, bumps.
//
// Walks what is seen at the point and adds up the light of each, by its share, and what continues from there. Two
// functions with all features, one of them without bumps: next to the walk, a test for another feature that is not
// there costs little.
//
// SPDX-License-Identifier: MIT
#include "math/extreme.h"
#include "render/shade/shade.h"
#include "render/shade/surface_uv.h"

enum { ALL_FEATURES = RENDER_ALL_FEATURES | TRACE_ALL_FEATURES, FLAT_FEATURES = ALL_FEATURES & ~RENDER_NORMALS };

// The point for all layers together: what reaches it of a light is computed once.
static ShadingPoint for_layers(const ShadingPoint *at, ShadeArrived *arrived)
{
    ShadingPoint shared = *at;
    arrived->known = 0;
    shared.arrived = arrived;
    return shared;
}

typedef struct LayerSum {
    const Prepared *p;
    const ShadingPoint *at;
    double weight; // of the ray
    ScatterRecord *scatter;
    RenderStatistics *statistics;
    Rgb light;
    Rgb through;      // what the layers of the present texture of a map let through
    ShadeMirror *own; // what these layers mirror, for each way on
    uint32_t layer;   // how many textures have been asked for
} LayerSum;

// Of layers the top one's; a map of textures has none of its own, nor have those in it. Measured.
static double refraction_of(const Prepared *p, const Compound *compound)
{
    const Texture *top = &p->scene->textures.items[compound->texture];
    return top->pattern.type == PATTERN_NONE ? p->finishes[top->finish].refraction : 1.0;
}

// A mirror is seen undimmed through the layers above, unless the ray would be worth too little; measured.
RT_ALWAYS_INLINE void add_mirror(unsigned features, const LayerSum *sum, const TextureLayer *layer,
                                 const ShadeMaterial *material, Rgb reflectance, ShadeMirror *own)
{
    double weight = rgb_luminance(layer->above) * shade_mirror_weight(features, material->finish, reflectance);
    if (sum->weight * weight < sum->p->adc_bailout) {
        return;
    }
    own->reflectance = rgb_add_scaled(own->reflectance, layer->part, reflectance);
    own->weight = greater_of(own->weight, weight);
}

static bool lets_through(const LayerSum *sum)
{
    return !rgb_is_black(sum->through) && !(fabs(rgb_luminance(sum->through)) < sum->p->adc_bailout);
}

// The layers of a texture have been seen: what they mirror is, too, and stays where what goes through is totally
// reflected.
static void end_mirrors(const LayerSum *sum, ScatterRecord *ways, int count, bool is_seen, bool stays)
{
    for (int i = 0; i < count; i++) {
        ShadeMirror *own = &sum->own[i], *kept = &ways[i].kept;
        if (own->weight != 0.0 && is_seen) {
            ways[i].reflectance = rgb_add(ways[i].reflectance, own->reflectance);
            ways[i].reflection_weight = greater_of(ways[i].reflection_weight, own->weight);
        }
        if (own->weight != 0.0 && stays) {
            kept->reflectance = rgb_add(kept->reflectance, own->reflectance);
            kept->weight = greater_of(kept->weight, own->weight);
        }
        *own = (ShadeMirror){.weight = 0.0};
    }
}

RT_ALWAYS_INLINE void add_light(unsigned features, LayerSum *sum, const TextureLayer *layer, const ShadingPoint *at,
                                const ShadeMaterial *material)
{
    Rgb light = shade_local(sum->p, features, material, at, sum->statistics);
    sum->light = rgb_add(sum->light, rgb_mul(rgb_scale(layer->part, layer->above), light));
}

static Rgb add_layer(void *client, const TextureLayer *layer)
{
    LayerSum *sum = client;
    ShadeMaterial material = shade_material(sum->p, FLAT_FEATURES, layer->pigment, layer->finish);
    material.layer = sum->layer++;
    Rgb reflectance, left = shade_left_below(sum->p, FLAT_FEATURES, &material, sum->at);
    if (layer->is_top) {
        end_mirrors(sum, sum->scatter, 1, true, !lets_through(sum));
    }
    if (shade_mirror(sum->p, FLAT_FEATURES, &material, sum->at, &reflectance)) {
        add_mirror(FLAT_FEATURES, sum, layer, &material, reflectance, sum->own);
    }
    sum->through = rgb_mul(rgb_mul(layer->above, left), texture_pigment_through(layer->pigment));
    add_light(FLAT_FEATURES, sum, layer, sum->at, &material);
    return left;
}

Rgb shade_compound(const Prepared *p, const ShadingPoint *at, double weight, ScatterRecord *scatter,
                   RenderStatistics *statistics)
{
    const Compound *compound = &p->compounds[at->material & ~MATERIAL_COMPOUND];
    ShadeArrived arrived;
    ShadingPoint shared = for_layers(at, &arrived);
    ShadeMirror own = {.weight = 0.0};
    LayerSum sum = {p, &shared, weight, scatter, statistics, .own = &own};
    *scatter = (ScatterRecord){.reflection_exponent = 1.0, .refraction = refraction_of(p, compound)};
    Vec3 room;
    TextureSight sight = shade_sight(p, compound->texture, at, &room);
    TextureThrough through = texture_walk(&p->textures, compound->texture, sight, p->adc_bailout, add_layer, &sum);
    end_mirrors(&sum, scatter, 1, true, !lets_through(&sum));
    scatter->through = through.light;
    scatter->through_weight = through.weight;
    scatter->part = through.part;
    return sum.light;
}

// ---- bumps

// The layers of one texture of a map, from its top to the last one so far.
typedef struct Stack {
    Vec3 normal; // of the top
    double part;
} Stack;

typedef struct BumpSum {
    LayerSum sum; // `scatter` is not used
    ShadeWays *ways;
    double refraction;
    Stack stack;
    bool has_stack;
} BumpSum;

// The way on for a normal and what its mirror raises light to; there is room for as many as the evaluator lets a texture
// have.
static int way_for(BumpSum *bumps, Vec3 normal, double exponent)
{
    ShadeWays *ways = bumps->ways;
    int i = 0;
    while (i < ways->count && (ways->normals[i].x != normal.x || ways->normals[i].y != normal.y ||
                               ways->normals[i].z != normal.z || ways->scatter[i].reflection_exponent != exponent)) {
        i++;
    }
    if (i == ways->count && ways->count < SHADE_WAYS_MAX) {
        ways->normals[i] = normal;
        ways->scatter[i] = (ScatterRecord){.reflection_exponent = exponent, .refraction = bumps->refraction};
        bumps->sum.own[i] = (ShadeMirror){.weight = 0.0};
        ways->count++;
    }
    return i < SHADE_WAYS_MAX ? i : SHADE_WAYS_MAX - 1;
}

// What a texture lets through is bent by the bumps of its top layer; where it is totally reflected there, no layer of
// this texture mirrors, whatever its own bumps and exponent. Without bending all goes one way.
static void end_stack(BumpSum *bumps)
{
    const Stack *stack = &bumps->stack;
    const LayerSum *sum = &bumps->sum;
    bool has_bend = sum->at->ior_ratio != 1.0, goes_through = bumps->has_stack && lets_through(sum);
    Vec3 bent;
    bool is_total = goes_through && has_bend && !shade_bent(ALL_FEATURES, sum->at, stack->normal, &bent);
    end_mirrors(sum, bumps->ways->scatter, bumps->ways->count, !is_total, !is_total);
    if (!goes_through) {
        return;
    }
    ScatterRecord *way = &bumps->ways->scatter[way_for(bumps, has_bend ? stack->normal : sum->at->normal, 1.0)];
    way->through = rgb_add_scaled(way->through, stack->part, sum->through);
    way->through_weight = greater_of(way->through_weight, rgb_max_abs(sum->through));
    way->part += stack->part;
}

static void begin_stack(BumpSum *bumps, const TextureLayer *layer, Vec3 normal)
{
    end_stack(bumps);
    bumps->has_stack = true;
    bumps->stack = (Stack){.normal = normal, .part = layer->part};
}

static Rgb add_bumpy_layer(void *client, const TextureLayer *layer)
{
    BumpSum *bumps = client;
    LayerSum *sum = &bumps->sum;
    ShadingPoint at = *sum->at;
    if (layer->normal != RECORD_NONE) {
        at.normal = texture_normal(layer, at.normal);
    }
    if (layer->is_top) {
        begin_stack(bumps, layer, at.normal);
    }
    ShadeMaterial material = shade_material(sum->p, ALL_FEATURES, layer->pigment, layer->finish);
    material.layer = sum->layer++;
    Rgb reflectance, left = shade_left_below(sum->p, ALL_FEATURES, &material, &at);
    if (shade_mirror(sum->p, ALL_FEATURES, &material, &at, &reflectance)) {
        int way = way_for(bumps, at.normal, material.finish->reflection_exponent);
        add_mirror(ALL_FEATURES, sum, layer, &material, reflectance, &sum->own[way]);
    }
    sum->through = rgb_mul(rgb_mul(layer->above, left), texture_pigment_through(layer->pigment));
    add_light(ALL_FEATURES, sum, layer, &at, &material);
    return left;
}

Rgb shade_bumpy(const Prepared *p, const ShadingPoint *at, double weight, ShadeWays *ways, RenderStatistics *statistics)
{
    const Compound *compound = &p->compounds[at->material & ~MATERIAL_COMPOUND];
    ShadeArrived arrived;
    ShadingPoint shared = for_layers(at, &arrived);
    ShadeMirror own[SHADE_WAYS_MAX]; // set with the ways
    BumpSum bumps = {
        .sum = {p, &shared, weight, NULL, statistics, .own = own},
        .ways = ways,
        .refraction = refraction_of(p, compound),
    };
    ways->count = 0;
    Vec3 room;
    TextureSight sight = shade_sight(p, compound->texture, at, &room);
    texture_walk(&p->textures, compound->texture, sight, p->adc_bailout, add_bumpy_layer, &bumps);
    end_stack(&bumps);
    if (ways->count == 0) {
        way_for(&bumps, at->normal, 1.0);
    }
    return bumps.sum.light;
}

// ---- sides

MaterialIndex shade_side(const Prepared *p, MaterialIndex material, Vec3 normal, Vec3 direction)
{
    MaterialIndex inner =
        material & MATERIAL_COMPOUND ? p->compounds[material & ~MATERIAL_COMPOUND].inner : RECORD_NONE;
    return inner != RECORD_NONE && vec3_dot(normal, direction) > 0.0 ? inner : material;
}

// The same of a compound; NULL where it looks plain.
static const Compound *compound_side(const Prepared *p, const Surface *surface, Vec3 direction)
{
    MaterialIndex side = shade_side(p, surface->material, surface->normal, direction);
    return side & MATERIAL_COMPOUND ? &p->compounds[side & ~MATERIAL_COMPOUND] : NULL;
}

// ---- caustics

typedef struct CausticSum {
    Vec3 normal, direction;
    double exponent;
} CausticSum;

// Light is gathered by each layer as its own bumps have it.
static Rgb gather_layer(void *client, const TextureLayer *layer)
{
    const CausticSum *sum = client;
    Vec3 normal = layer->normal != RECORD_NONE ? texture_normal(layer, sum->normal) : sum->normal;
    return rgb_grey(1.0 + pow(fabs(vec3_dot(normal, sum->direction)), sum->exponent));
}

// The factor 45 is POV-Ray's, found by fitting pictures to 1/65535.
Rgb shade_caustics(const Prepared *p, const Surface *surface, ShapeId shape, Vec3 direction)
{
    Vec3 room;
    const Compound *compound = compound_side(p, surface, direction); // of its interior, so it is there
    const Vec3 *uv = shade_uv(p, compound->texture, shape, surface->point, direction, &room);
    Vec3 normal = vec3_dot(surface->normal, direction) > 0.0 ? vec3_neg(surface->normal) : surface->normal;
    CausticSum sum = {normal, direction, 45.0 * p->interiors[compound->interior].caustics};
    TextureSight sight = {surface->point, uv, &normal, &direction, true};
    return texture_walk(&p->textures, compound->texture, sight, 0.0, gather_layer, &sum).light;
}

Rgb shade_layers_through(const Prepared *p, const Surface *surface, ShapeId shape, Vec3 direction)
{
    Vec3 room;
    const Compound *compound = compound_side(p, surface, direction);
    if (!compound) {
        MaterialIndex side = shade_side(p, surface->material, surface->normal, direction);
        return texture_pigment_through(material_pigment(&p->materials[side]));
    }
    const Vec3 *uv = shade_uv(p, compound->texture, shape, surface->point, direction, &room);
    bool turns = p->textures.faces && vec3_dot(surface->normal, direction) > 0.0;
    Vec3 normal = turns ? vec3_neg(surface->normal) : surface->normal;
    TextureSight sight = {surface->point, uv, &normal, &direction, true};
    return texture_walk(&p->textures, compound->texture, sight, 0.0, NULL, NULL).light;
}
