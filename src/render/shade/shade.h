// Light along one ray: what is hit, how it shines (render/shade/shade_light.h), and the rays that continue from there
// (render/shade/shade_scatter.h).
//
// Everything here is always-inline and takes the kernel's features as a constant.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_SHADE_H
#define RENDER_SHADE_SHADE_H

#include "render/shade/dome.h"
#include "render/shade/shade_scatter.h"
#include "render/shade/sky.h"

enum { SHADE_ALL_FEATURES = RENDER_ALL_FEATURES | TRACE_ALL_FEATURES };

// What a surface with bumps sends on, for each of the normals that its layers have.
typedef struct ShadeWays {
    int count;
    Vec3 normals[SHADE_WAYS_MAX];
    ScatterRecord scatter[SHADE_WAYS_MAX];
} ShadeWays;

// The same as shade_surface for patterns and layers; not inline, for it costs more than a call. In
// render/shade/compound.c. `weight` is the ray's.
Rgb shade_compound(const Prepared *p, const ShadingPoint *at, double weight, ScatterRecord *scatter,
                   RenderStatistics *statistics);
// The same where there may be bumps.
Rgb shade_bumpy(const Prepared *p, const ShadingPoint *at, double weight, ShadeWays *ways,
                RenderStatistics *statistics);

// What a material adds by itself: its glow and what the lights make of it.
RT_ALWAYS_INLINE Rgb shade_local_of(const Prepared *p, unsigned features, const ShadeMaterial *material,
                                    const ShadingPoint *at, RenderStatistics *statistics)
{
    Rgb light = rgb_mul(material->opaque, material->finish->glow);
    for (size_t i = 0; i < p->light_count; i++) {
        if (shade_reaches(p, features, at, &p->lights[i])) {
            light = rgb_add(light, shade_light(p, features, material, &p->lights[i], at, statistics));
        }
    }
    if (RT_UNLIKELY(p->has_dome) && shade_takes_light(material->finish, material->opaque)) {
        light = rgb_add(light, dome_light(p, material, at, statistics));
    }
    return light;
}

// The same with all features: compiled once, in render/shade/step.c.
Rgb shade_local_all(const Prepared *p, const ShadeMaterial *material, const ShadingPoint *at,
                    RenderStatistics *statistics);

// Without bumps it is the same: what they change, shade_metallic, they change for angles of more than a right one only.
RT_ALWAYS_INLINE Rgb shade_local(const Prepared *p, unsigned features, const ShadeMaterial *material,
                                 const ShadingPoint *at, RenderStatistics *statistics)
{
    return (features | RENDER_NORMALS) == SHADE_ALL_FEATURES
               ? shade_local_all(p, material, at, statistics)
               : shade_local_of(p, features, material, at, statistics);
}

// The mirror of a material, by colour; false when it has none.
RT_ALWAYS_INLINE bool shade_mirror(const Prepared *p, unsigned features, const ShadeMaterial *material,
                                   const ShadingPoint *at, Rgb *reflectance)
{
    if (!(features & RENDER_REFLECTION) || !material->finish->reflects) {
        return false;
    }
    double ratio = at->media ? at->fresnel_ratio : 1.0;
    double cosine = -vec3_dot(at->normal, at->direction);
    *reflectance = shade_reflectance(features, material, cosine, ratio);
    if ((features & RENDER_TEXTURES) && material->finish->irid > 0.0) {
        double along = vec3_dot(at->normal, shade_mirrored(features, at));
        *reflectance = rgb_mul(*reflectance, shade_thin_layer(p, material->finish, at, along));
    }
    return true;
}

// By how much the weight of a mirrored ray falls: by the greatest share of any angle, but with Fresnel by that of its
// own. Measured.
RT_ALWAYS_INLINE double shade_mirror_weight(unsigned features, const PreparedFinish *finish, Rgb reflectance)
{
    return (features & RENDER_INTERIORS) && finish->is_fresnel ? rgb_max(reflectance) : finish->reflection_weight;
}

// What a layer's mirror leaves of the light of the layers below.
RT_ALWAYS_INLINE Rgb shade_left_below(const Prepared *p, unsigned features, const ShadeMaterial *material,
                                      const ShadingPoint *at)
{
    Rgb reflectance;
    return material->finish->conserves_energy && shade_mirror(p, features, material, at, &reflectance)
               ? rgb_add_scaled(rgb_grey(1.0), -1.0, reflectance)
               : rgb_grey(1.0);
}

// What a surface's mirror sends on.
RT_ALWAYS_INLINE void shade_set_mirror(const Prepared *p, unsigned features, const ShadeMaterial *material,
                                       const ShadingPoint *at, ScatterRecord *scatter)
{
    if (shade_mirror(p, features, material, at, &scatter->reflectance)) {
        scatter->reflection_weight = shade_mirror_weight(features, material->finish, scatter->reflectance);
        scatter->reflection_exponent = material->finish->reflection_exponent;
    }
}

// The one layer that is seen at a point.
typedef struct ShadeLayer {
    Rgbft pigment;
    FinishIndex finish;
    bool is_clear; // light goes through, as through a texture
} ShadeLayer;

// Looks it up; false where there may be more, or light goes through what may have bumps: shade_compound and shade_bumpy
// walk that.
RT_ALWAYS_INLINE bool shade_one_layer(const Prepared *p, unsigned features, MaterialIndex material, Vec3 point,
                                      ShadeLayer *layer)
{
    if (!(features & (RENDER_TEXTURES | RENDER_PIGMENTS)) || !(material & MATERIAL_COMPOUND)) {
        const Material *plain = &p->materials[material];
        *layer = (ShadeLayer){material_pigment(plain), plain->finish, false};
        return true;
    }
    const Texture *texture = texture_single(&p->textures, p->compounds[material & ~MATERIAL_COMPOUND].texture);
    if ((features & RENDER_TEXTURES) && !texture) {
        return false;
    }
    Vec3 place = vec3_scale(p->textures.scale, point);
    *layer = (ShadeLayer){texture_pigment(&p->textures, &texture->pigment, place), texture->finish, false};
    layer->is_clear =
        (features & RENDER_TRANSPARENCY) && (layer->pigment.filter != 0.0 || layer->pigment.transmit != 0.0);
    return !((features & RENDER_NORMALS) && layer->is_clear);
}

// What a texture of one clear layer sends on, for a ray of some weight: as shade_compound has it of all its layers.
RT_ALWAYS_INLINE void shade_set_clear(const Prepared *p, unsigned features, const ShadeMaterial *material,
                                      const ShadeLayer *layer, const ShadingPoint *at, double weight,
                                      ScatterRecord *scatter)
{
    const PreparedFinish *finish = material->finish;
    Rgb reflectance;
    if (shade_mirror(p, features, material, at, &reflectance)) {
        double own = rgb_luminance(rgb_grey(1.0)) * shade_mirror_weight(features, finish, reflectance);
        if (!(weight * own < p->adc_bailout)) {
            scatter->reflectance = reflectance;
            scatter->reflection_weight = own;
            scatter->reflection_exponent = finish->reflection_exponent;
        }
    }
    Rgb through = rgb_mul(shade_left_below(p, features, material, at), texture_pigment_through(layer->pigment));
    if (!rgb_is_black(through) && !(fabs(rgb_luminance(through)) < p->adc_bailout)) {
        scatter->through = through;
        scatter->through_weight = rgb_max_abs(through);
    }
}

// The light of a surface of one layer, and what it sends on.
RT_ALWAYS_INLINE Rgb shade_plain(const Prepared *p, unsigned features, const ShadeLayer *layer, const ShadingPoint *at,
                                 double weight, ScatterRecord *scatter, RenderStatistics *statistics)
{
    ShadeMaterial material = shade_material(p, features, layer->pigment, layer->finish);
    *scatter = (ScatterRecord){
        .through = rgb_grey(0.0),
        .reflectance = rgb_grey(0.0),
        .reflection_exponent = 1.0,
        .part = 1.0,
        .refraction = material.finish->refraction,
    };
    if ((features & RENDER_TEXTURES) && layer->is_clear) {
        shade_set_clear(p, features, &material, layer, at, weight, scatter);
    } else {
        shade_set_mirror(p, features, &material, at, scatter);
        if (features & RENDER_TRANSPARENCY) {
            scatter->through = texture_pigment_through(layer->pigment);
            scatter->conserves_energy = material.finish->conserves_energy;
        }
    }
    return shade_local(p, features, &material, at, statistics);
}

// The light at a hit, and what the surface sends on.
RT_ALWAYS_INLINE Rgb shade_surface(const Prepared *p, unsigned features, const ShadingPoint *at, double weight,
                                   ScatterRecord *scatter, RenderStatistics *statistics)
{
    ShadeLayer layer;
    return shade_one_layer(p, features, at->material, at->point, &layer)
               ? shade_plain(p, features, &layer, at, weight, scatter, statistics)
               : shade_compound(p, at, weight, scatter, statistics);
}

// Finds what a ray hits; false when it meets nothing.
RT_ALWAYS_INLINE bool shade_find(const Prepared *p, unsigned features, const StackedRay *now, SampleStream *stream,
                                 ShadingPoint *at)
{
    Hit hit = {.shape = SHAPE_NONE};
    if (now->known) {
        hit = *now->known;
    } else if (!geometry_closest(p->geometry, features, now->ray, now->start, (double)INFINITY, &hit)) {
        return false;
    }
    if (hit.shape == SHAPE_NONE) {
        return false;
    }
    Surface surface = shade_surface_met(p, features, now->ray, hit);
    Vec3 normal = hit.inside ? vec3_neg(surface.normal) : surface.normal;
    bool has_interiors = features & RENDER_INTERIORS;
    *at = (ShadingPoint){.point = surface.point,
                         .normal = normal,
                         .outward = surface.normal,
                         .direction = now->ray.direction,
                         .shape = hit.shape,
                         .material = surface.material,
                         .order = surface.order,
                         .body = surface.body,
                         .interior = has_interiors ? shade_interior(p, surface.material) : RECORD_NONE,
                         .ior_ratio = 1.0,
                         .lit = shade_lit(p, features, surface.material),
                         .way = has_interiors ? hit.t * p->textures.scale : 0.0,
                         .inside = hit.inside,
                         .stream = features & RENDER_LIGHTS ? stream : NULL};
    return true;
}

// Adds a ray's light to the sum that is open.
RT_ALWAYS_INLINE void ray_stack_add(RayStack *stack, const StackedRay *ray, Rgb light)
{
    Rgb *sum = &stack->sums[stack->open];
    *sum = rgb_add(*sum, rgb_mul(ray->share, light));
}

// What a ray sees that meets nothing.
RT_ALWAYS_INLINE Rgb shade_miss(const Prepared *p, unsigned features, Vec3 direction)
{
    return features & RENDER_SKY ? sky_light(p, direction) : p->background;
}

// Fog on the way of a ray: what it adds, which is returned, is added, and what lies behind it will be dimmed.
RT_ALWAYS_INLINE Rgb shade_fog(const Prepared *p, double way, StackedRay *ray, RayStack *stack)
{
    if (stack->media.nodes[ray->inside].is_in_solid) {
        return rgb_grey(0.0);
    }
    FogShare fog = fog_between(p, &ray->ray, way);
    Rgb adds = rgb_mul(ray->share, fog.own);
    ray_stack_add(stack, ray, fog.own);
    ray->share = rgb_mul(ray->share, fog.through);
    return adds;
}

// What one turn of a path found: the ray that was taken, what it hit, and what the hit sends on.
typedef struct ShadeStep {
    StackedRay ray;
    ShadingPoint at;       // is_hit
    ScatterRecord scatter; // is_hit
    MediumStack behind;  // is_hit, where there are interiors: what a ray is inside of behind the surface
    Rgb light;           // what the ray's share is multiplied with
    Rgb fog;             // what fog adds on the ray's way, where there may be some; ray.share is already less by it
    bool is_hit;
} ShadeStep;

// No ray waits but the first, and no light has come.
RT_ALWAYS_INLINE void shade_path_begin(const Prepared *p, unsigned features, StackedRay *first, RayStack *stack)
{
    stack->count = stack->open = 0;
    stack->sums[0] = rgb_grey(0.0);
    if (features & RENDER_INTERIORS) {
        first->inside = prepared_start(p, first->ray.origin, &stack->media);
    }
    ray_stack_push(features, stack, first);
}

// A hit where there may be bumps: one way on for each of the surface's normals.
RT_ALWAYS_INLINE void shade_ways(const Prepared *p, unsigned features, RayStack *stack, RenderStatistics *statistics,
                                 ShadeStep *step)
{
    ShadeWays ways;
    ShadeLayer layer;
    if (shade_one_layer(p, features, step->at.material, step->at.point, &layer)) {
        ways.count = 1;
        ways.normals[0] = step->at.normal;
        step->light = shade_plain(p, features, &layer, &step->at, step->ray.weight, &ways.scatter[0], statistics);
    } else {
        step->light = shade_bumpy(p, &step->at, step->ray.weight, &ways, statistics);
    }
    ray_stack_add(stack, &step->ray, step->light);
    step->scatter = ways.scatter[0];
    step->at.normal = ways.normals[0];
    int kept = 2 * (TRACE_LEVEL_MAX - step->ray.level) + 4; // for the levels to come
    for (int i = 0; i < ways.count && (i == 0 || stack->count + SHADE_WAY_RAYS + kept <= RAY_STACK_MAX); i++) {
        ShadingPoint at = step->at;
        at.normal = ways.normals[i];
        const ScatterRays rays = {&step->ray, step->behind, stack};
        shade_go_on(p, features, &ways.scatter[i], &at, &rays, statistics);
    }
}

// Takes the ray that was put on the list last: its light is added, and the rays that continue from where it hits are
// put on the list.
RT_ALWAYS_INLINE void shade_path_step(const Prepared *p, unsigned features, RayStack *stack, SampleStream *stream,
                                      RenderStatistics *statistics, ShadeStep *step)
{
    StackedRay *now = &step->ray;
    ray_stack_pop(features, stack, now);
    step->is_hit = false;
    step->behind = MEDIUM_EMPTY;
    step->fog = rgb_grey(0.0);
    if ((features & RENDER_EXPONENT) && now->opens) {
        stack->sums[++stack->open] = rgb_grey(0.0);
    }
    if ((features & RENDER_EXPONENT) && now->closes) {
        step->light = shade_rgb_power(stack->sums[stack->open--], now->exponent);
        ray_stack_add(stack, now, step->light);
    } else if (shade_find(p, features, now, stream, &step->at)) {
        step->is_hit = true;
        if (features & RENDER_INTERIORS) {
            step->at.media = &stack->media;
            step->at.before = now->inside;
            step->behind = shade_cross(p, features, &step->at);
        }
        if (features & RENDER_FOG) {
            step->fog = shade_fog(p, step->at.way, now, stack);
        }
        if (features & RENDER_NORMALS) {
            shade_ways(p, features, stack, statistics, step);
            return;
        }
        // Its own light first: a reflected ray may open a sum of its own.
        step->light = shade_surface(p, features, &step->at, now->weight, &step->scatter, statistics);
        ray_stack_add(stack, now, step->light);
        const ScatterRays rays = {now, step->behind, stack};
        shade_go_on(p, features, &step->scatter, &step->at, &rays, statistics);
    } else {
        if (features & RENDER_FOG) {
            step->fog = shade_fog(p, (double)INFINITY, now, stack);
        }
        step->light = shade_miss(p, features, now->ray.direction);
        ray_stack_add(stack, now, step->light);
    }
}

// The same with all features: compiled once, in render/shade/step.c, for kernels with bumps, alpha and the watcher of a
// ray.
void shade_step_all(const Prepared *p, RayStack *stack, SampleStream *stream, RenderStatistics *statistics,
                    ShadeStep *step);

// Traces the rays that wait; returns the sum of all light.
RT_ALWAYS_INLINE Rgb shade_stack(const Prepared *p, unsigned features, RayStack *stack, SampleStream *stream,
                                 RenderStatistics *statistics)
{
    while (stack->count > 0) {
        ShadeStep step;
        if (features == SHADE_ALL_FEATURES) {
            shade_step_all(p, stack, stream, statistics, &step);
        } else {
            shade_path_step(p, features, stack, stream, statistics, &step);
        }
    }
    return stack->sums[0];
}

// A kernel's shade_stack, not inline, so that it is compiled once.
typedef Rgb (*ShadePath)(const Prepared *p, RayStack *stack, SampleStream *stream, RenderStatistics *statistics);

// A ray from the camera.
typedef struct CameraRay {
    Ray ray;
    const Hit *known;     // what it hits; NULL: what it meets
    SampleStream *stream; // what it draws numbers from; may be NULL
} CameraRay;

// The light that one camera ray brings back.
RT_ALWAYS_INLINE Rgb shade_ray(const Prepared *p, unsigned features, ShadePath path, const CameraRay *camera_ray,
                               RayStack *stack, RenderStatistics *statistics)
{
    SampleStream *stream = camera_ray->stream;
    StackedRay first = {.ray = camera_ray->ray,
                        .start = RAY_START_CAMERA,
                        .share = rgb_grey(1.0),
                        .weight = 1.0,
                        .level = 1,
                        .known = camera_ray->known};
    if (features & (RENDER_REFLECTION | RENDER_TRANSPARENCY)) {
        shade_path_begin(p, features, &first, stack);
        return path(p, stack, stream, statistics);
    }
    ShadingPoint at;
    ScatterRecord scatter;
    return shade_find(p, features, &first, stream, &at) ? shade_surface(p, features, &at, 1.0, &scatter, statistics)
                                                        : shade_miss(p, features, camera_ray->ray.direction);
}

#endif
