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

// The nearest hit so far; starts as t = the end of the ray's interval, shape = SHAPE_NONE.
typedef struct Nearest {
    Hit hit;
    uint32_t order; // of hit.shape
} Nearest;

// Builds the tree of `count` > BVH_LEAF_MOST usable spheres and puts their new order into `order`: sphere order[i]
// becomes number first + i of the table. False when out of memory; *bvh is then empty.
bool bvh_init(Bvh *bvh, const Ball *balls, uint32_t count, uint32_t first, uint32_t *order) RT_MUST_CHECK;
void bvh_fini(Bvh *bvh);

// Brings `nearest` up to date with the spheres of the tree. Spheres equal to `start` are passed over.
void bvh_closest(const Bvh *bvh, const BallTable *table, const SphereRay *ray, const Ball *start, Nearest *nearest);

// True when a sphere of the tree, other than `start`, is met at 0 < t < t_max.
bool bvh_occluded(const Bvh *bvh, const BallTable *table, const SphereRay *ray, const Ball *start, double t_max);

// Equal distances: the shape that was declared first is seen.
RT_ALWAYS_INLINE void nearest_offer(Nearest *nearest, double t, ShapeId shape, bool inside, uint32_t order)
{
    if (t > 0.0 && (t < nearest->hit.t ||
                    (t == nearest->hit.t && nearest->hit.shape != SHAPE_NONE && order < nearest->order))) {
        *nearest = (Nearest){{t, shape, inside}, order};
    }
}

// One sphere against the ray, for the nearest hit.
RT_ALWAYS_INLINE void ball_closest(const BallTable *table, uint32_t index, const SphereRay *ray, const Ball *start,
                                   Nearest *nearest)
{
    SphereRoots roots;
    if (!sphere_solve(ray, &table->balls[index], &roots)) {
        return;
    }
    double t = sphere_root(ray, &roots);
    if (t <= nearest->hit.t && !ball_equal(&table->balls[index], start)) {
        nearest_offer(nearest, t, shape_id(SHAPE_SPHERE, index), !(roots.c > 0.0), table->info[index].order);
    }
}

// One sphere against the ray, for any hit.
RT_ALWAYS_INLINE bool ball_occludes(const BallTable *table, uint32_t index, const SphereRay *ray, const Ball *start,
                                    double t_max)
{
    SphereRoots roots;
    if (!sphere_solve(ray, &table->balls[index], &roots)) {
        return false;
    }
    double t = sphere_root(ray, &roots);
    return t > 0.0 && t < t_max && !ball_equal(&table->balls[index], start);
}

#endif
