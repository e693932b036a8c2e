// Boxes, cones, discs, triangles and composites: hits lie on the surfaces, the tree finds what testing each shape
// finds, rays that leave a shape meet what they must, composites are what their members' insides say, scale changes no
// bit.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <string.h>

#include "trace/geometry.h"
#include "unit/tap.h"
#include "unit/trace_scenes.h"

static const PrimitiveKind solid_kinds[] = {PRIMITIVE_SPHERE, PRIMITIVE_BOX, PRIMITIVE_CONE, PRIMITIVE_TORUS};
static const PrimitiveKind alone_kinds[] = {PRIMITIVE_BOX, PRIMITIVE_CONE, PRIMITIVE_DISC, PRIMITIVE_TRIANGLE,
                                            PRIMITIVE_TORUS};

// How far inside of its fixed shape a point of the scene is, in units of that shape; negative outside.
static double depth(const Primitive *primitive, Vec3 point)
{
    Vec3 p = transform_point(&primitive->to_object, point);
    double round = hypot(p.x, p.y);
    switch (primitive->kind) {
    case PRIMITIVE_SPHERE:
        return 1.0 - vec3_length(p);
    case PRIMITIVE_BOX: {
        Vec3 low = vec3_sub(p, primitive->data[0]), high = vec3_sub(primitive->data[1], p);
        return fmin(fmin(fmin(low.x, low.y), low.z), fmin(fmin(high.x, high.y), high.z));
    }
    case PRIMITIVE_CONE:
        return fmin(1.0 + (primitive->data[0].x - 1.0) * p.z - round, fmin(p.z, 1.0 - p.z));
    case PRIMITIVE_TORUS:
        return primitive->data[0].y - hypot(hypot(p.x, p.z) - primitive->data[0].x, p.y);
    case PRIMITIVE_DISC:
        return fmin(-fabs(p.z), fmin(1.0 - round, round - primitive->data[0].x));
    default: return fmin(-fabs(p.z), fmin(fmin(p.x, p.y), 1.0 - p.x - p.y));
    }
}

static Ray random_ray(Random *random, double size)
{
    Vec3 from = random_point(random, 8.0 * size);
    Vec3 to = random_bits(random) % 4 ? random_point(random, 1.5 * size) : vec3_add(from, vec3(0.0, size, 0.0));
    return (Ray){from, vec3_normalize(vec3_sub(to, from))};
}

// ---- alone

static void test_on_surface(void)
{
    Random random = {1};
    double worst = 0.0;
    int hits = 0, wrong_sides = 0;
    for (int i = 0; i < 4000; i++) {
        Scene scene;
        Primitive primitive = random_primitive(&random, alone_kinds[i % 5], 1.0);
        scene_init(&scene);
        add_primitive(&scene, &primitive);
        Geometry *geometry = prepare(&scene, 0);
        for (int k = 0; k < 20; k++) {
            Ray ray = random_ray(&random, 1.0);
            Hit hit;
            if (!closest(geometry, ray, RAY_START_FREE, (double)INFINITY, &hit)) {
                continue;
            }
            Surface surface = geometry_surface(geometry, TRACE_ALL_FEATURES, ray, hit);
            worst = fmax(worst, fabs(depth(&primitive, surface.point)));
            worst = fmax(worst, vec3_length(vec3_sub(surface.point, ray_at(ray, hit.t))));
            wrong_sides += (vec3_dot(surface.normal, ray.direction) > 0.0) != hit.inside;
            hits++;
        }
        geometry_free(geometry);
        scene_fini(&scene);
    }
    printf("# %d hits, worst %.1e\n", hits, worst);
    // Coordinates below 50, maps of a condition below 1000: 64 of them rounded.
    tap_ok(hits > 10000 && worst < 64.0 * 50.0 * 1000.0 * DBL_EPSILON, "hits lie on the surfaces");
    tap_ok(wrong_sides == 0, "normals point to the side that the hit tells");
}

static void test_tree(void)
{
    enum { COUNT = 700, RAYS = 3000 };
    Random random = {2};
    Scene scene;
    Geometry *single[COUNT];
    scene_init(&scene);
    for (int i = 0; i < COUNT; i++) {
        Primitive primitive = random_primitive(&random, alone_kinds[i % 5], 0.05);
        Scene one;
        scene_init(&one);
        primitive.to_world = transform_compose(primitive.to_world, transform_translate(random_point(&random, 4.0)));
        if (!transform_invert(&primitive.to_world, &primitive.to_object)) {
            abort();
        }
        add_primitive(&scene, &primitive);
        add_primitive(&one, &primitive);
        single[i] = prepare(&one, 0);
        scene_fini(&one);
    }
    Geometry *geometry = prepare(&scene, 0);
    int differ = 0, met = 0, shadows_differ = 0;
    for (int k = 0; k < RAYS; k++) {
        Ray ray = random_ray(&random, 1.0);
        double t = (double)INFINITY;
        Hit hit;
        for (int i = 0; i < COUNT; i++) {
            t = closest(single[i], ray, RAY_START_FREE, t, &hit) ? hit.t : t;
        }
        bool is_met = closest(geometry, ray, RAY_START_FREE, (double)INFINITY, &hit);
        differ += is_met != isfinite(t) || (is_met && hit.t != t);
        shadows_differ += geometry_occluded(geometry, TRACE_ALL_FEATURES, ray, RAY_START_FREE, 5.0) != (t < 5.0);
        met += is_met;
    }
    tap_ok(met > RAYS / 10 && differ == 0, "the tree finds what testing each shape finds (%d of %d differ)", differ,
           RAYS);
    tap_ok(shadows_differ == 0, "and so it does for shadows");
    geometry_free(geometry);
    for (int i = 0; i < COUNT; i++) {
        geometry_free(single[i]);
    }
    scene_fini(&scene);
}

static void test_secondary(double size)
{
    Random random = {3};
    int false_hits = 0, wrong_exits = 0, rays = 0;
    for (int i = 0; i < 1500; i++) {
        Scene scene;
        Primitive primitive = random_primitive(&random, i % 2 ? PRIMITIVE_BOX : PRIMITIVE_CONE, size);
        scene_init(&scene);
        add_primitive(&scene, &primitive);
        Geometry *geometry = prepare(&scene, ilogb(size));
        double unit = ldexp(1.0, -ilogb(size));
        for (int k = 0; k < 20; k++) {
            Ray ray = random_ray(&random, size * unit);
            Hit hit, next;
            if (!closest(geometry, ray, RAY_START_FREE, (double)INFINITY, &hit) || hit.inside) {
                continue;
            }
            Surface surface = geometry_surface(geometry, TRACE_ALL_FEATURES, ray, hit);
            Ray on = {surface.point, random_direction(&random)};
            // Grazing as often as not.
            double rise = vec3_dot(on.direction, surface.normal);
            on.direction =
                vec3_normalize(vec3_add_scaled(on.direction, -rise * (k % 2 ? 1.0 - 1e-9 : 0.0), surface.normal));
            rise = vec3_dot(on.direction, surface.normal);
            bool inward = rise < 0.0;
            bool met = closest(geometry, on, (RayStart){hit.shape, inward, 0}, (double)INFINITY, &next);
            false_hits += !inward && met;
            // Inward the far side is met, unless the ray only grazes.
            if (inward && rise < -1e-6) {
                Surface far_side = met ? geometry_surface(geometry, TRACE_ALL_FEATURES, on, next) : surface;
                wrong_exits += !met || !next.inside || vec3_dot(far_side.normal, on.direction) < 0.0;
            }
            rays++;
        }
        geometry_free(geometry);
        scene_fini(&scene);
    }
    tap_ok(rays > 5000 && false_hits == 0, "size %g: no shape meets itself outward (%d)", size, false_hits);
    tap_ok(wrong_exits == 0, "size %g: every ray inward leaves on the far side (%d of %d)", size, wrong_exits, rays);
}

// ---- composites

static void grow(Scene *scene, Random *random, uint32_t parent, int level)
{
    for (int i = 0; i < 3; i++) {
        if (level < 3 && random_bits(random) % 3 == 0) {
            uint32_t node;
            NodeOp op = (NodeOp)(random_bits(random) % 3);
            if (!scene_add_node(scene, op, random_bits(random) % 4 == 0, parent, 0, &node)) {
                abort();
            }
            grow(scene, random, node, level + 1);
        } else {
            Primitive primitive = random_primitive(random, solid_kinds[random_bits(random) % 4], 1.0);
            primitive.node = parent;
            primitive.flags = random_bits(random) % 4 == 0 ? PRIMITIVE_INVERSE : 0;
            if (!scene_add_leaf(scene, &primitive)) {
                abort();
            }
        }
    }
}

// Whether a point is inside, by the insides of the leaves; *uncertainty turns true near a surface.
static bool is_inside(const Scene *scene, uint32_t at, Vec3 point, bool *uncertainty)
{
    const Node *node = &scene->nodes.items[at];
    bool any = false, all = true;
    for (size_t i = 0; i < scene->nodes.count; i++) {
        if (scene->nodes.items[i].parent == at) {
            bool inside = is_inside(scene, (uint32_t)i, point, uncertainty);
            any = any || inside;
            all = all && inside;
        }
    }
    for (size_t i = 0; i < scene->primitives.count; i++) {
        const Primitive *primitive = &scene->primitives.items[i];
        if (primitive->node == at) {
            double deep = depth(primitive, point);
            bool inside = (deep > 0.0) != (bool)(primitive->flags & PRIMITIVE_INVERSE);
            *uncertainty = *uncertainty || fabs(deep) < 1e-9;
            any = any || inside;
            all = all && inside;
        }
    }
    return (node->op == NODE_INTERSECTION ? all : any) != node->is_inverse;
}

static bool has_union(const Scene *scene)
{
    for (size_t i = 0; i < scene->nodes.count; i++) {
        if (scene->nodes.items[i].op == NODE_UNION) {
            return true;
        }
    }
    return false;
}

// Follows a line through the composite. Without unions each crossing changes the inside, and nothing else does.
static bool line_is_right(const Scene *scene, const Geometry *geometry, Ray ray, Random *random, int *crossings)
{
    RayStart start = RAY_START_FREE;
    Hit hit;
    for (int guard = 0; guard < 200; guard++) {
        bool met = closest(geometry, ray, start, (double)INFINITY, &hit);
        double length = met ? hit.t : 50.0;
        bool uncertainty = false;
        bool inside = is_inside(scene, 0, ray_at(ray, random_between(random, 0.0, length)), &uncertainty);
        for (int k = 0; k < 5; k++) {
            Vec3 point = ray_at(ray, random_between(random, 0.0, length));
            bool same = is_inside(scene, 0, point, &uncertainty) == inside;
            if (!uncertainty && !same) {
                return false;
            }
        }
        if (!uncertainty && met && hit.inside != inside) {
            return false;
        }
        if (!met) {
            return true;
        }
        (*crossings)++;
        Surface surface = geometry_surface(geometry, TRACE_ALL_FEATURES, ray, hit);
        ray.origin = surface.point;
        start = (RayStart){hit.shape, !hit.inside, 0};
    }
    return false;
}

static void test_composites(void)
{
    Random random = {4};
    int wrong = 0, lines = 0, crossings = 0;
    for (int i = 0; i < 600; i++) {
        Scene scene;
        uint32_t root;
        scene_init(&scene);
        if (!scene_begin_composite(&scene, 0, 0) ||
            !scene_add_node(&scene, (NodeOp)(1 + i % 2), false, NODE_NONE, 0, &root)) {
            abort();
        }
        grow(&scene, &random, root, 0);
        scene_end_composite(&scene);
        if (!has_union(&scene)) {
            Geometry *geometry = prepare(&scene, 0);
            for (int k = 0; k < 50; k++, lines++) {
                wrong += !line_is_right(&scene, geometry, random_ray(&random, 1.0), &random, &crossings);
            }
            geometry_free(geometry);
        }
        scene_fini(&scene);
    }
    printf("# %d lines, %d crossings\n", lines, crossings);
    tap_ok(crossings > 5000 && wrong == 0, "the surfaces of composites are where the inside changes (%d of %d lines)",
           wrong, lines);
}

// Two boxes with faces on one plane, under a turn that is rounded differently for each: the one taken away leaves no
// film.
static void test_coincident(void)
{
    Random random = {5};
    int films = 0, misses = 0;
    for (int i = 0; i < 300; i++) {
        Scene scene;
        uint32_t root;
        scene_init(&scene);
        if (!scene_begin_composite(&scene, 0, 0) ||
            !scene_add_node(&scene, NODE_INTERSECTION, false, NODE_NONE, 0, &root)) {
            abort();
        }
        Vec3 turn = random_vec3(&random, 0, 360);
        Transform map = transform_compose(transform_rotate(turn), transform_translate(random_point(&random, 3.0)));
        for (int k = 0; k < 2; k++) {
            Primitive primitive = {.kind = PRIMITIVE_BOX, .node = root, .flags = k ? PRIMITIVE_INVERSE : 0};
            double size = k ? 0.3 : 1.0;
            Transform own = transform_compose(transform_scale(vec3(size, 1.0 / 3.0, size)), map);
            primitive.data[0] = vec3(-1.0, -3.0, -1.0);
            primitive.data[1] = vec3(1.0, 3.0, 1.0);
            primitive.to_world = own;
            if (!transform_invert(&own, &primitive.to_object) || !scene_add_leaf(&scene, &primitive)) {
                abort();
            }
        }
        scene_end_composite(&scene);
        Geometry *geometry = prepare(&scene, 0);
        Vec3 axis = transform_direction(&map, vec3(0.0, 1.0, 0.0));
        for (int k = 0; k < 200; k++) {
            bool is_hole = k % 2;
            double reach = is_hole ? 0.29 : 0.65;
            Vec3 own = vec3(random_between(&random, -reach, reach), 0.0, 0.65);
            own.z = is_hole ? random_between(&random, -0.29, 0.29) : own.z;
            Vec3 target = transform_point(&map, own);
            Ray ray = {vec3_add_scaled(target, 7.0, axis), vec3_neg(axis)};
            Hit hit;
            bool met = closest(geometry, ray, RAY_START_FREE, (double)INFINITY, &hit);
            films += is_hole && met;
            misses += !is_hole && !met;
        }
        geometry_free(geometry);
        scene_fini(&scene);
    }
    tap_ok(films == 0 && misses == 0, "faces that coincide leave no film (%d) and no gap (%d)", films, misses);
}

static void test_scale(void)
{
    Random random = {6};
    int differ = 0, hits = 0;
    for (int i = 0; i < 200; i++) {
        Scene scenes[2];
        Primitive primitive = random_primitive(&random, alone_kinds[i % 5], 1.0);
        int k = (int)random_between(&random, -400, 400);
        Geometry *geometries[2];
        for (int which = 0; which < 2; which++) {
            Primitive one = primitive;
            one.to_world = transform_compose(
                primitive.to_world,
                transform_scale(vec3(ldexp(1.0, which * k), ldexp(1.0, which * k), ldexp(1.0, which * k))));
            scene_init(&scenes[which]);
            if (!transform_invert(&one.to_world, &one.to_object)) {
                abort();
            }
            add_primitive(&scenes[which], &one);
            geometries[which] = prepare(&scenes[which], which * k);
        }
        for (int r = 0; r < 50; r++) {
            Ray ray = random_ray(&random, 1.0);
            Hit a, b;
            bool met = closest(geometries[0], ray, RAY_START_FREE, (double)INFINITY, &a);
            bool met_too = closest(geometries[1], ray, RAY_START_FREE, (double)INFINITY, &b);
            differ += met != met_too || (met && (a.t != b.t || a.shape != b.shape));
            hits += met;
        }
        for (int which = 0; which < 2; which++) {
            geometry_free(geometries[which]);
            scene_fini(&scenes[which]);
        }
    }
    tap_ok(hits > 500 && differ == 0, "a power of two changes no bit (%d of %d differ)", differ, hits);
}

// What stands for the error of a crossing where either gives the same answer is never less.
static void test_bounds(void)
{
    static const PrimitiveKind kinds[] = {PRIMITIVE_SPHERE, PRIMITIVE_BOX,      PRIMITIVE_CONE,
                                          PRIMITIVE_DISC,   PRIMITIVE_TRIANGLE, PRIMITIVE_TORUS};
    Random random = {9};
    int asked = 0, less = 0, loose = 0;
    for (int i = 0; i < 3000; i++) {
        Scene scene;
        double size = ldexp(1.0, (int)(random_bits(&random) % 60) - 30);
        Primitive primitive = random_primitive(&random, kinds[i % 6], size);
        scene_init(&scene);
        add_primitive(&scene, &primitive);
        Geometry *geometry = prepare(&scene, 0);
        const PreparedPrimitive *prepared = &geometry->shapes.primitives[0];
        for (int k = 0; k < 20; k++) {
            Ray ray = random_ray(&random, size), object = primitive_ray(prepared, &ray);
            RayInterval intervals[2] = {INTERVAL_ALL}, interval;
            double t = 0.0;
            if (primitive_is_flat(prepared) ? !primitive_flat_root(prepared, &object, &t)
                                            : primitive_intervals(prepared, &object, LEFT_NONE, intervals) == 0) {
                continue;
            }
            interval = intervals[0];
            for (int end = 0; end < 2; end++) {
                uint8_t side = primitive_is_flat(prepared) ? 0 : end ? interval.leave_side : interval.enter_side;
                t = primitive_is_flat(prepared) ? t : end ? interval.leave : interval.enter;
                double span = vec3_sum_abs(ray.origin) + fabs(t) * vec3_sum_abs(ray.direction);
                double error = primitive_crossing_error(prepared, &ray, &object, t, side);
                double bound = primitive_crossing_bound(prepared, &ray, &object, t, side, span);
                less += bound < error;
                loose += bound > 100.0 * error;
                asked++;
            }
        }
        geometry_free(geometry);
        scene_fini(&scene);
    }
    tap_ok(asked > 10000 && less == 0, "bounds of errors are no less than errors (%d of %d are)", less, asked);
    tap_ok(loose < asked / 100, "and seldom a hundred times as much (%d are)", loose);
}

int main(void)
{
    test_bounds();
    test_on_surface();
    test_tree();
    test_secondary(1e-12);
    test_secondary(1.0);
    test_secondary(1e12);
    test_composites();
    test_coincident();
    test_scale();
    return tap_done();
}
