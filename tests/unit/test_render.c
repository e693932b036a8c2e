// The renderer without the language: scenes made as records, pictures checked against formulas and invariances.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "render/kernels.h"
#include "render/render.h"
#include "unit/tap.h"

static const Finish plain_finish = {
    .ambient = {0.1, 0.1, 0.1}, .diffuse = 0.6, .brilliance = 1.0, .phong_size = 40.0, .roughness = 0.05,
    .reflection_falloff = 1.0, .reflection_exponent = 1.0, .refraction = 1.0,
};

static void add_ball(Scene *scene, Vec3 centre, double radius, Rgbft pigment, const Finish *finish)
{
    MaterialIndex index;
    if (!scene_add_material(scene, pigment, finish, &index) || !scene_add_sphere(scene, centre, radius, index, 0)) {
        abort();
    }
}

static void add_light(Scene *scene, LightType type, Vec3 position, bool shadowless)
{
    Light light = {.type = type, .shadowless = shadowless, .position = position, .colour = {1.0, 1.0, 1.0}};
    if (!scene_add_light(scene, &light)) {
        abort();
    }
}

static void set_camera(Scene *scene, Vec3 location)
{
    scene->camera = (Camera){.type = CAMERA_PERSPECTIVE,
                             .location = location,
                             .direction = {0.0, 0.0, 1.0},
                             .right = {1.33, 0.0, 0.0},
                             .up = {0.0, 1.0, 0.0}};
    scene->has_camera = true;
}

// Many balls with mirrors, clear ones and highlights; every length is multiplied by `scale`.
static void make_crowd(Scene *scene, double scale)
{
    Finish mirror = plain_finish, shiny = plain_finish;
    mirror.reflection_min = mirror.reflection_max = (Rgb){0.5, 0.4, 0.3};
    shiny.phong = 0.7;
    shiny.specular = 0.3;
    shiny.metallic = 1.0;
    scene_init(scene);
    for (int i = 0; i < 60; i++) {
        Vec3 centre = {scale * (i % 8 - 3.5), scale * (i / 8 - 3.5), scale * (i * 7 % 5)};
        Rgbft pigment = {0.2 + 0.01 * i, 0.9 - 0.01 * i, 0.5, i % 3 ? 0.0 : 0.4, i % 5 ? 0.0 : 0.3};
        add_ball(scene, centre, scale * (0.3 + 0.01 * i), pigment, i % 4 ? &shiny : &mirror);
    }
    add_light(scene, LIGHT_POINT, vec3(scale * -10.0, scale * 12.0, scale * -20.0), false);
    add_light(scene, LIGHT_POINT, vec3(scale * 3.0, scale * 1.0, scale * -9.0), false);
    set_camera(scene, vec3(0.0, 0.0, scale * -9.0));
    scene->background = (Rgbft){0.1, 0.2, 0.3, 0.0, 0.0};
}

static Film render(const Scene *scene, int width, int height, int threads, RenderStatistics *statistics)
{
    Film film;
    Prepared *prepared = prepared_new(scene, &(GeometryOptions){.threads = 2});
    RenderOptions options = {.threads = threads};
    SamplingError error;
    if (!prepared || !film_init(&film, width, height, 0) ||
        render_film(prepared, &options, &film, statistics, &error) != RENDER_OK) {
        abort();
    }
    prepared_free(prepared);
    return film;
}

static bool same_film(const Film *a, const Film *b)
{
    return memcmp(a->rgb, b->rgb, (size_t)a->width * (size_t)a->height * 3 * sizeof(float)) == 0;
}

// One sphere straight ahead, the light behind the eye: the middle pixel is ambient + diffuse.
static void test_one_sphere(void)
{
    Scene scene;
    RenderStatistics statistics;
    scene_init(&scene);
    add_ball(&scene, vec3(0.0, 0.0, 5.0), 1.0, (Rgbft){1.0, 0.5, 0.25, 0.0, 0.0}, &plain_finish);
    add_light(&scene, LIGHT_POINT, vec3(0.0, 0.0, -10.0), false);
    set_camera(&scene, vec3(0.0, 0.0, 0.0));
    Film film = render(&scene, 1, 1, 1, &statistics);
    tap_ok(film.rgb[0] == 0.7f && film.rgb[1] == 0.35f, "ambient and diffuse of a lit sphere");
    tap_ok(statistics.camera_rays == 1 && statistics.shadow_rays == 1, "one camera ray, one shadow ray");
    film_fini(&film);
    scene.lights.items[0].position = vec3(0.0, 0.0, 20.0);
    film = render(&scene, 1, 1, 1, &statistics);
    tap_ok(film.rgb[0] == 0.1f && statistics.shadow_rays == 0, "lit from behind: ambient only, and no shadow ray");
    film_fini(&film);
    scene_fini(&scene);
}

// Two layers, of which the upper one lets light through, by one light: one shadow ray.
static void test_layers(void)
{
    Scene scene;
    RenderStatistics statistics;
    scene_init(&scene);
    Texture layer = {.to_world = transform_identity(), .entries = RECORD_NONE, .below = RECORD_NONE,
                     .normal = RECORD_NONE, .pigment = pigment_of((Rgbft){1.0, 0.5, 0.25, 0.0, 0.0})};
    Compound compound = {.interior = RECORD_NONE, .inner = RECORD_NONE};
    MaterialIndex material;
    bool is_fine = scene_add_finish(&scene, &plain_finish, &layer.finish) &&
                   scene_add_texture(&scene, &layer, &layer.below);
    layer.pigment = pigment_of((Rgbft){1.0, 1.0, 1.0, 0.0, 0.5});
    is_fine = is_fine && scene_add_texture(&scene, &layer, &compound.texture) &&
              scene_add_compound(&scene, &compound, &material) &&
              scene_add_sphere(&scene, vec3(0.0, 0.0, 5.0), 1.0, material, 0);
    add_light(&scene, LIGHT_POINT, vec3(0.0, 0.0, -10.0), false);
    set_camera(&scene, vec3(0.0, 0.0, 0.0));
    Film film = render(&scene, 1, 1, 1, &statistics);
    tap_ok(is_fine && film.rgb[0] == 0.7f && statistics.shadow_rays == 1, "layers share what reaches them of a light");
    film_fini(&film);
    scene_fini(&scene);
}

static void test_threads(void)
{
    Scene scene;
    RenderStatistics one, other;
    make_crowd(&scene, 1.0);
    Film film = render(&scene, 150, 110, 1, &one);
    const int counts[] = {2, 3, 8, 64};
    for (size_t i = 0; i < RT_COUNT_OF(counts); i++) {
        Film again = render(&scene, 150, 110, counts[i], &other);
        tap_ok(same_film(&film, &again) && memcmp(&one, &other, sizeof one) == 0, "same bits with %d threads",
               counts[i]);
        film_fini(&again);
    }
    tap_ok(one.reflected_rays > 1000 && one.transmitted_rays > 1000, "the scene reflects and lets through");
    film_fini(&film);
    scene_fini(&scene);
}

static void test_scale(void)
{
    Scene scene;
    RenderStatistics one, other;
    make_crowd(&scene, 1.0);
    Film film = render(&scene, 64, 48, 2, &one);
    scene_fini(&scene);
    const int exponents[] = {-400, -61, -1, 1, 30, 400};
    for (size_t i = 0; i < RT_COUNT_OF(exponents); i++) {
        make_crowd(&scene, ldexp(1.0, exponents[i]));
        Film again = render(&scene, 64, 48, 2, &other);
        tap_ok(same_film(&film, &again), "same bits at scale 2^%d", exponents[i]);
        film_fini(&again);
        scene_fini(&scene);
    }
    film_fini(&film);
}

// The least kernel that covers a scene is chosen, and some kernel always does.
static void test_kernels(void)
{
    const Kernel *all = kernel_choose(~0u);
    const Kernel *least = kernel_choose(TRACE_SPHERES);
    tap_ok(strcmp(least->name, "few spheres, opaque") == 0, "the least kernel for a few spheres without shadows");
    tap_ok((all->features & (unsigned)TRACE_ALL_FEATURES) == TRACE_ALL_FEATURES, "the last kernel has all features");
    int uncovered = 0;
    for (unsigned features = 0; features < 1u << 14; features++) {
        bool exists = (features & ~(unsigned)(TRACE_ALL_FEATURES | RENDER_ALL_FEATURES)) == 0;
        uncovered += exists && (features & ~kernel_choose(features)->features);
    }
    tap_ok(uncovered == 0, "every set of features is covered by a kernel");
}

// A light in a closed opaque shell lights nothing outside; the shell's own wall does not shadow itself.
static void test_inside(void)
{
    Scene scene;
    RenderStatistics statistics;
    scene_init(&scene);
    add_ball(&scene, vec3(0.0, 0.0, 0.0), 4.0, (Rgbft){1.0, 1.0, 1.0, 0.0, 0.0}, &plain_finish);
    add_light(&scene, LIGHT_POINT, vec3(0.0, 0.0, 0.0), false);
    set_camera(&scene, vec3(0.0, 0.0, -1.0));
    Film film = render(&scene, 1, 1, 1, &statistics);
    tap_ok(film.rgb[0] == 0.7f, "the inner wall is lit from inside");
    film_fini(&film);
    scene.camera.location = vec3(0.0, 0.0, -10.0);
    film = render(&scene, 1, 1, 1, &statistics);
    tap_ok(film.rgb[0] == 0.1f, "and dark outside");
    film_fini(&film);
    scene_fini(&scene);
}

// Mirrors that face each other show as many surfaces as max_trace_level allows.
static void test_trace_level(void)
{
    Scene scene;
    RenderStatistics statistics;
    Finish mirror = plain_finish;
    mirror.ambient = rgb_grey(1.0);
    mirror.diffuse = 0.0;
    mirror.reflection_min = mirror.reflection_max = rgb_grey(0.5);
    scene_init(&scene);
    add_ball(&scene, vec3(0.0, 0.0, 0.0), 1.0, (Rgbft){1.0, 1.0, 1.0, 0.0, 0.0}, &mirror);
    set_camera(&scene, vec3(0.0, 0.0, 0.0));
    scene.settings.adc_bailout = 0.0;
    float expected = 0.0f, term = 1.0f;
    for (int level = 1; level <= 6; level++) {
        scene.settings.max_trace_level = level;
        expected += term;
        term *= 0.5f;
        Film film = render(&scene, 1, 1, 1, &statistics);
        tap_ok(film.rgb[0] == expected, "max_trace_level %d", level);
        film_fini(&film);
    }
    scene_fini(&scene);
}

int main(void)
{
    test_one_sphere();
    test_layers();
    test_threads();
    test_scale();
    test_kernels();
    test_inside();
    test_trace_level();
    return tap_done();
}
