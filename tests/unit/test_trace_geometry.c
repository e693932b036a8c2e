// Geometry: kinds of shapes, equal distances, ends of intervals, and input that is not numbers.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>

#include "unit/tap.h"
#include "unit/trace_scenes.h"

static const double U = DBL_EPSILON / 2;

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
        {"sphere", {{0, 0, -5}, {0, 0, 1}}, {SHAPE_NONE, false, 0}, 9, true, {4, 0u << 30, false}},
        {"sphere, interval open at its end", {{0, 0, -5}, {0, 0, 1}}, {SHAPE_NONE, false, 0}, 4, false, {0, 0, false}},
        {"sphere from inside", {{0, 0, 0}, {0, 0, 1}}, {SHAPE_NONE, false, 0}, 9, true, {1, 0u << 30, true}},
        {"sphere, leaving outward", {{0, 0, 1}, {0, 0, 1}}, {0, false, 0}, 9, false, {0, 0, false}},
        {"sphere, leaving inward", {{0, 0, -1}, {0, 0, 1}}, {0, true, 0}, 9, true, {2, 0, true}},
        {"sphere, inward but not going in", {{0, 0, 1}, {0, 0, 1}}, {0, true, 0}, 9, false, {0, 0, false}},
        {"ellipsoid", {{10, 0, -5}, {0, 0, 1}}, {SHAPE_NONE, false, 0}, 9, true, {3, 2u << 30, false}},
        {"ellipsoid across", {{15, 0, 0}, {-1, 0, 0}}, {SHAPE_NONE, false, 0}, 9, true, {4, 2u << 30, false}},
        {"ellipsoid, leaving outward", {{10, 0, 2}, {0, 0, 1}}, {2u << 30, false, 0}, 9, false, {0, 0, false}},
        {"ellipsoid, leaving inward", {{10, 0, -2}, {0, 0, 1}}, {2u << 30, true, 0}, 9, true, {4, 2u << 30, true}},
        {"plane from its outer side", {{3, 0, 3}, {0, -1, 0}}, {SHAPE_NONE, false, 0}, 9, true, {3, 1u << 30, false}},
        {"plane from its inner side", {{3, -5, 3}, {0, 1, 0}}, {SHAPE_NONE, false, 0}, 9, true, {2, 1u << 30, true}},
        {"plane, leaving it", {{3, -3.0000001, 3}, {0, 1, 0}}, {1u << 30, false, 0}, 9, false, {0, 0, false}},
        {"plane, along it", {{3, -3, 3}, {1, 0, 0}}, {SHAPE_NONE, false, 0}, 9, false, {0, 0, false}},
        {"plane behind", {{3, 0, 3}, {0, 1, 0}}, {SHAPE_NONE, false, 0}, 9, false, {0, 0, false}},
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
    tap_ok(geometry_features(geometry) == (TRACE_SPHERES | TRACE_PRIMITIVES | TRACE_PLANES), "features are told");
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
    scene.sphere_runs.items[1].order = 0;
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
                                           (RayStart){equals[k], false, 0}, (double)INFINITY);
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

// ---- many stretched spheres, by the tree and one by one

static Transform random_stretch(Random *random, double thinnest)
{
    double size[3];
    for (int i = 0; i < 3; i++) {
        size[i] = exp(random_between(random, log(thinnest), 0.0));
    }
    Transform stretch = transform_scale(vec3(size[0], size[1], size[2]));
    Transform turn = transform_rotate(random_point(random, 180));
    return transform_compose(transform_compose(stretch, turn), transform_translate(random_point(random, 10)));
}

// Where the ray enters an item's box, in long doubles; -1: it does not.
static double box_enter(const Geometry *g, uint32_t item, Ray ray)
{
    const Bvh *tree = &g->shapes.tree;
    const ItemBox *box = &g->shapes.boxes[item];
    const double o[3] = {ray.origin.x, ray.origin.y, ray.origin.z};
    const double d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    const double centre[3] = {tree->centre.x, tree->centre.y, tree->centre.z};
    long double from[3], pad = tree->half.x + tree->half.y + tree->half.z, enter = 0, leave = HUGE_VALL;
    for (int i = 0; i < 3; i++) {
        from[i] = ((long double)o[i] - centre[i]) * tree->scale;
        pad += fabsl(from[i]);
    }
    pad *= 12 * U;
    for (int i = 0; i < 3; i++) {
        long double low = (box->low[i] - pad - from[i]) / d[i], high = (box->high[i] + pad - from[i]) / d[i];
        enter = fmaxl(enter, fminl(low, high));
        leave = fminl(leave, fmaxl(low, high));
    }
    return enter <= leave ? (double)(enter / tree->scale) : -1.0;
}

// Each asked by the formula for spheres in its own space: of those whose roots may be the least as far as rounding can
// tell, the first. `from`: the one that the ray leaves; what it may have passed by rounding then is not met. Some root
// is before `limit` for certain.
static bool nearest_one_by_one(const Geometry *g, Ray ray, RayStart start, uint32_t from, Hit *hit, double *limit)
{
    const SphereData unit = UNIT_SPHERE;
    double start_error = from == UINT32_MAX ? 0.0 : shapes_start_error(&g->shapes, &ray, start);
    uint32_t count = g->shapes.primitive_count;
    struct {
        Hit hit;
        double begin;
    } *roots = calloc(count, sizeof *roots);
    *limit = (double)INFINITY;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t i = item_index(g->shapes.items[k]);
        const PreparedPrimitive *primitive = &g->shapes.primitives[i];
        Ray object = primitive_ray(primitive, &ray);
        SphereRay own = sphere_ray_make(object.origin, object.direction);
        bool inside = true;
        double t = i != from ? sphere_hit(&own, &unit, &inside) : start.inward ? sphere_root_inward(&own, &unit) : 0.0;
        double error = primitive_ball_error(primitive, &ray, &object, t), enter = box_enter(g, k, ray);
        if (t > 0.0 && i != from && from != UINT32_MAX && t <= error + start_error) {
            t = inside ? 0.0 : sphere_root_inward(&own, &unit);
            error = primitive_ball_error(primitive, &ray, &object, t);
            inside = true;
            t = t > error + start_error ? t : 0.0;
        }
        if (t > 0.0 && enter >= 0.0) {
            roots[i].hit = (Hit){t, primitive_shape(i, 0), inside};
            roots[i].begin = fmax(root_span(t, error).from, enter);
            *limit = fmin(*limit, fmax(t + error, enter));
        }
    }
    hit->t = 0.0;
    for (uint32_t i = 0; i < count && hit->t == 0.0; i++) {
        if (roots[i].hit.t > 0.0 && roots[i].begin <= *limit) {
            *hit = roots[i].hit;
        }
    }
    free(roots);
    return hit->t > 0.0;
}

// What differs of a ray, and of two that continue from where it ends. Counts what they meet.
static int legs_that_differ(const Geometry *g, Ray ray, Random *random, int *met)
{
    RayStart start = RAY_START_FREE;
    Hit hit = {0}, known, next;
    uint32_t from = UINT32_MAX;
    int wrong = 0;
    for (int leg = 0; leg < 3; leg++) {
        double limit;
        bool is_met = nearest_one_by_one(g, ray, start, from, &known, &limit);
        bool is_found = closest(g, ray, start, (double)INFINITY, &hit);
        wrong += is_met != is_found || geometry_occluded(g, TRACE_ALL_FEATURES, ray, start, (double)INFINITY) != is_met;
        if (!is_met || !is_found) {
            break;
        }
        (*met)++;
        wrong += hit.t != known.t || hit.shape != known.shape || hit.inside != known.inside;
        wrong += closest(g, ray, start, 0.999 * limit, &next) ||
                 geometry_occluded(g, TRACE_ALL_FEATURES, ray, start, 0.999 * limit) ||
                 !geometry_occluded(g, TRACE_ALL_FEATURES, ray, start, 1.001 * limit);
        Surface surface = geometry_surface(g, TRACE_ALL_FEATURES, ray, hit);
        from = primitive_index(hit.shape);
        ray = (Ray){surface.point, random_direction(random)};
        start = (RayStart){hit.shape, vec3_dot(surface.normal, ray.direction) < 0.0, 0};
    }
    return wrong;
}

static void test_stretched(Random *random, double thinnest, int count)
{
    Scene scene;
    scene_init(&scene);
    for (int i = 0; i < count; i++) {
        add_ellipsoid(&scene, random_stretch(random, thinnest));
    }
    Geometry *g = prepare(&scene, 0);
    int met = 0, wrong = 0;
    for (int i = 0; i < 5000; i++) {
        Vec3 eye = random_point(random, 30), aim = g->shapes.primitives[random_below(random, (unsigned)count)].centre;
        wrong += legs_that_differ(g, (Ray){eye, vec3_normalize(vec3_sub(aim, eye))}, random, &met);
    }
    double bytes = (double)geometry_bytes(g) / count;
    tap_ok(wrong == 0 && met >= 5000 && (count < 100 || bytes < 460),
           "%d stretched spheres, as thin as %g: the tree says what each says alone, bit for bit (%d hits, %d differ, "
           "%.0f bytes each)", count, thinnest, met, wrong, bytes);
    geometry_free(g);
    scene_fini(&scene);
}

// Surfaces so near to each other that rounding tells some of them apart and not others: one and the next are one, so
// are the next and the one after, but not the first and the last. Which one is seen depends on all of them, and not on
// the order in which a walk comes to them: the same on each instruction set, and as one by one.
enum { LAYERS = 60 };

static void add_layers(Scene *scene, Random *random, double apart)
{
    for (int i = 0; i < LAYERS; i++) {
        double size = random_between(random, 0.5, 2), height = random_between(random, -apart, apart);
        double width = random_between(random, 5, 9), depth = random_between(random, 5, 9);
        Transform stretch = transform_scale(vec3(width, size, depth));
        Transform below = transform_compose(stretch, transform_translate(vec3(0, -size, 0)));
        Transform tilted = transform_compose(below, transform_rotate(vec3(0, 0, random_between(random, -1, 1))));
        add_ellipsoid(scene, transform_compose(tilted, transform_translate(vec3(0, height, 0))));
    }
}

// What differs of rays down on layers. Marks those that are seen.
static int layers_that_differ(const Geometry *g, Random *random, double apart, int *met, bool seen[LAYERS])
{
    int wrong = 0;
    for (int i = 0; i < 20; i++) {
        double aside = random_between(random, -100 * apart, 100 * apart), tilt = random_between(random, 0, 1e-3);
        Ray ray = {vec3(aside, 7, -7 * tilt), vec3_normalize(vec3(0, -1, tilt))};
        Hit hit;
        wrong += legs_that_differ(g, ray, random, met);
        if (closest(g, ray, RAY_START_FREE, (double)INFINITY, &hit)) {
            seen[primitive_index(hit.shape)] = true;
        }
    }
    return wrong;
}

static void test_nearly_one(Random *random, double apart)
{
    int met = 0, wrong = 0, not_first = 0;
    for (int round = 0; round < 20; round++) {
        bool seen[LAYERS] = {false};
        Scene scene;
        scene_init(&scene);
        add_layers(&scene, random, apart);
        Random rays = *random;
        for (size_t isa = 0; geometry_isa(isa); isa++) {
            Geometry *g = geometry_new_with(&scene, 0, &(GeometryOptions){.threads = 1, .isa = geometry_isa(isa)});
            *random = rays; // the same for all
            wrong += g ? layers_that_differ(g, random, apart, &met, seen) : 1;
            geometry_free(g);
        }
        not_first += !seen[0];
        scene_fini(&scene);
    }
    tap_ok(wrong == 0 && met >= 400,
           "%d surfaces within %g of each other: the same one is seen as one by one, on each instruction set (%d hits, "
           "%d differ; of 20 times the first was not seen in %d)", LAYERS, apart, met, wrong, not_first);
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

int main(int argc, char **argv)
{
    Random random = {random_seed(argc > 1 ? argv[1] : NULL)};
    test_empty();
    test_shapes();
    test_equal_distances();
    test_not_numbers();
    test_stretched(&random, 0.1, 1);
    test_stretched(&random, 0.1, 10);
    test_stretched(&random, 0.1, 300);
    test_stretched(&random, 1e-6, 1000);
    for (double apart = 1e-16; apart < 1e-10; apart *= 10) {
        test_nearly_one(&random, apart);
    }
    return tap_done();
}
