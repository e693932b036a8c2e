// Prepares a scene for its kernel: one exact scale, geometry, reduced lights and finishes, and the choice of the
// kernel.
//
// SPDX-License-Identifier: MIT
#include "render/records/prepared.h"

#include <stdatomic.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "render/kernels.h"
#include "render/points/sampler_many.h"
#include "render/render.h"
#include "render/shade/inside.h"
#include "render/shade/tile_light.h"
#include "scene/mesh.h"
#include "scene/primitive.h"
#include "scene/range.h"
#include "trace/elsewhere.h"
#include "trace/kept.h"

static const double radians_per_degree = 0x1.1df46a2529d39p-6; // pi / 180

// A unit vector along a, safe from overflow and underflow of its squares; zero stays zero.
static Vec3 unit(Vec3 a)
{
    double greatest = vec3_max_abs(a);
    if (greatest == 0.0 || !isfinite(greatest)) {
        return a;
    }
    return vec3_normalize(vec3_ldexp(a, -ilogb(greatest)));
}

// ---- surfaces

// How many surfaces of a primitive a line meets at most.
static uint64_t part_crossings_most(const Primitive *primitive)
{
    const PrimitiveClass *class = primitive_class(primitive->kind);
    if (class->is_mesh) {
        return (uint64_t)primitive->mesh.mesh->face_count + 8; // a field of heights has sides and water, too
    }
    if (primitive->kind == PRIMITIVE_ISOSURFACE || primitive->kind == PRIMITIVE_PARAMETRIC) {
        return (uint64_t)1 << 24; // its accuracy is no finer
    }
    Primitive member = *primitive;
    member.node = 0; // of one alone fewer are requested at a time
    return 2 * (uint64_t)primitive_interval_most(&member) + 1;
}

static uint64_t crossings_most(const Scene *scene)
{
    uint64_t most = 2 * (uint64_t)scene->shape_count;
    for (size_t i = 0; i < scene->primitives.count; i++) {
        most += part_crossings_most(&scene->primitives.items[i]);
    }
    return most;
}

// ---- camera, lights, finishes

static PreparedCamera prepare_camera(const Camera *camera, int exponent)
{
    PreparedCamera out = {.type = camera->type, .through = camera->type, .location = vec3_ldexp(camera->location, -exponent)};
    if (camera->type == CAMERA_ORTHOGRAPHIC) {
        out.direction = unit(camera->direction);
        out.right = vec3_ldexp(camera->right, -exponent);
        out.up = vec3_ldexp(camera->up, -exponent);
        return out;
    }
    if (camera->type != CAMERA_PERSPECTIVE) {
        out.direction = camera->direction;
        bool moves = camera_type_moves(camera->type);
        out.right = moves ? vec3_ldexp(camera->right, -exponent) : camera->right;
        out.up = moves ? vec3_ldexp(camera->up, -exponent) : camera->up;
        out.across = unit(camera->right);
        out.upright = unit(camera->up);
        out.ahead = unit(camera->direction);
        out.width = vec3_length(camera->right);
        out.height = vec3_length(camera->up);
        out.angle = camera->angle * radians_per_degree;
        out.angle_vertical = camera->angle_vertical * radians_per_degree;
        return out;
    }
    // Only ratios matter, so the three share a scale of their own.
    double greatest =
        fmax(vec3_max_abs(camera->direction), fmax(vec3_max_abs(camera->right), vec3_max_abs(camera->up)));
    int own = greatest > 0.0 && isfinite(greatest) ? ilogb(greatest) : 0;
    out.direction = vec3_ldexp(camera->direction, -own);
    out.right = vec3_ldexp(camera->right, -own);
    out.up = vec3_ldexp(camera->up, -own);
    out.lens_radius = ldexp(camera->lens_radius, -exponent);
    out.focal_distance = ldexp(camera->focal_distance, -exponent);
    out.focal_scale = out.focal_distance / vec3_length(out.direction);
    out.lens_right = vec3_scale(out.lens_radius, unit(camera->right));
    out.lens_up = vec3_scale(out.lens_radius, unit(camera->up));
    return out;
}

// How far from the middle a row of lights reaches, in lengths of its axis: POV-Ray's disc is a little aside, and jitter
// moves a light by half a step.
static double area_reach(const LightArea *area, int size)
{
    return (size > 1 ? 0.5 : 0.0) + (size > 1 && area->jitter ? 0.5 / (size - 1) : 0.0) + 0x1p-9;
}

static PreparedLight prepare_light(const Light *light, int exponent)
{
    PreparedLight out = {
        .parallel = light->type == LIGHT_PARALLEL || light->type == LIGHT_CYLINDER,
        .shadowless = light->shadowless,
        .is_plain = (light->type == LIGHT_POINT || light->type == LIGHT_PARALLEL) && light->fade_power == 0.0 &&
                    light->area.size1 == 0,
        .position = vec3_ldexp(light->position, -exponent),
        .colour = light->colour,
        .type = light->type,
        .tightness = light->tightness,
        .fade_distance = ldexp(light->fade_distance, -exponent),
        .fade_power = light->fade_power,
        .area = light->area,
    };
    if (light->type != LIGHT_POINT) {
        out.towards = unit(vec3_sub(light->position, light->point_at));
    }
    bool is_spot = light->type == LIGHT_SPOT;
    out.radius = is_spot ? cos(light->radius * radians_per_degree) : ldexp(light->radius, -exponent);
    out.falloff = is_spot ? cos(light->falloff * radians_per_degree) : ldexp(light->falloff, -exponent);
    out.area.axis1 = vec3_ldexp(light->area.axis1, -exponent);
    out.area.axis2 = vec3_ldexp(light->area.axis2, -exponent);
    Vec3 half1 = vec3_scale(area_reach(&out.area, out.area.size1), out.area.axis1);
    Vec3 half2 = vec3_scale(area_reach(&out.area, out.area.size2), out.area.axis2);
    out.area_radius = out.area.is_oriented
                          ? hypot(vec3_length(half1), vec3_length(half2))
                          : fmax(vec3_length(vec3_add(half1, half2)), vec3_length(vec3_sub(half1, half2)));
    return out;
}

static const double two_pi = 6.28318530717958647693;

static PreparedFinish prepare_finish(const Finish *finish, const Settings *settings)
{
    return (PreparedFinish){
        .glow = rgb_add(rgb_mul(finish->ambient, settings->ambient_light), finish->emission),
        .diffuse = fmax(finish->diffuse, 0.0),
        .diffuse_back = fmax(finish->diffuse_back, 0.0),
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
        .shines = finish->phong > 0.0 || finish->specular > 0.0,
        .reflects = !rgb_is_black(finish->reflection_min) || !rgb_is_black(finish->reflection_max),
        .reflects_evenly = rgb_is_black(rgb_add_scaled(finish->reflection_max, -1.0, finish->reflection_min)) &&
                           !(finish->reflection_metallic > 0.0),
        .refraction = finish->refraction,
        .crand = fmax(finish->crand, 0.0),
        .irid = fmax(finish->irid, 0.0),
        .irid_thickness = finish->irid_thickness,
        .irid_turbulence = finish->irid_turbulence,
        .irid_waves = rgb(two_pi / settings->irid_wavelength.red, two_pi / settings->irid_wavelength.green,
                          two_pi / settings->irid_wavelength.blue),
        .is_special = finish->crand > 0.0 || finish->irid > 0.0,
        .conserves_energy = finish->flags & FINISH_CONSERVE_ENERGY,
        .is_fresnel = finish->flags & FINISH_FRESNEL,
    };
}

// ---- features

static unsigned finish_features(const PreparedFinish *finish)
{
    bool is_lambertian = finish->diffuse_back == 0.0 && (finish->diffuse == 0.0 || finish->brilliance == 1.0);
    return (finish->shines ? (unsigned)RENDER_HIGHLIGHTS : 0) | (is_lambertian ? 0 : (unsigned)RENDER_BRILLIANCE) |
           (finish->is_special ? (unsigned)(RENDER_TEXTURES | RENDER_PIGMENTS) : 0) |
           (finish->reflects ? (unsigned)RENDER_REFLECTION : 0) |
           (finish->reflects && finish->is_fresnel ? (unsigned)RENDER_INTERIORS : 0) |
           (finish->reflects && finish->reflection_exponent != 1.0 ? (unsigned)RENDER_EXPONENT : 0);
}

// There may be as many materials as spheres: threads look for a clear one.
typedef struct MaterialSearch {
    const Scene *scene;
    atomic_bool has_clear;
} MaterialSearch;

static void search_some(void *client, size_t begin, size_t end)
{
    MaterialSearch *search = client;
    bool has_clear = atomic_load(&search->has_clear);
    for (size_t i = begin; i < end && !has_clear; i++) {
        const Material *material = &search->scene->materials.items[i];
        has_clear = material->filter != 0.0F || material->transmit != 0.0F;
    }
    if (has_clear) {
        atomic_store(&search->has_clear, true);
    }
}

static bool has_clear_material(const Scene *scene, int threads)
{
    MaterialSearch search = {.scene = scene};
    parallel_share(threads, scene->materials.count, SPHERE_RUN, search_some, &search);
    return atomic_load(&search.has_clear);
}

static unsigned pigments_features(const Scene *scene, const TextureTable *textures, int threads)
{
    if (texture_table_has_transparent_image(textures) || has_clear_material(scene, threads)) {
        return RENDER_TRANSPARENCY;
    }
    for (size_t i = 0; i < scene->pigment_entries.count; i++) {
        const Pigment *pigment = &scene->pigment_entries.items[i].pigment;
        if (pigment->filter != 0.0F || pigment->transmit != 0.0F) {
            return RENDER_TRANSPARENCY;
        }
    }
    for (size_t i = 0; i < scene->textures.count; i++) {
        const Pigment *pigment = &scene->textures.items[i].pigment;
        if (pigment->filter != 0.0F || pigment->transmit != 0.0F) {
            return RENDER_TRANSPARENCY;
        }
    }
    return 0;
}

// Of all others that are needed, `features`, only transparency matters.
static unsigned textures_features(const TextureTable *textures, unsigned features)
{
    const Scene *scene = textures->scene;
    bool is_single = !(features & RENDER_TRANSPARENCY);
    for (size_t i = 0; i < scene->compounds.count; i++) {
        is_single = is_single && texture_single(textures, scene->compounds.items[i].texture);
    }
    unsigned needed = (unsigned)RENDER_PIGMENTS | (is_single ? 0 : (unsigned)RENDER_TEXTURES);
    return scene->compounds.count > 0 ? needed : 0;
}

static unsigned needed_features(const Prepared *p, const Scene *scene, int threads)
{
    unsigned features = geometry_features(p->geometry) | pigments_features(scene, &p->textures, threads);
    for (size_t i = 0; i < p->light_count; i++) {
        features |= p->lights[i].shadowless ? 0 : (unsigned)RENDER_SHADOWS;
        features |= p->lights[i].is_plain ? 0 : (unsigned)RENDER_LIGHTS;
    }
    features |= p->has_dome ? (unsigned)(RENDER_SHADOWS | RENDER_LIGHTS) : 0;
    features |= textures_features(&p->textures, features);
    features |= scene->normals.count ? (unsigned)RENDER_NORMALS : 0;
    features |= scene->interiors.count ? (unsigned)RENDER_INTERIORS : 0;
    features |= scene->sky.count ? (unsigned)RENDER_SKY : 0;
    features |= scene_has_haze(scene) ? (unsigned)(RENDER_FOG | RENDER_INTERIORS) : 0;
    for (size_t i = 0; i < p->finish_count; i++) {
        features |= finish_features(&p->finishes[i]);
    }
    // Layers and maps may have several exponents at a point, each with a ray of its own, as bumps have.
    bool has_exponents = (features & RENDER_EXPONENT) && (features & RENDER_TEXTURES);
    features |= has_exponents ? (unsigned)RENDER_NORMALS : 0;
    return features;
}

// ---- the whole

static void prepare_lists(Prepared *p, const Scene *scene, int exponent)
{
    // A light that sends out nothing lights nothing.
    for (size_t i = 0; i < scene->lights.count; i++) {
        if (!rgb_is_black(scene->lights.items[i].colour)) {
            p->lights[p->light_count] = prepare_light(&scene->lights.items[i], exponent);
            p->lights[p->light_count++].number = i;
        }
    }
    p->dome = scene->settings.sky_light;
    p->has_dome = !rgb_is_black(p->dome);
    const Material *shared = geometry_materials(p->geometry);
    p->materials = shared ? shared : scene->materials.items;
    p->compounds = scene->compounds.items;
    p->interiors = scene->interiors.items;
    p->scene = scene;
    p->finish_count = scene->finishes.count;
    for (size_t i = 0; i < p->finish_count; i++) {
        p->finishes[i] = prepare_finish(&scene->finishes.items[i], &scene->settings);
    }
}

void prepared_seed(Prepared *prepared, uint64_t seed)
{
    prepared->seed = seed * UINT64_C(0x9e3779b97f4a7c15); // all bits of it count
    for (size_t i = 0; i < prepared->light_count; i++) {
        prepared->lights[i].seed = prepared->seed;
    }
}

Prepared *prepared_new(const Scene *scene, const GeometryOptions *options)
{
    Prepared *p = calloc(1, sizeof *p);
    if (!p) {
        return NULL;
    }
    SceneScale scale = scene_scale(scene, options->threads);
    int exponent = scale.exponent;
    p->abandon = calloc(1, sizeof *p->abandon);
    p->is_kept = options->kept != NULL;
    p->geometry = options->kept ? geometry_kept_take(options->kept, scene, exponent, options)
                                : geometry_new_with(scene, exponent, options);
    p->lights = calloc(scene->lights.count + 1, sizeof *p->lights);
    p->finishes = calloc(scene->finishes.count + 1, sizeof *p->finishes);
    if (!p->abandon || !p->geometry || !p->lights || !p->finishes ||
        !texture_table_init(&p->textures, scene, NULL, exponent, geometry_isa_name(p->geometry))) {
        prepared_free(p);
        return NULL;
    }
    geometry_set_abandon(p->geometry, p->abandon);
    p->length = ldexp(1.0, exponent);
    p->camera = prepare_camera(&scene->camera, exponent);
    if (scene->camera.bumps) {
        p->camera.type = CAMERA_BUMPY;
        p->camera.textures = &p->textures;
        p->camera.bumps = scene->camera.bumps - 1;
    }
    p->background = rgb_scale(1.0 - scene->background.transmit, rgbft_rgb(scene->background));
    p->is_old = scene->settings.version < 3.7;
    p->max_trace_level = scene->settings.max_trace_level;
    p->adc_bailout = scene->settings.adc_bailout;
    p->near_light = SHADOW_NEAR * ldexp(scale.least_size, -exponent);
    p->crossings_max = crossings_most(scene);
    prepare_lists(p, scene, exponent);
    if (!options->is_shared) { // such scenes have nothing in which it counts
        prepared_inside(p, p->camera.location, &p->start);
    }
    p->features = needed_features(p, scene, options->threads) |
                  (options->is_shared && options->has_clear ? (unsigned)RENDER_TRANSPARENCY : 0);
    p->kernel = kernel_choose(p->features);
    p->tile_lights = tile_lights_choose(geometry_isa_name(p->geometry));
    p->points = sobol_kernel_choose(geometry_isa_name(p->geometry));
    return p;
}

void prepared_want_alpha(Prepared *prepared)
{
    prepared->has_alpha = true;
    prepared->background = rgbft_rgb(prepared->scene->background);
}

void prepared_free(Prepared *prepared)
{
    if (!prepared) {
        return;
    }
    if (!prepared->is_kept) {
        geometry_free(prepared->geometry);
    } else if (prepared->geometry) {
        geometry_set_abandon(prepared->geometry, NULL);
    }
    free(prepared->abandon);
    free(prepared->lights);
    free(prepared->finishes);
    texture_table_fini(&prepared->textures);
    free(prepared);
}

unsigned prepared_features(const Prepared *prepared)
{
    return prepared->features;
}

size_t prepared_geometry_bytes(const Prepared *prepared)
{
    return geometry_bytes(prepared->geometry);
}

const char *prepared_kernel_name(const Prepared *prepared)
{
    return prepared->kernel->name;
}
