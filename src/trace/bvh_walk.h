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

// x, y, z and something.
typedef double Axes __attribute__((vector_size(32)));
typedef float FloatAxes __attribute__((vector_size(16)));
typedef int64_t AxesMask __attribute__((vector_size(32)));

typedef struct BvhWalk {
    const BvhNode *nodes;
    double scale, skipped; // distance in the tree = parameter of the ray * scale - skipped
    float origin[2][4], inverse[2][4]; // of near, of far planes: their distance is (plane - origin) * inverse
    unsigned near_side[3];             // 1 when the ray meets the high plane of an axis first
    unsigned waiting;
    uint64_t stack[BVH_STACK]; // bits of the distance above, child below: distances are >= 0, so they order as integers
} BvhWalk;

// A parameter of the ray as distances in the tree are compared with it: never too small by rounding.
RT_ALWAYS_INLINE float bvh_walk_limit(const BvhWalk *walk, double t_max)
{
    double limit = t_max * walk->scale - walk->skipped;
    return (float)(limit + fabs(limit) * 0x1p-22);
}

RT_ALWAYS_INLINE void axes_store(float to[4], Axes a)
{
    FloatAxes narrow = __builtin_convertvector(a, FloatAxes);
    memcpy(to, &narrow, sizeof(narrow));
}

RT_ALWAYS_INLINE double axes_sum_abs(Axes a)
{
    return fabs(a[0]) + fabs(a[1]) + fabs(a[2]);
}

// Moves a far origin up to the root box; false when the ray misses that.
RT_ALWAYS_INLINE bool bvh_walk_approach(BvhWalk *walk, const Bvh *bvh, Axes *origin, Axes direction, Axes inverse,
                                        double pad)
{
    const double u = DBL_EPSILON / 2;
    const double half[3] = {bvh->half.x, bvh->half.y, bvh->half.z};
    double enter = 0.0;
    double leave = (double)INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        double side = copysign(half[axis] + pad, inverse[axis]);
        double near = (-side - (*origin)[axis]) * inverse[axis];
        double far = (side - (*origin)[axis]) * inverse[axis];
        enter = near > enter ? near : enter;
        leave = far < leave ? far : leave;
    }
    walk->skipped = enter * (1.0 - 8 * u);
    *origin += walk->skipped * direction;
    return walk->skipped <= leave * (1.0 + 8 * u);
}

// What the tests of boxes need: planes moved outward by `pad`, and the inverses for near and for far planes.
RT_ALWAYS_INLINE void bvh_walk_set(BvhWalk *walk, const Bvh *bvh, Axes origin, double pad, AxesMask signs,
                                   Axes near_inverse, Axes far_inverse)
{
    Axes shift = (Axes)((AxesMask)((Axes){0} + pad) | signs);
    axes_store(walk->origin[0], origin + shift);
    axes_store(walk->origin[1], origin - shift);
    axes_store(walk->inverse[0], near_inverse * (1.0 - 0x1p-21));
    axes_store(walk->inverse[1], far_inverse * (1.0 + 0x1p-21));
    for (int axis = 0; axis < 3; axis++) {
        walk->near_side[axis] = signs[axis] != 0;
    }
    walk->nodes = bvh->nodes;
    walk->scale = bvh->scale;
    walk->waiting = 1;
    walk->stack[0] = 0;
}

// 1/d, with components of d below 2^-60 taken for that.
RT_ALWAYS_INLINE void axes_invert(Axes d, Axes *inverse)
{
    AxesMask signs = (AxesMask)d & INT64_MIN;
    Axes size = (Axes)((AxesMask)d & INT64_MAX);
    AxesMask small = size < 0x1p-60;
    size = (Axes)((small & (AxesMask)((Axes){0} + 0x1p-60)) | (~small & (AxesMask)size));
    *inverse = 1.0 / (Axes)((AxesMask)size | signs);
}

// A point in the coordinates of the tree.
RT_ALWAYS_INLINE void bvh_walk_point(const Bvh *bvh, Vec3 p, Axes *out)
{
    const Axes centre = {bvh->centre.x, bvh->centre.y, bvh->centre.z};
    *out = ((Axes){p.x, p.y, p.z} - centre) * bvh->scale;
}

// Begins a walk from p(0) on. The direction is about of unit length.
//
// Let D be the sum of the coordinates of origin and root box in tree coordinates, which is not less than any difference
// between them, u = 2^-53, and D' the same after the origin has been moved up to the tree along the ray, when it is far
// away. Planes are moved outward by 32 u D + 2^-22 D', to cover
//   in u D:     3 for a point reported at a t that is off by an ulp; 3 for centre ± radius in tree coordinates; 1 for the
//               origin there and 5 for moving it; the rest is spare
//   in 2^-24 D': 1 for the origin's conversion to float; the rest is spare
// and distances are multiplied by 1 ∓ 2^-21, where plane - origin, 1/direction and their product are each off by 2^-24.
// A direction's component below 2^-60 is taken for 2^-60: over the length of the tree that is less than u D.
// (T. Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013, with all of it done once a ray instead of once a box.)
// False when the ray cannot meet the tree.
RT_ALWAYS_INLINE bool bvh_walk_start(BvhWalk *walk, const Bvh *bvh, Vec3 origin, Vec3 direction)
{
    Axes o, inverse;
    Axes d = {direction.x, direction.y, direction.z, 1.0};
    bvh_walk_point(bvh, origin, &o);
    axes_invert(d, &inverse);
    double half = bvh->half.x + bvh->half.y + bvh->half.z;
    double reach = axes_sum_abs(o) + half;
    if (!(reach < (double)INFINITY) || !bvh->nodes) {
        return false;
    }
    double pad = 16.0 * (32.0 * (DBL_EPSILON / 2) + 0x1p-22);
    walk->skipped = 0.0;
    if (reach > 16.0) {
        pad = 32.0 * (DBL_EPSILON / 2) * reach;
        if (!bvh_walk_approach(walk, bvh, &o, d, inverse, pad)) {
            return false;
        }
        pad += 0x1p-22 * (axes_sum_abs(o) + half);
    }
    bvh_walk_set(walk, bvh, o, pad, (AxesMask)d & INT64_MIN, inverse, inverse);
    return true;
}

// The same for all rays from one origin whose directions have components between `least` and `greatest`, least and
// greatest by size and of the same signs (zeros have one), and for all that is no farther than `aside` from one of them.
// False when there are no such leaves, or when the origin is too far away for boxes in float (then ask ray by ray).
RT_ALWAYS_INLINE bool bvh_walk_start_beam(BvhWalk *walk, const Bvh *bvh, Vec3 origin, double aside, Vec3 least,
                                          Vec3 greatest, bool *is_too_far)
{
    Axes o, near_inverse, far_inverse;
    Axes far_direction = {least.x, least.y, least.z, 1.0};
    Axes near_direction = {greatest.x, greatest.y, greatest.z, 1.0};
    bvh_walk_point(bvh, origin, &o);
    axes_invert(near_direction, &near_inverse);
    axes_invert(far_direction, &far_inverse);
    double outset = aside * bvh->scale;
    double reach = axes_sum_abs(o) + bvh->half.x + bvh->half.y + bvh->half.z + outset;
    *is_too_far = !(reach < 4096.0);
    if (*is_too_far || !bvh->nodes) {
        return false;
    }
    walk->skipped = 0.0;
    bvh_walk_set(walk, bvh, o, (32.0 * (DBL_EPSILON / 2) + 0x1p-22) * reach + outset,
                 (AxesMask)near_direction & INT64_MIN, near_inverse, far_inverse);
    return true;
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
            Floats near = (floats_load(&node->box[axis][side][at]) - walk->origin[0][axis]) * walk->inverse[0][axis];
            Floats far = (floats_load(&node->box[axis][side ^ 1][at]) - walk->origin[1][axis]) * walk->inverse[1][axis];
            enter = floats_max(near, enter);
            leave = floats_min(far, leave);
        }
        floats_store(&enters[at], enter);
        met |= floats_le(enter, leave) << at;
    }
    return met;
}

// Puts a child and distance among those that wait above `bottom`, far ones first.
RT_ALWAYS_INLINE void bvh_walk_push(BvhWalk *walk, unsigned bottom, uint64_t key)
{
    unsigned at = walk->waiting++;
    for (; at > bottom && walk->stack[at - 1] < key; at--) {
        walk->stack[at] = walk->stack[at - 1];
    }
    walk->stack[at] = key;
}

// The nearest of the children that are met; the others wait.
RT_ALWAYS_INLINE BvhChild bvh_walk_choose(BvhWalk *walk, const BvhNode *node, unsigned met,
                                          const float enters[BVH_WIDTH])
{
    unsigned i = (unsigned)__builtin_ctz(met);
    BvhChild child = node->child[i];
    met &= met - 1;
    if (RT_LIKELY(!met)) {
        return child;
    }
    uint64_t nearest = bvh_walk_key(enters[i], child);
    i = (unsigned)__builtin_ctz(met);
    uint64_t other = bvh_walk_key(enters[i], node->child[i]);
    unsigned bottom = walk->waiting;
    walk->stack[walk->waiting++] = other > nearest ? other : nearest;
    nearest = other > nearest ? nearest : other;
    while ((met &= met - 1)) {
        i = (unsigned)__builtin_ctz(met);
        other = bvh_walk_key(enters[i], node->child[i]);
        bvh_walk_push(walk, bottom, other > nearest ? other : nearest);
        nearest = other > nearest ? nearest : other;
    }
    return (BvhChild)nearest;
}

// The next leaf with a box that begins no later than the limit (of bvh_walk_limit); false when there is none.
RT_ALWAYS_INLINE bool bvh_walk_next(BvhWalk *walk, float limit, BvhChild *leaf)
{
    uint64_t last = bvh_walk_key(limit, UINT32_MAX);
    while (walk->waiting > 0 && limit >= 0.0f) {
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
            child = bvh_walk_choose(walk, node, met, enters);
        }
        if (child & BVH_LEAF) {
            *leaf = child;
            return true;
        }
    }
    return false;
}

#endif
