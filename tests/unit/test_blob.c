// A ray against blobs: what is inside of the intervals, and what is not, beside the field itself in long doubles; lines
// at the threshold, along a rod, from far away, at sizes of 1e-12 to 1e12, of few components and many, some of them
// negative; and rays that start on the surface.
//
// SPDX-License-Identifier: MIT
#include "trace/blob.h"

#include <stdlib.h>

#include "scene/blob.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { COMPONENTS_MOST = 200, SAMPLES = 400 };

typedef struct Family {
    const char *name;
    unsigned components;
    double size, from, length;
    bool has_rods, has_negative, touches; // touches: the threshold is that of a place, and the ray runs along it there
} Family;

static const Family families[] = {
    {"one ball", 1, 1.0, 3.0, 1.0, false, false, false},
    {"balls", 5, 1.0, 3.0, 1.0, false, false, false},
    {"balls and rods", 6, 1.0, 3.0, 1.0, true, true, false},
    {"many", 200, 1.0, 3.0, 1.0, true, true, false},
    {"at the threshold", 4, 1.0, 3.0, 1.0, true, false, true},
    {"from far", 5, 1.0, 1e6, 1.0, true, true, false},
    {"small", 5, 1e-12, 3.0, 1.0, true, true, false},
    {"large", 5, 1e12, 3.0, 1.0, true, true, false},
    {"a long direction", 5, 1.0, 3.0, 1e12, true, true, false},
    {"a short direction", 5, 1.0, 3.0, 1e-12, true, true, false},
};

// The field less the threshold.
static long double field_at(const double *list, const Ray *ray, long double t)
{
    Blob blob = blob_of(list);
    const long double p[3] = {ray->origin.x + t * ray->direction.x, ray->origin.y + t * ray->direction.y,
                              ray->origin.z + t * ray->direction.z};
    long double sum = -(long double)blob.threshold;
    for (uint32_t i = 0; i < blob.component_count; i++) {
        const BlobComponent *c = &blob.components[i];
        long double own[3], square = 0.0L;
        for (int axis = 0; axis < 3; axis++) {
            own[axis] =
                p[0] * c->to_own[0][axis] + p[1] * c->to_own[1][axis] + p[2] * c->to_own[2][axis] + c->to_own[3][axis];
        }
        own[2] = own[2] <= 0.0L ? own[2] : own[2] < c->height ? 0.0L : own[2] - c->height;
        for (int axis = 0; axis < 3; axis++) {
            square += own[axis] * own[axis];
        }
        sum += square < 1.0L ? c->strength * (1.0L - square) * (1.0L - square) : 0.0L;
    }
    return sum;
}

static const double *random_blob(Random *random, const Family *family, double threshold, double *list)
{
    static const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    BlobComponent components[COMPONENTS_MOST];
    uint32_t count = 0;
    while (count < family->components) {
        Vec3 base = random_vec3(random, -family->size, family->size);
        Vec3 cap = random_vec3(random, -family->size, family->size);
        bool is_rod = family->has_rods && random_below(random, 2);
        double strength = random_between(random, 0.5, 1.5), radius = family->size * random_between(random, 0.4, 1.0);
        Vec3 scales = random_vec3(random, 0.5, 2.0);
        Transform moved =
            random_below(random, 3) ? transform_identity() : transform_scale(vec3(scales.x, 1.0, scales.z));
        if (is_rod && random_below(random, 3) == 0) {
            cap = vec3_add_scaled(base, family->size, axes[random_below(random, 3)]);
        }
        strength = family->has_negative && random_below(random, 4) == 0 ? -strength : strength;
        count += blob_component(&components[count], is_rod, base, cap, radius, strength, &moved);
    }
    return blob_make(threshold, components, count, list).items;
}

typedef struct Outcome {
    int rays, ends, wrong, off, unordered;
    long double worst; // of the field at an end, over what 512 u of its place make of it
} Outcome;

static void check_ends(const double *list, const Ray *ray, const RayInterval *intervals, unsigned count,
                       Outcome *outcome)
{
    double length = vec3_max_abs(ray->direction);
    double last = -(double)INFINITY;
    for (unsigned i = 0; i < count; i++) {
        for (unsigned end = 0; end < 2; end++) {
            double t = end ? intervals[i].leave : intervals[i].enter;
            outcome->unordered += t < last;
            last = t;
            if (isinf(t)) {
                continue;
            }
            double step = 0x1p-43 * (vec3_max_abs(ray->origin) / length + fabs(t));
            long double before = field_at(list, ray, t - step), behind = field_at(list, ray, t + step);
            long double rise = behind - before, at = field_at(list, ray, t);
            bool is_right = end ? rise < 0.0L || before > 0.0L : rise > 0.0L || before < 0.0L;
            outcome->off += !is_right && fabsl(at) > 1e-13L;
            outcome->ends++;
        }
    }
}

static void check(const double *list, const Family *family, const Ray *ray, Outcome *outcome)
{
    RayInterval intervals[15 * COMPONENTS_MOST + 3];
    unsigned count = blob_intervals(list, false, ray, LEFT_NONE, intervals), at = 0;
    double reach = (family->from + 4.0) * family->size / family->length;
    double begin = family->from > 100.0 ? reach - 8.0 * family->size / family->length : 0.0;
    for (int i = 1; i < SAMPLES; i++) {
        double t = begin + (reach - begin) * i / SAMPLES;
        long double field = field_at(list, ray, t);
        while (at < count && intervals[at].leave < t) {
            at++;
        }
        bool is_inside = at < count && intervals[at].enter < t;
        outcome->wrong += fabsl(field) > 1e-9L && is_inside != (field > 0.0L);
    }
    check_ends(list, ray, intervals, count, outcome);
    RayInterval few[4];
    unsigned few_count = blob_intervals(list, true, ray, LEFT_NONE, few);
    outcome->wrong += (few_count == 0) != (count == 0) ||
                      (count > 0 && (few[0].enter != intervals[0].enter ||
                                     (isinf(few[0].enter) && few[0].leave != intervals[0].leave)));
    outcome->rays++;
}

static void test_family(const Family *family, uint64_t seed)
{
    Random random = {seed};
    Outcome outcome = {0};
    static double list[BLOB_HEAD + (2 * BLOB_NODE + BLOB_COMPONENT) * COMPONENTS_MOST];
    int rays = getenv("CHECK_LONG") ? 20000 : 100;
    for (int i = 0; i < rays; i++) {
        Vec3 d = random_direction(&random), on = random_vec3(&random, -family->size, family->size);
        double share = random_between(&random, 0.2, 0.7);
        const double *made = random_blob(&random, family, share, list);
        if (family->touches) {
            Ray there = {on, d};
            double field = blob_field(made, on);
            if (!(field > 0.1)) {
                continue;
            }
            Vec3 n = blob_normal(made, on);
            (void)there;
            double change = pow(10.0, -(double)random_below(&random, 16));
            list[0] = field * (1.0 + change * random_between(&random, -1.0, 1.0));
            d = vec3_normalize(vec3_add_scaled(d, -vec3_dot(d, n), n));
        }
        Ray ray = {vec3_add_scaled(on, -family->from * family->size, d), vec3_scale(family->length, d)};
        check(made, family, &ray, &outcome);
    }
    tap_ok(outcome.wrong == 0 && outcome.rays > rays / 4,
           "%s: inside is where the field is greater (%d places of %d rays are not)", family->name, outcome.wrong,
           outcome.rays);
    tap_ok(outcome.off == 0 && outcome.unordered == 0 && outcome.ends > 0,
           "%s: the field goes through the threshold at the ends of intervals (%d of %d are not so, %d out of order)",
           family->name, outcome.off, outcome.ends, outcome.unordered);
}

// A ray that starts on the surface, inward or outward, meets what it met from before, but for its start.
static void test_from_surface(const Family *family, uint64_t seed)
{
    Random random = {seed};
    static double list[BLOB_HEAD + (2 * BLOB_NODE + BLOB_COMPONENT) * COMPONENTS_MOST];
    static RayInterval whole[15 * COMPONENTS_MOST + 3], own[15 * COMPONENTS_MOST + 3];
    int rays = 0, wrong = 0;
    for (int i = 0; i < 2000; i++) {
        const double *made = random_blob(&random, family, 0.4, list);
        Vec3 d = random_direction(&random), on = random_vec3(&random, -family->size, family->size);
        Ray ray = {vec3_add_scaled(on, -4.0 * family->size, d), d};
        unsigned count = blob_intervals(made, false, &ray, LEFT_NONE, whole);
        if (count == 0) {
            continue;
        }
        double t = whole[0].enter;
        Ray next = {ray_at(ray, t), random_direction(&random)};
        Vec3 n = blob_normal(made, next.origin), step = vec3_scale(1e-3 * family->size, n);
        double slope = vec3_dot(next.direction, n);
        double rise = blob_field(made, vec3_sub(next.origin, step)) - blob_field(made, vec3_add(next.origin, step));
        unsigned own_count = blob_intervals(made, false, &next, (SideLeft){0, slope < 0.0}, own);
        double limit = 1e-6 * family->size;
        if (fabs(slope) < 0.01 || fabs(rise) < 1e-4) { // it grazes, or fields cancel: what is near belongs to the start
            continue;
        }
        for (unsigned k = 0; k < own_count; k++) {
            wrong += (own[k].enter > 0.0 && own[k].enter < limit) || own[k].leave < limit;
        }
        wrong += slope < 0.0 && !(own_count > 0 && isinf(own[0].enter));
        wrong += slope > 0.0 && own_count > 0 && isinf(own[0].enter);
        rays++;
    }
    tap_ok(wrong == 0 && rays > 200, "%s: a ray leaves out what it starts on, and nothing else (%d of %d do not)",
           family->name, wrong, rays);
}

int main(void)
{
    uint64_t seed = random_seed(NULL);
    for (size_t i = 0; i < sizeof families / sizeof *families; i++) {
        test_family(&families[i], seed);
    }
    test_from_surface(&families[1], seed);
    test_from_surface(&families[2], seed);
    test_from_surface(&families[6], seed);
    test_from_surface(&families[7], seed);
    return tap_done();
}
