// Rays that continue from surfaces against few spheres and a plane: part of spheres_kernel.c.
//
// Some rays at once against one sphere after the other, by the arithmetic of single rays (trace/sphere.inc). A ray for which one of them is uncertain, or two are about equally near, is left to be asked by
// itself.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERES_SECONDARY_H
#define TRACE_SPHERES_SECONDARY_H

#include "trace/plane.h"
#include "trace/simd.h"
#include "trace/spheres.h"
#include "trace/sphere_rays.h"

// A vector of rays, and what they have met so far.
typedef struct SecondaryVector {
    SphereRays rays;
    Doubles t;                  // INFINITY where nothing is met
    DoublesMask shape;          // ShapeId
    DoublesMask inside, is_open; // -1 where it is; the ray is to be asked by itself
    DoublesMask is_approximate;  // t is sphere_test's, to be refined
} SecondaryVector;

// Slots of all spheres; some of the last may be empty.
static uint32_t few_slots(const SphereTable *table)
{
    return table->bvh.nodes ? table->block_count * SPHERE_BLOCK : table->loose_count;
}

// Rays that start on each of the spheres, or on one equal to it.
static void secondary_starts(const SphereTable *table, const ShapeId *start, int count,
                             uint64_t starts[SPHERES_FEW_MOST])
{
    uint64_t own[SPHERES_FEW_MOST];
    uint32_t slots = few_slots(table);
    memset(own, 0, slots * sizeof *own);
    for (int i = 0; i < count; i++) {
        if (start[i] != SHAPE_NONE && shape_kind(start[i]) == SHAPE_SPHERE) {
            own[shape_index(start[i])] |= UINT64_C(1) << i;
        }
    }
    memcpy(starts, own, slots * sizeof *own);
    for (uint32_t j = 0; j < slots; j++) {
        SphereData other = sphere_table_ball(table, j);
        for (uint32_t i = 0; own[j] && i < slots; i++) {
            SphereData ball = sphere_table_ball(table, i);
            starts[i] |= sphere_data_equal(&ball, &other) ? own[j] : 0;
        }
    }
}

// False when one of the rays is not usable.
RT_ALWAYS_INLINE bool secondary_load(SecondaryVector *v, const SecondaryRays *rays, int at)
{
    v->rays = sphere_rays_make(vec3s_load(rays->origin, at), vec3s_load(rays->direction, at));
    v->t = doubles_splat((double)INFINITY);
    v->shape = (DoublesMask){0} + (int64_t)SHAPE_NONE;
    v->inside = v->is_open = v->is_approximate = (DoublesMask){0};
    unsigned usable = doubles_gt(v->rays.inverse_square, doubles_splat(0x1p-100)) &
                      doubles_gt(doubles_splat((double)INFINITY), v->rays.inverse_square);
    return usable == (1u << DOUBLES) - 1;
}

// Rays into the spheres that they start on, whose other side they meet: sphere_root_inward.
RT_ALWAYS_INLINE void secondary_inward(const SphereTable *table, const SecondaryRays *rays, int at, SecondaryVector *v)
{
    _Alignas(64) double centre[3][DOUBLES];
    DoublesMask into = {0}, shape = {0};
    for (int i = 0; i < DOUBLES; i++) {
        int ray = at + i < rays->count ? at + i : rays->count - 1;
        ShapeId start = rays->start[ray];
        bool is_inward = (rays->inward >> ray & 1) && start != SHAPE_NONE && shape_kind(start) == SHAPE_SPHERE;
        SphereData ball = is_inward ? sphere_table_ball(table, shape_index(start)) : (SphereData){{0.0, 0.0, 0.0}, 0.0};
        into[i] = is_inward ? -1 : 0;
        shape[i] = (int64_t)start;
        centre[0][i] = ball.centre.x;
        centre[1][i] = ball.centre.y;
        centre[2][i] = ball.centre.z;
    }
    const Balls balls = {vec3s_load(centre, 0), doubles_splat(0.0)};
    Doubles root = spheres_root_inward(&v->rays, &balls);
    DoublesMask met = into & (root > 0.0) & (root < (double)INFINITY);
    v->t = doubles_choose(met, root, v->t);
    v->shape = (met & shape) | (~met & v->shape);
    v->inside = met;
}

// One sphere. The rays of `starts` leave it, or go into it.
RT_ALWAYS_INLINE void secondary_sphere(SecondaryVector *v, const SphereData *ball, uint32_t slot, unsigned starts)
{
    Vec3s f = vec3s_sub(v->rays.origin, vec3s_splat(ball->centre));
    Doubles t_middle, discriminant = spheres_discriminant(&v->rays, f, doubles_splat(ball->radius_squared), &t_middle);
    Doubles f_squared = vec3s_length_squared(f);
    Doubles sum = f_squared + ball->radius_squared;
    Doubles rounding = -SPHERE_ROUNDING * sum;
    if (!(doubles_ge(discriminant, rounding) & ~starts)) {
        return;
    }
    Doubles c = f_squared - ball->radius_squared;
    Doubles uncertainty = SPHERE_UNCERTAINTY * sum;
    Doubles root = spheres_root(t_middle, discriminant, c, v->rays.inverse_square);
    DoublesMask possible = (discriminant >= rounding) & ((t_middle >= 0.0) | ~(c >= uncertainty));
    possible = starts ? possible & ~doubles_bits_mask(starts) : possible;
    DoublesMask certain = (discriminant >= uncertainty) & (doubles_abs(c) >= uncertainty);
    DoublesMask nearest = possible & certain & ~(root >= v->t * (1.0 - SPHERE_ROOT_SLACK)) & (root > 0.0);
    v->is_open |= possible & ~nearest & (~certain | (v->t + SPHERE_ROOT_SLACK * v->t >= root));
    v->t = doubles_choose(nearest, root, v->t);
    v->shape = (nearest & (int64_t)shape_id(SHAPE_SPHERE, slot)) | (~nearest & v->shape);
    v->inside = (nearest & (c < 0.0)) | (~nearest & v->inside);
    v->is_approximate |= nearest;
}

// Makes the roots right.
static void secondary_refine(const SphereTable *table, SecondaryVector *v)
{
    DoublesMask met = v->is_approximate;
    unsigned any = doubles_mask_bits(met);
    if (!any) {
        return;
    }
    Balls balls = balls_gather(table, (met & v->shape) | (~met & v->shape[__builtin_ctz(any)]));
    Doubles t = v->t;
    unsigned certain = spheres_step(&v->rays, &balls, &t);
    v->t = doubles_choose(met, t, v->t);
    v->is_open |= any & ~certain ? met & ~doubles_bits_mask(certain) : (DoublesMask){0};
}

// A plane. The rays of `starts` leave it.
RT_ALWAYS_INLINE void secondary_plane(SecondaryVector *v, const PlaneShape *plane, ShapeId shape, unsigned starts)
{
    Vec3s n = vec3s_splat(plane->normal);
    Doubles along = vec3s_dot(n, v->rays.direction);
    Doubles root = (plane->distance - vec3s_dot(n, v->rays.origin)) / along;
    DoublesMask ahead = root > 0.0;
    ahead = starts ? ahead & ~doubles_bits_mask(starts) : ahead;
    DoublesMask nearer = ahead & (root < v->t);
    v->is_open |= ahead & (root == v->t) & (root < (double)INFINITY);
    v->t = doubles_choose(nearer, root, v->t);
    v->shape = (nearer & (int64_t)shape) | (~nearer & v->shape);
    v->inside = (nearer & (along > 0.0)) | (~nearer & v->inside);
}

// Fills the last vector up with copies of its last ray.
static void secondary_fill(SecondaryRays *rays)
{
    for (int i = rays->count; i % DOUBLES != 0; i++) {
        for (int axis = 0; axis < 3; axis++) {
            rays->origin[axis][i] = rays->origin[axis][rays->count - 1];
            rays->direction[axis][i] = rays->direction[axis][rays->count - 1];
        }
    }
}

static uint64_t closest_secondary(const SphereTable *table, const PlaneShape *plane, ShapeId plane_shape,
                                  SecondaryRays *rays, TileHits *hits)
{
    uint64_t starts[SPHERES_FEW_MOST], on_plane = 0, is_open = 0;
    uint32_t slots = few_slots(table);
    secondary_starts(table, rays->start, rays->count, starts);
    secondary_fill(rays);
    for (int i = 0; plane && i < rays->count; i++) {
        on_plane |= (uint64_t)(rays->start[i] == plane_shape) << i;
    }
    hits->met = hits->inside = 0;
    for (int at = 0; at < rays->count; at += DOUBLES) {
        const unsigned all = (1u << DOUBLES) - 1;
        SecondaryVector v;
        if (!secondary_load(&v, rays, at)) {
            is_open |= (uint64_t)all << at;
            continue;
        }
        if (rays->inward >> at & all) {
            secondary_inward(table, rays, at, &v);
        }
        for (uint32_t i = 0; i < slots; i++) {
            SphereData ball = sphere_table_ball(table, i);
            if (isnan(ball.radius_squared)) {
                continue;
            }
            secondary_sphere(&v, &ball, i, (unsigned)(starts[i] >> at) & all);
        }
        secondary_refine(table, &v);
        if (plane) {
            secondary_plane(&v, plane, plane_shape, (unsigned)(on_plane >> at) & all);
        }
        doubles_store(&hits->t[at], v.t);
        for (int i = 0; i < DOUBLES; i++) {
            hits->shape[at + i] = (ShapeId)v.shape[i];
        }
        is_open |= (uint64_t)doubles_mask_bits(v.is_open) << at;
        hits->met |= (uint64_t)doubles_mask_bits(v.t < (double)INFINITY) << at;
        hits->inside |= (uint64_t)doubles_mask_bits(v.inside) << at;
    }
    uint64_t decided = ~is_open & ~UINT64_C(0) >> (TILE_RAYS - rays->count);
    hits->met &= decided;
    hits->inside &= decided;
    return decided;
}

#endif
