// The quadratic in exact arithmetic, by MPFR or by pairs of __float128.
//
// Møller, Knuth; Dekker; Joldes, Muller, Popescu, as in trace/double_word.h, one floor higher.
//
// SPDX-License-Identifier: MIT
#include "study/oracle.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "study/optional.h"

#ifdef WITH_MPFR
#include <mpfr.h>

typedef mpfr_t Number;

static void number_init(Number x)
{
    mpfr_init2(x, 1100);
}

static void number_fini(Number x)
{
    mpfr_clear(x);
}

static void number_set(Number out, double x)
{
    mpfr_set_d(out, x, MPFR_RNDN);
}

static void number_add(Number out, Number a, Number b)
{
    mpfr_add(out, a, b, MPFR_RNDN);
}

static void number_sub(Number out, Number a, Number b)
{
    mpfr_sub(out, a, b, MPFR_RNDN);
}

static void number_mul(Number out, Number a, Number b)
{
    mpfr_mul(out, a, b, MPFR_RNDN);
}

static void number_div(Number out, Number a, Number b)
{
    mpfr_div(out, a, b, MPFR_RNDN);
}

static void number_sqrt(Number out, Number a)
{
    mpfr_sqrt(out, a, MPFR_RNDN);
}

static int number_sign(Number a)
{
    return mpfr_sgn(a);
}

static double number_get(Number a)
{
    return mpfr_get_d(a, MPFR_RNDN);
}

const char *oracle_name(void)
{
    return "MPFR at 1100 bits";
}

static void numbers_forget(void)
{
    mpfr_free_cache();
}

#else
#include "math/quad.h"

typedef struct Pair {
    Quad hi, lo;
} Pair;
typedef Pair Number[1];

static Pair pair_sum(Quad a, Quad b)
{
    Quad sum = a + b, b_part = sum - a, a_part = sum - b_part;
    return (Pair){sum, (a - a_part) + (b - b_part)};
}

static Quad quad_upper(Quad a)
{
    Quad scaled = ((Quad)0x1p57 + 1) * a;
    return scaled - (scaled - a);
}

static Pair pair_product(Quad a, Quad b)
{
    Quad product = a * b, x = quad_upper(a), y = quad_upper(b), v = a - x, w = b - y;
    return (Pair){product, ((x * y - product) + x * w + v * y) + v * w};
}

static void number_init(Number x)
{
    x[0] = (Pair){0, 0};
}

static void number_fini(Number x)
{
    (void)x;
}

static void number_set(Number out, double x)
{
    out[0] = (Pair){(Quad)x, 0};
}

static void number_add(Number out, Number a, Number b)
{
    Pair high = pair_sum(a[0].hi, b[0].hi), low = pair_sum(a[0].lo, b[0].lo);
    Pair sum = pair_sum(high.hi, high.lo + low.hi);
    out[0] = pair_sum(sum.hi, low.lo + sum.lo);
}

static void number_sub(Number out, Number a, Number b)
{
    Number negative = {{-b[0].hi, -b[0].lo}};
    number_add(out, a, negative);
}

static void number_mul(Number out, Number a, Number b)
{
    Pair high = pair_product(a[0].hi, b[0].hi);
    out[0] = pair_sum(high.hi, high.lo + (a[0].hi * b[0].lo + a[0].lo * b[0].hi));
}

// One step of Newton's from the upper part.
static void number_div(Number out, Number a, Number b)
{
    Quad first = a[0].hi / b[0].hi;
    Number guess = {{first, 0}}, rest;
    number_mul(rest, guess, b);
    number_sub(rest, a, rest);
    out[0] = pair_sum(first, rest[0].hi / b[0].hi);
}

static void number_sqrt(Number out, Number a)
{
    Quad first = quad_sqrt(a[0].hi);
    Number guess = {{first, 0}}, rest;
    number_mul(rest, guess, guess);
    number_sub(rest, a, rest);
    out[0] = first > 0 ? pair_sum(first, rest[0].hi / (2 * first)) : (Pair){0, 0};
}

static int number_sign(Number a)
{
    return (a[0].hi > 0) - (a[0].hi < 0);
}

static double number_get(Number a)
{
    return (double)a[0].hi;
}

const char *oracle_name(void)
{
    return "pairs of __float128, 226 bits, for want of MPFR";
}

static void numbers_forget(void)
{
}
#endif

// f = origin - centre, and the coefficients of a t² - 2 b t + c = 0.
struct Oracle {
    Number f[3], cross[3], d[3];
    Number r_squared, a, b, c, discriminant, root, one, two, given, sum; // the last four are scratch
};

static void each(Oracle *o, void (*act)(Number))
{
    for (int i = 0; i < 3; i++) {
        act(o->f[i]);
        act(o->cross[i]);
        act(o->d[i]);
    }
    act(o->r_squared);
    act(o->a);
    act(o->b);
    act(o->c);
    act(o->discriminant);
    act(o->root);
    act(o->one);
    act(o->two);
    act(o->given);
    act(o->sum);
}

Oracle *oracle_new(void)
{
    Oracle *oracle = malloc(sizeof *oracle);
    if (oracle) {
        each(oracle, number_init);
    }
    return oracle;
}

void oracle_free(Oracle *oracle)
{
    if (oracle) {
        each(oracle, number_fini);
        numbers_forget();
        free(oracle);
    }
}

static void sum_products(Oracle *o, Number sum, Number x[3], Number y[3])
{
    number_mul(sum, x[0], y[0]);
    for (int i = 1; i < 3; i++) {
        number_mul(o->one, x[i], y[i]);
        number_add(sum, sum, o->one);
    }
}

static void set_case(Oracle *o, const SphereCase *input)
{
    const double e[3] = {input->ray.origin.x, input->ray.origin.y, input->ray.origin.z};
    const double d[3] = {input->ray.direction.x, input->ray.direction.y, input->ray.direction.z};
    const double centre[3] = {input->centre.x, input->centre.y, input->centre.z};
    for (int i = 0; i < 3; i++) {
        number_set(o->f[i], e[i]);
        number_set(o->one, centre[i]);
        number_sub(o->f[i], o->f[i], o->one);
        number_set(o->d[i], d[i]);
    }
    for (int i = 0; i < 3; i++) {
        int next = (i + 1) % 3;
        number_mul(o->cross[i], o->f[i], o->d[next]);
        number_mul(o->one, o->f[next], o->d[i]);
        number_sub(o->cross[i], o->cross[i], o->one);
    }
    number_set(o->one, input->radius);
    number_mul(o->r_squared, o->one, o->one);
    sum_products(o, o->a, o->d, o->d);
    sum_products(o, o->b, o->f, o->d);
    number_set(o->two, 0.0);
    number_sub(o->b, o->two, o->b);
    sum_products(o, o->c, o->f, o->f);
    number_sub(o->c, o->c, o->r_squared);
    sum_products(o, o->two, o->cross, o->cross);
    number_mul(o->discriminant, o->a, o->r_squared);
    number_sub(o->discriminant, o->discriminant, o->two);
}

// |r² - l·l| < 2u (r² + Σ|l_i|(|f_i| + |t_m d_i|)), or |c| < 2u (r² + Σ f_i²).
static bool is_excusable(Oracle *o)
{
    const double u = DBL_EPSILON / 2;
    double a = number_get(o->a), middle = number_get(o->b) / a, r_squared = number_get(o->r_squared);
    double first = r_squared, second = r_squared;
    for (int i = 0; i < 3; i++) {
        double f = number_get(o->f[i]), along = middle * number_get(o->d[i]);
        first += fabs(f + along) * (fabs(f) + fabs(along));
        second += f * f;
    }
    return fabs(number_get(o->discriminant) / a) < 2.0 * u * first || fabs(number_get(o->c)) < 2.0 * u * second;
}

SphereClass oracle_solve(Oracle *o, const SphereCase *input, bool *excusable)
{
    set_case(o, input);
    *excusable = is_excusable(o);
    int c_sign = number_sign(o->c);
    if (number_sign(o->discriminant) < 0 || (c_sign >= 0 && number_sign(o->b) <= 0)) {
        return CLASS_MISS;
    }
    number_sqrt(o->root, o->discriminant);
    if (c_sign > 0) {
        number_sub(o->root, o->b, o->root);
    } else {
        number_add(o->root, o->b, o->root);
    }
    number_div(o->root, o->root, o->a);
    return c_sign > 0 ? CLASS_NEAR : CLASS_FAR;
}

double oracle_ulps(Oracle *o, double t)
{
    number_set(o->given, t);
    number_sub(o->one, o->root, o->given);
    return fabs(number_get(o->one)) / (nextafter(fabs(t), (double)INFINITY) - fabs(t));
}

double oracle_backward(Oracle *o, const SphereCase *input, double t)
{
    double scale = input->radius * input->radius;
    number_set(o->given, t);
    number_set(o->sum, 0.0);
    number_sub(o->sum, o->sum, o->r_squared);
    for (int i = 0; i < 3; i++) {
        double f = number_get(o->f[i]), along = t * number_get(o->d[i]);
        number_mul(o->one, o->d[i], o->given);
        number_add(o->one, o->one, o->f[i]);
        scale += fabs(number_get(o->one)) * (fabs(f) + fabs(along));
        number_mul(o->two, o->one, o->one);
        number_add(o->sum, o->sum, o->two);
    }
    return fabs(number_get(o->sum)) / (2.0 * scale) / (DBL_EPSILON / 2);
}
