// Scenes that are hard for a tree, each in its own way, for the tests of the tracer.
//
// SPDX-License-Identifier: MIT
#ifndef UNIT_TRACE_SCENES_H
#define UNIT_TRACE_SCENES_H

#include <math.h>
#include <stdlib.h>

#include "scene/scene.h"
#include "trace/query_surface.h"
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
    Primitive ball = {.kind = PRIMITIVE_SPHERE, .to_world = to_world};
    if (!transform_invert(&to_world, &ball.to_object) || !scene_add_primitive(scene, &ball)) {
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

// ---- the tree against testing every sphere

// As sphere_hit, for a ray that starts on a sphere: its radius is known better than by where the ray starts.
__attribute__((unused)) static double sphere_hit_from(const SphereRay *ray, const SphereData *ball,
                                                      const SphereData *start, bool *inside)
{
    double t;
    bool is_uncertain = sphere_test(ray, ball, &t, inside) == SPHERE_UNCERTAIN;
    return is_uncertain ? sphere_exact(ray, ball, start, inside) : sphere_hit(ray, ball, inside);
}

// Every sphere in order of declaration; a later one has to be strictly nearer, and so by exact arithmetic where the
// roots are the same but for their last bits.
__attribute__((unused)) static double brute_force(const Scene *scene, const SphereRay *ray, const SphereData *start,
                                                  bool inward, double t_max, uint32_t *order)
{
    double t_best = t_max;
    SphereData best = *start;
    bool best_inside = false;
    *order = UINT32_MAX;
    for (size_t i = 0; i < scene->spheres.count; i++) {
        SphereData ball = sphere_data_make(scene->spheres.items[i].centre, scene->spheres.items[i].radius);
        bool inside = inward;
        double t = sphere_data_equal(&ball, start) ? (inward ? sphere_root_inward(ray, &ball) : (double)NAN)
                                                   : sphere_hit_from(ray, &ball, start, &inside);
        bool is_tie = *order != UINT32_MAX && fabs(t - t_best) <= SPHERE_TIE * t_best;
        if (t > 0.0 && (is_tie ? sphere_roots_compare(ray, &ball, inside, &best, best_inside, t) < 0 : t < t_best)) {
            t_best = t;
            best = ball;
            best_inside = inside;
            *order = scene_sphere_order(scene, i);
        }
    }
    return t_best;
}

// True when the tree and the list agree on what the ray meets; *hit is that.
__attribute__((unused)) static bool same_hit(const Scene *scene, const Geometry *geometry, Ray ray, RayStart start,
                                             double t_max, bool *met, Hit *hit)
{
    SphereRay sphere_ray = sphere_ray_make(ray.origin, ray.direction);
    SphereData start_ball = query_start_sphere(geometry, TRACE_ALL_FEATURES, start).ball;
    uint32_t order;
    double t = brute_force(scene, &sphere_ray, &start_ball, start.inward, t_max, &order);
    *met = closest(geometry, ray, start, t_max, hit);
    if (*met != (order != UINT32_MAX) || *met != geometry_occluded(geometry, TRACE_ALL_FEATURES, ray, start, t_max)) {
        return false;
    }
    if (!*met || hit->t != t) {
        return !*met;
    }
    // Of spheres equal to the one that is left inward any is right: they are one surface.
    SphereData hit_ball = sphere_table_ball(&geometry->spheres, shape_index(hit->shape));
    const ShapeInfo *info = &geometry->spheres.info[shape_index(hit->shape)];
    return info->order == order || (start.inward && sphere_data_equal(&hit_ball, &start_ball));
}

// ---- parts

// A tile of rays about a direction, neighbours `step` apart.
__attribute__((unused)) static void tile_of(Random *random, Vec3 eye, Vec3 towards, double step, SphereTile *tile)
{
    Vec3 across = random_perpendicular(random, towards), down = vec3_cross(towards, across);
    tile->origin = eye;
    for (int i = 0; i < TILE_RAYS; i++) {
        Vec3 at = vec3_add_scaled(towards, step * (i % TILE_ROW - 3.5), across);
        Vec3 direction = vec3_normalize(vec3_add_scaled(at, step * (i / TILE_ROW - 3.5), down));
        SphereRay ray = sphere_ray_make(eye, direction);
        sphere_tile_set(tile, (unsigned)i, &ray);
    }
}

__attribute__((unused)) static Transform random_map(Random *random, double size)
{
    Vec3 powers = random_vec3(random, -2, 2), turn = random_vec3(random, 0, 360);
    Vec3 stretch = vec3(exp(powers.x), exp(powers.y), exp(powers.z));
    Transform map = transform_compose(transform_scale(vec3_scale(size, stretch)), transform_rotate(turn));
    map = transform_compose(map, transform_scale(vec3(1.0, 1.0, exp(random_between(random, -1, 1)))));
    return transform_compose(map, transform_translate(random_point(random, size)));
}

__attribute__((unused)) static Primitive random_primitive(Random *random, PrimitiveKind kind, double size)
{
    Primitive primitive = {.kind = kind, .node = NODE_NONE, .to_world = random_map(random, size)};
    if (!transform_invert(&primitive.to_world, &primitive.to_object)) {
        abort();
    }
    if (kind == PRIMITIVE_BOX) {
        primitive.data[0] = vec3(-1.0, -1.0, -1.0);
        primitive.data[1] = vec3(random_between(random, 0, 1), 1.0, 0.0);
        primitive.data[1].z = random_between(random, -0.5, 1);
    } else if (kind == PRIMITIVE_TORUS) {
        primitive.data[0] = vec3(0.6, random_between(random, 0.01, 0.4), 0.0);
    } else if (kind == PRIMITIVE_CONE || kind == PRIMITIVE_DISC) {
        primitive.data[0].x = random_bits(random) % 3 == 0 ? 1.0 : random_between(random, 0, 0.9);
        primitive.data[0].x = kind == PRIMITIVE_DISC ? 0.5 * primitive.data[0].x : primitive.data[0].x;
    }
    return primitive;
}

__attribute__((unused)) static void add_primitive(Scene *scene, const Primitive *primitive)
{
    if (!scene_add_primitive(scene, primitive)) {
        abort();
    }
}

// ---- families

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
