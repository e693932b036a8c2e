// The scene's shapes: spheres in runs, planes, primitives, composites and bodies, in order of declaration.
//
// Turns calls of whoever makes the scene into growable arrays. Checks nothing: that is validate.c.
//
// SPDX-License-Identifier: MIT
#include "scene/scene.h"

#include "scene/primitive.h"

// ---- spheres

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

// ---- planes, meshes, primitives

bool scene_add_plane(Scene *scene, Vec3 unit_normal, double distance, MaterialIndex material, uint64_t source)
{
    Plane plane = {unit_normal, distance, material, scene->shape_count, source};
    if (scene->shape_count == UINT32_MAX || !ARRAY_PUSH(&scene->planes, plane)) {
        return false;
    }
    scene->shape_count++;
    return true;
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

// Its list of numbers becomes the scene's.
static bool add_primitive(Scene *scene, const Primitive *primitive)
{
    if (!ARRAY_PUSH(&scene->primitives, *primitive)) {
        return false;
    }
    if (primitive_class(primitive->kind)->has_list &&
        !numbers_keep(&scene->numbers, &scene->primitives.items[scene->primitives.count - 1].list)) {
        scene->primitives.count--;
        return false;
    }
    return true;
}

bool scene_add_primitive(Scene *scene, const Primitive *primitive)
{
    if (scene->shape_count == UINT32_MAX || !add_primitive(scene, primitive)) {
        return false;
    }
    Primitive *added = &scene->primitives.items[scene->primitives.count - 1];
    added->node = NODE_NONE;
    added->order = scene->shape_count++;
    return true;
}

// ---- composites

bool scene_begin_composite(Scene *scene, uint8_t hidden, uint64_t source)
{
    Composite composite = {
        .first_node = (uint32_t)scene->nodes.count,
        .first_primitive = (uint32_t)scene->primitives.count,
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
        .first_primitive = (uint32_t)scene->primitives.count,
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

bool scene_add_leaf(Scene *scene, const Primitive *primitive)
{
    if (!add_primitive(scene, primitive)) {
        return false;
    }
    scene->primitives.items[scene->primitives.count - 1].order = scene->shape_count - 1;
    scene->nodes.items[primitive->node].child_count++;
    return true;
}

// What a ray keeps of each interval of its line in a primitive: as an interval, and in a composite as two crossings.
enum { INTERVAL_STACK = 96, CROSSINGS_STACK = 2 * 40 };
// And of a mesh, which it looks for along its line.
enum { MESH_CURSOR_STACK = 1056 };

static size_t primitive_stack(const Primitive *primitive)
{
    unsigned intervals = primitive_interval_most(primitive);
    bool is_mesh = primitive->kind == PRIMITIVE_MESH || primitive->kind == PRIMITIVE_MESH_SOLID;
    return COMPOSITE_PRIMITIVE_STACK + (is_mesh ? (size_t)MESH_CURSOR_STACK : 0) +
           (intervals > 1 ? (size_t)intervals * CROSSINGS_STACK : 0);
}

size_t scene_composite_stack(const Scene *scene)
{
    size_t most = 0;
    for (size_t i = 0; i < scene->primitives.count; i++) { // one at a time
        size_t bytes = (size_t)primitive_interval_most(&scene->primitives.items[i]) * INTERVAL_STACK;
        most = bytes > most ? bytes : most;
    }
    size_t alone = most;
    for (size_t i = 0; i < scene->composites.count; i++) {
        const Composite *composite = &scene->composites.items[i];
        size_t bytes = alone + (size_t)composite->node_count * COMPOSITE_NODE_STACK;
        for (uint32_t k = 0; k < composite->primitive_count; k++) {
            bytes += primitive_stack(&scene->primitives.items[composite->first_primitive + k]);
        }
        most = bytes > most ? bytes : most;
    }
    return most;
}

void scene_end_composite(Scene *scene)
{
    Composite *composite = &scene->composites.items[scene->composites.count - 1];
    composite->node_count = (uint32_t)scene->nodes.count - composite->first_node;
    composite->primitive_count = (uint32_t)scene->primitives.count - composite->first_primitive;
}

// ---- bodies

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
