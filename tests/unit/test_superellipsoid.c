// A ray against a superellipsoid, beside its function in more digits at places along the line: exponents on both sides
// of what is convex, lines along axes, through edges and by chance, and rays that start on the surface.
//
// What the intervals say must hold at each place where the function is not 0 but for rounding, and where it is least
// between two others, so that a crossing that is missed, or one too many, is seen. CHECK_LONG=1: a million rays each.
//
// SPDX-License-Identifier: MIT
#include "trace/superellipsoid.h"

#include <math.h>
#include <stdlib.h>

#include "scene/superellipsoid.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { PLACES = 100 };

static const double exponents[][2] = {{1.0, 1.0}, {0.25, 0.25}, {1.0, 0.1},  {0.02, 0.7}, {2.0, 2.0},  {1.7, 0.4},
                                      {3.0, 2.5}, {8.0, 2.0},   {2.0, 6.0},  {0.5, 3.0},  {3.0, 0.5},  {0.1, 5.0},
                                      {5.0, 0.1}, {1.99, 2.01}, {1e-6, 1.0}, {1.0, 1e-6}, {40.0, 40.0}};

static long double join(long double a, long double b, long double p)
{
    long double most = fmaxl(a, b), least = fminl(a, b);
    return most > 0.0L ? most * powl(1.0L + powl(least / most, p), 1.0L / p) : 0.0L;
}

// N - 1 at a place of the line.
static long double value_at(const double *e, const Ray *ray, long double t)
{
    long double x = fabsl((long double)ray->origin.x + t * (long double)ray->direction.x);
    long double y = fabsl((long double)ray->origin.y + t * (long double)ray->direction.y);
    long double z = fabsl((long double)ray->origin.z + t * (long double)ray->direction.z);
    return join(join(x, y, 2.0L / (long double)e[0]), z, 2.0L / (long double)e[1]) - 1.0L;
}

static bool says_inside(const RayInterval *intervals, unsigned count, double t)
{
    bool is_inside = false;
    for (unsigned i = 0; i < count; i++) {
        is_inside = is_inside || (intervals[i].enter < t && t < intervals[i].leave);
    }
    return is_inside;
}

static double random_place(Random *random)
{
    switch (random_bits(random) % 4) {
    case 0:
        return 0.0;
    case 1:
        return ((double)(random_bits(random) % 9) - 4.0) / 4.0;
    default:
        return random_between(random, -1.2, 1.2);
    }
}

static Ray random_ray(Random *random)
{
    Ray ray;
    do {
        double x = random_place(random), y = random_place(random), z = random_place(random);
        double a = random_place(random), b = random_place(random), c = random_place(random);
        ray.direction = vec3(a, b, c);
        ray.origin = vec3_add_scaled(vec3(x, y, z), -3.0, ray.direction);
    } while (vec3_equal(ray.direction, vec3(0.0, 0.0, 0.0)));
    return ray;
}

// Where the function is least about a place, by thirds.
static long double least_about(const double *e, const Ray *ray, long double place, long double step)
{
    long double low = place - step, high = place + step;
    for (int k = 0; k < 60; k++) {
        long double a = low + (high - low) / 3.0L, b = high - (high - low) / 3.0L;
        bool is_left = value_at(e, ray, a) < value_at(e, ray, b);
        low = is_left ? low : a;
        high = is_left ? b : high;
    }
    return (low + high) / 2.0L;
}

// How many places behind `from` are wrong.
static int compare(const double *e, const Ray *ray, const RayInterval *intervals, unsigned count, double from,
                   int *asked)
{
    const long double room =
        0x1p-46L * (1.0L + (long double)fmax(e[0], e[1])); // what N is off by; exponents magnify it
    const long double begin = (long double)from, step = 6.0L / PLACES;
    int wrong = 0;
    long double before = 1.0L, value = value_at(e, ray, begin);
    for (int i = 0; i <= PLACES; i++) {
        long double place = begin + (long double)i * step, next = value_at(e, ray, place + step), own = value;
        if (i > 0 && own < before && own < next && own > -0.1L) {
            place = least_about(e, ray, place, step);
            own = value_at(e, ray, place);
        }
        before = value;
        value = next;
        if (place > begin + 1e-9L && (own < -room || own > room)) {
            (*asked)++;
            wrong += says_inside(intervals, count, (double)place) != (own < 0.0L) &&
                     says_inside(intervals, count, (double)(place + 1e-12L)) != (own < 0.0L);
        }
    }
    return wrong;
}

static int rays_of_family(void)
{
    return getenv("CHECK_LONG") ? 1000000 : 200;
}

static void test(const double *e)
{
    Random random = {(uint64_t)(e[0] * 1000.0 + e[1])};
    Vec3 both = vec3(e[0], e[1], 0.0);
    int wrong = 0, asked = 0, wrong_starts = 0, starts = 0, differ = 0;
    for (int i = 0; i < rays_of_family(); i++) {
        RayInterval intervals[SUPERELLIPSOID_INTERVALS + 1];
        Ray ray = random_ray(&random);
        unsigned count = superellipsoid_intervals(both, &ray, LEFT_NONE, intervals);
        wrong += compare(e, &ray, intervals, count, 0.0, &asked);
        double size = superellipsoid_size(both, ray.origin);
        long double exact = value_at(e, &ray, 0.0L);
        differ += (size < 1.0) != (exact < 0.0L) && fabsl(exact) > 0x1p-46L;
        if (count == 0 || !(intervals[0].enter > 0.0)) {
            continue;
        }
        Vec3 on = superellipsoid_point(both, ray_at(ray, intervals[0].enter));
        Ray next = {on, random_direction(&random)};
        double rise = vec3_dot(vec3_normalize(superellipsoid_gradient(both, on)), next.direction);
        long double soon = value_at(e, &next, 1e-6L);
        if (fabs(rise) < 1e-2 || (soon < 0.0L) != (rise < 0.0)) {
            continue; // at an edge
        }
        count = superellipsoid_intervals(both, &next, (SideLeft){0, rise < 0.0}, intervals);
        wrong_starts += compare(e, &next, intervals, count, 1e-6, &starts);
    }
    tap_ok(asked > 1000 && wrong == 0 && differ == 0,
           "<%g, %g>: inside where the function is below 0 (%d of %d are not, %d)", e[0], e[1], wrong, asked, differ);
    tap_ok(wrong_starts == 0, "<%g, %g>: the same from the surface (%d of %d are not)", e[0], e[1], wrong_starts,
           starts);
}

int main(void)
{
    for (size_t i = 0; i < sizeof exponents / sizeof exponents[0]; i++) {
        test(exponents[i]);
    }
    return tap_done();
}
