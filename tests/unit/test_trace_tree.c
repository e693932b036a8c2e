// The tree: it finds what testing every sphere finds, bit for bit, with any instruction set; a power of two changes
// nothing, nor does the number of threads; hostile scenes stay within depth and memory.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unit/tap.h"
#include "unit/trace_scenes.h"

// ---- The tree against testing every sphere.

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
            double away = size * pow(10.0, random_between(random, 0, 12));
            origin = vec3_add_scaled(middle, away, vec3_mul(far_away, random_direction(random)));
        }
        Vec3 towards = vec3_normalize(vec3_sub(sphere->centre, origin));
        Vec3 edge = vec3_add_scaled(sphere->centre, sphere->radius, random_perpendicular(random, towards));
        direction = vec3_normalize(vec3_sub(edge, origin));
    }
    }
    return (Ray){origin, direction};
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
            RayStart start = {hit.shape, vec3_dot(direction, surface.normal) < 0.0, 0};
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
    uint32_t nodes, blocks, spheres, outside; // the last: spheres and nodes that reach out of their box
} TreeFacts;

// Whether a sphere is in a box of the tree, whose sides are rounded outward.
static bool box_holds(const Bvh *bvh, const BvhNode *node, int child, Vec3 centre, double radius)
{
    Vec3 low = vec3_scale(bvh->scale, vec3_sub(vec3_sub(centre, vec3(radius, radius, radius)), bvh->centre));
    Vec3 high = vec3_scale(bvh->scale, vec3_sub(vec3_add(centre, vec3(radius, radius, radius)), bvh->centre));
    return node->box[0][0][child] <= low.x && node->box[1][0][child] <= low.y && node->box[2][0][child] <= low.z &&
           node->box[0][1][child] >= high.x && node->box[1][1][child] >= high.y && node->box[2][1][child] >= high.z;
}

// Whether all boxes of a node are in that of the child that it is.
static bool box_holds_node(const BvhNode *node, int child, const BvhNode *below)
{
    bool holds = true;
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < BVH_WIDTH; i++) {
            bool is_none = below->child[i] == BVH_CHILD_NONE;
            holds = holds && (is_none || (below->box[axis][0][i] >= node->box[axis][0][child] &&
                                          below->box[axis][1][i] <= node->box[axis][1][child]));
        }
    }
    return holds;
}

static void tree_walk(const SphereTable *table, uint32_t at, unsigned depth, TreeFacts *facts)
{
    facts->nodes++;
    facts->depth = depth > facts->depth ? depth : facts->depth;
    for (int i = 0; i < BVH_WIDTH; i++) {
        BvhChild child = table->bvh.nodes[at].child[i];
        if (child & BVH_LEAF) {
            facts->blocks++;
            for (uint32_t k = 0; k < SPHERE_BLOCK; k++) {
                SphereData ball = sphere_table_ball(table, (child & ~BVH_LEAF) * SPHERE_BLOCK + k);
                bool is_there = !isnan(ball.radius_squared);
                facts->spheres += is_there;
                facts->outside += is_there && !box_holds(&table->bvh, &table->bvh.nodes[at], i, ball.centre,
                                                         sqrt(ball.radius_squared));
            }
        } else if (child != BVH_CHILD_NONE) {
            facts->outside += !box_holds_node(&table->bvh.nodes[at], i, &table->bvh.nodes[child]);
            tree_walk(table, child, depth + 1, facts);
        }
    }
}

static void test_tree_shape(size_t family, int count)
{
    Random random = {family};
    Scene scene;
    scene_init(&scene);
    families[family].make(&scene, &random, count);
    Geometry *geometry = prepare(&scene, 0);
    const SphereTable *table = &geometry->spheres;
    TreeFacts facts = {0};
    tree_walk(table, 0, 1, &facts);
    double bytes = (double)geometry_bytes(geometry) / (double)scene.spheres.count;
    tap_ok(facts.depth <= BVH_DEPTH_MOST && facts.nodes == table->bvh.node_count && bytes <= 64.0 &&
               facts.blocks + (table->loose_count > 0) == table->block_count &&
               facts.spheres + table->loose_count == scene.spheres.count && facts.outside == 0,
           "%s, %d: depth %u, %.2f spheres a block, %.0f bytes a sphere", families[family].name, count, facts.depth,
           (double)facts.spheres / facts.blocks, bytes);
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
    tap_ok(geometry->spheres.loose_count == 3, "spheres far larger than the rest stay out of the tree");
    tap_ok(vec3_max_abs(geometry->spheres.bvh.half) / geometry->spheres.bvh.scale < 20,
           "so that the tree is as large as the rest");
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

static bool same_spheres(const SphereTable *a, const SphereTable *b)
{
    return a->count == b->count && a->loose_count == b->loose_count && a->block_count == b->block_count &&
           a->bvh.node_count == b->bvh.node_count &&
           memcmp(a->blocks, b->blocks, a->block_count * sizeof(SphereBlock)) == 0 &&
           memcmp(a->info, b->info, a->block_count * SPHERE_BLOCK * sizeof(ShapeInfo)) == 0 &&
           memcmp(a->bvh.nodes, b->bvh.nodes, a->bvh.node_count * sizeof(BvhNode)) == 0;
}

static bool same_bytes(const Geometry *a, const Geometry *b)
{
    return same_spheres(&a->spheres, &b->spheres) &&
           primitive_equal(&a->shapes.primitives[0], &b->shapes.primitives[0]) &&
           memcmp(&a->shapes.primitives[0].to_world, &b->shapes.primitives[0].to_world, sizeof(Linear)) == 0 &&
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

// ---- Threads and instruction sets.

static void test_threads(size_t family)
{
    Random random = {family + 40};
    Scene scene;
    scene_init(&scene);
    families[family].make(&scene, &random, 150 * 1000); // so many that ranges are cut by all threads
    Geometry *alone = geometry_new_with(&scene, 0, &(GeometryOptions){.threads = 1});
    Geometry *together = geometry_new_with(&scene, 0, &(GeometryOptions){.threads = 5});
    Geometry *last = geometry_new_with(&scene, 0, &(GeometryOptions){.threads = 2, .spent = &scene});
    tap_ok(alone && together && same_spheres(&alone->spheres, &together->spheres),
           "%s: five threads build the same tree as one, bit for bit", families[family].name);
    tap_ok(alone && last && same_spheres(&alone->spheres, &last->spheres) && scene.spheres.count == 0 &&
               !scene.spheres.items,
           "%s: the same is built of a scene whose spheres are given up", families[family].name);
    geometry_free(last);
    geometry_free(alone);
    geometry_free(together);
    scene_fini(&scene);
}

// Hits of the same rays through all kernels that this processor has.
static void test_kernels(size_t family)
{
    Random random = {family + 80};
    Scene scene;
    scene_init(&scene);
    families[family].make(&scene, &random, 800);
    Geometry *geometry = prepare(&scene, 0);
    const SphereKernels *best = geometry->kernels;
    int different = 0;
    int names = 0;
    for (int i = 0; i < 1500; i++) {
        Ray ray = hard_ray(&scene, &random, families[family].size, families[family].middle);
        double t_max = random_bits(&random) % 4 ? (double)INFINITY : random_between(&random, 0, families[family].size);
        Hit expected = {0};
        geometry->kernels = best;
        bool met = closest(geometry, ray, RAY_START_FREE, t_max, &expected);
        names = 0;
        for (const char *name; (name = geometry_isa((size_t)names)); names++) {
            Hit hit = {0};
            geometry->kernels = sphere_kernels_choose(name);
            different += closest(geometry, ray, RAY_START_FREE, t_max, &hit) != met ||
                         (met && (hit.t != expected.t || hit.shape != expected.shape || hit.inside != expected.inside));
            different += geometry_occluded(geometry, TRACE_ALL_FEATURES, ray, RAY_START_FREE, t_max) != met;
        }
    }
    tap_ok(different == 0 && names > 0, "%s: %d instruction sets, %d rays differ", families[family].name, names,
           different);
    geometry_free(geometry);
    scene_fini(&scene);
}

// Tiles of rays from one point, narrow, wide, across an axis, with rays given twice, near and far: the same hits as ray
// by ray.
static void test_tiles(size_t family, int count)
{
    Random random = {family + 120};
    Scene scene;
    scene_init(&scene);
    families[family].make(&scene, &random, count);
    Geometry *geometry = prepare(&scene, 0);
    int different = 0;
    int hits = 0;
    for (int turn = 0; turn < 400; turn++) {
        Ray middle = hard_ray(&scene, &random, families[family].size, families[family].middle);
        Vec3 across = random_perpendicular(&random, middle.direction);
        Vec3 down = vec3_cross(middle.direction, across);
        double step = pow(10, random_between(&random, -8, -1));
        Ray rays[TILE_RAYS];
        SphereTile tile = {.origin = middle.origin};
        TileHits found;
        for (int i = 0; i < TILE_RAYS; i++) {
            int x = turn % 5 == 0 && i % 8 > 5 ? 5 : i % 8;
            Vec3 towards = vec3_add_scaled(middle.direction, step * (x - 3.5), across);
            rays[i] = (Ray){middle.origin, vec3_normalize(vec3_add_scaled(towards, step * (i / 8 - 3.5), down))};
            SphereRay ray = sphere_ray_make(rays[i].origin, rays[i].direction);
            sphere_tile_set(&tile, (unsigned)i, &ray);
        }
        for (size_t isa = 0; geometry_isa(isa); isa++) {
            geometry->kernels = sphere_kernels_choose(geometry_isa(isa));
            query_tile_closest(geometry, TRACE_ALL_FEATURES, &tile, true, &found);
            for (int i = 0; i < TILE_RAYS; i++) {
                Hit hit = {0};
                bool met = closest(geometry, rays[i], RAY_START_FREE, (double)INFINITY, &hit);
                hits += met;
                different += met ? hit.t != found.t[i] || hit.shape != found.shape[i] ||
                                       hit.inside != (found.inside >> i & 1)
                                 : found.shape[i] != SHAPE_NONE;
            }
        }
    }
    tap_ok(different == 0 && hits > 1000, "%s, %d: tiles of rays hit what the rays hit (%d of %d differ)",
           families[family].name, count, different, hits);
    geometry_free(geometry);
    scene_fini(&scene);
}

static void test_kernel_names(void)
{
    tap_ok(sphere_kernels_choose("z80") == NULL, "an instruction set that is not there is not chosen");
    tap_ok(geometry_isa(0) && strcmp(geometry_isa(0), "plain") == 0, "plain C is always there");
}

int main(void)
{
    test_powers_of_two();
    test_planet_is_loose();
    test_kernel_names();
    for (size_t family = 0; family < RT_COUNT_OF(families); family++) {
        test_tree_is_brute_force(family, 8, 5000);
        test_tree_is_brute_force(family, 9, 5000);
        test_tree_is_brute_force(family, 2000, 2000);
        test_tree_shape(family, 20 * 1000);
        test_tree_shape(family, 150 * 1000);
        test_threads(family);
        test_kernels(family);
        test_tiles(family, 8);
        test_tiles(family, 700);
    }
    return tap_done();
}
