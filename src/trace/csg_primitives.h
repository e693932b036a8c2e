// The tree of a composite's primitives, where they are many: a ray asks those alone whose boxes it meets.
//
// A primitive whose box is missed has no crossing, so the composite's counts have it as idle from the start, which is
// what asking it would find. Primitives that decide, meshes, which are followed along the line, and primitives without
// bounds are loose: each ray asks them, before all others.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_CSG_PRIMITIVES_H
#define TRACE_CSG_PRIMITIVES_H

#include <stdatomic.h>

#include "trace/bounds.h"
#include "trace/shapes.h"

enum { CSG_PRIMITIVES_LEAST = 6 }; // in the tree; fewer are asked one after the other

struct CsgPrimitives {
    Bvh tree;
    uint32_t *loose, *leaves; // numbers within the composite: in order, and in the tree's; in one block, owned
    uint32_t loose_count, leaf_count;
    bool are_leaves_unseen; // they only clip
    uint32_t joined; // the node of which they, convex and unseen, are all children, and which joins them; NODE_NONE
};

// Sorts the primitives of a composite, whose surfaces' boxes are given by solid, and those of what matters of its nodes
// (csg_bounds) by node. Leaves it without a tree where that is not worth it, or where the intervals of all its parts
// tell what is seen. False when out of memory or cancelled.
bool csg_parts_init(const ShapeTable *table, CsgTree *csg, const Bounds *surfaces, const Bounds *nodes, int threads,
                    const atomic_bool *cancel) RT_MUST_CHECK;
void csg_parts_fini(CsgTree *csg);
size_t csg_parts_bytes(const CsgTree *csg);

// Sets a bit, of primitive_count in all, for each of the leaves whose box the ray may enter up to a place.
void csg_parts_along(const CsgPrimitives *parts, const Ray *ray, double until, uint64_t *met);

// Calls a function with the number of each leaf whose box the ray may be in from one place to another, until that is
// true.
typedef bool (*CsgPrimitiveFn)(void *client, uint32_t part);
void csg_parts_at(const CsgPrimitives *parts, const Ray *ray, double from, double to, CsgPrimitiveFn ask, void *client);

#endif
