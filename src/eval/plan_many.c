// Many spheres at once: statements of a text whose plans are direct become records side by side.
//
// What comes of it are the same records in the same order as one by one. What may come to a fault is left to that.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "eval/plan.h"
#include "scene/many.h"

// A list of statements, and where its records go.
typedef struct Batch {
    const GrammarStatements *list;
    Material first, last;
    size_t changes;       // materials that are not that of the sphere before, the first one among them
    bool has_odd;         // there is one that must be left
    size_t first_sphere, first_material;
    MaterialIndex before; // the material before the list, which its first sphere has, too, …
    bool goes_on;         // … when this is true
} Batch;

typedef struct Batches {
    Scene *scene;
    Batch *items;
    size_t count, spheres, changes, materials;
} Batches;

static bool is_like(const Material *one, const Material *other)
{
    return memcmp(one, other, sizeof *one) == 0;
}

static void batch_count(Batch *batch)
{
    Vec3 centre;
    double radius;
    Material material;
    bool is_fine = true;
    for (size_t i = 0; i < batch->list->count; i++) {
        const GrammarStatement *statement = &batch->list->items[i];
        is_fine = plan_direct(statement->plan, statement->numbers, &centre, &radius, &material) && is_fine;
        if (i == 0) {
            batch->first = material;
        }
        batch->changes += i == 0 || !is_like(&material, &batch->last);
        batch->last = material;
    }
    batch->has_odd = !is_fine;
}

static void batches_count(void *client, size_t begin, size_t end)
{
    Batches *batches = client;
    for (size_t i = begin; i < end; i++) {
        batch_count(&batches->items[i]);
    }
}

// ---- where each differing material is added

// Records are written behind the ends of the scene's lists.
static void batch_fill(const Batch *batch, Scene *scene)
{
    Sphere *sphere = &scene->spheres.items[batch->first_sphere];
    size_t next = batch->first_material;
    MaterialIndex index = batch->before;
    Material last = batch->first;
    for (size_t i = 0; i < batch->list->count; i++, sphere++) {
        const GrammarStatement *statement = &batch->list->items[i];
        Material material;
        (void)plan_direct(statement->plan, statement->numbers, &sphere->centre, &sphere->radius, &material);
        if (i == 0 ? !batch->goes_on : !is_like(&material, &last)) {
            scene->materials.items[index = (MaterialIndex)next++] = material;
        }
        last = material;
        sphere->material = index;
        sphere->source = (uint32_t)statement->span.begin;
    }
}

static void batches_fill(void *client, size_t begin, size_t end)
{
    Batches *batches = client;
    for (size_t i = begin; i < end; i++) {
        batch_fill(&batches->items[i], batches->scene);
    }
}

static void batches_place(Batches *batches)
{
    const Scene *scene = batches->scene;
    MaterialIndex index;
    size_t spheres = 0;
    const Material *known = scene_last_material(scene, &index);
    Material last = known ? *known : (Material){.finish = RECORD_NONE};
    for (size_t i = 0; i < batches->count; i++) {
        Batch *batch = &batches->items[i];
        batch->goes_on = is_like(&last, &batch->first);
        batch->first_sphere = scene->spheres.count + spheres;
        batch->first_material = scene->materials.count + batches->materials;
        batch->before = index;
        spheres += batch->list->count;
        batches->materials += batch->changes - batch->goes_on;
        index = batches->materials > 0 ? (MaterialIndex)(scene->materials.count + batches->materials - 1) : index;
        last = batch->last;
    }
}

// ---- where materials are looked for among those that there are: one after the other

// False when out of memory.
static bool list_fill(Scene *scene, const GrammarStatements *list, Sphere *sphere)
{
    MaterialIndex index = 0;
    Material material, last;
    size_t repeated = 0;
    for (size_t i = 0; i < list->count; i++, sphere++) {
        const GrammarStatement *statement = &list->items[i];
        (void)plan_direct(statement->plan, statement->numbers, &sphere->centre, &sphere->radius, &material);
        bool is_same = i > 0 && is_like(&material, &last);
        repeated += is_same;
        if (!is_same) {
            scene_repeat_material(scene, repeated);
            repeated = 0;
            if (!scene_add_material_record(scene, &material, &index)) {
                return false;
            }
        }
        last = material;
        sphere->material = index;
        sphere->source = (uint32_t)statement->span.begin;
    }
    scene_repeat_material(scene, repeated);
    return true;
}

static bool batches_fill_in_order(const Batches *batches)
{
    Scene *scene = batches->scene;
    Sphere *sphere = &scene->spheres.items[scene->spheres.count];
    for (size_t i = 0; i < batches->count; i++) {
        if (!list_fill(scene, batches->items[i].list, sphere)) {
            return false; // one by one it will be told
        }
        sphere += batches->items[i].list->count;
    }
    return true;
}

// ---- both

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
    bool spheres_grow = scene->spheres.count + spheres > scene->spheres.capacity;
    bool materials_grow = scene->materials.count + materials > scene->materials.capacity;
    size_t all_spheres = spheres_grow ? (size_t)all : 0;
    size_t all_materials = materials_grow ? (size_t)(all * share) + 1 : 0;
    if (memory_has(ev, all_spheres * sizeof(Sphere) + all_materials * sizeof(Material)) &&
        !scene_reserve_spheres(scene, all_spheres, all_materials)) {
        return false;
    }
    return scene_reserve_spheres(scene, spheres, materials) && memory_has(ev, 0);
}

static bool take(Eval *ev, Batches *batches, size_t more)
{
    bool adds_up = scene_materials_add_up(ev->scene);
    uint64_t source = batches->items[0].list->items[0].span.begin;
    if (adds_up) {
        batches_place(batches);
        double share = (double)batches->materials / (double)batches->spheres;
        if (!reserve(ev, batches->spheres, batches->materials, more, share)) {
            return false;
        }
        parallel_share(ev->options.threads, batches->count, 1, batches_fill, batches);
    } else if (!reserve(ev, batches->spheres, batches->changes, more, 0.0) || !batches_fill_in_order(batches)) {
        return false;
    }
    scene_commit_spheres(ev->scene, batches->spheres, batches->materials, source);
    return true;
}

// Whether the places in the text have one upper half.
static bool sources_are_near(const GrammarStatements *lists, size_t count)
{
    const GrammarStatements *last = &lists[count - 1];
    return lists[0].items[0].span.begin >> 32 == last->items[last->count - 1].span.begin >> 32;
}

bool plan_run_all(void *client, const GrammarStatements *lists, size_t count, size_t more)
{
    Eval *ev = ((Splice *)client)->cursor.ev;
    Batches batches = {.scene = ev->scene, .count = count, .items = calloc(count, sizeof *batches.items)};
    bool is_fine = batches.items && !eval_cancelled(ev) && sources_are_near(lists, count);
    for (size_t i = 0; i < count && is_fine; i++) {
        batches.items[i].list = &lists[i];
        batches.spheres += lists[i].count;
    }
    if (is_fine) {
        parallel_share(ev->options.threads, count, 1, batches_count, &batches);
    }
    for (size_t i = 0; i < count && is_fine; i++) {
        batches.changes += batches.items[i].changes;
        is_fine = !batches.items[i].has_odd;
    }
    is_fine = is_fine && take(ev, &batches, more);
    free(batches.items);
    return is_fine;
}
