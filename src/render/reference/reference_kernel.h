// The kernel of the reference path over a real type: what a ray that meets surfaces brings back.
//
// One ray at a time, shapes as in render/reference/reference_geometry.h, shading as in render/shade/shade_light.h and
// render/shade/shade_scatter.h. Finishes, lights and colours are read as doubles, which they are in the scene; all that
// a ray does is Real.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_REFERENCE_REFERENCE_KERNEL_H
#define RENDER_REFERENCE_REFERENCE_KERNEL_H

#include "render/records/medium.h"
#include "render/reference/reference_geometry.h"
#include "render/reference/reference_kernels.h"
#include "render/sample/scratch.h"

// What a ray carries on from where it was sent.
typedef struct RealWay {
    RealRay ray;
    RealStart start;
    RealRgb share;
    Real weight;
    int level;
    uint64_t passed;
} RealWay;

// ---- materials

static Rgbft study_pigment(const Prepared *p, MaterialIndex material, const PreparedFinish **finish)
{
    if (material & MATERIAL_COMPOUND) {
        const Texture *texture = &p->scene->textures.items[p->compounds[material & ~MATERIAL_COMPOUND].texture];
        *finish = &p->finishes[texture->finish];
        return pigment_colour(&texture->pigment);
    }
    *finish = &p->finishes[p->materials[material].finish];
    return material_pigment(&p->materials[material]);
}

static uint32_t study_interior(const Prepared *p, MaterialIndex material)
{
    return material & MATERIAL_COMPOUND ? p->compounds[material & ~MATERIAL_COMPOUND].interior : RECORD_NONE;
}

static RealRgb real_pigment_through(Rgbft pigment)
{
    RealRgb through = real_rgb_scale((Real)pigment.filter, real_rgb(rgbft_rgb(pigment)));
    return real_rgb_add(through, (Real)pigment.transmit, real_grey(1));
}

// As shade_faded, and on the way to a light as shade_shadow_crossed; `way` in prepared lengths.
static RealRgb real_faded(const RealScene *s, MaterialIndex material, Real way, bool is_shadow)
{
    uint32_t index = study_interior(s->p, material);
    const Interior *interior = index == RECORD_NONE ? NULL : &s->p->interiors[index];
    if (!interior || interior->fade_distance == 0.0 || (is_shadow && interior->fade_power == 0.0)) {
        return real_grey(1);
    }
    Real relative = way / s->inverse_scale / (Real)interior->fade_distance;
    RealRgb colour = real_rgb(interior->fade_colour);
    if (interior->fade_power >= 1000.0) {
        return (RealRgb){REAL_EXP((colour.red - 1) * relative), REAL_EXP((colour.green - 1) * relative),
                         REAL_EXP((colour.blue - 1) * relative)};
    }
    Real left = 1 / (1 + REAL_POW(relative, (Real)interior->fade_power));
    return real_rgb_add(colour, left, real_rgb_add(real_grey(1), -1, colour));
}

// ---- light

// A ray leaves what it has entered, and enters anything else, as in shade_cross; true when it leaves.
static bool real_cross(const RealScene *s, const RealHit *hit, MediumStack *inside)
{
    uint64_t body = scene_body_key(s->scene, hit->order, 0);
    bool leaves = medium_leave(s->media, inside, body);
    if (!leaves) {
        MediumRegion region = {body, study_interior(s->p, hit->material), false};
        *inside = medium_enter(s->media, *inside, region);
    }
    return leaves;
}

// As shade_caustics, of a surface without bumps.
static Real real_caustics(const RealScene *s, const RealHit *hit, RealVec towards)
{
    uint32_t index = study_interior(s->p, hit->material);
    double caustics = index == RECORD_NONE ? 0.0 : s->p->interiors[index].caustics;
    return caustics == 0.0 ? 1 : 1 + REAL_POW(REAL_FABS(real_dot(hit->normal, towards)), (Real)(45.0 * caustics));
}

static RealRgb real_visibility(const RealScene *s, const RealHit *at, MediumStack inside, RealVec towards,
                               Real distance, RenderStatistics *statistics)
{
    RealRgb share = real_grey(1);
    RealRay ray = {at->point, towards};
    RealStart start = {at->kind, at->index, true, real_dot(at->normal, towards) < 0};
    RealHit hit;
    uint32_t kept = s->media->count;
    statistics->shadow_rays++;
    for (uint64_t passed = 0; real_closest(s, &ray, start, distance, &hit); passed++) {
        const PreparedFinish *finish;
        real_surface(s, &ray, &hit);
        RealRgb through = real_pigment_through(study_pigment(s->p, hit.material, &finish));
        if (real_rgb_is_black(through) || passed > s->p->crossings_max) {
            share = real_grey(0);
            break;
        }
        share = real_rgb_scale(real_caustics(s, &hit, towards), real_rgb_mul(share, through));
        if (real_cross(s, &hit, &inside)) {
            share = real_rgb_mul(share, real_faded(s, hit.material, hit.t, true));
        }
        inside = medium_keep(s->media, kept, inside);
        ray.e = hit.point;
        distance -= hit.t;
        start = (RealStart){hit.kind, hit.index, true, !hit.inside};
    }
    s->media->count = kept;
    return share;
}

static RealRgb real_metallic(double metallic, RealRgb pigment, Real cosine)
{
    const Real k = (Real)112 / 100;
    const Real at_normal = 1 / (k * k), at_grazing = 1 / ((1 - k) * (1 - k));
    cosine = REAL_FABS(cosine);
    Real x = REAL_ACOS(cosine < 1 ? cosine : 1) / REAL_ACOS(0);
    Real fresnel = (1 / ((x - k) * (x - k)) - at_normal) / (at_grazing - at_normal);
    Real share = (Real)metallic * (1 - fresnel);
    return real_rgb_add(real_grey(1), share, real_rgb_add(pigment, -1, real_grey(1)));
}

static Real real_highlights(const PreparedFinish *finish, RealVec direction, RealVec normal, RealVec towards)
{
    Real sum = 0;
    if (finish->phong > 0.0) {
        RealVec mirrored = real_add_scaled(direction, -2 * real_dot(direction, normal), normal);
        Real cosine = real_dot(mirrored, towards);
        sum += cosine > 0 ? (Real)finish->phong * real_power(cosine, finish->phong_size) : 0;
    }
    if (finish->specular > 0.0) {
        RealVec halfway = real_sub(towards, direction);
        Real cosine = real_dot(halfway, normal) / real_length(halfway);
        sum += cosine > 0 ? (Real)finish->specular * real_power(cosine, finish->shininess) : 0;
    }
    return sum;
}

static Real real_opaque(const RealScene *s, Rgbft pigment)
{
    Real filtered = (Real)pigment.filter * (Real)(s->p->is_old ? rgb_max(rgbft_rgb(pigment)) : 1.0);
    return 1 - filtered - (Real)pigment.transmit;
}

// What one hit is to lights and to the rays that continue.
typedef struct RealJunction {
    RealHit at;
    RealVec normal; // turned to where the ray comes from
    const PreparedFinish *finish;
    Rgbft pigment;
    RealRgb reflectance;
    Real ior_ratio, fresnel_ratio;
    RealVec direction; // of the ray that found it
    MediumStack before, behind;
    bool leaves; // what the ray is in
} RealJunction;

static RealRgb real_light(const RealScene *s, const PreparedLight *light, const RealJunction *j,
                          RenderStatistics *statistics)
{
    const PreparedFinish *finish = j->finish;
    RealVec offset = real_sub(real_vec(light->position), j->at.point);
    Real distance = light->parallel ? real_dot(offset, real_vec(light->towards)) : real_length(offset);
    RealVec towards = light->parallel ? real_vec(light->towards) : real_scale(1 / distance, offset);
    Real cosine = real_dot(j->normal, towards);
    bool front = cosine > 0, back = cosine < 0 && finish->diffuse_back > 0.0;
    RealRgb arriving = real_rgb(light->colour), colour = real_rgb(rgbft_rgb(j->pigment));
    if (!front && !back) {
        return real_grey(0);
    }
    if (!light->shadowless && distance > 0) {
        RealRgb share = real_visibility(s, &j->at, j->before, towards, distance, statistics);
        if (real_rgb_is_black(share)) {
            return share;
        }
        arriving = real_rgb_mul(arriving, share);
    }
    Real opaque = real_opaque(s, j->pigment);
    Real falloff = real_power(REAL_FABS(cosine), finish->brilliance);
    RealRgb sum = real_rgb_scale(falloff * (Real)(back ? finish->diffuse_back : finish->diffuse) * opaque, colour);
    if (finish->shines && front && !light->shadowless) {
        Real shine = real_highlights(finish, j->direction, j->normal, towards);
        RealRgb tint = finish->metallic > 0.0 ? real_metallic(finish->metallic, colour, cosine) : real_grey(1);
        sum = real_rgb_add(sum, shine, tint);
    }
    return real_rgb_mul(sum, arriving);
}

// ---- rays that continue

static Real real_fresnel(Real cosine, Real ratio)
{
    Real square = ratio * ratio - 1 + cosine * cosine;
    if (!(square > 0)) {
        return 1;
    }
    Real g = REAL_SQRT(square);
    Real first = (g - cosine) / (g + cosine);
    Real second = (cosine * (g + cosine) - 1) / (cosine * (g - cosine) + 1);
    return first * first * (1 + second * second) / 2;
}

static RealRgb real_reflectance(const PreparedFinish *finish, RealRgb pigment, Real cosine, Real ior_ratio)
{
    Real away = 1 - cosine;
    Real grazing = finish->is_fresnel ? real_fresnel(cosine, ior_ratio)
                                      : real_power(away > 0 ? away : 0, finish->reflection_falloff);
    RealRgb least = real_rgb(finish->reflection_min);
    RealRgb span = real_rgb_add(real_rgb(finish->reflection_max), -1, least);
    RealRgb share = real_rgb_add(least, grazing, span);
    return finish->reflection_metallic > 0.0
               ? real_rgb_mul(share, real_metallic(finish->reflection_metallic, pigment, cosine))
               : share;
}

static bool real_bend(RealVec direction, RealVec normal, Real ratio, RealVec *bent)
{
    Real eta = 1 / ratio;
    Real cosine = -real_dot(direction, normal);
    Real square = 1 - eta * eta * (1 - cosine * cosine);
    if (!(square >= 0)) {
        return false;
    }
    *bent = real_unit(real_add_scaled(real_scale(eta, direction), eta * cosine - REAL_SQRT(square), normal));
    return true;
}

static RealVec real_mirrored(RealVec direction, RealVec normal)
{
    return real_unit(real_add_scaled(direction, -2 * real_dot(direction, normal), normal));
}

// A ray that is followed through all that it goes through. Where it is mirrored, the next level is that of the mirrored
// ray, whose light is added before this one continues.
typedef struct RealLevel {
    RealWay way;
    MediumStack inside;
    uint32_t kept; // nodes that the levels before this one keep
    bool goes_on;
    RealRgb sum;                // its light so far
    RealRgb share, reflectance; // of the last mirror, whose light is still to be added
    double exponent;
} RealLevel;
_Static_assert(sizeof(RealLevel) <= STUDY_LEVEL_BYTES, "levels have room in a thread's scratch");

// The level of the mirrored ray; false when it is not followed.
static bool real_reflected(const RealScene *s, const RealJunction *j, const RealLevel *now, RealLevel *mirrored)
{
    const RealWay *way = &now->way;
    Real most = j->finish->is_fresnel ? real_rgb_max(j->reflectance) : (Real)j->finish->reflection_weight;
    RealWay next = {
        .ray = {j->at.point, real_mirrored(way->ray.d, j->normal)},
        .start = {j->at.kind, j->at.index, true, j->at.inside},
        .share = real_grey(1),
        .weight = way->weight * most,
        .level = way->level + 1,
    };
    if (!j->finish->reflects || way->level >= s->p->max_trace_level || next.weight < (Real)s->p->adc_bailout ||
        prepared_is_abandoned(s->p)) {
        return false;
    }
    *mirrored = (RealLevel){
        .way = next, .inside = now->inside, .kept = s->media->count, .goes_on = true, .sum = real_grey(0)};
    return true;
}

// Adds the light of the mirrored ray.
static void real_reflect(RealLevel *now, RealRgb light)
{
    if (now->exponent != 1.0) {
        double exponent = 1.0 / now->exponent;
        light = (RealRgb){real_power(light.red, exponent), real_power(light.green, exponent),
                          real_power(light.blue, exponent)};
    }
    now->sum = real_rgb_add(now->sum, 1, real_rgb_mul(now->share, real_rgb_mul(now->reflectance, light)));
}

// Turns the ray into the one that goes through or is totally reflected; false when there is none, *is_total in the last
// case, which leaves no mirrored ray.
static bool real_secondary(const RealScene *s, const RealJunction *j, RealWay *way, MediumStack *inside, bool *is_total)
{
    RealRgb through = real_pigment_through(j->pigment);
    Real refraction = (Real)j->finish->refraction;
    RealRgb fade = j->leaves ? real_faded(s, j->at.material, j->at.t, false) : real_grey(1);
    RealVec direction = way->ray.d;
    *is_total = false;
    if (refraction == 0 || real_rgb_is_black(through)) {
        return false;
    }
    bool has_bend = j->ior_ratio != 1;
    *is_total = has_bend && !real_bend(way->ray.d, j->normal, j->ior_ratio, &direction);
    if (way->level >= s->p->max_trace_level) {
        return false;
    }
    Real weight = way->weight * real_rgb_max(through);
    if (j->finish->conserves_energy) {
        RealRgb left = real_rgb_add(real_grey(1), -1, j->reflectance);
        through = real_rgb_mul(through, left);
        weight *= real_rgb_max(left);
    }
    Real grey = (Real)0.297 * through.red + (Real)0.589 * through.green + (Real)0.114 * through.blue;
    if (weight < (Real)s->p->adc_bailout || grey < (Real)s->p->adc_bailout || way->passed >= s->p->crossings_max ||
        prepared_is_abandoned(s->p)) {
        return false;
    }
    way->weight = weight;
    if (*is_total) {
        way->share = real_rgb_mul(way->share, real_rgb_scale(refraction, fade));
        direction = real_mirrored(way->ray.d, j->normal);
    } else {
        way->share = real_rgb_mul(way->share, real_rgb_mul(real_rgb_scale(refraction, through), fade));
        *inside = j->behind;
    }
    way->ray = (RealRay){j->at.point, direction};
    way->start = (RealStart){j->at.kind, j->at.index, true, *is_total == j->at.inside};
    way->level += has_bend;
    way->passed = has_bend ? 0 : way->passed + 1;
    return true;
}

static void real_join(const RealScene *s, const RealWay *way, MediumStack inside, RealJunction *j)
{
    j->normal = real_scale(j->at.inside ? -1 : 1, j->at.normal);
    j->pigment = study_pigment(s->p, j->at.material, &j->finish);
    j->direction = way->ray.d;
    j->before = j->behind = inside;
    j->leaves = real_cross(s, &j->at, &j->behind);
    j->ior_ratio = (Real)medium_ior(s->p->interiors, s->media, j->behind) /
                   (Real)medium_ior(s->p->interiors, s->media, inside);
    FresnelSides sides = medium_fresnel_sides(s->p->interiors, s->media, inside, j->behind,
                                              study_interior(s->p, j->at.material), j->leaves);
    j->fresnel_ratio = (Real)sides.behind / (Real)sides.before;
    j->reflectance = real_grey(0);
    if (j->finish->reflects) {
        j->reflectance = real_reflectance(j->finish, real_rgb(rgbft_rgb(j->pigment)), -real_dot(j->normal, way->ray.d),
                                          j->fresnel_ratio);
    }
}

// Adds the light of the next surface that a level's ray meets, or of the background; true when `mirrored` is to be
// followed first.
static bool real_step(const RealScene *s, RealLevel *now, RealLevel *mirrored, RenderStatistics *statistics)
{
    RealWay *way = &now->way;
    RealJunction j;
    now->inside = medium_keep(s->media, now->kept, now->inside);
    if (!real_closest(s, &way->ray, way->start, (Real)HUGE_VAL, &j.at)) {
        now->sum = real_rgb_add(now->sum, 1, real_rgb_mul(way->share, real_rgb(s->p->background)));
        now->goes_on = false;
        return false;
    }
    real_surface(s, &way->ray, &j.at);
    real_join(s, way, now->inside, &j);
    Real opaque = real_opaque(s, j.pigment);
    RealRgb light = real_rgb_scale(opaque, real_rgb_mul(real_rgb(rgbft_rgb(j.pigment)), real_rgb(j.finish->glow)));
    for (size_t i = 0; i < s->p->light_count; i++) {
        RealRgb one = real_light(s, &s->p->lights[i], &j, statistics);
        light = real_rgb_add(light, 1, one);
    }
    now->sum = real_rgb_add(now->sum, 1, real_rgb_mul(way->share, light));
    RealWay next = *way;
    MediumStack scatter = now->inside;
    bool is_total;
    now->goes_on = real_secondary(s, &j, &next, &scatter, &is_total);
    bool is_mirrored = !is_total && real_reflected(s, &j, now, mirrored);
    now->share = way->share;
    now->reflectance = j.reflectance;
    now->exponent = j.finish->reflection_exponent;
    statistics->transmitted_rays += now->goes_on;
    statistics->reflected_rays += is_mirrored;
    *way = next;
    now->inside = scatter;
    return is_mirrored;
}

// The light that a ray brings back. No level is deeper than max_trace_level.
static RealRgb real_trace(const RealScene *s, RealWay way, MediumStack inside, RealLevel *levels,
                          RenderStatistics *statistics)
{
    int depth = 0;
    levels[0] =
        (RealLevel){.way = way, .inside = inside, .kept = s->media->count, .goes_on = true, .sum = real_grey(0)};
    while (depth > 0 || levels[0].goes_on) {
        if (!levels[depth].goes_on) {
            depth--;
            real_reflect(&levels[depth], levels[depth + 1].sum);
        } else if (real_step(s, &levels[depth], &levels[depth + 1], statistics)) {
            depth++;
        }
    }
    return levels[0].sum;
}

// ---- the camera

static Rgb real_colour(const Prepared *p, double u, double v, RenderScratch *scratch, RenderStatistics *statistics)
{
    const PreparedCamera *camera = &p->camera;
    RealScene s = {p, p->scene, (Real)1 / (Real)p->textures.scale, &scratch->rays.media};
    RealVec across = real_sub(real_scale((Real)u, real_vec(camera->right)), real_scale((Real)v, real_vec(camera->up)));
    bool is_parallel = camera->type == CAMERA_ORTHOGRAPHIC;
    RealVec location = real_vec(camera->location), direction = real_vec(camera->direction);
    RealWay way = {.share = real_grey(1), .weight = 1, .level = 1};
    way.ray.e = is_parallel ? real_add_scaled(location, 1, across) : location;
    way.ray.d = real_unit(is_parallel ? direction : real_add_scaled(direction, 1, across));
    Vec3 start = vec3((double)way.ray.e.x, (double)way.ray.e.y, (double)way.ray.e.z);
    MediumStack inside = prepared_start(p, start, s.media);
    statistics->camera_rays++;
    RealRgb light = real_trace(&s, way, inside, (RealLevel *)(void *)scratch->study_levels, statistics);
    return rgb((double)light.red, (double)light.green, (double)light.blue);
}

#endif
