// Sky and fog; see sky.h.
//
// SPDX-License-Identifier: MIT
#include "math/extreme.h"
#include "render/shade/sky.h"

#include "render/shade/rainbow.h"

#include <math.h>

static const double half_pi = 1.57079632679489661923;

static Rgb layer_through(Rgbft layer)
{
    return rgb_add(rgb_scale(layer.filter, rgbft_rgb(layer)), rgb_grey(layer.transmit));
}

Rgb sky_through(const Prepared *p, Vec3 direction)
{
    Rgb through = rgb_grey(1.0);
    for (size_t i = 0; i < p->scene->sky.count; i++) {
        through = rgb_mul(through, layer_through(texture_pigment(&p->textures, &p->scene->sky.items[i], direction)));
    }
    return through;
}

// Before version 3.7 light came through all filters or through all clear shares, and only the background's was
// coloured.
Rgb sky_light(const Prepared *p, Vec3 direction)
{
    Rgb light = rgb_grey(0.0);
    Rgb above = rgb_grey(1.0), filtered = rgb_grey(1.0);
    double filtering = 1.0, clear = 1.0;
    bool old = p->is_old;
    if (p->scene->sky.count == 0) {
        return p->background;
    }
    for (size_t i = 0; i < p->scene->sky.count; i++) {
        Rgbft layer = texture_pigment(&p->textures, &p->scene->sky.items[i], direction);
        double opaque = 1.0 - layer.filter - layer.transmit;
        Rgb own = rgb_mul(rgb_scale(opaque, rgbft_rgb(layer)), p->scene->sky_emission);
        Rgb filter = rgb_scale(layer.filter, rgbft_rgb(layer));
        light = rgb_add(light, rgb_mul(old ? rgb_grey(i ? filtering + clear : 1.0) : above, own));
        above = rgb_mul(above, layer_through(layer));
        filtered = rgb_mul(filtered, filter);
        filtering *= layer.filter;
        clear *= layer.transmit;
    }
    return rgb_add(light, rgb_mul(old ? rgb_add(filtered, rgb_grey(clear)) : above, p->background));
}

// ---- fog

// The mean density between two heights above the fog's offset, both >= 0, of 1 / (1 + (h / alt)²).
// atan(b / alt) - atan(a / alt) is computed as one angle, so that heights may be close.
static double mean_density(double alt, double a, double b)
{
    double rise = b - a;
    if (rise == 0.0) {
        return 1.0 / (1.0 + (a / alt) * (a / alt));
    }
    return alt * atan2(fabs(rise) * alt, alt * alt + a * b) / fabs(rise);
}

// Of a way that leads up for ever.
static double endless_depth(double alt, double slope, double from)
{
    double below = greater_of(-from, 0.0), above = greater_of(from, 0.0);
    return (below + alt * (half_pi - atan(above / alt))) / slope;
}

// The length of a way of the same loss in a fog that is everywhere; `from` is its first height above the offset.
static double ground_depth(double alt, double slope, double from, double way)
{
    if (isinf(way)) {
        return slope > 0.0 ? endless_depth(alt, slope, from) : INFINITY;
    }
    double to = from + slope * way;
    if (from <= 0.0 && to <= 0.0) {
        return way;
    }
    if (from >= 0.0 && to >= 0.0) {
        return way * mean_density(alt, from, to);
    }
    double low = less_of(from, to), high = greater_of(from, to);
    return (-low + alt * atan(high / alt)) / fabs(slope);
}

static double fog_depth(const Prepared *p, const Fog *fog, const Ray *ray, double way)
{
    if (!fog->is_ground) {
        return way;
    }
    double height = vec3_dot(ray->origin, fog->up) * p->textures.scale;
    return ground_depth(fog->alt, vec3_dot(ray->direction, fog->up), height - fog->offset, way);
}

// How much of the fog's depth turbulence takes away: the more the shorter the way. Measured.
static double turbulent_share(const Prepared *p, const Fog *fog, const Ray *ray, double way)
{
    Octaves octaves = {fog->lambda, fog->omega, (unsigned)fog->octaves};
    Vec3 start = vec3_sub(vec3_scale(p->textures.scale, ray->origin), fog->origin);
    Vec3 middle = vec3_add_scaled(start, way / 2.0, ray->direction);
    double sum =
        noise_sum(p->textures.source.noise, p->textures.source.generator, &octaves, vec3_mul(fog->turbulence, middle));
    return exp(-way / fog->distance) * less_of(fog->turb_depth * sum, 1.0);
}

static double loss_depth(const Prepared *p, const Fog *fog, const Ray *ray, double way)
{
    double depth = fog_depth(p, fog, ray, way);
    return fog->is_turbulent && !isinf(way) ? depth * (1.0 - turbulent_share(p, fog, ray, way)) : depth;
}

FogShare fog_between(const Prepared *p, const Ray *ray, double way)
{
    FogShare sum = {rgb_grey(1.0), rgb_grey(0.0)};
    for (size_t i = 0; i < p->scene->fogs.count; i++) {
        const Fog *fog = &p->scene->fogs.items[i];
        Rgb colour = rgbft_rgb(fog->colour);
        double left = greater_of(exp(-loss_depth(p, fog, ray, way) / fog->distance), fog->colour.transmit);
        Rgb tint = rgb_add(rgb_grey(1.0 - fog->colour.filter), rgb_scale(fog->colour.filter, colour));
        sum.through = rgb_mul(sum.through, rgb_scale(left, tint));
        sum.own = rgb_add_scaled(sum.own, 1.0 - left, colour);
    }
    if (p->scene->rainbows.count > 0) {
        FogShare behind = rainbow_between(p, ray, way);
        sum.own = rgb_add(sum.own, rgb_mul(sum.through, behind.own));
        sum.through = rgb_mul(sum.through, behind.through);
    }
    return sum;
}
