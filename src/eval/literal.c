// Literal spheres: the evaluator's part in statements that are read without a tree (grammar/literal.c).
//
// One statement of each kind is evaluated as any other while it is watched; when it gave one plain sphere and no
// message, the next ones of its kind differ in centre, radius and colour only and become scene records at once.
// Whatever may change what such a statement gives changes `state`. Knows nothing of text.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "eval/blocks.h"
#include "scene/many.h"

_Static_assert(sizeof(GrammarLiteralKind) == sizeof(Material), "a kind is a material");

static Eval *eval_of(void *client)
{
    return ((Splice *)client)->cursor.ev;
}

static size_t message_count(const Eval *ev)
{
    return ev->options.diags->error_count + ev->options.diags->warning_count;
}

static void watch(void *client, const GrammarLiteral *literal, const GrammarMoves *moves)
{
    Eval *ev = eval_of(client);
    ev->literal = (LiteralWatch){
        .is_watching = true,
        .state = ev->literal.state,
        .literal = *literal,
        .moves = *moves,
        .shapes = ev->scene->shape_count,
        .spheres = ev->scene->spheres.count,
        .parts = ev->scene->parts.count,
        .messages = message_count(ev),
    };
}

static bool is_plain_but_for_place(const Eval *ev, SchemaKind kind, const Blueprint *record)
{
    const ObjectPart *part = &record->part;
    const TextureBlueprint *texture = part->texture ? part->texture : ev->objects->defaults;
    return kind == KIND_SPHERE && !part->is_inverse && !part->no_shadow && !part->no_image && !part->no_reflection &&
           !part->interior && !part->clips && !part->bounds && texture->ior == 0.0;
}

bool object_is_plain_sphere(const Eval *ev, SchemaKind kind, const Blueprint *record)
{
    return is_plain_but_for_place(ev, kind, record) && transform_is_identity(&record->part.transform);
}

// What the transforms of a statement are together. False when the statement itself is to say what is wrong with one.
static bool moves_compose(const GrammarMoves *moves, Transform *all)
{
    *all = transform_identity();
    for (unsigned i = 0; i < moves->count; i++) {
        const GrammarMove *move = &moves->items[i];
        Transform transform;
        if (!transform_of_numbers(move->word, move->numbers, move->count, &transform)) {
            return false;
        }
        *all = transform_compose(*all, transform);
    }
    return transform_is_finite(all);
}

void literal_note(Eval *ev, SchemaKind kind, const Blueprint *record)
{
    Transform all;
    ev->literal.is_plain = is_plain_but_for_place(ev, kind, record) && moves_compose(&ev->literal.moves, &all) &&
                           memcmp(&all, &record->part.transform, sizeof all) == 0;
}

// The colour that the text says is the colour that the sphere has.
static bool has_colour(const GrammarLiteral *literal, const Material *material)
{
    const float colour[] = {material->red, material->green, material->blue, material->filter, material->transmit};
    for (unsigned i = 0; i < literal->colours; i++) {
        if (colour[i] != literal->kind.colour[i]) {
            return false;
        }
    }
    return true;
}

static bool is_same_sphere(const Scene *scene, size_t number, const GrammarLiteral *literal)
{
    const Sphere *sphere = &scene->spheres.items[number];
    const double *centre = literal->centre;
    return sphere->centre.x == centre[0] && sphere->centre.y == centre[1] && sphere->centre.z == centre[2] &&
           sphere->radius == literal->radius && scene_sphere_source(scene, number) == literal->span.begin;
}

static bool learn(void *client, GrammarLiteralKind *kind)
{
    Eval *ev = eval_of(client);
    const LiteralWatch *watched = &ev->literal;
    const Scene *scene = ev->scene;
    bool is_sphere = scene->spheres.count == watched->spheres + 1;
    bool is_plain = watched->is_watching && watched->is_plain && !ev->stop &&
                    message_count(ev) == watched->messages && scene->shape_count == watched->shapes + 1 &&
                    (is_sphere || (watched->moves.count > 0 && scene->parts.count == watched->parts + 1));
    ev->literal.is_watching = false;
    if (!is_plain) {
        return false;
    }
    MaterialIndex index = is_sphere ? scene->spheres.items[watched->spheres].material
                                    : scene->parts.items[watched->parts].material;
    if ((index & MATERIAL_COMPOUND) ||
        (watched->moves.count == 0 && !is_same_sphere(scene, watched->spheres, &watched->literal))) {
        return false;
    }
    const Material *material = &scene->materials.items[index];
    *kind = (GrammarLiteralKind){
        {material->red, material->green, material->blue, material->filter, material->transmit}, material->finish};
    return has_colour(&watched->literal, material);
}

// False when its colour is to be left to the statements that say what is wrong with it.
static inline bool literal_material(const GrammarLiteral *literal, Material *material)
{
    const float *colour = literal->kind.colour;
    bool is_fine = true;
    for (int i = 0; i < 5; i++) {
        is_fine = is_fine && fabsf(colour[i]) <= (float)COLOUR_USUAL;
    }
    *material = (Material){colour[0], colour[1], colour[2], colour[3], colour[4], literal->kind.finish};
    return is_fine;
}

// A zero is positive, as it is behind any transform.
static Vec3 literal_centre(const GrammarLiteral *literal)
{
    return vec3(literal->centre[0] + 0.0, literal->centre[1] + 0.0, literal->centre[2] + 0.0);
}

static LiteralResult take(void *client, const GrammarLiteral *literal, const GrammarMoves *moves)
{
    Eval *ev = eval_of(client);
    Material material;
    Transform all;
    if (!literal_material(literal, &material) || (moves->count > 0 && !moves_compose(moves, &all))) {
        return LITERAL_LEFT;
    }
    Vec3 centre = literal_centre(literal);
    bool is_placed = moves->count > 0
                         ? sphere_place_moved(ev, centre, literal->radius, &all, &material, literal->span)
                         : sphere_place_plain(ev, centre, literal->radius, &material, literal->span);
    ev->faulty = !is_placed || ev->faulty;
    return eval_cancelled(ev) ? LITERAL_STOP : LITERAL_TAKEN;
}

// ---- many at once

// Where the records of a list go.
typedef struct Batch {
    const GrammarLiterals *list;
    size_t first_sphere, first_material;
    MaterialIndex before; // the material before the list, which its first sphere has, too, …
    bool goes_on;         // … when this is true
} Batch;

typedef struct Batches {
    Scene *scene;
    Batch *items;
    size_t count, spheres, materials;
    atomic_bool has_odd; // a colour that must be left
} Batches;

// Records are written behind the ends of the scene's lists. False when there is a colour that must be left.
static bool batch_fill(const Batch *batch, Scene *scene)
{
    const GrammarLiterals *list = batch->list;
    Sphere *sphere = &scene->spheres.items[batch->first_sphere];
    size_t next = batch->first_material;
    MaterialIndex index = batch->before;
    Material material, last;
    bool is_fine = true;
    for (size_t i = 0; i < list->count; i++) {
        const GrammarLiteral *literal = &list->items[i];
        is_fine = literal_material(literal, &material) && is_fine;
        if (i == 0 ? !batch->goes_on : memcmp(&material, &last, sizeof last) != 0) {
            scene->materials.items[index = (MaterialIndex)next++] = material;
        }
        last = material;
        sphere[i] = (Sphere){literal_centre(literal), literal->radius, index,
                             (uint32_t)(list->base + literal->span.begin)};
    }
    return is_fine;
}

static void batches_work(void *client, size_t begin, size_t end)
{
    Batches *batches = client;
    for (size_t i = begin; i < end; i++) {
        if (!batch_fill(&batches->items[i], batches->scene)) {
            atomic_store(&batches->has_odd, true);
        }
    }
}

static void batches_place(Batches *batches, const GrammarLiterals *lists)
{
    const Scene *scene = batches->scene;
    MaterialIndex index;
    const Material *known = scene_last_material(scene, &index);
    Material last = known != NULL ? *known : (Material){.finish = RECORD_NONE};
    for (size_t i = 0; i < batches->count; i++) {
        const GrammarLiterals *list = &lists[i];
        bool goes_on = memcmp(&last, &list->items[0].kind, sizeof last) == 0;
        batches->items[i] = (Batch){.list = list,
                                    .first_sphere = scene->spheres.count + batches->spheres,
                                    .first_material = scene->materials.count + batches->materials,
                                    .before = index,
                                    .goes_on = goes_on};
        batches->spheres += list->count;
        batches->materials += list->changes - goes_on;
        index = batches->materials > 0 ? (MaterialIndex)(scene->materials.count + batches->materials - 1) : index;
        memcpy(&last, &list->items[list->count - 1].kind, sizeof last);
    }
}

static uint64_t source_of_first(const GrammarLiterals *lists)
{
    return lists[0].base + lists[0].items[0].span.begin;
}

// Whether the places in the text have one upper half.
static bool sources_are_near(const GrammarLiterals *lists, size_t count)
{
    const GrammarLiterals *last = &lists[count - 1];
    uint64_t end = last->base + last->items[last->count - 1].span.begin;
    return source_of_first(lists) >> 32 == end >> 32;
}

static bool grows(size_t wanted, size_t capacity)
{
    return wanted > capacity;
}

// Whether there is room for so many, in all limits; if the lists must grow, for those that seem to follow, too, of which
// each takes a `share` of a material.
static bool reserve(Eval *ev, size_t spheres, size_t materials, size_t more, double share)
{
    Scene *scene = ev->scene;
    if (scene_shapes_in_all(scene) + spheres > ev->options.limits->objects) {
        return false;
    }
    // A little more than that, since it is a guess. Where it is too much, they grow as they need to.
    double all = (double)spheres + 1.02 * (double)more;
    size_t all_spheres = grows(scene->spheres.count + spheres, scene->spheres.capacity) ? (size_t)all : 0;
    size_t all_materials =
        grows(scene->materials.count + materials, scene->materials.capacity) ? (size_t)(all * share) + 1 : 0;
    if (memory_has(ev, all_spheres * sizeof(Sphere) + all_materials * sizeof(Material)) &&
        !scene_reserve_spheres(scene, all_spheres, all_materials)) {
        return false;
    }
    return scene_reserve_spheres(scene, spheres, materials) && memory_has(ev, 0);
}

// Where each differing material is added.
static bool take_side_by_side(Eval *ev, const GrammarLiterals *lists, size_t count, size_t more)
{
    Batches batches = {.scene = ev->scene, .count = count, .items = malloc(count * sizeof *batches.items)};
    if (batches.items == NULL) {
        return false;
    }
    batches_place(&batches, lists);
    double share = (double)batches.materials / (double)batches.spheres;
    bool is_taken = reserve(ev, batches.spheres, batches.materials, more, share);
    if (is_taken) {
        parallel_share(ev->options.threads, count, 1, batches_work, &batches);
        is_taken = !atomic_load(&batches.has_odd);
    }
    if (is_taken) {
        scene_commit_spheres(ev->scene, batches.spheres, batches.materials, source_of_first(lists));
    }
    free(batches.items);
    return is_taken;
}

static bool list_has_odd(const GrammarLiterals *list)
{
    Material material;
    bool is_fine = true;
    for (size_t i = 0; i < list->count; i++) {
        is_fine = literal_material(&list->items[i], &material) && is_fine;
    }
    return !is_fine;
}

// Writes a list's records behind the end of the scene's list. False when out of memory.
static bool list_fill(Scene *scene, const GrammarLiterals *list, Sphere *sphere)
{
    MaterialIndex index = 0;
    Material material;
    size_t repeated = 0;
    for (size_t i = 0; i < list->count; i++) {
        const GrammarLiteral *literal = &list->items[i];
        bool is_like = i > 0 && memcmp(&literal->kind, &literal[-1].kind, sizeof literal->kind) == 0;
        repeated += is_like;
        if (!is_like) {
            scene_repeat_material(scene, repeated);
            repeated = 0;
            (void)literal_material(literal, &material);
            if (!scene_add_material_record(scene, &material, &index)) {
                return false;
            }
        }
        sphere[i] = (Sphere){literal_centre(literal), literal->radius, index,
                             (uint32_t)(list->base + literal->span.begin)};
    }
    scene_repeat_material(scene, repeated);
    return true;
}

// Where materials are looked for among those that there are: one after the other.
static bool take_in_order(Eval *ev, const GrammarLiterals *lists, size_t count, size_t more)
{
    Scene *scene = ev->scene;
    size_t spheres = 0, changes = 0;
    for (size_t i = 0; i < count; i++) {
        spheres += lists[i].count;
        changes += lists[i].changes;
        if (list_has_odd(&lists[i])) {
            return false;
        }
    }
    if (!reserve(ev, spheres, changes, more, 0.0)) {
        return false;
    }
    for (size_t i = 0, done = 0; i < count; done += lists[i++].count) {
        if (!list_fill(scene, &lists[i], &scene->spheres.items[scene->spheres.count + done])) {
            return false; // one by one it will be told
        }
    }
    scene_commit_spheres(scene, spheres, 0, source_of_first(lists));
    return true;
}

// The same records in the same order as one by one. What may come to a fault is left to that.
static bool take_many(void *client, const GrammarLiterals *lists, size_t count, size_t more)
{
    Eval *ev = eval_of(client);
    return !eval_cancelled(ev) && sources_are_near(lists, count) &&
           (scene_materials_add_up(ev->scene) ? take_side_by_side(ev, lists, count, more)
                                              : take_in_order(ev, lists, count, more));
}

void literal_hooks(Eval *ev, GrammarHooks *hooks)
{
    hooks->literal_state = &ev->literal.state;
    hooks->literal_watch = watch;
    hooks->literal_learn = learn;
    hooks->literal = ev->options.no_literals ? NULL : take;
    hooks->literals = take_many;
    hooks->literal_threads = ev->options.threads;
    hooks->literal_piece = ev->options.literal_piece;
}
