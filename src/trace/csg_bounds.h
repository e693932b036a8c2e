// The nodes of composites, and the box around one of which planes or quadrics cut something off.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_CSG_BOUNDS_H
#define TRACE_CSG_BOUNDS_H

#include "trace/bounds.h"
#include "trace/shapes.h"

static inline bool node_is_all(const TreeNode *node)
{
    return node->op == NODE_INTERSECTION || node->op == NODE_CLIP;
}

// Whether its children have become its parent's, and it is nothing any more.
static inline bool node_is_joined(const TreeNode *node)
{
    return node->needed == UINT32_MAX;
}

// Makes the table's nodes from those of a scene. One that does what the node around it does is joined with that.
void csg_nodes_init(ShapeTable *table, const Scene *scene);

// What the tree's nodes count of children, and the box that holds what may be seen of it. `surfaces`: the boxes of all
// primitives' surfaces; `inner` and `next` have room for a box of each of the table's nodes. In `inner` what holds all
// of a node that may matter to what is seen.
Bounds csg_measure(ShapeTable *table, const CsgTree *csg, const Bounds *surfaces, Bounds *inner, Bounds *next);

#endif
