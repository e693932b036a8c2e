// Composites of a few convex leaves in one node: what is met by intervals is what is met by crossings in order, bit for
// bit, also where surfaces of several leaves coincide, or nearly.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "unit/tap.h"
#include "unit/trace_scenes.h"

// What composites are drawn from.
typedef struct Family {
    const char *name;
    int leaves;   // at most
    bool is_tied; // their sides have a few places only, and some are shaken by an ulp or some
    NodeOp op;
} Family;

static const Family kinds[] = {
    {"cut boxes", 3, false, NODE_INTERSECTION},
    {"many leaves", 8, false, NODE_INTERSECTION},
    {"coincident sides", 4, true, NODE_INTERSECTION},
    {"many coincident sides", 8, true, NODE_INTERSECTION},
    {"clips", 4, false, NODE_CLIP},
    {"clips with coincident sides", 4, true, NODE_CLIP},
};

static double quarter(Random *random, double from, double to)
{
    double place = 0.25 * floor(4.0 * random_between(random, from, to));
    uint64_t bits = random_bits(random);
    return bits % 3 ? place : place * (1.0 + 0x1p-52 * (double)(bits >> 8 & 63));
}

static Primitive random_leaf(Random *random, const Family *family, int number)
{
    static const PrimitiveKind any[] = {PRIMITIVE_BOX, PRIMITIVE_SPHERE, PRIMITIVE_CONE, PRIMITIVE_PLANE};
    Primitive primitive;
    PrimitiveKind kind = any[random_bits(random) % 4];
    if (family->is_tied) {
        bool is_box = random_bits(random) % 3;
        double radius = 0.25 + quarter(random, 0.25, 1.25);
        Vec3 at = vec3(quarter(random, -0.5, 0.5), 0.0, 0.0);
        at.y = quarter(random, -0.5, 0.5);
        at.z = quarter(random, -0.5, 0.5);
        primitive = (Primitive){.kind = is_box ? PRIMITIVE_BOX : PRIMITIVE_SPHERE};
        primitive.data[0] = vec3(-1.0, -1.0, -1.0);
        primitive.data[1] = vec3(1.0, 1.0, 1.0);
        primitive.to_world = transform_compose(transform_scale(vec3(radius, radius, radius)), transform_translate(at));
    } else {
        primitive = random_primitive(random, kind, 1.0);
        primitive.to_world = transform_compose(primitive.to_world, transform_translate(random_point(random, 0.6)));
    }
    if (primitive.kind == PRIMITIVE_PLANE) {
        primitive.to_world = transform_identity();
        primitive.data[0] = random_direction(random);
        primitive.data[1].x = random_between(random, -0.5, 0.5);
    }
    if (!transform_invert(&primitive.to_world, &primitive.to_object)) {
        abort();
    }
    bool is_clip = family->op == NODE_CLIP && number > 0;
    primitive.flags =
        (number > 0 && random_bits(random) % 2 ? PRIMITIVE_INVERSE : 0) | (is_clip ? PRIMITIVE_UNSEEN : 0);
    primitive.flags |= family->op == NODE_CLIP && random_bits(random) % 2 ? PRIMITIVE_OPEN : 0;
    return primitive;
}

static Geometry *random_composite(Random *random, const Family *family, Scene *scene)
{
    uint32_t root;
    int leaves = 2 + (int)random_below(random, (unsigned)family->leaves - 1);
    scene_init(scene);
    if (!scene_begin_composite(scene, 0, 0) || !scene_add_node(scene, family->op, false, NODE_NONE, 0, &root)) {
        abort();
    }
    for (int i = 0; i < leaves; i++) {
        Primitive leaf = random_leaf(random, family, i);
        leaf.node = root;
        if (!scene_add_leaf(scene, &leaf)) {
            abort();
        }
    }
    scene_end_composite(scene);
    return prepare(scene, 0);
}

typedef struct Found {
    int rays, met, differ, plain;
} Found;

// What a ray meets both ways; puts a hit into *hit, if there is one.
static bool try_ray(Geometry *g, Ray ray, RayStart start, Found *found, Hit *hit)
{
    CsgTree *csg = &g->shapes.csg_trees[0];
    bool is_plain = csg->is_plain;
    Hit one = {.shape = SHAPE_NONE}, other = {.shape = SHAPE_NONE};
    double most = found->rays % 3 ? (double)INFINITY : 3.0;
    bool met = closest(g, ray, start, most, &one);
    bool is_dark = geometry_occluded(g, TRACE_ALL_FEATURES, ray, start, most);
    csg->is_plain = false;
    bool other_met = closest(g, ray, start, most, &other);
    bool other_dark = geometry_occluded(g, TRACE_ALL_FEATURES, ray, start, most);
    csg->is_plain = is_plain;
    found->rays++;
    found->plain += is_plain;
    found->met += met;
    bool differs = met != other_met || is_dark != other_dark ||
                   (met && (memcmp(&one.t, &other.t, sizeof one.t) != 0 || one.shape != other.shape ||
                            one.inside != other.inside));
    found->differ += differs;
    *hit = one;
    return met;
}

static void test_family(uint64_t seed, const Family *family)
{
    Random random = {seed};
    Found found = {0};
    for (int turn = 0; turn < (family->is_tied ? 800 : 200); turn++) {
        Scene scene;
        Geometry *g = random_composite(&random, family, &scene);
        for (int i = 0; i < 100; i++) {
            Vec3 to = random_point(&random, 1.0), eye = vec3_scale(4.0, random_direction(&random));
            Vec3 direction = vec3_normalize(vec3_sub(to, eye));
            if (family->is_tied && i % 4 == 0) { // along sides, and through edges
                eye = vec3(quarter(&random, -1, 1), 0.0, -4.0);
                eye.y = quarter(&random, -1, 1);
                direction = i % 8 ? vec3(0.0, 0.0, 1.0) : vec3_normalize(vec3(0.25, -0.25, 1.0));
            }
            Ray ray = {eye, direction};
            RayStart start = RAY_START_CAMERA;
            Hit hit;
            for (int bounce = 0; bounce < 3 && try_ray(g, ray, start, &found, &hit); bounce++) {
                Surface surface = geometry_surface(g, TRACE_ALL_FEATURES, ray, hit);
                direction = random_direction(&random);
                ray = (Ray){surface.point, direction};
                start = (RayStart){hit.shape, vec3_dot(surface.normal, direction) < 0.0, HIDDEN_MIRROR};
            }
        }
        geometry_free(g);
        scene_fini(&scene);
    }
    tap_ok(found.differ == 0 && found.met > 1500 && found.plain == found.rays,
           "%s: by intervals as by crossings (%d of %d rays differ, %d met something, %d by intervals)", family->name,
           found.differ, found.rays, found.met, found.plain);
}

int main(void)
{
    uint64_t seed = random_seed(NULL);
    for (size_t i = 0; i < RT_COUNT_OF(kinds); i++) {
        test_family(seed + i, &kinds[i]);
    }
    return tap_done();
}
