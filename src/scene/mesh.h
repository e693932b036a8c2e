// Meshes: triangles that share their corners, as `mesh` and `mesh2` describe them.
//
// One record holds the lists of a mesh in its own space, in single precision as POV-Ray has them; parts place it under
// maps, as often as they like. Owns the lists. Knows nothing of materials but their numbers, and nothing of trees.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_MESH_H
#define SCENE_MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/attributes.h"
#include "math/vec3.h"

enum {
    MESH_FLAT = UINT32_MAX,    // in the place of a face's first normal: it has none
    MESH_FACES_MOST = 1 << 28, // what a tree of them has room for
};

// The field of heights that a mesh is made of: vertices over a grid of columns in x and rows in z, each 1 from the
// next, with heights of 16 bits, 0 to 1, in y. What is below its surface or its water is inside, however deep, and
// nothing beside it is.
typedef struct MeshField {
    uint32_t columns, rows; // each at least 2
    uint16_t *heights;      // of 65536; row by row from z = 0 on; owned
    int16_t (*normals)[3];  // of 32767, where a column, a row and a height are 1 each; NULL: faces are flat; owned
    double water;           // no surface lies below this height
} MeshField;

typedef struct Mesh {
    uint32_t vertex_count, normal_count, face_count, texture_count;
    float (*vertices)[3];
    float (*normals)[3];         // of length 1
    uint32_t (*faces)[3];        // three of the vertices each
    uint32_t (*face_normals)[3]; // three of the normals each, or MESH_FLAT; NULL: all are flat; may be `faces`
    uint32_t *face_textures;     // from 1 on; 0: that of the mesh; NULL: all have that
    uint32_t uv_count;
    float (*uvs)[2];         // surface coordinates; NULL: all are 0
    uint32_t (*face_uvs)[3]; // three of these each; may be `faces`
    double (*uv_corners)[2]; // of a patch: what the coordinates of <0, 0>, <1, 0>, <1, 1>, <0, 1> become; NULL: those
    Vec3 inside_vector;
    bool has_inside;  // what an odd number of faces is before, along inside_vector
    Vec3 low, high;   // of the vertices that faces have
    MeshField *field; // NULL: none; owned. Faces have no normals then
    uint32_t number;  // among those of Scene.meshes whose faces have no textures of their own
    uint64_t source;
} Mesh;

// An empty mesh; NULL when out of memory.
Mesh *mesh_new(void) RT_MUST_CHECK;
void mesh_free(Mesh *mesh); // NULL is allowed
size_t mesh_bytes(const Mesh *mesh);

// Sets `low` and `high`. The indices are valid, and there is a face.
void mesh_measure(Mesh *mesh);

// Whether a point of its space is inside: it asks all faces.
bool mesh_holds(const Mesh *mesh, Vec3 point);

static inline Vec3 mesh_vector(const float v[3])
{
    return vec3((double)v[0], (double)v[1], (double)v[2]);
}

static inline Vec3 mesh_corner(const Mesh *mesh, uint32_t face, int corner)
{
    return mesh_vector(mesh->vertices[mesh->faces[face][corner]]);
}

// A vector along the normal of a face, on the side where its corners go round clockwise. Measured.
static inline Vec3 mesh_face_normal(const Mesh *mesh, uint32_t face)
{
    Vec3 a = mesh_corner(mesh, face, 0);
    return vec3_cross(vec3_sub(mesh_corner(mesh, face, 2), a), vec3_sub(mesh_corner(mesh, face, 1), a));
}

// What <u, v> becomes between the four corners of a patch, if there are any.
static inline void mesh_uv_settle(const Mesh *mesh, double uv[2])
{
    if (mesh->uv_corners) {
        double u = uv[0], v = uv[1];
        for (int k = 0; k < 2; k++) {
            double first = (1.0 - u) * mesh->uv_corners[0][k] + u * mesh->uv_corners[1][k];
            double last = (1.0 - u) * mesh->uv_corners[3][k] + u * mesh->uv_corners[2][k];
            uv[k] = (1.0 - v) * first + v * last;
        }
    }
}

static inline bool mesh_face_is_smooth(const Mesh *mesh, uint32_t face)
{
    return mesh->face_normals && mesh->face_normals[face][0] != MESH_FLAT;
}

#endif
