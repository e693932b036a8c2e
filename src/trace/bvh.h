// A tree of boxes over many spheres.
//
// Built once by binned surface-area heuristic (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies",
// 2007), then const. Nodes lie in one array and hold the boxes of their two children in float, in the tree's own
// coordinates: the root box lies around 0, within -1..1, so that neither an offset of the scene nor its size
// costs digits. The tree orders the spheres; leaves are runs of that order. Knows nothing of scenes or other shapes.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_BVH_H
#define TRACE_BVH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/attributes.h"
#include "trace/sphere.h"
#include "trace/trace.h"

enum {
    BVH_LEAF_MOST = 4, // spheres in a leaf
    // Below this depth ranges are simply halved, so that 2^30 spheres make at most 30 more levels.
    BVH_SAH_DEPTH_MOST = 32,
    BVH_DEPTH_MOST = 64,
};

// A leaf child has its first sphere in `first` and count > 0; an inner child has its node there and count 0.
typedef struct BvhNode {
    float box[3][2][2]; // axis; low, high; child
    uint32_t first[2];
    uint32_t count[2];
} BvhNode;

typedef struct Bvh {
    BvhNode *nodes; // the root first; owned
    size_t node_count;
    Vec3 centre;  // tree coordinates are (p - centre) * scale
    double scale; // a power of two
    Vec3 half;    // half the size of the root box, in tree coordinates
} Bvh;

// What a hit leads to.
typedef struct ShapeInfo {
    MaterialIndex material;
    uint32_t order; // place in the order of declaration
} ShapeInfo;

// The spheres of a Geometry, in its own order.
typedef struct BallTable {
    Ball *balls;
    ShapeInfo *info;
    uint32_t count;
} BallTable;

// The nearest hit so far; starts as t = the end of the ray's interval, shape = SHAPE_NONE. While `is_rough`, hit.t is a
// sphere's root as sphere_test gives it; nearest_settle makes it right.
typedef struct Nearest {
    Hit hit;
    uint32_t order; // of hit.shape
    bool is_rough;
} Nearest;

// Builds the tree of `count` > BVH_LEAF_MOST usable spheres and puts their new order into `order`: sphere order[i]
// becomes number first + i of the table. False when out of memory; *bvh is then empty.
bool bvh_init(Bvh *bvh, const Ball *balls, uint32_t count, uint32_t first, uint32_t *order) RT_MUST_CHECK;
void bvh_fini(Bvh *bvh);

// Brings `nearest` up to date with the spheres of the tree. Spheres equal to `start` are passed over.
void bvh_closest(const Bvh *bvh, const BallTable *table, const SphereRay *ray, const Ball *start, Nearest *nearest);

// True when a sphere of the tree, other than `start`, is met at 0 < t < t_max.
bool bvh_occluded(const Bvh *bvh, const BallTable *table, const SphereRay *ray, const Ball *start, double t_max);

// Equal distances: the shape that was declared first is seen. Both roots are exact to the last rounding.
RT_ALWAYS_INLINE void nearest_offer(Nearest *nearest, double t, ShapeId shape, bool inside, uint32_t order)
{
    if (t > 0.0 && (t < nearest->hit.t ||
                    (t == nearest->hit.t && nearest->hit.shape != SHAPE_NONE && order < nearest->order))) {
        *nearest = (Nearest){{t, shape, inside}, order, false};
    }
}

// Refines a rough root.
RT_ALWAYS_INLINE void nearest_settle(const BallTable *table, const SphereRay *ray, Nearest *nearest)
{
    if (nearest->is_rough) {
        nearest->hit.t = sphere_refine(ray, &table->balls[shape_index(nearest->hit.shape)], nearest->hit.t);
        nearest->is_rough = false;
    }
}

// One sphere against the ray, for the nearest hit. Roots are refined only where rough ones could be taken in the wrong
// order, so in the end the same sphere is nearest as if all had been.
RT_ALWAYS_INLINE void ball_closest(const BallTable *table, uint32_t index, const SphereRay *ray, const Ball *start,
                                   Nearest *nearest)
{
    const Ball *ball = &table->balls[index];
    double t;
    bool inside;
    SphereVerdict verdict = sphere_test(ray, ball, &t, &inside);
    if (verdict == SPHERE_MISS || ball_equal(ball, start)) {
        return;
    }
    bool is_rough = verdict == SPHERE_MET;
    if (!is_rough) {
        t = sphere_exact(ray, ball, &inside);
    }
    double slack = SPHERE_ROOT_SLACK * nearest->hit.t;
    if (!(t > 0.0) || t > nearest->hit.t + slack) {
        return;
    }
    uint32_t order = table->info[index].order;
    if (t < nearest->hit.t - slack || isinf(nearest->hit.t)) {
        *nearest = (Nearest){{t, shape_id(SHAPE_SPHERE, index), inside}, order, is_rough};
        return;
    }
    nearest_settle(table, ray, nearest);
    nearest_offer(nearest, is_rough ? sphere_refine(ray, ball, t) : t, shape_id(SHAPE_SPHERE, index), inside, order);
}

// One sphere against the ray, for any hit.
RT_ALWAYS_INLINE bool ball_occludes(const BallTable *table, uint32_t index, const SphereRay *ray, const Ball *start,
                                    double t_max)
{
    const Ball *ball = &table->balls[index];
    double t;
    bool inside;
    SphereVerdict verdict = sphere_test(ray, ball, &t, &inside);
    if (verdict == SPHERE_MISS || ball_equal(ball, start)) {
        return false;
    }
    double slack = SPHERE_ROOT_SLACK * t_max;
    if (verdict == SPHERE_DOUBTFUL) {
        t = sphere_exact(ray, ball, &inside);
    } else if (t < t_max - slack || isinf(t_max)) {
        return true;
    } else if (t <= t_max + slack) {
        t = sphere_refine(ray, ball, t);
    }
    return t > 0.0 && t < t_max;
}

#endif
