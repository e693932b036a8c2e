// Whether a ball is seen whole from a surface: when it is said to be, no ray to any place of it meets anything.
//
// SPDX-License-Identifier: MIT
#include "unit/tap.h"
#include "unit/trace_scenes.h"

static void add_box(Scene *scene, Random *random)
{
    Primitive primitive = {.kind = PRIMITIVE_BOX, .node = NODE_NONE, .data = {{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}}};
    double size = random_between(random, 0.05, 0.8);
    Vec3 turn = random_vec3(random, 0, 360);
    primitive.to_world = transform_compose(transform_scale(vec3(size, 0.3 * size, size)), transform_rotate(turn));
    primitive.to_world = transform_compose(primitive.to_world, transform_translate(random_point(random, 10)));
    if (!transform_invert(&primitive.to_world, &primitive.to_object) || !scene_add_primitive(scene, &primitive)) {
        abort();
    }
}

// Few things or many, of one kind or more, now and then far from 0.
static void draw_scene(Scene *scene, Random *random)
{
    unsigned kinds = 1 + random_below(random, 7);
    make_cloud(scene, random, kinds & 1 ? (int)random_below(random, 4) : 0);
    make_cloud(scene, random, kinds & 2 ? 5 + (int)random_below(random, 200) : 0);
    for (unsigned i = kinds & 4 ? random_below(random, 60) : 0; i > 0; i--) {
        add_box(scene, random);
    }
    for (unsigned i = random_below(random, 3); i > 0; i--) {
        Vec3 normal = vec3_normalize(random_point(random, 1));
        add_plane(scene, normal, random_between(random, -12, 12));
    }
    if (random_below(random, 5) == 0) {
        make_far_cloud(scene, random, 50);
    }
}

typedef struct Counts {
    int asked, seen, wrong;
} Counts;

static void look(const Geometry *geometry, Random *random, Counts *counts)
{
    Ray ray = {.origin = random_point(random, 12)};
    ray.direction = vec3_normalize(random_point(random, 1));
    Hit hit;
    if (!closest(geometry, ray, RAY_START_FREE, (double)INFINITY, &hit)) {
        return;
    }
    Surface surface = geometry_surface(geometry, TRACE_ALL_FEATURES, ray, hit);
    SurfaceSpot spot = {surface.point, surface.normal, hit.shape};
    double radius = random_below(random, 4) ? random_between(random, 0, 3) : 0.0;
    Vec3 centre = vec3_add(random_below(random, 2) ? surface.point : vec3(0, 0, 0), random_point(random, 14));
    counts->asked++;
    if (!geometry_sees_ball(geometry, &spot, centre, radius)) {
        return;
    }
    counts->seen++;
    for (int i = 0; i < 60; i++) {
        double far = i % 2 ? radius : random_between(random, 0, radius);
        Vec3 place = vec3_add_scaled(centre, far, vec3_normalize(random_point(random, 1)));
        Vec3 offset = vec3_sub(place, surface.point);
        double distance = vec3_length(offset);
        Ray way = {surface.point, vec3_scale(1.0 / distance, offset)};
        RayStart start = {hit.shape, vec3_dot(surface.normal, way.direction) < 0.0, HIDDEN_SHADOW};
        if (geometry_occluded(geometry, TRACE_ALL_FEATURES, way, start, distance)) {
            counts->wrong++;
            return;
        }
    }
}

int main(int argc, char **argv)
{
    Random random = {random_seed(argc > 1 ? argv[1] : NULL)};
    Counts counts = {0};
    for (int i = 0; i < 400; i++) {
        Scene scene;
        scene_init(&scene);
        draw_scene(&scene, &random);
        Geometry *geometry = prepare(&scene, 0);
        for (int k = 0; k < 200; k++) {
            look(geometry, &random, &counts);
        }
        geometry_free(geometry);
        scene_fini(&scene);
    }
    tap_ok(counts.wrong == 0, "nothing is before a ball that is seen (%d of %d are)", counts.wrong, counts.seen);
    tap_ok(counts.seen > counts.asked / 20, "balls are seen (%d of %d)", counts.seen, counts.asked);
    return tap_done();
}
