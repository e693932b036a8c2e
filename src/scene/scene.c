// Scene records: keeps them in order, each different material once.
//
// Turns calls of the evaluator into growable arrays. Owns the arrays and the indices of what is kept once. Knows
// nothing of the language, and checks nothing: that is validate.c.
//
// SPDX-License-Identifier: MIT
#include "scene/scene.h"

#include <stdlib.h>
#include <string.h>

#include "scene/primitive.h"

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

void scene_fini(Scene *scene)
{
    ARRAY_FREE(&scene->sky);
    ARRAY_FREE(&scene->fogs);
    ARRAY_FREE(&scene->rainbows);
    ARRAY_FREE(&scene->lights);
    ARRAY_FREE(&scene->finishes);
    ARRAY_FREE(&scene->materials);
    ARRAY_FREE(&scene->pigment_entries);
    ARRAY_FREE(&scene->patterns);
    for (size_t i = 0; i < scene->pictures.count; i++) {
        picture_fini(&scene->pictures.items[i]);
    }
    ARRAY_FREE(&scene->formula_steps);
    ARRAY_FREE(&scene->warps);
    ARRAY_FREE(&scene->picture_sources);
    ARRAY_FREE(&scene->picture_shades);
    ARRAY_FREE(&scene->image_maps);
    ARRAY_FREE(&scene->pictures);
    ARRAY_FREE(&scene->slope_entries);
    ARRAY_FREE(&scene->normal_entries);
    ARRAY_FREE(&scene->normals);
    ARRAY_FREE(&scene->texture_entries);
    ARRAY_FREE(&scene->textures);
    ARRAY_FREE(&scene->interiors);
    ARRAY_FREE(&scene->compounds);
    ARRAY_FREE(&scene->spheres);
    ARRAY_FREE(&scene->sphere_runs);
    ARRAY_FREE(&scene->planes);
    ARRAY_FREE(&scene->parts);
    numbers_fini(&scene->numbers);
    if (scene->formula_host) {
        free((void *)scene->formula_host->noise);
        free(scene->formula_host);
    }
    for (size_t i = 0; i < scene->meshes.count; i++) {
        mesh_free(scene->meshes.items[i]);
    }
    ARRAY_FREE(&scene->meshes);
    ARRAY_FREE(&scene->face_materials);
    ARRAY_FREE(&scene->blobs);
    ARRAY_FREE(&scene->nodes);
    ARRAY_FREE(&scene->composites);
    ARRAY_FREE(&scene->start_shapes);
    ARRAY_FREE(&scene->bodies);
    unique_fini(&scene->finish_index);
    unique_fini(&scene->material_index);
    unique_fini(&scene->pigment_entry_index);
    unique_fini(&scene->pattern_index);
    unique_fini(&scene->slope_entry_index);
    unique_fini(&scene->normal_entry_index);
    unique_fini(&scene->normal_index);
    unique_fini(&scene->texture_entry_index);
    unique_fini(&scene->texture_index);
    unique_fini(&scene->interior_index);
    unique_fini(&scene->compound_index);
    unique_fini(&scene->picture_source_index);
    unique_fini(&scene->picture_shade_index);
    unique_fini(&scene->image_map_index);
    unique_fini(&scene->formula_step_index);
    unique_fini(&scene->warp_index);
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
#define LIST_BYTES(list) list_bytes((list).count, (list).capacity, sizeof *(list).items)
    return LIST_BYTES(scene->sky) + LIST_BYTES(scene->fogs) + LIST_BYTES(scene->rainbows) + LIST_BYTES(scene->lights) + LIST_BYTES(scene->materials) +
           LIST_BYTES(scene->finishes) + LIST_BYTES(scene->pigment_entries) + LIST_BYTES(scene->patterns) +
           LIST_BYTES(scene->slope_entries) + LIST_BYTES(scene->normal_entries) + LIST_BYTES(scene->normals) +
           LIST_BYTES(scene->texture_entries) + LIST_BYTES(scene->textures) + LIST_BYTES(scene->interiors) +
           LIST_BYTES(scene->compounds) + LIST_BYTES(scene->spheres) + LIST_BYTES(scene->sphere_runs) +
           LIST_BYTES(scene->planes) + LIST_BYTES(scene->parts) + LIST_BYTES(scene->meshes) +
           LIST_BYTES(scene->face_materials) + LIST_BYTES(scene->blobs) + scene->mesh_bytes + LIST_BYTES(scene->nodes) +
           LIST_BYTES(scene->composites) + LIST_BYTES(scene->bodies) + LIST_BYTES(scene->start_shapes) +
           LIST_BYTES(scene->formula_steps) + LIST_BYTES(scene->warps) + LIST_BYTES(scene->picture_sources) +
           LIST_BYTES(scene->picture_shades) + LIST_BYTES(scene->image_maps) + LIST_BYTES(scene->pictures) +
           LIST_BYTES(scene->numbers.lists) + LIST_BYTES(scene->numbers.slots) + scene->numbers.bytes +
           scene_picture_bytes(scene);
#undef LIST_BYTES
}

bool scene_add_mesh(Scene *scene, Mesh *mesh)
{
    if (!ARRAY_PUSH(&scene->meshes, mesh)) {
        return false;
    }
    mesh->number = scene->plain_mesh_count;
    scene->plain_mesh_count += !mesh->face_textures;
    scene->mesh_bytes += mesh_bytes(mesh);
    return true;
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
    return ARRAY_PUSH(&scene->lights, *light);
}

// Whether the next sphere continues with the last run.
static bool run_goes_on(const Scene *scene, uint64_t source)
{
    if (scene->sphere_runs.count == 0) {
        return false;
    }
    const SphereRun *last = &scene->sphere_runs.items[scene->sphere_runs.count - 1];
    return last->source == source >> 32 &&
           scene->shape_count - last->order == (uint32_t)scene->spheres.count - last->first;
}

// Of the next sphere, if it is not in the last one. One that is then not added does no harm.
static bool add_run(Scene *scene, uint64_t source)
{
    SphereRun run = {(uint32_t)scene->spheres.count, scene->shape_count, (uint32_t)(source >> 32)};
    return run_goes_on(scene, source) || ARRAY_PUSH(&scene->sphere_runs, run);
}

// ---- spheres that other processes keep

enum { SHARE_RUN = 64 }; // spheres on end that one process keeps

static bool is_elsewhere(const Scene *scene, uint32_t order)
{
    return scene->share.parts > 1 && order / SHARE_RUN % scene->share.parts != scene->share.part;
}

void scene_end_share(Scene *scene)
{
    if (scene->share.has_other) {
        scene->spheres.count--;
        scene->sphere_runs.count -=
            scene->sphere_runs.items[scene->sphere_runs.count - 1].first == scene->spheres.count;
        scene->share.has_other = false;
    }
}

bool scene_pass_spheres(Scene *scene, size_t spheres)
{
    scene_end_share(scene);
    if (spheres >= UINT32_MAX - scene->shape_count) {
        return false;
    }
    scene->shape_count += (uint32_t)spheres;
    return true;
}

bool scene_add_sphere(Scene *scene, Vec3 centre, double radius, MaterialIndex material, uint64_t source)
{
    Sphere sphere = {centre, radius, material, (uint32_t)source};
    scene_end_share(scene);
    if (scene->shape_count == UINT32_MAX || !add_run(scene, source) || !ARRAY_PUSH(&scene->spheres, sphere)) {
        return false;
    }
    scene->share.has_other = is_elsewhere(scene, scene->shape_count);
    scene->shape_count++;
    return true;
}

static const SphereRun *run_of(const Scene *scene, size_t sphere)
{
    const SphereRun *runs = scene->sphere_runs.items;
    size_t low = 0, high = scene->sphere_runs.count;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        *(runs[middle].first <= sphere ? &low : &high) = middle;
    }
    return &runs[low];
}

uint32_t scene_sphere_order(const Scene *scene, size_t sphere)
{
    const SphereRun *run = run_of(scene, sphere);
    return run->order + ((uint32_t)sphere - run->first);
}

uint64_t scene_sphere_source(const Scene *scene, size_t sphere)
{
    return (uint64_t)run_of(scene, sphere)->source << 32 | scene->spheres.items[sphere].source;
}

uint32_t scene_sphere_at(const Scene *scene, uint32_t order)
{
    const SphereRun *runs = scene->sphere_runs.items;
    size_t low = 0, high = scene->sphere_runs.count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (runs[middle].order <= order) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    if (low == 0) {
        return RECORD_NONE;
    }
    size_t sphere = (size_t)runs[low - 1].first + (order - runs[low - 1].order);
    size_t end = low < scene->sphere_runs.count ? runs[low].first : scene->spheres.count;
    return sphere < end ? (uint32_t)sphere : RECORD_NONE;
}

bool scene_materials_add_up(const Scene *scene)
{
    return scene->material_index.is_given_up;
}

bool scene_reserve_spheres(Scene *scene, size_t spheres, size_t materials)
{
    scene_end_share(scene);
    return spheres < UINT32_MAX - scene->shape_count && materials < MATERIAL_COMPOUND - scene->materials.count &&
           ARRAY_RESERVE(&scene->spheres, scene->spheres.count + spheres) &&
           ARRAY_RESERVE(&scene->sphere_runs, scene->sphere_runs.count + 1) &&
           ARRAY_RESERVE(&scene->materials, scene->materials.count + materials);
}

void scene_commit_spheres(Scene *scene, size_t spheres, uint64_t source)
{
    (void)add_run(scene, source); // there is room for it
    scene->spheres.count += spheres;
    scene->shape_count += (uint32_t)spheres;
}

void scene_commit_materials(Scene *scene, size_t materials)
{
    scene->materials.count += materials;
    scene->material_index.last = materials > 0 ? (uint32_t)scene->materials.count - 1 : scene->material_index.last;
}

void scene_spheres_change(Scene *scene)
{
    scene->surveyed = 0;
    scene->survey = SURVEY_OF_NOTHING;
}

bool scene_add_own_materials(Scene *scene, size_t count, MaterialIndex *first)
{
    *first = (MaterialIndex)scene->materials.count;
    if (count >= MATERIAL_COMPOUND - scene->materials.count ||
        !ARRAY_RESERVE(&scene->materials, scene->materials.count + count)) {
        return false;
    }
    scene->materials.count += count;
    unique_give_up(&scene->material_index);
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

// Its list of numbers becomes the scene's.
static bool add_part(Scene *scene, const Part *part)
{
    if (!ARRAY_PUSH(&scene->parts, *part)) {
        return false;
    }
    if (primitive_class(part->kind)->has_list &&
        !numbers_keep(&scene->numbers, &scene->parts.items[scene->parts.count - 1].list)) {
        scene->parts.count--;
        return false;
    }
    return true;
}

bool scene_add_part(Scene *scene, const Part *part)
{
    if (scene->shape_count == UINT32_MAX || !add_part(scene, part)) {
        return false;
    }
    Part *added = &scene->parts.items[scene->parts.count - 1];
    added->node = NODE_NONE;
    added->order = scene->shape_count++;
    return true;
}

bool scene_begin_composite(Scene *scene, uint8_t hidden, uint64_t source)
{
    Composite composite = {
        .first_node = (uint32_t)scene->nodes.count,
        .first_part = (uint32_t)scene->parts.count,
        .start_clips = UINT32_MAX,
        .hidden = hidden,
        .order = scene->shape_count,
        .source = source,
    };
    if (scene->shape_count == UINT32_MAX || !ARRAY_PUSH(&scene->composites, composite)) {
        return false;
    }
    scene->shape_count++;
    return true;
}

bool scene_add_node(Scene *scene, NodeOp op, bool is_inverse, uint32_t parent, uint64_t source, uint32_t *index)
{
    Node node = {
        .op = op,
        .is_inverse = is_inverse,
        .parent = parent,
        .first_part = (uint32_t)scene->parts.count,
        .source = source,
    };
    *index = (uint32_t)scene->nodes.count;
    if (!ARRAY_PUSH(&scene->nodes, node)) {
        return false;
    }
    if (parent != NODE_NONE) {
        scene->nodes.items[parent].child_count++;
    }
    return true;
}

bool scene_add_leaf(Scene *scene, const Part *part)
{
    if (!add_part(scene, part)) {
        return false;
    }
    scene->parts.items[scene->parts.count - 1].order = scene->shape_count - 1;
    scene->nodes.items[part->node].child_count++;
    return true;
}

// What a ray keeps of each interval of its line in a part: as an interval, and in a composite as two crossings.
enum { INTERVAL_STACK = 96, CROSSINGS_STACK = 2 * 40 };
// And of a mesh, which it looks for along its line.
enum { MESH_CURSOR_STACK = 1056 };

static size_t part_stack(const Part *part)
{
    unsigned intervals = primitive_intervals(part);
    bool is_mesh = part->kind == PART_MESH || part->kind == PART_MESH_SOLID;
    return COMPOSITE_PART_STACK + (is_mesh ? (size_t)MESH_CURSOR_STACK : 0) +
           (intervals > 1 ? (size_t)intervals * CROSSINGS_STACK : 0);
}

size_t scene_composite_stack(const Scene *scene)
{
    size_t most = 0;
    for (size_t i = 0; i < scene->parts.count; i++) { // one at a time
        size_t bytes = (size_t)primitive_intervals(&scene->parts.items[i]) * INTERVAL_STACK;
        most = bytes > most ? bytes : most;
    }
    size_t alone = most;
    for (size_t i = 0; i < scene->composites.count; i++) {
        const Composite *composite = &scene->composites.items[i];
        size_t bytes = alone + (size_t)composite->node_count * COMPOSITE_NODE_STACK;
        for (uint32_t k = 0; k < composite->part_count; k++) {
            bytes += part_stack(&scene->parts.items[composite->first_part + k]);
        }
        most = bytes > most ? bytes : most;
    }
    return most;
}

void scene_end_composite(Scene *scene)
{
    Composite *composite = &scene->composites.items[scene->composites.count - 1];
    composite->node_count = (uint32_t)scene->nodes.count - composite->first_node;
    composite->part_count = (uint32_t)scene->parts.count - composite->first_part;
}

bool scene_begin_body(Scene *scene, uint32_t around, uint32_t *index)
{
    Body body = {.first = scene->shape_count, .end = UINT32_MAX, .around = around, .interior = RECORD_NONE};
    *index = (uint32_t)scene->bodies.count;
    return scene->bodies.count < RECORD_NONE && ARRAY_PUSH(&scene->bodies, body);
}

void scene_end_body(Scene *scene, uint32_t index, bool is_kept)
{
    if (!is_kept && scene->bodies.count == (size_t)index + 1) {
        scene->bodies.count--;
    } else {
        scene->bodies.items[index].end = scene->shape_count;
    }
}

// The last one that begins at or before the shape is the innermost of those that hold it, or within those or behind
// them.
uint32_t scene_body(const Scene *scene, uint32_t order)
{
    size_t low = 0, high = scene->bodies.count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (scene->bodies.items[middle].first <= order) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    uint32_t body = low > 0 ? (uint32_t)(low - 1) : RECORD_NONE;
    while (body != RECORD_NONE && scene->bodies.items[body].end <= order) {
        body = scene->bodies.items[body].around;
    }
    return body;
}

// The upper half of a key.
enum { KEY_INNER = 1, KEY_WHOLE = 2, KEY_SHAPE = 3 };

uint64_t scene_shape_key(uint32_t order, uint32_t inner)
{
    return inner ? (uint64_t)KEY_INNER << 32 | inner : (uint64_t)KEY_SHAPE << 32 | order;
}

bool scene_shape_is_key(uint64_t key)
{
    return key >> 32 == KEY_SHAPE;
}

uint64_t scene_body_key(const Scene *scene, uint32_t order, uint32_t inner)
{
    uint32_t body = !inner && scene->bodies.count ? scene_body(scene, order) : RECORD_NONE;
    return body == RECORD_NONE ? scene_shape_key(order, inner) : (uint64_t)KEY_WHOLE << 32 | body;
}
