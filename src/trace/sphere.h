// A ray against one sphere: does it meet it, from which side, and where.
//
// The class (miss, near root, far root) comes from the distance between ray and centre, not from b² - ac: the
// discriminant is r² - |l|², l being the remainder of f = origin - centre after its part along the ray is taken away
// (Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, ch. 7), and
// the roots are sums of terms of one sign. sphere_test adds a filter with a proven bound: what rounding could decide
// wrongly goes to double-word arithmetic (trace/sphere_exact.c), so no class is wrong; sphere_refine makes the root of
// an accepted hit right to an ulp. docs/numerics.md has the derivations.
//
// Knows one sphere and one ray; nothing of scenes, materials or trees.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERE_H
#define TRACE_SPHERE_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/attributes.h"
#include "math/ray.h"
#include "math/vec3.h"
#include "trace/double_word.h"

// A sphere as the test wants it. sqrt(radius_squared) is the radius again, bit for bit.
typedef struct SphereData {
    Vec3 centre;
    double radius_squared; // NaN for a sphere that nothing can meet
} SphereData;

// A ray with what depends on it alone. A direction that is zero, infinite or NaN makes `direction_over_length2` NaN,
// and every test with it a miss.
typedef struct SphereRay {
    Vec3 origin, direction;
    Vec3 direction_over_length2; // direction / |direction|², so that f·direction_over_length2 is a parameter of the ray
    double inverse_square; // 1 / |direction|²
} SphereRay;

#define UNIT_SPHERE ((SphereData){{0.0, 0.0, 0.0}, 1.0})

// A radius that is not positive, or outside 2^-480..2^511, gives a sphere that is never met. Below, the squares would
// underflow where the filter's bound does not say so; prepared scenes are scaled to the middle of that range.
RT_ALWAYS_INLINE SphereData sphere_data_make(Vec3 centre, double radius)
{
    double square = radius * radius;
    return (SphereData){centre, radius > 0.0 && square >= 0x1p-960 && square < 0x1p1022 ? square : (double)NAN};
}

RT_ALWAYS_INLINE bool sphere_data_is_usable(const SphereData *ball)
{
    return vec3_is_finite(ball->centre) && !isnan(ball->radius_squared);
}

RT_ALWAYS_INLINE bool sphere_data_equal(const SphereData *a, const SphereData *b)
{
    return a->radius_squared == b->radius_squared && vec3_equal(a->centre, b->centre);
}

RT_ALWAYS_INLINE SphereRay sphere_ray_of(Vec3 origin, Vec3 direction, double inverse_square)
{
    return (SphereRay){origin, direction, vec3_scale(inverse_square, direction), inverse_square};
}

RT_ALWAYS_INLINE SphereRay sphere_ray_make(Vec3 origin, Vec3 direction)
{
    return sphere_ray_of(origin, direction, 1.0 / vec3_length_squared(direction));
}

// True for a ray that can meet anything at all.
RT_ALWAYS_INLINE bool sphere_ray_is_usable(const SphereRay *ray)
{
    return ray->inverse_square > 0x1p-100 && ray->inverse_square < (double)INFINITY;
}

// What rounding can do to r² - |l|² and to |f|² - r² is below SPHERE_ROUNDING (|f|² + r²). Where they are beyond
// SPHERE_UNCERTAINTY (|f|² + r²) = 2^14 times that, they also have 14 bits, and the root has 13.
#define SPHERE_ROUNDING 0x1p-49
#define SPHERE_UNCERTAINTY 0x1p-35

// Two roots that differ by more than this share of the greater are in the right order before they are refined.
#define SPHERE_ROOT_SLACK 0x1p-11

typedef enum SphereVerdict {
    SPHERE_MISS,
    SPHERE_MET,      // with a root that has 13 bits
    SPHERE_UNCERTAIN // ask sphere_exact
} SphereVerdict;

// Decides class and root in doubles alone (src/trace/spheres_kernel.c does the same to eight spheres at once), or says
// that it cannot. `t` > 0 and `inside` are set when the sphere is met.
RT_ALWAYS_INLINE SphereVerdict sphere_test(const SphereRay *ray, const SphereData *ball, double *t, bool *inside)
{
    Vec3 f = vec3_sub(ray->origin, ball->centre);
    double t_middle = -vec3_dot(f, ray->direction_over_length2);
    Vec3 l = vec3_add_scaled(f, t_middle, ray->direction);
    double discriminant = ball->radius_squared - vec3_length_squared(l);
    double f_squared = vec3_length_squared(f);
    double sum = f_squared + ball->radius_squared;
    if (!(discriminant >= -SPHERE_ROUNDING * sum)) {
        return SPHERE_MISS;
    }
    double c = f_squared - ball->radius_squared;
    double uncertainty = SPHERE_UNCERTAINTY * sum;
    if (c >= uncertainty && !(t_middle >= 0.0)) {
        return SPHERE_MISS;
    }
    if (!(discriminant >= uncertainty && fabs(c) >= uncertainty)) {
        return SPHERE_UNCERTAIN;
    }
    double far_side = fabs(t_middle) + sqrt(discriminant * ray->inverse_square);
    *inside = c < 0.0;
    *t = c > 0.0 || t_middle < 0.0 ? fabs(c) * ray->inverse_square / far_side : far_side;
    return SPHERE_MET;
}

// The same in double-word arithmetic, for any finite numbers: the nearest positive root, off by less than an ulp, and
// from which side; 0 for a miss. `start`: what the ray starts on, NULL or with a radius of NaN if that is no sphere; of
// one with the same centre the radii alone decide which of the two is inside of the other.
double sphere_exact(const SphereRay *ray, const SphereData *ball, const SphereData *start, bool *inside)
    __attribute__((cold));

// Which of two spheres is met first, where both roots are within some ulps of t: below 0 when that is a. Roots that
// differ by u² of the distances are distinguished; spheres of one centre by their radii, however far their roots are
// apart.
int sphere_roots_compare(const SphereRay *ray, const SphereData *a, bool a_inside, const SphereData *b, bool b_inside,
                         double t) __attribute__((cold));

// One Newton step from a root of sphere_test, with the residual |f + t d|² - r² in double-word arithmetic. What the
// step leaves is e² / (distance of the two roots), and the residual is known to 12 u² (|f|² + r²): the two checks make
// both less than a quarter of an ulp. When they do not hold, the whole is done in double words.
RT_ALWAYS_INLINE double sphere_refine(const SphereRay *ray, const SphereData *ball, double t)
{
    const double o[3] = {ray->origin.x, ray->origin.y, ray->origin.z};
    const double d[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
    const double centre[3] = {ball->centre.x, ball->centre.y, ball->centre.z};
    double f_squared = 0.0;
    double slope = 0.0;
    double low = 0.0;
    DoubleWord square[3];
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        DoubleWord f = two_sum(o[i], -centre[i]);
        DoubleWord along = two_product(t, d[i]);
        DoubleWord p = two_sum(f.hi, along.hi);
        square[i] = two_product(p.hi, p.hi);
        low += square[i].lo + 2.0 * p.hi * (p.lo + (f.lo + along.lo));
        slope += p.hi * d[i];
        f_squared += f.hi * f.hi;
    }
    double radius = sqrt(ball->radius_squared);
    DoubleWord r = two_product(radius, radius);
    DoubleWord xy = two_sum(square[0].hi, square[1].hi);
    DoubleWord xyz = two_sum(xy.hi, square[2].hi);
    DoubleWord all = two_sum(xyz.hi, -r.hi);
    double residual = all.hi + (all.lo + (xyz.lo + (xy.lo + (low - r.lo))));
    double step = residual / (2.0 * slope);
    double reach = 2.0 * t * fabs(slope);
    double sum = f_squared + ball->radius_squared;
    bool is_certain = sum < 0x1p900 && sum > 0x1p-900 && 0x1p-46 * sum <= reach &&
                      step * step * 0x1p56 <= reach * ray->inverse_square;
    bool inside;
    return RT_LIKELY(is_certain) ? t - step : sphere_exact(ray, ball, NULL, &inside);
}

// The nearest positive root, as right as it gets; 0 for a miss. What the queries below agree with, bit for bit.
RT_ALWAYS_INLINE double sphere_hit(const SphereRay *ray, const SphereData *ball, bool *inside)
{
    double t;
    switch (sphere_test(ray, ball, &t, inside)) {
    case SPHERE_MISS: return 0.0;
    case SPHERE_MET: return sphere_refine(ray, ball, t);
    default: return sphere_exact(ray, ball, NULL, inside);
    }
}

// Where a ray that starts on the sphere and goes in meets it again: with c = 0 the other root is -2 (f·d) / (d·d),
// whose relative error is at most (3/|cos| + 3) u. Not positive when the ray does not go in.
RT_ALWAYS_INLINE double sphere_root_inward(const SphereRay *ray, const SphereData *ball)
{
    return -2.0 * vec3_dot(vec3_sub(ray->origin, ball->centre), ray->direction_over_length2);
}

// p(t) - centre in double words, for spheres so far away that nothing of it is left in doubles.
Vec3 sphere_exact_offset(Ray ray, const SphereData *ball, double t) __attribute__((cold));

// The outward unit normal at p(t), t being refined.
RT_ALWAYS_INLINE Vec3 sphere_normal(Ray ray, const SphereData *ball, double t)
{
    Vec3 offset = vec3_add_scaled(vec3_sub(ray.origin, ball->centre), t, ray.direction);
    double error = fabs(vec3_length_squared(offset) - ball->radius_squared);
    if (RT_UNLIKELY(!(error <= 0x1p-20 * ball->radius_squared))) {
        offset = sphere_exact_offset(ray, ball, t);
    }
    return vec3_normalize(offset);
}

// p(t) put back onto the sphere, t being refined, `normal` that of sphere_normal and the direction of about unit
// length: of origin + t d, off by u t, and centre + r n, off the sphere by u r, the one that is off by less.
// docs/numerics.md has more.
RT_ALWAYS_INLINE Vec3 sphere_point(Ray ray, const SphereData *ball, double t, Vec3 normal)
{
    double radius = sqrt(ball->radius_squared);
    return t < radius ? vec3_add_scaled(ray.origin, t, ray.direction) : vec3_add_scaled(ball->centre, radius, normal);
}

#endif
