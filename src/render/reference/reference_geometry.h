// Numbers, vectors and colours of the reference path over a real type, and what a ray meets.
//
// Included once by each of reference_float.c, reference_double.c and reference_quad.c, of which two say what `Real` is
// and how its functions are called. Every shape is tested, by the formulas of docs/numerics.md without the filter: the
// discriminant from the remainder, roots without cancellation, self-hits by identity.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_REFERENCE_REFERENCE_GEOMETRY_H
#define RENDER_REFERENCE_REFERENCE_GEOMETRY_H

#include "render/records/prepared.h"

// Where nothing is said, as in reference_double.c, numbers are doubles.
#ifndef REAL_SQRT
#include <math.h>
typedef double Real;
#define REAL_SQRT sqrt
#define REAL_FABS fabs
#define REAL_POW  pow
#define REAL_ACOS acos
#define REAL_EXP  exp
#endif

typedef struct RealVec {
    Real x, y, z;
} RealVec;

typedef struct RealRgb {
    Real red, green, blue;
} RealRgb;

typedef struct RealRay {
    RealVec e, d;
} RealRay;

// Where a ray starts: SHAPE_NONE, or a shape of the scene by its order of declaration.
typedef struct RealStart {
    ShapeKind kind;
    uint32_t index;
    bool on_shape, inward;
} RealStart;

typedef struct RealHit {
    Real t;
    ShapeKind kind;
    uint32_t index, order;
    bool inside;
    RealVec point, normal; // outward
    MaterialIndex material;
} RealHit;

typedef struct RealScene {
    const Prepared *p;
    const Scene *scene;
    Real inverse_scale; // lengths of the scene times this are prepared ones
    MediumTable *media; // of what rays are inside of
} RealScene;

// ---- vectors and colours

static inline RealVec real_vec(Vec3 a)
{
    return (RealVec){(Real)a.x, (Real)a.y, (Real)a.z};
}

static inline RealVec real_add_scaled(RealVec a, Real s, RealVec b)
{
    return (RealVec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline RealVec real_scale(Real s, RealVec a)
{
    return (RealVec){s * a.x, s * a.y, s * a.z};
}

static inline RealVec real_sub(RealVec a, RealVec b)
{
    return (RealVec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline Real real_dot(RealVec a, RealVec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline Real real_length(RealVec a)
{
    return REAL_SQRT(real_dot(a, a));
}

static inline RealVec real_unit(RealVec a)
{
    return real_scale((Real)1 / real_length(a), a);
}

static inline RealVec real_linear(const double m[4][3], RealVec a)
{
    return (RealVec){(Real)m[0][0] * a.x + (Real)m[1][0] * a.y + (Real)m[2][0] * a.z,
                     (Real)m[0][1] * a.x + (Real)m[1][1] * a.y + (Real)m[2][1] * a.z,
                     (Real)m[0][2] * a.x + (Real)m[1][2] * a.y + (Real)m[2][2] * a.z};
}

static inline RealRgb real_rgb(Rgb a)
{
    return (RealRgb){(Real)a.red, (Real)a.green, (Real)a.blue};
}

static inline RealRgb real_grey(Real level)
{
    return (RealRgb){level, level, level};
}

static inline RealRgb real_rgb_add(RealRgb a, Real s, RealRgb b)
{
    return (RealRgb){a.red + s * b.red, a.green + s * b.green, a.blue + s * b.blue};
}

static inline RealRgb real_rgb_mul(RealRgb a, RealRgb b)
{
    return (RealRgb){a.red * b.red, a.green * b.green, a.blue * b.blue};
}

static inline RealRgb real_rgb_scale(Real s, RealRgb a)
{
    return (RealRgb){s * a.red, s * a.green, s * a.blue};
}

static inline Real real_max(Real a, Real b)
{
    return a > b ? a : b;
}

static inline Real real_rgb_max(RealRgb a)
{
    return real_max(a.red, real_max(a.green, a.blue));
}

static inline bool real_rgb_is_black(RealRgb a)
{
    return a.red == 0 && a.green == 0 && a.blue == 0;
}

static inline Real real_power(Real base, double exponent)
{
    if (!(exponent >= 0.0 && exponent <= 4096.0 && exponent == (double)(int)exponent)) {
        return REAL_POW(base, (Real)exponent);
    }
    Real result = 1;
    for (unsigned n = (unsigned)exponent; n; n >>= 1, base *= base) {
        if (n & 1) {
            result *= base;
        }
    }
    return result;
}

// ---- what a ray meets

// The nearest root in front of a ray, 0 when there is none. `f` is the origin as seen from the centre.
static Real real_ball_root(RealVec f, RealVec d, Real r_squared, bool *inside)
{
    Real d_squared = real_dot(d, d);
    Real middle = -real_dot(f, d) / d_squared;
    RealVec l = real_add_scaled(f, middle, d);
    Real discriminant = r_squared - real_dot(l, l);
    Real c = real_dot(f, f) - r_squared;
    if (!(discriminant >= 0) || (c >= 0 && !(middle > 0))) {
        return 0;
    }
    Real far_side = REAL_FABS(middle) + REAL_SQRT(discriminant / d_squared);
    *inside = !(c > 0);
    return c > 0 || middle < 0 ? REAL_FABS(c) / d_squared / far_side : far_side;
}

static Real real_ball_inward(RealVec f, RealVec d)
{
    return -2 * real_dot(f, d) / real_dot(d, d);
}

static RealVec real_sphere_offset(const RealScene *s, const Sphere *sphere, RealVec e)
{
    return real_sub(e, real_scale(s->inverse_scale, real_vec(sphere->centre)));
}

static bool real_starts_on(RealStart start, ShapeKind kind)
{
    return start.on_shape && start.kind == kind;
}

static Real real_sphere_root(const RealScene *s, uint32_t index, const RealRay *ray, RealStart start, bool *inside)
{
    const Sphere *sphere = &s->scene->spheres.items[index];
    const Sphere *left = &s->scene->spheres.items[start.index];
    Real radius = (Real)sphere->radius * s->inverse_scale;
    RealVec f = real_sphere_offset(s, sphere, ray->e);
    if (real_starts_on(start, SHAPE_SPHERE) && sphere->radius == left->radius &&
        vec3_equal(sphere->centre, left->centre)) {
        *inside = true;
        return start.inward ? real_ball_inward(f, ray->d) : 0;
    }
    return real_ball_root(f, ray->d, radius * radius, inside);
}

// The ray in the space of a part, which is a ball alone.
static RealRay real_ball_ray(const RealScene *s, const Primitive *ball, const RealRay *ray)
{
    const double *centre = ball->to_world.m[3];
    RealVec offset = real_sub(ray->e, real_scale(s->inverse_scale, real_vec(vec3(centre[0], centre[1], centre[2]))));
    Real scale = (Real)1 / s->inverse_scale;
    return (RealRay){real_scale(scale, real_linear(ball->to_object.m, offset)),
                     real_scale(scale, real_linear(ball->to_object.m, ray->d))};
}

static Real real_part_root(const RealScene *s, uint32_t index, const RealRay *ray, RealStart start, bool *inside)
{
    RealRay object = real_ball_ray(s, &s->scene->primitives.items[index], ray);
    if (real_starts_on(start, SHAPE_PRIMITIVE) && start.index == index) {
        *inside = true;
        return start.inward ? real_ball_inward(object.e, object.d) : 0;
    }
    return real_ball_root(object.e, object.d, 1, inside);
}

static Real real_plane_root(const RealScene *s, uint32_t index, const RealRay *ray, RealStart start, bool *inside)
{
    const Plane *plane = &s->scene->planes.items[index];
    RealVec normal = real_vec(plane->normal);
    *inside = real_dot(normal, ray->d) > 0;
    if (real_starts_on(start, SHAPE_PLANE) && start.index == index) {
        return 0;
    }
    return ((Real)plane->distance * s->inverse_scale - real_dot(normal, ray->e)) / real_dot(normal, ray->d);
}

static void real_offer(RealHit *hit, bool *has_hit, Real t, bool inside, ShapeKind kind, uint32_t index, uint32_t order)
{
    if (t > 0 && (t < hit->t || (*has_hit && t == hit->t && order < hit->order))) {
        hit->t = t;
        hit->kind = kind;
        hit->index = index;
        hit->order = order;
        hit->inside = inside;
        *has_hit = true;
    }
}

// The nearest hit at 0 < t < t_max.
static bool real_closest(const RealScene *s, const RealRay *ray, RealStart start, Real t_max, RealHit *hit)
{
    bool has_hit = false;
    hit->t = t_max;
    for (uint32_t i = 0; i < s->scene->spheres.count; i++) {
        bool inside = false;
        Real t = real_sphere_root(s, i, ray, start, &inside);
        real_offer(hit, &has_hit, t, inside, SHAPE_SPHERE, i, scene_sphere_order(s->scene, i));
    }
    for (uint32_t i = 0; i < s->scene->primitives.count; i++) {
        bool inside = false;
        Real t = real_part_root(s, i, ray, start, &inside);
        real_offer(hit, &has_hit, t, inside, SHAPE_PRIMITIVE, i, s->scene->primitives.items[i].order);
    }
    for (uint32_t i = 0; i < s->scene->planes.count; i++) {
        bool inside;
        Real t = real_plane_root(s, i, ray, start, &inside);
        real_offer(hit, &has_hit, t, inside, SHAPE_PLANE, i, s->scene->planes.items[i].order);
    }
    return has_hit && hit->t < t_max;
}

// Point, normal and material of a hit; the point is put back onto the surface.
static void real_surface(const RealScene *s, const RealRay *ray, RealHit *hit)
{
    if (hit->kind == SHAPE_SPHERE) {
        const Sphere *sphere = &s->scene->spheres.items[hit->index];
        RealVec f = real_sphere_offset(s, sphere, ray->e);
        hit->normal = real_unit(real_add_scaled(f, hit->t, ray->d));
        Real radius = (Real)sphere->radius * s->inverse_scale;
        hit->point = hit->t < radius ? real_add_scaled(ray->e, hit->t, ray->d)
                                     : real_add_scaled(real_scale(s->inverse_scale, real_vec(sphere->centre)), radius,
                                                       hit->normal);
        hit->material = sphere->material;
    } else if (hit->kind == SHAPE_PRIMITIVE) {
        const Primitive *ball = &s->scene->primitives.items[hit->index];
        const double(*m)[3] = ball->to_object.m, *centre = ball->to_world.m[3];
        RealRay object = real_ball_ray(s, ball, ray);
        RealVec n = real_unit(real_add_scaled(object.e, hit->t, object.d));
        RealVec world = real_linear(ball->to_world.m, n);
        hit->point =
            real_scale(s->inverse_scale, real_add_scaled(world, 1, real_vec(vec3(centre[0], centre[1], centre[2]))));
        hit->normal = real_unit((RealVec){(Real)m[0][0] * n.x + (Real)m[0][1] * n.y + (Real)m[0][2] * n.z,
                                          (Real)m[1][0] * n.x + (Real)m[1][1] * n.y + (Real)m[1][2] * n.z,
                                          (Real)m[2][0] * n.x + (Real)m[2][1] * n.y + (Real)m[2][2] * n.z});
        hit->material = ball->material;
    } else {
        const Plane *plane = &s->scene->planes.items[hit->index];
        hit->normal = real_vec(plane->normal);
        RealVec point = real_add_scaled(ray->e, hit->t, ray->d);
        Real rest = (Real)plane->distance * s->inverse_scale - real_dot(hit->normal, point);
        hit->point = real_add_scaled(point, rest, hit->normal);
        hit->material = plane->material;
    }
}

#endif
