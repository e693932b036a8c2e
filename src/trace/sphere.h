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
// What is the same for some rays and spheres at once stands in trace/sphere.inc.
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

#include "math/lane_double.h"
#include "trace/sphere.inc"

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

// Decides class and root in doubles alone (src/trace/spheres_kernel.c does the same to some at once), or says that it
// cannot. `t` > 0 and `inside` are set when the sphere is met.
RT_ALWAYS_INLINE SphereVerdict sphere_test(const SphereRay *ray, const SphereData *ball, double *t, bool *inside)
{
    Vec3 f = vec3_sub(ray->origin, ball->centre);
    double t_middle, discriminant = sphere_discriminant(ray, f, ball->radius_squared, &t_middle);
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
    *inside = c < 0.0;
    *t = sphere_root(t_middle, discriminant, c, ray->inverse_square);
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

// A root of sphere_test made right to an ulp.
RT_ALWAYS_INLINE double sphere_refine(const SphereRay *ray, const SphereData *ball, double t)
{
    bool inside, is_certain = sphere_step(ray, ball, &t);
    return RT_LIKELY(is_certain) ? t : sphere_exact(ray, ball, NULL, &inside);
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

// p(t) - centre in double words, for spheres so far away that nothing of it is left in doubles.
Vec3 sphere_exact_offset(Ray ray, const SphereData *ball, double t) __attribute__((cold));

// The outward unit normal at p(t), t being refined.
RT_ALWAYS_INLINE Vec3 sphere_normal(Ray ray, const SphereData *ball, double t)
{
    Vec3 offset = sphere_offset(&ray, ball, t);
    if (RT_UNLIKELY(!sphere_offset_is_right(ball, offset))) {
        offset = sphere_exact_offset(ray, ball, t);
    }
    return vec3_normalize(offset);
}

#endif
