// Scene records: keeps them in order, each different material once. Shapes are in scene_shapes.c.
//
// Turns calls of the evaluator into growable arrays. Owns the arrays and the indices of what is kept once. Knows
// nothing of the language, and checks nothing: that is validate.c.
//
// SPDX-License-Identifier: MIT
#include "scene/scene.h"

#include <stdlib.h>
#include <string.h>

_Static_assert(sizeof(Material) == 5 * sizeof(float) + sizeof(FinishIndex), "no padding in a material");
_Static_assert(sizeof(Pattern) == 12 * sizeof(uint32_t) + 20 * sizeof(double), "no padding in a pattern");
_Static_assert(sizeof(PigmentEntry) == sizeof(double) + sizeof(Pigment) + 2 * sizeof(uint32_t), "no padding");
_Static_assert(sizeof(PatternedPigment) == sizeof(Transform) + sizeof(Pattern) + 2 * sizeof(uint32_t), "no padding");
_Static_assert(sizeof(Texture) == sizeof(Pigment) + sizeof(Transform) + sizeof(Pattern) + 4 * sizeof(uint32_t),
               "no padding in a texture");
_Static_assert(sizeof(PictureSource) ==
                   2 * sizeof(char *) + 4 * sizeof(uint32_t) + 2 * sizeof(double) + sizeof(uint64_t),
               "no padding in a source of a picture");
_Static_assert(sizeof(PictureShade) == sizeof(double) + sizeof(uint64_t) + 4 * sizeof(uint32_t), "no padding");
_Static_assert(sizeof(Normal) == sizeof(Transform) + sizeof(Pattern) + 2 * sizeof(double) + 4 * sizeof(uint32_t),
               "no padding in a normal");
_Static_assert(sizeof(Finish) == 28 * sizeof(double) + sizeof(uint64_t), "no padding in a finish");
_Static_assert(sizeof(FormulaStep) == sizeof(double) + 4 * sizeof(uint32_t), "no padding in a step");
_Static_assert(sizeof(Warp) == sizeof(Transform) + 3 * sizeof(Vec3) + 6 * sizeof(double) + 4 * sizeof(uint32_t),
               "no padding in a warp");

void scene_init(Scene *scene)
{
    *scene = (Scene){
        .text_unit = 1.0,
        .sky_emission = {1.0, 1.0, 1.0},
        .background = {0.0, 0.0, 0.0, 0.0, 1.0}, // none
        .camera =
            {
                .type = CAMERA_PERSPECTIVE,
                .direction = {0.0, 0.0, 1.0},
                .right = {1.33, 0.0, 0.0},
                .up = {0.0, 1.0, 0.0},
            },
        .survey = SURVEY_OF_NOTHING,
        .settings =
            {
                .gamma_model = GAMMA_NONE,
                .assumed_gamma = 1.0,
                .ambient_light = {1.0, 1.0, 1.0},
                .max_trace_level = 5,
                .number_of_waves = SETTINGS_WAVES,
                .irid_wavelength = {(double)0.70F, (double)0.52F, (double)0.48F},
                .adc_bailout = 1.0 / 255.0,
                .version = SCENE_VERSION_UNSAID,
            },
    };
}

// All its lists, and the indices of those that keep each different record once.
#define SCENE_LISTS(X)                                                                                                 \
    X(sky)                                                                                                             \
    X(fogs)                                                                                                            \
    X(rainbows)                                                                                                        \
    X(lights) X(light_groups) X(finishes) X(materials) X(pigment_entries) X(patterns) X(formula_steps) X(warps)        \
        X(picture_sources) X(picture_shades) X(image_maps) X(pictures) X(slope_entries) X(normal_entries) X(normals)   \
            X(texture_entries) X(textures) X(interiors) X(compounds) X(spheres) X(sphere_runs) X(planes) X(primitives) \
                X(meshes) X(face_materials) X(blobs) X(nodes) X(composites) X(start_shapes) X(bodies) X(insides)
#define SCENE_INDICES(X)                                                                                               \
    X(finish) X(material) X(pigment_entry) X(pattern) X(slope_entry) X(normal_entry) X(normal) X(texture_entry)        \
    X(texture) X(interior) X(compound) X(picture_source) X(picture_shade) X(image_map) X(formula_step) X(warp)

void scene_fini(Scene *scene)
{
    for (size_t i = 0; i < scene->pictures.count; i++) {
        picture_fini(&scene->pictures.items[i]);
    }
    for (size_t i = 0; i < scene->meshes.count; i++) {
        mesh_free(scene->meshes.items[i]);
    }
    for (size_t i = 0; i < scene->insides.count; i++) {
        scene_fini(scene->insides.items[i]);
        free(scene->insides.items[i]);
    }
    numbers_fini(&scene->numbers);
    if (scene->formula_host) {
        free((void *)scene->formula_host->noise);
        free(scene->formula_host);
    }
#define FREE_LIST(list)    ARRAY_FREE(&scene->list);
#define FREE_INDEX(record) unique_fini(&scene->record##_index);
    SCENE_LISTS(FREE_LIST)
    SCENE_INDICES(FREE_INDEX)
    scene_init(scene);
}

// The index of an equal record of an array that keeps each different one once. A slot may only be taken when the record
// is sure to follow, so room is made first.
#define ADD_ONCE(array, unique, record, index)                                                                         \
    (ARRAY_RESERVE((array), (array)->count + 1) &&                                                                     \
     unique_place((unique), (array)->items, (array)->count, sizeof *(array)->items, (record), (index)) &&              \
     (*(index) < (array)->count || ARRAY_PUSH((array), *(record))))

bool scene_add_finish(Scene *scene, const Finish *finish, FinishIndex *index)
{
    return ADD_ONCE(&scene->finishes, &scene->finish_index, finish, index);
}

bool scene_add_pigment_entry(Scene *scene, const PigmentEntry *entry, uint32_t *index)
{
    return ADD_ONCE(&scene->pigment_entries, &scene->pigment_entry_index, entry, index);
}

bool scene_add_pattern(Scene *scene, const PatternedPigment *pattern, uint32_t *index)
{
    return ADD_ONCE(&scene->patterns, &scene->pattern_index, pattern, index);
}

bool scene_add_formula_step(Scene *scene, const FormulaStep *step, uint32_t *index)
{
    return ADD_ONCE(&scene->formula_steps, &scene->formula_step_index, step, index);
}

bool scene_add_warp(Scene *scene, const Warp *warp, uint32_t *index)
{
    return ADD_ONCE(&scene->warps, &scene->warp_index, warp, index);
}

bool scene_add_picture_shade(Scene *scene, const PictureShade *shade, uint32_t *index)
{
    return ADD_ONCE(&scene->picture_shades, &scene->picture_shade_index, shade, index);
}

bool scene_add_image_map(Scene *scene, const ImageMap *map, uint32_t *index)
{
    return ADD_ONCE(&scene->image_maps, &scene->image_map_index, map, index);
}

bool scene_add_picture(Scene *scene, const PictureSource *source, Span span, uint32_t *index)
{
    return ARRAY_RESERVE(&scene->pictures, scene->pictures.count + 1) &&
           ADD_ONCE(&scene->picture_sources, &scene->picture_source_index, source, index) &&
           (*index < scene->pictures.count || ARRAY_PUSH(&scene->pictures, ((Picture){.span = span})));
}

bool scene_add_slope_entry(Scene *scene, const SlopeEntry *entry, uint32_t *index)
{
    return ADD_ONCE(&scene->slope_entries, &scene->slope_entry_index, entry, index);
}

bool scene_add_normal_entry(Scene *scene, const NormalEntry *entry, uint32_t *index)
{
    return ADD_ONCE(&scene->normal_entries, &scene->normal_entry_index, entry, index);
}

bool scene_add_normal(Scene *scene, const Normal *normal, uint32_t *index)
{
    return ADD_ONCE(&scene->normals, &scene->normal_index, normal, index);
}

bool scene_add_texture_entry(Scene *scene, const TextureEntry *entry, uint32_t *index)
{
    return ADD_ONCE(&scene->texture_entries, &scene->texture_entry_index, entry, index);
}

bool scene_add_texture(Scene *scene, const Texture *texture, uint32_t *index)
{
    return ADD_ONCE(&scene->textures, &scene->texture_index, texture, index);
}

bool scene_add_interior(Scene *scene, const Interior *interior, uint32_t *index)
{
    return ADD_ONCE(&scene->interiors, &scene->interior_index, interior, index);
}

bool scene_add_compound(Scene *scene, const Compound *compound, MaterialIndex *index)
{
    bool is_added = scene->compounds.count < MATERIAL_COMPOUND &&
                    ADD_ONCE(&scene->compounds, &scene->compound_index, compound, index);
    *index |= MATERIAL_COMPOUND;
    return is_added;
}

// One for each sphere where all have colours of their own.
bool scene_add_material_record(Scene *scene, const Material *material, MaterialIndex *index)
{
    size_t count = scene->materials.count;
    return count < MATERIAL_COMPOUND &&
           (count < scene->materials.capacity || ARRAY_RESERVE(&scene->materials, count + 1)) &&
           unique_place_if_worth(&scene->material_index, scene->materials.items, count, sizeof *material, material,
                                 index) &&
           (*index < count || ARRAY_PUSH(&scene->materials, *material));
}

bool scene_materials_are_equal(const Scene *scene, MaterialIndex one, MaterialIndex other)
{
    bool are_plain = one < scene->materials.count && other < scene->materials.count;
    return one == other ||
           (are_plain && memcmp(&scene->materials.items[one], &scene->materials.items[other], sizeof(Material)) == 0);
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
    return scene_add_finish(scene, finish, &material.finish) && scene_add_material_record(scene, &material, index);
}

Pigment pigment_of(Rgbft colour)
{
    return (Pigment){(float)colour.red,    (float)colour.green,    (float)colour.blue,
                     (float)colour.filter, (float)colour.transmit, RECORD_NONE};
}

// A full list grows to twice its size, and the old one is there until it is copied.
static size_t list_bytes(size_t count, size_t capacity, size_t item_bytes)
{
    return (count == capacity ? 3 * capacity : capacity) * item_bytes;
}

size_t scene_picture_bytes(const Scene *scene)
{
    size_t bytes = 0;
    for (size_t i = 0; i < scene->pictures.count; i++) {
        bytes += picture_bytes(&scene->pictures.items[i]);
    }
    return bytes;
}

size_t scene_bytes(const Scene *scene)
{
#define LIST_BYTES(list) +list_bytes(scene->list.count, scene->list.capacity, sizeof *scene->list.items)
    return scene->inside_bytes + scene->mesh_bytes + scene->numbers.bytes +
           scene_picture_bytes(scene) SCENE_LISTS(LIST_BYTES) LIST_BYTES(numbers.lists) LIST_BYTES(numbers.slots);
}

bool scene_add_sky_layer(Scene *scene, const Pigment *layer)
{
    return ARRAY_PUSH(&scene->sky, *layer);
}

bool scene_add_rainbow(Scene *scene, const Rainbow *rainbow)
{
    return ARRAY_PUSH(&scene->rainbows, *rainbow);
}

bool scene_add_fog(Scene *scene, const Fog *fog)
{
    return ARRAY_PUSH(&scene->fogs, *fog);
}

bool scene_add_light(Scene *scene, const Light *light)
{
    if (!ARRAY_PUSH(&scene->lights, *light)) {
        return false;
    }
    size_t place = scene->lights.count - 1;
    for (; place > 0 && light->group == 0 && scene->lights.items[place - 1].group != 0; place--) {
        scene->lights.items[place] = scene->lights.items[place - 1];
    }
    scene->lights.items[place] = *light;
    return true;
}
