// Draws a scene by the kernel that is chosen for it among all, or by one that was compiled with nothing but what the scene
// has, so that the instructions of both can be counted: `count_kernels NUMBER all|own`. Prints the kernel's name and a
// digest of the picture; without arguments, the number of scenes.
//
// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/kernel_instance.h"
#include "render/render.h"

enum { WIDTH = 64, HEIGHT = 48, FEW = 5, MANY = 400 };

// What a scene has, beside its spheres.
typedef struct Wanted {
    int spheres;
    bool shadows, highlights, mirrors, clear;
} Wanted;

#define SHINE (RENDER_SHADOWS | RENDER_HIGHLIGHTS)
#define SCENES(X)                                                                                                      \
    X(few_plain, "spheres", TRACE_SPHERES, 0, FEW, false, false, false, false)                                         \
    X(few_shadows, "spheres, shadows", TRACE_SPHERES, RENDER_SHADOWS, FEW, true, false, false, false)                  \
    X(few_shine, "spheres, shadows, highlights", TRACE_SPHERES, SHINE, FEW, true, true, false, false)                  \
    X(few_mirrors, "spheres, shadows, highlights, mirrors", TRACE_SPHERES, SHINE | RENDER_REFLECTION, FEW, true, true, \
      true, false)                                                                                                     \
    X(many_plain, "a tree", TRACE_SPHERE_BVH, 0, MANY, false, false, false, false)                                     \
    X(many_shadows, "a tree, shadows", TRACE_SPHERE_BVH, RENDER_SHADOWS, MANY, true, false, false, false)              \
    X(many_shine, "a tree, shadows, highlights", TRACE_SPHERE_BVH, SHINE, MANY, true, true, false, false)              \
    X(many_mirrors, "a tree, shadows, highlights, mirrors", TRACE_SPHERE_BVH, SHINE | RENDER_REFLECTION, MANY, true,   \
      true, true, false)                                                                                               \
    X(bvh_clear, "a tree, shadows, highlights, transparency", TRACE_SPHERE_BVH, SHINE | RENDER_TRANSPARENCY, MANY,     \
      true, true, false, true)

#define OWN_KERNEL(name, text, geometry, shading, ...) DEFINE_KERNEL(name, text, geometry, shading)
#define OWN_ROW(name, text, geometry, shading, ...) LIST_KERNEL(name, text, geometry, shading)
#define WANTED_ROW(name, text, geometry, shading, ...) {__VA_ARGS__},
SCENES(OWN_KERNEL)
static const Kernel own[] = {SCENES(OWN_ROW)};
static const Wanted wanted[] = {SCENES(WANTED_ROW)};

static void check(bool is_fine)
{
    if (!is_fine) {
        abort();
    }
}

static void add_sphere(Scene *scene, const Wanted *has, int number)
{
    Finish finish = {.ambient = {0.1, 0.1, 0.1}, .diffuse = 0.6, .brilliance = 1.0, .phong_size = 40.0, .roughness = 0.05,
                     .reflection_falloff = 1.0, .reflection_exponent = 1.0, .refraction = 1.0};
    finish.phong = has->highlights ? 0.5 : 0.0;
    finish.reflection_min = finish.reflection_max = rgb_grey(has->mirrors && number % 2 ? 0.3 : 0.0);
    int row = has->spheres > FEW ? 20 : 3;
    Vec3 centre = {number % row - 0.5 * (row - 1), number / row - 0.5 * (row - 1), number * 7 % 5};
    Rgbft colour = {0.2 + 0.8 * (number % 7) / 7.0, 0.5, 0.3, has->clear && number % 3 == 0 ? 0.5 : 0.0, 0.0};
    MaterialIndex material;
    check(scene_add_material(scene, colour, &finish, &material) && scene_add_sphere(scene, centre, 0.55, material, 0));
}

static void make_scene(Scene *scene, const Wanted *has)
{
    scene_init(scene);
    for (int i = 0; i < has->spheres; i++) {
        add_sphere(scene, has, i);
    }
    Light light = {.type = LIGHT_POINT, .shadowless = !has->shadows, .position = {-20, 30, -40}, .colour = {1, 1, 1}};
    check(scene_add_light(scene, &light));
    scene->camera = (Camera){.type = CAMERA_PERSPECTIVE,
                             .location = {0.0, 0.0, has->spheres > FEW ? -20.0 : -4.0},
                             .direction = {0.0, 0.0, 1.0},
                             .right = {1.33, 0.0, 0.0},
                             .up = {0.0, 1.0, 0.0}};
}

int main(int count, char **words)
{
    if (count != 3) {
        printf("%d\n", (int)RT_COUNT_OF(own));
        return 0;
    }
    size_t number = (size_t)atoi(words[1]);
    check(number < RT_COUNT_OF(own));
    Scene scene;
    Film film;
    RenderStatistics statistics = {0};
    SamplingError error;
    make_scene(&scene, &wanted[number]);
    Prepared *prepared = prepared_new(&scene, &(GeometryOptions){.threads = 1});
    check(prepared != NULL && film_init(&film, WIDTH, HEIGHT, 0) && prepared->features == own[number].features);
    prepared->kernel = strcmp(words[2], "own") == 0 ? &own[number] : prepared->kernel;
    check(render_film(prepared, &(RenderOptions){.threads = 1}, &film, &statistics, &error) == RENDER_OK);
    uint64_t digest = 0;
    for (size_t i = 0; i < (size_t)3 * WIDTH * HEIGHT; i++) {
        uint32_t bits;
        memcpy(&bits, &film.rgb[i], sizeof bits);
        digest = (digest ^ bits) * UINT64_C(0x100000001b3);
    }
    printf("%016llx %s\n", (unsigned long long)digest, prepared->kernel->name);
    prepared_free(prepared);
    film_fini(&film);
    scene_fini(&scene);
    return 0;
}
