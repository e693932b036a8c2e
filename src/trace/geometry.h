// The inside of a Geometry, for trace/ and the inline queries only.
//
// Arrays of prepared shapes, one for each kind; a ShapeId is an index into one of them, a slot of the table for
// spheres.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_GEOMETRY_H
#define TRACE_GEOMETRY_H

#include <stdint.h>

#include "trace/plane.h"
#include "trace/shapes.h"
#include "trace/spheres.h"
#include "trace/trace.h"

typedef struct PlaneEntry {
    PlaneShape shape;
    ShapeInfo info;
} PlaneEntry;

struct Geometry {
    unsigned features;
    const SphereKernels *kernels; // for this processor, or as given
    SphereTable spheres;
    PlaneEntry *planes;
    uint32_t plane_count;
    ShapeTable shapes;           // everything else
    struct Elsewhere *elsewhere; // NULL: all spheres are here; else trace/elsewhere.h has them, and those above are
                                 // what rays have met
};

#endif
