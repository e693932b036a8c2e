// Geometry: the tree finds what testing every sphere finds, bit for bit; secondary rays neither meet what they leave
// nor miss what they touch; a power of two changes nothing; hostile scenes stay within depth and memory.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene.h"
#include "trace/query.h"
#include "unit/random.h"
#include "unit/tap.h"

static const double U = DBL_EPSILON / 2;

static bool closest(const Geometry *g, Ray ray, RayStart start, double t_max, Hit *hit)
{
    return geometry_closest(g, TRACE_ALL_FEATURES, ray, start, t_max, hit);
}

static void add_sphere(Scene *scene, Vec3 centre, double radius)
{
    if (!scene_add_sphere(scene, centre, radius, 0, 0)) {
        abort();
    }
}

static Geometry *prepare(const Scene *scene, int exponent)
{
    Geometry *geometry = geometry_new(scene, exponent);
    if (!geometry) {
        abort();
    }
    return geometry;
}

static void add_ellipsoid(Scene *scene, Transform to_world)
{
    Transform to_object;
    if (!transform_invert(&to_world, &to_object) || !scene_add_ellipsoid(scene, &to_world, &to_object, 0, 0)) {
        abort();
    }
}

static void add_plane(Scene *scene, Vec3 normal, double distance)
{
    if (!scene_add_plane(scene, normal, distance, 0, 0)) {
        abort();
    }
}

// ---- Scenes that are hard for a tree, each in its own way.

static Vec3 random_point(Random *random, double size)
{
    return vec3(random_between(random, -size, size), random_between(random, -size, size),
                random_between(random, -size, size));
}

static void make_cloud(Scene *scene, Random *random, int count)
{
    for (int i = 0; i < count; i++) {
        add_sphere(scene, random_point(random, 10), random_between(random, 0.05, 0.5));
    }
}

static void make_far_cloud(Scene *scene, Random *random, int count)
{
    for (int i = 0; i < count; i++) {
        add_sphere(scene, vec3_add(vec3(1e6, -1e6, 1e6), random_point(random, 10)), random_between(random, 0.05, 0.5));
    }
}

static void make_sizes(Scene *scene, Random *random, int count)
{
    for (int i = 0; i < count; i++) {
        add_sphere(scene, random_point(random, 10), exp(random_between(random, -25, 1)));
    }
}

static void make_planet(Scene *scene, Random *random, int count)
{
    add_sphere(scene, vec3(0, -1e6, 0), 1e6);
    make_cloud(scene, random, count);
    add_sphere(scene, vec3(0, 0, 1e5), 1e5 - 30);
    add_sphere(scene, vec3(0, 0, 0), 1e4);
}

static void make_lattice(Scene *scene, Random *random, int count)
{
    (void)random;
    for (int i = 0; i < count; i++) {
        add_sphere(scene, vec3(i % 16, i / 16 % 16, i / 256), 0.5);
    }
}

static void make_line(Scene *scene, Random *random, int count)
{
    (void)random;
    for (int i = 0; i < count; i++) {
        add_sphere(scene, vec3(0, i * 0.01, 0), 0.5);
    }
}

static void make_coincident(Scene *scene, Random *random, int count)
{
    (void)random;
    for (int i = 0; i < count; i++) {
        add_sphere(scene, vec3(1, 2, 3), 4);
    }
}

static void make_shells(Scene *scene, Random *random, int count)
{
    (void)random;
    for (int i = 0; i < count; i++) {
        add_sphere(scene, vec3(1, 2, 3), 1 + i * 1e-3);
    }
}

static void make_spread(Scene *scene, Random *random, int count)
{
    for (int i = 0; i < count; i++) {
        double scale = pow(10, random_between(random, -100, 100));
        add_sphere(scene, vec3_scale(scale, random_direction(random)), scale * random_between(random, 0.1, 0.9));
    }
}

static const struct {
    const char *name;
    void (*make)(Scene *scene, Random *random, int count);
    double size;
    Vec3 middle;
} families[] = {
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

// ---- The tree against testing every sphere.

// Every sphere in order of declaration; a later one has to be strictly nearer.
static double brute_force(const Scene *scene, const SphereRay *ray, const Ball *start, bool inward, double t_max,
                          uint32_t *order)
{
    double t_best = t_max;
    *order = UINT32_MAX;
    for (size_t i = 0; i < scene->spheres.count; i++) {
        Ball ball = ball_make(scene->spheres.items[i].centre, scene->spheres.items[i].radius);
        bool inside;
        double t = ball_equal(&ball, start) ? (inward ? sphere_root_inward(ray, &ball) : (double)NAN)
                                            : sphere_hit(ray, &ball, &inside);
        if (t > 0.0 && t < t_best) {
            t_best = t;
            *order = scene->spheres.items[i].order;
        }
    }
    return t_best;
}

// Free rays: any, along axes (zeros of both signs), in planes of boxes, grazing a sphere, from near and far.
static Ray hard_ray(const Scene *scene, Random *random, double size, Vec3 middle)
{
    static const double zeros[2] = {0.0, -0.0};
    Vec3 origin = vec3_add(middle, random_point(random, size));
    const Sphere *sphere = &scene->spheres.items[random_bits(random) % scene->spheres.count];
    Vec3 direction = random_direction(random);
    uint64_t bits = random_bits(random);
    switch (bits % 4) {
    case 0: break;
    case 1: {
        double along = bits & 16 ? 1.0 : -1.0;
        double zero = zeros[bits >> 5 & 1];
        direction = bits & 64    ? vec3(along, zero, -zero)
                    : bits & 128 ? vec3(zero, along, zero)
                                 : vec3(-zero, zero, along);
        if (bits & 256) {
            Vec3 side = vec3_mul(vec3(bits & 512 ? 1 : -1, bits & 1024 ? 1 : -1, bits & 2048 ? 1 : -1),
                                 vec3(sphere->radius, sphere->radius, sphere->radius));
            origin = vec3_add(sphere->centre, side);
            origin = vec3_add_scaled(origin, -3 * sphere->radius, direction);
        }
        break;
    }
    case 2: direction = vec3_normalize(vec3_sub(sphere->centre, origin)); break;
    default: {
        if (bits & 16) {
            // From very far and nearly along an axis, the touching sphere and its box end together.
            Vec3 far_away = {bits & 32 ? 1 : 0.01, bits & 64 ? 1 : 0.01, bits & 128 ? 1 : 0.01};
            origin = vec3_add_scaled(middle, size * pow(10.0, random_between(random, 0, 12)),
                                     vec3_mul(far_away, random_direction(random)));
        }
        Vec3 towards = vec3_normalize(vec3_sub(sphere->centre, origin));
        Vec3 edge = vec3_add_scaled(sphere->centre, sphere->radius, random_perpendicular(random, towards));
        direction = vec3_normalize(vec3_sub(edge, origin));
    }
    }
    return (Ray){origin, direction};
}

// True when the tree and the list agree on what the ray meets; *hit is that.
static bool same_hit(const Scene *scene, const Geometry *geometry, Ray ray, RayStart start, double t_max, bool *met,
                     Hit *hit)
{
    SphereRay sphere_ray = sphere_ray_make(ray.origin, ray.direction);
    Ball start_ball = query_start_ball(geometry, start);
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
    const ShapeInfo *info = &geometry->spheres.info[shape_index(hit->shape)];
    return info->order == order ||
           (start.inward && ball_equal(&geometry->spheres.balls[shape_index(hit->shape)], &start_ball));
}

static void test_tree_is_brute_force(size_t family, int count, int rays)
{
    Random random = {family * 100 + (unsigned)count};
    Scene scene;
    scene_init(&scene);
    families[family].make(&scene, &random, count);
    Geometry *geometry = prepare(&scene, 0);
    int different = 0;
    int hits = 0;
    for (int i = 0; i < rays; i++) {
        Ray ray = hard_ray(&scene, &random, families[family].size, families[family].middle);
        double t_max = random_bits(&random) % 4 ? (double)INFINITY : random_between(&random, 0, families[family].size);
        bool met;
        Hit hit = {0};
        different += !same_hit(&scene, geometry, ray, RAY_START_FREE, t_max, &met, &hit);
        if (met) {
            hits++;
            Surface surface = geometry_surface(geometry, TRACE_ALL_FEATURES, ray, hit);
            Vec3 direction = random_direction(&random);
            RayStart start = {hit.shape, vec3_dot(direction, surface.normal) < 0.0};
            Ray next = {surface.point, direction};
            different += !same_hit(&scene, geometry, next, start, (double)INFINITY, &met, &hit);
        }
    }
    tap_ok(different == 0 && hits > rays / 50, "%s, %d: the tree is brute force (%d of %d rays differ, %d hits)",
           families[family].name, count, different, rays + hits, hits);
    geometry_free(geometry);
    scene_fini(&scene);
}

// ---- The shape of the tree.

typedef struct TreeFacts {
    unsigned depth;
    uint32_t largest_leaf;
    size_t spheres;
} TreeFacts;

static void tree_walk(const Bvh *bvh, uint32_t at, unsigned depth, TreeFacts *facts)
{
    facts->depth = depth > facts->depth ? depth : facts->depth;
    for (int child = 0; child < 2; child++) {
        uint32_t count = bvh->nodes[at].count[child];
        if (count == 0) {
            tree_walk(bvh, bvh->nodes[at].first[child], depth + 1, facts);
        }
        facts->spheres += count;
        facts->largest_leaf = count > facts->largest_leaf ? count : facts->largest_leaf;
    }
}

static void test_tree_shape(size_t family, int count)
{
    Random random = {family};
    Scene scene;
    scene_init(&scene);
    families[family].make(&scene, &random, count);
    Geometry *geometry = prepare(&scene, 0);
    TreeFacts facts = {0};
    tree_walk(&geometry->bvh, 0, 1, &facts);
    double bytes = (double)geometry_bytes(geometry) / (double)scene.spheres.count;
    tap_ok(facts.depth < BVH_DEPTH_MOST && facts.largest_leaf <= BVH_LEAF_MOST && bytes <= 150.0 &&
               facts.spheres + geometry->loose_count == scene.spheres.count,
           "%s, %d: depth %u, leaves <= %u, %.0f bytes a sphere", families[family].name, count, facts.depth,
           facts.largest_leaf, bytes);
    geometry_free(geometry);
    scene_fini(&scene);
}

static void test_planet_is_loose(void)
{
    Random random = {3};
    Scene scene;
    scene_init(&scene);
    make_planet(&scene, &random, 1000);
    Geometry *geometry = prepare(&scene, 0);
    tap_ok(geometry->loose_count == 3, "spheres far larger than the rest stay out of the tree");
    tap_ok(vec3_max_abs(geometry->bvh.half) / geometry->bvh.scale < 20, "so that the tree is as large as the rest");
    geometry_free(geometry);
    scene_fini(&scene);
}

// ---- Powers of two.

static void make_everything(Scene *scene, int exponent)
{
    Random random = {11};
    for (int i = 0; i < 500; i++) {
        Vec3 centre = random_point(&random, 10);
        double scale = ldexp(1.0, exponent);
        add_sphere(scene, vec3_scale(scale, centre), scale * random_between(&random, 0.05, 0.5));
    }
    Transform to_world = transform_compose(transform_scale(vec3(1, 2, 3)), transform_rotate(vec3(10, 20, 30)));
    to_world = transform_compose(to_world, transform_translate(vec3(1, 2, 3)));
    for (int i = 0; i < 12; i++) {
        to_world.m[i / 3][i % 3] = ldexp(to_world.m[i / 3][i % 3], exponent);
    }
    add_ellipsoid(scene, to_world);
    add_plane(scene, vec3(0.6, 0.8, 0), ldexp(-3, exponent));
}

static bool same_bytes(const Geometry *a, const Geometry *b)
{
    return a->spheres.count == b->spheres.count && a->loose_count == b->loose_count &&
           a->bvh.node_count == b->bvh.node_count &&
           memcmp(a->spheres.balls, b->spheres.balls, a->spheres.count * sizeof(Ball)) == 0 &&
           memcmp(a->spheres.info, b->spheres.info, a->spheres.count * sizeof(ShapeInfo)) == 0 &&
           memcmp(a->bvh.nodes, b->bvh.nodes, a->bvh.node_count * sizeof(BvhNode)) == 0 &&
           memcmp(&a->ellipsoids[0].shape, &b->ellipsoids[0].shape, sizeof(EllipsoidShape)) == 0 &&
           memcmp(&a->planes[0].shape, &b->planes[0].shape, sizeof(PlaneShape)) == 0;
}

static void test_powers_of_two(void)
{
    Scene scene;
    scene_init(&scene);
    make_everything(&scene, 0);
    Geometry *geometry = prepare(&scene, 4);
    for (int k = -400; k <= 400; k += 160) {
        Scene scaled;
        scene_init(&scaled);
        make_everything(&scaled, k);
        Geometry *other = prepare(&scaled, 4 + k);
        tap_ok(same_bytes(geometry, other), "a scene scaled by 2^%d is the same geometry, bit for bit", k);
        geometry_free(other);
        scene_fini(&scaled);
    }
    geometry_free(geometry);
    scene_fini(&scene);
}

// ---- Secondary rays.

typedef struct SecondaryCounts {
    int rays, false_shadows, wrong_exits, missed_contacts;
} SecondaryCounts;

// A ray from outside enters the sphere that `hit` is on: it leaves by the far side, and meets nothing beyond.
static bool exits_rightly(const Geometry *geometry, Ray ray, Hit hit, Surface surface, double radius)
{
    Ray within = {surface.point, ray.direction};
    Hit exit;
    if (!closest(geometry, within, (RayStart){hit.shape, true}, (double)INFINITY, &exit) || exit.shape != hit.shape ||
        !exit.inside) {
        return false;
    }
    double cosine = -vec3_dot(surface.normal, ray.direction);
    double expected = 2.0 * radius * cosine;
    // Bound of the rule, (3/|cos| + 3) u, and as much again for the rounding of the point and of `expected`; the point
    // is known to u of its coordinates only.
    double uncertainty = (6.0 / cosine + 6.0) * U * expected + 8.0 * U * vec3_max_abs(surface.point) / cosine;
    Surface far_side = geometry_surface(geometry, TRACE_SPHERES, within, exit);
    Ray beyond = {far_side.point, ray.direction};
    Hit none;
    return fabs(exit.t - expected) <= uncertainty &&
           !closest(geometry, beyond, (RayStart){exit.shape, false}, (double)INFINITY, &none);
}

static void secondary_case(Random *random, double scale, SecondaryCounts *counts)
{
    double radius = scale * pow(10.0, random_bits(random) % 4 ? 0.0 : random_between(random, 0, 12));
    double offset = random_bits(random) % 2 ? 0.0 : scale * pow(10.0, random_between(random, 0, 6));
    Vec3 centre = vec3_scale(offset, random_direction(random));
    Vec3 outward = random_direction(random);
    Ray ray = {vec3_add_scaled(centre, radius * random_between(random, 1.5, 4), outward), {0, 0, 0}};
    Vec3 aim = vec3_add_scaled(centre, radius * 0.999 * sqrt(random_between(random, 0, 1)),
                               random_perpendicular(random, outward));
    ray.direction = vec3_normalize(vec3_sub(aim, ray.origin));
    Scene scene;
    scene_init(&scene);
    add_sphere(&scene, centre, radius);
    Geometry *geometry = prepare(&scene, 0);
    Hit hit;
    if (closest(geometry, ray, RAY_START_FREE, (double)INFINITY, &hit)) {
        counts->rays++;
        Surface surface = geometry_surface(geometry, TRACE_SPHERES, ray, hit);
        Vec3 grazing = random_perpendicular(random, surface.normal);
        grazing = vec3_normalize(vec3_add_scaled(grazing, pow(10.0, random_between(random, -15, -1)), surface.normal));
        RayStart leaving = {hit.shape, false};
        counts->false_shadows += geometry_occluded(geometry, TRACE_SPHERES, (Ray){surface.point, grazing}, leaving,
                                                   (double)INFINITY);
        counts->wrong_exits += !exits_rightly(geometry, ray, hit, surface, radius);
        geometry_free(geometry);
        // A second sphere nearly touches the point that was hit, by a gap that the coordinates still resolve.
        double resolution = 16.0 * U * (vec3_max_abs(surface.point) + radius);
        double gap = resolution + radius * pow(10.0, random_between(random, -15, 0));
        double other_radius = radius * random_between(random, 0.1, 1);
        add_sphere(&scene, vec3_add_scaled(surface.point, other_radius + gap, surface.normal), other_radius);
        geometry = prepare(&scene, 0);
        Hit contact;
        bool met = closest(geometry, (Ray){surface.point, surface.normal}, leaving, (double)INFINITY, &contact);
        counts->missed_contacts += !met || contact.inside || fabs(contact.t - gap) > resolution;
    }
    geometry_free(geometry);
    scene_fini(&scene);
}

static void test_secondary_rays(void)
{
    for (int power = -12; power <= 12; power += 4) {
        Random random = {(uint64_t)(power + 50)};
        SecondaryCounts counts = {0};
        for (int i = 0; i < 30 * 1000; i++) {
            secondary_case(&random, pow(10.0, power), &counts);
        }
        tap_ok(counts.rays > 29000 && counts.false_shadows == 0 && counts.wrong_exits == 0 &&
                   counts.missed_contacts == 0,
               "scale 1e%d: %d false shadows, %d wrong exits, %d missed contacts of %d", power, counts.false_shadows,
               counts.wrong_exits, counts.missed_contacts, counts.rays);
    }
}

// ---- Kinds of shapes, equal distances, ends of intervals.

static void test_shapes(void)
{
    Scene scene;
    scene_init(&scene);
    add_sphere(&scene, vec3(0, 0, 0), 1);
    add_ellipsoid(&scene, transform_compose(transform_scale(vec3(1, 1, 2)), transform_translate(vec3(10, 0, 0))));
    add_plane(&scene, vec3(0, 1, 0), -3);
    static const struct {
        const char *name;
        Ray ray;
        RayStart start;
        double t_max;
        bool met;
        Hit hit;
    } cases[] = {
        {"sphere", {{0, 0, -5}, {0, 0, 1}}, {SHAPE_NONE, false}, 9, true, {4, 0u << 30, false}},
        {"sphere, interval open at its end", {{0, 0, -5}, {0, 0, 1}}, {SHAPE_NONE, false}, 4, false, {0, 0, false}},
        {"sphere from inside", {{0, 0, 0}, {0, 0, 1}}, {SHAPE_NONE, false}, 9, true, {1, 0u << 30, true}},
        {"sphere, leaving outward", {{0, 0, 1}, {0, 0, 1}}, {0, false}, 9, false, {0, 0, false}},
        {"sphere, leaving inward", {{0, 0, -1}, {0, 0, 1}}, {0, true}, 9, true, {2, 0, true}},
        {"sphere, inward but not going in", {{0, 0, 1}, {0, 0, 1}}, {0, true}, 9, false, {0, 0, false}},
        {"ellipsoid", {{10, 0, -5}, {0, 0, 1}}, {SHAPE_NONE, false}, 9, true, {3, 1u << 30, false}},
        {"ellipsoid across", {{15, 0, 0}, {-1, 0, 0}}, {SHAPE_NONE, false}, 9, true, {4, 1u << 30, false}},
        {"ellipsoid, leaving outward", {{10, 0, 2}, {0, 0, 1}}, {1u << 30, false}, 9, false, {0, 0, false}},
        {"ellipsoid, leaving inward", {{10, 0, -2}, {0, 0, 1}}, {1u << 30, true}, 9, true, {4, 1u << 30, true}},
        {"plane from its outer side", {{3, 0, 3}, {0, -1, 0}}, {SHAPE_NONE, false}, 9, true, {3, 2u << 30, false}},
        {"plane from its inner side", {{3, -5, 3}, {0, 1, 0}}, {SHAPE_NONE, false}, 9, true, {2, 2u << 30, true}},
        {"plane, leaving it", {{3, -3.0000001, 3}, {0, 1, 0}}, {2u << 30, false}, 9, false, {0, 0, false}},
        {"plane, along it", {{3, -3, 3}, {1, 0, 0}}, {SHAPE_NONE, false}, 9, false, {0, 0, false}},
        {"plane behind", {{3, 0, 3}, {0, 1, 0}}, {SHAPE_NONE, false}, 9, false, {0, 0, false}},
    };
    Geometry *geometry = prepare(&scene, 0);
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        Hit hit = {0};
        bool met = closest(geometry, cases[i].ray, cases[i].start, cases[i].t_max, &hit);
        bool occluded = geometry_occluded(geometry, TRACE_ALL_FEATURES, cases[i].ray, cases[i].start, cases[i].t_max);
        tap_ok(met == cases[i].met && occluded == met &&
                   (!met || (hit.t == cases[i].hit.t && hit.shape == cases[i].hit.shape &&
                             hit.inside == cases[i].hit.inside)),
               "%s", cases[i].name);
    }
    Ray ray = {{10.5, 0.5, -5}, {0, 0, 1}};
    Hit hit = {0};
    bool met = closest(geometry, ray, RAY_START_FREE, (double)INFINITY, &hit);
    Surface surface = geometry_surface(geometry, TRACE_ALL_FEATURES, ray, hit);
    Vec3 p = vec3_sub(surface.point, vec3(10, 0, 0));
    Vec3 gradient = vec3_normalize(vec3(p.x, p.y, p.z / 4));
    tap_ok(met && fabs(p.x * p.x + p.y * p.y + p.z * p.z / 4 - 1) < 8 * U &&
               vec3_max_abs(vec3_sub(surface.normal, gradient)) < 8 * U,
           "an ellipsoid's point and normal");
    tap_ok(geometry_features(geometry) == (TRACE_SPHERES | TRACE_ELLIPSOIDS | TRACE_PLANES), "features are told");
    geometry_free(geometry);
    scene_fini(&scene);
}

// Coincident shapes are one surface, and the one declared first is seen.
static void test_equal_distances(void)
{
    Scene scene;
    scene_init(&scene);
    Transform stretch = transform_scale(vec3(1, 3, 1));
    add_plane(&scene, vec3(0, 0, 1), -1);
    add_sphere(&scene, vec3(0, 0, 0), 1);
    add_ellipsoid(&scene, stretch);
    add_ellipsoid(&scene, stretch);
    add_sphere(&scene, vec3(0, 0, 0), 1);
    add_plane(&scene, vec3(0, 0, 1), -1);
    Geometry *geometry = prepare(&scene, 0);
    Ray ray = {{0, 0, -5}, {0, 0, 1}};
    Hit hit = {0};
    bool met = closest(geometry, ray, RAY_START_FREE, (double)INFINITY, &hit);
    tap_ok(met && hit.shape == shape_id(SHAPE_PLANE, 0), "the plane, declared first, is seen");
    geometry_free(geometry);
    scene.spheres.items[1].order = 0;
    scene.planes.items[0].order = 4;
    geometry = prepare(&scene, 0);
    met = closest(geometry, ray, RAY_START_FREE, (double)INFINITY, &hit);
    tap_ok(met && hit.shape == shape_id(SHAPE_SPHERE, 1), "now the sphere");
    const ShapeId equals[] = {shape_id(SHAPE_SPHERE, 0), shape_id(SHAPE_SPHERE, 1)};
    int self_hits = 0;
    Random random = {1};
    for (int i = 0; i < 1000; i++) {
        Vec3 normal = random_direction(&random);
        for (size_t k = 0; k < RT_COUNT_OF(equals); k++) {
            self_hits += geometry_occluded(geometry, TRACE_SPHERES, (Ray){normal, normal},
                                           (RayStart){equals[k], false}, (double)INFINITY);
        }
    }
    tap_ok(self_hits == 0, "a sphere does not shade its equal");
    geometry_free(geometry);
    scene_fini(&scene);
}

static void test_not_numbers(void)
{
    static const double odd[] = {NAN, INFINITY, -INFINITY};
    Random random = {2};
    Scene scene;
    scene_init(&scene);
    make_cloud(&scene, &random, 100);
    add_sphere(&scene, vec3(0, 0, 0), 100);
    add_ellipsoid(&scene, transform_scale(vec3(100, 200, 300)));
    add_plane(&scene, vec3(0, 1, 0), -3);
    add_sphere(&scene, vec3(0, 0, 0), 0);
    add_sphere(&scene, vec3(0, NAN, 0), 1);
    add_sphere(&scene, vec3(0, 0, 0), (double)INFINITY);
    Geometry *geometry = prepare(&scene, 0);
    int met = 0;
    for (size_t i = 0; i < RT_COUNT_OF(odd); i++) {
        for (int input = 0; input < 6; input++) {
            double v[6] = {0.1, 0.2, 0.3, 0.6, 0.8, 0};
            v[input] = odd[i];
            Ray ray = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
            Hit hit;
            met += closest(geometry, ray, RAY_START_FREE, (double)INFINITY, &hit);
            met += geometry_occluded(geometry, TRACE_ALL_FEATURES, ray, RAY_START_FREE, (double)INFINITY);
        }
    }
    Hit hit;
    met += closest(geometry, (Ray){{0, 0, 0}, {0, 0, 0}}, RAY_START_FREE, (double)INFINITY, &hit);
    met += closest(geometry, (Ray){{0, 0, 0}, {0, 0, 1}}, RAY_START_FREE, (double)NAN, &hit);
    tap_ok(met == 0, "rays that are not finite, or have no direction, meet nothing (%d did)", met);
    tap_ok(geometry->spheres.count == 101, "spheres that nothing can meet are left out");
    geometry_free(geometry);
    scene_fini(&scene);
}

static void test_empty(void)
{
    Scene scene;
    scene_init(&scene);
    Geometry *geometry = prepare(&scene, 0);
    Hit hit;
    tap_ok(geometry_features(geometry) == 0 &&
               !closest(geometry, (Ray){{0, 0, 0}, {0, 0, 1}}, RAY_START_FREE, (double)INFINITY, &hit),
           "an empty scene has no features and no hits");
    geometry_free(geometry);
    scene_fini(&scene);
}

int main(void)
{
    test_empty();
    test_shapes();
    test_equal_distances();
    test_not_numbers();
    test_powers_of_two();
    test_planet_is_loose();
    for (size_t family = 0; family < RT_COUNT_OF(families); family++) {
        test_tree_is_brute_force(family, 8, 5000);
        test_tree_is_brute_force(family, 9, 5000);
        test_tree_is_brute_force(family, 2000, 2000);
        test_tree_shape(family, 20 * 1000);
    }
    test_secondary_rays();
    return tap_done();
}
