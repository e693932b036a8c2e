// A ray against one sphere: does it meet it, from which side, and where.
//
// The class (miss, near root, far root) comes from the distance between ray and centre, not from b² - ac: the
// discriminant is r² - |l|², l being the remainder of f = origin - centre after its part along the ray is taken away
// (Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, ch. 7), and
// the roots are sums of terms of one sign. Backward error <= 4 u (tests/unit/test_trace_sphere.c). Two steps, so that a
// certified filter can stand between them: sphere_solve decides, sphere_root says where.
//
// Knows one sphere and one ray; nothing of scenes, materials or trees.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERE_H
#define TRACE_SPHERE_H

#include <math.h>
#include <stdbool.h>

#include "base/attributes.h"
#include "math/ray.h"
#include "math/vec3.h"

// A sphere as the test wants it. sqrt(radius_squared) is the radius again, bit for bit.
typedef struct Ball {
    Vec3 centre;
    double radius_squared; // NaN for a sphere that nothing can meet
} Ball;

// A ray with what depends on it alone. A direction that is zero, infinite or NaN makes `dual` NaN, and every test with
// it a miss.
typedef struct SphereRay {
    Vec3 origin, direction;
    Vec3 dual;             // direction / |direction|², so that f·dual is a parameter of the ray
    double inverse_square; // 1 / |direction|²
} SphereRay;

// The two roots are t_middle ± sqrt(half_squared); their product is c / |direction|².
typedef struct SphereRoots {
    double t_middle;     // where the ray is nearest to the centre
    double half_squared; // >= 0; 0 when the ray touches the sphere
    double c;            // |f|² - r²; the ray starts inside when it is negative
} SphereRoots;

// A radius that is not positive, or whose square is not a positive number, gives a sphere that is never met.
RT_ALWAYS_INLINE Ball ball_make(Vec3 centre, double radius)
{
    double square = radius * radius;
    return (Ball){centre, radius > 0.0 && square > 0.0 && square < (double)INFINITY ? square : (double)NAN};
}

RT_ALWAYS_INLINE bool ball_is_usable(const Ball *ball)
{
    return vec3_is_finite(ball->centre) && !isnan(ball->radius_squared);
}

RT_ALWAYS_INLINE bool ball_equal(const Ball *a, const Ball *b)
{
    return a->radius_squared == b->radius_squared && vec3_equal(a->centre, b->centre);
}

RT_ALWAYS_INLINE SphereRay sphere_ray_make(Vec3 origin, Vec3 direction)
{
    double inverse_square = 1.0 / vec3_length_squared(direction);
    return (SphereRay){origin, direction, vec3_scale(inverse_square, direction), inverse_square};
}

// True for a ray that can meet anything at all.
RT_ALWAYS_INLINE bool sphere_ray_is_usable(const SphereRay *ray)
{
    return ray->inverse_square > 0.0 && ray->inverse_square < (double)INFINITY;
}

// Decides whether the ray meets the sphere at some t > 0. A ray that only touches does; one that starts exactly on
// the surface (c = 0) does when it goes in. Comparisons are written so that a NaN is a miss.
RT_ALWAYS_INLINE bool sphere_solve(const SphereRay *ray, const Ball *ball, SphereRoots *roots)
{
    Vec3 f = vec3_sub(ray->origin, ball->centre);
    double t_middle = -vec3_dot(f, ray->dual);
    Vec3 l = vec3_add_scaled(f, t_middle, ray->direction);
    double discriminant = ball->radius_squared - vec3_length_squared(l);
    if (!(discriminant >= 0.0)) {
        return false;
    }
    double c = vec3_length_squared(f) - ball->radius_squared;
    *roots = (SphereRoots){t_middle, discriminant * ray->inverse_square, c};
    return t_middle > 0.0 || c < 0.0;
}

// The nearest positive root; call only after sphere_solve said yes. 0, infinite or NaN when the numbers left the range
// of double, so the caller still compares it with its interval.
RT_ALWAYS_INLINE double sphere_root(const SphereRay *ray, const SphereRoots *roots)
{
    double half = sqrt(roots->half_squared);
    double far_side = fabs(roots->t_middle) + half;
    bool is_outer = roots->c > 0.0;
    if (is_outer || roots->t_middle < 0.0) {
        return fabs(roots->c) * ray->inverse_square / far_side;
    }
    return far_side;
}

// Where a ray that starts on the sphere and goes in meets it again: with c = 0 the other root is -2 (f·d) / (d·d),
// whose relative error is at most (3/|cos| + 3) u. Not positive when the ray does not go in.
RT_ALWAYS_INLINE double sphere_root_inward(const SphereRay *ray, const Ball *ball)
{
    return -2.0 * vec3_dot(vec3_sub(ray->origin, ball->centre), ray->dual);
}

// The outward unit normal at p(t).
RT_ALWAYS_INLINE Vec3 sphere_normal(Ray ray, const Ball *ball, double t)
{
    return vec3_normalize(vec3_add_scaled(vec3_sub(ray.origin, ball->centre), t, ray.direction));
}

#endif
