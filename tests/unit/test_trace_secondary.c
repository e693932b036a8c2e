// Secondary rays: they neither meet what they leave nor miss what they touch, at any scale.
//
// Usage: test_trace_secondary [cases a scale [seed]]; 100 000 if nothing is said, a million in `make check-long`, with
// a new seed each time (unit/random.h).
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>

#include "unit/tap.h"
#include "unit/trace_scenes.h"

static const double U = DBL_EPSILON / 2;

typedef struct SecondaryCounts {
    int rays, false_shadows, wrong_exits, missed_contacts;
} SecondaryCounts;

// A ray from outside enters the sphere that `hit` is on: it leaves by the far side, and meets nothing beyond.
static bool exits_rightly(const Geometry *geometry, Ray ray, Hit hit, Surface surface, double radius)
{
    Ray within = {surface.point, ray.direction};
    Hit exit;
    if (!closest(geometry, within, (RayStart){hit.shape, true, 0}, (double)INFINITY, &exit) ||
        exit.shape != hit.shape || !exit.inside) {
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
           !closest(geometry, beyond, (RayStart){exit.shape, false, 0}, (double)INFINITY, &none);
}

static void secondary_case(Random *random, double scale, SecondaryCounts *counts)
{
    double radius = scale * pow(10.0, random_bits(random) % 4 ? 0.0 : random_between(random, 0, 12));
    double offset = random_bits(random) % 2 ? 0.0 : scale * pow(10.0, random_between(random, 0, 6));
    Vec3 centre = vec3_scale(offset, random_direction(random));
    Vec3 outward = random_direction(random);
    Ray ray = {vec3_add_scaled(centre, radius * random_between(random, 1.5, 4), outward), {0, 0, 0}};
    double aside = radius * 0.999 * sqrt(random_between(random, 0, 1));
    Vec3 aim = vec3_add_scaled(centre, aside, random_perpendicular(random, outward));
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
        RayStart leaving = {hit.shape, false, 0};
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

static void test_secondary_rays(int cases, uint64_t seed)
{
    for (int power = -12; power <= 12; power += 4) {
        Random random = {seed + (uint64_t)(power + 50)};
        SecondaryCounts counts = {0};
        for (int i = 0; i < cases; i++) {
            secondary_case(&random, pow(10.0, power), &counts);
        }
        tap_ok(counts.rays > cases - cases / 30 && counts.false_shadows == 0 && counts.wrong_exits == 0 &&
                   counts.missed_contacts == 0,
               "scale 1e%d: %d false shadows, %d wrong exits, %d missed contacts of %d", power, counts.false_shadows,
               counts.wrong_exits, counts.missed_contacts, counts.rays);
    }
}

int main(int argc, char **argv)
{
    test_secondary_rays(argc > 1 ? atoi(argv[1]) : 100 * 1000, random_seed(argc > 2 ? argv[2] : NULL));
    return tap_done();
}
