// Spheres shared by several geometries: what a ray meets through questions and answers is what it meets of all of them
// in one, bit for bit; also where spheres are equal, touch, or hold each other.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "scene/scene.h"
#include "trace/elsewhere.h"
#include "trace/query_surface.h"
#include "unit/tap.h"

enum { SPHERES = 600, PARTS = 3, RAYS = 4000, BOUNCES = 4 };

static uint64_t state = 1;

static double drawn(void)
{
    state = state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(state >> 11) * 0x1p-53;
}

static Vec3 drawn_place(double reach)
{
    double x = drawn(), y = drawn(), z = drawn();
    return vec3(reach * (2.0 * x - 1.0), reach * (2.0 * y - 1.0), reach * (2.0 * z - 1.0));
}

// The whole, or one of the parts. Every third sphere equals an earlier one; some have its centre.
static bool scene_make(Scene *scene, uint32_t part, uint32_t parts)
{
    Vec3 places[SPHERES];
    double radii[SPHERES];
    Finish finish = {.diffuse = 0.6};
    bool is_made = true;
    state = 1;
    scene_init(scene);
    scene->share = (SceneShare){.part = part, .parts = parts};
    for (uint32_t i = 0; i < SPHERES && is_made; i++) {
        MaterialIndex material;
        Rgbft colour = {drawn(), drawn(), 0.5, 0.0, 0.0};
        places[i] = i % 3 == 2 ? places[i - 2] : drawn_place(4.0);
        radii[i] = i % 6 == 2 ? radii[i - 2] : 0.1 + 0.5 * drawn();
        is_made = scene_add_material(scene, colour, &finish, &material) &&
                  scene_add_sphere(scene, places[i], radii[i], material, i + 1);
    }
    scene_end_share(scene);
    return is_made;
}

// Asks the other parts of what is open, until nothing is.
static bool settle(Geometry *const parts[PARTS], int own)
{
    const SphereQuestion *questions;
    size_t count = geometry_questions(parts[own], &questions);
    if (count == 0) {
        return true;
    }
    SphereAnswer *answers = calloc(count * (PARTS - 1), sizeof *answers);
    size_t list = 0;
    for (int part = 0; part < PARTS; part++) {
        if (part != own && !geometry_answer(parts[part], questions, count, &answers[list++ * count])) {
            abort();
        }
    }
    geometry_learn(parts[own], answers, list);
    free(answers);
    return false;
}

static bool closest(Geometry *const parts[PARTS], int own, Ray ray, RayStart start, Hit *hit)
{
    bool is_met;
    do {
        is_met = geometry_closest(parts[own], TRACE_ALL_FEATURES, ray, start, (double)INFINITY, hit);
    } while (!settle(parts, own));
    return is_met;
}

static bool occluded(Geometry *const parts[PARTS], int own, Ray ray, RayStart start, double t_max)
{
    bool is_dark;
    do {
        is_dark = geometry_occluded(parts[own], TRACE_ALL_FEATURES, ray, start, t_max);
    } while (!settle(parts, own));
    return is_dark;
}

static bool surfaces_are_equal(const Scene *scene, const Geometry *part, const Surface *a, const Surface *b)
{
    const Material *one = &scene->materials.items[a->material], *other = &geometry_materials(part)[b->material];
    return a->order == b->order && vec3_equal(a->point, b->point) && vec3_equal(a->normal, b->normal) &&
           one->red == other->red && one->green == other->green;
}

// A ray and those that continue from where it meets something, to either side.
static bool path_is_equal(const Scene *scene, const Geometry *whole, Geometry *const parts[PARTS], int own)
{
    Ray ray = {drawn_place(6.0), vec3_normalize(drawn_place(1.0))};
    RayStart one = RAY_START_FREE, other = RAY_START_FREE;
    bool is_equal = true;
    for (int i = 0; i < BOUNCES && is_equal; i++) {
        Hit hit, shared;
        double t_max = 6.0 * drawn();
        bool is_met = geometry_closest(whole, TRACE_ALL_FEATURES, ray, one, (double)INFINITY, &hit);
        is_equal =
            closest(parts, own, ray, other, &shared) == is_met &&
            geometry_occluded(whole, TRACE_ALL_FEATURES, ray, one, t_max) == occluded(parts, own, ray, other, t_max);
        if (!is_met || !is_equal) {
            break;
        }
        Surface surface = geometry_surface(whole, TRACE_ALL_FEATURES, ray, hit);
        Surface met = geometry_surface(parts[own], TRACE_ALL_FEATURES, ray, shared);
        is_equal =
            hit.t == shared.t && hit.inside == shared.inside && surfaces_are_equal(scene, parts[own], &surface, &met);
        bool inward = drawn() < 0.5;
        Vec3 towards = vec3_normalize(drawn_place(1.0));
        bool is_out = vec3_dot(towards, surface.normal) > 0.0;
        ray = (Ray){surface.point, is_out == inward ? vec3_neg(towards) : towards};
        one = (RayStart){hit.shape, inward, 0};
        other = (RayStart){shared.shape, inward, 0};
    }
    return is_equal && geometry_forget(parts[own]);
}

int main(void)
{
    Scene whole_scene, scenes[PARTS];
    Geometry *parts[PARTS] = {NULL};
    size_t spheres = 0;
    bool is_made = scene_make(&whole_scene, 0, 1);
    Geometry *whole = geometry_new(&whole_scene, 0);
    for (uint32_t i = 0; i < PARTS; i++) {
        is_made = scene_make(&scenes[i], i, PARTS) && is_made;
        parts[i] = geometry_new_with(&scenes[i], 0, &(GeometryOptions){.threads = 1, .is_shared = true});
        is_made = is_made && parts[i];
        spheres += scenes[i].spheres.count;
    }
    if (!tap_ok(is_made && whole, "geometries of a whole and of its parts")) {
        return tap_done();
    }
    tap_ok(spheres == SPHERES && scenes[1].shape_count == SPHERES, "each sphere is in one part, and all are counted");
    int wrong = 0;
    for (int i = 0; i < RAYS; i++) {
        wrong += !path_is_equal(&whole_scene, whole, parts, i % PARTS);
    }
    tap_ok(wrong == 0, "%d paths meet the same; %d do not", RAYS, wrong);
    geometry_free(whole);
    scene_fini(&whole_scene);
    for (int i = 0; i < PARTS; i++) {
        geometry_free(parts[i]);
        scene_fini(&scenes[i]);
    }
    return tap_done();
}
