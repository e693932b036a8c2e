// The leaves of a tree along a ray, nearest first, inline so that each user's loop is compiled with its own test.
//
// Boxes are tested eight at a time in float. What float cannot say is made up for once a ray: see bvh_walk_start. The
// walk is conservative only; what is met is for the caller's test to say.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_BVH_WALK_H
#define TRACE_BVH_WALK_H

#include <float.h>

#include "math/extreme.h"
#include "math/ray.h"
#include "trace/bvh.h"
#include "trace/simd.h"

enum { BVH_CHILD_BYTES = sizeof(BvhNode) };
enum { BVH_STACK = BVH_DEPTH_MOST * (BVH_WIDTH - 1) + BVH_WIDTH };

// x, y, z and something.
typedef double Axes __attribute__((vector_size(32)));
typedef float FloatAxes __attribute__((vector_size(16)));
typedef int32_t FloatAxesMask __attribute__((vector_size(16)));

// Planes of an axis are met at floats_slab(plane, from[axis], by[axis]), see bvh_walk_start.
typedef struct BvhSlabs {
    float from[4], by[4];
} BvhSlabs;

typedef struct BvhWalk {
    const BvhNode *nodes;
    const char *leaves; // what leaves lead to, BVH_CHILD_BYTES each; NULL: nothing is fetched ahead
    double scale, skipped; // distance in the tree = parameter of the ray * scale - skipped
    BvhSlabs near, far;
    unsigned near_side[3]; // 1 when the ray meets the high plane of an axis first
    unsigned waiting;
    uint64_t stack[BVH_STACK]; // bits of the distance above, child below: distances are >= 0, so they order as integers
} BvhWalk;

// A parameter of the ray as distances in the tree are compared with it: never too small by rounding.
RT_ALWAYS_INLINE float bvh_walk_limit(const BvhWalk *walk, double t_max)
{
    double limit = t_max * walk->scale - walk->skipped;
    return (float)(limit + fabs(limit) * 0x1p-22);
}

RT_ALWAYS_INLINE double axes_sum_abs(const Axes *a)
{
    return fabs((*a)[0]) + fabs((*a)[1]) + fabs((*a)[2]);
}

// Moves a far origin up to the root box; false when the ray misses that.
RT_ALWAYS_INLINE bool bvh_walk_approach(BvhWalk *walk, const Bvh *bvh, Axes *origin, Vec3 direction, double pad)
{
    const double u = DBL_EPSILON / 2;
    const double half[3] = {bvh->half.x, bvh->half.y, bvh->half.z};
    const double d[3] = {direction.x, direction.y, direction.z};
    double enter = 0.0;
    double leave = (double)INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        double inverse = 1.0 / copysign(greater_of(fabs(d[axis]), 0x1p-60), d[axis]);
        double side = copysign(half[axis] + pad, d[axis]);
        double near = (-side - (*origin)[axis]) * inverse;
        double far = (side - (*origin)[axis]) * inverse;
        enter = near > enter ? near : enter;
        leave = far < leave ? far : leave;
    }
    walk->skipped = enter * (1.0 - 8 * u);
    *origin += walk->skipped * (Axes){d[0], d[1], d[2], 0.0};
    return walk->skipped <= leave * (1.0 + 8 * u);
}

// 1/d, with components of d below 2^-60 taken for that.
RT_ALWAYS_INLINE FloatAxes axes_invert(FloatAxes d)
{
    FloatAxesMask signs = (FloatAxesMask)d & INT32_MIN;
    FloatAxes size = (FloatAxes)((FloatAxesMask)d & INT32_MAX);
    FloatAxesMask small = size < 0x1p-60f;
    size = (FloatAxes)((small & (FloatAxesMask)((FloatAxes){0} + 0x1p-60f)) | (~small & (FloatAxesMask)size));
    return 1.0f / (FloatAxes)((FloatAxesMask)size | signs);
}

RT_ALWAYS_INLINE void bvh_slabs_set(BvhSlabs *slabs, FloatAxes origin, FloatAxes inverse)
{
    FloatAxes from = FLOATS_ARE_FUSED ? origin * inverse : origin;
    memcpy(slabs->from, &from, sizeof(from));
    memcpy(slabs->by, &inverse, sizeof(inverse));
    asm("" : "+m"(*slabs)); // so that they are spread over vectors by loads, which cost less than shuffles
}

// Begins at the root with what the tests of boxes need: planes moved outward by `pad`, and the directions for near and
// for far planes, which have the same signs.
RT_ALWAYS_INLINE void bvh_walk_set(BvhWalk *walk, const Bvh *bvh, FloatAxes origin, float pad,
                                   FloatAxes near_direction, FloatAxes far_direction)
{
    FloatAxesMask signs = (FloatAxesMask)near_direction & INT32_MIN;
    FloatAxes shift = (FloatAxes)((FloatAxesMask)((FloatAxes){0} + pad) | signs);
    bvh_slabs_set(&walk->near, origin + shift, axes_invert(near_direction) * (1.0f - 0x1p-21f));
    bvh_slabs_set(&walk->far, origin - shift, axes_invert(far_direction) * (1.0f + 0x1p-21f));
    for (int axis = 0; axis < 3; axis++) {
        walk->near_side[axis] = (uint32_t)signs[axis] >> 31;
    }
    walk->nodes = bvh->nodes;
    walk->leaves = NULL;
    walk->scale = bvh->scale;
    walk->waiting = 1;
    walk->stack[0] = 0;
}

// A point in the coordinates of the tree.
RT_ALWAYS_INLINE void bvh_walk_point(const Bvh *bvh, Vec3 p, Axes *out)
{
    const Axes centre = {bvh->centre.x, bvh->centre.y, bvh->centre.z};
    *out = ((Axes){p.x, p.y, p.z} - centre) * bvh->scale;
}

RT_ALWAYS_INLINE FloatAxes axes_narrow(const Axes *a)
{
    return __builtin_convertvector(*a, FloatAxes);
}

RT_ALWAYS_INLINE FloatAxes axes_of_direction(Vec3 d)
{
    return axes_narrow(&(Axes){d.x, d.y, d.z, 1.0});
}

// Whether no component is greater than 4 by size; a NaN is.
RT_ALWAYS_INLINE bool axes_are_small(FloatAxes a)
{
    FloatAxesMask small = (FloatAxes)((FloatAxesMask)a & INT32_MAX) <= 4.0f;
    return small[0] & small[1] & small[2];
}

// How far planes are moved for an origin whose D and D', see below, are no more than these.
RT_ALWAYS_INLINE double bvh_walk_pad(double reach, double near_reach)
{
    return 32.0 * (DBL_EPSILON / 2) * reach + 0x1p-22 * near_reach;
}

// Where planes would be moved farther than that, far beyond what is added to them in float, every box is met: see
// below.
#define BVH_PAD_MOST 0x1p40

// Begins a walk from p(0) on. The direction is about of unit length.
//
// Let D be the sum of the coordinates of origin and root box in tree coordinates, which is not less than any difference
// between them, u = 2^-53, and D' the same after the origin has been moved up to the tree along the ray, when it is far
// away. Planes are moved outward by 32 u D + 2^-22 D', to cover
//   in u D:     3 for a point reported at a t that is off by an ulp; 3 for centre ± radius in tree coordinates; 1 for the
//               origin there and 5 for moving it; the rest is spare
//   in 2^-24 D': 1 for the origin's conversion to float, 1 for moving it outward there, 1 for origin / direction where
//               that is subtracted from plane / direction; the rest is spare
// and distances are multiplied by 1 ∓ 2^-21, where direction's conversion to float, its inverse and that times 1 ∓ 2^-21,
// plane - origin and the product of both are each off by 2^-24.
// A direction's component below 2^-60 is taken for 2^-60: over the length of the tree that is less than u D.
// (T. Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013, with all of it done once a ray instead of once a box.)
//
// Where that is BVH_PAD_MOST or more, every box lies within it, and float may not hold it, nor the origin: then the
// walk begins in the middle of the root box with planes so far away that all boxes are met, and nothing is skipped, so
// that no limit is too low. No number of a walk overflows then: inverses are no greater than 2^60. False when the ray
// cannot meet the tree.
RT_ALWAYS_INLINE bool bvh_walk_start(BvhWalk *walk, const Bvh *bvh, Vec3 origin, Vec3 direction)
{
    Axes o;
    bvh_walk_point(bvh, origin, &o);
    double pad = bvh_walk_pad(16.0, 16.0); // D is at most 12 and the root box's 3, where no component is above 4
    walk->skipped = 0.0;
    if (RT_UNLIKELY(!axes_are_small(axes_narrow(&o)))) {
        double half = bvh->half.x + bvh->half.y + bvh->half.z;
        double reach = axes_sum_abs(&o) + half;
        pad = bvh_walk_pad(reach, 0.0);
        if (pad < BVH_PAD_MOST) {
            if (!bvh_walk_approach(walk, bvh, &o, direction, pad)) {
                return false;
            }
            pad = bvh_walk_pad(reach, axes_sum_abs(&o) + half);
        }
        if (!(pad < BVH_PAD_MOST)) {
            o = (Axes){0.0, 0.0, 0.0, 0.0};
            pad = 0x1p62;
            walk->skipped = 0.0;
        }
    }
    FloatAxes d = axes_of_direction(direction);
    bvh_walk_set(walk, bvh, axes_narrow(&o), (float)pad, d, d);
    return bvh->nodes;
}

// The same for all rays from one origin whose directions have components between `least` and `greatest`, least and
// greatest by size and of the same signs (zeros have one), and for all that is no farther than `end_radius` from one of them.
// False when there are no such leaves, or when the origin is too far away for boxes in float (then ask ray by ray).
RT_ALWAYS_INLINE bool bvh_walk_start_beam(BvhWalk *walk, const Bvh *bvh, Vec3 origin, double end_radius, Vec3 least,
                                          Vec3 greatest, bool *is_too_far)
{
    Axes o;
    bvh_walk_point(bvh, origin, &o);
    double outset = end_radius * bvh->scale;
    double reach = axes_sum_abs(&o) + bvh->half.x + bvh->half.y + bvh->half.z + outset;
    *is_too_far = !(reach < 4096.0);
    if (*is_too_far || !bvh->nodes) {
        return false;
    }
    walk->skipped = 0.0;
    bvh_walk_set(walk, bvh, axes_narrow(&o), (float)(bvh_walk_pad(reach, reach) + outset), axes_of_direction(greatest),
                 axes_of_direction(least));
    return true;
}

RT_ALWAYS_INLINE uint64_t bvh_walk_key(float distance, BvhChild child)
{
    uint32_t bits;
    memcpy(&bits, &distance, sizeof(bits));
    return (uint64_t)bits << 32 | child;
}

// A parameter that is not above that of a key's distance: what ends before it is passed over by the limit of its end.
RT_ALWAYS_INLINE double bvh_walk_parameter(const BvhWalk *walk, uint64_t key)
{
    uint32_t bits = (uint32_t)(key >> 32);
    float distance;
    memcpy(&distance, &bits, sizeof(distance));
    return ((double)distance + walk->skipped) * (1.0 - 0x1p-20) / walk->scale;
}

// The children that the ray meets before the limit, and where it enters each.
RT_ALWAYS_INLINE unsigned bvh_walk_boxes(const BvhWalk *walk, const BvhNode *node, float limit, float enters[BVH_WIDTH])
{
    unsigned met = 0;
#pragma GCC unroll 2
    for (int at = 0; at < BVH_WIDTH; at += FLOATS) {
        Floats near[3], far[3];
#pragma GCC unroll 3
        for (int axis = 0; axis < 3; axis++) {
            unsigned side = walk->near_side[axis];
            near[axis] = floats_slab(floats_load(&node->box[axis][side][at]), floats_splat(walk->near.from[axis]),
                                     floats_splat(walk->near.by[axis]));
            far[axis] = floats_slab(floats_load(&node->box[axis][side ^ 1][at]), floats_splat(walk->far.from[axis]),
                                    floats_splat(walk->far.by[axis]));
        }
        // Two and two, so that one does not wait for the one before.
        Floats enter = floats_max(floats_max(near[0], near[1]), floats_max(near[2], floats_splat(0.0f)));
        Floats leave = floats_min(floats_min(far[0], far[1]), floats_min(far[2], floats_splat(limit)));
        floats_store(&enters[at], enter);
        met |= floats_le(enter, leave) << at;
    }
    return met & node->present; // an empty box is missed already, unless a number overflowed
}

// Fetches a child, which has to wait, into the cache.
RT_ALWAYS_INLINE void bvh_walk_expect(const BvhWalk *walk, uint64_t key)
{
    BvhChild child = (BvhChild)key;
    if (!walk->leaves) {
        return;
    }
    const char *from = child & BVH_LEAF ? walk->leaves : (const char *)walk->nodes;
    from += (size_t)(child & ~BVH_LEAF) * BVH_CHILD_BYTES;
#pragma GCC unroll 4
    for (size_t line = 0; line < BVH_CHILD_BYTES; line += 64) {
        __builtin_prefetch(from + line);
    }
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
    bvh_walk_expect(walk, other > nearest ? other : nearest);
    walk->stack[walk->waiting++] = other > nearest ? other : nearest;
    nearest = other > nearest ? nearest : other;
    while ((met &= met - 1)) {
        i = (unsigned)__builtin_ctz(met);
        other = bvh_walk_key(enters[i], node->child[i]);
        bvh_walk_expect(walk, other > nearest ? other : nearest);
        bvh_walk_push(walk, bottom, other > nearest ? other : nearest);
        nearest = other > nearest ? nearest : other;
    }
    return (BvhChild)nearest;
}

// The next leaf with a box that begins no later than the limit (of bvh_walk_limit); false when there is none.
RT_ALWAYS_INLINE bool bvh_walk_next(BvhWalk *walk, float limit, BvhChild *leaf)
{
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
