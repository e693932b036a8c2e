// A tree of boxes over anything that has bounds.
//
// Built once by binned surface-area heuristic (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies",
// 2007) straight into nodes of eight children, then const. Boxes are kept in float, rounded outward, in the tree's own
// coordinates: the root box lies around 0, within -1..1, so that neither an offset of the scene nor its size costs
// digits. The tree orders its things; a leaf is a run of that order. trace/bvh_walk.h finds the leaves along a ray.
// Knows nothing of shapes.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_BVH_H
#define TRACE_BVH_H

#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/attributes.h"
#include "base/pages.h"
#include "math/vec3.h"

enum {
    BVH_WIDTH = 8,
    BVH_LEAF_MOST = 8, // things in a leaf
    // Below this depth of binary splits ranges are simply halved, so that 2^28 things make at most 28 more.
    BVH_SAH_DEPTH_MOST = 32,
    BVH_DEPTH_MOST = 64, // levels of nodes
};

// A child is a node's number, a leaf, or none (with an empty box).
typedef uint32_t BvhChild;
#define BVH_LEAF       0x80000000u
#define BVH_CHILD_NONE 0x7fffffffu

// The leaf of the things first <= i < first + count, 1 <= count <= BVH_LEAF_MOST, first < 2^28.
static inline BvhChild bvh_leaf(uint32_t first, uint32_t count)
{
    return BVH_LEAF | (count - 1) << 28 | first;
}

static inline uint32_t bvh_leaf_first(BvhChild leaf)
{
    return leaf & 0x0fffffffu;
}

static inline uint32_t bvh_leaf_count(BvhChild leaf)
{
    return (leaf >> 28 & 7) + 1;
}

typedef struct BvhNode {
    _Alignas(64) float box[3][2][BVH_WIDTH]; // axis; low, high; child
    BvhChild child[BVH_WIDTH];
    uint32_t present; // a bit for each child that is not BVH_CHILD_NONE: whatever floats say, no other is followed
    uint32_t unused[BVH_WIDTH - 1]; // 0; so that a node is four lines of cache
} BvhNode;

// A node without children.
static inline void bvh_node_clear(BvhNode *node)
{
    for (int child = 0; child < BVH_WIDTH; child++) {
        for (int axis = 0; axis < 3; axis++) {
            node->box[axis][0][child] = INFINITY;
            node->box[axis][1][child] = -INFINITY;
        }
        node->child[child] = BVH_CHILD_NONE;
    }
    node->present = 0;
    memset(node->unused, 0, sizeof node->unused);
}

typedef struct Bvh {
    BvhNode *nodes; // the root first, parents before children; in `pages`; NULL in a tree of nothing
    uint32_t node_count;
    Pages pages;  // owned
    Vec3 centre;  // tree coordinates are (p - centre) * scale
    double scale; // a power of two
    Vec3 half;    // half the size of the root box, in tree coordinates
} Bvh;

// A thing while the tree is built: its box in tree coordinates, and in the fourth places its number for whoever builds,
// 23 bits in the fraction of each, so that they can go through vector arithmetic as harmless numbers between 1 and 2.
typedef struct BvhRef {
    _Alignas(16) float low[4];
    float high[4];
} BvhRef;

static inline uint32_t bvh_ref_index(const BvhRef *ref)
{
    const float parts[2] = {ref->low[3], ref->high[3]};
    uint32_t bits[2];
    memcpy(bits, parts, sizeof(bits));
    return (bits[0] & 0x7fffffu) | (bits[1] & 0x1ffu) << 23;
}

// Chooses the coordinates of a tree whose things all lie within low..high, which are finite.
void bvh_place(Bvh *bvh, Vec3 low, Vec3 high);

// Rounded outward: a conversion to float is off by at most 2^-24 of the value.
static inline float bvh_float_below(double x)
{
    return (float)(x - fabs(x) * 0x1p-23);
}

static inline float bvh_float_above(double x)
{
    return (float)(x + fabs(x) * 0x1p-23);
}

// The ref of a thing within low..high. A box of centre ± radius may be given as rounded; see bvh_walk.h for what is
// added to make up for that.
static inline BvhRef bvh_ref(const Bvh *bvh, Vec3 low, Vec3 high, uint32_t index)
{
    Vec3 a = vec3_scale(bvh->scale, vec3_sub(low, bvh->centre));
    Vec3 b = vec3_scale(bvh->scale, vec3_sub(high, bvh->centre));
    uint32_t bits[2] = {0x3f800000u | (index & 0x7fffffu), 0x3f800000u | index >> 23};
    float parts[2];
    memcpy(parts, bits, sizeof(parts));
    return (BvhRef){{bvh_float_below(a.x), bvh_float_below(a.y), bvh_float_below(a.z), parts[0]},
                    {bvh_float_above(b.x), bvh_float_above(b.y), bvh_float_above(b.z), parts[1]}};
}

// How many things a leaf may hold, as a power of two: one each where a test costs more than that of its box, eight where
// they are tested at once.
typedef enum BvhLeafBits { BVH_LEAF_ONE = 0, BVH_LEAF_EIGHT = 3 } BvhLeafBits;

// Builds the tree of a placed *bvh over 1 <= count < 2^28 refs and puts them into its order, in which leaves are runs
// and follow each other as their nodes do. The result does not depend on the number of threads. False when out of
// memory, or given up since *cancel (NULL: there is none) is set; *bvh is then empty.
bool bvh_build(Bvh *bvh, BvhRef *refs, uint32_t count, BvhLeafBits leaf_bits, int threads,
               const atomic_bool *cancel) RT_MUST_CHECK;
void bvh_fini(Bvh *bvh);

#endif
