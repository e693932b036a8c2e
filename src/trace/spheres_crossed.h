// All crossings of rays to a light with few spheres and a plane, found from the rays' starts: part of spheres_kernel.c.
//
// A walk from one crossing to the next, each found from the one before (render/shade_light.h), meets the same surfaces in
// the same order wherever that is certain: every crossing of a line, and the place of its end, is told apart from the next
// by more than all that rounding does on a walk's way. What is not so certain is left to be walked.
//
// Each start of the walk's rays is off the line by less than 2^-50 W, where no coordinate is beyond W, and there are
// fewer than 2^7 of them: by less than 2^-43 W in all. That, and rounding here, change r² - |l|² and |f|² - r² by less
// than 2^-41 W², and, those being beyond CROSSED_DOUBT W², roots by less than 2^-41 W² / (2 sqrt(2^-30) W) = 2^-27 W.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERES_CROSSED_H
#define TRACE_SPHERES_CROSSED_H

#include "trace/plane.h"
#include "trace/simd.h"
#include "trace/spheres.h"
#include "trace/spheres_onward.h"

#define CROSSED_DOUBT 0x1p-30 // of W², for r² - |l|² and |f|² - r²
#define CROSSED_APART 0x1p-25 // of W, for two roots
#define CROSSED_GRAZE 0x1p-14 // of W: how far from the middle both roots are at most where it is grazed

// Crossings by their roots, which rise or fall.
typedef struct CrossedList {
    int count;
    double t[SPHERES_FEW_MOST + 1];
    ShapeId shape[SPHERES_FEW_MOST + 1];
} CrossedList;

// A vector of rays.
typedef struct CrossedVector {
    Doubles origin[3], direction[3], dual[3], inverse_square, end;
    Doubles doubt, apart, graze; // what the names above stand for
    DoublesMask inward;          // into what they start on
    DoublesMask is_open;         // not certain
    CrossedList into[DOUBLES], out[DOUBLES]; // the roots of the first rise, those of the second fall
} CrossedVector;

// Beyond every coordinate of spheres and plane. 0: some sphere is so small beside that, that little would be certain.
static double crossed_reach(const SphereTable *table, const PlaneShape *plane)
{
    double reach = plane ? fabs(plane->distance) : 0.0, least = (double)INFINITY;
    for (uint32_t i = 0; i < few_slots(table); i++) {
        Ball ball = sphere_table_ball(table, i);
        if (!isnan(ball.radius_squared)) {
            Vec3 c = ball.centre;
            reach = fmax(reach, fabs(c.x) + fabs(c.y) + fabs(c.z) + sqrt(ball.radius_squared));
            least = fmin(least, ball.radius_squared);
        }
    }
    return least >= 0x1p-18 * reach * reach && reach < 0x1p400 && reach > 0x1p-400 ? reach : 0.0;
}

static void crossed_load(CrossedVector *v, const TileSurfaces *from, const SurfaceRays *rays, int at, double reach)
{
    Doubles square = doubles_splat(0.0), cosine = doubles_splat(0.0), beyond = doubles_splat(reach);
    for (int axis = 0; axis < 3; axis++) {
        v->origin[axis] = doubles_load(&from->point[axis][at]);
        v->direction[axis] = doubles_load(&rays->towards[axis][at]);
        square += v->direction[axis] * v->direction[axis];
        cosine += doubles_load(&from->outward[axis][at]) * v->direction[axis];
        beyond += doubles_abs(v->origin[axis]);
    }
    v->inverse_square = 1.0 / square;
    for (int axis = 0; axis < 3; axis++) {
        v->dual[axis] = v->inverse_square * v->direction[axis];
    }
    v->end = doubles_load(&rays->distance[at]);
    v->doubt = CROSSED_DOUBT * beyond * beyond;
    v->apart = CROSSED_APART * (beyond + doubles_abs(v->end));
    v->graze = CROSSED_GRAZE * beyond;
    v->inward = cosine < 0.0;
    v->is_open = ~((v->inverse_square > 0.5) & (v->inverse_square < 2.0)) | ~(v->end > v->apart) |
                 ~(doubles_abs(cosine) > 0x1p-40);
    for (int i = 0; i < DOUBLES; i++) {
        v->into[i].count = v->out[i].count = 0;
    }
}

// Adds a crossing to the lists of some rays.
RT_ALWAYS_INLINE void crossed_add(CrossedList *lists, bool rises, unsigned rays, Doubles roots, ShapeId shape)
{
    _Alignas(64) double t[DOUBLES];
    doubles_store(t, roots);
    for (; rays; rays &= rays - 1) {
        unsigned i = (unsigned)__builtin_ctz(rays);
        CrossedList *list = &lists[i];
        int place = list->count++;
        for (; place > 0 && (rises ? list->t[place - 1] > t[i] : list->t[place - 1] < t[i]); place--) {
            list->t[place] = list->t[place - 1];
            list->shape[place] = list->shape[place - 1];
        }
        list->t[place] = t[i];
        list->shape[place] = shape;
    }
}

// Of roots that are met, those before the ray's end.
RT_ALWAYS_INLINE DoublesMask crossed_before(CrossedVector *v, DoublesMask met, Doubles root)
{
    DoublesMask before = root < v->end - v->apart;
    v->is_open |= met & ~before & ~(root > v->end + v->apart);
    return met & before;
}

// One sphere; the rays of `starts` start on it.
RT_ALWAYS_INLINE void crossed_sphere(CrossedVector *v, const Ball *ball, ShapeId shape, unsigned starts, unsigned asked)
{
    Doubles fx = v->origin[0] - ball->centre.x;
    Doubles fy = v->origin[1] - ball->centre.y;
    Doubles fz = v->origin[2] - ball->centre.z;
    Doubles t_middle = -(fx * v->dual[0] + fy * v->dual[1] + fz * v->dual[2]);
    Doubles lx = fx + t_middle * v->direction[0];
    Doubles ly = fy + t_middle * v->direction[1];
    Doubles lz = fz + t_middle * v->direction[2];
    Doubles discriminant = ball->radius_squared - (lx * lx + ly * ly + lz * lz);
    Doubles c = (fx * fx + fy * fy + fz * fz) - ball->radius_squared;
    DoublesMask own = starts ? doubles_bits_mask(starts) : (DoublesMask){0};
    // What it starts outside of and goes away from, or reaches after its end, is not met.
    DoublesMask passed = ((c > v->doubt) & (t_middle < 0.0)) | ~(discriminant > -v->doubt) |
                         ((c > v->doubt) & (t_middle - doubles_sqrt(doubles_abs(discriminant)) > v->end + v->graze));
    DoublesMask possible = ~own & ~passed;
    if (!(doubles_mask_bits(possible | (own & v->inward)) & asked)) {
        return;
    }
    DoublesMask certain = (discriminant > v->doubt) & (doubles_abs(c) > v->doubt);
    v->is_open |= possible & ~certain;
    Doubles half = doubles_sqrt(doubles_abs(discriminant) * v->inverse_square);
    Doubles far_side = doubles_choose(own, 2.0 * t_middle, t_middle + half), near_side = t_middle - half;
    DoublesMask into = crossed_before(v, possible & (c > 0.0), near_side);
    DoublesMask out = crossed_before(v, possible | (own & v->inward), far_side);
    unsigned open = ~doubles_mask_bits(v->is_open) & asked;
    crossed_add(v->into, true, doubles_mask_bits(into) & open, near_side, shape);
    crossed_add(v->out, false, doubles_mask_bits(out) & open, far_side, shape);
}

// The plane; the rays of `starts` start on it. Where they run along it, only its distance may say that it is not met.
RT_ALWAYS_INLINE void crossed_plane(CrossedVector *v, const PlaneShape *plane, ShapeId shape, unsigned starts,
                                    unsigned asked)
{
    Vec3 n = plane->normal;
    Doubles along = n.x * v->direction[0] + n.y * v->direction[1] + n.z * v->direction[2];
    Doubles height = plane->distance - (n.x * v->origin[0] + n.y * v->origin[1] + n.z * v->origin[2]);
    Doubles root = height / along;
    DoublesMask ahead = ~((root < -v->apart) | (doubles_abs(height) > 2.0 * v->end));
    ahead &= ~doubles_bits_mask(starts);
    v->is_open |= ahead & ~((root > v->apart) & (doubles_abs(along) > CROSSED_GRAZE));
    DoublesMask met = crossed_before(v, ahead, root);
    unsigned open = ~doubles_mask_bits(v->is_open) & asked;
    crossed_add(v->into, true, doubles_mask_bits(met) & open, root, shape);
}

// Both lists of a ray in one; false when two crossings are not told apart.
static bool crossed_merge(const CrossedList *into, const CrossedList *out, double apart, ShapeId *shapes)
{
    int in = 0, left = out->count;
    double last = 0.0;
    for (int k = 0; k < into->count + out->count; k++) {
        bool is_into = in < into->count && (left == 0 || into->t[in] < out->t[left - 1]);
        double t = is_into ? into->t[in] : out->t[left - 1];
        shapes[k] = is_into ? into->shape[in] : out->shape[left - 1];
        if (!(t - last > apart)) {
            return false;
        }
        in += is_into;
        left -= !is_into;
        last = t;
    }
    return true;
}

// The rays of a vector for which the crossings are told.
static unsigned crossed_end(const CrossedVector *v, unsigned asked, int at, TileCrossings *crossings)
{
    unsigned told = 0;
    for (unsigned open = ~doubles_mask_bits(v->is_open) & asked; open; open &= open - 1) {
        unsigned i = (unsigned)__builtin_ctz(open);
        crossings->count[(unsigned)at + i] = (uint8_t)(v->into[i].count + v->out[i].count);
        told |= (unsigned)crossed_merge(&v->into[i], &v->out[i], v->apart[i], crossings->shape[(unsigned)at + i]) << i;
    }
    return told;
}

static uint64_t spheres_crossed(const SphereTable *table, const PlaneShape *plane, ShapeId plane_shape,
                                const TileSurfaces *from, const SurfaceRays *rays, uint64_t asked,
                                TileCrossings *crossings)
{
    const unsigned all = (1u << DOUBLES) - 1;
    uint64_t starts[SPHERES_FEW_MOST] = {0}, on_plane = 0, told = 0;
    double reach = crossed_reach(table, plane);
    if (reach == 0.0) {
        return 0;
    }
    for (int i = 0; i < from->count; i++) {
        bool is_sphere = shape_kind(from->shape[i]) == SHAPE_SPHERE;
        *(is_sphere ? &starts[shape_index(from->shape[i])] : &on_plane) |= UINT64_C(1) << i;
    }
    for (int at = 0; at < from->count; at += DOUBLES) {
        unsigned own = (unsigned)(asked >> at) & all;
        CrossedVector v;
        if (!own) {
            continue;
        }
        crossed_load(&v, from, rays, at, reach);
        for (uint32_t i = 0; i < few_slots(table); i++) {
            Ball ball = sphere_table_ball(table, i);
            if (!isnan(ball.radius_squared)) {
                crossed_sphere(&v, &ball, shape_id(SHAPE_SPHERE, i), (unsigned)(starts[i] >> at) & all, own);
            }
        }
        if (plane) {
            crossed_plane(&v, plane, plane_shape, (unsigned)(on_plane >> at) & all, own);
        }
        told |= (uint64_t)crossed_end(&v, own, at, crossings) << at;
    }
    return told;
}

#endif
