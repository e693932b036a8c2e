// Rays against the spheres: compiled once for each instruction set, with ISA_NAME the name of the table.
//
// A leaf is a block of eight spheres, tested at once in doubles, with the verdicts and roots of sphere_test in vectors of
// any width.
//
// SPDX-License-Identifier: MIT
#include "base/isa.h"
#include "trace/bvh_walk.h"
#include "trace/plane_tile.h"
#include "trace/shapes_group.h"
#include "trace/shapes_surface.h"
#include "trace/shapes_tile.h"
#include "trace/shapes_walk.h"
#include "trace/simd.h"
#include "trace/spheres.h"
#include "trace/spheres_crossed.h"
#include "trace/spheres_group.h"
#include "trace/spheres_secondary.h"
#include "trace/spheres_surface.h"
#include "trace/spheres_tile.h"

// A vector that was stored just now, and not as one: read back as one it would be waited for.
RT_ALWAYS_INLINE Vec3 by_parts(const Vec3 *a)
{
    const volatile Vec3 *parts = a;
    return vec3(parts->x, parts->y, parts->z);
}

enum { HALVES = SPHERE_BLOCK / DOUBLES };

// What the test of a block finds of its eight spheres.
typedef struct BlockHits {
    _Alignas(64) double t[SPHERE_BLOCK]; // approximate roots
    unsigned met;                        // by a root no later than the limit, or uncertain
    unsigned uncertain;
    unsigned inside;
} BlockHits;

// The sphere that a ray starts on.
typedef struct BlockStart {
    uint32_t slot; // SLOT_NONE: none
    SphereData ball; // equals none then
} BlockStart;

RT_ALWAYS_INLINE BlockStart block_start(const SphereTable *table, uint32_t slot)
{
    return (BlockStart){slot, slot == SLOT_NONE ? (SphereData){{0.0, 0.0, 0.0}, (double)NAN}
                                                : sphere_table_ball(table, slot)};
}

// All of a block but that sphere, a bit for each.
RT_ALWAYS_INLINE unsigned block_others(uint32_t block, const BlockStart *start)
{
    return start->slot / SPHERE_BLOCK == block ? ~(1u << start->slot % SPHERE_BLOCK) : ~0u;
}

// sphere_test eight times over, of the spheres asked for. False when all are missed.
RT_ALWAYS_INLINE bool block_test(const SphereBlock *block, const SphereRay *ray, unsigned asked, double limit,
                                 BlockHits *hits)
{
    const SphereRays rays = sphere_rays_splat(ray);
    Doubles discriminant[HALVES], t_middle[HALVES], f_squared[HALVES], sum[HALVES];
    unsigned possible = 0;
#pragma GCC unroll 4
    for (int i = 0; i < HALVES; i++) {
        Balls balls = balls_load(block, (uint32_t)i * DOUBLES);
        Vec3s f = vec3s_sub(rays.origin, balls.centre);
        discriminant[i] = spheres_discriminant(&rays, f, balls.radius_squared, &t_middle[i]);
        f_squared[i] = vec3s_length_squared(f);
        sum[i] = f_squared[i] + balls.radius_squared;
        possible |= doubles_ge(discriminant[i], -SPHERE_ROUNDING * sum[i]) << (i * DOUBLES);
    }
    possible &= asked;
    if (!possible) {
        return false;
    }
    unsigned certain = 0, in_time = 0, ahead = 0, outer = 0;
#pragma GCC unroll 4
    for (int i = 0; i < HALVES; i++) {
        Doubles c = f_squared[i] - doubles_load(&block->radius_squared[i * DOUBLES]);
        Doubles uncertainty = SPHERE_UNCERTAINTY * sum[i];
        Doubles t = spheres_root(t_middle[i], discriminant[i], c, rays.inverse_square);
        doubles_store(&hits->t[i * DOUBLES], t);
        certain |= (doubles_ge(discriminant[i], uncertainty) & doubles_ge(doubles_abs(c), uncertainty))
                   << (i * DOUBLES);
        outer |= doubles_ge(c, uncertainty) << (i * DOUBLES);
        ahead |= doubles_ge(t_middle[i], doubles_splat(0.0)) << (i * DOUBLES);
        in_time |= doubles_ge(doubles_splat(limit), t) << (i * DOUBLES);
    }
    possible &= ahead | ~outer;
    hits->uncertain = possible & ~certain;
    hits->met = possible & (in_time | ~certain);
    hits->inside = ~outer;
    return hits->met != 0;
}

// Brings `nearest` up to date with a block. False when all its spheres are missed.
RT_ALWAYS_INLINE bool block_closest(const SphereTable *table, uint32_t block, const SphereRay *ray,
                                    const BlockStart *start, double limit, Nearest *nearest)
{
    BlockHits hits;
    if (!block_test(&table->blocks[block], ray, block_others(block, start), limit, &hits)) {
        return false;
    }
    do {
        unsigned at = (unsigned)__builtin_ctz(hits.met);
        hits.met &= hits.met - 1;
        uint32_t slot = block * SPHERE_BLOCK + at;
        SphereRoot root = {slot, sphere_table_ball(table, slot), hits.t[at], hits.inside >> at & 1,
                           !(hits.uncertain >> at & 1)};
        if (sphere_data_equal(&root.ball, &start->ball)) {
            continue;
        }
        if (RT_UNLIKELY(!root.is_approximate)) {
            root.t = sphere_exact(ray, &root.ball, &start->ball, &root.inside);
        }
        nearest_offer_sphere(table, ray, &root, nearest);
    } while (hits.met);
    return true;
}

RT_ALWAYS_INLINE bool block_occludes(const SphereTable *table, uint32_t block, const SphereRay *ray,
                                     const BlockStart *start, double limit, double t_max)
{
    BlockHits hits;
    if (!block_test(&table->blocks[block], ray, block_others(block, start), limit, &hits)) {
        return false;
    }
    do {
        unsigned at = (unsigned)__builtin_ctz(hits.met);
        hits.met &= hits.met - 1;
        SphereData ball = sphere_table_ball(table, block * SPHERE_BLOCK + at);
        bool inside;
        if (sphere_data_equal(&ball, &start->ball)) {
            continue;
        }
        if (RT_UNLIKELY(hits.uncertain >> at & 1)) {
            double t = sphere_exact(ray, &ball, &start->ball, &inside);
            if (t > 0.0 && t < t_max) {
                return true;
            }
        } else if (sphere_root_is_before(ray, &ball, hits.t[at], t_max)) {
            return true;
        }
    } while (hits.met);
    return false;
}

static void spheres_closest(const SphereTable *table, const SphereRay *ray, uint32_t start_slot, Nearest *nearest)
{
    BvhWalk walk;
    BvhChild leaf;
    const BlockStart start = block_start(table, start_slot);
    double limit = nearest_limit(nearest->hit.t);
    if (table->loose_count > 0 && block_closest(table, 0, ray, &start, limit, nearest)) {
        limit = nearest_limit(nearest->hit.t);
    }
    if (table->bvh.nodes && bvh_walk_start(&walk, &table->bvh, by_parts(&ray->origin), by_parts(&ray->direction))) {
        walk.leaves = (const char *)table->blocks;
        float tree_limit = bvh_walk_limit(&walk, limit);
        while (bvh_walk_next(&walk, tree_limit, &leaf)) {
            if (block_closest(table, leaf & ~BVH_LEAF, ray, &start, limit, nearest)) {
                limit = nearest_limit(nearest->hit.t);
                tree_limit = bvh_walk_limit(&walk, limit);
            }
        }
    }
    nearest_refine(table, ray, nearest); // here, where the processor may have a fused multiply-add
}

static bool spheres_occluded(const SphereTable *table, const SphereRay *ray, uint32_t start_slot, double t_max)
{
    BvhWalk walk;
    BvhChild leaf;
    const BlockStart start = block_start(table, start_slot);
    double limit = nearest_limit(t_max);
    if (table->loose_count > 0 && block_occludes(table, 0, ray, &start, limit, t_max)) {
        return true;
    }
    if (!table->bvh.nodes || !bvh_walk_start(&walk, &table->bvh, by_parts(&ray->origin), by_parts(&ray->direction))) {
        return false;
    }
    walk.leaves = (const char *)table->blocks;
    float tree_limit = bvh_walk_limit(&walk, limit);
    while (bvh_walk_next(&walk, tree_limit, &leaf)) {
        if (block_occludes(table, leaf & ~BVH_LEAF, ray, &start, limit, t_max)) {
            return true;
        }
    }
    return false;
}

extern const SphereKernels ISA_NAMED(sphere_kernels_);
const SphereKernels ISA_NAMED(sphere_kernels_) = {
    .name = ISA_TEXT,
    .is_supported = isa_is_supported,
    .closest = spheres_closest,
    .occluded = spheres_occluded,
    .closest_tile = tile_closest,
    .surfaces = surfaces_sphere,
    .closest_secondary = closest_secondary,
    .surfaces_secondary = surfaces_secondary,
    .occluded_surfaces = surfaces_occluded,
    .crossed = spheres_crossed,
    .ray_crossed = ray_crossed,
    .plane_closest = plane_closest,
    .plane_foremost = plane_foremost,
    .plane_occluded = plane_occluded,
    .view_tile = view_tile,
    .view_passes = view_passes,
    .shapes_closest = shapes_closest,
    .shapes_closest_tile = shapes_closest_tile,
    .shapes_occluded = shapes_occluded,
    .shapes_occluded_surfaces = shapes_occluded_surfaces,
    .shapes_surfaces = shapes_surfaces,
    .shape_blocks = shape_blocks,
};
