// Scene records: keeps them in order, each different material once.
//
// Turns calls of the evaluator into growable arrays. Owns the arrays and the indices of what is kept once. Knows nothing of
// the language, and checks nothing: that is validate.c.
//
// SPDX-License-Identifier: MIT
#include "scene/scene.h"

_Static_assert(sizeof(Material) == 5 * sizeof(float) + sizeof(FinishIndex), "no padding in a material");
_Static_assert(sizeof(Finish) == 23 * sizeof(double) + sizeof(uint64_t), "no padding in a finish");

void scene_init(Scene *scene)
{
    *scene = (Scene){
        .camera =
            {
                .type = CAMERA_PERSPECTIVE,
                .direction = {0.0, 0.0, 1.0},
                .right = {1.33, 0.0, 0.0},
                .up = {0.0, 1.0, 0.0},
            },
        .settings =
            {
                .gamma_model = GAMMA_NONE,
                .assumed_gamma = 1.0,
                .ambient_light = {1.0, 1.0, 1.0},
                .max_trace_level = 5,
                .adc_bailout = 1.0 / 255.0,
                .version = 3.7,
            },
    };
}

void scene_fini(Scene *scene)
{
    ARRAY_FREE(&scene->lights);
    ARRAY_FREE(&scene->finishes);
    ARRAY_FREE(&scene->materials);
    ARRAY_FREE(&scene->spheres);
    ARRAY_FREE(&scene->ellipsoids);
    ARRAY_FREE(&scene->planes);
    unique_fini(&scene->finish_index);
    unique_fini(&scene->material_index);
    scene_init(scene);
}

// A slot may only be taken when the record is sure to follow, so room is made first.
static bool add_finish(Scene *scene, const Finish *finish, FinishIndex *index)
{
    if (!ARRAY_RESERVE(&scene->finishes, scene->finishes.count + 1) ||
        !unique_place(&scene->finish_index, scene->finishes.items, scene->finishes.count, sizeof *finish, finish,
                      index)) {
        return false;
    }
    return *index < scene->finishes.count || ARRAY_PUSH(&scene->finishes, *finish);
}

bool scene_add_material(Scene *scene, Rgbft pigment, const Finish *finish, MaterialIndex *index)
{
    Material material = {
        .red = (float)pigment.red,
        .green = (float)pigment.green,
        .blue = (float)pigment.blue,
        .filter = (float)pigment.filter,
        .transmit = (float)pigment.transmit,
    };
    if (!add_finish(scene, finish, &material.finish) ||
        !ARRAY_RESERVE(&scene->materials, scene->materials.count + 1) ||
        !unique_place(&scene->material_index, scene->materials.items, scene->materials.count, sizeof material,
                      &material, index)) {
        return false;
    }
    return *index < scene->materials.count || ARRAY_PUSH(&scene->materials, material);
}

Rgbft material_pigment(const Material *material)
{
    return (Rgbft){material->red, material->green, material->blue, material->filter, material->transmit};
}

bool scene_add_light(Scene *scene, const Light *light)
{
    return ARRAY_PUSH(&scene->lights, *light);
}

bool scene_add_sphere(Scene *scene, Vec3 centre, double radius, MaterialIndex material, uint64_t source)
{
    Sphere sphere = {centre, radius, material, scene->shape_count, source};
    if (scene->shape_count == UINT32_MAX || !ARRAY_PUSH(&scene->spheres, sphere)) {
        return false;
    }
    scene->shape_count++;
    return true;
}

bool scene_add_ellipsoid(Scene *scene, const Transform *to_world, const Transform *to_object, MaterialIndex material,
                         uint64_t source)
{
    Ellipsoid ellipsoid = {*to_world, *to_object, material, scene->shape_count, source};
    if (scene->shape_count == UINT32_MAX || !ARRAY_PUSH(&scene->ellipsoids, ellipsoid)) {
        return false;
    }
    scene->shape_count++;
    return true;
}

bool scene_add_plane(Scene *scene, Vec3 unit_normal, double distance, MaterialIndex material, uint64_t source)
{
    Plane plane = {unit_normal, distance, material, scene->shape_count, source};
    if (scene->shape_count == UINT32_MAX || !ARRAY_PUSH(&scene->planes, plane)) {
        return false;
    }
    scene->shape_count++;
    return true;
}
