// The sphere test on cases that can be computed by hand, and on inputs that are not numbers. The families of
// test_trace_certified.c compare it with exact arithmetic.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>

#include "math/random.h"
#include "trace/sphere.h"
#include "study/cases.h"
#include "unit/tap.h"

typedef enum Class { CLASS_MISS, CLASS_NEAR, CLASS_FAR } Class;

static Class computed_class(const SphereCase *input, double *t)
{
    SphereRay ray = sphere_ray_make(input->ray.origin, input->ray.direction);
    SphereData ball = sphere_data_make(input->centre, input->radius);
    bool inside = false;
    *t = sphere_ray_is_usable(&ray) ? sphere_hit(&ray, &ball, &inside) : 0.0;
    return !(*t > 0.0 && *t < (double)INFINITY) ? CLASS_MISS : inside ? CLASS_FAR : CLASS_NEAR;
}

static void test_exact_cases(void)
{
    static const struct {
        const char *name;
        SphereCase input;
        Class class;
        double t;
    } cases[] = {
        {"head on", {{{0, 0, -5}, {0, 0, 1}}, {0, 0, 0}, 1}, CLASS_NEAR, 4},
        {"tangent counts as met", {{{0, 1, -5}, {0, 0, 1}}, {0, 0, 0}, 1}, CLASS_NEAR, 5},
        {"just beside", {{{0, 1 + 0x1p-52, -5}, {0, 0, 1}}, {0, 0, 0}, 1}, CLASS_MISS, 0},
        {"behind", {{{0, 0, 5}, {0, 0, 1}}, {0, 0, 0}, 1}, CLASS_MISS, 0},
        {"from the centre", {{{0, 0, 0}, {0, 0, 1}}, {0, 0, 0}, 2}, CLASS_FAR, 2},
        {"on the surface, inward", {{{0, 0, -1}, {0, 0, 1}}, {0, 0, 0}, 1}, CLASS_FAR, 2},
        {"on the surface, outward", {{{0, 0, 1}, {0, 0, 1}}, {0, 0, 0}, 1}, CLASS_MISS, 0},
        {"on the surface, along it", {{{0, 1, 0}, {0, 0, 1}}, {0, 0, 0}, 1}, CLASS_MISS, 0},
        {"direction of length 2", {{{0, 0, -5}, {0, 0, 2}}, {0, 0, 0}, 1}, CLASS_NEAR, 2},
    };
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        double t = 0.0;
        Class class = computed_class(&cases[i].input, &t);
        tap_ok(class == cases[i].class && (class == CLASS_MISS || t == cases[i].t), "%s", cases[i].name);
    }
}

// Every pair of the ten inputs set to things that are not usable numbers. Nothing is met when there is no ray or no
// sphere; what is met otherwise has a finite t, since computed_class compares as the queries do.
static void test_not_numbers(void)
{
    static const double odd[] = {NAN,    INFINITY, -INFINITY, DBL_MAX, -DBL_MAX, DBL_MIN, 0x1p-1074,
                                 0.0,    -0.0,     1e200,     -1e200,  1e-200,   1.0,     -1.0};
    enum { ODD_COUNT = RT_COUNT_OF(odd), INPUTS = 10 };
    int false_hits = 0;
    for (int i = 0; i < INPUTS * INPUTS * ODD_COUNT * ODD_COUNT; i++) {
        double v[INPUTS] = {0.1, 0.2, -5, 0, 0, 1, 0, 0, 0, 1};
        v[i % INPUTS] = odd[i / (INPUTS * INPUTS) % ODD_COUNT];
        v[i / INPUTS % INPUTS] = odd[i / (INPUTS * INPUTS * ODD_COUNT)];
        SphereCase input = {{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}}, {v[6], v[7], v[8]}, v[9]};
        double t;
        bool all_finite = vec3_is_finite(input.ray.origin) && vec3_is_finite(input.ray.direction) &&
                          vec3_is_finite(input.centre) && isfinite(input.radius);
        bool nothing_there = !all_finite || !(input.radius > 0.0) || vec3_max_abs(input.ray.direction) == 0.0;
        false_hits += nothing_there && computed_class(&input, &t) != CLASS_MISS;
    }
    tap_ok(false_hits == 0, "NaN, infinity, zero direction and zero radius meet nothing (%d did)", false_hits);
}

// A ray from the surface of a sphere to its middle meets whatever lies about that, however small: rounding moves its
// start by some 2^-53, and so the ray by as little.
static void test_small_within(void)
{
    Random random = {11};
    int missed = 0, wrong = 0;
    for (int i = 0; i < 20000; i++) {
        Vec3 direction = random_direction(&random);
        int power = -(int)(random_bits(&random) % 46);
        double radius = ldexp(random_between(&random, 0.5, 1.0), power);
        SphereRay ray = sphere_ray_make(vec3_neg(direction), direction);
        SphereData within = sphere_data_make(vec3(0.0, 0.0, 0.0), radius), own = sphere_data_make(within.centre, 1.0);
        bool inside = true;
        double t = sphere_exact(&ray, &within, &own, &inside);
        missed += !(t > 0.0) || inside;
        wrong += !(fabs(t - (1.0 - radius)) <= 0x1p-50);
    }
    tap_ok(missed == 0 && wrong == 0, "small spheres within one that the ray starts on: %d missed, %d elsewhere", missed,
           wrong);
}

int main(void)
{
    test_small_within();
    test_exact_cases();
    test_not_numbers();
    return tap_done();
}
