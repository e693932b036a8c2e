// Light along one ray: what is hit, how it shines, and the rays that go on from there.
//
// Everything here is always-inline and takes the kernel's features as a constant. The lighting model is the scene
// language's, as its manual describes it and as measured against it; docs/language.md, "Lighting model", has the formulas.
// Reflected and transmitted rays wait in a small stack with the weight of what they will add, so that no recursion is
// needed and the order of additions is fixed.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_H
#define RENDER_SHADE_H

#include "base/attributes.h"
#include "base/limits.h"
#include "render/inside.h"
#include "render/kernel.h"
#include "render/light.h"
#include "render/prepared.h"
#include "render/sky.h"
#include "render/texture.h"
#include "trace/query.h"

// A ray that is still to be traced, or (closes) the end of one whose light is raised to a power before it is added.
typedef struct PendingRay {
    Ray ray;
    RayStart start;
    Rgb share;       // what its light is multiplied with
    double weight;   // what decides whether it is worth tracing: greatest components of all shares multiplied
    int level;       // 1 for camera rays; one more after each reflection
    uint64_t passed; // surfaces gone through since the last reflection
    double exponent; // closes: of the light; else unused
    bool opens, closes; // opens: its light is summed by itself, until the one below it closes
    const Hit *known; // what it hits, where that is known already (SHAPE_NONE: nothing); else NULL
} PendingRay;

// Normals that the layers of one surface with bumps may have between them.
enum { SHADE_WAYS_MAX = SCENE_NORMALS_MOST + 1, SHADE_WAY_RAYS = 3 };

// Depth first, each level leaves at most one transmitted ray and one closing entry behind, and more only where bumps send
// rays in more than one direction; of those, what would not fit (80 in a row that each do so) is not followed.
enum { PENDING_MAX = 2 * TRACE_LEVEL_MAX + 4 + 80 * SHADE_WAY_RAYS };

// The rays that wait, and the sums of light that are open: one, and one more for each ray with an exponent.
typedef struct Pending {
    int count, open;
    PendingRay rays[PENDING_MAX];
    Inside inside[PENDING_MAX]; // of each ray, where there are interiors
    Rgb sums[TRACE_LEVEL_MAX + 1];
} Pending;

// A point being shaded. `normal` is turned towards the viewer, `outward` is the shape's own.
typedef struct ShadePoint {
    Vec3 point, normal, outward;
    Vec3 direction; // of the ray that found it
    ShapeId shape;
    MaterialIndex material;
    uint32_t order;    // of the shape, in the order of declaration
    uint32_t interior; // of the shape
    double ior_ratio;  // index of refraction behind the surface over the one before it
    double way;        // of the ray that found it, in the scene's lengths; where there are interiors
    bool inside;  // the ray met the surface from the side where the shape is
    bool leaves;  // what the ray is in; where there are interiors
    SampleStream *stream; // what area lights draw numbers from; NULL: they are grids; where there are such lights
} ShadePoint;

// What a surface is made of at a point. "Opaque share" is 1 - filter - transmit.
typedef struct ShadeMaterial {
    Rgb pigment;
    Rgb opaque; // opaque share × pigment
    const PreparedFinish *finish;
} ShadeMaterial;

// What a surface sends on, all its layers together.
typedef struct ShadeOnward {
    Rgb through;     // what a ray that goes through is multiplied with
    Rgb reflectance; // the same for the mirrored ray
    double through_weight; // of layers: by how much the ray's weight falls, when it is not the greatest of `through`
    double reflection_weight; // the greatest share that any angle may reflect; 0: no mirror
    double reflection_exponent;
    double part; // where there are bumps: of the textures of a map, those whose light goes through this way
    bool conserves_energy;
} ShadeOnward;

// What a surface with bumps sends on, for each of the normals that its layers have.
typedef struct ShadeWays {
    int count;
    Vec3 normals[SHADE_WAYS_MAX];
    ShadeOnward onward[SHADE_WAYS_MAX];
} ShadeWays;

// The same as shade_surface for patterns and layers; not inline, for it costs more than a call. In render/compound.c.
// `weight` is the ray's.
Rgb shade_compound(const Prepared *p, const ShadePoint *at, double weight, ShadeOnward *onward,
                   RenderStatistics *statistics);
// The same where there may be bumps.
Rgb shade_bumpy(const Prepared *p, const ShadePoint *at, double weight, ShadeWays *ways, RenderStatistics *statistics);

RT_ALWAYS_INLINE ShadeMaterial shade_material(const Prepared *p, unsigned features, Rgbft pigment, FinishIndex finish)
{
    Rgb colour = rgbft_rgb(pigment);
    ShadeMaterial out = {colour, colour, &p->finishes[finish]};
    if (features & RENDER_TRANSPARENCY) {
        out.opaque = rgb_scale(1.0 - pigment.filter - pigment.transmit, colour);
    }
    return out;
}

RT_ALWAYS_INLINE uint32_t shade_interior(const Prepared *p, MaterialIndex material)
{
    return material & MATERIAL_COMPOUND ? p->compounds[material & ~MATERIAL_COMPOUND].interior : RECORD_NONE;
}

// What an interior leaves of light that comes out of it.
RT_ALWAYS_INLINE Rgb shade_faded(const Prepared *p, uint32_t interior, double way)
{
    return interior != RECORD_NONE && p->interiors[interior].fade_distance != 0.0
               ? inside_fade(&p->interiors[interior], way)
               : rgb_grey(1.0);
}

// The same on the way from a light, where a power of 0 leaves all. Measured.
RT_ALWAYS_INLINE Rgb shade_shadow_faded(const Prepared *p, const Surface *surface, double t)
{
    uint32_t interior = shade_interior(p, surface->material);
    return interior != RECORD_NONE && p->interiors[interior].fade_power != 0.0
               ? shade_faded(p, interior, t * p->textures.scale)
               : rgb_grey(1.0);
}

// What a surface multiplies light with that goes through it.
RT_ALWAYS_INLINE Rgb shade_surface_through(const Prepared *p, unsigned features, const Surface *surface)
{
    if ((features & RENDER_TEXTURES) && (surface->material & MATERIAL_COMPOUND)) {
        const Compound *compound = &p->compounds[surface->material & ~MATERIAL_COMPOUND];
        return texture_walk(&p->textures, compound->texture, surface->point, 0.0, NULL, NULL).light;
    }
    return texture_pigment_through(material_pigment(&p->materials[surface->material]));
}

// The share of light that arrives along a shadow ray, by colour: every surface on the way that lets light through
// multiplies it, the first that does not ends it. What is seen from outside and lit from behind, by bumps or on its back,
// gets its light through itself unfaded. Measured.
RT_ALWAYS_INLINE Rgb shade_light_through(const Prepared *p, unsigned features, const ShadePoint *at, Ray ray,
                                         RayStart start, double t_max)
{
    Rgb share = rgb_grey(1.0);
    Hit hit;
    bool fades = at->inside || !start.inward;
    for (uint64_t passed = 0; geometry_closest(p->geometry, features, ray, start, t_max, &hit); passed++) {
        Surface surface = geometry_surface(p->geometry, features, ray, hit);
        Rgb through = shade_surface_through(p, features, &surface);
        if (rgb_is_black(through) || passed > p->crossings_max) {
            return rgb_grey(0.0);
        }
        share = rgb_mul(share, through);
        if ((features & RENDER_INTERIORS) && hit.inside && fades) {
            share = rgb_mul(share, shade_shadow_faded(p, &surface, hit.t));
        }
        fades = true;
        ray.origin = surface.point;
        t_max -= hit.t;
        start = (RayStart){hit.shape, !hit.inside, HIDDEN_SHADOW};
    }
    return share;
}

// The share of the light that reaches the point, by colour.
RT_ALWAYS_INLINE Rgb shade_visibility(const Prepared *p, unsigned features, const ShadePoint *at, Vec3 towards,
                                      double distance, RenderStatistics *statistics)
{
    Ray ray = {at->point, towards};
    RayStart start = {at->shape, vec3_dot(at->outward, towards) < 0.0, HIDDEN_SHADOW};
    statistics->shadow_rays++;
    if (features & RENDER_TRANSPARENCY) {
        return shade_light_through(p, features, at, ray, start, distance);
    }
    return rgb_grey(geometry_occluded(p->geometry, features, ray, start, distance) ? 0.0 : 1.0);
}

// The share of the light of a place in an area, `aside` from its middle, that reaches the point.
RT_ALWAYS_INLINE Rgb shade_area_one(const Prepared *p, unsigned features, const ShadePoint *at,
                                    const PreparedLight *light, Vec3 aside, RenderStatistics *statistics)
{
    Vec3 offset = vec3_sub(vec3_add(light->position, aside), at->point);
    double distance = vec3_length(offset);
    return shade_visibility(p, features, at, vec3_scale(1.0 / distance, offset), distance, statistics);
}

// The mean over an area light, see render/light.h.
RT_ALWAYS_INLINE Rgb shade_area_grid(const Prepared *p, unsigned features, const ShadePoint *at,
                                const PreparedLight *light, RenderStatistics *statistics)
{
    LightParts parts;
    Rgb sum = rgb_grey(0.0);
    light_parts_begin(&parts, &light->area);
    while (parts.count > 0) {
        LightPart part = parts.waiting[--parts.count];
        Rgb corners[4], mean = rgb_grey(0.0);
        for (int corner = 0; corner < 4; corner++) {
            int i = corner & 1 ? part.right : part.left, j = corner & 2 ? part.bottom : part.top;
            int same = (part.right == part.left ? corner & 2 : corner) & (part.bottom == part.top ? 1 : 3);
            corners[corner] =
                same < corner
                    ? corners[same]
                    : shade_area_one(p, features, at, light, light_area_offset(light, at->point, i, j), statistics);
            mean = rgb_add(mean, corners[corner]);
        }
        if (!light_part_divides(&parts, &light->area, part, corners)) {
            sum = rgb_add_scaled(sum, 0.25 * part.weight, mean);
        }
    }
    return sum;
}

// The same; or of one of its lights by chance, when the camera ray is one of many.
RT_ALWAYS_INLINE Rgb shade_area(const Prepared *p, unsigned features, const ShadePoint *at,
                                const PreparedLight *light, RenderStatistics *statistics)
{
    return at->stream ? shade_area_one(p, features, at, light, light_area_sample(light, sample_next(at->stream)),
                                       statistics)
                      : shade_area_grid(p, features, at, light, statistics);
}

// Phong and specular highlights of one light, in units of the light's colour. `cosine` = N·L > 0.
RT_ALWAYS_INLINE double shade_highlights(const PreparedFinish *finish, const ShadePoint *at, Vec3 towards)
{
    double sum = 0.0;
    if (finish->phong > 0.0) {
        double cosine = vec3_dot(vec3_reflect(at->direction, at->normal), towards);
        if (cosine > 0.0) {
            sum += finish->phong * shade_power(cosine, finish->phong_size);
        }
    }
    if (finish->specular > 0.0) {
        Vec3 halfway = vec3_sub(towards, at->direction);
        double cosine = vec3_dot(halfway, at->normal) / vec3_length(halfway);
        if (cosine > 0.0) {
            sum += finish->specular * shade_power(cosine, finish->shininess);
        }
    }
    return sum;
}

// The share of the pigment in a metallic highlight falls with the light's angle x (in right angles) to the normal as 1 - F,
// F being the Fresnel curve of P. Strauss, "A Realistic Lighting Model for Computer Animators", IEEE CG&A 10(6), 1990:
// F(x) = (1 / (x - k)² - 1 / k²) / (1 / (1 - k)² - 1 / k²) with k = 1.12. Renderings agree with it to 1/65535. A normal
// with bumps may be turned away from the viewer: then F goes on beyond 1 right angle, but not above 1.
RT_ALWAYS_INLINE Rgb shade_metallic(unsigned features, double metallic, Rgb pigment, double cosine)
{
    const double k = 1.12;
    const double at_normal = 1.0 / (k * k), at_grazing = 1.0 / ((1.0 - k) * (1.0 - k));
    bool is_bumpy = features & RENDER_NORMALS;
    double x = acos(is_bumpy ? fmax(fmin(cosine, 1.0), -1.0) : fmin(fabs(cosine), 1.0)) * (2.0 / 3.14159265358979323846);
    double fresnel = (1.0 / ((x - k) * (x - k)) - at_normal) / (at_grazing - at_normal);
    fresnel = is_bumpy ? fmin(fresnel, 1.0) : fresnel;
    double share = metallic * (1.0 - fresnel);
    return rgb(1.0 + share * (pigment.red - 1.0), 1.0 + share * (pigment.green - 1.0),
               1.0 + share * (pigment.blue - 1.0));
}

// What one light adds at a point: diffuse on the side it stands on, highlights on the viewer's side only.
RT_ALWAYS_INLINE Rgb shade_light(const Prepared *p, unsigned features, const ShadeMaterial *material,
                                 const PreparedLight *light, const ShadePoint *at, RenderStatistics *statistics)
{
    const PreparedFinish *finish = material->finish;
    Vec3 offset = vec3_sub(light->position, at->point);
    double distance = light->parallel ? vec3_dot(offset, light->towards) : vec3_length(offset);
    Vec3 towards = light->parallel ? light->towards : vec3_scale(1.0 / distance, offset);
    double cosine = vec3_dot(at->normal, towards);
    bool front = cosine > 0.0;
    bool back = (features & RENDER_BRILLIANCE) && cosine < 0.0 && finish->diffuse_back > 0.0;
    if (!(front || back)) {
        return rgb_grey(0.0);
    }
    Rgb arriving = light->colour;
    if ((features & RENDER_LIGHTS) && !light->is_plain) {
        double strength = light_strength(light, offset, distance);
        if (!(strength > 0.0)) {
            return rgb_grey(0.0);
        }
        arriving = rgb_scale(strength, arriving);
    }
    // Beyond the plane of a parallel light nothing throws a shadow.
    if ((features & RENDER_SHADOWS) && !light->shadowless && distance > 0.0) {
        Rgb share = (features & RENDER_LIGHTS) && light->area.size1 > 0
                        ? shade_area(p, features, at, light, statistics)
                        : shade_visibility(p, features, at, towards, distance, statistics);
        if (rgb_is_black(share)) {
            return share;
        }
        arriving = rgb_mul(arriving, share);
    }
    double falloff = features & RENDER_BRILLIANCE ? shade_power(fabs(cosine), finish->brilliance) : cosine;
    Rgb sum = rgb_scale(falloff, rgb_scale(back ? finish->diffuse_back : finish->diffuse, material->opaque));
    if ((features & RENDER_HIGHLIGHTS) && finish->shines && front && !light->shadowless) {
        double shine = shade_highlights(finish, at, towards);
        Rgb tint = finish->metallic > 0.0 ? shade_metallic(features, finish->metallic, material->pigment, cosine)
                                            : rgb_grey(1.0);
        sum = rgb_add_scaled(sum, shine, tint);
    }
    return rgb_mul(sum, arriving);
}

// The reflected share at an angle with cosine N·V.
RT_ALWAYS_INLINE Rgb shade_reflectance(unsigned features, const ShadeMaterial *material, double cosine,
                                       double ior_ratio)
{
    const PreparedFinish *finish = material->finish;
    double grazing = (features & RENDER_INTERIORS) && finish->is_fresnel
                         ? inside_fresnel(features & RENDER_NORMALS ? fmax(cosine, 0.0) : cosine, ior_ratio)
                         : shade_power(fmax(1.0 - cosine, 0.0), finish->reflection_falloff);
    Rgb span = rgb_add_scaled(finish->reflection_max, -1.0, finish->reflection_min);
    Rgb share = rgb_add_scaled(finish->reflection_min, grazing, span);
    if (finish->reflection_metallic > 0.0) {
        share = rgb_mul(share, shade_metallic(features, finish->reflection_metallic, material->pigment, cosine));
    }
    return share;
}

RT_ALWAYS_INLINE Rgb shade_rgb_power(Rgb light, double exponent)
{
    return rgb(shade_power(light.red, exponent), shade_power(light.green, exponent),
               shade_power(light.blue, exponent));
}

// Where a mirror sends the ray. With bumps that may be into the surface: such a ray is mirrored once more, at the surface
// as it is; or, when the normal is turned away from the viewer, mirrored there only. Measured.
RT_ALWAYS_INLINE Vec3 shade_mirrored(unsigned features, const ShadePoint *at)
{
    Vec3 mirrored = vec3_reflect(at->direction, at->normal);
    Vec3 facing = at->inside ? vec3_neg(at->outward) : at->outward;
    if ((features & RENDER_NORMALS) && !vec3_equal(at->normal, facing) && vec3_dot(mirrored, facing) < 0.0) {
        bool is_away = vec3_dot(at->normal, at->direction) > 0.0;
        mirrored = vec3_reflect(is_away ? at->direction : mirrored, facing);
    }
    return vec3_normalize(mirrored);
}

// The mirrored ray, unless it is too deep or worth too little. The angle does not enter its weight.
RT_ALWAYS_INLINE void shade_reflect(const Prepared *p, unsigned features, const ShadeOnward *onward,
                                    const ShadePoint *at, const PendingRay *from, Pending *pending)
{
    double weight = from->weight * onward->reflection_weight;
    if (from->level >= p->max_trace_level || weight < p->adc_bailout) {
        return;
    }
    PendingRay ray = {
        .ray = {at->point, shade_mirrored(features, at)},
        .start = {at->shape, at->inside, HIDDEN_MIRROR},
        .share = rgb_mul(from->share, onward->reflectance),
        .weight = weight,
        .level = from->level + 1,
    };
    if ((features & RENDER_EXPONENT) && onward->reflection_exponent != 1.0) {
        PendingRay end = {.share = ray.share, .exponent = 1.0 / onward->reflection_exponent, .closes = true};
        pending->rays[pending->count++] = end;
        ray.opens = true;
        ray.share = rgb_grey(1.0);
    }
    pending->rays[pending->count++] = ray;
}

// The ray that goes straight on, whose share may be below 0. It stays on its level; what bounds it is that a line meets only so many surfaces.
RT_ALWAYS_INLINE void shade_transmit(const Prepared *p, const ShadeOnward *onward, const ShadePoint *at,
                                     const PendingRay *from, Pending *pending)
{
    Rgb through = onward->through;
    double weight = from->weight * (onward->through_weight > 0.0 ? onward->through_weight : rgb_max_abs(through));
    if (onward->conserves_energy) {
        Rgb left = rgb_add_scaled(rgb_grey(1.0), -1.0, onward->reflectance);
        through = rgb_mul(through, left);
        weight *= rgb_max(left);
    }
    if (from->level >= p->max_trace_level || weight < p->adc_bailout || from->passed >= p->crossings_max ||
        (onward->through_weight == 0.0 && fabs(rgb_luminance(through)) < p->adc_bailout)) {
        return;
    }
    pending->rays[pending->count++] = (PendingRay){
        .ray = {at->point, at->direction},
        .start = {at->shape, !at->inside, from->start.use},
        .share = rgb_mul(from->share, through),
        .weight = weight,
        .level = from->level,
        .passed = from->passed + 1,
    };
}

// Where a surface is between two interiors: how the index of refraction changes, and what the ray is inside of behind it.
// A ray leaves what it has entered, and enters anything else, from whichever side it comes to a surface: one that is open
// or flat, too. Measured.
RT_ALWAYS_INLINE void shade_cross(const Prepared *p, unsigned features, ShadePoint *at, const Inside *before,
                                  Inside *behind)
{
    inside_copy(behind, before);
    at->leaves = inside_leave(behind, at->order);
    if (!at->leaves) {
        bool is_solid = (features & RENDER_FOG) && !scene_is_hollow(p->scene, at->material);
        inside_enter(behind, at->order, at->interior, is_solid);
    }
    at->ior_ratio = inside_ior(p->interiors, behind) / inside_ior(p->interiors, before);
}

// The ray that is bent at the surface, or mirrored when none of it gets through; true in the second case. It goes to the
// next level. There is none when it is too deep or worth too little, and then no other mirrored ray either. Measured.
RT_ALWAYS_INLINE bool shade_bend(const Prepared *p, unsigned features, const ShadeOnward *onward, Rgb fade,
                                 const ShadePoint *at, const PendingRay *from, const Inside *before,
                                 const Inside *behind, Pending *pending)
{
    Vec3 direction, normal = at->normal;
    if ((features & RENDER_NORMALS) && vec3_dot(normal, at->direction) > 0.0) {
        normal = vec3_neg(normal);
    }
    bool is_bent = inside_bend(at->direction, normal, at->ior_ratio, &direction);
    int place = pending->count;
    shade_transmit(p, onward, at, from, pending);
    if (pending->count == place) {
        return !is_bent;
    }
    PendingRay *ray = &pending->rays[place];
    if (!is_bent) {
        // Its weight is that of one that gets through, its light is not. Measured.
        double part = features & RENDER_NORMALS ? onward->part : 1.0;
        ray->share = rgb_mul(from->share, rgb_scale(part, fade));
        direction = shade_mirrored(features, at);
    }
    // Bumps may bend a ray back to the side that it came from.
    bool goes_in = (features & RENDER_NORMALS) && is_bent ? vec3_dot(at->outward, direction) < 0.0
                                                          : is_bent != at->inside;
    ray->ray = (Ray){at->point, direction};
    ray->start = (RayStart){at->shape, goes_in, is_bent ? from->start.use : HIDDEN_MIRROR};
    ray->level = from->level + 1;
    ray->passed = 0;
    inside_copy(&pending->inside[place], is_bent ? behind : before);
    return !is_bent;
}

// What goes through; true when all of it is mirrored instead.
RT_ALWAYS_INLINE bool shade_go_through(const Prepared *p, unsigned features, const ShadeOnward *onward,
                                       const ShadePoint *at, const PendingRay *from, const Inside *before,
                                       const Inside *behind, Pending *pending)
{
    int place = pending->count;
    ShadeOnward faded = *onward;
    Rgb fade = rgb_grey(1.0);
    if ((features & RENDER_INTERIORS) && at->leaves) {
        // Only what comes out of it or is mirrored for want of a way out; not what the surface's finish gives off or
        // mirrors. Measured.
        fade = shade_faded(p, at->interior, at->way);
        faded.through = rgb_mul(onward->through, fade);
        onward = &faded;
    }
    if ((features & RENDER_INTERIORS) && at->ior_ratio != 1.0) {
        return shade_bend(p, features, onward, fade, at, from, before, behind, pending);
    }
    shade_transmit(p, onward, at, from, pending);
    if ((features & RENDER_INTERIORS) && pending->count > place) {
        inside_copy(&pending->inside[place], behind);
    }
    return false;
}

// Notes the share of a ray that is not followed, in whole units, so that sums do not depend on their order.
RT_ALWAYS_INLINE void shade_note_cut(const Prepared *p, const PendingRay *from, Rgb share, RenderStatistics *statistics)
{
    double cut = fmin(fmax(rgb_luminance(rgb_mul(from->share, share)), 0.0), 1.0);
    uint64_t units = (uint64_t)(cut * 0x1p32);
    statistics->cut_by_level += from->level >= p->max_trace_level ? units : 0;
    statistics->cut_by_weight += from->level >= p->max_trace_level ? 0 : units;
}

// The rays that go on from a hit; the reflected one will be traced first. `before` and `behind` are what the ray is inside
// of on both sides of the surface, where there are interiors.
RT_ALWAYS_INLINE void shade_go_on(const Prepared *p, unsigned features, const ShadeOnward *onward,
                                  const ShadePoint *at, const PendingRay *from, const Inside *before,
                                  const Inside *behind, Pending *pending, RenderStatistics *statistics)
{
    int place = pending->count;
    bool is_total = false;
    if ((features & RENDER_TRANSPARENCY) && !rgb_is_black(onward->through)) {
        is_total = shade_go_through(p, features, onward, at, from, before, behind, pending);
        statistics->transmitted_rays += (uint64_t)(pending->count - place);
        if (pending->count == place) {
            shade_note_cut(p, from, onward->through, statistics);
        }
    }
    place = pending->count;
    if ((features & RENDER_REFLECTION) && onward->reflection_weight != 0.0 && !is_total) {
        shade_reflect(p, features, onward, at, from, pending);
        statistics->reflected_rays += pending->count > place;
        if (pending->count == place) {
            shade_note_cut(p, from, onward->reflectance, statistics);
        }
        if ((features & RENDER_INTERIORS) && pending->count > place) {
            inside_copy(&pending->inside[pending->count - 1], before);
        }
    }
}

// What a material adds by itself: its glow and what the lights make of it.
RT_ALWAYS_INLINE Rgb shade_local(const Prepared *p, unsigned features, const ShadeMaterial *material,
                                 const ShadePoint *at, RenderStatistics *statistics)
{
    Rgb light = rgb_mul(material->opaque, material->finish->glow);
    for (size_t i = 0; i < p->light_count; i++) {
        light = rgb_add(light, shade_light(p, features, material, &p->lights[i], at, statistics));
    }
    return light;
}

// The mirror of a material, by colour; false when it has none.
RT_ALWAYS_INLINE bool shade_mirror(unsigned features, const ShadeMaterial *material, const ShadePoint *at,
                                   Rgb *reflectance)
{
    if (!(features & RENDER_REFLECTION) || !material->finish->reflects) {
        return false;
    }
    *reflectance = shade_reflectance(features, material, -vec3_dot(at->normal, at->direction), at->ior_ratio);
    return true;
}

// By how much the weight of a mirrored ray falls: by the greatest share of any angle, but with Fresnel by that of its own.
// Measured.
RT_ALWAYS_INLINE double shade_mirror_weight(unsigned features, const PreparedFinish *finish, Rgb reflectance)
{
    return (features & RENDER_INTERIORS) && finish->is_fresnel ? rgb_max(reflectance) : finish->reflection_weight;
}

// What a layer's mirror leaves of the light of the layers below.
RT_ALWAYS_INLINE Rgb shade_left_below(unsigned features, const ShadeMaterial *material, const ShadePoint *at)
{
    Rgb reflectance;
    return material->finish->conserves_energy && shade_mirror(features, material, at, &reflectance)
               ? rgb_add_scaled(rgb_grey(1.0), -1.0, reflectance)
               : rgb_grey(1.0);
}

// The light of a surface of one material, and what it sends on.
RT_ALWAYS_INLINE Rgb shade_plain(const Prepared *p, unsigned features, const ShadePoint *at, ShadeOnward *onward,
                                 RenderStatistics *statistics)
{
    const Material *plain = &p->materials[at->material];
    Rgbft pigment = material_pigment(plain);
    ShadeMaterial material = shade_material(p, features, pigment, plain->finish);
    if (shade_mirror(features, &material, at, &onward->reflectance)) {
        onward->reflection_weight = shade_mirror_weight(features, material.finish, onward->reflectance);
        onward->reflection_exponent = material.finish->reflection_exponent;
    }
    if (features & RENDER_TRANSPARENCY) {
        onward->through = rgb_scale(material.finish->refraction, texture_pigment_through(pigment));
        onward->conserves_energy = material.finish->conserves_energy;
    }
    return shade_local(p, features, &material, at, statistics);
}

// The light at a hit, and what the surface sends on.
RT_ALWAYS_INLINE Rgb shade_surface(const Prepared *p, unsigned features, const ShadePoint *at, double weight,
                                   ShadeOnward *onward, RenderStatistics *statistics)
{
    *onward = (ShadeOnward){.through = rgb_grey(0.0), .reflectance = rgb_grey(0.0), .reflection_exponent = 1.0, .part = 1.0};
    if ((features & RENDER_TEXTURES) && (at->material & MATERIAL_COMPOUND)) {
        return shade_compound(p, at, weight, onward, statistics);
    }
    return shade_plain(p, features, at, onward, statistics);
}

// Finds what a ray hits; false when it meets nothing.
RT_ALWAYS_INLINE bool shade_find(const Prepared *p, unsigned features, const PendingRay *now, SampleStream *stream,
                                 ShadePoint *at)
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
    Surface surface = geometry_surface(p->geometry, features, now->ray, hit);
    Vec3 normal = hit.inside ? vec3_neg(surface.normal) : surface.normal;
    bool has_interiors = features & RENDER_INTERIORS;
    *at = (ShadePoint){.point = surface.point,
                       .normal = normal,
                       .outward = surface.normal,
                       .direction = now->ray.direction,
                       .shape = hit.shape,
                       .material = surface.material,
                       .order = surface.order,
                       .interior = has_interiors ? shade_interior(p, surface.material) : RECORD_NONE,
                       .ior_ratio = 1.0,
                       .way = has_interiors ? hit.t * p->textures.scale : 0.0,
                       .inside = hit.inside,
                       .stream = features & RENDER_LIGHTS ? stream : NULL};
    return true;
}

// Adds a ray's light to the sum that is open.
RT_ALWAYS_INLINE void pending_add(Pending *pending, const PendingRay *ray, Rgb light)
{
    Rgb *sum = &pending->sums[pending->open];
    *sum = rgb_add(*sum, rgb_mul(ray->share, light));
}

// What a ray sees that meets nothing.
RT_ALWAYS_INLINE Rgb shade_miss(const Prepared *p, unsigned features, Vec3 direction)
{
    return features & RENDER_SKY ? sky_light(p, direction) : p->background;
}

// Fog on the way of a ray that is inside of `before`: what it adds, which is returned, is added, and what lies behind it
// will be dimmed.
RT_ALWAYS_INLINE Rgb shade_fog(const Prepared *p, double way, const Inside *before, PendingRay *ray, Pending *pending)
{
    if (inside_is_solid(before)) {
        return rgb_grey(0.0);
    }
    FogShare fog = fog_between(p, &ray->ray, way);
    Rgb adds = rgb_mul(ray->share, fog.own);
    pending_add(pending, ray, fog.own);
    ray->share = rgb_mul(ray->share, fog.through);
    return adds;
}

// What one turn of a path found: the ray that was taken, what it hit, and what the hit sends on.
typedef struct ShadeStep {
    PendingRay ray;
    ShadePoint at;       // is_hit
    ShadeOnward onward;  // is_hit
    Inside before, behind; // is_hit, where there are interiors
    Rgb light;           // what the ray's share is multiplied with
    Rgb fog;             // what fog adds on the ray's way, where there may be some; ray.share is already less by it
    bool is_hit;
} ShadeStep;

RT_ALWAYS_INLINE void shade_path_begin(const Prepared *p, unsigned features, const PendingRay *first, Pending *pending)
{
    pending->count = 1;
    pending->open = 0;
    pending->rays[0] = *first;
    pending->sums[0] = rgb_grey(0.0);
    if (features & RENDER_INTERIORS) {
        if (p->camera.type != CAMERA_ORTHOGRAPHIC && p->camera.lens_radius == 0.0) {
            inside_copy(&pending->inside[0], &p->start);
        } else {
            prepared_inside(p, first->ray.origin, &pending->inside[0]);
        }
    }
}

// A hit where there may be bumps: one way on for each of the surface's normals.
RT_ALWAYS_INLINE void shade_ways(const Prepared *p, unsigned features, Pending *pending, RenderStatistics *statistics,
                                 ShadeStep *step)
{
    ShadeWays ways;
    if (step->at.material & MATERIAL_COMPOUND) {
        step->light = shade_bumpy(p, &step->at, step->ray.weight, &ways, statistics);
    } else {
        ways.count = 1;
        ways.normals[0] = step->at.normal;
        step->light = shade_surface(p, features, &step->at, step->ray.weight, &ways.onward[0], statistics);
    }
    pending_add(pending, &step->ray, step->light);
    step->onward = ways.onward[0];
    step->at.normal = ways.normals[0];
    int kept = 2 * (TRACE_LEVEL_MAX - step->ray.level) + 4; // for the levels to come
    for (int i = 0; i < ways.count && (i == 0 || pending->count + SHADE_WAY_RAYS + kept <= PENDING_MAX); i++) {
        ShadePoint at = step->at;
        at.normal = ways.normals[i];
        shade_go_on(p, features, &ways.onward[i], &at, &step->ray, &step->before, &step->behind, pending, statistics);
    }
}

// Takes the ray that was put on the list last: its light is added, and the rays that go on from where it hits are put on
// the list.
RT_ALWAYS_INLINE void shade_path_step(const Prepared *p, unsigned features, Pending *pending, SampleStream *stream,
                                      RenderStatistics *statistics, ShadeStep *step)
{
    PendingRay *now = &step->ray;
    *now = pending->rays[--pending->count];
    step->is_hit = false;
    step->fog = rgb_grey(0.0);
    if ((features & RENDER_EXPONENT) && now->opens) {
        pending->sums[++pending->open] = rgb_grey(0.0);
    }
    if ((features & RENDER_EXPONENT) && now->closes) {
        step->light = shade_rgb_power(pending->sums[pending->open--], now->exponent);
        pending_add(pending, now, step->light);
    } else if (shade_find(p, features, now, stream, &step->at)) {
        step->is_hit = true;
        if (features & RENDER_INTERIORS) {
            inside_copy(&step->before, &pending->inside[pending->count]);
            shade_cross(p, features, &step->at, &step->before, &step->behind);
        }
        if (features & RENDER_FOG) {
            step->fog = shade_fog(p, step->at.way, &step->before, now, pending);
        }
        if (features & RENDER_NORMALS) {
            shade_ways(p, features, pending, statistics, step);
            return;
        }
        // Its own light first: a reflected ray may open a sum of its own.
        step->light = shade_surface(p, features, &step->at, now->weight, &step->onward, statistics);
        pending_add(pending, now, step->light);
        shade_go_on(p, features, &step->onward, &step->at, now, &step->before, &step->behind, pending, statistics);
    } else {
        if (features & RENDER_FOG) {
            step->fog = shade_fog(p, (double)INFINITY, &pending->inside[pending->count], now, pending);
        }
        step->light = shade_miss(p, features, now->ray.direction);
        pending_add(pending, now, step->light);
    }
}

// The light that one camera ray brings back, where rays may go on.
RT_ALWAYS_INLINE Rgb shade_path(const Prepared *p, unsigned features, const PendingRay *first, SampleStream *stream,
                                RenderStatistics *statistics)
{
    Pending pending;
    shade_path_begin(p, features, first, &pending);
    while (pending.count > 0) {
        ShadeStep step;
        shade_path_step(p, features, &pending, stream, statistics, &step);
    }
    return pending.sums[0];
}

// The light that one camera ray brings back, which hits what `known` says.
RT_ALWAYS_INLINE Rgb shade_ray(const Prepared *p, unsigned features, Ray ray, const Hit *known, SampleStream *stream,
                               RenderStatistics *statistics)
{
    PendingRay first = {.ray = ray,
                        .start = RAY_START_CAMERA,
                        .share = rgb_grey(1.0),
                        .weight = 1.0,
                        .level = 1,
                        .known = known};
    if (features & (RENDER_REFLECTION | RENDER_TRANSPARENCY)) {
        return shade_path(p, features, &first, stream, statistics);
    }
    ShadePoint at;
    ShadeOnward onward;
    return shade_find(p, features, &first, stream, &at) ? shade_surface(p, features, &at, 1.0, &onward, statistics)
                                                        : shade_miss(p, features, ray.direction);
}

#endif
