// Cutting a range of things in two, for the builder of the tree (trace/bvh_build.c).
//
// Finds by the binned surface-area heuristic where a range of refs is best cut, puts the refs of the left part first and
// measures both parts. Private to the builder; knows nothing of nodes and threads.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_BVH_SPLIT_H
#define TRACE_BVH_SPLIT_H

#include "trace/bvh.h"

// Four floats at a time; x, y and z are used.
typedef float Float4 __attribute__((vector_size(16)));

typedef struct Box {
    Float4 low, high;
} Box;

// A range of refs to become a node or a leaf. Centres are twice the middles of the boxes.
typedef struct Range {
    Box box, centres;
    uint32_t begin, end;
    unsigned depth;
    unsigned leaf_bits; // a leaf holds 2^leaf_bits things at most
} Range;

static inline float box_half_area(const Box *box)
{
    Float4 size = box->high - box->low;
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

static inline uint32_t range_count(const Range *range)
{
    return range->end - range->begin;
}

static inline bool range_is_leaf(const Range *range)
{
    return range_count(range) <= 1u << range->leaf_bits;
}

// The range with its box and centres, from its refs.
Range range_measure(const BvhRef *refs, Range range, int threads);

enum { RANGE_SPARE = 1023 }; // refs of the longest range that is moved by way of spare room

// Cuts a range of more than a leaf in two. The order of the refs in both parts depends on the order before alone, not on
// the number of threads, of which very long ranges only take more than one. `spare` is the calling thread's room.
void range_split(BvhRef *refs, const Range *range, int threads, BvhRef spare[RANGE_SPARE], Range *left, Range *right);

#endif
