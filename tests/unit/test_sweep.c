// A ray against a sphere sweep, beside its balls in more digits: rays by chance, that graze, along a segment, from
// afar, through thin tubes and balls within balls, of all three curves; and rays that start on the surface.
//
// A place of a line is inside where some ball is nearer than its radius, for which the least of |p - m(s)|² - r(s)²
// over s is looked for in long double. Each place where that is not 0 but for rounding must be as the intervals say; of
// straight segments the class of the line, too. CHECK_LONG=1: a million rays each.
//
// SPDX-License-Identifier: MIT
#include "trace/sweep.h"

#include <math.h>
#include <stdlib.h>

#include "math/quad.h"
#include "scene/sweep.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { BALLS_MOST = 6, LIST_MOST = 400, PLACES = 60, SAMPLES = 48 };

typedef struct Family {
    const char *name;
    SweepCurve curve;
    double size, least, most; // of the middles; of radii
    double far;               // where rays come from
    bool is_grazing, is_along;
} Family;

static const Family families[] = {
    {"linear, by chance", SWEEP_LINEAR, 1.0, 0.05, 0.4, 3.0, false, false},
    {"linear, grazing", SWEEP_LINEAR, 1.0, 0.05, 0.4, 3.0, true, false},
    {"linear, along a segment", SWEEP_LINEAR, 1.0, 0.05, 0.4, 3.0, false, true},
    {"linear, thin", SWEEP_LINEAR, 1.0, 1e-7, 1e-6, 3.0, true, false},
    {"linear, balls in balls", SWEEP_LINEAR, 0.2, 0.1, 1.0, 3.0, true, false},
    {"linear, points and cones", SWEEP_LINEAR, 1.0, -0.3, 0.3, 3.0, true, false},
    {"linear, from afar", SWEEP_LINEAR, 1.0, 0.05, 0.4, 1e6, true, false},
    {"linear, small", SWEEP_LINEAR, 1e-12, 1e-13, 5e-13, 3e-12, true, false},
    {"B-spline, by chance", SWEEP_B_SPLINE, 1.0, 0.05, 0.4, 3.0, false, false},
    {"B-spline, grazing", SWEEP_B_SPLINE, 1.0, 0.05, 0.4, 3.0, true, false},
    {"B-spline, along a segment", SWEEP_B_SPLINE, 1.0, 0.05, 0.4, 3.0, false, true},
    {"B-spline, thin", SWEEP_B_SPLINE, 1.0, 1e-5, 1e-4, 3.0, true, false},
    {"cubic, by chance", SWEEP_CUBIC, 1.0, 0.05, 0.4, 3.0, false, false},
    {"cubic, thin", SWEEP_CUBIC, 1.0, 1e-5, 1e-4, 3.0, true, false},
    {"cubic, through points", SWEEP_CUBIC, 1.0, -0.3, 0.3, 3.0, true, false},
};

static int rays_of_family(void)
{
    return getenv("CHECK_LONG") ? 1000000 : 100;
}

// ---- sweeps and rays

// Places on a lattice at times, so that segments lie along axes and balls on each other.
static double random_place(Random *random, double size)
{
    return random_bits(random) % 3 == 0 ? size * ((double)(random_bits(random) % 3) - 1.0)
                                        : random_between(random, -size, size);
}

static Sweep random_sweep(Random *random, const Family *family, double *list)
{
    uint32_t count = sweep_least(family->curve) + random_below(random, BALLS_MOST - sweep_least(family->curve) + 1);
    SweepBall *balls = (SweepBall *)(void *)(list + SWEEP_HEAD);
    double even = random_between(random, fmax(family->least, 0.0), family->most);
    bool is_even = random_bits(random) % 3 == 0;
    for (uint32_t i = 0; i < count; i++) {
        double x = random_place(random, family->size), y = random_place(random, family->size);
        double z = random_place(random, family->size), radius = random_between(random, family->least, family->most);
        balls[i] = (SweepBall){{x, y, z}, is_even ? even : fmax(radius, 0.0)};
    }
    sweep_complete(list, family->curve, count);
    return sweep_of(list);
}

static Ray random_ray(Random *random, const Family *family, const Sweep *sweep)
{
    uint32_t segment = random_below(random, sweep->segment_count);
    SweepBall ball = sweep_ball(sweep, segment, random_between(random, -0.5, 0.5));
    Vec3 direction = random_direction(random), aim = ball.middle;
    if (random_bits(random) % 4 == 0) {
        direction = random_bits(random) % 2 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 0.0, -1.0);
    }
    if (family->is_along && vec3_length(sweep->segments[segment].terms[1].middle) > 0.0) {
        direction = vec3_normalize(sweep->segments[segment].terms[1].middle);
    }
    Vec3 beside = vec3_cross(direction, random_direction(random));
    double graze = pow(10.0, random_between(random, -16.0, -3.0));
    graze = random_bits(random) % 2 ? graze : -graze;
    double most = family->is_grazing ? 1.0 + graze : random_between(random, 0.0, 1.1);
    if (vec3_length(beside) > 0.0) {
        aim = vec3_add_scaled(aim, most * fabs(ball.radius), vec3_normalize(beside));
    }
    double stretch = random_bits(random) % 2 ? 1.0 : random_between(random, 0.01, 50.0);
    return (Ray){vec3_add_scaled(aim, -family->far, direction), vec3_scale(stretch, direction)};
}

// ---- balls in more digits

static long double power_at(const SweepBall *t, unsigned degree, const long double p[3], long double s)
{
    long double ball[4] = {0.0L, 0.0L, 0.0L, 0.0L};
    for (unsigned i = degree + 1; i-- > 0;) {
        ball[0] = ball[0] * s + (long double)t[i].middle.x;
        ball[1] = ball[1] * s + (long double)t[i].middle.y;
        ball[2] = ball[2] * s + (long double)t[i].middle.z;
        ball[3] = ball[3] * s + (long double)t[i].radius;
    }
    long double x = ball[0] - p[0], y = ball[1] - p[1], z = ball[2] - p[2];
    long double distance = sqrtl(x * x + y * y + z * z), radius = fabsl(ball[3]);
    return (distance - radius) * (distance + radius);
}

static long double least_power(const SweepBall *t, unsigned degree, const long double p[3])
{
    long double least = fminl(power_at(t, degree, p, -0.5L), power_at(t, degree, p, 0.5L)), values[SAMPLES + 1];
    for (int i = 0; i <= SAMPLES; i++) {
        values[i] = power_at(t, degree, p, i / (long double)SAMPLES - 0.5L);
    }
    for (int i = 0; i <= SAMPLES; i++) {
        if ((i > 0 && values[i - 1] < values[i]) || (i < SAMPLES && values[i + 1] < values[i])) {
            continue;
        }
        long double low = (i > 0 ? i - 1 : 0) / (long double)SAMPLES - 0.5L;
        long double high = (i < SAMPLES ? i + 1 : SAMPLES) / (long double)SAMPLES - 0.5L;
        for (int k = 0; k < 80; k++) {
            long double a = low + (high - low) / 3.0L, b = high - (high - low) / 3.0L;
            bool is_left = power_at(t, degree, p, a) < power_at(t, degree, p, b);
            low = is_left ? low : a;
            high = is_left ? b : high;
        }
        least = fminl(least, power_at(t, degree, p, 0.5L * (low + high)));
    }
    return least;
}

static long double exact_power(const Sweep *sweep, const Ray *ray, long double t)
{
    const long double p[3] = {(long double)ray->origin.x + t * (long double)ray->direction.x,
                              (long double)ray->origin.y + t * (long double)ray->direction.y,
                              (long double)ray->origin.z + t * (long double)ray->direction.z};
    long double least = HUGE_VALL;
    for (uint32_t i = 0; i < sweep->segment_count; i++) {
        least = fminl(least, least_power(sweep->segments[i].terms, sweep->degree, p));
    }
    return least;
}

// ---- comparisons

static bool says_inside(const RayInterval *intervals, unsigned count, double t)
{
    bool is_inside = false;
    for (unsigned i = 0; i < count; i++) {
        is_inside = is_inside || (intervals[i].enter < t && t < intervals[i].leave);
    }
    return is_inside;
}

// How much a power may be wrong where a point of the line is off by rounding.
static long double room_of(const Family *family, const Ray *ray, double t)
{
    double reach = family->size + family->most + vec3_length(ray->origin) + fabs(t) * vec3_length(ray->direction);
    return (long double)(0x1p-47 * reach * (family->most + 0x1p-47 * reach));
}

// Places on both sides of the ends of intervals, and between; returns how many are not as they should be.
static int compare(const Family *family, const Sweep *sweep, const Ray *ray, const RayInterval *intervals,
                   unsigned count, double begin, int *asked)
{
    double length = vec3_length(ray->direction), middle = family->far / length, half = 3.0 * family->size / length;
    int wrong = 0;
    for (int i = 0; i < PLACES; i++) {
        double place = middle + half * (2.0 * i / PLACES - 1.0);
        if (i < 8 * (int)count && i < PLACES / 2) {
            const RayInterval *own = &intervals[i / 8];
            double step = (own->leave - own->enter) * (i & 1 ? 1e-3 : 1e-9) * (i & 2 ? 1.0 : -1.0);
            place = i & 4 ? own->leave + step : own->enter + step;
        }
        if (!(place > begin) || isinf(place)) {
            continue;
        }
        long double power = exact_power(sweep, ray, (long double)place);
        if (fabsl(power) > room_of(family, ray, place)) {
            (*asked)++;
            wrong += says_inside(intervals, count, place) != (power < 0.0L);
        }
    }
    return wrong;
}

// The greatest |d|² r² - |(m - o) × d|² of a straight segment, whose sign says whether the line is met: by its terms as
// they are, in quadruple precision; *size: of what makes it.
static Quad exact_class(const Sweep *sweep, const Ray *ray, Quad *size)
{
    Quad most = -1.0, d[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
    Quad square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    *size = 0.0;
    for (uint32_t i = 0; i < sweep->segment_count; i++) {
        const SweepBall *t = sweep->segments[i].terms;
        Quad from[3] = {(Quad)t[0].middle.x - (Quad)ray->origin.x, (Quad)t[0].middle.y - (Quad)ray->origin.y,
                        (Quad)t[0].middle.z - (Quad)ray->origin.z};
        Quad way[3] = {t[1].middle.x, t[1].middle.y, t[1].middle.z}, f[3];
        f[0] = square * (Quad)t[0].radius * (Quad)t[0].radius;
        f[1] = 2.0 * square * (Quad)t[0].radius * (Quad)t[1].radius;
        f[2] = square * (Quad)t[1].radius * (Quad)t[1].radius;
        for (int k = 0; k < 3; k++) {
            int a = (k + 1) % 3, b = (k + 2) % 3;
            Quad first = from[a] * d[b] - from[b] * d[a], next = way[a] * d[b] - way[b] * d[a];
            f[0] -= first * first;
            f[1] -= 2.0 * first * next;
            f[2] -= next * next;
        }
        Quad places[3] = {-0.5, 0.5, f[2] < 0.0 ? -0.5 * f[1] / f[2] : 0.5};
        for (int k = 0; k < 3; k++) {
            Quad s = places[k], value = f[0] + s * (f[1] + s * f[2]);
            most = (s >= -0.5 && s <= 0.5 && (value > most || (i == 0 && k == 0))) ? value : most;
        }
        for (int k = 0; k < 3; k++) {
            *size += square * (from[k] * from[k] + way[k] * way[k]);
        }
    }
    return most;
}

static void test(const Family *family, uint64_t seed)
{
    Random random = {seed};
    double list[LIST_MOST];
    int wrong = 0, asked = 0, wrong_starts = 0, starts = 0, wrong_class = 0, classes = 0, rays = rays_of_family();
    for (int i = 0; i < rays; i++) {
        RayInterval intervals[SWEEP_PIECES_MOST * BALLS_MOST + 1];
        Sweep sweep = random_sweep(&random, family, list);
        Ray ray = random_ray(&random, family, &sweep);
        unsigned count = sweep_intervals(list, &ray, LEFT_NONE, intervals);
        if (family->curve == SWEEP_LINEAR) {
            Quad size, most = exact_class(&sweep, &ray, &size);
            bool is_known = (most < 0.0 ? -most : most) > 0x1p-90 * size;
            classes += is_known;
            wrong_class += is_known && (most > 0.0) != (count > 0);
        }
        if (i >= 20000) {
            continue; // the other comparison takes its time
        }
        wrong += compare(family, &sweep, &ray, intervals, count, -1e300, &asked);
        if (count == 0) {
            continue;
        }
        Vec3 on = sweep_point(list, ray_at(ray, intervals[0].enter)), out = sweep_gradient(list, on);
        Ray next = {on, random_direction(&random)};
        double rise = vec3_dot(vec3_normalize(out), next.direction);
        if (fabs(rise) < 1e-2 || family->far > 10.0) {
            continue;
        }
        Family near = *family;
        near.far = 0.0;
        count = sweep_intervals(list, &next, (SideLeft){0, rise < 0.0}, intervals);
        wrong_starts += compare(&near, &sweep, &next, intervals, count, 1e-6 * family->size, &starts);
    }
    tap_ok(asked > rays && wrong == 0, "%s: inside where a ball is (%d of %d are not)", family->name, wrong, asked);
    tap_ok(wrong_starts == 0, "%s: the same from the surface (%d of %d are not)", family->name, wrong_starts, starts);
    if (family->curve == SWEEP_LINEAR) {
        tap_ok(classes > rays / 2 && wrong_class == 0, "%s: met as exact arithmetic says (%d of %d are not)",
               family->name, wrong_class, classes);
    }
}

int main(int argc, char **argv)
{
    uint64_t seed = random_seed(argc > 1 ? argv[1] : NULL);
    for (size_t i = 0; i < sizeof families / sizeof families[0]; i++) {
        test(&families[i], seed + i);
    }
    return tap_done();
}
