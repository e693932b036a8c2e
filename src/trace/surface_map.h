// Surface coordinates: where on its shape a point is, as `uv_mapping` asks for it.
//
// Spheres, eggs, boxes, tori, lathes, surfaces of revolution, parametric surfaces and faces of meshes have coordinates of their own, which move
// and stretch with the shape; all others are laid out by x and y of the scene's text. All measured of POV-Ray;
// docs/language.md has the formulas. Knows nothing of textures.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SURFACE_MAP_H
#define TRACE_SURFACE_MAP_H

#include "trace/trace.h"

// <u, v, 0> of a point that a ray of a direction met on a shape; `place` is the point in the scene's lengths.
Vec3 geometry_uv(const Geometry *geometry, const Scene *scene, ShapeId shape, Vec3 point, Vec3 direction, Vec3 place);

#endif
