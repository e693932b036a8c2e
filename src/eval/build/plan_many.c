// Many spheres at once: statements of a text whose plans are direct become records on any thread, and then the scene's.
//
// What comes of it are the same records in the same order as one by one. What may come to a fault is left to that.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "eval/build/plan.h"
#include "scene/many.h"

typedef struct PlanRecord {
    Vec3 centre;
    double radius;
    Material material;
    uint64_t source;
} PlanRecord;

const size_t plan_record_bytes = sizeof(PlanRecord);

bool plan_prepare(const GrammarPlan *plan, const double *numbers, uint64_t begin, void *record)
{
    PlanRecord *to = record;
    to->source = begin;
    return plan_direct(plan, numbers, &to->centre, &to->radius, &to->material);
}

// Bit for bit; a call of memcmp takes longer than all else that is done with a record.
static inline bool is_repeated(const PlanRecord *records, size_t i)
{
    uint64_t one[3], other[3];
    _Static_assert(sizeof one == sizeof records->material, "a material is three words");
    if (i == 0) {
        return false;
    }
    memcpy(one, &records[i].material, sizeof one);
    memcpy(other, &records[i - 1].material, sizeof other);
    return ((one[0] ^ other[0]) | (one[1] ^ other[1]) | (one[2] ^ other[2])) == 0;
}

static size_t count_materials(const PlanRecord *records, size_t count)
{
    size_t materials = 0;
    for (size_t i = 0; i < count; i++) {
        materials += !is_repeated(records, i);
    }
    return materials;
}

// Whether there is room for so many, in all limits; if the lists must grow, for those that seem to follow, too.
static bool reserve(Eval *ev, size_t spheres, size_t materials, size_t more)
{
    Scene *scene = ev->scene;
    if (scene_shapes_in_all(scene) + spheres > ev->options.limits->objects) {
        return false;
    }
    // A little more than that, since it is a guess. Where it is too much, they grow as they need to.
    double all = (double)spheres + 1.02 * (double)more;
    double share = scene_materials_add_up(scene) ? (double)materials / (double)spheres : 0.0;
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

bool plan_pass(void *client, size_t count)
{
    Eval *ev = client;
    return scene_pass_spheres(ev->scene, count);
}

bool plan_exchange(void *client, const GrammarRound *own, GrammarRound *all)
{
    Eval *ev = client;
    bool goes_on = ev->options.share->exchange(ev->options.client, own, all, sizeof *own);
    ev->stop = ev->stop || !goes_on;
    return goes_on;
}

bool plan_keep(void *client, const void *list, size_t count, size_t more)
{
    Eval *ev = client;
    Scene *scene = ev->scene;
    const PlanRecord *records = list;
    // The places in the text have one upper half.
    bool are_near = records[0].source >> 32 == records[count - 1].source >> 32;
    // They are counted when there may be no room for them.
    bool may_grow = scene->materials.count + count > scene->materials.capacity;
    size_t materials = may_grow ? count_materials(records, count) : 0;
    if (!are_near || eval_cancelled(ev) || !reserve(ev, count, materials, more)) {
        return false;
    }
    Sphere *sphere = &scene->spheres.items[scene->spheres.count];
    MaterialIndex index = 0;
    size_t repeated = 0;
    for (size_t i = 0; i < count; i++) {
        const PlanRecord *record = &records[i];
        if (is_repeated(records, i)) {
            repeated++;
        } else {
            scene_repeat_material(scene, repeated);
            repeated = 0;
            bool is_added = i > 0 ? scene_add_other_material(scene, &record->material, &index)
                                  : scene_add_material_record(scene, &record->material, &index);
            if (!is_added) {
                return false; // one by one it will be reported
            }
        }
        sphere[i] = (Sphere){record->centre, record->radius, index, (uint32_t)record->source};
    }
    scene_repeat_material(scene, repeated);
    if (ev->tells_plan) { // before there are shapes of it, as of any statement
        eval_tell_statement(ev, (Span){records[0].source, records[0].source + 1});
    }
    scene_commit_spheres(scene, count, records[0].source);
    return true;
}
