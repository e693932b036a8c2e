// Any bytes are spheres and rays: the tree of each instruction set finds what testing every sphere finds, bit for bit.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "fuzz/fuzz.h"
#include "unit/trace_scenes.h"

enum { SPHERES_MOST = 300, RAYS_MOST = 60 };

typedef struct Bytes {
    const uint8_t *at, *end;
} Bytes;

static unsigned take(Bytes *bytes)
{
    return bytes->at < bytes->end ? *bytes->at++ : 0;
}

// Few distinct numbers, so that spheres touch and coincide, some of them far larger and smaller than others.
static double number(Bytes *bytes)
{
    unsigned head = take(bytes);
    double value = (double)(int8_t)take(bytes) / 16.0;
    return head % 4 != 0 ? value : ldexp(value, (int)(head / 4) - 31);
}

static Vec3 vector(Bytes *bytes)
{
    Vec3 v;
    v.x = number(bytes);
    v.y = number(bytes);
    v.z = number(bytes);
    return v;
}

static void add_spheres(Scene *scene, Bytes *bytes)
{
    unsigned count = take(bytes) * 2 % SPHERES_MOST, often = 1 + take(bytes) % 4;
    for (unsigned i = 0; i <= count && (i == 0 || bytes->at < bytes->end); i++) {
        Vec3 centre = vector(bytes);
        double radius = fabs(number(bytes));
        for (unsigned n = 0; n < often; n++) { // a row of them
            add_sphere(scene, vec3_add(centre, vec3(n, 0.0, 0.0)), radius > 0.0 ? radius : 1.0);
        }
    }
}

// A ray of any direction, or to the middle of a sphere; from there another along the surface that was met.
static void try_ray(const Scene *scene, Geometry *const *trees, Bytes *bytes)
{
    const Sphere *sphere = &scene->spheres.items[take(bytes) % scene->spheres.count];
    Vec3 origin = vector(bytes), direction = vector(bytes);
    direction = take(bytes) % 2 ? vec3_sub(sphere->centre, origin) : direction;
    double length = vec3_length(direction);
    if (length == 0.0) {
        return;
    }
    Ray ray = {origin, vec3_scale(1.0 / length, direction)};
    for (size_t i = 0; geometry_isa(i); i++) {
        bool is_met;
        Hit hit = {0};
        FUZZ_HOLDS(same_hit(scene, trees[i], ray, RAY_START_FREE, (double)INFINITY, &is_met, &hit));
        if (is_met) {
            Surface surface = geometry_surface(trees[i], TRACE_ALL_FEATURES, ray, hit);
            RayStart start = {hit.shape, vec3_dot(ray.direction, surface.normal) < 0.0, 0};
            Ray next = {surface.point, ray.direction};
            FUZZ_HOLDS(same_hit(scene, trees[i], next, start, (double)INFINITY, &is_met, &hit));
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { ISAS_MOST = 8 };
    Bytes bytes = {data, data + size};
    Geometry *trees[ISAS_MOST] = {NULL};
    Scene scene;
    scene_init(&scene);
    add_spheres(&scene, &bytes);
    for (size_t i = 0; geometry_isa(i); i++) {
        FUZZ_HOLDS(i < ISAS_MOST);
        trees[i] = geometry_new_with(&scene, 0, &(GeometryOptions){.threads = 1, .isa = geometry_isa(i)});
        FUZZ_HOLDS(trees[i] != NULL);
    }
    for (int i = 0; i < RAYS_MOST && bytes.at < bytes.end; i++) {
        try_ray(&scene, trees, &bytes);
    }
    for (size_t i = 0; geometry_isa(i); i++) {
        geometry_free(trees[i]);
    }
    scene_fini(&scene);
    return 0;
}
