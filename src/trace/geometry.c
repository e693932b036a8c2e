// Scene shapes prepared for rays: scaled, put into arrays of their kind, and the many spheres into a tree.
//
// Everything is worked out from the scaled lengths alone, so that a scene scaled by 2^k and prepared with an exponent
// greater by k gives the same Geometry bit for bit.
//
// SPDX-License-Identifier: MIT
#include "trace/geometry.h"

#include <math.h>
#include <stdlib.h>

enum {
    RADIUS_SAMPLES = 255, // radii that the median is taken of
    // A sphere this many times larger than the median is kept out of the tree. A planet under a million grains would
    // otherwise make every box on its way to the root as large as itself.
    LARGE_RADIUS_RATIO = 32,
};

static Vec3 vec3_ldexp(Vec3 a, int exponent)
{
    return vec3(ldexp(a.x, exponent), ldexp(a.y, exponent), ldexp(a.z, exponent));
}

// The linear part only, with every entry times 2^exponent.
static Transform linear_ldexp(const Transform *transform, int exponent)
{
    Transform linear = {0};
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++) {
            linear.m[row][column] = ldexp(transform->m[row][column], exponent);
        }
    }
    return linear;
}

static Ball ball_of(const Sphere *sphere, int exponent)
{
    return ball_make(vec3_ldexp(sphere->centre, -exponent), ldexp(sphere->radius, -exponent));
}

static int double_compare(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

// The square of the radius above which a sphere is large; infinite when there would be too many of them.
static double large_radius_squared(const Ball *balls, uint32_t count)
{
    double samples[RADIUS_SAMPLES];
    uint32_t sample_count = count < RADIUS_SAMPLES ? count : RADIUS_SAMPLES;
    for (uint32_t i = 0; i < sample_count; i++) {
        samples[i] = balls[(uint64_t)i * count / sample_count].radius_squared;
    }
    qsort(samples, sample_count, sizeof(samples[0]), double_compare);
    double limit = samples[sample_count / 2] * (LARGE_RADIUS_RATIO * LARGE_RADIUS_RATIO);
    uint32_t large_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        large_count += balls[i].radius_squared > limit;
    }
    bool enough_left = count - large_count > BVH_LEAF_MOST;
    return large_count <= LOOSE_SPHERES_MOST && enough_left ? limit : (double)INFINITY;
}

// The spheres that a ray can meet, the loose ones first; numbers[i] is the place of ball i in the scene.
static void spheres_gather(Geometry *geometry, const Scene *scene, int exponent, Ball *balls, uint32_t *numbers)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->spheres.count; i++) {
        Ball ball = ball_of(&scene->spheres.items[i], exponent);
        if (ball_is_usable(&ball)) {
            balls[count] = ball;
            numbers[count++] = i;
        }
    }
    geometry->spheres.count = count;
    if (count <= LOOSE_SPHERES_MOST) {
        geometry->loose_count = count;
        return;
    }
    double limit = large_radius_squared(balls, count);
    for (uint32_t i = 0; i < count; i++) {
        if (balls[i].radius_squared > limit) {
            uint32_t place = geometry->loose_count++;
            Ball ball = balls[i];
            uint32_t number = numbers[i];
            balls[i] = balls[place];
            numbers[i] = numbers[place];
            balls[place] = ball;
            numbers[place] = number;
        }
    }
}

static void spheres_place(Geometry *geometry, const Scene *scene, const Ball *balls, const uint32_t *numbers,
                          const uint32_t *tree_order)
{
    for (uint32_t i = 0; i < geometry->spheres.count; i++) {
        uint32_t from = i < geometry->loose_count ? i : geometry->loose_count + tree_order[i - geometry->loose_count];
        const Sphere *sphere = &scene->spheres.items[numbers[from]];
        geometry->spheres.balls[i] = balls[from];
        geometry->spheres.info[i] = (ShapeInfo){sphere->material, sphere->order};
    }
}

static bool spheres_init(Geometry *geometry, const Scene *scene, int exponent)
{
    size_t count = scene->spheres.count;
    if (count == 0) {
        return true;
    }
    Ball *balls = malloc(count * sizeof(*balls));
    uint32_t *numbers = malloc(count * sizeof(*numbers));
    uint32_t *tree_order = malloc(count * sizeof(*tree_order));
    bool done = balls && numbers && tree_order;
    if (done) {
        spheres_gather(geometry, scene, exponent, balls, numbers);
        uint32_t loose = geometry->loose_count;
        uint32_t in_tree = geometry->spheres.count - loose;
        geometry->features |= in_tree ? TRACE_SPHERE_BVH : TRACE_SPHERES;
        done = in_tree == 0 || bvh_init(&geometry->bvh, balls + loose, in_tree, loose, tree_order);
    }
    if (done) {
        geometry->spheres.balls = malloc(count * sizeof(*geometry->spheres.balls));
        geometry->spheres.info = malloc(count * sizeof(*geometry->spheres.info));
        done = geometry->spheres.balls && geometry->spheres.info;
    }
    if (done) {
        spheres_place(geometry, scene, balls, numbers, tree_order);
    }
    free(balls);
    free(numbers);
    free(tree_order);
    return done;
}

static bool ellipsoids_init(Geometry *geometry, const Scene *scene, int exponent)
{
    size_t count = scene->ellipsoids.count;
    if (count == 0) {
        return true;
    }
    geometry->ellipsoids = malloc(count * sizeof(*geometry->ellipsoids));
    if (!geometry->ellipsoids) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        const Ellipsoid *from = &scene->ellipsoids.items[i];
        const double *origin = from->to_world.m[3];
        geometry->ellipsoids[i] = (EllipsoidEntry){
            .shape = {.centre = vec3_ldexp(vec3(origin[0], origin[1], origin[2]), -exponent),
                      .to_world = linear_ldexp(&from->to_world, -exponent),
                      .to_object = linear_ldexp(&from->to_object, exponent)},
            .info = {from->material, from->order},
        };
    }
    geometry->ellipsoid_count = (uint32_t)count;
    geometry->features |= TRACE_ELLIPSOIDS;
    return true;
}

static bool planes_init(Geometry *geometry, const Scene *scene, int exponent)
{
    size_t count = scene->planes.count;
    if (count == 0) {
        return true;
    }
    geometry->planes = malloc(count * sizeof(*geometry->planes));
    if (!geometry->planes) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        const Plane *from = &scene->planes.items[i];
        geometry->planes[i] = (PlaneEntry){
            .shape = {from->normal, ldexp(from->distance, -exponent)},
            .info = {from->material, from->order},
        };
    }
    geometry->plane_count = (uint32_t)count;
    geometry->features |= TRACE_PLANES;
    return true;
}

Geometry *geometry_new(const Scene *scene, int exponent)
{
    Geometry *geometry = calloc(1, sizeof(*geometry));
    if (!geometry) {
        return NULL;
    }
    if (!spheres_init(geometry, scene, exponent) || !ellipsoids_init(geometry, scene, exponent) ||
        !planes_init(geometry, scene, exponent)) {
        geometry_free(geometry);
        return NULL;
    }
    return geometry;
}

void geometry_free(Geometry *geometry)
{
    if (geometry) {
        free(geometry->spheres.balls);
        free(geometry->spheres.info);
        free(geometry->ellipsoids);
        free(geometry->planes);
        bvh_fini(&geometry->bvh);
        free(geometry);
    }
}

unsigned geometry_features(const Geometry *geometry)
{
    return geometry->features;
}

size_t geometry_bytes(const Geometry *geometry)
{
    return sizeof(*geometry) + geometry->spheres.count * (sizeof(Ball) + sizeof(ShapeInfo)) +
           geometry->bvh.node_count * sizeof(BvhNode) + geometry->ellipsoid_count * sizeof(EllipsoidEntry) +
           geometry->plane_count * sizeof(PlaneEntry);
}
