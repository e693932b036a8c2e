// Some rays against balls, spheres under affine maps, in the ball's own space: part of spheres_kernel.c.
//
// Operations and their order are those of solid_ray, sphere_test, sphere_refine and solid_surface, so the bits are the
// same.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_BALL_LANES_H
#define TRACE_BALL_LANES_H

#include <float.h>

#include "trace/shapes.h"
#include "trace/simd.h"
#include "trace/spheres_refine.h"

// A linear map for each ray, or the same for all.
typedef struct Linears {
    Doubles m[3][3];
} Linears;

RT_ALWAYS_INLINE void linears_splat(const Linear *linear, Linears *all)
{
#pragma GCC unroll 3
    for (int row = 0; row < 3; row++) {
#pragma GCC unroll 3
        for (int column = 0; column < 3; column++) {
            all->m[row][column] = doubles_splat(linear->m[row][column]);
        }
    }
}

// linear_direction of each.
RT_ALWAYS_INLINE void linears_direction(const Linears *linear, const Doubles v[3], Doubles image[3])
{
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        image[i] = v[0] * linear->m[0][i] + v[1] * linear->m[1][i] + v[2] * linear->m[2][i];
    }
}

// linear_normal of each.
RT_ALWAYS_INLINE void linears_normal(const Linears *inverse, const Doubles v[3], Doubles image[3])
{
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        image[i] = v[0] * inverse->m[i][0] + v[1] * inverse->m[i][1] + v[2] * inverse->m[i][2];
    }
}

RT_ALWAYS_INLINE Doubles lanes_dot(const Doubles a[3], const Doubles b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

RT_ALWAYS_INLINE void lanes_load(const double from[3][TILE_RAYS], unsigned at, Doubles to[3])
{
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
        to[axis] = doubles_load(&from[axis][at]);
    }
}

RT_ALWAYS_INLINE void lanes_sub(const Doubles a[3], const Doubles b[3], Doubles difference[3])
{
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
        difference[axis] = a[axis] - b[axis];
    }
}

// ---- errors

// No crossing of a ball at t is off by more than (fixed + slope t) / |n·d|, for n and d in the ball's space: that is
// solid_crossing_error's bound, made of lengths instead of coordinates, with a tenth more for their rounding.
typedef struct BallSlack {
    double fixed, slope;
} BallSlack;

// For rays whose origins are no farther from 0 than `far` and whose directions are of about unit length.
RT_ALWAYS_INLINE BallSlack ball_slack(const Solid *ball, double far)
{
    const double(*m)[3] = ball->to_object.m;
    double columns = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        columns += sqrt(m[0][axis] * m[0][axis] + m[1][axis] * m[1][axis] + m[2][axis] * m[2][axis]);
    }
    double slope = 1.1 * TRANSFORM_ROUNDING * columns;
    double fixed = slope * (far + vec3_length(ball->centre) + ball->extent) + 3.3 * TRANSFORM_ROUNDING;
    return (BallSlack){fixed, 1.1 * slope};
}

// ---- what is met

// What sphere_test says of some rays.
typedef struct BallLanes {
    unsigned possible; // not missed
    unsigned certain;  // not doubtful; the others' roots mean nothing
    unsigned inside;
    Doubles root;  // approximate
    Doubles bound; // of how far that and its error reach
} BallLanes;

// False when all of `asked` are missed; nothing else is set then. `f` and `d` are in the ball's space.
RT_ALWAYS_INLINE bool ball_lanes_test(const Doubles f[3], const Doubles d[3], const BallSlack *slack, unsigned asked,
                                      BallLanes *lanes)
{
    Doubles inverse_square = 1.0 / lanes_dot(d, d);
    const Doubles direction_over_length2[3] = {inverse_square * d[0], inverse_square * d[1], inverse_square * d[2]};
    Doubles t_middle = -lanes_dot(f, direction_over_length2);
    const Doubles l[3] = {f[0] + t_middle * d[0], f[1] + t_middle * d[1], f[2] + t_middle * d[2]};
    Doubles discriminant = 1.0 - lanes_dot(l, l);
    Doubles f_squared = lanes_dot(f, f);
    Doubles sum = f_squared + 1.0, c = f_squared - 1.0, uncertainty = SPHERE_UNCERTAINTY * sum;
    unsigned outer = doubles_ge(c, uncertainty);
    lanes->possible = asked & doubles_ge(discriminant, -SPHERE_ROUNDING * sum) &
                      (doubles_ge(t_middle, doubles_splat(0.0)) | ~outer);
    if (!lanes->possible) {
        return false;
    }
    lanes->certain = doubles_ge(discriminant, uncertainty) & doubles_ge(doubles_abs(c), uncertainty);
    lanes->inside = ~doubles_ge(c, doubles_splat(0.0));
    Doubles half = doubles_sqrt(discriminant * inverse_square), far_side = doubles_abs(t_middle) + half;
    Doubles near_side = doubles_abs(c) * inverse_square / far_side;
    Doubles root = doubles_choose((c > 0.0) | (t_middle < 0.0), near_side, far_side);
    Doubles error = (slack->fixed + slack->slope * root) * inverse_square / half; // |n·d| is half an interval times |d|²
    lanes->root = root;
    lanes->bound = doubles_min(2.0 * half, error) + 0x1p-10 * root;
    return true;
}

// ---- one ball for all rays

typedef struct LaneBall {
    const Solid *solid;
    Linears to_object;
    Doubles centre[3];
    BallSlack slack;
} LaneBall;

// `far` as in ball_slack.
RT_ALWAYS_INLINE void lane_ball_set(LaneBall *ball, const Solid *solid, double far)
{
    ball->solid = solid;
    ball->slack = ball_slack(solid, far);
    ball->centre[0] = doubles_splat(solid->centre.x);
    ball->centre[1] = doubles_splat(solid->centre.y);
    ball->centre[2] = doubles_splat(solid->centre.z);
    linears_splat(&solid->to_object, &ball->to_object);
}

// solid_ray of some rays.
RT_ALWAYS_INLINE void lane_ball_ray(const LaneBall *ball, const double origin[3][TILE_RAYS],
                                    const double direction[3][TILE_RAYS], unsigned at, Doubles f[3], Doubles d[3])
{
    Doubles from[3], along[3];
    lanes_load(origin, at, from);
    lanes_load(direction, at, along);
    lanes_sub(from, ball->centre, from);
    linears_direction(&ball->to_object, from, f);
    linears_direction(&ball->to_object, along, d);
}

// ---- boxes

// item_enters of some rays: those that meet the box, and where.
RT_ALWAYS_INLINE unsigned box_lanes_enter(const Bvh *tree, const ItemBox *box, const Doubles origin[3],
                                          const Doubles direction[3], Doubles *enter)
{
    const double centre[3] = {tree->centre.x, tree->centre.y, tree->centre.z};
    Doubles o[3], in = doubles_splat(0.0), out = doubles_splat((double)INFINITY);
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
        o[axis] = tree->scale * (origin[axis] - centre[axis]);
    }
    Doubles reach = doubles_abs(o[0]) + doubles_abs(o[1]) + doubles_abs(o[2]) +
                    (tree->half.x + tree->half.y + tree->half.z);
    Doubles pad = 12.0 * (DBL_EPSILON / 2) * reach;
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
        Doubles size = doubles_abs(direction[axis]);
        size = doubles_choose(size > 0x1p-60, size, doubles_splat(0x1p-60));
        Doubles inverse = 1.0 / (Doubles)((DoublesMask)size | ((DoublesMask)direction[axis] & INT64_MIN));
        Doubles low = ((double)box->low[axis] - (o[axis] + pad)) * inverse;
        Doubles high = ((double)box->high[axis] - (o[axis] - pad)) * inverse;
        DoublesMask is_up = low < high;
        Doubles near = doubles_choose(is_up, low, high), far = doubles_choose(is_up, high, low);
        in = doubles_choose(in < near, near, in);
        out = doubles_choose(far < out, far, out);
    }
    *enter = in * (1.0 / tree->scale);
    return doubles_ge(out, in);
}

// ---- one ball for each ray

// A member of some solids; `first`: that of the first of the table.
RT_ALWAYS_INLINE Doubles solids_gather(const double *first, DoublesMask index)
{
    return doubles_gather(first, index * (int64_t)sizeof(Solid));
}

RT_ALWAYS_INLINE void solids_gather_linear(const Linear *first, DoublesMask index, Linears *all)
{
#pragma GCC unroll 3
    for (int row = 0; row < 3; row++) {
#pragma GCC unroll 3
        for (int column = 0; column < 3; column++) {
            all->m[row][column] = solids_gather(&first->m[row][column], index);
        }
    }
}

// The solids of parts.
RT_ALWAYS_INLINE DoublesMask parts_index(DoublesMask shapes)
{
    return (shapes & ((INT64_C(1) << SHAPE_INDEX_BITS) - 1)) >> PART_SIDE_BITS;
}

// solid_ray of some rays and the ball of each, whose centre is set, too.
RT_ALWAYS_INLINE void balls_ray(const Solid *solids, DoublesMask index, const Doubles origin[3],
                                const Doubles direction[3], Linears *to_object, Doubles centre[3], Doubles f[3],
                                Doubles d[3])
{
    Doubles offset[3];
    centre[0] = solids_gather(&solids->centre.x, index);
    centre[1] = solids_gather(&solids->centre.y, index);
    centre[2] = solids_gather(&solids->centre.z, index);
    solids_gather_linear(&solids->to_object, index, to_object);
    lanes_sub(origin, centre, offset);
    linears_direction(to_object, offset, f);
    linears_direction(to_object, direction, d);
}

// Refines roots, one of a ball for each ray. Returns those for which it is certain.
RT_ALWAYS_INLINE unsigned balls_refine(const Solid *solids, DoublesMask index, const Doubles origin[3],
                                       const Doubles direction[3], Doubles *t)
{
    Linears to_object;
    Doubles centre[3], f[3], d[3];
    const Doubles none = doubles_splat(0.0);
    const Balls unit = {{none, none, none}, doubles_splat(1.0)};
    balls_ray(solids, index, origin, direction, &to_object, centre, f, d);
    return roots_refine(f, d, 1.0 / lanes_dot(d, d), &unit, t);
}

// solid_surface of each.
RT_ALWAYS_INLINE void balls_surface(const Solid *solids, DoublesMask index, const Doubles origin[3],
                                    const Doubles direction[3], Doubles t, Doubles point[3], Doubles normal[3])
{
    Linears to_object, to_world;
    Doubles centre[3], f[3], d[3], own[3], away[3];
    balls_ray(solids, index, origin, direction, &to_object, centre, f, d);
    solids_gather_linear(&solids->to_world, index, &to_world);
    for (int axis = 0; axis < 3; axis++) {
        own[axis] = f[axis] + t * d[axis];
    }
    Doubles shrink = 1.0 / doubles_sqrt(lanes_dot(own, own));
    for (int axis = 0; axis < 3; axis++) {
        own[axis] = shrink * own[axis];
    }
    linears_direction(&to_world, own, away);
    linears_normal(&to_object, own, normal);
    shrink = 1.0 / doubles_sqrt(lanes_dot(normal, normal));
    for (int axis = 0; axis < 3; axis++) {
        point[axis] = centre[axis] + away[axis];
        normal[axis] = shrink * normal[axis];
    }
}

#endif
