// Some rays against a primitive of a kind that has a test in lanes, in the primitive's own space: part of
// spheres_kernel.c.
//
// Operations and their order are those of primitive_ray and of sphere_test, or of cone_interval, box_interval and
// flat_root, so the bits are the same. Whatever takes a way that ordinary rays do not take (along a face, grazing,
// through a tip) is not certain: it is asked by itself.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_PRIMITIVE_LANES_H
#define TRACE_PRIMITIVE_LANES_H

#include <float.h>

#include "trace/cone.h"
#include "trace/curve_lanes.h"
#include "trace/prism.h"
#include "trace/prism_lanes.h"
#include "trace/shapes.h"
#include "trace/simd.h"

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

// No crossing of a primitive at t is off by more than (fixed + slope t) / |n·d|, for d in its space and the gradient n
// there: that is primitive_crossing_error's bound, made of lengths instead of coordinates, with a tenth more for their
// rounding.
typedef struct LaneSlack {
    double fixed, slope;
} LaneSlack;

// The greatest that a component of a gradient is on the surface.
RT_ALWAYS_INLINE double gradient_most(const PreparedPrimitive *primitive)
{
    if (primitive->kind == PRIMITIVE_TORUS) {
        return 1.1 * primitive->data[0].y; // it is as long as the tube is thick
    }
    if (primitive->kind == PRIMITIVE_POLYNOMIAL) { // it is the polynomial's own
        const double *sizes = polynomial_sizes(primitive->list.items);
        double r = greater_of(vec3_max_abs(primitive->fixed[0]), vec3_max_abs(primitive->fixed[1]));
        return 1.1 * (((4.0 * sizes[4] * r + 3.0 * sizes[3]) * r + 2.0 * sizes[2]) * r + sizes[1]);
    }
    double ratio = primitive->kind == PRIMITIVE_CONE ? primitive->data[0].x : 1.0;
    double radius = greater_of(1.0, ratio);
    return 1.1 * radius * greater_of(1.0, fabs(1.0 - ratio));
}

// For rays whose origins are no farther from 0 than `far` and whose directions are of about unit length.
RT_ALWAYS_INLINE LaneSlack lane_slack(const PreparedPrimitive *primitive, double far)
{
    const double *columns = &primitive->columns.x;
    const Vec3 low = primitive->data[0], high = primitive->data[1];
    double sizes = (primitive->traits & TRAIT_SIZED) ? vec3_sum_abs(low) + vec3_sum_abs(high) : 3.0;
    double unit = 1.1 * TRANSFORM_ROUNDING * gradient_most(primitive), sum = columns[0] + columns[1] + columns[2];
    double fixed = unit * (sum * (far + vec3_length(primitive->centre) + primitive->extent) + sizes);
    return (LaneSlack){fixed, 1.1 * unit * sum};
}

// ---- what is met

// The first root of some rays that is ahead, into the primitive or out of it.
typedef struct PrimitiveLanes {
    unsigned possible; // not missed
    unsigned certain;  // the others' roots mean nothing
    unsigned leaves;   // it is met from the inside; of what is flat: from below
    DoublesMask side;  // none of a ball
    Doubles root;      // of a ball approximate
    Doubles bound;     // of how far that and its error reach
} PrimitiveLanes;

// A solid and what is the same for all rays.
typedef struct LanePrimitive {
    const PreparedPrimitive *solid;
    Linears to_object;
    Doubles centre[3];
    LaneSlack slack;
    Vec3 normal; // of a disc or triangle
} LanePrimitive;

// `far` as in lane_slack.
RT_ALWAYS_INLINE void lane_primitive_set(LanePrimitive *own, const PreparedPrimitive *primitive, double far)
{
    own->solid = primitive;
    own->slack = lane_slack(primitive, far);
    own->centre[0] = doubles_splat(primitive->centre.x);
    own->centre[1] = doubles_splat(primitive->centre.y);
    own->centre[2] = doubles_splat(primitive->centre.z);
    linears_splat(&primitive->to_object, &own->to_object);
    if (primitive_is_flat(primitive)) {
        own->normal = vec3_normalize(linear_normal(&primitive->to_object, vec3(0.0, 0.0, 1.0)));
    }
}

// primitive_ray of some rays.
RT_ALWAYS_INLINE void lane_primitive_ray(const LanePrimitive *own, const double origin[3][TILE_RAYS],
                                         const double direction[3][TILE_RAYS], unsigned at, Doubles f[3], Doubles d[3])
{
    Doubles from[3], along[3];
    lanes_load(origin, at, from);
    lanes_load(direction, at, along);
    lanes_sub(from, own->centre, from);
    linears_direction(&own->to_object, from, f);
    linears_direction(&own->to_object, along, d);
}

// False when all of `asked` are missed; nothing else is set then. `f` and `d` are in the ball's space.
RT_ALWAYS_INLINE bool ball_lanes(const Doubles f[3], const Doubles d[3], const LaneSlack *slack, unsigned asked,
                                 PrimitiveLanes *lanes)
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
    lanes->leaves = ~doubles_ge(c, doubles_splat(0.0));
    Doubles half = doubles_sqrt(discriminant * inverse_square), far_side = doubles_abs(t_middle) + half;
    Doubles near_side = doubles_abs(c) * inverse_square / far_side;
    Doubles root = doubles_choose((c > 0.0) | (t_middle < 0.0), near_side, far_side);
    Doubles error = (slack->fixed + slack->slope * root) * inverse_square / half; // |n·d| is half an interval times |d|²
    lanes->root = root;
    lanes->side = (DoublesMask){0};
    lanes->bound = doubles_min(2.0 * half, error) + 0x1p-10 * root;
    return true;
}

// Ends of an interval, the sides there, and how large n·d is there. As RayInterval.
typedef struct IntervalLanes {
    Doubles enter, leave, enter_along, leave_along;
    DoublesMask enter_side, leave_side;
} IntervalLanes;

RT_ALWAYS_INLINE DoublesMask sides_choose(DoublesMask mask, DoublesMask a, DoublesMask b)
{
    return (mask & a) | (~mask & b);
}

// interval_slab. `certain` keeps the rays that do not run along a bound, in it.
RT_ALWAYS_INLINE void slab_lanes(Doubles o, Doubles d, double low, double high, int64_t low_side, IntervalLanes *slab,
                                 DoublesMask *certain)
{
    Doubles t_low = (low - o) / d, t_high = (high - o) / d; // of a line along the bounds both ends are infinite
    DoublesMask up = (d > 0.0) | ((d == 0.0) & (t_low < t_high)), low_sides = (DoublesMask){0} + low_side;
    *certain &= (t_low == t_low) & (t_high == t_high);
    slab->enter = doubles_choose(up, t_low, t_high);
    slab->leave = doubles_choose(up, t_high, t_low);
    slab->enter_side = low_sides + (~up & 1);
    slab->leave_side = low_sides + (up & 1);
    slab->enter_along = slab->leave_along = doubles_abs(d);
}

// interval_meet.
RT_ALWAYS_INLINE void interval_lanes_meet(IntervalLanes *interval, const IntervalLanes *other)
{
    DoublesMask later = other->enter > interval->enter, sooner = other->leave < interval->leave;
    interval->enter = doubles_choose(later, other->enter, interval->enter);
    interval->enter_side = sides_choose(later, other->enter_side, interval->enter_side);
    interval->enter_along = doubles_choose(later, other->enter_along, interval->enter_along);
    interval->leave = doubles_choose(sooner, other->leave, interval->leave);
    interval->leave_side = sides_choose(sooner, other->leave_side, interval->leave_side);
    interval->leave_along = doubles_choose(sooner, other->leave_along, interval->leave_along);
}

// What convex_closest offers of an interval: its first end that is ahead and has a surface. False: no ray has any.
RT_ALWAYS_INLINE bool interval_lanes_first(const LanePrimitive *own, const IntervalLanes *interval, unsigned asked,
                                           PrimitiveLanes *lanes)
{
    const Doubles zero = doubles_splat(0.0);
    DoublesMask hidden = (DoublesMask){0} - ((own->solid->flags & PRIMITIVE_OPEN) != 0);
    DoublesMask enters = (interval->enter > zero) & ~(hidden & (interval->enter_side != 0));
    DoublesMask leaves = (interval->leave > zero) & ~(hidden & (interval->leave_side != 0));
    unsigned ahead = doubles_mask_bits((interval->enter <= interval->leave) & (enters | leaves));
    lanes->possible = asked & (ahead | ~lanes->certain);
    lanes->leaves = ~doubles_mask_bits(enters);
    lanes->root = doubles_choose(enters, interval->enter, interval->leave);
    lanes->side = sides_choose(enters, interval->enter_side, interval->leave_side);
    Doubles along = doubles_choose(enters, interval->enter_along, interval->leave_along);
    Doubles error = (own->slack.fixed + own->slack.slope * lanes->root) / along;
    lanes->bound = doubles_min(interval->leave - interval->enter, error);
    return lanes->possible;
}

RT_ALWAYS_INLINE bool box_lanes(const LanePrimitive *own, const Doubles f[3], const Doubles d[3], unsigned asked,
                                PrimitiveLanes *lanes)
{
    const double *low = &own->solid->data[0].x, *high = &own->solid->data[1].x;
    IntervalLanes interval, slab;
    DoublesMask certain = ~(DoublesMask){0};
    slab_lanes(f[0], d[0], low[0], high[0], 0, &interval, &certain);
    slab_lanes(f[1], d[1], low[1], high[1], 2, &slab, &certain);
    interval_lanes_meet(&interval, &slab);
    slab_lanes(f[2], d[2], low[2], high[2], 4, &slab, &certain);
    interval_lanes_meet(&interval, &slab);
    lanes->certain = doubles_mask_bits(certain);
    return interval_lanes_first(own, &interval, asked, lanes);
}

// cone_roots and cone_interval. Lines along the side, or next to grazing it, are not certain.
RT_ALWAYS_INLINE bool cone_lanes(const LanePrimitive *own, const Doubles f[3], const Doubles d[3], unsigned asked,
                                 PrimitiveLanes *lanes)
{
    const Doubles zero = doubles_splat(0.0), far = doubles_splat((double)INFINITY);
    double ratio = own->solid->data[0].x;
    Doubles p = 1.0 + (ratio - 1.0) * f[2], q = (ratio - 1.0) * d[2];
    Doubles cross = f[0] * d[1] - f[1] * d[0];
    Doubles wx = p * d[0] - q * f[0], wy = p * d[1] - q * f[1], whole = wx * wx + wy * wy;
    Doubles discriminant = whole - cross * cross;
    Doubles a = d[0] * d[0] + d[1] * d[1] - q * q;
    if (!(asked & ~(doubles_gt(a, zero) & doubles_gt(zero, discriminant)))) {
        return false;
    }
    Doubles b = f[0] * d[0] + f[1] * d[1] - p * q, c = f[0] * f[0] + f[1] * f[1] - p * p;
    Doubles along = doubles_sqrt(discriminant);
    Doubles sum = -(b + (Doubles)((DoublesMask)along | ((DoublesMask)b & INT64_MIN)));
    Doubles first = sum / a, second = c / sum;
    DoublesMask ordered = first < second, narrows = a > 0.0, widens = ~narrows & (q > 0.0);
    Doubles less = doubles_choose(ordered, first, second), greater = doubles_choose(ordered, second, first);
    IntervalLanes interval, slab;
    interval.enter = doubles_choose(narrows, less, doubles_choose(widens, greater, -far));
    interval.leave = doubles_choose(narrows, greater, doubles_choose(widens, far, less));
    interval.enter_along = interval.leave_along = along;
    interval.enter_side = interval.leave_side = (DoublesMask){0} + CONE_ROUND;
    DoublesMask is_clear = (discriminant > 0x1p-20 * whole) | (narrows & (discriminant < 0.0));
    DoublesMask certain = is_clear & (a != zero) & (sum != zero);
    slab_lanes(f[2], d[2], 0.0, 1.0, CONE_BASE, &slab, &certain);
    interval_lanes_meet(&interval, &slab);
    lanes->certain = doubles_mask_bits(certain);
    return interval_lanes_first(own, &interval, asked, lanes);
}

// What prism_intervals finds first, where a ray comes in at an end of the prism.
RT_ALWAYS_INLINE bool prism_lanes(const LanePrimitive *own, const Doubles f[3], const Doubles d[3], unsigned asked,
                                  PrimitiveLanes *lanes)
{
    IntervalLanes slab;
    DoublesMask certain = ~(DoublesMask){0};
    unsigned misses;
    slab_lanes(f[1], d[1], own->solid->data[0].y, own->solid->data[1].y, PRISM_LOW, &slab, &certain);
    asked &= ~doubles_mask_bits(certain & (slab.leave <= 0.0)); // all of it is behind
    certain &= (slab.enter > 0.0) & (slab.enter < slab.leave) & (slab.leave < 0x1p900);
    unsigned told = asked & doubles_mask_bits(certain);
    lanes->certain = told ? prism_lanes_enter(own->solid, f, d, slab.enter, slab.leave, told, &misses) : 0;
    lanes->possible = asked & ~(told ? told & misses : 0);
    lanes->leaves = 0;
    lanes->root = slab.enter;
    lanes->side = slab.enter_side;
    lanes->bound = (own->slack.fixed + own->slack.slope * slab.enter) / slab.enter_along;
    return lanes->possible;
}

// smooth_normal of each, from the normals at the corners.
RT_ALWAYS_INLINE void smooth_lanes(const Doubles corners[3][3], Doubles x, Doubles y, Doubles normal[3])
{
    const Doubles zero = doubles_splat(0.0);
    Doubles first = 1.0 - x - y;
    DoublesMask cancel = ~(DoublesMask){0};
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
        normal[axis] = first * corners[0][axis] + x * corners[1][axis] + y * corners[2][axis];
        cancel &= normal[axis] == zero;
    }
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
        normal[axis] = doubles_choose(cancel, corners[0][axis], normal[axis]);
    }
}

// Whether rays come from below where they meet a smooth triangle.
RT_ALWAYS_INLINE unsigned smooth_lanes_leave(const LanePrimitive *own, Doubles x, Doubles y, const Doubles world[3])
{
    Doubles corners[3][3], object[3], normal[3];
#pragma GCC unroll 3
    for (int corner = 0; corner < 3; corner++) {
        Vec3 n = own->solid->data[corner];
        corners[corner][0] = doubles_splat(n.x);
        corners[corner][1] = doubles_splat(n.y);
        corners[corner][2] = doubles_splat(n.z);
    }
    smooth_lanes(corners, x, y, object);
    linears_normal(&own->to_object, object, normal);
    Doubles shrink = 1.0 / doubles_sqrt(lanes_dot(normal, normal));
    for (int axis = 0; axis < 3; axis++) {
        normal[axis] = shrink * normal[axis];
    }
    return doubles_gt(lanes_dot(normal, world), doubles_splat(0.0));
}

// flat_root, with disc_has or triangle_has, and which side of it the ray comes from.
RT_ALWAYS_INLINE bool flat_lanes(const LanePrimitive *own, PrimitiveKind kind, const Doubles f[3], const Doubles d[3],
                                 const Doubles world[3], unsigned asked, PrimitiveLanes *lanes)
{
    const Doubles zero = doubles_splat(0.0);
    const double hole = own->solid->data[0].x;
    Doubles t = -f[2] / d[2], x = f[0] + t * d[0], y = f[1] + t * d[1], square = x * x + y * y;
    DoublesMask has =
        kind == PRIMITIVE_DISC ? (square <= 1.0) & (square >= hole * hole) : (x >= 0.0) & (y >= 0.0) & (x + y <= 1.0);
    lanes->possible = asked & doubles_mask_bits(has & (t > zero) & (d[2] != zero));
    if (!lanes->possible) {
        return false;
    }
    lanes->certain = ~0u;
    if (kind == PRIMITIVE_SMOOTH_TRIANGLE) {
        lanes->leaves = smooth_lanes_leave(own, x, y, world);
    } else {
        Vec3 n = own->normal;
        lanes->leaves = doubles_gt(n.x * world[0] + n.y * world[1] + n.z * world[2], zero);
    }
    lanes->root = t;
    lanes->side = (DoublesMask){0};
    lanes->bound = (own->slack.fixed + own->slack.slope * t) / doubles_abs(d[2]);
    return true;
}

// The first root of a curve; `starts`: all rays start on it and leave it.
RT_ALWAYS_INLINE bool curve_lanes(const LanePrimitive *own, PrimitiveKind kind, const Doubles f[3], const Doubles d[3],
                                  bool starts, unsigned asked, PrimitiveLanes *lanes)
{
    CurveFirst first;
    if (!curve_lanes_first(own->solid, kind, starts, f, d, asked, &first)) {
        return false;
    }
    lanes->possible = first.possible;
    lanes->certain = first.certain;
    lanes->leaves = 0;
    lanes->side = (DoublesMask){0};
    lanes->root = first.root;
    lanes->bound = (own->slack.fixed + own->slack.slope * first.root) / first.along;
    return true;
}

// The kinds, each with its test. `kind` is a constant of the caller, `world` the rays' directions. False when all of
// `asked` are missed; nothing else is set then.
RT_ALWAYS_INLINE bool primitive_lanes(const LanePrimitive *own, PrimitiveKind kind, const Doubles f[3],
                                      const Doubles d[3], const Doubles world[3], unsigned asked, PrimitiveLanes *lanes)
{
    switch (kind) {
    case PRIMITIVE_SPHERE:
        return ball_lanes(f, d, &own->slack, asked, lanes);
    case PRIMITIVE_BOX:
        return box_lanes(own, f, d, asked, lanes);
    case PRIMITIVE_CONE:
        return cone_lanes(own, f, d, asked, lanes);
    case PRIMITIVE_TORUS:
        return curve_lanes(own, PRIMITIVE_TORUS, f, d, false, asked, lanes);
    case PRIMITIVE_POLYNOMIAL:
        return curve_lanes(own, PRIMITIVE_POLYNOMIAL, f, d, false, asked, lanes);
    case PRIMITIVE_PRISM:
        return prism_lanes(own, f, d, asked, lanes);
    case PRIMITIVE_BLOB:
        return curve_lanes(own, PRIMITIVE_BLOB, f, d, false, asked, lanes);
    default: return flat_lanes(own, kind, f, d, world, asked, lanes);
    }
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

#endif
