// What is behind the scene, seen along camera rays: see alpha.h. Takes the kernels' own steps with all features on, in a
// scene without lights, and follows only what goes through.
//
// SPDX-License-Identifier: MIT
#include "render/sample/alpha.h"

#include "render/records/camera.h"
#include "render/sample/scratch.h"

typedef struct Behind {
    Rgb light;
    double clear;
} Behind;

static double share_of(double part, double whole)
{
    return whole != 0.0 ? part / whole : 0.0;
}

// What a ray that meets nothing sees of the clear part of what lies around the scene. Before version 3.7 all of it was
// clear.
static void meet_nothing(const Prepared *p, Vec3 direction, const AlphaThrough *through, Behind *behind)
{
    if (p->is_old) {
        behind->light = rgb_add(behind->light, rgb_mul(through->colour, sky_light(p, direction)));
        behind->clear += through->grey;
        return;
    }
    Rgbft background = p->scene->background;
    Rgb sky = sky_through(p, direction), colour = rgbft_rgb(background);
    Rgb light = rgb_mul(rgb_scale(background.filter + background.transmit, colour), rgb_mul(sky, through->colour));
    behind->light = rgb_add(behind->light, light);
    behind->clear += through->grey * rgb_luminance(rgb_mul(sky, texture_pigment_through(background)));
}

// Of the rays that a step put on the list, keeps those that go through. Their shares are as if the step's ray had one of
// 1 before the fog on its way. Fog, the shape left behind and the surface count each by its own grey.
static void keep_through(const Prepared *p, const ShadeStep *step, RayStack *stack, int place,
                         const AlphaThrough *before, AlphaThrough *through)
{
    int kept = place;
    Rgb fog = step->ray.share;
    Rgb fade = step->at.leaves ? shade_faded(p, step->at.interior, step->at.way) : rgb_grey(1.0);
    Rgb way = rgb_mul(fog, fade);
    double grey = before->grey * rgb_luminance(fog) * rgb_luminance(fade);
    for (int i = place; i < stack->count; i++) {
        StackedRay *ray = &stack->rays[i];
        if (ray->closes || ray->opens || ray->start.use == HIDDEN_MIRROR) {
            continue;
        }
        Rgb surface = rgb(share_of(ray->share.red, way.red), share_of(ray->share.green, way.green),
                          share_of(ray->share.blue, way.blue));
        through[kept].colour = rgb_mul(before->colour, ray->share);
        through[kept].grey = grey * rgb_luminance(surface);
        ray->share = rgb_grey(1.0);
        stack->rays[kept++] = *ray;
    }
    stack->count = kept;
}

static Behind follow(const Prepared *dark, Ray ray, RenderScratch *scratch)
{
    Behind behind = {rgb_grey(0.0), 0.0};
    AlphaThrough *through = scratch->through;
    RayStack *stack = &scratch->rays;
    RenderStatistics unused = {0};
    StackedRay first = {
        .ray = ray, .start = RAY_START_CAMERA, .share = rgb_grey(1.0), .weight = 1.0, .level = 1, .known = NULL};
    shade_path_begin(dark, SHADE_ALL_FEATURES, &first, stack);
    through[0] = (AlphaThrough){rgb_grey(1.0), 1.0};
    while (stack->count > 0) {
        ShadeStep step;
        int place = stack->count - 1;
        AlphaThrough before = through[place];
        shade_step_all(dark, stack, NULL, &unused, &step);
        if (step.is_hit) {
            keep_through(dark, &step, stack, place, &before, through);
        } else {
            Rgb fog = step.ray.share;
            AlphaThrough rest = {rgb_mul(before.colour, fog), before.grey * rgb_luminance(fog)};
            meet_nothing(dark, step.ray.ray.direction, &rest, &behind);
        }
    }
    return behind;
}

void alpha_part(const Prepared *p, const KernelCall *call, double *clear)
{
    Prepared dark = *p;
    dark.light_count = 0;
    dark.has_dome = false;
    for (uint64_t left = call->wanted; left; left &= left - 1) {
        int i = __builtin_ctzll(left);
        Ray ray;
        bool is_seen = camera_place_ray(&p->camera, call->places, i, &ray);
        Behind behind = is_seen ? follow(&dark, ray, call->scratch) : (Behind){rgb_grey(0.0), 1.0};
        call->light[i] = rgb_add_scaled(call->light[i], -1.0, behind.light);
        clear[i] = fmin(fmax(behind.clear, 0.0), 1.0);
    }
}
