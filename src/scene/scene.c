// Scene records: keeps them in order, each different material once.
//
// Turns calls of the evaluator into growable arrays. Owns the arrays and the hash table of materials. Knows nothing of
// the language, and checks nothing: that is validate.c.
//
// SPDX-License-Identifier: MIT
#include "scene/scene.h"

#include <string.h>

_Static_assert(sizeof(Material) == 5 * sizeof(double) + sizeof(Finish), "no padding after the pigment");
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
    ARRAY_FREE(&scene->materials);
    ARRAY_FREE(&scene->spheres);
    ARRAY_FREE(&scene->ellipsoids);
    ARRAY_FREE(&scene->planes);
    ARRAY_FREE(&scene->material_slots);
    scene_init(scene);
}

// Eight bytes at a time, each step a multiplication by an odd constant and a shift that carries high bits down, as in
// the finalizer of MurmurHash3 (A. Appleby, public domain).
static uint64_t material_hash(const Material *material)
{
    uint64_t words[sizeof(Material) / sizeof(uint64_t)];
    memcpy(words, material, sizeof words);
    uint64_t hash = 0;
    for (size_t i = 0; i < RT_COUNT_OF(words); i++) {
        hash = (hash ^ words[i]) * UINT64_C(0xff51afd7ed558ccd);
        hash ^= hash >> 33;
    }
    return hash;
}

// The slot that holds an equal material, or the empty one where it belongs. The table is never full.
static uint32_t *material_slot(Scene *scene, const Material *material)
{
    size_t mask = scene->material_slots.count - 1;
    for (size_t at = (size_t)material_hash(material) & mask;; at = (at + 1) & mask) {
        uint32_t *slot = &scene->material_slots.items[at];
        if (*slot == 0 || memcmp(&scene->materials.items[*slot - 1], material, sizeof *material) == 0) {
            return slot;
        }
    }
}

static bool material_slots_grow(Scene *scene)
{
    size_t size = scene->material_slots.count ? 2 * scene->material_slots.count : 16;
    if (!ARRAY_RESERVE(&scene->material_slots, size)) {
        return false;
    }
    scene->material_slots.count = size;
    memset(scene->material_slots.items, 0, size * sizeof *scene->material_slots.items);
    for (size_t i = 0; i < scene->materials.count; i++) {
        *material_slot(scene, &scene->materials.items[i]) = (uint32_t)i + 1;
    }
    return true;
}

bool scene_add_material(Scene *scene, const Material *material, MaterialIndex *index)
{
    // At most half full, so that runs of taken slots stay short.
    if (2 * (scene->materials.count + 1) > scene->material_slots.count && !material_slots_grow(scene)) {
        return false;
    }
    uint32_t *slot = material_slot(scene, material);
    if (*slot == 0) {
        if (scene->materials.count == UINT32_MAX - 1 || !ARRAY_PUSH(&scene->materials, *material)) {
            return false;
        }
        *slot = (uint32_t)scene->materials.count;
    }
    *index = *slot - 1;
    return true;
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
