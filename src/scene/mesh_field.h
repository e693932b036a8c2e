// Fields of heights: a mesh over a grid, with two triangles between each four heights.
//
// In its own space a column and a row are 1 each, so that vertices are exact in single precision. What is inside is
// known by one cell. Owns nothing. Knows nothing of where heights come from.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_MESH_FIELD_H
#define SCENE_MESH_FIELD_H

#include "base/attributes.h"
#include "scene/mesh.h"

enum { FIELD_HEIGHTS = 65536 }; // of a height of 1

// A field of so many heights, all 0, with room for the mesh; NULL when out of memory. Both sides are at least 2, and
// mesh_field_faces of them at most MESH_FACES_MOST. It must be built.
Mesh *mesh_field_new(uint32_t columns, uint32_t rows) RT_MUST_CHECK;
// How many triangles it has, and how many bytes it takes; a smooth one has normals, too.
double mesh_field_faces(double columns, double rows);
size_t mesh_field_bytes(uint32_t columns, uint32_t rows, bool is_smooth);

// Sets vertices, faces and bounds when all heights are set.
void mesh_field_build(Mesh *mesh);
// Gives a built one normals at its vertices. False when out of memory.
bool mesh_field_smooth(Mesh *mesh) RT_MUST_CHECK;

// The far corner of a field of height 1, which is that of the unit cube before it is scaled by this.
Vec3 mesh_field_size(const MeshField *field);

// Whether a point is over or below the field, and how high the field is there.
bool mesh_field_is_over(const MeshField *field, Vec3 point);
double mesh_field_height(const MeshField *field, Vec3 point);
// Whether a point of its space is inside: below the surface or below the water.
bool mesh_field_holds(const MeshField *field, Vec3 point);

// Upward vectors along the normals at a point of a face, in the field's space: one, or those of the cell's corners.
// Returns how many; in the scene they are made of length 1 and mixed by the weights.
int mesh_field_normals(const MeshField *field, uint32_t face, Vec3 point, Vec3 normals[4], double weights[4]);

#endif
