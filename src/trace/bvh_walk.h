// The leaves of a tree along a ray, nearest first, inline so that each user's loop is compiled with its own test.
//
// Boxes are tested eight at a time in float. What float cannot say is made up for once a ray: see bvh_walk_start. The
// walk is conservative only; what is met is for the caller's test to say.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_BVH_WALK_H
#define TRACE_BVH_WALK_H

#include <float.h>

#include "math/ray.h"
#include "trace/bvh.h"
#include "trace/simd.h"

enum { BVH_STACK = BVH_DEPTH_MOST * (BVH_WIDTH - 1) + BVH_WIDTH };

typedef struct BvhWalk {
    const BvhNode *nodes;
    double scale, skipped; // distance in the tree = parameter of the ray * scale - skipped
    // Axis; near, far: distance of a plane = (plane - origin) * inverse.
    float origin[3][2], inverse[3][2];
    unsigned near_side[3];    // 1 when the ray meets the high plane of an axis first
    unsigned waiting;
    uint64_t stack[BVH_STACK]; // bits of the distance above, child below: distances are >= 0, so they order as integers
} BvhWalk;

// Distances as they are compared: never too small by rounding.
RT_ALWAYS_INLINE float bvh_walk_limit(const BvhWalk *walk, double t_max)
{
    double limit = t_max * walk->scale - walk->skipped;
    return (float)(limit + fabs(limit) * 0x1p-22);
}

// Begins a walk from p(0) on. The direction is about of unit length.
//
// Let D be the greatest coordinate difference between the origin and a point of the tree, in tree coordinates, u = 2^-53,
// and D' the greatest coordinate of the origin after it has been moved up to the tree along the ray. Planes are moved
// outward by 32 u D + 2^-22 D', to cover
//   in u D:     3 for a point reported at a t that is off by an ulp; 3 for centre ± radius in tree coordinates; 1 for the
//               origin there and 5 for moving it; the rest is spare
//   in 2^-24 D': 1 for the origin's conversion to float; the rest is spare
// and distances are multiplied by 1 ∓ 2^-21, where plane - origin, 1/direction and their product are each off by 2^-24.
// A direction's component below 2^-60 is taken for 2^-60: over the length of the tree that is less than 32 u D.
// (T. Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013, with all of it done once a ray instead of once a box.)
// False when the ray cannot meet the tree.
RT_ALWAYS_INLINE bool bvh_walk_start(BvhWalk *walk, const Bvh *bvh, Vec3 origin, Vec3 direction)
{
    const double u = DBL_EPSILON / 2;
    Vec3 from = vec3_scale(bvh->scale, vec3_sub(origin, bvh->centre));
    const double d[3] = {direction.x, direction.y, direction.z};
    const double half[3] = {bvh->half.x, bvh->half.y, bvh->half.z};
    double o[3] = {from.x, from.y, from.z};
    double inverse[3];
    double reach = 0.0;
    bool is_ray = bvh->nodes != NULL;
    for (int axis = 0; axis < 3; axis++) {
        double component = fabs(d[axis]) < 0x1p-60 ? copysign(0x1p-60, d[axis]) : d[axis];
        inverse[axis] = 1.0 / component;
        walk->near_side[axis] = inverse[axis] < 0.0;
        is_ray = is_ray && fabs(d[axis]) < 0x1p60 && fabs(o[axis]) < (double)INFINITY;
        reach = fmax(reach, fabs(o[axis]) + half[axis]);
    }
    double pad = 32.0 * u * reach;
    walk->skipped = 0.0;
    if (reach > 4.0) {
        double enter = 0.0;
        double leave = (double)INFINITY;
        for (int axis = 0; axis < 3; axis++) {
            double side = copysign(half[axis] + pad, inverse[axis]);
            enter = fmax(enter, (-side - o[axis]) * inverse[axis]);
            leave = fmin(leave, (side - o[axis]) * inverse[axis]);
        }
        if (!(enter * (1.0 - 8 * u) <= leave * (1.0 + 8 * u))) {
            return false;
        }
        walk->skipped = enter * (1.0 - 8 * u);
        for (int axis = 0; axis < 3; axis++) {
            o[axis] += walk->skipped * d[axis];
            pad = fmax(pad, 0x1p-22 * fabs(o[axis]));
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        double shift = copysign(pad + 0x1p-22 * (fabs(o[axis]) + pad), inverse[axis]);
        walk->origin[axis][0] = (float)(o[axis] + shift);
        walk->origin[axis][1] = (float)(o[axis] - shift);
        walk->inverse[axis][0] = (float)(inverse[axis] * (1.0 - 0x1p-21));
        walk->inverse[axis][1] = (float)(inverse[axis] * (1.0 + 0x1p-21));
    }
    walk->nodes = bvh->nodes;
    walk->scale = bvh->scale;
    walk->waiting = 1;
    walk->stack[0] = 0;
    return is_ray;
}

RT_ALWAYS_INLINE uint64_t bvh_walk_key(float distance, BvhChild child)
{
    uint32_t bits;
    memcpy(&bits, &distance, sizeof(bits));
    return (uint64_t)bits << 32 | child;
}

// The children that the ray meets before the limit, and where it enters each.
RT_ALWAYS_INLINE unsigned bvh_walk_boxes(const BvhWalk *walk, const BvhNode *node, float limit, float enters[BVH_WIDTH])
{
    unsigned met = 0;
#pragma GCC unroll 2
    for (int at = 0; at < BVH_WIDTH; at += FLOATS) {
        Floats enter = floats_splat(0.0f);
        Floats leave = floats_splat(limit);
#pragma GCC unroll 3
        for (int axis = 0; axis < 3; axis++) {
            unsigned side = walk->near_side[axis];
            Floats near = (floats_load(&node->box[axis][side][at]) - walk->origin[axis][0]) * walk->inverse[axis][0];
            Floats far = (floats_load(&node->box[axis][side ^ 1][at]) - walk->origin[axis][1]) * walk->inverse[axis][1];
            enter = floats_max(near, enter);
            leave = floats_min(far, leave);
        }
        floats_store(&enters[at], enter);
        met |= floats_le(enter, leave) << at;
    }
    return met;
}

// The next leaf with a box that begins no later than t_max; false when there is none.
RT_ALWAYS_INLINE bool bvh_walk_next(BvhWalk *walk, double t_max, BvhChild *leaf)
{
    float limit = bvh_walk_limit(walk, t_max);
    uint64_t last = bvh_walk_key(limit, UINT32_MAX);
    if (!(limit >= 0.0f)) {
        return false;
    }
    while (walk->waiting > 0) {
        uint64_t key = walk->stack[--walk->waiting];
        if (key > last) {
            continue;
        }
        BvhChild child = (BvhChild)key;
        while (!(child & BVH_LEAF)) {
            const BvhNode *node = &walk->nodes[child];
            _Alignas(64) float enters[BVH_WIDTH];
            unsigned met = bvh_walk_boxes(walk, node, limit, enters);
            if (!met) {
                break;
            }
            unsigned i = (unsigned)__builtin_ctz(met);
            child = node->child[i];
            met &= met - 1;
            if (!met) {
                continue;
            }
            // Far ones first onto the stack: an insertion, as there are seldom more than three.
            uint64_t nearest = bvh_walk_key(enters[i], child);
            unsigned bottom = walk->waiting;
            do {
                i = (unsigned)__builtin_ctz(met);
                met &= met - 1;
                uint64_t other = bvh_walk_key(enters[i], node->child[i]);
                uint64_t farther = other > nearest ? other : nearest;
                nearest = other > nearest ? nearest : other;
                unsigned at = walk->waiting++;
                for (; at > bottom && walk->stack[at - 1] < farther; at--) {
                    walk->stack[at] = walk->stack[at - 1];
                }
                walk->stack[at] = farther;
            } while (met);
            child = (BvhChild)nearest;
        }
        if (child & BVH_LEAF) {
            *leaf = child;
            return true;
        }
    }
    return false;
}

#endif
