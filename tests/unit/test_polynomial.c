// A ray against surfaces of order 2 to 8, beside the polynomial along it with 500 bits: how many crossings there are
// and where, through random surfaces, grazing them, at double and triple roots, along an axis, from far away, at sizes
// of 1e-12 to 1e12; and rays that start on the surface.
//
// SPDX-License-Identifier: MIT
#include "trace/polynomial.h"

#include <stdlib.h>

#include "scene/polynomial.h"
#include "study/optional.h"
#include "unit/random.h"
#include "unit/tap.h"

#ifdef WITH_MPFR
#include "unit/roots_oracle.h"

enum { ORDER_MOST = ORACLE_DEGREE, LIST_MOST = POLYNOMIAL_HEAD + ORDER_MOST + 1 + 165 };

typedef struct Surface {
    unsigned order;
    double list[LIST_MOST];
} Surface;

static double *surface_terms(Surface *surface)
{
    return surface->list + (polynomial_list_count(surface->order) - polynomial_count(surface->order));
}

// p += term (o + d t)_axis^power …, all exact but for 500 bits.
static void add_monomial(OraclePolynomial *p, double term, const unsigned powers[3], const Ray *ray)
{
    const double o[3] = {ray->origin.x, ray->origin.y, ray->origin.z};
    const double d[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
    mpfr_t c[ORACLE_DEGREE + 1], next;
    mpfr_init2(next, BITS);
    for (int i = 0; i <= ORACLE_DEGREE; i++) {
        mpfr_init2(c[i], BITS);
        mpfr_set_d(c[i], i == 0 ? term : 0.0, MPFR_RNDN);
    }
    for (int axis = 0; axis < 3; axis++) {
        for (unsigned k = 0; k < powers[axis]; k++) {
            for (int i = ORACLE_DEGREE; i >= 0; i--) {
                mpfr_mul_d(c[i], c[i], o[axis], MPFR_RNDN);
                if (i > 0) {
                    mpfr_mul_d(next, c[i - 1], d[axis], MPFR_RNDN);
                    mpfr_add(c[i], c[i], next, MPFR_RNDN);
                }
            }
        }
    }
    for (int i = 0; i <= ORACLE_DEGREE; i++) {
        mpfr_add(p->c[i], p->c[i], c[i], MPFR_RNDN);
        mpfr_clear(c[i]);
    }
    mpfr_clear(next);
}

static void along_ray(Surface *surface, const Ray *ray, OraclePolynomial *p)
{
    const double *term = surface_terms(surface);
    polynomial_init(p, (int)surface->order);
    for (unsigned i = surface->order + 1; i-- > 0;) {
        for (unsigned j = surface->order - i + 1; j-- > 0;) {
            for (unsigned k = surface->order - i - j + 1; k-- > 0;) {
                if (*term != 0.0) {
                    add_monomial(p, *term, (unsigned[]){i, j, k}, ray);
                }
                term++;
            }
        }
    }
    while (p->degree > 0 && mpfr_zero_p(p->c[p->degree])) {
        p->degree--;
    }
}

// Within which all roots are.
static double roots_bound(const OraclePolynomial *p)
{
    double most = 0.0;
    mpfr_t share;
    mpfr_init2(share, BITS);
    for (int i = 0; i < p->degree; i++) {
        mpfr_div(share, p->c[i], p->c[p->degree], MPFR_RNDN);
        most = fmax(most, pow(fabs(mpfr_get_d(share, MPFR_RNDN)), 1.0 / (p->degree - i)));
    }
    mpfr_clear(share);
    return 2.5 * most;
}

typedef struct SurfaceRay {
    const Surface *surface;
    const Ray *ray;
} SurfaceRay;

// The sum of the sizes of all terms at t.
static double sizes_at(const void *client, double t)
{
    const Surface *surface = ((const SurfaceRay *)client)->surface;
    const Ray *ray = ((const SurfaceRay *)client)->ray;
    double reach = vec3_max_abs(ray->origin) + fabs(t) * vec3_max_abs(ray->direction), sum = 0.0;
    const double *sizes = polynomial_sizes(surface->list);
    for (unsigned i = surface->order + 1; i-- > 0;) {
        sum = sum * reach + sizes[i];
    }
    return sum;
}

typedef struct Outcome {
    int rays, crossings, undecided, wrong;
    double worst; // error in units of 2^-53 of what makes the place
} Outcome;

static void check(Surface *surface, const Ray *ray, Outcome *outcome)
{
    RayInterval intervals[ORDER_MOST];
    double own[2 * ORDER_MOST];
    unsigned count = polynomial_intervals(surface->list, ray, LEFT_NONE, ORDER_MOST, intervals), roots_count = 0;
    for (unsigned i = 0; i < count; i++) {
        if (!isinf(intervals[i].enter)) {
            own[roots_count++] = intervals[i].enter;
        }
        if (!isinf(intervals[i].leave)) {
            own[roots_count++] = intervals[i].leave;
        }
    }
    OraclePolynomial p;
    Roots roots;
    along_ray(surface, ray, &p);
    double bound = roots_bound(&p), length = vec3_max_abs(ray->direction);
    find_roots(&p, bound, &roots);
    outcome->rays++;
    if ((unsigned)roots.count != roots_count) {
        bool decided = is_decided(&p, bound, sizes_at, &(SurfaceRay){surface, ray});
        outcome->wrong += decided;
        outcome->undecided += !decided;
    }
    for (int i = 0; (unsigned)roots.count == roots_count && i < roots.count; i++) {
        double t = mpfr_get_d(roots.at[i], MPFR_RNDN), near = (double)INFINITY;
        double reach = vec3_max_abs(ray->origin) / length + fabs(t);
        for (int k = 0; k < roots.count; k++) {
            near = k == i ? near : fmin(near, fabs(mpfr_get_d(roots.at[k], MPFR_RNDN) - t));
        }
        if (near > 1e-9 * reach) { // of two that are nearer the line's last digits move both
            outcome->worst = fmax(outcome->worst, fabs(own[i] - t) / (0x1p-53 * reach));
        }
        outcome->crossings++;
    }
    polynomial_fini(&p);
    roots_fini(&roots);
}

// ---- families

typedef struct Family {
    const char *name;
    unsigned order;
    double from;   // how far away rays start
    double graze;  // > 0: they pass the surface at about this, along it
    double size;   // of the surface
    double length; // of the direction
    bool is_along_axis;
} Family;

static const Family families[] = {
    {"quadrics", 2, 3.0, 0.0, 1.0, 1.0, false},
    {"cubics", 3, 3.0, 0.0, 1.0, 1.0, false},
    {"quartics", 4, 3.0, 0.0, 1.0, 1.0, false},
    {"order 6", 6, 3.0, 0.0, 1.0, 1.0, false},
    {"order 8", 8, 3.0, 0.0, 1.0, 1.0, false},
    {"grazing a quadric", 2, 3.0, 1e-9, 1.0, 1.0, false},
    {"grazing a quadric to 14 digits", 2, 3.0, 1e-14, 1.0, 1.0, false},
    {"grazing a quartic", 4, 3.0, 1e-9, 1.0, 1.0, false},
    {"grazing a quartic to 14 digits", 4, 3.0, 1e-14, 1.0, 1.0, false},
    {"grazing order 7", 7, 3.0, 1e-12, 1.0, 1.0, false},
    {"along an axis", 4, 3.0, 0.0, 1.0, 1.0, true},
    {"from far", 4, 1e6, 0.0, 1.0, 1.0, false},
    {"from far on a quadric", 2, 1e6, 1e-9, 1.0, 1.0, false},
    {"a small quadric", 2, 3.0, 0.0, 1e-12, 1.0, false},
    {"a small quartic", 4, 3.0, 1e-9, 1e-12, 1.0, false},
    {"a large quartic", 4, 3.0, 1e-9, 1e12, 1.0, false},
    {"a large surface of order 6", 6, 3.0, 0.0, 1e12, 1.0, false},
    {"a long direction", 4, 3.0, 0.0, 1.0, 1e12, false},
    {"a short direction", 4, 3.0, 0.0, 1.0, 1e-12, false},
};

// Random coefficients, some of them 0; made such that the surface goes through a place of about its size.
static Surface random_surface(Random *random, unsigned order, double size, Vec3 on)
{
    Surface surface = {.order = order};
    double *term = surface_terms(&surface);
    surface.list[0] = order;
    for (unsigned i = order + 1; i-- > 0;) {
        for (unsigned j = order - i + 1; j-- > 0;) {
            for (unsigned k = order - i - j + 1; k-- > 0;) {
                bool is_there = random_below(random, 3) != 0 || i + j + k == order;
                *term++ = is_there ? random_between(random, -1.0, 1.0) * pow(size, -(double)(i + j + k)) : 0.0;
            }
        }
    }
    term[-1] -= polynomial_value(surface.list, on);
    polynomial_complete(surface.list);
    return surface;
}

static void test_family(const Family *family, uint64_t seed)
{
    Random random = {seed};
    Outcome outcome = {0};
    int rays = getenv("CHECK_LONG") ? 1000000 / (int)(family->order * family->order) : 60;
    for (int i = 0; i < rays; i++) {
        Vec3 on = random_vec3(&random, -family->size, family->size), d = random_direction(&random);
        Surface surface = random_surface(&random, family->order, family->size, on);
        if (family->is_along_axis) {
            unsigned axis = random_below(&random, 3);
            d = vec3(axis == 0, axis == 1, axis == 2);
        }
        if (family->graze > 0.0) {
            Vec3 n = polynomial_normal(surface.list, on);
            d = vec3_normalize(vec3_add_scaled(d, -vec3_dot(d, n), n));
            on = vec3_add_scaled(on, family->size * family->graze * random_between(&random, -2.0, 2.0), n);
        }
        Ray ray = {vec3_add_scaled(on, -family->from * family->size, d), vec3_scale(family->length, d)};
        check(&surface, &ray, &outcome);
    }
    tap_ok(outcome.wrong == 0 && outcome.crossings > rays / 3,
           "%s: as many crossings as there are (%d of %d are not, %d "
           "are within 26 digits)",
           family->name, outcome.wrong, outcome.rays, outcome.undecided);
    tap_ok(outcome.worst < 512.0, "%s: within 512 u (worst %.2f u of %d)", family->name, outcome.worst,
           outcome.crossings);
}

// (x - a)^m (x + b)… + s y: on the ray along x at y, with y near 0, roots of multiplicity m come apart or go.
static void test_multiple(unsigned multiplicity, unsigned order, uint64_t seed)
{
    Random random = {seed};
    Outcome outcome = {0};
    for (int i = 0; i < 60; i++) {
        Surface surface = {.order = order};
        double *terms = surface_terms(&surface), c[ORDER_MOST + 1] = {1.0}, a = random_below(&random, 7) / 4.0;
        for (unsigned k = 0; k < order; k++) {
            double root = k < multiplicity ? a : -(double)(k + 1);
            for (unsigned n = k + 2; n-- > 0;) {
                c[n] = (n > 0 ? c[n - 1] : 0.0) - root * (n <= k ? c[n] : 0.0);
            }
        }
        size_t at = 0; // of x^i alone the coefficient is the last of its row
        for (unsigned n = order + 1; n-- > 0;) {
            at += (size_t)(order - n + 1) * (order - n + 2) / 2;
            terms[at - 1] = c[n];
        }
        terms[polynomial_count(order) - order - 2] = 1.0; // of y
        surface.list[0] = order;
        polynomial_complete(surface.list);
        double share = random_between(&random, -1.0, 1.0);
        double aside = i % 3 == 0 ? 0.0 : share * pow(10.0, -(double)random_below(&random, 30));
        Ray ray = {vec3(-10.0, aside, 0.0), vec3(1.0, 0.0, 0.0)};
        check(&surface, &ray, &outcome);
    }
    tap_ok(outcome.wrong == 0,
           "roots of multiplicity %u in order %u: as many as there are (%d of %d are not, %d are within "
           "26 digits)",
           multiplicity, order, outcome.wrong, outcome.rays, outcome.undecided);
}

// ---- from the surface

static void test_from_surface(unsigned order, double size, uint64_t seed)
{
    Random random = {seed};
    int rays = 0, wrong = 0, met_again = 0;
    for (int i = 0; i < 2000; i++) {
        Vec3 on = random_vec3(&random, -size, size), d = random_direction(&random);
        Surface surface = random_surface(&random, order, size, on);
        Vec3 n = polynomial_normal(surface.list, on);
        if (i % 2) { // grazing
            d = vec3_normalize(vec3_add_scaled(d, -(1.0 - 1e-2) * vec3_dot(d, n), n));
        }
        bool inward = vec3_dot(d, n) < 0.0;
        RayInterval intervals[ORDER_MOST], whole[ORDER_MOST];
        Ray ray = {on, d}, before = {vec3_add_scaled(on, -8.0 * size, d), d};
        unsigned count = polynomial_intervals(surface.list, &ray, (SideLeft){0, inward}, ORDER_MOST, intervals);
        unsigned whole_count = polynomial_intervals(surface.list, &before, LEFT_NONE, ORDER_MOST, whole), behind = 0;
        double limit = 1e-4 * size;
        unsigned near = 0;
        for (unsigned k = 0; k < whole_count; k++) {
            double enter = whole[k].enter - 8.0 * size, leave = whole[k].leave - 8.0 * size;
            behind += (unsigned)(enter > limit && !isinf(enter)) + (unsigned)(leave > limit && !isinf(leave));
            near += (unsigned)(fabs(enter) <= limit) + (unsigned)(fabs(leave) <= limit);
        }
        if (near != 1) {
            continue; // another root is at hand
        }
        unsigned own = 0;
        for (unsigned k = 0; k < count; k++) {
            own += (unsigned)(intervals[k].enter > 0.0 && !isinf(intervals[k].enter)) +
                   (unsigned)(intervals[k].leave < (double)INFINITY);
            met_again += (intervals[k].enter > 0.0 && intervals[k].enter < limit) || intervals[k].leave < limit;
        }
        rays++;
        wrong += own != behind;
    }
    tap_ok(met_again == 0 && rays > 1000, "order %u, size %g: no ray meets what it starts on (%d of %d do)", order,
           size, met_again, rays);
    tap_ok(wrong == 0, "order %u, size %g: and all else (%d of %d do not)", order, size, wrong, rays);
}

// The crossings of intervals in a range, and whether its low end is inside. False: some lie next to an end.
static bool crossings_within(const RayInterval *intervals, unsigned count, double low, double high, double *places,
                             unsigned *found, bool *is_inside)
{
    bool is_clear = true;
    *found = 0;
    *is_inside = false;
    for (unsigned i = 0; i < count; i++) {
        const double ends[2] = {intervals[i].enter, intervals[i].leave};
        for (int k = 0; k < 2; k++) {
            is_clear = is_clear && !(fabs(ends[k] - low) < 1e-5 * high) && !(fabs(ends[k] - high) < 1e-5 * high);
            if (ends[k] > low && ends[k] < high) {
                places[(*found)++] = ends[k];
            }
        }
        *is_inside = *is_inside || (ends[0] < low && ends[1] > low);
    }
    return is_clear;
}

// A range has the crossings that all of the line has there, and as good ones.
static void test_within(unsigned order, double size, bool starts, uint64_t seed)
{
    Random random = {seed};
    int rays = 0, met = 0, wrong = 0;
    double worst = 0.0;
    for (int i = 0; i < 4000; i++) {
        Vec3 on = random_vec3(&random, -size, size), d = random_direction(&random);
        Surface surface = random_surface(&random, order, size, on);
        Vec3 n = polynomial_normal(surface.list, on);
        Ray ray = {starts ? on : vec3_add_scaled(on, -random_between(&random, 1.0, 8.0) * size, d), d};
        SideLeft left = {starts ? 0 : SIDE_NONE, vec3_dot(d, n) < 0.0};
        double low = i % 3 == 0 ? 0.0 : random_between(&random, 0.0, 6.0) * size;
        double high = low + random_between(&random, 0.1, 6.0) * size;
        RayInterval whole[ORDER_MOST], part[ORDER_MOST];
        double all[2 * ORDER_MOST], some[2 * ORDER_MOST];
        unsigned all_count, some_count;
        bool all_inside, some_inside;
        unsigned count = polynomial_intervals(surface.list, &ray, left, ORDER_MOST, whole);
        if (!crossings_within(whole, count, low, high, all, &all_count, &all_inside)) {
            continue;
        }
        count = polynomial_intervals_within(surface.list, &ray, left, (LineRange){low, high}, ORDER_MOST, part);
        crossings_within(part, count, low, high, some, &some_count, &some_inside);
        rays++;
        met += all_count > 0;
        wrong += some_count != all_count || some_inside != all_inside;
        for (unsigned k = 0; k < all_count && some_count == all_count; k++) {
            worst = fmax(worst, fabs(some[k] - all[k]) / (size + all[k]));
        }
    }
    tap_ok(wrong == 0 && rays > 2000 && met > 200, "order %u, size %g%s: a range has what the line has (%d of %d not)",
           order, size, starts ? ", from the surface" : "", wrong, rays);
    tap_ok(worst < 1e-9, "order %u, size %g: and where that has it (%g)", order, size, worst);
}

int main(void)
{
    uint64_t seed = random_seed(NULL);
    for (size_t i = 0; i < sizeof families / sizeof *families; i++) {
        test_family(&families[i], seed);
    }
    for (unsigned order = 3; order <= 6; order++) {
        for (int starts = 0; starts < 2; starts++) {
            test_within(order, order == 4 ? 1e-9 : 1.0, starts, seed + order);
        }
    }
    test_multiple(2, 2, seed);
    test_multiple(2, 4, seed);
    test_multiple(3, 3, seed);
    test_multiple(3, 4, seed);
    test_multiple(4, 4, seed);
    test_multiple(3, 6, seed);
    test_from_surface(2, 1.0, seed);
    test_from_surface(2, 1e-12, seed);
    test_from_surface(4, 1.0, seed);
    test_from_surface(4, 1e12, seed);
    test_from_surface(6, 1.0, seed);
    mpfr_free_cache();
    return tap_done();
}
#else
int main(void)
{
    tap_skip("polynomials along rays", "no MPFR");
    return tap_done();
}
#endif
