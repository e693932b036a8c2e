// Composites of planes and quadrics: in their boxes, and ended by the parts that are needed, rays meet what they meet
// without either, bit for bit; and what ought to have a box has one.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "unit/tap.h"
#include "unit/trace_scenes.h"

enum { LIST = POLYNOMIAL_HEAD + 2 + 1 + 10 };

// Quadrics in POV-Ray's order of terms, with what planes across y make finite and what they do not.
typedef struct Form {
    const char *name;
    double terms[10];
    bool is_bounded; // between two planes across y
} Form;

static const Form forms[] = {
    {"cylinders", {1, 0, 0, 0, 0, 0, 0, 1, 0, -1}, true},
    {"cones", {1, 0, 0, 0, -1, 0, 0, 1, 0, 0}, true},
    {"hyperboloids", {1, 0, 0, 0, -1, 0, 0, 1, 0, -1}, true},
    {"paraboloids", {1, 0, 0, 0, 0, 0, -1, 1, 0, 0}, true},
    {"slanted cylinders", {2, 1, 0, 0, 1, 0, 0, 1, 0.5, -1}, true},
    {"saddles", {1, 0, 0, 0, 0, 0, -1, -1, 0, 0}, false},
    {"tori that cross themselves", {0}, true}, // in place of a quadric
};

static void finish(Primitive *primitive, Transform to_world)
{
    primitive->to_world = to_world;
    if (!transform_invert(&to_world, &primitive->to_object)) {
        abort();
    }
}

static Primitive quadric(const Form *form, double list[LIST], Transform to_world)
{
    Primitive primitive = {.node = NODE_NONE};
    list[0] = 2.0;
    memcpy(list + POLYNOMIAL_HEAD + 3, form->terms, sizeof form->terms);
    polynomial_complete(list);
    polynomial_part(&(Numbers){list, LIST}, &primitive);
    finish(&primitive, to_world);
    return primitive;
}

// A plane across y of the space of a map: above it, or below.
static Primitive plane(const Primitive *in, double y, bool is_above)
{
    Primitive primitive = {.kind = PRIMITIVE_PLANE};
    Vec3 at = transform_point(&in->to_world, vec3(0.0, y, 0.0));
    Vec3 normal = vec3_normalize(transform_normal(&in->to_object, vec3(0.0, is_above ? -1.0 : 1.0, 0.0)));
    primitive.data[0] = normal;
    primitive.data[1].x = vec3_dot(normal, at);
    finish(&primitive, transform_identity());
    return primitive;
}

static void add_leaf(Scene *scene, Primitive primitive, uint32_t node, bool is_inverse)
{
    primitive.node = node;
    primitive.flags = is_inverse ? PRIMITIVE_INVERSE : 0;
    if (!scene_add_leaf(scene, &primitive)) {
        abort();
    }
}

static Transform random_place(Random *random)
{
    double along_x = random_between(random, 0.5, 2.0), along_y = random_between(random, 0.5, 2.0);
    Vec3 stretch = vec3(along_x, along_y, 1.0);
    Vec3 turn = random_bits(random) % 4 ? random_vec3(random, 0, 360) : vec3(0.0, 0.0, 0.0);
    Transform map = transform_compose(transform_scale(stretch), transform_rotate(turn));
    return transform_compose(map, transform_translate(random_point(random, 2.0)));
}

// A quadric between two planes; at times a hole in it, a third plane or a pair of planes of which one is enough.
static Geometry *random_composite(Random *random, const Form *form, Scene *scene, double lists[2][LIST])
{
    uint32_t root, either;
    scene_init(scene);
    if (!scene_begin_composite(scene, 0, 0) || !scene_add_node(scene, NODE_INTERSECTION, false, NODE_NONE, 0, &root)) {
        abort();
    }
    bool is_torus = form->terms[0] == 0.0;
    Primitive first = {.kind = PRIMITIVE_TORUS, .node = NODE_NONE, .data = {{0.4, 1.1, 0.0}}};
    finish(&first, random_place(random));
    if (is_torus) {
        add_leaf(scene, first, root, false);
        finish(&first, random_place(random));
    } else {
        first = quadric(form, lists[0], random_place(random));
    }
    add_leaf(scene, first, root, false);
    add_leaf(scene, plane(&first, random_between(random, -1.5, 0.0), true), root, false);
    add_leaf(scene, plane(&first, random_between(random, 0.5, 2.0), false), root, false);
    if (random_bits(random) % 2) {
        const Form *hole = &forms[random_bits(random) % 3];
        add_leaf(scene, quadric(hole, lists[1], random_place(random)), root, true);
    }
    if (random_bits(random) % 2) {
        if (!scene_add_node(scene, NODE_UNION, false, root, 0, &either)) {
            abort();
        }
        Primitive other = {.node = NODE_NONE};
        finish(&other, random_place(random));
        add_leaf(scene, plane(&other, 0.3, true), either, false);
        add_leaf(scene, plane(&other, -0.3, true), either, random_bits(random) % 2);
    }
    scene_end_composite(scene);
    return prepare(scene, 0);
}

typedef struct Found {
    int rays, met, differ, bounded, composites;
} Found;

static bool try_ray(Geometry *g, Ray ray, RayStart start, Found *found, Hit *hit)
{
    ShapeTable *table = &g->shapes;
    bool was_needed[16];
    uint32_t bounded = table->bounded_count, unbounded = table->unbounded_count;
    Hit one = {.shape = SHAPE_NONE}, other = {.shape = SHAPE_NONE};
    bool met = closest(g, ray, start, (double)INFINITY, &one);
    for (uint32_t i = 0; i < table->primitive_count; i++) {
        was_needed[i] = table->primitives[i].is_needed;
        table->primitives[i].is_needed = table->primitives[i].decides;
    }
    table->bounded_count = 0;
    table->unbounded_count = 1;
    bool other_met = closest(g, ray, start, (double)INFINITY, &other);
    table->bounded_count = bounded;
    table->unbounded_count = unbounded;
    for (uint32_t i = 0; i < table->primitive_count; i++) {
        table->primitives[i].is_needed = was_needed[i];
    }
    found->rays++;
    found->met += met;
    found->differ += met != other_met || (met && (memcmp(&one.t, &other.t, sizeof one.t) != 0 ||
                                                  one.shape != other.shape || one.inside != other.inside));
    *hit = one;
    return met;
}

static void test_form(uint64_t seed, const Form *form)
{
    Random random = {seed};
    Found found = {0};
    for (int turn = 0; turn < 200; turn++) {
        Scene scene;
        double lists[2][LIST];
        Geometry *g = random_composite(&random, form, &scene, lists);
        found.composites++;
        found.bounded += g->shapes.unbounded_count == 0;
        bool is_nothing = g->shapes.bounded_count + g->shapes.unbounded_count == 0;
        for (int i = 0; i < 100 && !is_nothing; i++) {
            Vec3 to = random_point(&random, 3.0), eye = vec3_scale(9.0, random_direction(&random));
            Ray ray = {eye, vec3_normalize(vec3_sub(to, eye))};
            RayStart start = RAY_START_CAMERA;
            Hit hit;
            for (int bounce = 0; bounce < 3 && try_ray(g, ray, start, &found, &hit); bounce++) {
                Surface surface = geometry_surface(g, TRACE_ALL_FEATURES, ray, hit);
                Vec3 direction = random_direction(&random);
                ray = (Ray){surface.point, direction};
                start = (RayStart){hit.shape, vec3_dot(surface.normal, direction) < 0.0, HIDDEN_MIRROR};
            }
        }
        geometry_free(g);
        scene_fini(&scene);
    }
    tap_ok(found.differ == 0 && found.met > 1000,
           "%s: in a box as without one (%d of %d rays differ, %d met something)", form->name, found.differ, found.rays,
           found.met);
    tap_ok(!form->is_bounded || found.bounded >= 0.9 * found.composites, "%s: %d of %d have a box", form->name,
           found.bounded, found.composites);
}

// Far from 0, too, the box of what lies between two planes is hardly larger than that.
static void test_size(uint64_t seed, const Form *form, double half)
{
    Random random = {seed};
    double greatest = 0.0;
    for (int turn = 0; turn < 100; turn++) {
        Scene scene;
        double list[LIST];
        uint32_t root;
        Transform place = transform_translate(random_point(&random, 20.0));
        scene_init(&scene);
        if (!scene_begin_composite(&scene, 0, 0) ||
            !scene_add_node(&scene, NODE_INTERSECTION, false, NODE_NONE, 0, &root)) {
            abort();
        }
        Primitive primitive = quadric(form, list, place);
        add_leaf(&scene, primitive, root, false);
        add_leaf(&scene, plane(&primitive, -1.0, true), root, false);
        add_leaf(&scene, plane(&primitive, 1.0, false), root, false);
        scene_end_composite(&scene);
        Geometry *g = prepare(&scene, 0);
        const Bvh *tree = &g->shapes.tree;
        greatest = fmax(greatest, fmax(tree->half.x, tree->half.z) / tree->scale / half);
        geometry_free(g);
        scene_fini(&scene);
    }
    tap_ok(greatest > 0.0 && greatest < 1.1, "%s: a box as large as what is in it (%.3f times)", form->name, greatest);
}

int main(void)
{
    uint64_t seed = random_seed(NULL);
    for (size_t i = 0; i < RT_COUNT_OF(forms); i++) {
        test_form(seed + i, &forms[i]);
    }
    test_size(seed, &forms[0], 1.0);
    test_size(seed, &forms[1], 1.0);
    test_size(seed, &forms[2], sqrt(2.0));
    return tap_done();
}
