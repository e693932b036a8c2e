// The inside of a Geometry, for trace/ and the inline queries only.
//
// Arrays of prepared shapes, one for each kind; a ShapeId is an index into one of them. Spheres come in two runs: loose
// ones first, which are tested one after the other, then those of the tree, in the tree's order.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_GEOMETRY_H
#define TRACE_GEOMETRY_H

#include <stdint.h>

#include "trace/bvh.h"
#include "trace/ellipsoid.h"
#include "trace/plane.h"
#include "trace/sphere.h"
#include "trace/trace.h"

enum {
    LOOSE_SPHERES_MOST = 8, // a scene with no more than these has no tree
};

typedef struct EllipsoidEntry {
    EllipsoidShape shape;
    ShapeInfo info;
} EllipsoidEntry;

typedef struct PlaneEntry {
    PlaneShape shape;
    ShapeInfo info;
} PlaneEntry;

struct Geometry {
    unsigned features;
    BallTable spheres;
    uint32_t loose_count;
    Bvh bvh; // of the spheres from loose_count on; empty when there are none
    EllipsoidEntry *ellipsoids;
    uint32_t ellipsoid_count;
    PlaneEntry *planes;
    uint32_t plane_count;
};

#endif
