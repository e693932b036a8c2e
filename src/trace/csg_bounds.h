// The box around a composite of which planes or quadrics cut something off.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_CSG_BOUNDS_H
#define TRACE_CSG_BOUNDS_H

#include "trace/bounds.h"
#include "trace/shapes.h"

// What the tree's nodes count of children, and the box that holds what may be seen of it. `surfaces`: the boxes of all
// primitives' surfaces; `inner` and `next` have room for a box of each of the table's nodes. In `inner` what holds all
// of a node that may matter to what is seen.
Bounds csg_measure(ShapeTable *table, const CsgTree *csg, const Bounds *surfaces, Bounds *inner, Bounds *next);

#endif
