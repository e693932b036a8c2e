// Boxes around polyhedra, beside their corners found by brute force from all threes of planes.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "trace/half_spaces.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { MOST = 24 };

// Where three planes meet; false when two of them are nearly parallel.
static bool meet(const HalfSpace *a, const HalfSpace *b, const HalfSpace *c, Vec3 *point)
{
    Vec3 bc = vec3_cross(b->normal, c->normal), ca = vec3_cross(c->normal, a->normal),
         ab = vec3_cross(a->normal, b->normal);
    double volume = vec3_dot(a->normal, bc);
    *point = vec3_scale(1.0 / volume, vec3_add(vec3_add(vec3_scale(a->distance, bc), vec3_scale(b->distance, ca)),
                                               vec3_scale(c->distance, ab)));
    return fabs(volume) > 1e-6;
}

static bool holds(const HalfSpace *spaces, uint32_t count, Vec3 point, double slack)
{
    for (uint32_t i = 0; i < count; i++) {
        if (vec3_dot(spaces[i].normal, point) > spaces[i].distance + slack) {
            return false;
        }
    }
    return true;
}

static Bounds by_corners(const HalfSpace *spaces, uint32_t count, double size)
{
    Bounds all = BOUNDS_NONE;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = i + 1; j < count; j++) {
            for (uint32_t k = j + 1; k < count; k++) {
                Vec3 point;
                if (meet(&spaces[i], &spaces[j], &spaces[k], &point) && holds(spaces, count, point, 1e-9 * size)) {
                    all = bounds_join(all, (Bounds){point, point});
                }
            }
        }
    }
    return all;
}

static bool is_around(const Bounds *box, const Bounds *corners, double slack)
{
    Vec3 low = vec3_sub(corners->low, box->low), high = vec3_sub(box->high, corners->high);
    double least = fmin(fmin(fmin(low.x, low.y), low.z), fmin(fmin(high.x, high.y), high.z));
    double most = fmax(fmax(fmax(low.x, low.y), low.z), fmax(fmax(high.x, high.y), high.z));
    return least >= 0.0 && most <= slack;
}

// Planes around a point, of which most cut something; sizes and places of any order.
static void test_closed(void)
{
    Random random = {random_seed(NULL)};
    int missing = 0, wrong = 0;
    for (int turn = 0; turn < 400; turn++) {
        HalfSpace spaces[MOST];
        double size = exp2(random_between(&random, -60.0, 60.0));
        double away = exp2(random_between(&random, -10.0, 6.0));
        Vec3 middle = vec3_scale(size * away, random_direction(&random));
        uint32_t count = 12 + random_below(&random, MOST - 12);
        for (uint32_t i = 0; i < count; i++) {
            Vec3 normal = random_direction(&random);
            if (i < 6) { // closed at all events, often with faces along the axes
                normal = vec3(i / 2 == 0, i / 2 == 1, i / 2 == 2);
                normal = i & 1 ? vec3_neg(normal) : normal;
            }
            spaces[i] = (HalfSpace){normal, vec3_dot(normal, middle) + size * random_between(&random, 0.5, 2.0)};
        }
        Bounds box, corners = by_corners(spaces, count, size * (1.0 + away));
        if (!half_spaces_bounds(spaces, count, &box)) {
            missing++;
        } else {
            wrong += !is_around(&box, &corners, 1e-4 * size * (1.0 + away));
        }
    }
    tap_ok(missing == 0, "what is closed has a box (%d have none)", missing);
    tap_ok(wrong == 0, "the box holds all corners and little more (%d do not)", wrong);
}

// Open to one side, or with nothing in common: no box.
static void test_open(void)
{
    Random random = {random_seed(NULL)};
    int boxed = 0;
    for (int turn = 0; turn < 400; turn++) {
        HalfSpace spaces[MOST];
        Bounds box;
        Vec3 open = random_direction(&random);
        for (uint32_t i = 0; i < MOST; i++) {
            Vec3 normal = random_direction(&random);
            double along = vec3_dot(normal, open);
            normal = along > 0.0 ? vec3_neg(normal) : normal; // a ray along `open` leaves none of them
            spaces[i] = (HalfSpace){normal, random_between(&random, 0.5, 2.0)};
        }
        boxed += half_spaces_bounds(spaces, MOST, &box);
    }
    tap_ok(boxed == 0, "what is open has no box (%d have one)", boxed);
    const HalfSpace apart[] = {{{1, 0, 0}, -1}, {{-1, 0, 0}, -1}, {{0, 1, 0}, 1},
                               {{0, -1, 0}, 1}, {{0, 0, 1}, 1},   {{0, 0, -1}, 1}};
    Bounds box;
    tap_ok(!half_spaces_bounds(apart, 6, &box) || bounds_are_empty(box), "nothing in common: no box, or an empty one");
    const HalfSpace at_origin[] = {{{1, 0, 0}, 0}, {{-1, 0, 0}, 0}, {{0, 1, 0}, 0}, {{0, 0, 1}, 0}};
    const HalfSpace odd[] = {{{1, 0, 0}, (double)NAN}, {{-1, 0, 0}, 1}, {{0, 1, 0}, 1e300}, {{0, 0, (double)NAN}, 1}};
    tap_ok(!half_spaces_bounds(at_origin, 4, &box) && !half_spaces_bounds(odd, 4, &box) &&
               !half_spaces_bounds(at_origin, 0, &box),
           "planes through one point, or of no number, have none");
}

int main(void)
{
    test_closed();
    test_open();
    return tap_done();
}
