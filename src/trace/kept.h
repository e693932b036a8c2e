// A geometry that serves several pictures, and follows its scene between them.
//
// Of a scene's records more are added, and spheres get other numbers; all else stays. So the kinds of shapes that there
// are more of are prepared again, and spheres that may have changed are brought up to date in the tree that there is, as long
// as that is a good one. The pictures are those of a new geometry, bit for bit.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_KEPT_H
#define TRACE_KEPT_H

#include "trace/spheres_refit.h"
#include "trace/trace.h"

struct GeometryKept {
    Geometry *geometry; // NULL: none yet; owned
    int exponent;       // that it was made with
    size_t spheres, planes, parts; // how many of the scene's records it has
    SphereRange changed; // spheres that may not be as it has them
    bool is_elsewhere;   // the places of all shapes may be others
    SphereRefit refit;
    unsigned builds, refits; // how often a tree was built, and how often that of the spheres stayed for others
};

// Spheres begin <= i < end of the scene have changed.
void geometry_kept_change(GeometryKept *kept, size_t begin, size_t end);

// A geometry as geometry_new_with would make it, but for the order of its spheres. It belongs to `kept`. NULL when out of
// memory.
Geometry *geometry_kept_take(GeometryKept *kept, const Scene *scene, int exponent,
                             const GeometryOptions *options) RT_MUST_CHECK;
void geometry_kept_fini(GeometryKept *kept);

#endif
