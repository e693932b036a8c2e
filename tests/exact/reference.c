// Rays, nearest crossings and Phong's model in MPFR.
//
// SPDX-License-Identifier: MIT
#include "exact/reference.h"

#include "study/optional.h"

#ifdef WITH_MPFR
#include <math.h>
#include <mpfr.h>
#include <stdlib.h>

// Numbers for a function's own use, given back all together: a stack.
enum { NUMBERS = 2048 };
static mpfr_t numbers[NUMBERS];
static int used;

static mpfr_ptr number(const ExactScene *scene)
{
    if (used == NUMBERS) {
        abort();
    }
    if (mpfr_get_prec(numbers[used]) != scene->bits) {
        mpfr_set_prec(numbers[used], scene->bits);
    }
    return numbers[used++];
}

typedef struct Vector {
    mpfr_ptr x[3];
} Vector;

static Vector vector(const ExactScene *scene)
{
    return (Vector){{number(scene), number(scene), number(scene)}};
}

void exact_begin(void)
{
    for (int i = 0; i < NUMBERS; i++) {
        mpfr_init2(numbers[i], 64);
    }
}

void exact_end(void)
{
    for (int i = 0; i < NUMBERS; i++) {
        mpfr_clear(numbers[i]);
    }
    mpfr_free_cache();
}

static void set(Vector out, const double from[3])
{
    for (int i = 0; i < 3; i++) {
        mpfr_set_d(out.x[i], from[i], MPFR_RNDN);
    }
}

static void dot(mpfr_ptr out, Vector a, Vector b, mpfr_ptr scratch)
{
    mpfr_mul(out, a.x[0], b.x[0], MPFR_RNDN);
    for (int i = 1; i < 3; i++) {
        mpfr_mul(scratch, a.x[i], b.x[i], MPFR_RNDN);
        mpfr_add(out, out, scratch, MPFR_RNDN);
    }
}

// a + s b
static void add_scaled(Vector out, Vector a, mpfr_srcptr s, Vector b, mpfr_ptr scratch)
{
    for (int i = 0; i < 3; i++) {
        mpfr_mul(scratch, s, b.x[i], MPFR_RNDN);
        mpfr_add(out.x[i], a.x[i], scratch, MPFR_RNDN);
    }
}

static void normalize(Vector a, mpfr_ptr scratch, mpfr_ptr length)
{
    dot(length, a, a, scratch);
    mpfr_sqrt(length, length, MPFR_RNDN);
    for (int i = 0; i < 3; i++) {
        mpfr_div(a.x[i], a.x[i], length, MPFR_RNDN);
    }
}

// Crossings nearer than this are those of the surface that a ray leaves: 2^-(bits / 2) of its coordinates.
static void least_distance(const ExactScene *scene, mpfr_ptr out, Vector origin)
{
    mpfr_set_zero(out, 1);
    for (int i = 0; i < 3; i++) {
        if (mpfr_cmpabs(origin.x[i], out) > 0) {
            mpfr_abs(out, origin.x[i], MPFR_RNDN);
        }
    }
    mpfr_mul_2si(out, out, -scene->bits / 2, MPFR_RNDN);
}

// Sets t to the least root above `least`; false when there is none.
static bool sphere_root(const ExactScene *scene, const ExactShape *shape, Vector origin, Vector direction,
                        mpfr_srcptr least, mpfr_ptr t)
{
    int mark = used;
    Vector f = vector(scene);
    mpfr_ptr b = number(scene), c = number(scene), d = number(scene), scratch = number(scene);
    for (int i = 0; i < 3; i++) {
        mpfr_sub_d(f.x[i], origin.x[i], shape->centre[i], MPFR_RNDN);
    }
    dot(b, f, direction, scratch);
    dot(c, f, f, scratch);
    mpfr_set_d(scratch, shape->radius, MPFR_RNDN);
    mpfr_sqr(scratch, scratch, MPFR_RNDN);
    mpfr_sub(c, c, scratch, MPFR_RNDN);
    mpfr_sqr(d, b, MPFR_RNDN);
    mpfr_sub(d, d, c, MPFR_RNDN);
    bool is_met = mpfr_sgn(d) >= 0;
    if (is_met) {
        mpfr_sqrt(d, d, MPFR_RNDN);
        mpfr_neg(b, b, MPFR_RNDN);
        mpfr_sub(t, b, d, MPFR_RNDN);
        if (mpfr_cmp(t, least) <= 0) {
            mpfr_add(t, b, d, MPFR_RNDN);
        }
        is_met = mpfr_cmp(t, least) > 0;
    }
    used = mark;
    return is_met;
}

static bool plane_root(const ExactShape *shape, Vector origin, Vector direction, mpfr_srcptr least, mpfr_ptr t)
{
    int axis = shape->axis;
    if (mpfr_zero_p(direction.x[axis])) {
        return false;
    }
    mpfr_d_sub(t, shape->distance, origin.x[axis], MPFR_RNDN);
    mpfr_div(t, t, direction.x[axis], MPFR_RNDN);
    return mpfr_cmp(t, least) > 0;
}

// The nearest shape, or -1, for directions of unit length; `most`, NULL for none, is where the way ends: then any.
static int nearest_shape(const ExactScene *scene, Vector origin, Vector direction, mpfr_srcptr most, mpfr_ptr nearest)
{
    int mark = used, found = -1;
    mpfr_ptr t = number(scene), least = number(scene);
    least_distance(scene, least, origin);
    for (int i = 0; i < scene->shape_count; i++) {
        const ExactShape *shape = &scene->shapes[i];
        bool is_met = shape->is_plane ? plane_root(shape, origin, direction, least, t)
                                      : sphere_root(scene, shape, origin, direction, least, t);
        if (is_met && (found < 0 || mpfr_cmp(t, nearest) < 0) && (!most || mpfr_cmp(t, most) < 0)) {
            mpfr_set(nearest, t, MPFR_RNDN);
            found = i;
        }
    }
    used = mark;
    return found;
}

// A point of a surface as it is shaded: all vectors but `point` of unit length, the normal towards the viewer.
typedef struct Point {
    const ExactShape *shape;
    Vector point, normal, direction, mirrored;
} Point;

static void add_light(const ExactScene *scene, const Point *at, const ExactLight *light, double rgb[3])
{
    int mark = used;
    Vector towards = vector(scene);
    mpfr_ptr distance = number(scene), scratch = number(scene), cosine = number(scene), shine = number(scene);
    set(towards, light->position);
    for (int i = 0; i < 3; i++) {
        mpfr_sub(towards.x[i], towards.x[i], at->point.x[i], MPFR_RNDN);
    }
    normalize(towards, scratch, distance);
    dot(cosine, towards, at->normal, scratch);
    dot(shine, towards, at->mirrored, scratch);
    if (mpfr_sgn(cosine) > 0 && nearest_shape(scene, at->point, towards, distance, scratch) < 0) {
        double diffuse = EXACT_DIFFUSE * mpfr_get_d(cosine, MPFR_RNDN), highlight = mpfr_get_d(shine, MPFR_RNDN);
        highlight = highlight > 0.0 ? at->shape->phong * pow(highlight, EXACT_PHONG_SIZE) : 0.0;
        for (int i = 0; i < 3; i++) {
            rgb[i] += light->rgb[i] * (diffuse * at->shape->rgb[i] + highlight);
        }
    }
    used = mark;
}

static void point_set(const ExactScene *scene, Point *at, Vector origin, Vector direction, mpfr_srcptr t)
{
    mpfr_ptr scratch = number(scene), size = number(scene);
    const ExactShape *shape = at->shape;
    at->point = vector(scene);
    at->normal = vector(scene);
    at->mirrored = vector(scene);
    at->direction = direction;
    add_scaled(at->point, origin, t, direction, scratch);
    if (shape->is_plane) {
        for (int i = 0; i < 3; i++) {
            mpfr_set_d(at->normal.x[i], i == shape->axis ? 1.0 : 0.0, MPFR_RNDN);
        }
    } else {
        for (int i = 0; i < 3; i++) {
            mpfr_sub_d(at->normal.x[i], at->point.x[i], shape->centre[i], MPFR_RNDN);
        }
        normalize(at->normal, scratch, size);
    }
    dot(size, at->normal, direction, scratch);
    for (int i = 0; mpfr_sgn(size) > 0 && i < 3; i++) {
        mpfr_neg(at->normal.x[i], at->normal.x[i], MPFR_RNDN);
    }
    dot(size, at->normal, direction, scratch);
    mpfr_mul_si(size, size, -2, MPFR_RNDN);
    add_scaled(at->mirrored, direction, size, at->normal, scratch);
    normalize(at->mirrored, scratch, size);
}

static void ray_colour(const ExactScene *scene, Vector origin, Vector direction, double weight, int bounces,
                       double rgb[3])
{
    int mark = used;
    mpfr_ptr t = number(scene);
    int found = nearest_shape(scene, origin, direction, NULL, t);
    if (found >= 0) {
        Point at = {.shape = &scene->shapes[found]};
        double own[3];
        point_set(scene, &at, origin, direction, t);
        for (int i = 0; i < 3; i++) {
            own[i] = EXACT_AMBIENT * at.shape->rgb[i];
        }
        for (int i = 0; i < scene->light_count; i++) {
            add_light(scene, &at, &scene->lights[i], own);
        }
        for (int i = 0; i < 3; i++) {
            rgb[i] += weight * own[i];
        }
        if (at.shape->mirror > 0.0 && bounces < BOUNCES_MOST) {
            ray_colour(scene, at.point, at.mirrored, weight * at.shape->mirror, bounces + 1, rgb);
        }
    }
    used = mark;
}

void exact_colour(const ExactScene *scene, double u, double v, double rgb[3])
{
    int mark = used;
    Vector origin = vector(scene), direction = vector(scene), right = vector(scene), up = vector(scene);
    mpfr_ptr scratch = number(scene), length = number(scene);
    set(origin, scene->location);
    set(direction, scene->direction);
    set(right, scene->right);
    set(up, scene->up);
    mpfr_set_d(length, u, MPFR_RNDN);
    add_scaled(direction, direction, length, right, scratch);
    mpfr_set_d(length, v, MPFR_RNDN);
    add_scaled(direction, direction, length, up, scratch);
    normalize(direction, scratch, length);
    rgb[0] = rgb[1] = rgb[2] = 0.0;
    ray_colour(scene, origin, direction, 1.0, 0, rgb);
    used = mark;
}
#endif
