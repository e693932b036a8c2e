// The rays that continue from a surface: mirrored, straight through, bent, or mirrored for want of a way out.
//
// They wait on a stack with the weight of what they will add, so that no recursion is needed and the order of additions
// is fixed. Everything is always-inline and takes the kernel's features as a constant.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_SHADE_SCATTER_H
#define RENDER_SHADE_SHADE_SCATTER_H

#include "base/limits.h"
#include "math/extreme.h"
#include "render/shade/shade_light.h"

// A ray that is still to be traced, or (closes) the end of one whose light is raised to a power before it is added.
typedef struct StackedRay {
    Ray ray;
    RayStart start;
    Rgb share;       // what its light is multiplied with
    double weight;   // what decides whether it is worth tracing: greatest components of all shares multiplied
    int level;       // 1 for camera rays; one more after each reflection
    uint64_t passed; // surfaces gone through since the last reflection
    double exponent; // closes: of the light; else unused
    bool opens, closes; // opens: its light is summed by itself, until the one below it closes
    const Hit *known; // what it hits, where that is known already (SHAPE_NONE: nothing); else NULL
    // Where there are interiors: what it is inside of, and how many nodes are kept while it or what is above it waits.
    MediumStack inside;
    uint32_t kept;
} StackedRay;

// Normals that the layers of one surface with bumps may have between them.
enum { SHADE_WAYS_MAX = SCENE_NORMALS_MOST + 1, SHADE_WAY_RAYS = 3 };

// Depth first, each level leaves at most one transmitted ray and one closing entry behind, and more only where bumps
// send rays in more than one direction; of those, what would not fit (80 in a row that each do so) is not followed.
enum { RAY_STACK_MAX = 2 * TRACE_LEVEL_MAX + 4 + 80 * SHADE_WAY_RAYS };

// The rays that wait, and the sums of light that are open: one, and one more for each ray with an exponent.
typedef struct RayStack {
    int count, open;
    MediumTable media; // of what the rays are inside of, where there are interiors
    Rgb sums[TRACE_LEVEL_MAX + 1];
    StackedRay rays[RAY_STACK_MAX];
} RayStack;

// Nodes that a stack of rays may need: each ray, the one that is followed, and a shadow ray.
enum { RAY_STACK_NODES = (RAY_STACK_MAX + 2) * MEDIUM_NODES_EACH };

RT_ALWAYS_INLINE void ray_stack_push(unsigned features, RayStack *stack, const StackedRay *ray)
{
    stack->rays[stack->count] = *ray;
    if (features & RENDER_INTERIORS) {
        stack->rays[stack->count].kept = stack->media.count;
    }
    stack->count++;
}

// Takes the ray that was put there last, and gives back the nodes that none but those above it had need of.
RT_ALWAYS_INLINE void ray_stack_pop(unsigned features, RayStack *stack, StackedRay *ray)
{
    *ray = stack->rays[--stack->count];
    if (features & RENDER_INTERIORS) {
        uint32_t kept = stack->count > 0 ? stack->rays[stack->count - 1].kept : MEDIUM_EMPTY + 1;
        ray->inside = medium_keep(&stack->media, kept, ray->inside);
    }
}

typedef struct ShadeMirror {
    Rgb reflectance; // what the mirrored ray is multiplied with
    double weight;   // the greatest share that any angle may reflect; 0: no mirror
} ShadeMirror;

// What a surface sends on, all its layers together.
typedef struct ScatterRecord {
    Rgb through;     // what a ray that goes through is multiplied with, beside `refraction`
    Rgb reflectance; // the same for the mirrored ray
    ShadeMirror kept; // of that, what textures of a map mirror also where what goes through is totally reflected
    double through_weight; // of layers: by how much the ray's weight falls, when it is not the greatest of `through`
    double reflection_weight; // the greatest share that any angle may reflect; 0: no mirror
    double reflection_exponent;
    double part; // of the textures of a map, of those that let light through, this way where there are bumps
    double refraction; // what light that goes through is multiplied with, too, but not the ray's weight; measured
    bool conserves_energy;
} ScatterRecord;

RT_ALWAYS_INLINE Rgb shade_rgb_power(Rgb light, double exponent)
{
    return rgb(shade_power(light.red, exponent), shade_power(light.green, exponent),
               shade_power(light.blue, exponent));
}

// Where a mirror sends the ray. With bumps that may be into the surface: such a ray is mirrored once more, at the
// surface as it is; or, when the normal is turned away from the viewer, mirrored there only. Measured.
RT_ALWAYS_INLINE Vec3 shade_mirrored(unsigned features, const ShadingPoint *at)
{
    Vec3 mirrored = vec3_reflect(at->direction, at->normal);
    Vec3 facing = at->inside ? vec3_neg(at->outward) : at->outward;
    if ((features & RENDER_NORMALS) && !vec3_equal(at->normal, facing) && vec3_dot(mirrored, facing) < 0.0) {
        bool is_away = vec3_dot(at->normal, at->direction) > 0.0;
        mirrored = vec3_reflect(is_away ? at->direction : mirrored, facing);
    }
    return vec3_normalize(mirrored);
}

// Whether a mirrored ray of such a weight continues: it is neither too deep nor worth too little.
RT_ALWAYS_INLINE bool shade_is_followed(const Prepared *p, int level, double weight)
{
    return level < p->max_trace_level && !(weight < p->adc_bailout) && !prepared_is_abandoned(p);
}

// Where rays that continue from a surface come from, and where they go.
typedef struct ScatterRays {
    const StackedRay *from;
    MediumStack behind; // what a ray is inside of behind the surface, where there are interiors
    RayStack *stack;
} ScatterRays;

// The mirrored ray, if it is followed. The angle does not enter its weight.
RT_ALWAYS_INLINE void shade_reflect(const Prepared *p, unsigned features, const ScatterRecord *scatter,
                                    const ShadingPoint *at, const ScatterRays *rays)
{
    const StackedRay *from = rays->from;
    RayStack *stack = rays->stack;
    double weight = from->weight * scatter->reflection_weight;
    if (!shade_is_followed(p, from->level, weight)) {
        return;
    }
    StackedRay ray = {
        .ray = {at->point, shade_mirrored(features, at)},
        .start = {at->shape, at->inside, HIDDEN_MIRROR},
        .share = rgb_mul(from->share, scatter->reflectance),
        .weight = weight,
        .level = from->level + 1,
        .inside = at->before,
    };
    if ((features & RENDER_EXPONENT) && scatter->reflection_exponent != 1.0) {
        StackedRay end = {.share = ray.share, .exponent = 1.0 / scatter->reflection_exponent, .closes = true};
        ray_stack_push(features, stack, &end);
        ray.opens = true;
        ray.share = rgb_grey(1.0);
    }
    ray_stack_push(features, stack, &ray);
}

// How far a ray has come.
typedef struct RayAge {
    double weight;
    int level;
    uint64_t passed;
} RayAge;

// What light that goes straight on is multiplied with, and the weight of its ray; false when that is not followed.
RT_ALWAYS_INLINE bool shade_goes_on(const Prepared *p, const ScatterRecord *scatter, RayAge age, Rgb *through,
                                    double *weight)
{
    *through = scatter->through;
    *weight = age.weight * (scatter->through_weight > 0.0 ? scatter->through_weight : rgb_max_abs(*through));
    if (scatter->conserves_energy) {
        Rgb left = rgb_add_scaled(rgb_grey(1.0), -1.0, scatter->reflectance);
        *through = rgb_mul(*through, left);
        *weight *= rgb_max(left);
    }
    bool goes_on = !(age.level >= p->max_trace_level || *weight < p->adc_bailout || age.passed >= p->crossings_max ||
                     prepared_is_abandoned(p) ||
                     (scatter->through_weight == 0.0 && fabs(rgb_luminance(*through)) < p->adc_bailout));
    *through = rgb_scale(scatter->refraction, *through);
    return goes_on;
}

// Light that a surface sends through, 0 where its finish lets none continue.
RT_ALWAYS_INLINE Rgb shade_sent_through(const ScatterRecord *scatter)
{
    return rgb_scale(scatter->refraction, scatter->through);
}

// The ray that goes straight on, whose share may be below 0. It stays on its level; what bounds it is that a line meets
// only so many surfaces.
RT_ALWAYS_INLINE void shade_transmit(const Prepared *p, unsigned features, const ScatterRecord *scatter,
                                     const ShadingPoint *at, const ScatterRays *rays)
{
    const StackedRay *from = rays->from;
    Rgb through;
    double weight;
    if (!shade_goes_on(p, scatter, (RayAge){from->weight, from->level, from->passed}, &through, &weight)) {
        return;
    }
    StackedRay ray = {
        .ray = {at->point, at->direction},
        .start = {at->shape, !at->inside, from->start.use},
        .share = rgb_mul(from->share, through),
        .weight = weight,
        .level = from->level,
        .passed = from->passed + 1,
        .inside = rays->behind,
    };
    ray_stack_push(features, rays->stack, &ray);
}

// Where a surface is between two interiors: how the index of refraction changes; returns what the ray is inside of behind
// it. A ray leaves the body that it has entered, and enters any other, from whichever side it comes to a surface: one
// that is open or flat, too. Measured.
RT_ALWAYS_INLINE MediumStack shade_cross(const Prepared *p, unsigned features, ShadingPoint *at)
{
    uint64_t body = scene_body_key(p->scene, at->order, at->body);
    MediumStack behind = at->before;
    at->leaves = medium_leave(at->media, &behind, body);
    if (!at->leaves) {
        bool has_fog = (features & RENDER_FOG) && scene_has_haze(p->scene);
        bool is_solid = has_fog && !scene_is_hollow(p->scene, at->material);
        behind = medium_enter(at->media, behind, (MediumRegion){body, at->interior, is_solid});
    }
    at->ior_ratio = medium_ior(p->interiors, at->media, behind) / medium_ior(p->interiors, at->media, at->before);
    FresnelSides sides = medium_fresnel_sides(p->interiors, at->media, at->before, behind, at->interior, at->leaves);
    at->fresnel_ratio = sides.behind / sides.before;
    return behind;
}

// The finish of a surface's top layer; NULL where textures lie side by side.
RT_ALWAYS_INLINE const PreparedFinish *shade_top_finish(const Prepared *p, MaterialIndex material)
{
    if (!(material & MATERIAL_COMPOUND)) {
        return &p->finishes[p->materials[material].finish];
    }
    const Texture *top = &p->scene->textures.items[p->compounds[material & ~MATERIAL_COMPOUND].texture];
    return top->pattern.type == PATTERN_NONE ? &p->finishes[top->finish] : NULL;
}

// Where a ray is bent to by a normal, of bumps perhaps; false when all of it is mirrored.
RT_ALWAYS_INLINE bool shade_bent(unsigned features, const ShadingPoint *at, Vec3 normal, Vec3 *direction)
{
    bool is_away = (features & RENDER_NORMALS) && vec3_dot(normal, at->direction) > 0.0;
    return inside_bend(at->direction, is_away ? vec3_neg(normal) : normal, at->ior_ratio, direction);
}

// The ray that is bent at the surface, or mirrored when none of it gets through; true in the second case. It goes to
// the next level. There is none when it is too deep or worth too little, and then no other mirrored ray either.
// Measured.
RT_ALWAYS_INLINE bool shade_bend(const Prepared *p, unsigned features, const ScatterRecord *scatter, Rgb fade,
                                 const ShadingPoint *at, const ScatterRays *rays)
{
    const StackedRay *from = rays->from;
    RayStack *stack = rays->stack;
    Vec3 direction;
    bool is_bent = shade_bent(features, at, at->normal, &direction);
    int place = stack->count;
    shade_transmit(p, features, scatter, at, &(ScatterRays){from, is_bent ? rays->behind : at->before, stack});
    if (stack->count == place) {
        return !is_bent;
    }
    StackedRay *ray = &stack->rays[place];
    if (!is_bent) {
        // Its weight is that of one that gets through, its light is not. Measured.
        ray->share = rgb_mul(from->share, rgb_scale(scatter->part * scatter->refraction, fade));
        direction = shade_mirrored(features, at);
        const PreparedFinish *finish = features & RENDER_TEXTURES ? shade_top_finish(p, at->material) : NULL;
        if (finish && finish->irid > 0.0) {
            ray->share = rgb_mul(ray->share, shade_thin_layer(p, finish, at, vec3_dot(at->normal, direction)));
        }
    }
    // Bumps may bend a ray back to the side that it came from.
    bool goes_in = (features & RENDER_NORMALS) && is_bent ? vec3_dot(at->outward, direction) < 0.0
                                                          : is_bent != at->inside;
    ray->ray = (Ray){at->point, direction};
    ray->start = (RayStart){at->shape, goes_in, is_bent ? from->start.use : HIDDEN_MIRROR};
    ray->level = from->level + 1;
    ray->passed = 0;
    return !is_bent;
}

// What goes through; true when all of it is mirrored instead.
RT_ALWAYS_INLINE bool shade_go_through(const Prepared *p, unsigned features, const ScatterRecord *scatter,
                                       const ShadingPoint *at, const ScatterRays *rays)
{
    ScatterRecord faded = *scatter;
    Rgb fade = rgb_grey(1.0);
    if ((features & RENDER_INTERIORS) && at->leaves) {
        // Only what comes out of it or is mirrored for want of a way out; not what the surface's finish gives off or
        // mirrors. Measured.
        fade = shade_faded(p, at->interior, at->way);
        faded.through = rgb_mul(scatter->through, fade);
        scatter = &faded;
    }
    if ((features & RENDER_INTERIORS) && at->ior_ratio != 1.0) {
        return shade_bend(p, features, scatter, fade, at, rays);
    }
    shade_transmit(p, features, scatter, at, rays);
    return false;
}

// Notes the share of a ray that is not followed, in whole units, so that sums do not depend on their order.
RT_ALWAYS_INLINE void shade_note_cut(const Prepared *p, int level, Rgb share, RenderStatistics *statistics)
{
    double cut = less_of(greater_of(rgb_luminance(share), 0.0), 1.0);
    uint64_t units = (uint64_t)(cut * 0x1p32);
    statistics->cut_by_level += level >= p->max_trace_level ? units : 0;
    statistics->cut_by_weight += level >= p->max_trace_level ? 0 : units;
}

// The rays that continue from a hit; the reflected one will be traced first.
RT_ALWAYS_INLINE void shade_go_on(const Prepared *p, unsigned features, const ScatterRecord *scatter,
                                  const ShadingPoint *at, const ScatterRays *rays, RenderStatistics *statistics)
{
    const StackedRay *from = rays->from;
    const RayStack *stack = rays->stack;
    int place = stack->count;
    bool is_total = false;
    if ((features & RENDER_TRANSPARENCY) && !rgb_is_black(shade_sent_through(scatter))) {
        is_total = shade_go_through(p, features, scatter, at, rays);
        statistics->transmitted_rays += (uint64_t)(stack->count - place);
        if (stack->count == place) {
            shade_note_cut(p, from->level, rgb_mul(from->share, shade_sent_through(scatter)), statistics);
        }
    }
    place = stack->count;
    ScatterRecord kept;
    if ((features & RENDER_TEXTURES) && is_total) { // each texture of a map by itself. Measured.
        kept = *scatter;
        kept.reflectance = scatter->kept.reflectance;
        kept.reflection_weight = scatter->kept.weight;
        scatter = &kept;
        is_total = false;
    }
    if ((features & RENDER_REFLECTION) && scatter->reflection_weight != 0.0 && !is_total) {
        shade_reflect(p, features, scatter, at, rays);
        statistics->reflected_rays += stack->count > place;
        if (stack->count == place) {
            shade_note_cut(p, from->level, rgb_mul(from->share, scatter->reflectance), statistics);
        }
    }
}

#endif
