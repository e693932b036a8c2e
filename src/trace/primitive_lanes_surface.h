// Refined roots, points and normals of primitives that have tests in lanes, one for each ray: part of spheres_kernel.c.
//
// Bits are those of single rays: operations and their order are those of primitive_surface.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_PRIMITIVE_LANES_SURFACE_H
#define TRACE_PRIMITIVE_LANES_SURFACE_H

#include "trace/primitive_lanes.h"
#include "trace/sphere_rays.h"

// A member of some primitives; `first`: that of the first of the table.
RT_ALWAYS_INLINE Doubles primitives_gather(const double *first, DoublesMask index)
{
    return doubles_gather(first, index * (int64_t)sizeof(PreparedPrimitive));
}

RT_ALWAYS_INLINE Vec3s primitives_gather_vec3(const Vec3 *first, DoublesMask index)
{
    return vec3s(primitives_gather(&first->x, index), primitives_gather(&first->y, index),
                 primitives_gather(&first->z, index));
}

RT_ALWAYS_INLINE Linears primitives_gather_linear(const Linear *first, DoublesMask index)
{
    Linears all;
#pragma GCC unroll 3
    for (int row = 0; row < 3; row++) {
#pragma GCC unroll 3
        for (int column = 0; column < 3; column++) {
            all.m[row][column] = primitives_gather(&first->m[row][column], index);
        }
    }
    return all;
}

// The primitives of primitives.
RT_ALWAYS_INLINE DoublesMask parts_index(DoublesMask shapes)
{
    return (shapes & ((INT64_C(1) << SHAPE_INDEX_BITS) - 1)) >> PRIMITIVE_SIDE_BITS;
}

// Some rays in the space of a primitive each, and what leads there.
typedef struct PrimitivesRay {
    Linears to_object;
    Vec3s centre;
    Vec3s f, d;
} PrimitivesRay;

// primitive_ray of each.
RT_ALWAYS_INLINE PrimitivesRay primitives_ray(const PreparedPrimitive *primitives, DoublesMask index, Vec3s origin,
                                              Vec3s direction)
{
    PrimitivesRay ray = {primitives_gather_linear(&primitives->to_object, index),
                         primitives_gather_vec3(&primitives->centre, index), origin, direction};
    ray.f = linears_direction(&ray.to_object, vec3s_sub(origin, ray.centre));
    ray.d = linears_direction(&ray.to_object, direction);
    return ray;
}

// Refines roots, one of a ball for each ray. Returns those for which it is certain.
RT_ALWAYS_INLINE unsigned balls_refine(const PreparedPrimitive *primitives, DoublesMask index, Vec3s origin,
                                       Vec3s direction, Doubles *t)
{
    const Balls unit = {vec3s_splat(vec3(0.0, 0.0, 0.0)), doubles_splat(1.0)};
    PrimitivesRay ray = primitives_ray(primitives, index, origin, direction);
    SphereRays rays = sphere_rays_make(ray.f, ray.d);
    return spheres_step(&rays, &unit, t);
}

// cone_point and cone_normal of each.
RT_ALWAYS_INLINE void cones_side(const PreparedPrimitive *primitives, DoublesMask index, DoublesMask side,
                                 Vec3s *own, Vec3s *normal)
{
    const Doubles zero = doubles_splat(0.0), one = doubles_splat(1.0);
    DoublesMask round = side == CONE_ROUND;
    Doubles ratio = primitives_gather(&primitives->data[0].x, index);
    Doubles radius = doubles_sqrt(own->x * own->x + own->y * own->y);
    Doubles factor = doubles_choose(radius > zero, (1.0 + (ratio - 1.0) * own->z) / radius, one);
    own->x = doubles_choose(round, factor * own->x, own->x);
    own->y = doubles_choose(round, factor * own->y, own->y);
    own->z = doubles_choose(round, own->z, doubles_choose(side == CONE_CAP, one, zero));
    radius = doubles_sqrt(own->x * own->x + own->y * own->y);
    DoublesMask wide = radius > zero, slopes = round & wide;
    normal->x = doubles_choose(slopes, own->x / radius, zero);
    normal->y = doubles_choose(slopes, own->y / radius, zero);
    Doubles flat = doubles_choose(round | (side == CONE_CAP), one, -one);
    normal->z = doubles_choose(slopes, 1.0 - ratio, flat);
}

// box_point and box_normal of each.
RT_ALWAYS_INLINE void boxes_side(const PreparedPrimitive *primitives, DoublesMask index, DoublesMask side,
                                 Vec3s *own, Vec3s *normal)
{
    const Doubles zero = doubles_splat(0.0), one = doubles_splat(1.0);
    DoublesMask high = (side & 1) != 0;
    Vec3s bound = vec3s_choose(high, primitives_gather_vec3(&primitives->data[1], index),
                               primitives_gather_vec3(&primitives->data[0], index));
    Doubles outward = doubles_choose(high, one, -one);
    DoublesMask axis = side >> 1, along_x = axis == 0, along_y = axis == 1, along_z = axis == 2;
    *own = vec3s(doubles_choose(along_x, bound.x, own->x), doubles_choose(along_y, bound.y, own->y),
                 doubles_choose(along_z, bound.z, own->z));
    *normal = vec3s(doubles_choose(along_x, outward, zero), doubles_choose(along_y, outward, zero),
                    doubles_choose(along_z, outward, zero));
}

// torus_point and torus_normal of each.
RT_ALWAYS_INLINE void tori_side(const PreparedPrimitive *primitives, DoublesMask index, DoublesMask side,
                                Vec3s *own, Vec3s *normal)
{
    const Doubles zero = doubles_splat(0.0), one = doubles_splat(1.0);
    DoublesMask outer = side == TORUS_OUTER;
    Doubles major = primitives_gather(&primitives->data[0].x, index),
            minor = primitives_gather(&primitives->data[0].y, index);
    Doubles rho = doubles_sqrt(own->x * own->x + own->z * own->z), ring = doubles_choose(outer, major, -major);
    Doubles from = rho - ring, length = doubles_sqrt(from * from + own->y * own->y), share = minor / length;
    DoublesMask is_put = (rho > zero) & (length > zero);
    Doubles factor = (ring + from * share) / rho;
    own->x = doubles_choose(is_put, factor * own->x, own->x);
    own->y = doubles_choose(is_put, own->y * share, own->y);
    own->z = doubles_choose(is_put, factor * own->z, own->z);
    rho = doubles_sqrt(own->x * own->x + own->z * own->z);
    DoublesMask is_off_axis = rho > zero;
    factor = doubles_choose(outer, rho - major, -(rho + major)) / rho;
    normal->x = doubles_choose(is_off_axis, factor * own->x, zero);
    normal->y = doubles_choose(outer, own->y, -own->y);
    normal->z = doubles_choose(is_off_axis, factor * own->z, zero);
    length = doubles_sqrt(vec3s_dot(*normal, *normal));
    DoublesMask has_length = length > zero;
    Doubles shrink = 1.0 / length;
    normal->x = doubles_choose(has_length, shrink * normal->x, zero);
    normal->y = doubles_choose(has_length, shrink * normal->y, one);
    normal->z = doubles_choose(has_length, shrink * normal->z, zero);
}

// flat_point and smooth_normal of each.
RT_ALWAYS_INLINE void smooth_triangles_side(const PreparedPrimitive *primitives, DoublesMask index, Vec3s *own,
                                            Vec3s *normal)
{
    const Vec3s corners[3] = {primitives_gather_vec3(&primitives->data[0], index),
                              primitives_gather_vec3(&primitives->data[1], index),
                              primitives_gather_vec3(&primitives->data[2], index)};
    own->z = doubles_splat(0.0);
    *normal = smooth_lanes(corners, own->x, own->y);
}

// The point that is put onto the side, and the normal there, of the primitives' own class.
RT_ALWAYS_INLINE void primitives_side(const PreparedPrimitive *primitives, PrimitiveKind kind, DoublesMask index,
                                      DoublesMask side, Vec3s *own, Vec3s *normal)
{
    switch (kind) {
    case PRIMITIVE_SPHERE:
        *normal = *own = vec3s_normalize(*own);
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
        own->z = doubles_splat(0.0);
        *normal = vec3s_splat(vec3(0.0, 0.0, 1.0));
    }
}

// Places on surfaces.
typedef struct PlaceLanes {
    Vec3s point, normal;
} PlaceLanes;

// primitive_surface of each; all are of one kind, a constant of the caller.
RT_ALWAYS_INLINE void primitives_surface(const PreparedPrimitive *primitives, PrimitiveKind kind, DoublesMask index,
                                         DoublesMask side, const PrimitivesRay *ray, Doubles t, PlaceLanes *place)
{
    Linears to_world = primitives_gather_linear(&primitives->to_world, index);
    Vec3s own = vec3s_add_scaled(ray->f, t, ray->d), outward;
    primitives_side(primitives, kind, index, side, &own, &outward);
    place->point = vec3s_add(ray->centre, linears_direction(&to_world, own));
    place->normal = vec3s_normalize(linears_normal(&ray->to_object, outward));
}

#endif
