// The ray against the sphere in double-word arithmetic, for what doubles cannot decide.
//
// Discriminant |d|² r² - |f × d|² and c = |f|² - r² from the exact f, so that their errors are some u² of their terms;
// everything is scaled by powers of two first, so no finite input leaves the range.
//
// SPDX-License-Identifier: MIT
#include "trace/sphere.h"

// a b - c d
static DoubleWord cross_term(DoubleWord a, double b, DoubleWord c, double d)
{
    return double_word_sub(double_word_scale(a, b), double_word_scale(c, d));
}

static DoubleWord sum_of_squares(const DoubleWord v[3])
{
    DoubleWord sum = double_word_mul(v[0], v[0]);
    sum = double_word_add(sum, double_word_mul(v[1], v[1]));
    return double_word_add(sum, double_word_mul(v[2], v[2]));
}

static int exponent_of(double x)
{
    return x > 0.0 ? ilogb(x) : 0;
}

// Ray and sphere about the centre, lengths over 2^length_exponent and directions over 2^direction_exponent.
typedef struct ScaledCase {
    DoubleWord f[3];
    double d[3], radius;
    int length_exponent, direction_exponent;
} ScaledCase;

static bool case_init(ScaledCase *out, const SphereRay *ray, const SphereData *ball)
{
    const double o[3] = {ray->origin.x, ray->origin.y, ray->origin.z};
    const double d[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
    const double centre[3] = {ball->centre.x, ball->centre.y, ball->centre.z};
    double radius = sqrt(ball->radius_squared);
    double length = radius;
    for (int i = 0; i < 3; i++) {
        out->f[i] = two_sum(o[i], -centre[i]);
        length = fmax(length, fabs(out->f[i].hi));
    }
    double greatest = vec3_max_abs(ray->direction);
    if (!(length < (double)INFINITY && greatest > 0.0 && greatest < (double)INFINITY && radius > 0.0)) {
        return false;
    }
    out->length_exponent = exponent_of(length);
    out->direction_exponent = exponent_of(greatest);
    for (int i = 0; i < 3; i++) {
        out->f[i].hi = ldexp(out->f[i].hi, -out->length_exponent);
        out->f[i].lo = ldexp(out->f[i].lo, -out->length_exponent);
        out->d[i] = ldexp(d[i], -out->direction_exponent);
    }
    out->radius = ldexp(radius, -out->length_exponent);
    return vec3_is_finite(ray->origin) && vec3_is_finite(ray->direction) && vec3_is_finite(ball->centre);
}

// r'² - r², r' being the radius of a sphere that has the same centre and that the ray starts on: |f|² - r² without what
// rounding did to the origin.
static DoubleWord concentric_c(const ScaledCase *s, const SphereData *start)
{
    double radius = ldexp(sqrt(start->radius_squared), -s->length_exponent);
    return double_word_mul(two_sum(radius, -s->radius), two_sum(radius, s->radius));
}

double sphere_exact(const SphereRay *ray, const SphereData *ball, const SphereData *start, bool *inside)
{
    ScaledCase s;
    *inside = false;
    if (!case_init(&s, ray, ball)) {
        return 0.0;
    }
    bool is_concentric = start && start->radius_squared > 0.0 && vec3_equal(start->centre, ball->centre);
    DoubleWord cross[3];
    DoubleWord b = {0.0, 0.0}; // -f·d
    DoubleWord a = {0.0, 0.0}; // d·d
    for (int i = 0; i < 3; i++) {
        int next = (i + 1) % 3;
        cross[i] = cross_term(s.f[i], s.d[next], s.f[next], s.d[i]);
        b = double_word_sub(b, double_word_scale(s.f[i], s.d[i]));
        a = double_word_add(a, two_product(s.d[i], s.d[i]));
    }
    DoubleWord r_squared = two_product(s.radius, s.radius);
    DoubleWord aside = sum_of_squares(cross), along = double_word_mul(b, b);
    DoubleWord discriminant = double_word_sub(double_word_mul(a, r_squared), aside);
    DoubleWord c = double_word_sub(sum_of_squares(s.f), r_squared);
    if (is_concentric) {
        // What rounding did to the origin is a share of both squares: the smaller one says more.
        c = concentric_c(&s, start);
        discriminant = along.hi < aside.hi ? double_word_sub(along, double_word_mul(a, c)) : discriminant;
    }
    if (discriminant.hi < 0.0 || (c.hi >= 0.0 && !(b.hi > 0.0))) {
        return 0.0;
    }
    *inside = !(c.hi > 0.0);
    DoubleWord size = b.hi < 0.0 ? double_word_neg(b) : b;
    DoubleWord far_side = double_word_add(size, double_word_sqrt(discriminant));
    bool over_sum = c.hi > 0.0 || b.hi < 0.0;
    double t = over_sum ? double_word_quotient(c.hi < 0.0 ? double_word_neg(c) : c, far_side)
                        : double_word_quotient(far_side, a);
    t = ldexp(t, s.length_exponent - s.direction_exponent);
    return t < (double)INFINITY ? t : 0.0;
}

// What is to be added to t, about a root, to come to the root: Newton's step, with the residual in double words.
static double root_correction(const SphereRay *ray, const SphereData *ball, double t)
{
    const double o[3] = {ray->origin.x, ray->origin.y, ray->origin.z};
    const double d[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
    const double centre[3] = {ball->centre.x, ball->centre.y, ball->centre.z};
    double radius = sqrt(ball->radius_squared), slope = 0.0;
    DoubleWord p[3];
    for (int i = 0; i < 3; i++) {
        p[i] = double_word_add(two_sum(o[i], -centre[i]), two_product(t, d[i]));
        slope += p[i].hi * d[i];
    }
    return -0.5 * double_word_sub(sum_of_squares(p), two_product(radius, radius)).hi / slope;
}

int sphere_roots_compare(const SphereRay *ray, const SphereData *a, bool a_inside, const SphereData *b, bool b_inside,
                         double t)
{
    if (!vec3_equal(a->centre, b->centre)) {
        double after_a = root_correction(ray, a, t), after_b = root_correction(ray, b, t);
        return (after_a > after_b) - (after_a < after_b);
    }
    if (a_inside != b_inside) {
        return a_inside - b_inside;
    }
    int is_greater = (a->radius_squared > b->radius_squared) - (a->radius_squared < b->radius_squared);
    return a_inside ? is_greater : -is_greater;
}

Vec3 sphere_exact_offset(Ray ray, const SphereData *ball, double t)
{
    const double o[3] = {ray.origin.x, ray.origin.y, ray.origin.z};
    const double d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    const double centre[3] = {ball->centre.x, ball->centre.y, ball->centre.z};
    double offset[3];
    for (int i = 0; i < 3; i++) {
        offset[i] = double_word_add(two_sum(o[i], -centre[i]), two_product(t, d[i])).hi;
    }
    return vec3(offset[0], offset[1], offset[2]);
}
