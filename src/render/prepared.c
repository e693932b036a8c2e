// Prepares a scene for its kernel: one exact scale, geometry, reduced lights and materials, and the choice of the kernel.
//
// SPDX-License-Identifier: MIT
#include "render/prepared.h"

#include <limits.h>
#include <stdlib.h>

// ---- the exact scale

// Least and greatest binary exponent of the lengths that rays meet. Zero, infinite and NaN lengths do not count.
typedef struct ExponentRange {
    int least, greatest;
} ExponentRange;

static void range_add(ExponentRange *range, double length)
{
    if (length == 0.0 || !isfinite(length)) {
        return;
    }
    int exponent = ilogb(length);
    range->least = exponent < range->least ? exponent : range->least;
    range->greatest = exponent > range->greatest ? exponent : range->greatest;
}

static void range_add_row(ExponentRange *range, const double row[3])
{
    range_add(range, fmax(fabs(row[0]), fmax(fabs(row[1]), fabs(row[2]))));
}

// The exponent that puts the scene's lengths in the middle of the range of double: scaled by 2^-exponent, squares of the
// greatest and the least are as far from overflow as from underflow. A scene times 2^k has an exponent greater by k, so
// both become the same numbers. (The direction and screen of a perspective camera have no length that matters.)
static int scene_exponent(const Scene *scene)
{
    ExponentRange range = {INT_MAX, INT_MIN};
    for (size_t i = 0; i < scene->spheres.count; i++) {
        range_add(&range, vec3_max_abs(scene->spheres.items[i].centre));
        range_add(&range, scene->spheres.items[i].radius);
    }
    for (size_t i = 0; i < scene->ellipsoids.count; i++) {
        for (int row = 0; row < 4; row++) {
            range_add_row(&range, scene->ellipsoids.items[i].to_world.m[row]);
        }
    }
    for (size_t i = 0; i < scene->planes.count; i++) {
        range_add(&range, scene->planes.items[i].distance);
    }
    for (size_t i = 0; i < scene->lights.count; i++) {
        range_add(&range, vec3_max_abs(scene->lights.items[i].position));
    }
    range_add(&range, vec3_max_abs(scene->camera.location));
    if (range.least > range.greatest) {
        return 0;
    }
    int sum = range.least + range.greatest;
    return (sum - (sum < 0)) / 2; // rounded down, also below 0
}

static Vec3 vec3_ldexp(Vec3 a, int exponent)
{
    return vec3(ldexp(a.x, exponent), ldexp(a.y, exponent), ldexp(a.z, exponent));
}

// A unit vector along a, safe from overflow and underflow of its squares; zero stays zero.
static Vec3 unit(Vec3 a)
{
    double greatest = vec3_max_abs(a);
    if (greatest == 0.0 || !isfinite(greatest)) {
        return a;
    }
    return vec3_normalize(vec3_ldexp(a, -ilogb(greatest)));
}

// ---- camera, lights, materials

static PreparedCamera prepare_camera(const Camera *camera, int exponent)
{
    PreparedCamera out = {.type = camera->type, .location = vec3_ldexp(camera->location, -exponent)};
    if (camera->type == CAMERA_ORTHOGRAPHIC) {
        out.direction = unit(camera->direction);
        out.right = vec3_ldexp(camera->right, -exponent);
        out.up = vec3_ldexp(camera->up, -exponent);
        return out;
    }
    // Only ratios matter, so the three share a scale of their own.
    double greatest =
        fmax(vec3_max_abs(camera->direction), fmax(vec3_max_abs(camera->right), vec3_max_abs(camera->up)));
    int own = greatest > 0.0 && isfinite(greatest) ? ilogb(greatest) : 0;
    out.direction = vec3_ldexp(camera->direction, -own);
    out.right = vec3_ldexp(camera->right, -own);
    out.up = vec3_ldexp(camera->up, -own);
    return out;
}

static PreparedLight prepare_light(const Light *light, int exponent)
{
    PreparedLight out = {
        .parallel = light->type == LIGHT_PARALLEL,
        .shadowless = light->shadowless,
        .position = vec3_ldexp(light->position, -exponent),
        .colour = light->colour,
    };
    if (out.parallel) {
        out.towards = unit(vec3_sub(light->position, light->point_at));
    }
    return out;
}

static PreparedMaterial prepare_material(const Material *material, const Settings *settings)
{
    const Finish *finish = &material->finish;
    Rgbft pigment = material->pigment;
    Rgb colour = rgbft_rgb(pigment);
    Rgb opaque = rgb_scale(1.0 - pigment.filter - pigment.transmit, colour);
    PreparedMaterial out = {
        .glow = rgb_mul(opaque, rgb_add(rgb_mul(finish->ambient, settings->ambient_light), finish->emission)),
        .diffuse = rgb_scale(fmax(finish->diffuse, 0.0), opaque),
        .diffuse_back = rgb_scale(fmax(finish->diffuse_back, 0.0), opaque),
        .through = rgb_add(rgb_scale(pigment.filter, colour), rgb_grey(pigment.transmit)),
        .pigment = colour,
        .brilliance = finish->brilliance,
        .phong = finish->phong,
        .phong_size = finish->phong_size,
        .specular = finish->specular,
        .shininess = finish->roughness != 0.0 ? 1.0 / finish->roughness : 0.0,
        .metallic = finish->metallic,
        .reflection_min = finish->reflection_min,
        .reflection_max = finish->reflection_max,
        .reflection_falloff = finish->reflection_falloff,
        .reflection_exponent = finish->reflection_exponent,
        .reflection_metallic = finish->reflection_metallic,
        .reflection_weight = fmax(rgb_max(finish->reflection_min), rgb_max(finish->reflection_max)),
        .conserves_energy = finish->flags & FINISH_CONSERVE_ENERGY,
    };
    out.scatters = !rgb_is_black(out.diffuse);
    out.scatters_back = !rgb_is_black(out.diffuse_back);
    out.shines = finish->phong > 0.0 || finish->specular > 0.0;
    out.reflects = !rgb_is_black(out.reflection_min) || !rgb_is_black(out.reflection_max);
    out.lets_through = !rgb_is_black(out.through);
    return out;
}

// ---- features

static unsigned material_features(const PreparedMaterial *material)
{
    return (material->shines ? (unsigned)RENDER_HIGHLIGHTS : 0) |
           (material->scatters_back || (material->scatters && material->brilliance != 1.0) ? (unsigned)RENDER_BRILLIANCE
                                                                                           : 0) |
           (material->reflects ? (unsigned)RENDER_REFLECTION : 0) |
           (material->reflects && material->reflection_exponent != 1.0 ? (unsigned)RENDER_EXPONENT : 0) |
           (material->lets_through ? (unsigned)RENDER_TRANSPARENCY : 0);
}

static unsigned needed_features(const Prepared *p)
{
    unsigned features = geometry_features(p->geometry);
    for (size_t i = 0; i < p->light_count; i++) {
        features |= p->lights[i].shadowless ? 0 : (unsigned)RENDER_SHADOWS;
    }
    for (size_t i = 0; i < p->material_count; i++) {
        features |= material_features(&p->materials[i]);
    }
    return features;
}

// ---- the whole

static void prepare_lists(Prepared *p, const Scene *scene, int exponent)
{
    // A light that sends out nothing lights nothing.
    for (size_t i = 0; i < scene->lights.count; i++) {
        if (!rgb_is_black(scene->lights.items[i].colour)) {
            p->lights[p->light_count++] = prepare_light(&scene->lights.items[i], exponent);
        }
    }
    p->material_count = scene->materials.count;
    for (size_t i = 0; i < p->material_count; i++) {
        p->materials[i] = prepare_material(&scene->materials.items[i], &scene->settings);
    }
}

Prepared *prepared_new(const Scene *scene)
{
    Prepared *p = calloc(1, sizeof *p);
    if (!p) {
        return NULL;
    }
    int exponent = scene_exponent(scene);
    p->geometry = geometry_new(scene, exponent);
    p->lights = calloc(scene->lights.count + 1, sizeof *p->lights);
    p->materials = calloc(scene->materials.count + 1, sizeof *p->materials);
    if (!p->geometry || !p->lights || !p->materials) {
        prepared_free(p);
        return NULL;
    }
    p->camera = prepare_camera(&scene->camera, exponent);
    p->background = rgb_scale(1.0 - scene->background.transmit, rgbft_rgb(scene->background));
    p->max_trace_level = scene->settings.max_trace_level;
    p->adc_bailout = scene->settings.adc_bailout;
    p->crossings_max = 2 * (uint64_t)scene->shape_count;
    prepare_lists(p, scene, exponent);
    p->features = needed_features(p);
    p->kernel = kernel_choose(p->features);
    return p;
}

void prepared_free(Prepared *prepared)
{
    if (!prepared) {
        return;
    }
    geometry_free(prepared->geometry);
    free(prepared->lights);
    free(prepared->materials);
    free(prepared);
}

const char *prepared_kernel_name(const Prepared *prepared)
{
    return prepared->kernel->name;
}
