// A ray against a torus, beside its quartic with 500 bits: how many crossings there are and where, for thin tubes and
// thick ones, from far away, grazing, along the axis and through it; and rays that start on the surface.
//
// The oracle knows the polynomial only: its roots lie between those of its derivative, and so on down.
//
// SPDX-License-Identifier: MIT
#include "trace/torus.h"

#include <stdlib.h>

#include "study/optional.h"
#include "unit/random.h"
#include "unit/tap.h"

#ifdef WITH_MPFR
#include "unit/roots_oracle.h"

// out = a b, of degree 2 each.
static void square_product(const OraclePolynomial *a, const OraclePolynomial *b, OraclePolynomial *out)
{
    mpfr_t term;
    mpfr_init2(term, BITS);
    for (int i = 0; i <= 2; i++) {
        for (int k = 0; k <= 2; k++) {
            mpfr_mul(term, a->c[i], b->c[k], MPFR_RNDN);
            mpfr_add(out->c[i + k], out->c[i + k], term, MPFR_RNDN);
        }
    }
    mpfr_clear(term);
}

// sum += factor (o + d t)²
static void add_square(OraclePolynomial *sum, double o, double d)
{
    mpfr_t term;
    mpfr_init2(term, BITS);
    const double terms[3][2] = {{o, o}, {2.0 * o, d}, {d, d}};
    for (int i = 0; i < 3; i++) {
        mpfr_set_d(term, terms[i][0], MPFR_RNDN);
        mpfr_mul_d(term, term, terms[i][1], MPFR_RNDN);
        mpfr_add(sum->c[i], sum->c[i], term, MPFR_RNDN);
    }
    mpfr_clear(term);
}

// (|p|² + R² - r²)² - 4 R² (x² + z²)
static void torus_polynomial(double major, double minor, const Ray *ray, OraclePolynomial *p)
{
    OraclePolynomial q, round, four;
    mpfr_t term;
    Vec3 o = ray->origin, d = ray->direction;
    polynomial_init(p, 4);
    polynomial_init(&q, 2);
    polynomial_init(&round, 2);
    polynomial_init(&four, 2);
    mpfr_init2(term, BITS);
    add_square(&round, o.x, d.x);
    add_square(&round, o.z, d.z);
    add_square(&q, o.x, d.x);
    add_square(&q, o.y, d.y);
    add_square(&q, o.z, d.z);
    mpfr_set_d(term, major, MPFR_RNDN);
    mpfr_sqr(term, term, MPFR_RNDN);
    mpfr_add(q.c[0], q.c[0], term, MPFR_RNDN);
    mpfr_mul_si(four.c[0], term, -4, MPFR_RNDN);
    mpfr_set_d(term, minor, MPFR_RNDN);
    mpfr_sqr(term, term, MPFR_RNDN);
    mpfr_sub(q.c[0], q.c[0], term, MPFR_RNDN);
    square_product(&q, &q, p);
    square_product(&round, &four, p);
    mpfr_clear(term);
    polynomial_fini(&q);
    polynomial_fini(&round);
    polynomial_fini(&four);
}

// ---- rays

typedef struct Case {
    double major, minor;
    Ray ray;
} Case;

typedef struct Family {
    const char *name;
    double minor; // of a major radius of 1
    double from;  // how far away rays start
    double graze; // > 0: they pass the surface at about this share of the minor radius, along it
    double size;  // of the direction
} Family;

static const Family families[] = {
    {"a thick tube", 0.4, 3.0, 0.0, 1.0},       {"a thin tube", 1e-3, 3.0, 0.0, 1.0},
    {"a thread", 1e-9, 3.0, 0.0, 1.0},          {"a closed hole", 1.0, 3.0, 0.0, 1.0},
    {"through itself", 2.5, 3.0, 0.0, 1.0},     {"nearly a ball", 1e6, 3.0, 0.0, 1.0},
    {"grazing", 0.4, 3.0, 1e-9, 1.0},           {"grazing to 14 digits", 0.4, 3.0, 1e-14, 1.0},
    {"grazing a thread", 1e-9, 3.0, 1e-6, 1.0}, {"grazing what goes through itself", 1.5, 3.0, 1e-12, 1.0},
    {"from far", 0.4, 1e6, 0.0, 1.0},           {"grazing from far", 0.4, 1e6, 1e-9, 1.0},
    {"a long direction", 0.4, 3.0, 0.0, 1e12},  {"a short direction", 0.4, 3.0, 0.0, 1e-12},
    {"from close by", 0.4, 1e-9, 0.0, 1.0},
};

static Case random_case(Random *random, const Family *family)
{
    int exponent;
    double a = random_between(random, 0.0, 6.3), b = random_between(random, 0.0, 6.3);
    double minor = family->minor * random_between(random, 0.8, 1.0);
    frexp(1.0 + minor, &exponent);
    Case made = {ldexp(1.0, -exponent), ldexp(minor, -exponent), {{0, 0, 0}, {0, 0, 0}}};
    Vec3 normal = vec3(cos(b) * cos(a), sin(b), cos(b) * sin(a));
    double deep = made.minor * (1.0 + family->graze * random_between(random, -2.0, 2.0));
    Vec3 on = vec3_add_scaled(vec3(made.major * cos(a), 0.0, made.major * sin(a)), deep, normal);
    Vec3 d = random_direction(random);
    unsigned way = random_bits(random) % 8;
    if (family->graze > 0.0) {
        d = vec3_normalize(vec3_add_scaled(d, -vec3_dot(d, normal), normal));
    } else if (way == 0) {
        d = vec3(0.0, 1.0, 0.0);
    } else if (way == 1) {
        d = vec3_normalize(vec3(on.x, 0.0, on.z)); // through the axis
    } else if (way == 2) {
        d = vec3_normalize(vec3_neg(on)); // through the middle
    }
    made.ray.origin = vec3_add_scaled(on, -family->from, d);
    made.ray.direction = vec3_scale(family->size, d);
    return made;
}

typedef struct Outcome {
    int rays, crossings, undecided, wrong_count;
    double worst; // error in units of 2^-53 t
} Outcome;

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double minor_square(const void *client, double t)
{
    const Case *asked = client;
    (void)t;
    return asked->minor * asked->minor;
}

static void check(const Case *asked, Outcome *outcome)
{
    RayInterval intervals[TORUS_INTERVALS];
    double own[2 * TORUS_INTERVALS], length = vec3_length(asked->ray.direction);
    unsigned count = torus_intervals(asked->major, asked->minor, &asked->ray, LEFT_NONE, intervals);
    for (unsigned i = 0; i < count; i++) {
        own[2 * i] = intervals[i].enter;
        own[2 * i + 1] = intervals[i].leave;
    }
    qsort(own, 2 * (size_t)count, sizeof own[0], compare);
    double bound = 2.0 * (vec3_length(asked->ray.origin) + 2.0) / length;
    OraclePolynomial p;
    Roots roots;
    torus_polynomial(asked->major, asked->minor, &asked->ray, &p);
    find_roots(&p, bound, &roots);
    outcome->rays++;
    if ((unsigned)roots.count != 2 * count) {
        bool decided = is_decided(&p, bound, minor_square, asked);
        outcome->wrong_count += decided;
        outcome->undecided += !decided;
    }
    for (int i = 0; (unsigned)roots.count == 2 * count && i < roots.count; i++) {
        double t = mpfr_get_d(roots.at[i], MPFR_RNDN), near = (double)INFINITY;
        for (int k = 0; k < roots.count; k++) {
            near = k == i ? near : fmin(near, fabs(mpfr_get_d(roots.at[k], MPFR_RNDN) - t));
        }
        // Of two roots that are so near, rounding of the line's 30 digits moves both.
        bool is_apart = near * length > 1e-13 * (1.0 + fabs(t) * length);
        outcome->worst = is_apart ? fmax(outcome->worst, fabs(own[i] - t) / (0x1p-53 * fabs(t))) : outcome->worst;
        outcome->crossings++;
    }
    polynomial_fini(&p);
    roots_fini(&roots);
}

static void test_family(const Family *family)
{
    Random random = {7};
    Outcome outcome = {0};
    for (int i = 0; i < 150; i++) {
        Case asked = random_case(&random, family);
        check(&asked, &outcome);
    }
    tap_ok(outcome.wrong_count == 0 && outcome.crossings > 50, "%s: as many crossings as the quartic has (%d of %d are not)",
           family->name, outcome.wrong_count, outcome.rays);
    tap_ok(outcome.worst < 4.0, "%s: all to the last bits (worst %.2f u of %d)", family->name, outcome.worst,
           outcome.crossings);
}

// ---- from the surface

static void test_from_surface(double major, double minor)
{
    Random random = {11};
    int rays = 0, wrong_in = 0, wrong_out = 0;
    for (int i = 0; i < 20000; i++) {
        double a = random_between(&random, 0.0, 6.3), b = random_between(&random, 0.0, 6.3);
        Vec3 n = vec3(cos(b) * cos(a), sin(b), cos(b) * sin(a));
        Vec3 on = vec3_add_scaled(vec3(major * cos(a), 0.0, major * sin(a)), minor, n), d = random_direction(&random);
        if (minor > major && major + minor * cos(b) < 0.0) {
            continue; // on the other side
        }
        if (i % 2) { // grazing
            d = vec3_normalize(vec3_add_scaled(d, -(1.0 - 1e-9) * vec3_dot(d, n), n));
        }
        double rise = vec3_dot(d, n);
        bool inward = rise < 0.0;
        RayInterval intervals[TORUS_INTERVALS];
        unsigned count = torus_intervals(major, minor, &(Ray){on, d}, (SideLeft){TORUS_OUTER, inward}, intervals);
        bool begins_inside = count > 0 && intervals[0].enter_side == TORUS_OUTER &&
                             intervals[0].enter == -(double)INFINITY && intervals[0].leave > 0.0;
        wrong_in += inward && rise < -1e-12 - 1e-15 / minor && !begins_inside; // the point is rounded
        for (unsigned k = 0; !inward && cos(b) > 0.0 && k < count; k++) { // where the surface is convex
            wrong_out += !(intervals[k].enter > 0.1 * minor * rise || intervals[k].enter_side == TORUS_INNER);
        }
        rays++;
    }
    tap_ok(rays > 10000 && wrong_in == 0, "%g, %g: rays inward are inside (%d of %d are not)", major, minor, wrong_in, rays);
    tap_ok(wrong_out == 0, "%g, %g: rays outward do not meet where they start (%d do)", major, minor, wrong_out);
}

int main(void)
{
    for (size_t i = 0; i < RT_COUNT_OF(families); i++) {
        test_family(&families[i]);
    }
    test_from_surface(0.6, 0.3);
    test_from_surface(0.75, 1e-9);
    test_from_surface(0.5, 0.5);
    test_from_surface(0.3, 0.6);
    mpfr_free_cache();
    return tap_done();
}
#else
int main(void)
{
    tap_skip("tori beside their quartics", "no MPFR");
    return tap_done();
}
#endif
