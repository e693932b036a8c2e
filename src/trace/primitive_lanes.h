// Some rays against a primitive of a kind that has a test in lanes, in the primitive's own space: part of
// spheres_kernel.c.
//
// Roots are those of single rays, bit for bit, by the same text (trace/sphere.inc, cone.inc, flat.inc, interval.inc).
// Whatever takes a way that ordinary rays do not take (along a face, grazing, through a tip) is not certain: it is
// asked by itself.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_PRIMITIVE_LANES_H
#define TRACE_PRIMITIVE_LANES_H

#include <float.h>

#include "trace/cone.h"
#include "trace/curve_lanes.h"
#include "trace/flat.h"
#include "trace/prism.h"
#include "trace/prism_lanes.h"
#include "trace/shapes.h"
#include "trace/simd.h"
#include "trace/sphere_rays.h"

// As RayInterval.
typedef struct IntervalLanes {
    Doubles enter, leave;
    DoublesMask enter_side, leave_side;
} IntervalLanes;

#include "trace/lane_doubles.h"
#include "trace/cone.inc"
#include "trace/flat.inc"
#include "trace/interval.inc"

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

// Some rays in the space of a primitive, and their directions in the scene.
typedef struct RayLanes {
    Vec3s f, d, world;
} RayLanes;

// A solid and what is the same for all rays.
typedef struct LanePrimitive {
    const PreparedPrimitive *solid;
    Linears to_object;
    Vec3s centre;
    LaneSlack slack;
    Vec3 normal; // of a disc or triangle
} LanePrimitive;

// `far` as in lane_slack.
RT_ALWAYS_INLINE void lane_primitive_set(LanePrimitive *own, const PreparedPrimitive *primitive, double far)
{
    own->solid = primitive;
    own->slack = lane_slack(primitive, far);
    own->centre = vec3s_splat(primitive->centre);
    own->to_object = linears_splat(&primitive->to_object);
    if (primitive_is_flat(primitive)) {
        own->normal = vec3_normalize(linear_normal(&primitive->to_object, vec3(0.0, 0.0, 1.0)));
    }
}

// primitive_ray of some rays.
RT_ALWAYS_INLINE RayLanes lane_primitive_ray(const LanePrimitive *own, const double origin[3][TILE_RAYS],
                                             const double direction[3][TILE_RAYS], unsigned at)
{
    Vec3s d = vec3s_load(direction, at), f = vec3s_sub(vec3s_load(origin, at), own->centre);
    return (RayLanes){linears_direction(&own->to_object, f), linears_direction(&own->to_object, d), d};
}

// False when all of `asked` are missed; nothing else is set then.
RT_ALWAYS_INLINE bool ball_lanes(const LanePrimitive *own, const RayLanes *rays, unsigned asked, PrimitiveLanes *lanes)
{
    const LaneSlack *slack = &own->slack;
    SphereRays ray = sphere_rays_make(rays->f, rays->d);
    Doubles t_middle, discriminant = spheres_discriminant(&ray, rays->f, doubles_splat(1.0), &t_middle);
    Doubles f_squared = vec3s_length_squared(rays->f);
    Doubles sum = f_squared + 1.0, c = f_squared - 1.0, uncertainty = SPHERE_UNCERTAINTY * sum;
    unsigned outer = doubles_ge(c, uncertainty);
    lanes->possible =
        asked & doubles_ge(discriminant, -SPHERE_ROUNDING * sum) & (doubles_ge(t_middle, doubles_splat(0.0)) | ~outer);
    if (!lanes->possible) {
        return false;
    }
    lanes->certain = doubles_ge(discriminant, uncertainty) & doubles_ge(doubles_abs(c), uncertainty);
    lanes->leaves = ~doubles_ge(c, doubles_splat(0.0));
    Doubles half = doubles_sqrt(discriminant * ray.inverse_square);
    Doubles root = spheres_root(t_middle, discriminant, c, ray.inverse_square);
    Doubles error =
        (slack->fixed + slack->slope * root) * ray.inverse_square / half; // |n·d| is half an interval times |d|²
    lanes->root = root;
    lanes->side = (DoublesMask){0};
    lanes->bound = doubles_min(2.0 * half, error) + 0x1p-10 * root;
    return true;
}

// What lies between two bounds as interval_slab has it. `certain` keeps the rays that do not run along a bound, in it.
RT_ALWAYS_INLINE IntervalLanes slab_lanes(Doubles o, Doubles d, Slab ends, DoublesMask *certain)
{
    IntervalLanes slab = interval_lanes_between(o, d, ends);
    *certain &= (slab.enter == slab.enter) & (slab.leave == slab.leave);
    return slab;
}

// What convex_closest offers of an interval: its first end that is ahead and has a surface. The bound is for crossings
// without errors. False: no ray has any.
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
    lanes->side = (enters & interval->enter_side) | (~enters & interval->leave_side);
    lanes->bound = interval->leave - interval->enter;
    return lanes->possible;
}

// How far a crossing may be off, for n·d of that size.
RT_ALWAYS_INLINE Doubles lane_error(const LanePrimitive *own, Doubles root, Doubles along)
{
    return (own->slack.fixed + own->slack.slope * root) / along;
}

RT_ALWAYS_INLINE bool box_lanes(const LanePrimitive *own, const RayLanes *rays, unsigned asked, PrimitiveLanes *lanes)
{
    const Vec3 low = own->solid->data[0], high = own->solid->data[1];
    const Vec3s f = rays->f, d = rays->d;
    DoublesMask certain = ~(DoublesMask){0};
    IntervalLanes interval = slab_lanes(f.x, d.x, (Slab){low.x, high.x, 0}, &certain);
    IntervalLanes y = slab_lanes(f.y, d.y, (Slab){low.y, high.y, 2}, &certain);
    IntervalLanes z = slab_lanes(f.z, d.z, (Slab){low.z, high.z, 4}, &certain);
    interval_lanes_meet(&interval, &y);
    interval_lanes_meet(&interval, &z);
    lanes->certain = doubles_mask_bits(certain);
    if (!interval_lanes_first(own, &interval, asked, lanes)) {
        return false;
    }
    Doubles along = doubles_choose(lanes->side < 2, d.x, doubles_choose(lanes->side < 4, d.y, d.z));
    lanes->bound = doubles_min(lanes->bound, lane_error(own, lanes->root, doubles_abs(along)));
    return true;
}

// cone_roots and cone_interval. Lines along the side, or next to grazing it, are not certain.
RT_ALWAYS_INLINE bool cone_lanes(const LanePrimitive *own, const RayLanes *rays, unsigned asked, PrimitiveLanes *lanes)
{
    const Doubles zero = doubles_splat(0.0);
    const ConesRoots r = cones_roots(own->solid->data[0].x, rays->f, rays->d);
    if (!(asked & ~(doubles_gt(r.a, zero) & doubles_gt(zero, r.discriminant)))) {
        return false;
    }
    Doubles root = doubles_sqrt(r.discriminant), sum = cones_sum(&r, root);
    DoublesMask is_clear = (r.discriminant > 0x1p-20 * r.whole) | ((r.a > 0.0) & (r.discriminant < 0.0));
    DoublesMask certain = is_clear & (r.a != zero) & (sum != zero);
    IntervalLanes interval = cones_round(&r, sum);
    IntervalLanes slab = slab_lanes(rays->f.z, rays->d.z, (Slab){0.0, 1.0, CONE_BASE}, &certain);
    interval_lanes_meet(&interval, &slab);
    lanes->certain = doubles_mask_bits(certain);
    if (!interval_lanes_first(own, &interval, asked, lanes)) {
        return false;
    }
    Doubles along = doubles_choose(lanes->side == CONE_ROUND, root, doubles_abs(rays->d.z));
    lanes->bound = doubles_min(lanes->bound, lane_error(own, lanes->root, along));
    return true;
}

// What prism_intervals finds first, where a ray comes in at an end of the prism.
RT_ALWAYS_INLINE bool prism_lanes(const LanePrimitive *own, const RayLanes *rays, unsigned asked, PrimitiveLanes *lanes)
{
    const Doubles f[3] = {rays->f.x, rays->f.y, rays->f.z}, d[3] = {rays->d.x, rays->d.y, rays->d.z};
    const Slab ends = {own->solid->data[0].y, own->solid->data[1].y, PRISM_LOW};
    DoublesMask certain = ~(DoublesMask){0};
    unsigned misses;
    IntervalLanes slab = slab_lanes(f[1], d[1], ends, &certain);
    asked &= ~doubles_mask_bits(certain & (slab.leave <= 0.0)); // all of it is behind
    certain &= (slab.enter > 0.0) & (slab.enter < slab.leave) & (slab.leave < 0x1p900);
    unsigned decided = asked & doubles_mask_bits(certain);
    lanes->certain = decided ? prism_lanes_enter(own->solid, f, d, slab.enter, slab.leave, decided, &misses) : 0;
    lanes->possible = asked & ~(decided ? decided & misses : 0);
    lanes->leaves = 0;
    lanes->root = slab.enter;
    lanes->side = slab.enter_side;
    lanes->bound = lane_error(own, slab.enter, doubles_abs(d[1]));
    return lanes->possible;
}

// smooth_normal of each, from the normals at the corners.
RT_ALWAYS_INLINE Vec3s smooth_lanes(const Vec3s corners[3], Doubles x, Doubles y)
{
    Doubles first = 1.0 - x - y;
    Vec3s normal =
        vec3s_add(vec3s_add(vec3s_scale(first, corners[0]), vec3s_scale(x, corners[1])), vec3s_scale(y, corners[2]));
    DoublesMask cancel = (normal.x == 0.0) & (normal.y == 0.0) & (normal.z == 0.0);
    return vec3s_choose(cancel, corners[0], normal);
}

// Whether rays come from below where they meet a smooth triangle.
RT_ALWAYS_INLINE unsigned smooth_lanes_leave(const LanePrimitive *own, Doubles x, Doubles y, Vec3s world)
{
    const Vec3 *data = own->solid->data;
    const Vec3s corners[3] = {vec3s_splat(data[0]), vec3s_splat(data[1]), vec3s_splat(data[2])};
    Vec3s normal = vec3s_normalize(linears_normal(&own->to_object, smooth_lanes(corners, x, y)));
    return doubles_gt(vec3s_dot(normal, world), doubles_splat(0.0));
}

// Where it is met, and which side of it the ray comes from.
RT_ALWAYS_INLINE bool flat_lanes(const LanePrimitive *own, PrimitiveKind kind, const RayLanes *rays, unsigned asked,
                                 PrimitiveLanes *lanes)
{
    const FlatPlaces at = flat_places(rays->f, rays->d);
    DoublesMask has = kind == PRIMITIVE_DISC ? discs_have(own->solid->data[0].x, &at) : triangles_have(&at);
    lanes->possible = asked & doubles_mask_bits(has & (at.t > 0.0));
    if (!lanes->possible) {
        return false;
    }
    lanes->certain = ~0u;
    if (kind == PRIMITIVE_SMOOTH_TRIANGLE) {
        lanes->leaves = smooth_lanes_leave(own, at.x, at.y, rays->world);
    } else {
        lanes->leaves = doubles_gt(vec3s_dot(vec3s_splat(own->normal), rays->world), doubles_splat(0.0));
    }
    lanes->root = at.t;
    lanes->side = (DoublesMask){0};
    lanes->bound = lane_error(own, at.t, doubles_abs(rays->d.z));
    return true;
}

// The first root of a curve; `starts`: all rays start on it and leave it.
RT_ALWAYS_INLINE bool curve_lanes(const LanePrimitive *own, PrimitiveKind kind, const RayLanes *rays, bool starts,
                                  unsigned asked, PrimitiveLanes *lanes)
{
    const Doubles f[3] = {rays->f.x, rays->f.y, rays->f.z}, d[3] = {rays->d.x, rays->d.y, rays->d.z};
    CurveFirst first;
    if (!curve_lanes_first(own->solid, kind, starts, f, d, asked, &first)) {
        return false;
    }
    lanes->possible = first.possible;
    lanes->certain = first.certain;
    lanes->leaves = 0;
    lanes->side = (DoublesMask){0};
    lanes->root = first.root;
    lanes->bound = lane_error(own, first.root, first.along);
    return true;
}

// The kinds, each with its test. `kind` is a constant of the caller. False when all of `asked` are missed; nothing else
// is set then.
RT_ALWAYS_INLINE bool primitive_lanes(const LanePrimitive *own, PrimitiveKind kind, const RayLanes *rays,
                                      unsigned asked, PrimitiveLanes *lanes)
{
    switch (kind) {
    case PRIMITIVE_SPHERE:
        return ball_lanes(own, rays, asked, lanes);
    case PRIMITIVE_BOX:
        return box_lanes(own, rays, asked, lanes);
    case PRIMITIVE_CONE:
        return cone_lanes(own, rays, asked, lanes);
    case PRIMITIVE_TORUS:
        return curve_lanes(own, PRIMITIVE_TORUS, rays, false, asked, lanes);
    case PRIMITIVE_POLYNOMIAL:
        return curve_lanes(own, PRIMITIVE_POLYNOMIAL, rays, false, asked, lanes);
    case PRIMITIVE_PRISM:
        return prism_lanes(own, rays, asked, lanes);
    case PRIMITIVE_BLOB:
        return curve_lanes(own, PRIMITIVE_BLOB, rays, false, asked, lanes);
    default:
        return flat_lanes(own, kind, rays, asked, lanes);
    }
}

RT_ALWAYS_INLINE Doubles lanes_max_abs(const Doubles v[3])
{
    return doubles_max(doubles_max(doubles_abs(v[0]), doubles_abs(v[1])), doubles_abs(v[2]));
}

// Those of some rays that may meet a quadric, in whose space `origin` and `direction` are.
RT_ALWAYS_INLINE unsigned quadric_lanes_possible(const PreparedPrimitive *primitive, Vec3s origin, Vec3s direction)
{
    const Doubles f[3] = {origin.x, origin.y, origin.z}, d[3] = {direction.x, direction.y, direction.z};
    Doubles value, rounding;
    Doubles discriminant =
        quadric_discriminant(primitive->list.items, f, d, lanes_max_abs(f), lanes_max_abs(d), &value, &rounding);
    return ~doubles_mask_bits((rounding > QUADRIC_ROUNDING_LEAST) & (discriminant < -rounding));
}

// ---- boxes

// item_enters of some rays: those that meet the box, and where.
RT_ALWAYS_INLINE unsigned box_lanes_enter(const Bvh *tree, const ItemBox *box, Vec3s origin, Vec3s world,
                                          Doubles *enter)
{
    const Vec3s start = vec3s_scale(doubles_splat(tree->scale), vec3s_sub(origin, vec3s_splat(tree->centre)));
    const Doubles o[3] = {start.x, start.y, start.z}, direction[3] = {world.x, world.y, world.z};
    Doubles in = doubles_splat(0.0), out = doubles_splat((double)INFINITY);
    Doubles reach =
        doubles_abs(o[0]) + doubles_abs(o[1]) + doubles_abs(o[2]) + (tree->half.x + tree->half.y + tree->half.z);
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
