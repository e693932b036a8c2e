// Places in the lists of records by the order of declaration, which all of them follow.
//
// SPDX-License-Identifier: MIT
#include "scene/tail.h"

#include <string.h>

// How many records of each list belong to the shapes before one.
typedef struct Places {
    uint32_t order;
    size_t spheres, runs, planes, parts, nodes, composites, starts, bodies;
    uint32_t inner_bodies;
} Places;

static size_t spheres_before(const Scene *scene, size_t runs, uint32_t order)
{
    if (runs == 0) {
        return 0;
    }
    const SphereRun *last = &scene->sphere_runs.items[runs - 1];
    size_t end = runs < scene->sphere_runs.count ? scene->sphere_runs.items[runs].first : scene->spheres.count;
    size_t wanted = (size_t)last->first + (order - last->order);
    return wanted < end ? wanted : end;
}

static uint32_t greatest_body(const Scene *scene, const Places *places)
{
    uint32_t greatest = 0;
    for (size_t i = 0; i < places->parts; i++) {
        greatest = scene->primitives.items[i].body > greatest ? scene->primitives.items[i].body : greatest;
    }
    for (size_t i = 0; i < places->nodes; i++) {
        greatest = scene->nodes.items[i].body > greatest ? scene->nodes.items[i].body : greatest;
    }
    return greatest;
}

// How many items of a list stand before the order, looked for from the end.
#define BEFORE(list, member, order, place)                                                                             \
    do {                                                                                                               \
        (place) = (list).count;                                                                                        \
        while ((place) > 0 && (list).items[(place) - 1].member >= (order)) {                                           \
            (place)--;                                                                                                 \
        }                                                                                                              \
    } while (0)

static Places places_before(const Scene *scene, uint32_t order)
{
    Places places = {.order = order};
    BEFORE(scene->sphere_runs, order, order, places.runs);
    BEFORE(scene->planes, order, order, places.planes);
    BEFORE(scene->primitives, order, order, places.parts);
    BEFORE(scene->composites, order, order, places.composites);
    BEFORE(scene->start_shapes, order, order, places.starts);
    BEFORE(scene->bodies, first, order, places.bodies);
    places.spheres = spheres_before(scene, places.runs, order);
    bool has_more = places.composites < scene->composites.count;
    places.nodes = has_more ? scene->composites.items[places.composites].first_node : scene->nodes.count;
    places.inner_bodies = greatest_body(scene, &places);
    return places;
}

void scene_keep_shapes(Scene *scene, uint32_t count)
{
    Places places = places_before(scene, count);
    scene->spheres.count = places.spheres;
    scene_spheres_change(scene);
    scene->sphere_runs.count = places.runs;
    scene->planes.count = places.planes;
    scene->primitives.count = places.parts;
    scene->nodes.count = places.nodes;
    scene->composites.count = places.composites;
    scene->start_shapes.count = places.starts;
    scene->bodies.count = places.bodies;
    scene->inner_body_count = places.inner_bodies;
    scene->shape_count = count;
}

// ---- the same again

// Two stretches of the same shapes, the second right behind the first.
typedef struct Stretches {
    const Scene *scene;
    Places one, other;
} Stretches;

static bool is_same_material(const Scene *scene, MaterialIndex a, MaterialIndex b)
{
    bool are_plain = !((a | b) & MATERIAL_COMPOUND) && a < scene->materials.count && b < scene->materials.count;
    return a == b ||
           (are_plain && memcmp(&scene->materials.items[a], &scene->materials.items[b], sizeof(Material)) == 0);
}

// An index, or RECORD_NONE or NODE_NONE, in the first stretch, and what it is in the second.
static uint32_t moved(uint32_t index, size_t one, size_t other)
{
    return index >= one && index != RECORD_NONE ? index + (uint32_t)(other - one) : index;
}

static uint32_t moved_body(uint32_t body, const Stretches *s)
{
    return body ? body + (s->other.inner_bodies - s->one.inner_bodies) : 0;
}

static bool are_spheres_same(const Stretches *s)
{
    const Scene *scene = s->scene;
    bool is_same = scene->spheres.count - s->other.spheres == s->other.spheres - s->one.spheres;
    for (size_t i = s->other.spheres, k = s->one.spheres; is_same && i < scene->spheres.count; i++, k++) {
        const Sphere *a = &scene->spheres.items[k], *b = &scene->spheres.items[i];
        is_same = memcmp(&a->centre, &b->centre, sizeof a->centre) == 0 && a->radius == b->radius &&
                  is_same_material(scene, a->material, b->material) &&
                  scene_sphere_order(scene, i) - s->other.order == scene_sphere_order(scene, k) - s->one.order;
    }
    return is_same;
}

static bool are_planes_same(const Stretches *s)
{
    const Scene *scene = s->scene;
    bool is_same = scene->planes.count - s->other.planes == s->other.planes - s->one.planes;
    for (size_t i = s->other.planes, k = s->one.planes; is_same && i < scene->planes.count; i++, k++) {
        const Plane *a = &scene->planes.items[k], *b = &scene->planes.items[i];
        is_same = memcmp(&a->normal, &b->normal, sizeof a->normal) == 0 && a->distance == b->distance &&
                  is_same_material(scene, a->material, b->material) &&
                  moved(a->order, s->one.order, s->other.order) == b->order;
    }
    return is_same;
}

static bool is_part_same(const Stretches *s, const Primitive *a, const Primitive *b)
{
    return a->kind == b->kind && a->flags == b->flags && a->hidden == b->hidden &&
           moved(a->node, s->one.nodes, s->other.nodes) == b->node &&
           is_same_material(s->scene, a->material, b->material) &&
           moved(a->order, s->one.order, s->other.order) == b->order && moved_body(a->body, s) == b->body &&
           memcmp(&a->to_world, &b->to_world, sizeof a->to_world) == 0 && memcmp(a->data, b->data, sizeof a->data) == 0;
}

static bool are_parts_same(const Stretches *s)
{
    const Scene *scene = s->scene;
    bool is_same = scene->primitives.count - s->other.parts == s->other.parts - s->one.parts;
    for (size_t i = s->other.parts, k = s->one.parts; is_same && i < scene->primitives.count; i++, k++) {
        is_same = is_part_same(s, &scene->primitives.items[k], &scene->primitives.items[i]);
    }
    return is_same;
}

static bool are_composites_same(const Stretches *s)
{
    const Scene *scene = s->scene;
    bool is_same = scene->nodes.count - s->other.nodes == s->other.nodes - s->one.nodes &&
                   scene->composites.count - s->other.composites == s->other.composites - s->one.composites;
    for (size_t i = s->other.nodes, k = s->one.nodes; is_same && i < scene->nodes.count; i++, k++) {
        const Node *a = &scene->nodes.items[k], *b = &scene->nodes.items[i];
        is_same = a->op == b->op && a->is_inverse == b->is_inverse && a->child_count == b->child_count &&
                  moved(a->parent, s->one.nodes, s->other.nodes) == b->parent &&
                  moved(a->first_primitive, s->one.parts, s->other.parts) == b->first_primitive &&
                  moved_body(a->body, s) == b->body;
    }
    for (size_t i = s->other.composites, k = s->one.composites; is_same && i < scene->composites.count; i++, k++) {
        const Composite *a = &scene->composites.items[k], *b = &scene->composites.items[i];
        is_same = a->node_count == b->node_count && a->primitive_count == b->primitive_count &&
                  a->hidden == b->hidden && a->start_clips == b->start_clips &&
                  moved(a->order, s->one.order, s->other.order) == b->order;
    }
    return is_same;
}

static bool are_bodies_same(const Stretches *s)
{
    const Scene *scene = s->scene;
    bool is_same = scene->bodies.count - s->other.bodies == s->other.bodies - s->one.bodies &&
                   scene->start_shapes.count - s->other.starts == s->other.starts - s->one.starts;
    for (size_t i = s->other.bodies, k = s->one.bodies; is_same && i < scene->bodies.count; i++, k++) {
        const Body *a = &scene->bodies.items[k], *b = &scene->bodies.items[i];
        is_same = moved(a->first, s->one.order, s->other.order) == b->first &&
                  moved(a->end, s->one.order, s->other.order) == b->end &&
                  moved(a->around, s->one.bodies, s->other.bodies) == b->around && a->interior == b->interior;
    }
    return is_same;
}

bool scene_repeats_shapes(const Scene *scene, uint32_t first, uint32_t second)
{
    Stretches s = {scene, places_before(scene, first), places_before(scene, second)};
    return scene->shape_count - second == second - first && are_spheres_same(&s) && are_planes_same(&s) &&
           are_parts_same(&s) && are_composites_same(&s) && are_bodies_same(&s);
}
