// Rays that all end at or about one point, which something may be in the way of: part of spheres_kernel.c.
//
// Seen from that point, a light, they are a beam through the tree, whose boxes begin with those next to the light. Rays
// that end beside it are never farther from that beam than their ends. What the leaves hold is narrowed by a cone, whose
// margin is far above what rounding does to the ends of rays.
// What is left is tested against some rays at once, each from its own origin, by the arithmetic of single rays
// (trace/sphere.inc).
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERES_GROUP_H
#define TRACE_SPHERES_GROUP_H

#include "trace/bvh_walk.h"
#include "trace/cone_test.h"
#include "trace/simd.h"
#include "trace/sphere_rays.h"
#include "trace/spheres.h"

enum {
    GROUP_LEAST = 3,  // fewer rays are traced one by one
    GROUP_BLOCKS = 4, // for each ray; where a wide group meets more, its rays are traced one by one, too
};

// Rays from one shape; all arrays are filled up to a whole vector.
typedef struct RayGroup {
    Vec3 end;
    double end_radius, farthest; // of the rays' ends from there; of their starts
    SphereData start;       // equals none where they do not start on a sphere
    unsigned count, whole;
    _Alignas(64) double origin[3][TILE_RAYS];
    _Alignas(64) double direction[3][TILE_RAYS]; // of about unit length, towards the end
    _Alignas(64) double seen[3][TILE_RAYS];      // of about unit length, from the end to their starts
    _Alignas(64) double distance[TILE_RAYS];
    _Alignas(64) double inverse_square[TILE_RAYS]; // as in SphereRay
} RayGroup;

static SphereRay group_ray(const RayGroup *group, unsigned i)
{
    return sphere_ray_make(vec3(group->origin[0][i], group->origin[1][i], group->origin[2][i]),
                           vec3(group->direction[0][i], group->direction[1][i], group->direction[2][i]));
}

// Those of a vector's rays that meet the sphere before they end.
RT_ALWAYS_INLINE unsigned group_test(const RayGroup *group, const SphereData *ball, unsigned at)
{
    SphereRays rays = sphere_rays_of(vec3s_load(group->origin, at), vec3s_load(group->direction, at),
                                     doubles_load(&group->inverse_square[at]));
    Vec3s f = vec3s_sub(rays.origin, vec3s_splat(ball->centre));
    Doubles t_middle, discriminant = spheres_discriminant(&rays, f, doubles_splat(ball->radius_squared), &t_middle);
    Doubles f_squared = vec3s_length_squared(f);
    Doubles sum = f_squared + ball->radius_squared;
    unsigned possible = doubles_ge(discriminant, -SPHERE_ROUNDING * sum);
    if (!possible) {
        return 0;
    }
    Doubles c = f_squared - ball->radius_squared;
    Doubles uncertainty = SPHERE_UNCERTAINTY * sum;
    Doubles ends = doubles_load(&group->distance[at]);
    Doubles root = spheres_root(t_middle, discriminant, c, rays.inverse_square);
    possible &= doubles_ge(t_middle, doubles_splat(0.0)) | ~doubles_ge(c, uncertainty);
    unsigned certain = doubles_ge(discriminant, uncertainty) & doubles_ge(doubles_abs(c), uncertainty);
    unsigned before = ~doubles_ge(root, ends * (1.0 - SPHERE_ROOT_SLACK)); // as sphere_root_is_before says at once
    unsigned met = possible & certain & before;
    unsigned open = possible & ~met & (~certain | doubles_ge(ends + SPHERE_ROOT_SLACK * ends, root));
    for (; RT_UNLIKELY(open); open &= open - 1) {
        unsigned i = (unsigned)__builtin_ctz(open);
        SphereRay ray = group_ray(group, at + i);
        bool inside;
        double end = group->distance[at + i];
        double t = certain >> i & 1 ? sphere_refine(&ray, ball, root[i])
                                    : sphere_exact(&ray, ball, &group->start, &inside);
        met |= (unsigned)(t < end && (t > 0.0 || certain >> i & 1)) << i;
    }
    return met;
}

// The rays of the group that what is in a leaf is in the way of, with those that are known to be `occluded`. `context`
// is the caller's.
typedef uint64_t GroupLeaf(const void *context, const RayGroup *group, const RayCone *cone, uint32_t leaf,
                           uint64_t occluded);

// Of a block's spheres; the context is their table.
static uint64_t group_block(const void *context, const RayGroup *group, const RayCone *cone, uint32_t block,
                            uint64_t occluded)
{
    const SphereTable *table = context;
    unsigned touched = cone_spheres(cone, &table->blocks[block]);
    for (; touched; touched &= touched - 1) {
        SphereData ball = sphere_table_ball(table, block * SPHERE_BLOCK + (unsigned)__builtin_ctz(touched));
        if (sphere_data_equal(&ball, &group->start)) {
            continue;
        }
        for (unsigned at = 0; at < group->whole; at += DOUBLES) {
            if (~occluded >> at & ((1u << DOUBLES) - 1)) {
                occluded |= (uint64_t)group_test(group, &ball, at) << at;
            }
        }
    }
    return occluded;
}

// A tree and what its leaves are.
typedef struct GroupTree {
    const Bvh *bvh;
    const char *fetched; // as BvhWalk's leaves
    GroupLeaf *leaf;
    const void *context;
    unsigned leaves; // for each ray, before they are traced one by one
} GroupTree;

// What one walk meets, of directions in an octant, before `leaves` are used up; false when they are.
RT_ALWAYS_INLINE bool group_walk(const GroupTree *tree, const RayGroup *group, const RayCone *cone, BvhWalk *walk,
                                 unsigned *leaves, uint64_t *occluded)
{
    BvhChild leaf;
    walk->leaves = tree->fetched;
    float limit = bvh_walk_limit(walk, group->farthest);
    while (~*occluded && bvh_walk_next(walk, limit, &leaf)) {
        if ((*leaves)-- == 0) {
            return false;
        }
        *occluded = tree->leaf(tree->context, group, cone, leaf & ~BVH_LEAF, *occluded);
    }
    return true;
}

// What is in the tree: a walk for each octant in which the rays start, as seen from their end. False when the group
// cannot walk it, or had better not.
RT_ALWAYS_INLINE bool group_tree(const GroupTree *tree, const RayGroup *group, const RayCone *cone, uint64_t *occluded)
{
    DirectionRange range;
    unsigned leaves = tree->leaves * group->count;
    direction_range(group->seen, group->whole, &range);
    for (unsigned octant = 0; octant < OCTANTS && ~*occluded; octant++) {
        BvhWalk walk;
        Vec3 least, greatest;
        bool is_too_far;
        if (!direction_octant(&range, octant, &least, &greatest)) {
            continue;
        }
        if (!bvh_walk_start_beam(&walk, tree->bvh, group->end, group->end_radius, least, greatest, &is_too_far)) {
            if (is_too_far) {
                return false;
            }
        } else if (!group_walk(tree, group, cone, &walk, &leaves, occluded)) {
            return false;
        }
    }
    return true;
}

// The bits of no ray.
static uint64_t group_none(const RayGroup *group)
{
    return ~(~UINT64_C(0) >> (TILE_RAYS - group->count));
}

// Those of the group that a sphere is before; false when they cannot be traced together.
static bool group_occluded(const SphereTable *table, const RayGroup *group, uint64_t *occluded)
{
    unsigned middle = group->count / 2, last = group->count - 1;
    RayCone cone = {.origin = group->end, .end_radius = group->end_radius};
    cone.axis = vec3_normalize(vec3(group->seen[0][0] + group->seen[0][middle] + group->seen[0][last],
                                    group->seen[1][0] + group->seen[1][middle] + group->seen[1][last],
                                    group->seen[2][0] + group->seen[2][middle] + group->seen[2][last]));
    cone.spread = cone_spread(group->seen, 0, group->whole, cone.axis);
    uint64_t none = group_none(group);
    const GroupTree tree = {&table->bvh, (const char *)table->blocks, group_block, table, GROUP_BLOCKS};
    *occluded = table->loose_count > 0 ? group_block(table, group, &cone, 0, none) : none;
    if (table->bvh.nodes && ~*occluded && !group_tree(&tree, group, &cone, occluded)) {
        return false;
    }
    *occluded &= ~none;
    return true;
}

// What depends on directions alone; false when one of them is not usable.
static bool group_look(RayGroup *group)
{
    const Vec3s end = vec3s_splat(group->end);
    unsigned usable = ~0u;
    Doubles farthest = doubles_splat(0.0);
    for (unsigned i = 0; i < group->whole; i += DOUBLES) {
        Vec3s away = vec3s_sub(vec3s_load(group->origin, i), end);
        Doubles inverse_square = 1.0 / vec3s_length_squared(vec3s_load(group->direction, i));
        Doubles distance = vec3s_length(away);
        vec3s_store(group->seen, i, vec3s_scale(1.0 / distance, away));
        doubles_store(&group->inverse_square[i], inverse_square);
        usable &= doubles_gt(inverse_square, doubles_splat(0x1p-100)) &
                  doubles_gt(doubles_splat((double)INFINITY), inverse_square) &
                  doubles_gt(distance, doubles_splat(0x1p-480)) & doubles_gt(doubles_splat(0x1p480), distance);
        farthest = doubles_max(distance, farthest);
    }
    group->farthest = doubles_greatest(farthest);
    return usable == (1u << DOUBLES) - 1;
}

// The rays of some surfaces, which share a shape; false when one of them is not usable.
static bool group_gather(const TileSurfaces *from, const SurfaceRays *rays, uint64_t members, RayGroup *group)
{
    group->end = rays->end;
    group->end_radius = rays->end_radius;
    unsigned count = 0, last = 0;
    for (; members || count % DOUBLES != 0; members &= members - 1, count++) {
        last = members ? (unsigned)__builtin_ctzll(members) : last;
        group->count = members ? count + 1 : group->count;
        for (int axis = 0; axis < 3; axis++) {
            group->origin[axis][count] = from->point[axis][last];
            group->direction[axis][count] = rays->towards[axis][last];
        }
        group->distance[count] = rays->distance[last];
    }
    group->whole = count;
    return group_look(group);
}

// The surfaces that have the shape of one of them, a bit for each.
static uint64_t surfaces_alike(const TileSurfaces *from, ShapeId shape)
{
    uint64_t alike = 0;
    for (int i = 0; i < from->count; i += FLOATS) {
        alike |= (uint64_t)ints_equal(&from->shape[i], shape) << i;
    }
    return alike;
}

// Those that leave their shape inward, if only by rounding.
static uint64_t surfaces_inward(const TileSurfaces *from, const SurfaceRays *rays)
{
    uint64_t inward = 0;
    for (int i = 0; i < from->count; i += DOUBLES) {
        Doubles along = vec3s_dot(vec3s_load(from->outward, i), vec3s_load(rays->towards, i));
        inward |= (uint64_t)doubles_gt(doubles_splat(0.0), along) << i;
    }
    return inward;
}

// A bit of each ray of a group as that of its surface.
static uint64_t group_spread(uint64_t bits, uint64_t members)
{
    uint64_t all = 0;
    for (; members; members &= members - 1, bits >>= 1) {
        all |= (bits & 1) << __builtin_ctzll(members);
    }
    return all;
}

static uint64_t surfaces_occluded(const SphereTable *table, const TileSurfaces *from, const SurfaceRays *rays,
                                  uint64_t asked, uint64_t *left)
{
    RayGroup group;
    uint64_t all = 0;
    *left = asked & surfaces_inward(from, rays);
    for (uint64_t rest = asked & ~*left; rest;) {
        uint64_t members = rest & surfaces_alike(from, from->shape[__builtin_ctzll(rest)]), occluded;
        rest &= ~members;
        ShapeId shape = from->shape[__builtin_ctzll(members)];
        group.start = shape_kind(shape) == SHAPE_SPHERE ? sphere_table_ball(table, shape_index(shape))
                                                        : (SphereData){{0.0, 0.0, 0.0}, (double)NAN};
        if (__builtin_popcountll(members) < GROUP_LEAST || !group_gather(from, rays, members, &group) ||
            !group_occluded(table, &group, &occluded)) {
            *left |= members;
            continue;
        }
        all |= group_spread(occluded, members);
    }
    return all;
}

#endif
