// How a point of a surface shines: what reaches it of each light, and what its finish makes of that.
//
// Everything here is always-inline and takes the kernel's features as a constant. The lighting model is the scene
// language's, as its manual describes it and as measured against it; docs/language.md, "Lighting model", has the
// formulas. What is the same for some points at once stands in render/shade/lighting.inc.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_SHADE_LIGHT_H
#define RENDER_SHADE_SHADE_LIGHT_H

#include "base/attributes.h"
#include "math/extreme.h"
#include "render/records/kernel.h"
#include "render/records/medium.h"
#include "render/records/prepared.h"
#include "render/shade/inside.h"
#include "render/shade/light.h"
#include "render/shade/light_grid.h"
#include "render/surface/texture.h"
#include "trace/query_surface.h"

#include "math/lane_double.h"
#include "render/shade/lighting.inc"

// What reaches a point of the first lights: found once for all layers of what is seen there.
enum { SHADE_ARRIVED_MOST = 8 };
typedef struct ShadeArrived {
    uint32_t known; // a bit for each light
    Rgb share[SHADE_ARRIVED_MOST];
} ShadeArrived;

// A point being shaded. `normal` is turned towards the viewer, `outward` is the shape's own.
typedef struct ShadingPoint {
    Vec3 point, normal, outward;
    Vec3 direction; // of the ray that found it
    ShapeId shape;
    MaterialIndex material;
    uint32_t order;    // of the shape, in the order of declaration
    uint32_t body;     // likewise: Surface.body
    uint32_t interior; // of the shape
    double ior_ratio;  // index of refraction behind the surface over the one before it
    double way;        // of the ray that found it, in the scene's lengths; where there are interiors
    const Compound *lit; // what of it lights reach otherwise than usual; NULL: nothing
    bool inside;  // the ray met the surface from the side where the shape is
    bool leaves;  // what the ray is in; where there are interiors
    SampleStream *stream; // what area lights draw numbers from; NULL: they are grids; where there are such lights
    MediumTable *media;   // of what rays are inside of; NULL where there are no interiors
    MediumStack before;   // what the ray is inside of as it arrives; where there are
    double fresnel_ratio; // of indices of refraction, by medium_fresnel_sides; where there are
    ShadeArrived *arrived; // NULL: each layer asks for itself
} ShadingPoint;

// What a surface is made of at a point. "Opaque share" is 1 - filter - transmit, and in old scenes
// 1 less the greatest share of any colour that goes through.
typedef struct ShadeMaterial {
    Rgb pigment;
    Rgb opaque; // opaque share × pigment
    const PreparedFinish *finish;
    uint32_t layer; // of a surface of several textures: how many are asked for before this one
} ShadeMaterial;

RT_ALWAYS_INLINE ShadeMaterial shade_material(const Prepared *p, unsigned features, Rgbft pigment, FinishIndex finish)
{
    Rgb colour = rgbft_rgb(pigment);
    ShadeMaterial out = {colour, colour, &p->finishes[finish], 0};
    if (features & RENDER_TRANSPARENCY) {
        out.opaque = rgb_scale(texture_pigment_opaque(p->is_old, pigment), colour);
    }
    return out;
}

// Whether lights make anything of a surface; where they do not, none is evaluated. Of a clear one grain takes away what
// shines through it.
RT_ALWAYS_INLINE bool shade_takes_light(const PreparedFinish *finish, Rgb opaque)
{
    return finish->shines || ((finish->diffuse > 0.0 || finish->diffuse_back > 0.0) &&
                              (!rgb_is_black(opaque) || finish->crand > 0.0));
}

RT_ALWAYS_INLINE uint32_t shade_interior(const Prepared *p, MaterialIndex material)
{
    return material & MATERIAL_COMPOUND ? p->compounds[material & ~MATERIAL_COMPOUND].interior : RECORD_NONE;
}

// What a material looks like to a ray: from inside, where that goes along the normal, it may be another. In compound.c.
MaterialIndex shade_side(const Prepared *p, MaterialIndex material, Vec3 normal, Vec3 direction);

// The surface where a ray met something, as it looks to it.
RT_ALWAYS_INLINE Surface shade_surface_met(const Prepared *p, unsigned features, Ray ray, Hit hit)
{
    Surface surface = geometry_surface(p->geometry, features, ray, hit);
    if ((features & RENDER_TEXTURES) && RT_UNLIKELY(p->textures.has_sides)) {
        surface.material = shade_side(p, surface.material, surface.normal, ray.direction);
    }
    return surface;
}

// See ShadingPoint.lit.
RT_ALWAYS_INLINE const Compound *shade_lit(const Prepared *p, unsigned features, MaterialIndex material)
{
    bool is_apart = (features & RENDER_TEXTURES) && RT_UNLIKELY(p->textures.is_lit_apart);
    return is_apart && (material & MATERIAL_COMPOUND) ? &p->compounds[material & ~MATERIAL_COMPOUND] : NULL;
}

// What an interior leaves of light that comes out of it.
RT_ALWAYS_INLINE Rgb shade_faded(const Prepared *p, uint32_t interior, double way)
{
    return interior != RECORD_NONE && p->interiors[interior].fade_distance != 0.0
               ? inside_fade(&p->interiors[interior], way)
               : rgb_grey(1.0);
}

// The same on the way to a light, where a power of 0 leaves all, at a surface after a way t since the last one. As rays
// that are seen, this one enters what it is not inside of, from whichever side it comes. Measured.
RT_ALWAYS_INLINE Rgb shade_shadow_crossed(const Prepared *p, const Surface *surface, double t, MediumTable *media,
                                          MediumStack *inside)
{
    uint32_t interior = shade_interior(p, surface->material);
    uint64_t body = scene_body_key(p->scene, surface->order, surface->body);
    if (!medium_leave(media, inside, body)) {
        *inside = medium_enter(media, *inside, (MediumRegion){body, interior, false});
        return rgb_grey(1.0);
    }
    return interior != RECORD_NONE && p->interiors[interior].fade_power != 0.0
               ? shade_faded(p, interior, t * p->textures.scale)
               : rgb_grey(1.0);
}

// What a surface whose interior has caustics multiplies light with that goes through it, on the side that the light
// meets. In compound.c.
Rgb shade_caustics(const Prepared *p, const Surface *surface, ShapeId shape, Vec3 direction);
// The same of any other compound.
Rgb shade_layers_through(const Prepared *p, const Surface *surface, ShapeId shape, Vec3 direction);

// What a surface multiplies light with that goes through it in a direction.
RT_ALWAYS_INLINE Rgb shade_surface_through(const Prepared *p, unsigned features, const Surface *surface, ShapeId shape,
                                           Vec3 direction)
{
    if ((features & RENDER_TEXTURES) && (surface->material & MATERIAL_COMPOUND)) {
        const Compound *compound = &p->compounds[surface->material & ~MATERIAL_COMPOUND];
        if ((features & RENDER_INTERIORS) && compound->interior != RECORD_NONE &&
            p->interiors[compound->interior].caustics != 0.0) {
            return shade_caustics(p, surface, shape, direction);
        }
        return shade_layers_through(p, surface, shape, direction);
    }
    return texture_pigment_through(material_pigment(&p->materials[surface->material]));
}

// The same where it depends on neither place nor direction, nor on what light has gone through; false where it may.
RT_ALWAYS_INLINE bool shade_even_through(const Prepared *p, unsigned features, MaterialIndex material, Rgb *through)
{
    if (!(features & RENDER_TEXTURES) || !(material & MATERIAL_COMPOUND)) {
        *through = texture_pigment_through(material_pigment(&p->materials[material]));
        return true;
    }
    const Compound *compound = &p->compounds[material & ~MATERIAL_COMPOUND];
    const Texture *texture = texture_single(&p->textures, compound->texture);
    const Interior *interior = compound->interior != RECORD_NONE ? &p->interiors[compound->interior] : NULL;
    if (!texture || texture->pigment.pattern != RECORD_NONE ||
        (interior && (interior->caustics != 0.0 || interior->fade_power != 0.0))) {
        return false;
    }
    *through = texture_pigment_through(pigment_colour(&texture->pigment));
    return true;
}

// What some shapes on a way leave of light, if all of them are even; false where one is not.
RT_ALWAYS_INLINE bool shade_even_share(const Prepared *p, unsigned features, const ShapeId *shapes, int count,
                                       Rgb *share)
{
    *share = rgb_grey(1.0);
    for (int i = 0; i < count; i++) {
        Rgb through;
        if (!shade_even_through(p, features, geometry_material(p->geometry, features, shapes[i]), &through)) {
            return false;
        }
        if (rgb_is_black(through)) {
            *share = rgb_grey(0.0);
            return true;
        }
        *share = rgb_mul(*share, through);
    }
    return true;
}

// The share of light along a shadow ray where all that it crosses is found at once, and is even; false elsewhere.
RT_ALWAYS_INLINE bool shade_even_light(const Prepared *p, unsigned features, Ray ray, RayStart start, double t_max,
                                       Rgb *share)
{
    RayCrossings crossings;
    return geometry_ray_crossed(p->geometry, features, ray, start, t_max, &crossings) &&
           shade_even_share(p, features, crossings.shape, crossings.count, share);
}

// The share of light that arrives along a shadow ray, by colour: every surface on the way that lets light through
// multiplies it, the first that does not ends it. The shadow ray is inside of what the ray was that came to the point,
// and goes into bodies and out of them as that does. Measured.
RT_ALWAYS_INLINE Rgb shade_light_through(const Prepared *p, unsigned features, const ShadingPoint *at, Ray ray,
                                         RayStart start, double t_max)
{
    Rgb share;
    if (shade_even_light(p, features, ray, start, t_max, &share)) {
        return share;
    }
    share = rgb_grey(1.0);
    Hit hit;
    bool has_interiors = (features & RENDER_INTERIORS) && at->media;
    MediumStack inside = at->before;
    uint32_t kept = has_interiors ? at->media->count : 0;
    for (uint64_t passed = 0; geometry_closest(p->geometry, features, ray, start, t_max, &hit); passed++) {
        Surface surface = geometry_surface(p->geometry, features, ray, hit);
        Rgb through = shade_surface_through(p, features, &surface, hit.shape, ray.direction);
        if (rgb_is_black(through) || passed > p->crossings_max) {
            share = rgb_grey(0.0);
            break;
        }
        share = rgb_mul(share, through);
        if (has_interiors) {
            share = rgb_mul(share, shade_shadow_crossed(p, &surface, hit.t, at->media, &inside));
            inside = medium_keep(at->media, kept, inside);
        }
        ray.origin = surface.point;
        t_max -= hit.t;
        start = (RayStart){hit.shape, !hit.inside, HIDDEN_SHADOW};
    }
    if (has_interiors) {
        at->media->count = kept;
    }
    return share;
}

// The same, found by a ray from `end`, the light, to the point. In far_light.c.
Rgb shade_far_light(const Prepared *p, const ShadingPoint *at, Vec3 end, Vec3 towards, double distance);

// Whether that is better: of point and light the latter is nearer to the scene's middle, which is at 0, and the
// distance is so great that it matters.
RT_ALWAYS_INLINE bool shade_is_far(const Prepared *p, Vec3 point, Vec3 end, double distance)
{
    return RT_UNLIKELY(distance > p->near_light) && vec3_max_abs(point) > vec3_max_abs(end);
}

// The way from a point to a light.
typedef struct ShadeWay {
    Vec3 end, towards;
    double distance;
    bool has_end; // the light has a place
} ShadeWay;

RT_ALWAYS_INLINE ShadeWay shade_way(const PreparedLight *light, const LightAim *aim)
{
    return (ShadeWay){light->position, aim->towards, aim->distance, !light->parallel};
}

// The share of the light at the end of a way that reaches the point, by colour.
RT_ALWAYS_INLINE Rgb shade_visibility(const Prepared *p, unsigned features, const ShadingPoint *at, const ShadeWay *way,
                                      uint32_t *blocker, RenderStatistics *statistics)
{
    Ray ray = {at->point, way->towards};
    RayStart start = {at->shape, vec3_dot(at->outward, way->towards) < 0.0, HIDDEN_SHADOW};
    statistics->shadow_rays++;
    if (way->has_end && shade_is_far(p, at->point, way->end, way->distance)) {
        return shade_far_light(p, at, way->end, way->towards, way->distance);
    }
    if ((features & RENDER_TRANSPARENCY) && (p->features & RENDER_TRANSPARENCY)) {
        return shade_light_through(p, features, at, ray, start, way->distance);
    }
    return rgb_grey(geometry_occluded_again(p->geometry, features, ray, start, way->distance, blocker) ? 0.0 : 1.0);
}

// To what is `aside` from the area's middle.
RT_ALWAYS_INLINE ShadeWay shade_area_way(const ShadingPoint *at, const PreparedLight *light, Vec3 aside)
{
    Vec3 end = vec3_add(light->position, aside), offset = vec3_sub(end, at->point);
    double distance = vec3_length(offset);
    return (ShadeWay){end, vec3_scale(1.0 / distance, offset), distance, true};
}

// The mean over an area light, of which all would be `arriving`.
RT_ALWAYS_INLINE Rgb shade_area_grid(const Prepared *p, unsigned features, const ShadingPoint *at,
                                     const PreparedLight *light, Rgb arriving, RenderStatistics *statistics)
{
    LightGrid grid;
    uint32_t blocker = NO_BLOCKER;
    SurfaceSpot spot = {at->point, at->outward, at->shape};
    if (geometry_sees_ball(p->geometry, &spot, light->position, light->area_radius)) {
        return rgb_grey(1.0);
    }
    light_grid_begin(&grid, &light->area);
    while (grid.asked_count > 0) {
        ShadeWay ways[LIGHT_ASKED_MAX]; // found first: none waits for what another one meets
        for (int k = 0; k < grid.asked_count; k++) {
            Vec3 aside = light_area_offset(light, at->point, grid.asked[k].i, grid.asked[k].j);
            ways[k] = shade_area_way(at, light, aside);
        }
        for (int k = 0; k < grid.asked_count; k++) {
            grid.asked[k].share = shade_visibility(p, features, at, &ways[k], &blocker, statistics);
        }
        if (prepared_is_abandoned(p)) { // grids have up to 10^6 lights
            light_grid_end(&grid);
        } else {
            light_grid_next(&grid, arriving);
        }
    }
    return grid.sum;
}

// The same; or of one of its lights by chance, when the camera ray is one of many.
RT_ALWAYS_INLINE Rgb shade_area(const Prepared *p, unsigned features, const ShadingPoint *at,
                                const PreparedLight *light, Rgb arriving, RenderStatistics *statistics)
{
    if (at->stream) {
        uint32_t blocker = NO_BLOCKER;
        ShadeWay way = shade_area_way(at, light, light_area_sample(light, at->point, sample_next(at->stream)));
        return shade_visibility(p, features, at, &way, &blocker, statistics);
    }
    return shade_area_grid(p, features, at, light, arriving, statistics);
}

// What of a light reaches the point, by colour: all would be `arriving`. Where an area is drawn from by chance, each
// layer draws for itself.
RT_ALWAYS_INLINE Rgb shade_arrived(const Prepared *p, unsigned features, const PreparedLight *light,
                                   const ShadingPoint *at, const LightAim *aim, Rgb arriving,
                                   RenderStatistics *statistics)
{
    size_t number = (size_t)(light - p->lights);
    bool is_area = (features & RENDER_LIGHTS) && light->area.size1 > 0;
    bool is_kept = at->arrived && number < SHADE_ARRIVED_MOST && !(is_area && at->stream);
    if (is_kept && (at->arrived->known >> number & 1)) {
        return at->arrived->share[number];
    }
    uint32_t blocker = NO_BLOCKER;
    const ShadeWay way = shade_way(light, aim);
    Rgb share = is_area ? shade_area(p, features, at, light, arriving, statistics)
                        : shade_visibility(p, features, at, &way, &blocker, statistics);
    if (is_kept) {
        at->arrived->known |= UINT32_C(1) << number;
        at->arrived->share[number] = share;
    }
    return share;
}

// Phong and specular highlights of one light, in units of the light's colour. `cosine` = N·L > 0.
RT_ALWAYS_INLINE double shade_highlights(const PreparedFinish *finish, const ShadingPoint *at, Vec3 towards)
{
    double sum = 0.0;
    if (finish->phong > 0.0) {
        double cosine = phong_cosine(at->direction, at->normal, towards);
        if (cosine > 0.0) {
            sum += finish->phong * shade_power(cosine, finish->phong_size);
        }
    }
    if (finish->specular > 0.0) {
        double cosine = specular_cosine(at->direction, at->normal, towards);
        if (cosine > 0.0) {
            sum += finish->specular * shade_power(cosine, finish->shininess);
        }
    }
    return sum;
}

// The share of the pigment in a metallic highlight falls with the light's angle x (in right angles) to the normal as 1
// - F, F being the Fresnel curve of P. Strauss, "A Realistic Lighting Model for Computer Animators", IEEE CG&A 10(6),
// 1990: F(x) = (1 / (x - k)² - 1 / k²) / (1 / (1 - k)² - 1 / k²) with k = 1.12. Renderings agree with it to 1/65535. A
// normal with bumps may be turned away from the viewer: then F continues beyond 1 right angle, but not above 1.
RT_ALWAYS_INLINE Rgb shade_metallic(unsigned features, double metallic, Rgb pigment, double cosine)
{
    const double k = 1.12;
    const double at_normal = 1.0 / (k * k), at_grazing = 1.0 / ((1.0 - k) * (1.0 - k));
    bool is_bumpy = features & RENDER_NORMALS;
    double x =
        acos(is_bumpy ? greater_of(less_of(cosine, 1.0), -1.0) : less_of(fabs(cosine), 1.0)) * (2.0 / 3.14159265358979323846);
    double fresnel = (1.0 / ((x - k) * (x - k)) - at_normal) / (at_grazing - at_normal);
    fresnel = is_bumpy ? less_of(fresnel, 1.0) : fresnel;
    double share = metallic * (1.0 - fresnel);
    return rgb(1.0 + share * (pigment.red - 1.0), 1.0 + share * (pigment.green - 1.0),
               1.0 + share * (pigment.blue - 1.0));
}

// What is less by chance: the same at a point for any number of threads, and another number for each texture there.
RT_ALWAYS_INLINE double shade_grain(const PreparedLight *light, const ShadingPoint *at, uint32_t layer)
{
    enum { GRAIN = 1 << 20 }; // no light of an area has this number
    return 0.5 + light_random(light_key(light, at->point, GRAIN, GRAIN + (int)(layer % GRAIN)));
}

// Colours of a thin layer: light that goes through it once more is ahead by as much as the angles of light and viewer
// say. In shade_thin.c.
Rgb shade_thin_layer(const Prepared *p, const PreparedFinish *finish, const ShadingPoint *at, double cosine);

// Whether a light lights what the point is of.
RT_ALWAYS_INLINE bool shade_reaches(const Prepared *p, unsigned features, const ShadingPoint *at,
                                    const PreparedLight *light)
{
    if (!(features & RENDER_TEXTURES) || RT_LIKELY(!p->textures.is_lit_apart)) {
        return true;
    }
    uint32_t of_light = p->scene->lights.items[light->number].group, of_point = at->lit ? at->lit->light_group : 0;
    return of_light == of_point || (of_light == 0 && p->scene->light_groups.items[of_point - 1].has_others);
}

// What one light adds at a point: diffuse on the side it stands on, highlights on the viewer's side only.
RT_ALWAYS_INLINE Rgb shade_light(const Prepared *p, unsigned features, const ShadeMaterial *material,
                                 const PreparedLight *light, const ShadingPoint *at, RenderStatistics *statistics)
{
    const PreparedFinish *finish = material->finish;
    LightAim aim = light_aim(light, at->point, at->normal);
    double cosine = aim.cosine;
    bool is_double = (features & RENDER_TEXTURES) && at->lit && at->lit->is_double;
    bool front = cosine > 0.0 || is_double;
    bool back = !front && (features & RENDER_BRILLIANCE) && cosine < 0.0 && finish->diffuse_back > 0.0;
    if (!(front || back) || !shade_takes_light(finish, material->opaque)) {
        return rgb_grey(0.0);
    }
    Rgb arriving = light->colour;
    if ((features & RENDER_LIGHTS) && !light->is_plain) {
        double strength = light_strength(light, aim.offset, aim.distance);
        if (!(strength > 0.0)) {
            return rgb_grey(0.0);
        }
        arriving = rgb_scale(strength, arriving);
    }
    // Beyond the plane of a parallel light nothing throws a shadow.
    if ((features & RENDER_SHADOWS) && !light->shadowless && aim.distance > 0.0) {
        Rgb share = shade_arrived(p, features, light, at, &aim, arriving, statistics);
        if (rgb_is_black(share)) {
            return share;
        }
        arriving = rgb_mul(arriving, share);
    }
    double falloff = features & RENDER_BRILLIANCE ? shade_power(fabs(cosine), finish->brilliance)
                     : is_double                  ? fabs(cosine)
                                                  : cosine;
    double diffuse = back ? finish->diffuse_back : finish->diffuse;
    Rgb opaque = material->opaque;
    Rgb sum = rgb(lit_diffusely(falloff, diffuse, opaque.red), lit_diffusely(falloff, diffuse, opaque.green),
                  lit_diffusely(falloff, diffuse, opaque.blue));
    if ((features & RENDER_TEXTURES) && finish->crand > 0.0 && diffuse > 0.0) {
        sum = rgb_add_scaled(sum, -finish->crand * shade_grain(light, at, material->layer), material->pigment);
    }
    if ((features & RENDER_HIGHLIGHTS) && finish->shines && front && !light->shadowless) {
        double shine = shade_highlights(finish, at, aim.towards);
        Rgb tint = finish->metallic > 0.0 ? shade_metallic(features, finish->metallic, material->pigment, cosine)
                                            : rgb_grey(1.0);
        sum = rgb(lit_shiny(sum.red, shine, tint.red), lit_shiny(sum.green, shine, tint.green),
                  lit_shiny(sum.blue, shine, tint.blue));
    }
    if ((features & RENDER_TEXTURES) && finish->irid > 0.0) {
        sum = rgb_mul(sum, shade_thin_layer(p, finish, at, fabs(cosine)));
    }
    return rgb_mul(sum, arriving);
}

// The reflected share at an angle with cosine N·V.
RT_ALWAYS_INLINE Rgb shade_reflectance(unsigned features, const ShadeMaterial *material, double cosine,
                                       double ior_ratio)
{
    const PreparedFinish *finish = material->finish;
    if (finish->reflects_evenly) {
        return finish->reflection_min;
    }
    double grazing = (features & RENDER_INTERIORS) && finish->is_fresnel
                         ? inside_fresnel(features & RENDER_NORMALS ? greater_of(cosine, 0.0) : cosine, ior_ratio)
                         : shade_power(greater_of(1.0 - cosine, 0.0), finish->reflection_falloff);
    Rgb span = rgb_add_scaled(finish->reflection_max, -1.0, finish->reflection_min);
    Rgb share = rgb_add_scaled(finish->reflection_min, grazing, span);
    if (finish->reflection_metallic > 0.0) {
        share = rgb_mul(share, shade_metallic(features, finish->reflection_metallic, material->pigment, cosine));
    }
    return share;
}

#endif
