// Single shapes as somebody sees them who looks at the whole from outside: how far each reaches, whether a line crosses
// it, and whether it is what a camera ray meets first.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_EXTENT_H
#define TRACE_EXTENT_H

#include "trace/trace.h"

// An ellipsoid around a shape: of the points centre + x axes[0] + y axes[1] + z axes[2] with x² + y² + z² <= 1.
typedef struct Extent {
    ShapeId shape; // without a side
    bool is_ball;  // a sphere: it is that ellipsoid
    MaterialIndex material;
    Vec3 centre, axes[3];
} Extent;

// How many places there are for shapes that have an extent.
uint32_t extent_count(const Geometry *geometry);

// False where there is none in that place: no shape, one without bounds or invisible to the camera, or a leaf of a
// composite.
bool extent_get(const Geometry *geometry, uint32_t place, Extent *extent);

// That of a shape that has one.
void extent_of(const Geometry *geometry, ShapeId shape, Extent *extent);

// The place of that.
uint32_t extent_place(const Geometry *geometry, ShapeId shape);

// Whether a ray crosses a shape that has one, whatever is before it.
bool extent_is_crossed(const Geometry *geometry, ShapeId shape, Ray ray);

// A plane by its number, by a point of it and its normal. False past the last.
bool extent_plane(const Geometry *geometry, uint32_t number, ShapeId *shape, Vec3 *point, Vec3 *normal,
                  MaterialIndex *material);

// Whether anything is before `distance` on a shadow ray that leaves a sphere's outside, or the plane of that normal.
bool extent_is_dark(const Geometry *geometry, ShapeId shape, const Vec3 *normal, Ray ray, double distance);

// What a camera ray meets first; false when it meets nothing.
bool extent_first(const Geometry *geometry, Ray ray, Hit *hit, Surface *surface);

typedef enum ExtentSight {
    EXTENT_SEEN,   // it is what the camera ray meets first
    EXTENT_BEHIND, // another shape is, of the material *before
    EXTENT_MISSED, // the ray meets nothing
} ExtentSight;
ExtentSight extent_sight(const Geometry *geometry, ShapeId shape, Ray ray, MaterialIndex *before);

#endif
