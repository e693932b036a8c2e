// A mesh while its text is read: arrays that grow become the scene's record, and textures get the numbers that faces
// refer to. `mesh` and `mesh2` fill it, each in its own way (mesh.c, mesh2.c). Owns the arrays until
// mesh_reader_finish; descriptions of textures belong to the block's arena.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_MESH_READER_H
#define EVAL_MESH_READER_H

#include <math.h>

#include "eval/build/blocks.h"

// One of the mesh's lists while it grows: `items` has room for `room` items of `size` bytes, of which `count` are set.
typedef struct MeshArray {
    void *items; // becomes one of Mesh
    size_t count, room, size;
} MeshArray;

typedef struct MeshReader {
    Block *block;
    Mesh *mesh;
    MeshArray vertices, normals, faces, face_normals, face_textures; // as in Mesh
    MeshArray uvs, face_uvs; // likewise
    const TextureDesc **textures; // in the order in which they are declared; faces count them from 1 while reading
    uint32_t texture_count, texture_room;
    MeshCorners *corners; // faces with several textures
    uint32_t corner_count, corner_room;
} MeshReader;

// In face_textures while reading: the other bits are a place in `corners`, and not a texture.
#define MESH_FACE_OF_CORNERS (UINT32_C(1) << 31)

// Of the functions that return bool and are not said to do otherwise, false: a fault is reported.

bool mesh_reader_begin(MeshReader *reader, Block *block) RT_MUST_CHECK;
// Makes the record and hands it to the scene; the block's description refers to it. is_fine: all went well so far; if
// it did not, frees what was read and skips the rest of the block's lists and triangles without a word.
bool mesh_reader_finish(MeshReader *reader, bool is_fine) RT_MUST_CHECK;

// Room for more items; `wanted` is how many the text says there will be, 0 if it does not say.
bool mesh_reader_grow(MeshReader *reader, MeshArray *array, size_t wanted) RT_MUST_CHECK;

// Makes room for one item more.
RT_ALWAYS_INLINE bool mesh_reader_has_room(MeshReader *reader, MeshArray *array, size_t wanted)
{
    return RT_LIKELY(array->count < array->room) || mesh_reader_grow(reader, array, wanted);
}

// Whether the limits allow `count` more faces.
bool mesh_reader_may_have_faces(MeshReader *reader, uint32_t count, Span span) RT_MUST_CHECK;

bool mesh_reader_texture_of(MeshReader *reader, const Value *value, Span span,
                            const TextureDesc **texture) RT_MUST_CHECK;
// *index: its place, from 0 on.
bool mesh_reader_add_texture(MeshReader *reader, const TextureDesc *texture, uint32_t *index) RT_MUST_CHECK;
// What a face refers to that has the textures of these places at its corners: *texture is for face_textures.
bool mesh_reader_join_corners(MeshReader *reader, const uint32_t indices[3], uint32_t face, Span span,
                              uint32_t *texture) RT_MUST_CHECK;

// Of unit length within single precision. Such a normal stays as it is, so that a dump reads back as the same.
static inline bool mesh_normal_is_unit(const double v[3])
{
    return fabs(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] - 1.0) < 0x1p-22;
}

// Makes a normal one of unit length. A normal of 0 becomes x, with a warning at `span`.
void mesh_normalise(Eval *ev, double v[3], Span span);

// Rounds to single precision. False, without a report: what is too large for it is no place.
static inline bool mesh_narrow(const double v[3], float narrowed[3])
{
    for (int i = 0; i < 3; i++) {
        narrowed[i] = (float)v[i];
    }
    float nothing = narrowed[0] * 0.0F + narrowed[1] * 0.0F + narrowed[2] * 0.0F;
    return RT_LIKELY(nothing == 0.0F);
}
// Reads <u, v>, or one number that stands for both.
bool mesh_read_uv(Cursor *cursor, Span span, double v[2]) RT_MUST_CHECK;

static inline bool mesh_narrow_uv(const double v[2], float narrowed[2])
{
    narrowed[0] = (float)v[0];
    narrowed[1] = (float)v[1];
    return narrowed[0] * 0.0F + narrowed[1] * 0.0F == 0.0F;
}
#define MESH_NOT_NARROW "a coordinate of a mesh must be finite and within single precision, about 3.4e38"

#endif
