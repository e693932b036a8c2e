// The box around a composite that its parts' boxes and planes alone do not bound: planes and quadrics that cut one
// another.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_CSG_BOUNDS_H
#define TRACE_CSG_BOUNDS_H

#include "trace/bounds.h"
#include "trace/shapes.h"

// A box that holds what may be seen of the composite. `surfaces`: the boxes of all solids' surfaces; `inner` and `next`
// have room for a box of each of the table's nodes. BOUNDS_ALL where none was found.
Bounds csg_bounds(const ShapeTable *table, const CsgTree *csg, const Bounds *surfaces, Bounds *inner, Bounds *next);

#endif
