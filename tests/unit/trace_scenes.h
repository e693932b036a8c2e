// Scenes that are hard for a tree, each in its own way, for the tests of the tracer.
//
// SPDX-License-Identifier: MIT
#ifndef UNIT_TRACE_SCENES_H
#define UNIT_TRACE_SCENES_H

#include <math.h>
#include <stdlib.h>

#include "scene/scene.h"
#include "trace/query.h"
#include "unit/random.h"

__attribute__((unused)) static bool closest(const Geometry *g, Ray ray, RayStart start, double t_max, Hit *hit)
{
    return geometry_closest(g, TRACE_ALL_FEATURES, ray, start, t_max, hit);
}

__attribute__((unused)) static void add_sphere(Scene *scene, Vec3 centre, double radius)
{
    if (!scene_add_sphere(scene, centre, radius, 0, 0)) {
        abort();
    }
}

__attribute__((unused)) static Geometry *prepare(const Scene *scene, int exponent)
{
    Geometry *geometry = geometry_new(scene, exponent);
    if (!geometry) {
        abort();
    }
    return geometry;
}

__attribute__((unused)) static void add_ellipsoid(Scene *scene, Transform to_world)
{
    Part ball = {.kind = PART_BALL, .to_world = to_world};
    if (!transform_invert(&to_world, &ball.to_object) || !scene_add_part(scene, &ball)) {
        abort();
    }
}

__attribute__((unused)) static void add_plane(Scene *scene, Vec3 normal, double distance)
{
    if (!scene_add_plane(scene, normal, distance, 0, 0)) {
        abort();
    }
}

__attribute__((unused)) static Vec3 random_point(Random *random, double size)
{
    return random_vec3(random, -size, size);
}

__attribute__((unused)) static void make_cloud(Scene *scene, Random *random, int count)
{
    for (int i = 0; i < count; i++) {
        Vec3 centre = random_point(random, 10);
        add_sphere(scene, centre, random_between(random, 0.05, 0.5));
    }
}

__attribute__((unused)) static void make_far_cloud(Scene *scene, Random *random, int count)
{
    for (int i = 0; i < count; i++) {
        Vec3 centre = vec3_add(vec3(1e6, -1e6, 1e6), random_point(random, 10));
        add_sphere(scene, centre, random_between(random, 0.05, 0.5));
    }
}

__attribute__((unused)) static void make_sizes(Scene *scene, Random *random, int count)
{
    for (int i = 0; i < count; i++) {
        Vec3 centre = random_point(random, 10);
        add_sphere(scene, centre, exp(random_between(random, -25, 1)));
    }
}

__attribute__((unused)) static void make_planet(Scene *scene, Random *random, int count)
{
    add_sphere(scene, vec3(0, -1e6, 0), 1e6);
    make_cloud(scene, random, count);
    add_sphere(scene, vec3(0, 0, 1e5), 1e5 - 30);
    add_sphere(scene, vec3(0, 0, 0), 1e4);
}

__attribute__((unused)) static void make_lattice(Scene *scene, Random *random, int count)
{
    (void)random;
    for (int i = 0; i < count; i++) {
        add_sphere(scene, vec3(i % 16, i / 16 % 16, i / 256), 0.5);
    }
}

__attribute__((unused)) static void make_line(Scene *scene, Random *random, int count)
{
    (void)random;
    for (int i = 0; i < count; i++) {
        add_sphere(scene, vec3(0, i * 0.01, 0), 0.5);
    }
}

__attribute__((unused)) static void make_coincident(Scene *scene, Random *random, int count)
{
    (void)random;
    for (int i = 0; i < count; i++) {
        add_sphere(scene, vec3(1, 2, 3), 4);
    }
}

__attribute__((unused)) static void make_shells(Scene *scene, Random *random, int count)
{
    (void)random;
    for (int i = 0; i < count; i++) {
        add_sphere(scene, vec3(1, 2, 3), 1 + i * 1e-3);
    }
}

__attribute__((unused)) static void make_spread(Scene *scene, Random *random, int count)
{
    for (int i = 0; i < count; i++) {
        double scale = pow(10, random_between(random, -100, 100));
        Vec3 centre = vec3_scale(scale, random_direction(random));
        add_sphere(scene, centre, scale * random_between(random, 0.1, 0.9));
    }
}

typedef struct TraceFamily {
    const char *name;
    void (*make)(Scene *scene, Random *random, int count);
    double size;
    Vec3 middle;
} TraceFamily;

__attribute__((unused)) static const TraceFamily families[] = {
    {"a cloud", make_cloud, 10, {0, 0, 0}},
    {"a cloud at 1e6", make_far_cloud, 10, {1e6, -1e6, 1e6}},
    {"sizes from 1e-11 to 3", make_sizes, 10, {0, 0, 0}},
    {"planets", make_planet, 10, {0, 0, 0}},
    {"a lattice of touching spheres", make_lattice, 20, {8, 8, 8}},
    {"a line", make_line, 2, {0, 2, 0}},
    {"coincident spheres", make_coincident, 10, {1, 2, 3}},
    {"shells", make_shells, 4, {1, 2, 3}},
    {"scales from 1e-100 to 1e100", make_spread, 10, {0, 0, 0}},
};

#endif
