// The box around a composite of which planes or quadrics cut something off.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_CSG_BOUNDS_H
#define TRACE_CSG_BOUNDS_H

#include "trace/bounds.h"
#include "trace/shapes.h"

// A box that holds what may be seen of the composite and lies within `bounds`, which holds it, too. `surfaces`: the
// boxes of all primitives' surfaces; `inner` and `next` have room for a box of each of the table's nodes. In `inner`
// what holds all of a node that may matter to what is seen.
Bounds csg_bounds(const ShapeTable *table, const CsgTree *csg, const Bounds *surfaces, Bounds bounds, Bounds *inner,
                  Bounds *next);

// Nothing is seen of a composite outside of the planes that decide; where they enclose a space, the box of that.
Bounds csg_planes_bounds(const ShapeTable *table, const CsgTree *csg);

#endif
