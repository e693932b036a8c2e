// Whether a point is inside of a shape, by its numbers alone.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_WITHIN_H
#define SCENE_WITHIN_H

#include "scene/scene.h"

// POV-Ray's planes are so thick, for points. Measured.
#define WITHIN_PLANE 1e-10

// Of a primitive that stands alone. A disc has all that is below it for its inside, a triangle nothing.
bool within_part(const Primitive *primitive, Vec3 point);

// Of a composite, as where a ray starts (StartShape).
bool within_composite(const Scene *scene, const Composite *composite, Vec3 point);

// Of the object of one of Scene.insides.
bool within_inside(const Scene *inside, Vec3 point);

#endif
