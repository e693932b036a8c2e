// Refined roots, points and normals of primitives that have tests in lanes, one for each ray: part of spheres_kernel.c.
//
// Operations and their order are those of sphere_refine and primitive_surface, so the bits are the same.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_PRIMITIVE_LANES_SURFACE_H
#define TRACE_PRIMITIVE_LANES_SURFACE_H

#include "trace/primitive_lanes.h"
#include "trace/spheres_refine.h"

// A member of some primitives; `first`: that of the first of the table.
RT_ALWAYS_INLINE Doubles primitives_gather(const double *first, DoublesMask index)
{
    return doubles_gather(first, index * (int64_t)sizeof(PreparedPrimitive));
}

RT_ALWAYS_INLINE void primitives_gather_linear(const Linear *first, DoublesMask index, Linears *all)
{
#pragma GCC unroll 3
    for (int row = 0; row < 3; row++) {
#pragma GCC unroll 3
        for (int column = 0; column < 3; column++) {
            all->m[row][column] = primitives_gather(&first->m[row][column], index);
        }
    }
}

// The primitives of primitives.
RT_ALWAYS_INLINE DoublesMask parts_index(DoublesMask shapes)
{
    return (shapes & ((INT64_C(1) << SHAPE_INDEX_BITS) - 1)) >> PRIMITIVE_SIDE_BITS;
}

// primitive_ray of some rays and the primitive of each, whose centre is set, too.
RT_ALWAYS_INLINE void primitives_ray(const PreparedPrimitive *primitives, DoublesMask index, const Doubles origin[3],
                                     const Doubles direction[3], Linears *to_object, Doubles centre[3], Doubles f[3],
                                     Doubles d[3])
{
    Doubles offset[3];
    centre[0] = primitives_gather(&primitives->centre.x, index);
    centre[1] = primitives_gather(&primitives->centre.y, index);
    centre[2] = primitives_gather(&primitives->centre.z, index);
    primitives_gather_linear(&primitives->to_object, index, to_object);
    lanes_sub(origin, centre, offset);
    linears_direction(to_object, offset, f);
    linears_direction(to_object, direction, d);
}

// Refines roots, one of a ball for each ray. Returns those for which it is certain.
RT_ALWAYS_INLINE unsigned balls_refine(const PreparedPrimitive *primitives, DoublesMask index, const Doubles origin[3],
                                       const Doubles direction[3], Doubles *t)
{
    Linears to_object;
    Doubles centre[3], f[3], d[3];
    const Doubles none = doubles_splat(0.0);
    const Balls unit = {{none, none, none}, doubles_splat(1.0)};
    primitives_ray(primitives, index, origin, direction, &to_object, centre, f, d);
    return roots_refine(f, d, 1.0 / lanes_dot(d, d), &unit, t);
}

// cone_point and cone_normal of each.
RT_ALWAYS_INLINE void cones_side(const PreparedPrimitive *primitives, DoublesMask index, DoublesMask side,
                                 Doubles own[3], Doubles normal[3])
{
    const Doubles zero = doubles_splat(0.0), one = doubles_splat(1.0);
    DoublesMask round = side == CONE_ROUND;
    Doubles ratio = primitives_gather(&primitives->data[0].x, index);
    Doubles radius = doubles_sqrt(own[0] * own[0] + own[1] * own[1]);
    Doubles factor = doubles_choose(radius > zero, (1.0 + (ratio - 1.0) * own[2]) / radius, one);
    own[0] = doubles_choose(round, factor * own[0], own[0]);
    own[1] = doubles_choose(round, factor * own[1], own[1]);
    own[2] = doubles_choose(round, own[2], doubles_choose(side == CONE_CAP, one, zero));
    radius = doubles_sqrt(own[0] * own[0] + own[1] * own[1]);
    DoublesMask wide = radius > zero, slopes = round & wide;
    normal[0] = doubles_choose(slopes, own[0] / radius, zero);
    normal[1] = doubles_choose(slopes, own[1] / radius, zero);
    Doubles flat = doubles_choose(round | (side == CONE_CAP), one, -one);
    normal[2] = doubles_choose(slopes, 1.0 - ratio, flat);
}

// box_point and box_normal of each.
RT_ALWAYS_INLINE void boxes_side(const PreparedPrimitive *primitives, DoublesMask index, DoublesMask side,
                                 Doubles own[3], Doubles normal[3])
{
    const Doubles zero = doubles_splat(0.0), one = doubles_splat(1.0);
    DoublesMask high = (side & 1) != 0;
    const double *lows = &primitives->data[0].x, *highs = &primitives->data[1].x;
    for (int axis = 0; axis < 3; axis++) {
        DoublesMask is_met = (side >> 1) == axis;
        Doubles bound =
            doubles_choose(high, primitives_gather(highs + axis, index), primitives_gather(lows + axis, index));
        own[axis] = doubles_choose(is_met, bound, own[axis]);
        normal[axis] = doubles_choose(is_met, doubles_choose(high, one, -one), zero);
    }
}

// torus_point and torus_normal of each.
RT_ALWAYS_INLINE void tori_side(const PreparedPrimitive *primitives, DoublesMask index, DoublesMask side,
                                Doubles own[3], Doubles normal[3])
{
    const Doubles zero = doubles_splat(0.0), one = doubles_splat(1.0);
    DoublesMask outer = side == TORUS_OUTER;
    Doubles major = primitives_gather(&primitives->data[0].x, index),
            minor = primitives_gather(&primitives->data[0].y, index);
    Doubles rho = doubles_sqrt(own[0] * own[0] + own[2] * own[2]), ring = doubles_choose(outer, major, -major);
    Doubles from = rho - ring, length = doubles_sqrt(from * from + own[1] * own[1]), share = minor / length;
    DoublesMask is_put = (rho > zero) & (length > zero);
    Doubles factor = (ring + from * share) / rho;
    own[0] = doubles_choose(is_put, factor * own[0], own[0]);
    own[1] = doubles_choose(is_put, own[1] * share, own[1]);
    own[2] = doubles_choose(is_put, factor * own[2], own[2]);
    rho = doubles_sqrt(own[0] * own[0] + own[2] * own[2]);
    DoublesMask is_off_axis = rho > zero;
    factor = doubles_choose(outer, rho - major, -(rho + major)) / rho;
    normal[0] = doubles_choose(is_off_axis, factor * own[0], zero);
    normal[1] = doubles_choose(outer, own[1], -own[1]);
    normal[2] = doubles_choose(is_off_axis, factor * own[2], zero);
    length = doubles_sqrt(lanes_dot(normal, normal));
    DoublesMask has_length = length > zero;
    Doubles shrink = 1.0 / length;
    normal[0] = doubles_choose(has_length, shrink * normal[0], zero);
    normal[1] = doubles_choose(has_length, shrink * normal[1], one);
    normal[2] = doubles_choose(has_length, shrink * normal[2], zero);
}

// flat_point and smooth_normal of each.
RT_ALWAYS_INLINE void smooth_triangles_side(const PreparedPrimitive *primitives, DoublesMask index, Doubles own[3],
                                            Doubles normal[3])
{
    Doubles corners[3][3];
    for (int corner = 0; corner < 3; corner++) {
        for (int axis = 0; axis < 3; axis++) {
            corners[corner][axis] = primitives_gather(&primitives->data[corner].x + axis, index);
        }
    }
    own[2] = doubles_splat(0.0);
    smooth_lanes(corners, own[0], own[1], normal);
}

// The point that is put onto the side, and the normal there, of the primitives' own class.
RT_ALWAYS_INLINE void primitives_side(const PreparedPrimitive *primitives, PrimitiveKind kind, DoublesMask index,
                                      DoublesMask side, Doubles own[3], Doubles normal[3])
{
    Doubles shrink;
    switch (kind) {
    case PRIMITIVE_SPHERE:
        shrink = 1.0 / doubles_sqrt(lanes_dot(own, own));
        for (int axis = 0; axis < 3; axis++) {
            normal[axis] = own[axis] = shrink * own[axis];
        }
        break;
    case PRIMITIVE_BOX:
        boxes_side(primitives, index, side, own, normal);
        break;
    case PRIMITIVE_CONE:
        cones_side(primitives, index, side, own, normal);
        break;
    case PRIMITIVE_TORUS:
        tori_side(primitives, index, side, own, normal);
        break;
    case PRIMITIVE_SMOOTH_TRIANGLE:
        smooth_triangles_side(primitives, index, own, normal);
        break;
    default:
        own[2] = normal[0] = normal[1] = doubles_splat(0.0);
        normal[2] = doubles_splat(1.0);
    }
}

// primitive_surface of each; all are of one kind, a constant of the caller.
RT_ALWAYS_INLINE void primitives_surface(const PreparedPrimitive *primitives, PrimitiveKind kind, DoublesMask index,
                                         DoublesMask side, const Doubles origin[3], const Doubles direction[3],
                                         Doubles t, Doubles point[3], Doubles normal[3])
{
    Linears to_object, to_world;
    Doubles centre[3], f[3], d[3], own[3], away[3], outward[3];
    primitives_ray(primitives, index, origin, direction, &to_object, centre, f, d);
    primitives_gather_linear(&primitives->to_world, index, &to_world);
    for (int axis = 0; axis < 3; axis++) {
        own[axis] = f[axis] + t * d[axis];
    }
    primitives_side(primitives, kind, index, side, own, outward);
    linears_direction(&to_world, own, away);
    linears_normal(&to_object, outward, normal);
    Doubles shrink = 1.0 / doubles_sqrt(lanes_dot(normal, normal));
    for (int axis = 0; axis < 3; axis++) {
        point[axis] = centre[axis] + away[axis];
        normal[axis] = shrink * normal[axis];
    }
}

#endif
