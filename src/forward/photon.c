// The way of a photon. The estimators: J. Arvo, "Backward ray tracing", 1986; E. Veach, "Robust Monte Carlo methods",
// 1997, chapter 8 (light tracing).
//
// A photon that leaves a light evenly into the solid angle S meets a surface at distance d and angle i to its normal
// with the density cos i / (S d²) on it; what it stands for is one over that. The light that a hit sends on is what the
// renderer's own lighting model gives for this light, so that fading, cones and highlights are the same.
//
// A value of the film is the mean light over the lens and over the pixel's part P of the plane in focus, at distance F.
// Light L that leaves x to a point q of the lens, at angles o to x's normal and a to the axis, adds L cos o / |xq|² for
// a unit of surface at x, times F² / (P cos³ a), which turns an angle at the lens into a part of that plane.
//
// SPDX-License-Identifier: MIT
#include "forward/photon.h"

#include <math.h>
#include <stdlib.h>

#include "render/records/camera.h"
#include "render/shade/shade.h"

static const double pi = 3.14159265358979323846;

// Sums of photons' shares are about as many as photons; 2^20 units each leave room for 2^43.
static const double UNIT = 0x1p20, MOST = 0x1p60;

enum { FEATURES = (unsigned)TRACE_ALL_FEATURES | ((unsigned)RENDER_ALL_FEATURES & ~(unsigned)RENDER_SHADOWS) };

bool photon_film_init(PhotonFilm *arrived, const Prepared *prepared, const Film *film)
{
    const PreparedCamera *camera = &prepared->camera;
    size_t values = (size_t)film->width * (size_t)film->height * 3;
    double reach = vec3_length(camera->direction);
    double distance = camera->lens_radius > 0.0 ? camera->focal_distance : reach;
    double side = distance / reach;
    double pixels = (double)film->whole_width * film->whole_height;
    *arrived = (PhotonFilm){
        .film = film,
        .axis = vec3_scale(1.0 / reach, camera->direction),
        .distance = distance,
        .pixel_area = side * side * vec3_length(camera->right) * vec3_length(camera->up) / pixels,
        .lens_area = pi * camera->lens_radius * camera->lens_radius,
    };
    arrived->sums[0] = calloc(values, sizeof *arrived->sums[0]);
    arrived->sums[1] = calloc(values, sizeof *arrived->sums[1]);
    if (!arrived->sums[0] || !arrived->sums[1]) {
        photon_film_fini(arrived);
        return false;
    }
    return true;
}

void photon_film_fini(PhotonFilm *film)
{
    free(film->sums[0]);
    free(film->sums[1]);
}

double photon_film_value(const PhotonFilm *film, unsigned half, size_t i)
{
    return (double)atomic_load_explicit(&film->sums[half][i], memory_order_relaxed) / UNIT;
}

static void add_value(atomic_int_least64_t *sum, double value)
{
    atomic_fetch_add_explicit(sum, (int_least64_t)llrint(fmax(fmin(value * UNIT, MOST), -MOST)), memory_order_relaxed);
}

// Light that comes to the point q of the lens against `direction`, which is of unit length: the pixel gets it.
static void film_add(PhotonFilm *film, const Prepared *prepared, Photon *photon, Vec3 q, Vec3 direction, Rgb light)
{
    const PreparedCamera *camera = &prepared->camera;
    double along = vec3_dot(direction, film->axis);
    Vec3 aside = vec3_sub(q, camera->location);
    Vec3 at = vec3_add_scaled(aside, film->distance / along, direction); // on the plane in focus
    double scale = vec3_length(camera->direction) / film->distance;
    double u = scale * vec3_dot(at, camera->right) / vec3_length_squared(camera->right) + 0.5;
    double v = 0.5 - scale * vec3_dot(at, camera->up) / vec3_length_squared(camera->up);
    double x = u * film->film->whole_width - film->film->left, y = v * film->film->whole_height - film->film->top;
    if (!(x >= 0.0 && x < film->film->width && y >= 0.0 && y < film->film->height)) {
        return;
    }
    size_t pixel = (size_t)y * (size_t)film->film->width + (size_t)x;
    light = rgb_scale(film->distance * film->distance / film->pixel_area, light);
    add_value(&film->sums[photon->half][3 * pixel], light.red);
    add_value(&film->sums[photon->half][3 * pixel + 1], light.green);
    add_value(&film->sums[photon->half][3 * pixel + 2], light.blue);
    photon->arrived++;
}

// Even over the sphere, or over the cap around `axis` whose cosine is above `least`.
static Vec3 cap_direction(SamplePoint at, Vec3 axis, double least)
{
    double along = 1.0 - at.x * (1.0 - least), across = sqrt(fmax(1.0 - along * along, 0.0));
    Vec3 other = fabs(axis.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    Vec3 u = vec3_normalize(vec3_cross(axis, other)), v = vec3_cross(axis, u);
    double angle = 2.0 * pi * at.y;
    return vec3_normalize(vec3_add(vec3_scale(along, axis),
                                   vec3_add(vec3_scale(across * cos(angle), u), vec3_scale(across * sin(angle), v))));
}

// A hit that light was scattered at, and the light as it arrived.
typedef struct Scattered {
    Surface surface;
    ShapeId shape;
    const PreparedLight *light;
    ShadeMaterial material;
    Vec3 lit_normal;   // towards the light
    double stands_for; // area, times the number of lights among which photons are shared
} Scattered;

// The light that goes from the hit along a direction of unit length, for all that the photon stands for.
static Rgb scattered_light(const Prepared *prepared, const Scattered *at, Vec3 direction)
{
    RenderStatistics unused = {0};
    bool inside = vec3_dot(at->surface.normal, direction) < 0.0;
    ShadingPoint point = {.point = at->surface.point,
                          .normal = inside ? vec3_neg(at->surface.normal) : at->surface.normal,
                          .outward = at->surface.normal,
                          .direction = vec3_neg(direction),
                          .shape = at->shape,
                          .ior_ratio = 1.0,
                          .inside = inside};
    return rgb_scale(at->stands_for, shade_light(prepared, FEATURES, &at->material, at->light, &point, &unused));
}

static void connect(const Prepared *prepared, Photon *photon, PhotonFilm *film, SampleStream *stream,
                    const Scattered *at)
{
    Vec3 q = camera_lens_point(&prepared->camera, sample_next(stream));
    Vec3 way = vec3_sub(q, at->surface.point);
    double distance = vec3_length(way);
    Vec3 direction = vec3_scale(1.0 / distance, way);
    double along = -vec3_dot(direction, film->axis), cosine = vec3_dot(at->surface.normal, direction);
    RayStart start = {at->shape, cosine < 0.0, 0};
    if (!(along > 0.0)) {
        return;
    }
    Rgb light = scattered_light(prepared, at, direction);
    if (rgb_is_black(light) ||
        geometry_occluded(prepared->geometry, FEATURES, (Ray){at->surface.point, direction}, start, distance)) {
        return;
    }
    light = rgb_scale(fabs(cosine) / (distance * distance * along * along * along), light);
    film_add(film, prepared, photon, q, vec3_neg(direction), light);
}

// Whether a ray passes the lens before `t_max`, and where.
static bool lens_passed(const Prepared *prepared, const PhotonFilm *film, Ray ray, double t_max, Vec3 *q)
{
    double along = -vec3_dot(ray.direction, film->axis);
    double t = vec3_dot(vec3_sub(ray.origin, prepared->camera.location), film->axis) / along;
    if (!(along > 0.0) || !(t > 0.0) || !(t < t_max)) {
        return false;
    }
    *q = ray_at(ray, t);
    double radius = prepared->camera.lens_radius;
    return vec3_length_squared(vec3_sub(*q, prepared->camera.location)) <= radius * radius;
}

// From the hit into a direction by chance, then over mirrors, until something passes the lens. Light that comes to the
// lens straight counts only if hits are not connected to it.
static void scatter(const Prepared *prepared, Photon *photon, PhotonFilm *film, SampleStream *stream,
                    const Scattered *at)
{
    SamplePoint chance = sample_next(stream);
    chance.x = 1.0 - sqrt(chance.x); // cap_direction then gives a density of cos / pi
    Ray ray = {at->surface.point, cap_direction(chance, at->lit_normal, 0.0)};
    RayStart start = {at->shape, vec3_dot(at->surface.normal, ray.direction) < 0.0, 0};
    Rgb light = rgb_scale(pi, scattered_light(prepared, at, ray.direction));
    double weight = 1.0;
    for (int level = 1; !rgb_is_black(light); level++) {
        Hit hit;
        Vec3 q;
        bool is_hit = geometry_closest(prepared->geometry, FEATURES, ray, start, (double)INFINITY, &hit);
        if ((level > 1 || !photon->connects) &&
            lens_passed(prepared, film, ray, is_hit ? hit.t : (double)INFINITY, &q)) {
            double along = -vec3_dot(ray.direction, film->axis);
            double share = 1.0 / (along * along * along * along * film->lens_area);
            film_add(film, prepared, photon, q, vec3_neg(ray.direction), rgb_scale(share, light));
        }
        if (!is_hit || level >= prepared->max_trace_level) {
            return;
        }
        Surface surface = geometry_surface(prepared->geometry, FEATURES, ray, hit);
        const Material *plain = &prepared->materials[surface.material];
        ShadeMaterial material = shade_material(prepared, FEATURES, material_pigment(plain), plain->finish);
        Vec3 normal = hit.inside ? vec3_neg(surface.normal) : surface.normal;
        weight *= material.finish->reflection_weight;
        if (!material.finish->reflects || weight < prepared->adc_bailout) {
            return;
        }
        light = rgb_mul(light, shade_reflectance(FEATURES, &material, -vec3_dot(normal, ray.direction), 1.0));
        ray = (Ray){surface.point, vec3_normalize(vec3_reflect(ray.direction, normal))};
        start = (RayStart){hit.shape, hit.inside, 0};
    }
}

void photon_trace(const Prepared *prepared, Photon *photon, PhotonFilm *film)
{
    SampleStream stream = {.kind = SAMPLER_RANDOM,
                           .index = (uint32_t)photon->number,
                           .seed = sampler_pixel_seed(photon->seed, (uint32_t)(photon->number >> 32), 0)};
    const PreparedLight *light = &prepared->lights[photon->number % prepared->light_count];
    Scattered at = {.light = light};
    Hit hit;
    bool is_spot = light->type == LIGHT_SPOT;
    double least = is_spot ? fmax(light->falloff, -1.0) : -1.0;
    Vec3 axis = is_spot ? vec3_neg(light->towards) : vec3(0.0, 0.0, 1.0), origin = light->position;
    SamplePoint chance = sample_next(&stream), place = sample_next(&stream);
    if (light->area.size1 > 0) {
        // The model's shadows come from all of the area, angles and cones from its middle: the latter are in the light.
        origin = vec3_add(origin, light_area_sample(light, origin, place));
        least = -1.0;
    }
    Ray ray = {origin, cap_direction(chance, axis, least)};
    if (!geometry_closest(prepared->geometry, FEATURES, ray, RAY_START_FREE, (double)INFINITY, &hit)) {
        return;
    }
    photon->met = 1;
    at.shape = hit.shape;
    at.surface = geometry_surface(prepared->geometry, FEATURES, ray, hit);
    at.lit_normal = hit.inside ? vec3_neg(at.surface.normal) : at.surface.normal;
    double cosine = -vec3_dot(at.lit_normal, ray.direction);
    if (!(cosine > 0.0)) {
        return;
    }
    const Material *plain = &prepared->materials[at.surface.material];
    at.material = shade_material(prepared, FEATURES, material_pigment(plain), plain->finish);
    at.stands_for = (double)prepared->light_count * 2.0 * pi * (1.0 - least) * hit.t * hit.t / cosine;
    if (photon->connects) {
        connect(prepared, photon, film, &stream, &at);
    }
    if (film->lens_area > 0.0 && (!photon->connects || (prepared->features & RENDER_REFLECTION))) {
        scatter(prepared, photon, film, &stream, &at);
    }
}
