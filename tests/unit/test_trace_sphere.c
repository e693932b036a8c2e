// The sphere test against exact arithmetic: the classes and backward errors that docs/numerics.md promises, in families
// of rays that are hard in different ways, and inputs that are not numbers.
//
// The reference is __float128 on the exact inputs: 113 bits hold r² - |l|² to 1e-10 r² at a distance of 1e12 radii, far
// below its rounding uncertainty in double.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>

#include "trace/sphere.h"
#include "unit/random.h"
#include "unit/tap.h"

typedef __float128 Quad;

enum { CASES = 100 * 1000 };

static const double U = DBL_EPSILON / 2;

typedef enum Class { CLASS_MISS, CLASS_NEAR, CLASS_FAR } Class;

typedef struct Case {
    Ray ray;
    Vec3 centre;
    double radius;
} Case;

typedef struct Exact {
    Quad f[3], d[3], r, t_middle, discriminant, c, uncertainty_d, uncertainty_c;
    Class class;
} Exact;

static Quad quad_abs(Quad x)
{
    return x < 0 ? -x : x;
}

static Quad quad_dot(const Quad *a, const Quad *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static Exact exact_solve(const Case *input)
{
    Exact e = {.f = {(Quad)input->ray.origin.x - input->centre.x, (Quad)input->ray.origin.y - input->centre.y,
                     (Quad)input->ray.origin.z - input->centre.z},
               .d = {input->ray.direction.x, input->ray.direction.y, input->ray.direction.z},
               .r = input->radius};
    e.t_middle = -quad_dot(e.f, e.d) / quad_dot(e.d, e.d);
    Quad l[3];
    Quad reach = 0;
    for (int i = 0; i < 3; i++) {
        l[i] = e.f[i] + e.t_middle * e.d[i];
        reach += quad_abs(l[i]) * (quad_abs(e.f[i]) + quad_abs(e.t_middle * e.d[i]));
    }
    e.discriminant = e.r * e.r - quad_dot(l, l);
    e.c = quad_dot(e.f, e.f) - e.r * e.r;
    e.uncertainty_d = 2 * U * (e.r * e.r + reach);
    e.uncertainty_c = 2 * U * (e.r * e.r + quad_dot(e.f, e.f));
    if (e.discriminant < 0 || (e.c >= 0 && e.t_middle <= 0)) {
        e.class = CLASS_MISS;
    } else {
        e.class = e.c > 0 ? CLASS_NEAR : CLASS_FAR;
    }
    return e;
}

// True when rounding does not excuse a wrong class.
static bool is_certain(const Exact *e)
{
    return quad_abs(e->discriminant) > e->uncertainty_d && quad_abs(e->c) > e->uncertainty_c;
}

// | |P|² - r² | / ( 2 ( r² + Σ|P_i|(|f_i| + |t d_i|) ) ) in units of u
static double backward_error(const Exact *e, double t)
{
    Quad p[3];
    Quad scale = e->r * e->r;
    for (int i = 0; i < 3; i++) {
        p[i] = e->f[i] + t * e->d[i];
        scale += quad_abs(p[i]) * (quad_abs(e->f[i]) + quad_abs(t * e->d[i]));
    }
    return (double)(quad_abs(quad_dot(p, p) - e->r * e->r) / (2 * scale)) / U;
}

static Class computed_class(const Case *input, double *t)
{
    SphereRay ray = sphere_ray_make(input->ray.origin, input->ray.direction);
    Ball ball = ball_make(input->centre, input->radius);
    SphereRoots roots;
    if (!sphere_solve(&ray, &ball, &roots)) {
        return CLASS_MISS;
    }
    *t = sphere_root(&ray, &roots);
    return !(*t > 0.0 && *t < (double)INFINITY) ? CLASS_MISS : roots.c > 0.0 ? CLASS_NEAR : CLASS_FAR;
}

typedef struct Family {
    const char *name;
    double distance; // of the origin from the centre, in radii
    double impact_low, impact_high; // distance of the ray from the centre, in radii
    double radius, offset; // offset: greatest coordinate of the centre
} Family;

// A sphere, an origin at the distance, and a ray that passes the centre at the impact parameter.
static Case family_case(const Family *family, Random *random)
{
    Vec3 span = vec3_scale(family->offset, random_direction(random));
    double radius = family->radius * random_between(random, 0.5, 2.0);
    Vec3 outward = random_direction(random);
    Vec3 origin = vec3_add_scaled(span, radius * family->distance * random_between(random, 1.0, 1.5), outward);
    if (family->distance <= 1.0) {
        origin = vec3_add_scaled(span, radius * family->distance, outward);
    }
    double impact = radius * random_between(random, family->impact_low, family->impact_high);
    Vec3 target = vec3_add_scaled(span, impact, random_perpendicular(random, outward));
    Vec3 direction = vec3_normalize(vec3_sub(target, origin));
    if (family->distance < 1.0 || random_bits(random) % 8 == 0) {
        direction = random_direction(random); // from inside any way out; else mostly misses and spheres behind
    }
    return (Case){{origin, direction}, span, radius};
}

static void test_family(const Family *family, uint64_t seed)
{
    Random random = {seed};
    double worst = 0.0;
    int wrong = 0;
    int inexcusable = 0;
    int hits = 0;
    for (int i = 0; i < CASES; i++) {
        Case input = family_case(family, &random);
        Exact exact = exact_solve(&input);
        double t = 0.0;
        Class class = computed_class(&input, &t);
        if (class != exact.class) {
            wrong++;
            inexcusable += is_certain(&exact);
        }
        if (class != CLASS_MISS) {
            hits++;
            worst = fmax(worst, backward_error(&exact, t));
        }
    }
    tap_ok(inexcusable == 0 && worst <= 4.0 && hits > CASES / 20,
           "%s: backward error %.2f u <= 4 u, %d inexcusable classes (%d wrong of %d hits)", family->name, worst,
           inexcusable, wrong, hits);
}

static void test_families(void)
{
    static const Family families[] = {
        {"ordinary", 5.0, 0.0, 1.5, 1.0, 10.0},
        {"distance 1e3 radii", 1e3, 0.0, 1.5, 1.0, 0.0},
        {"distance 1e6 radii", 1e6, 0.0, 1.5, 1.0, 0.0},
        {"distance 1e12 radii", 1e12, 0.0, 1.5, 1.0, 0.0},
        {"planet, height 1e-3 radii", 1.0 + 1e-3, 0.0, 1.0, 1e3, 1e3},
        {"planet, height 1e-6 radii", 1.0 + 1e-6, 0.0, 1.0, 1e6, 1e6},
        {"grazing 1 - 1e-4", 5.0, 1.0 - 1e-4, 1.0, 1.0, 10.0},
        {"grazing 1 - 1e-8", 5.0, 1.0 - 1e-8, 1.0, 1.0, 10.0},
        {"grazing 1 - 1e-14", 5.0, 1.0 - 1e-14, 1.0, 1.0, 10.0},
        {"leaving a surface", 1.0, 0.0, 1.0, 1.0, 10.0},
        {"inside", 0.7, 0.0, 1.0, 1.0, 10.0},
        {"offset 1e6", 5.0, 0.0, 1.5, 1.0, 1e6},
        {"tiny, 1e-100", 5.0, 0.0, 1.5, 1e-100, 1e-99},
        {"huge, 1e100", 5.0, 0.0, 1.5, 1e100, 1e101},
    };
    for (size_t i = 0; i < RT_COUNT_OF(families); i++) {
        test_family(&families[i], 1000 + i);
    }
}

// The direction's length must not matter, since ellipsoids are tested in their own space.
static void test_direction_length(void)
{
    static const Family family = {"", 5.0, 0.0, 1.5, 1.0, 10.0};
    Random random = {77};
    double worst = 0.0;
    int inexcusable = 0;
    for (int i = 0; i < CASES; i++) {
        Case input = family_case(&family, &random);
        input.ray.direction = vec3_scale(exp(random_between(&random, -50, 50)), input.ray.direction);
        Exact exact = exact_solve(&input);
        double t = 0.0;
        Class class = computed_class(&input, &t);
        inexcusable += class != exact.class && is_certain(&exact);
        worst = class == CLASS_MISS ? worst : fmax(worst, backward_error(&exact, t));
    }
    tap_ok(inexcusable == 0 && worst <= 4.0, "directions of any length: backward error %.2f u, %d inexcusable", worst,
           inexcusable);
}

static void test_exact_cases(void)
{
    static const struct {
        const char *name;
        Case input;
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
        Case input = {{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}}, {v[6], v[7], v[8]}, v[9]};
        double t;
        bool all_finite = vec3_is_finite(input.ray.origin) && vec3_is_finite(input.ray.direction) &&
                          vec3_is_finite(input.centre) && isfinite(input.radius);
        bool nothing_there = !all_finite || !(input.radius > 0.0) || vec3_max_abs(input.ray.direction) == 0.0;
        false_hits += nothing_there && computed_class(&input, &t) != CLASS_MISS;
    }
    tap_ok(false_hits == 0, "NaN, infinity, zero direction and zero radius meet nothing (%d did)", false_hits);
}

int main(void)
{
    test_exact_cases();
    test_not_numbers();
    test_direction_length();
    test_families();
    return tap_done();
}
