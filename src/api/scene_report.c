// What is reported of a scene only when all its spheres are looked at, where each rank has a part of them.
//
// Each rank picks those of its spheres that something may be reported of: lost beside their coordinates, equal to another,
// around the camera. Rank 0 gets these and reports by what looks over a whole scene, so the messages are those of one
// process.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/session.h"
#include "scene/opaque.h"
#include "scene/range.h"
#include "scene/view.h"

enum { WINDOW = 1 << 20 }; // hashes of all ranks that are compared at a time, about

// Of a sphere, without padding.
typedef struct OddSphere {
    Vec3 centre;
    double radius;
    Material material;
    uint64_t order, source;
} OddSphere;

typedef ARRAY(OddSphere) OddSpheres;

// Lists of all ranks on end; to be freed. Ends all ranks where there is no memory for them.
static void *gather_lists(rt_session *session, const void *own, size_t count, size_t size, size_t *total)
{
    size_t ranks = (size_t)session->sharing.ranks.ranks, most = 0;
    uint64_t length = count, *counts = session_scene_gather(session, &length, sizeof length);
    for (size_t i = 0; i < ranks; i++) {
        most = counts[i] > most ? (size_t)counts[i] : most;
    }
    unsigned char *padded = calloc(most + 1, size);
    if (!padded || most * size > INT32_MAX / 2) {
        session->sharing.ranks.module->stop(RT_FAULT_LIMIT);
        return NULL;
    }
    memcpy(padded, own, count * size);
    unsigned char *all = session_scene_gather(session, padded, most * size + 1);
    *total = 0;
    for (size_t i = 0; i < ranks; i++) {
        memmove(all + *total * size, all + i * (most * size + 1), (size_t)counts[i] * size);
        *total += (size_t)counts[i];
    }
    free(counts);
    free(padded);
    return all;
}

static bool pick(const Scene *scene, OddSpheres *odd, size_t i)
{
    const Sphere *sphere = &scene->spheres.items[i];
    OddSphere one = {sphere->centre, sphere->radius, scene->materials.items[sphere->material],
                      scene_sphere_order(scene, i), scene_sphere_source(scene, i)};
    return ARRAY_PUSH(odd, one);
}

// ---- spheres that are lost

static bool pick_lost(const Scene *scene, OddSpheres *odd)
{
    bool is_whole = true, may_report = scene_range_reports(scene, &scene->survey, &scene->survey);
    for (size_t i = 0; may_report && is_whole && i < scene->spheres.count; i++) {
        const Sphere *sphere = &scene->spheres.items[i];
        SphereSurvey one = {sphere->radius, sphere->radius, vec3_max_abs(sphere->centre), true};
        is_whole = !scene_range_reports(scene, &scene->survey, &one) || pick(scene, odd, i);
    }
    return is_whole;
}

// ---- equal spheres

static uint64_t mix(uint64_t hash, double number)
{
    uint64_t word;
    number += 0.0; // -0 and 0 are one
    memcpy(&word, &number, sizeof word);
    hash = (hash ^ word) * UINT64_C(0x9e3779b97f4a7c15);
    return hash ^ hash >> 32;
}

static uint64_t sphere_hash(const Sphere *sphere)
{
    uint64_t hash = mix(mix(mix(mix(1, sphere->centre.x), sphere->centre.y), sphere->centre.z), sphere->radius);
    return (hash ^ hash >> 29) * UINT64_C(0xbf58476d1ce4e5b9);
}

static int hash_compare(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

// Leaves those of a sorted list that are there more than once.
static size_t keep_doubled(uint64_t *hashes, size_t count)
{
    size_t kept = 0;
    for (size_t i = 1; i < count; i++) {
        if (hashes[i] == hashes[i - 1] && (kept == 0 || hashes[kept - 1] != hashes[i])) {
            hashes[kept++] = hashes[i];
        }
    }
    return kept;
}

typedef struct Window {
    uint64_t number, count; // of windows that all hashes fall into
    ARRAY(uint64_t) hashes; // of own spheres in it
    ARRAY(uint32_t) spheres;
} Window;

static bool window_fill(Window *window, const Scene *scene)
{
    bool is_whole = true;
    window->hashes.count = window->spheres.count = 0;
    for (size_t i = 0; is_whole && i < scene->spheres.count; i++) {
        uint64_t hash = sphere_hash(&scene->spheres.items[i]);
        if ((hash >> 32) * window->count >> 32 == window->number) {
            is_whole = ARRAY_PUSH(&window->hashes, hash) && ARRAY_PUSH(&window->spheres, (uint32_t)i);
        }
    }
    return is_whole;
}

static bool pick_equal(rt_session *session, OddSpheres *odd)
{
    const Scene *scene = &session->scene;
    Window window = {.count = scene->shape_count / WINDOW + 1};
    bool is_whole = true;
    for (; diag_is_on(&session->diags, DIAG_W0444) && window.number < window.count; window.number++) {
        size_t total;
        is_whole = window_fill(&window, scene) && is_whole;
        uint64_t *all = gather_lists(session, window.hashes.items, window.hashes.count, sizeof *all, &total);
        qsort(all, total, sizeof *all, hash_compare);
        size_t doubled = keep_doubled(all, total);
        for (size_t i = 0; doubled > 0 && i < window.hashes.count; i++) {
            if (bsearch(&window.hashes.items[i], all, doubled, sizeof *all, hash_compare)) {
                is_whole = pick(scene, odd, window.spheres.items[i]) && is_whole;
            }
        }
        free(all);
    }
    ARRAY_FREE(&window.hashes);
    ARRAY_FREE(&window.spheres);
    return is_whole;
}

// ---- what the camera sees, and is in

static bool holds(Vec3 centre, double radius, Vec3 point)
{
    return vec3_length(vec3_sub(point, centre)) < radius;
}

// Spheres around the camera; then, of what is in one of these, as much as shows that there is something.
static bool pick_around(rt_session *session, OddSpheres *odd)
{
    enum { ENOUGH = 2 };
    const Scene *scene = &session->scene;
    OddSpheres own = {0};
    size_t total, seen = scene_first_seen(scene);
    bool is_whole = seen == scene->spheres.count || pick(scene, odd, seen);
    for (size_t i = 0; is_whole && i < scene->spheres.count; i++) {
        const Sphere *sphere = &scene->spheres.items[i];
        if (holds(sphere->centre, sphere->radius, scene->camera.location) &&
            scene_material_is_opaque(scene, sphere->material)) {
            is_whole = pick(scene, &own, i) && pick(scene, odd, i);
        }
    }
    OddSphere *all = gather_lists(session, own.items, own.count, sizeof *all, &total);
    for (size_t outer = 0; outer < total; outer++) {
        int found = 0;
        for (size_t i = 0; is_whole && found < ENOUGH && i < scene->spheres.count; i++) {
            if (holds(all[outer].centre, all[outer].radius, scene->spheres.items[i].centre)) {
                is_whole = pick(scene, odd, i);
                found++;
            }
        }
    }
    free(all);
    ARRAY_FREE(&own);
    return is_whole;
}

// ---- reporting

static int odd_compare(const void *a, const void *b)
{
    uint64_t x = ((const OddSphere *)a)->order, y = ((const OddSphere *)b)->order;
    return (x > y) - (x < y);
}

static bool add_material(Scene *scene, const Material *material, MaterialIndex *index)
{
    *index = (MaterialIndex)scene->materials.count;
    return ARRAY_PUSH(&scene->materials, *material);
}

// Of the spheres, each of which may be there more than once, and of all that each rank has.
static bool odd_scene(Scene *scene, const Scene *whole, OddSphere *odd, size_t count)
{
    bool is_whole = true;
    qsort(odd, count, sizeof *odd, odd_compare);
    for (size_t i = 0; is_whole && i < whole->planes.count; i++) {
        Plane plane = whole->planes.items[i];
        const Material *material = &whole->materials.items[plane.material];
        is_whole = add_material(scene, material, &plane.material) && ARRAY_PUSH(&scene->planes, plane);
    }
    for (size_t i = 0; is_whole && i < count; i++) {
        const OddSphere *from = &odd[i];
        Sphere sphere = {from->centre, from->radius, 0, (uint32_t)from->source};
        SphereRun run = {(uint32_t)scene->spheres.count, (uint32_t)from->order, (uint32_t)(from->source >> 32)};
        if (i == 0 || from->order != odd[i - 1].order) {
            is_whole = add_material(scene, &from->material, &sphere.material) && ARRAY_PUSH(&scene->sphere_runs, run) &&
                       ARRAY_PUSH(&scene->spheres, sphere);
        }
    }
    return is_whole;
}

static bool report(rt_session *session, OddSphere *odd, size_t count)
{
    Scene scene = session->scene; // all but these lists stays the whole scene's
    scene.planes.items = NULL;
    scene.materials.items = NULL;
    scene.spheres.items = NULL;
    scene.sphere_runs.items = NULL;
    scene.planes.count = scene.materials.count = scene.spheres.count = scene.sphere_runs.count = 0;
    scene.planes.capacity = scene.materials.capacity = scene.spheres.capacity = scene.sphere_runs.capacity = 0;
    bool is_whole = odd_scene(&scene, &session->scene, odd, count);
    if (is_whole) {
        scene_warn_of_range(&scene, &session->scene.survey, &session->diags);
        is_whole = scene_warn_of_coincident(&scene, &session->diags, 1);
        scene_hint_of_view(&scene, session->width, session->height, &session->diags);
    }
    ARRAY_FREE(&scene.planes);
    ARRAY_FREE(&scene.materials);
    ARRAY_FREE(&scene.spheres);
    ARRAY_FREE(&scene.sphere_runs);
    return is_whole;
}

bool session_scene_report(rt_session *session)
{
    OddSpheres odd = {0};
    size_t count;
    bool is_whole = pick_lost(&session->scene, &odd);
    is_whole = pick_equal(session, &odd) && is_whole;
    is_whole = pick_around(session, &odd) && is_whole;
    OddSphere *all = gather_lists(session, odd.items, odd.count, sizeof *all, &count);
    ARRAY_FREE(&odd);
    if (is_whole && session->sharing.ranks.rank == 0) {
        is_whole = report(session, all, count);
        diag_finish(&session->diags);
        session_deliver(session);
    }
    free(all);
    if (!is_whole) {
        (void)session_no_memory(session);
    }
    return is_whole && session->diags.error_count == 0;
}
