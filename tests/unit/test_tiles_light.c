// Rays by the tile: the light of surfaces is that of single rays, bit for bit, with any instruction set.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/kernels.h"
#include "render/records/prepared.h"
#include "render/render.h"
#include "render/shade/tile_light.h"
#include "unit/random.h"
#include "unit/tap.h"
#include "unit/trace_scenes.h"

static double one_of(Random *random, const double *values, size_t count)
{
    return values[random_bits(random) % count];
}

static Finish random_finish(Random *random)
{
    static const double amounts[] = {0, 0, 0.3, 1.2}, exponents[] = {1, 1, 2, 40, 0.5, 7.25, 5000}, levels[] = {0, 0.1};
    double glow = one_of(random, levels, 2), mirror = random_bits(random) % 3 ? 0.0 : 0.4;
    Finish finish = {.ambient = {glow, 0.1, glow},
                     .reflection_min = {mirror, 0.5 * mirror, mirror},
                     .reflection_max = {mirror, mirror, mirror},
                     .reflection_falloff = 1.0,
                     .reflection_exponent = 1.0};
    finish.flags = random_bits(random) % 4 ? 0 : FINISH_CONSERVE_ENERGY;
    finish.diffuse = one_of(random, amounts, 4);
    finish.diffuse_back = one_of(random, amounts, 4);
    finish.brilliance = one_of(random, exponents, 6);
    finish.phong = one_of(random, amounts, 4);
    finish.phong_size = one_of(random, exponents, 7);
    finish.specular = one_of(random, amounts, 4);
    finish.roughness = 1.0 / one_of(random, exponents, 7);
    finish.metallic = one_of(random, amounts, 4);
    finish.refraction = random_bits(random) % 4 ? 1.0 : 0.8;
    return finish;
}

// kinds > 1: of any kind, else points and parallel ones.
static void random_light(Random *random, int kinds, Scene *scene)
{
    Light light = {.point_at = {0, 0, 0}, .colour = {0.9, random_between(random, -0.2, 1), 0.7}};
    light.type = random_bits(random) % 4 ? LIGHT_POINT : LIGHT_PARALLEL;
    light.shadowless = random_bits(random) % 5 == 0;
    light.position = random_point(random, random_bits(random) % 2 ? 5 : 40);
    uint64_t kind = random_bits(random);
    if (kinds > 1 && kind % 4 == 0) {
        light.type = kind & 16 ? LIGHT_SPOT : LIGHT_CYLINDER;
        light.radius = light.type == LIGHT_SPOT ? 10 : 2;
        light.falloff = light.type == LIGHT_SPOT ? 25 : 5;
        light.tightness = kind & 32 ? 3.5 : 0;
    }
    if (kinds > 1 && kind % 3 == 0) {
        light.fade_distance = 6;
        light.fade_power = kind & 64 ? 2 : 1.5;
    }
    if (kinds > 1 && kind % 2 == 0) {
        double size = random_between(random, 0, 6);
        Vec3 axis1 = vec3_scale(size, random_direction(random));
        Vec3 axis2 = vec3_scale(size, random_direction(random));
        light.area = (LightArea){.axis1 = axis1,
                                 .axis2 = axis2,
                                 .size1 = kind & 128 ? 5 : 2,
                                 .size2 = kind & 256 ? 3 : 1,
                                 .adaptive = 1,
                                 .circular = kind & 512,
                                 .jitter = kind & 1024,
                                 .is_adaptive = kind & 2048,
                                 .is_oriented = kind & 4096};
        if (light.area.is_oriented) { // as the evaluator makes them
            light.area.circular = true;
            light.area.size2 = 3;
            light.area.axis2 = vec3_scale(vec3_length(light.area.axis1), random_direction(random));
        }
    }
    if (!scene_add_light(scene, &light)) {
        abort();
    }
}

// A checkered material, whose one layer may stand on another that is not seen.
static bool add_checkered(Scene *scene, Random *random, const Finish *finish, bool is_doubled, MaterialIndex *material)
{
    uint32_t last, first = RECORD_NONE, pattern = RECORD_NONE, below = RECORD_NONE, texture = RECORD_NONE;
    PigmentEntry entry = {.at = 1.0, .pigment = pigment_of((Rgbft){0.1, 0.9, 0.3, 0, 0}), .next = RECORD_NONE};
    bool is_fine = scene_add_pigment_entry(scene, &entry, &last);
    entry = (PigmentEntry){.pigment = pigment_of((Rgbft){random_between(random, 0, 1), 0.2, 0.7, 0, 0}), .next = last};
    is_fine = is_fine && scene_add_pigment_entry(scene, &entry, &first);
    PatternedPigment checker = {
        .to_world = transform_identity(), .pattern = {.type = PATTERN_CHECKER}, .entries = first};
    checker.to_world.m[3][0] = random_between(random, 0, 1);
    is_fine = is_fine && scene_add_pattern(scene, &checker, &pattern);
    Texture top = {.to_world = transform_identity(), .entries = RECORD_NONE, .below = RECORD_NONE, .normal = RECORD_NONE};
    top.pigment.pattern = RECORD_NONE;
    is_fine = is_fine && scene_add_finish(scene, finish, &top.finish) &&
              (!is_doubled || scene_add_texture(scene, &top, &below));
    top.pigment.pattern = pattern;
    top.below = below;
    is_fine = is_fine && scene_add_texture(scene, &top, &texture);
    Compound compound = {.texture = texture, .interior = RECORD_NONE, .inner = RECORD_NONE};
    return is_fine && scene_add_compound(scene, &compound, material);
}

// A clear layer by itself, around something that bends light, dims it or gathers it.
static bool add_glass(Scene *scene, Random *random, Rgbft pigment, const Finish *finish, MaterialIndex *material)
{
    static const double iors[] = {1, 1.05, 1.5, 0.8}, powers[] = {0, 0, 2, 1001};
    Texture texture = {.to_world = transform_identity(), .entries = RECORD_NONE, .below = RECORD_NONE,
                       .normal = RECORD_NONE, .pigment = pigment_of(pigment)};
    Interior interior = {.ior = one_of(random, iors, 4), .fade_colour = {0.3, 0.9, 0.5}};
    interior.fade_distance = random_bits(random) % 2 ? 3.0 : 0.0;
    interior.fade_power = one_of(random, powers, 4);
    interior.caustics = random_bits(random) % 4 ? 0.0 : 0.5;
    Compound compound = {.interior = RECORD_NONE, .inner = RECORD_NONE};
    bool is_fine = scene_add_finish(scene, finish, &texture.finish) &&
                   scene_add_texture(scene, &texture, &compound.texture) &&
                   (random_bits(random) % 4 == 0 || scene_add_interior(scene, &interior, &compound.interior));
    return is_fine && scene_add_compound(scene, &compound, material);
}

// What a scene may have beside spheres of plain colours, planes and point lights.
typedef struct Extras {
    bool any_lights, patterns, doubled; // the last: of layers
    bool clear;                         // some surfaces let light through
    bool glass;                         // some have an interior, too
} Extras;

// What a pigment lets through: mostly something.
static void random_clearness(Random *random, Rgbft *pigment)
{
    static const double amounts[] = {0, 0, 0.3, 0.9};
    pigment->filter = one_of(random, amounts, 4);
    pigment->transmit = one_of(random, amounts, 4);
}

// Spheres of few finishes, some of them touching the eye's surroundings, lights, planes.
static void random_scene(Random *random, const Extras *extras, Scene *scene)
{
    Finish finishes[4];
    static const int counts[] = {6, 20, 60};
    int count = counts[random_bits(random) % 3];
    scene_init(scene);
    if (extras->clear) {
        scene->settings.max_trace_level = 1 + (int)(random_bits(random) % 8); // shells that mirror double the rays
        scene->settings.adc_bailout = random_bits(random) % 2 ? 1.0 / 255 : 0.02;
        scene->settings.version = random_bits(random) % 4 ? 3.7 : 3.6;
    }
    for (int i = 0; i < 4; i++) {
        finishes[i] = random_finish(random);
        finishes[i].flags |= extras->glass && random_bits(random) % 4 == 0 ? FINISH_FRESNEL : 0;
    }
    for (int i = 0; i < count; i++) {
        MaterialIndex material;
        Rgbft pigment = {random_between(random, -0.1, 1), 0.5, 0, 0, 0};
        pigment.blue = random_between(random, 0, 1);
        const Finish *finish = &finishes[random_bits(random) % 4];
        if (extras->clear) {
            random_clearness(random, &pigment);
        }
        bool is_added = extras->glass && random_bits(random) % 4
                            ? add_glass(scene, random, pigment, finish, &material)
                        : extras->patterns && random_bits(random) % 2
                            ? add_checkered(scene, random, finish, extras->doubled, &material)
                            : scene_add_material(scene, pigment, finish, &material);
        Vec3 place = extras->clear && i % 2 ? (Vec3){0.0, 0.0, 0.0} : random_point(random, 5); // shells
        if (!is_added || (i % 9 == 5 ? !scene_add_plane(scene, random_direction(random), -6, material, 0)
                                     : !scene_add_sphere(scene, place, random_between(random, 0.2, 2), material, 0))) {
            abort();
        }
    }
    if (extras->any_lights && random_bits(random) % 3 == 0) {
        scene->settings.sky_light = rgb(0.9, random_between(random, 0, 1), 0.4);
    }
    for (uint64_t i = random_bits(random) % 4; i-- > 0;) {
        random_light(random, extras->any_lights ? 2 : 1, scene);
    }
    scene->camera = (Camera){.type = CAMERA_PERSPECTIVE,
                             .location = {0.0, 0.0, -9.0},
                             .direction = {0.0, 0.0, 1.0},
                             .right = {1.33, 0.0, 0.0},
                             .up = {0.0, 1.0, 0.0}};
    scene->has_camera = true;
    scene->background = (Rgbft){0.1, 0.2, 0.3, 0.0, 0.0};
}

// `by_rays`: each surface by itself, where the kernel traces ray by ray.
static Film picture(const Scene *scene, const char *isa, unsigned features, bool by_rays,
                    const SamplingOptions *sampling, RenderStatistics *statistics)
{
    Film film;
    SamplingError error;
    Prepared *prepared = prepared_new(scene, &(GeometryOptions){.threads = 1, .isa = isa});
    RenderOptions options = {.threads = 1, .sampling = sampling};
    if (!prepared || !film_init(&film, 45, 31, 0)) {
        abort();
    }
    prepared->kernel = kernel_choose(features | prepared->features);
    prepared->is_by_rays = by_rays;
    if (render_film(prepared, &options, &film, statistics, &error) != RENDER_OK) {
        abort();
    }
    prepared_free(prepared);
    return film;
}

static bool films_differ(const Film *a, const Film *b)
{
    return memcmp(a->rgb, b->rgb, 3 * sizeof(float) * (size_t)a->width * (size_t)a->height) != 0;
}

// A kernel of all shapes shades ray by ray, and walks from one crossing to the next. It shades first surfaces together
// that are plain, unless it is not to.
static void test_light(uint64_t first, const Extras *extras, const SamplingOptions *sampling)
{
    int different = 0, pictures = 0;
    uint64_t shadow_rays = 0, reflected_rays = 0, transmitted_rays = 0;
    for (uint64_t seed = first; seed < first + (extras->clear ? 20 : 60); seed++) {
        Random random = {seed};
        Scene scene;
        RenderStatistics single, tiled;
        random_scene(&random, extras, &scene);
        const unsigned all = RENDER_NORMALS | TRACE_PRIMITIVES;
        Film expected = picture(&scene, NULL, all, true, sampling, &single);
        for (size_t i = 0; geometry_isa(i / 2); i++, pictures++) {
            Film film = picture(&scene, geometry_isa(i / 2), i % 2 ? all : 0, false, sampling, &tiled);
            different += films_differ(&film, &expected) || memcmp(&single, &tiled, sizeof single) != 0;
            film_fini(&film);
        }
        shadow_rays += single.shadow_rays;
        reflected_rays += single.reflected_rays;
        transmitted_rays += single.transmitted_rays;
        film_fini(&expected);
        scene_fini(&scene);
    }
    // How many rays twenty scenes have varies with the seed by five times: these only show that there are such at all.
    bool has_rays = shadow_rays > 3000 && reflected_rays > 1000 &&
                    (extras->clear ? transmitted_rays > 3000 : transmitted_rays == 0);
    tap_ok(different == 0 && has_rays,
           "light by tiles is light by rays, %s, %s, %s: %d of %d pictures differ (%llu shadow rays, %llu mirrored, %llu "
           "through surfaces)",
           extras->any_lights ? "any lights" : "point lights",
           extras->glass ? "glass" : extras->patterns ? "patterns" : extras->clear ? "clear colours" : "plain colours",
           sampling ? "sampled" : "one ray a pixel", different, pictures, (unsigned long long)shadow_rays,
           (unsigned long long)reflected_rays, (unsigned long long)transmitted_rays);
}

// A layer that lets nothing through looks the same by itself, which is done by tiles, and over another, which is walked.
static void test_one_layer(uint64_t first)
{
    int different = 0;
    for (uint64_t seed = first; seed < first + 60; seed++) {
        Film films[2];
        for (int doubled = 0; doubled < 2; doubled++) {
            Random random = {seed};
            Scene scene;
            RenderStatistics statistics;
            random_scene(&random, &(Extras){.patterns = true, .doubled = doubled}, &scene);
            films[doubled] = picture(&scene, NULL, 0, false, NULL, &statistics);
            scene_fini(&scene);
        }
        different += films_differ(&films[0], &films[1]);
        film_fini(&films[0]);
        film_fini(&films[1]);
    }
    tap_ok(different == 0, "a layer by itself is that layer over another: %d of 60 pictures differ", different);
}

int main(void)
{
    uint64_t seed = random_seed(NULL);
    SamplingOptions sampling = {.seed = seed, .samples = 5};
    for (int kind = 0; kind < 8; kind++) {
        Extras extras = {.any_lights = kind & 1, .patterns = kind == 2 || kind == 3, .clear = kind & 4, .glass = kind > 5};
        test_light(seed, &extras, NULL);
        test_light(seed, &extras, &sampling);
    }
    test_one_layer(seed);
    return tap_done();
}
