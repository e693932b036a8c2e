// Rays and isosurfaces (scene/isosurface.h): what of a line is inside, and normals.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_ISOSURFACE_H
#define TRACE_ISOSURFACE_H

#include "scene/isosurface.h"
#include "trace/prepared_primitive.h"

// Its sides.
enum {
    ISOSURFACE_SIDE,   // where the function is at the threshold
    ISOSURFACE_UNSEEN, // bounds what is inside and is not seen, as where surfaces are that nobody asked for
    ISOSURFACE_BALL,   // the container, a ball
    ISOSURFACE_BOX = ISOSURFACE_BALL, // or a box, whose six sides follow
};

// As PreparedClass has them. Of an isosurface that stands alone nothing is known behind the first surface that is seen.
unsigned isosurface_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                              RayInterval *intervals);
Vec3 isosurface_normal(const PreparedPrimitive *primitive, Vec3 point, uint8_t side);
Vec3 isosurface_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side);

#endif
