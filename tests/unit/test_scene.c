// Scene records: materials are kept once, shapes keep their order, the dump says everything, validation finds what no
// ray could be traced against.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "scene/range.h"
#include "scene/scene_extent.h"
#include "scene/scene.h"
#include "tap.h"
#include "unit/random.h"

static bool add_material(Scene *scene, double red, double diffuse, MaterialIndex *index)
{
    Finish finish = {.diffuse = diffuse};
    return scene_add_material(scene, (Rgbft){red, 0.5, 0.25, 0.0, 0.0}, &finish, index);
}

static void test_materials(void)
{
    Scene scene;
    bool is_fine = true;
    scene_init(&scene);
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < 1000; i++) {
            MaterialIndex index = UINT32_MAX;
            is_fine = add_material(&scene, i, 1.0 / (1 + i % 3), &index) && index == (uint32_t)i && is_fine;
        }
    }
    tap_ok(is_fine && scene.materials.count == 1000, "a thousand materials, given twice, are kept once and in order");
    tap_ok(scene.finishes.count == 3 && scene.materials.items[4].finish == 1, "and the three finishes they share");
    MaterialIndex first, second, third;
    is_fine = add_material(&scene, 0.0, 1.0, &first) && add_material(&scene, -0.0, 1.0, &second) &&
              add_material(&scene, 0.0, 0.5, &third);
    tap_ok(is_fine && first == 0 && second != first && third != first && third != second,
           "materials are compared bit by bit, finish and all");
    scene_fini(&scene);
    tap_ok(scene.materials.count == 0 && scene.material_index.slots.items == NULL, "scene_fini leaves an empty scene");
}

static bool build_scene(Scene *scene)
{
    Transform stretch = transform_scale(vec3(1.0, 2.0, 3.0));
    Primitive ball = {.kind = PRIMITIVE_SPHERE, .to_world = stretch, .source = 9};
    MaterialIndex index;
    scene_init(scene);
    return transform_invert(&stretch, &ball.to_object) && add_material(scene, 0.1, 0.6, &index) &&
           scene_add_sphere(scene, vec3(0.0, 1.0, -0.1), 0.5, index, 7) &&
           scene_add_plane(scene, vec3(0.0, 1.0, 0.0), -1.0, index, 8) && scene_add_primitive(scene, &ball) &&
           scene_add_sphere(scene, vec3(1e300, 1.0, 1.0 / 3.0), 1e-9, index, 10);
}

static void test_order_and_dump(void)
{
    Scene scene;
    TextBuffer out;
    text_init(&out);
    tap_ok(build_scene(&scene) && scene.shape_count == 4 && scene_sphere_order(&scene, 1) == 3 &&
               scene.planes.items[0].order == 1 && scene.primitives.items[0].order == 2,
           "shapes are numbered in the order of declaration over all kinds");
    scene.settings.version = 3.7;
    scene.settings.gamma_model = GAMMA_POWER;
    scene.settings.assumed_gamma = 2.2;
    scene_dump(&scene, &out);
    const char *text = text_get(&out);
    const char *wanted[] = {
        "#version 3.7;\nglobal_settings {\n  assumed_gamma 2.2\n",
        "#declare M1 = texture { pigment { rgbft <0.10000000149011612, 0.5, 0.25, 0, 0> } finish { F1 } }\n",
        "sphere { <0, 1, -0.1>, 0.5 texture { M1 } }\nplane { <0, 1, 0>, -1 texture { M1 } }\n"
        "sphere { 0, 1 matrix <1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0> texture { M1 } }\n"
        "sphere { <1e300, 1, 0.3333333333333333>, 1e-9 texture { M1 } }\n",
    };
    for (size_t i = 0; i < RT_COUNT_OF(wanted); i++) {
        tap_ok(strstr(text, wanted[i]) != NULL, "the dump has part %zu", i);
    }
    text_fini(&out);
    scene_fini(&scene);
}

static void test_gamma_dump(void)
{
    static const struct {
        GammaModel model;
        double gamma, version;
        const char *begins;
    } cases[] = {
        {GAMMA_NONE, 1.0, SCENE_VERSION_UNSAID, "global_settings {\n  ambient_light"},
        {GAMMA_NONE, 1.0, 3.5, "#version 3.5;\nglobal_settings {\n  ambient_light"},
        {GAMMA_LINEAR, 1.0, 3.7, "#version 3.7;\nglobal_settings {\n  assumed_gamma 1\n"},
        {GAMMA_SRGB, 1.0, 3.1, "#version 3.1;\nglobal_settings {\n  assumed_gamma srgb\n"},
        {GAMMA_POWER, 1.8, 3.7, "#version 3.7;\nglobal_settings {\n  assumed_gamma 1.8\n"},
    };
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        Scene scene;
        TextBuffer out;
        scene_init(&scene);
        text_init(&out);
        scene.settings.gamma_model = cases[i].model;
        scene.settings.assumed_gamma = cases[i].gamma;
        scene.settings.version = cases[i].version;
        scene_dump(&scene, &out);
        tap_ok(strncmp(text_get(&out), cases[i].begins, strlen(cases[i].begins)) == 0, "gamma case %zu", i);
        text_fini(&out);
        scene_fini(&scene);
    }
}

typedef void (*Spoil)(Scene *scene);

static void spoil_nothing(Scene *scene)
{
    (void)scene;
}

static void spoil_camera(Scene *scene)
{
    scene->camera.up.z = NAN;
}

static void spoil_light(Scene *scene)
{
    Light light = {.position = {0.0, INFINITY, 0.0}};
    if (!scene_add_light(scene, &light)) {
        scene->camera.up.z = NAN; // out of memory shows as another code
    }
}

static void spoil_all_shapes(Scene *scene)
{
    scene->spheres.count = scene->primitives.count = scene->planes.count = 0;
    scene->shape_count = 0;
}

static void spoil_radius(Scene *scene)
{
    scene->spheres.items[1].radius = 0.0;
}

static void spoil_material(Scene *scene)
{
    scene->planes.items[0].material = 1;
}

static void spoil_inverse(Scene *scene)
{
    scene->primitives.items[0].to_object.m[2][2] = INFINITY;
}

static void spoil_finish(Scene *scene)
{
    scene->finishes.items[0].roughness = NAN;
}

static void test_validation(void)
{
    static const struct {
        const char *name;
        Spoil spoil;
        size_t errors;
        DiagCode code; // of the last record; a warning when there is no error
    } cases[] = {
        {"a whole scene, with a sphere beyond the range", spoil_nothing, 0, DIAG_W0442},
        {"camera", spoil_camera, 1, DIAG_E0410},
        {"light", spoil_light, 1, DIAG_E0411},
        {"finish", spoil_finish, 1, DIAG_E0412},
        {"radius", spoil_radius, 1, DIAG_E0413},
        {"material", spoil_material, 1, DIAG_E0413},
        {"inverse of a matrix", spoil_inverse, 1, DIAG_E0413},
        {"no shapes", spoil_all_shapes, 0, DIAG_W0403},
    };
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        Scene scene;
        DiagSink diags;
        SourceMap *sources = source_map_new();
        bool is_built = build_scene(&scene);
        diag_init(&diags, sources);
        cases[i].spoil(&scene);
        bool is_valid = scene_validate(&scene, &diags, 1);
        tap_ok(is_built && is_valid == (cases[i].errors == 0) && diags.error_count == cases[i].errors &&
                   diags.count > 0 && diags.items[diags.count - 1].code == cases[i].code,
               "validation of %s", cases[i].name);
        tap_ok(diags.items[0].code == DIAG_W0401, "validation warns of the missing camera: %s", cases[i].name);
        diag_fini(&diags);
        source_map_free(sources);
        scene_fini(&scene);
    }
}

// Spheres in turn with planes, from places in the text on both sides of 2^32.
static void test_runs(void)
{
    enum { SPHERES = 40 };
    Scene scene;
    uint32_t orders[SPHERES];
    uint64_t sources[SPHERES];
    scene_init(&scene);
    bool is_fine = true, is_told = true;
    for (uint32_t i = 0; i < SPHERES; i++) {
        for (uint32_t k = 0; i % 7 == 3 && k < i % 3; k++) {
            is_fine = is_fine && scene_add_plane(&scene, vec3(0.0, 1.0, 0.0), i, 0, 1);
        }
        orders[i] = scene.shape_count;
        sources[i] = i % 5 == 4 ? 0 : ((uint64_t)(i / 10) << 32) + 10 * i;
        is_fine = is_fine && scene_add_sphere(&scene, vec3(i, 0.0, 0.0), 1.0, 0, sources[i]);
    }
    for (uint32_t i = 0, at = 0; i < scene.shape_count; i++) {
        bool is_sphere = at < SPHERES && orders[at] == i;
        is_told = is_told && scene_sphere_at(&scene, i) == (is_sphere ? at : RECORD_NONE);
        is_told = is_told && (!is_sphere || (scene_sphere_order(&scene, at) == i &&
                                             scene_sphere_source(&scene, at) == sources[at]));
        at += is_sphere;
    }
    tap_ok(is_fine && is_told && scene_sphere_at(&scene, scene.shape_count) == RECORD_NONE,
           "each sphere's place among all shapes, and where it was written");
    // Many at once, as grammar and evaluator add them.
    is_fine = scene_reserve_spheres(&scene, 2, 0);
    if (is_fine) {
        Sphere *sphere = &scene.spheres.items[SPHERES];
        sphere[0] = sphere[1] = (Sphere){{0.0, 0.0, 0.0}, 2.0, 0, 77};
        scene_commit_spheres(&scene, 2, (UINT64_C(9) << 32) + 5);
    }
    tap_ok(is_fine && scene_sphere_source(&scene, SPHERES + 1) == (UINT64_C(9) << 32) + 77 &&
               scene_sphere_order(&scene, SPHERES + 1) == scene.shape_count - 1,
           "and of many at once");
    scene_fini(&scene);
}

enum { CROWD = 50 * 1000, CROWD_TWINS = 6, ROUND_TWINS = 3 };

// Equal spheres here and there among very many, and shapes that are round in another way, alone and in a composite.
// Each was written at its place in the order of declaration + 1.
static bool make_crowd(Scene *scene, const uint32_t twins[CROWD_TWINS][2])
{
    Random random = {3};
    Finish finish = {.diffuse = 0.6};
    MaterialIndex clear; // two surfaces of it are not one
    bool is_made = scene_add_material(scene, (Rgbft){0.5, 0.5, 0.5, 0.0, 0.5}, &finish, &clear);
    uint32_t index = 0;
    for (uint32_t i = 0, twin = 0; i < CROWD && is_made; i++) {
        Vec3 centre = random_vec3(&random, -9.0, 9.0);
        centre.z = i;
        if (twin < CROWD_TWINS && twins[twin][1] == i) {
            centre = scene->spheres.items[twins[twin++][0]].centre;
        }
        is_made = scene_add_sphere(scene, centre, 1.0, 0, i + 1);
    }
    for (uint32_t i = 0; i < ROUND_TWINS && is_made; i++) { // in the way of the last one stands something else
        Primitive primitive = {.kind = PRIMITIVE_SPHERE, .node = NODE_NONE, .source = CROWD + i + 1};
        primitive.to_world =
            transform_translate(i == 2 ? vec3(1e6, 0.0, 0.0) : scene->spheres.items[7 + 30000 * i].centre);
        is_made = scene_add_primitive(scene, &primitive);
    }
    Primitive leaf = {.kind = PRIMITIVE_SPHERE, .source = CROWD + 9};
    leaf.to_world = transform_translate(scene->spheres.items[CROWD - 3].centre);
    is_made = is_made && scene_begin_composite(scene, 0, CROWD + 8) &&
              scene_add_node(scene, NODE_INTERSECTION, false, NODE_NONE, CROWD + 8, &index);
    leaf.node = index;
    is_made = is_made && scene_add_leaf(scene, &leaf);
    if (is_made) {
        scene_end_composite(scene);
    }
    return is_made;
}

static void test_crowd(int threads)
{
    // Numbers of the first and of the second one: in one run of threads and in two, next to each other, three alike.
    static const uint32_t twins[CROWD_TWINS][2] = {{0, 1},         {5, 16000},      {5, 16384},
                                                   {16383, 16385}, {40000, 40040}, {0, CROWD - 1}};
    static const uint64_t round_twins[] = {CROWD + 1, CROWD + 2, CROWD + 9};
    Scene scene;
    SourceMap *sources = source_map_new();
    DiagSink diags;
    diag_init(&diags, sources);
    diags.keep_alike = 100;
    scene_init(&scene);
    bool is_told = make_crowd(&scene, twins) && scene_warn_of_coincident(&scene, &diags, threads) &&
                   diags.count == CROWD_TWINS + RT_COUNT_OF(round_twins);
    for (size_t i = 0; is_told && i < diags.count; i++) {
        const Diag *diag = &diags.items[i];
        uint64_t wanted = i < CROWD_TWINS ? twins[i][1] + 1 : round_twins[i - CROWD_TWINS];
        is_told = diag->code == DIAG_W0444 && diag->span.begin == wanted && diag->note_count == 1;
        is_told = is_told && (i >= CROWD_TWINS || diag->notes[0].span.begin == twins[i][0] + 1);
    }
    tap_ok(is_told, "%d thread(s): the few of %d spheres that have an equal are told, in order", threads, (int)CROWD);
    scene_fini(&scene);
    diag_fini(&diags);
    source_map_free(sources);
}

static void test_reach(void)
{
    Scene scene;
    SceneExtent reach;
    scene_init(&scene);
    scene_extent(&scene, &reach);
    tap_ok(reach.reach == 0.0 && reach.nearest_far == 0.0 && isinf(reach.least_size) && isinf(reach.least_angle),
           "an empty scene has no reach");
    scene_fini(&scene);
    bool is_fine = build_scene(&scene);
    scene.camera.location = vec3(0.0, -30.0, 4.0);
    scene_extent(&scene, &reach);
    tap_ok(is_fine && reach.eye_offset == 30.0 && reach.least_size == 1e-9, "the eye's place and the smallest sphere");
    tap_ok(reach.reach == 1e300 && reach.nearest_far == 1e300 && reach.least_angle == 1e-309,
           "the farthest sphere, and how small it looks: %g", reach.least_angle);
    scene.spheres.count = 1;
    scene_extent(&scene, &reach);
    // The stretched sphere's box reaches from <-1, -2, -3> to <1, 2, 3>.
    tap_ok(reach.least_size == 0.5 && fabs(reach.reach - (sqrt(916.0) + sqrt(14.0))) < 1e-12,
           "a stretched sphere's box");
    scene_fini(&scene);
}

int main(void)
{
    test_materials();
    test_order_and_dump();
    test_gamma_dump();
    test_validation();
    test_runs();
    test_crowd(1);
    test_crowd(3);
    test_reach();
    return tap_done();
}
