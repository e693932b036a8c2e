// What was read of a mesh becomes the scene's record and the block's description: arrays shrink to what they hold,
// faces get normals and the final numbers of their textures, and all that failed is freed. Textures of faces stay
// descriptions until the mesh is placed.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/pages.h"
#include "eval/build/mesh_reader.h"
#include "scene/room.h"

bool mesh_reader_grow(MeshReader *reader, MeshArray *array, size_t wanted)
{
    Eval *ev = reader->block->ev;
    enum { LEAST_ROOM = 16 }; // what is left over of more lies idle between the arrays of many small meshes
    size_t room = array->room * 2 > LEAST_ROOM ? array->room * 2 : LEAST_ROOM;
    room = room < wanted && array->room * 4 >= wanted ? wanted : room;
    const MeshArray *all[] = {&reader->vertices, &reader->normals, &reader->faces, &reader->face_normals,
                              &reader->face_textures};
    size_t taken = 0;
    for (size_t i = 0; i < RT_COUNT_OF(all); i++) {
        taken += all[i]->room * all[i]->size;
    }
    if (eval_cancelled(ev)) {
        return false;
    }
    if (!memory_has(ev, taken + room * array->size)) {
        ev->memory.refused = true;
        return eval_no_memory(ev, reader->block->node->span);
    }
    void *items = pages_grow(array->items, array->room * array->size, room * array->size);
    if (!items) {
        return eval_no_memory(ev, reader->block->node->span);
    }
    array->items = items;
    array->room = room;
    return true;
}

// The memory beyond an array's end goes back.
static void *trim(MeshArray *array)
{
    void *items = array->count > 0 ? realloc(array->items, array->count * array->size) : NULL;
    return items ? items : array->items;
}

bool mesh_reader_may_have_faces(MeshReader *reader, uint32_t count, Span span)
{
    Eval *ev = reader->block->ev;
    if (scene_has_room(ev->scene, count, ev->options.limits, ev->options.diags, span)) {
        return true;
    }
    ev->stop = true;
    return false;
}

void mesh_normalise(Eval *ev, double v[3], Span span)
{
    double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    if (square == 0.0) {
        eval_warn(ev, DIAG_W0470, span, "a normal of 0 has no direction; x is taken instead");
        v[0] = 1.0;
    } else if (!mesh_normal_is_unit(v)) {
        double length = sqrt(square);
        for (int i = 0; i < 3; i++) {
            v[i] /= length;
        }
    }
}

// ---- surface coordinates

bool mesh_read_uv(Cursor *cursor, Span span, double v[2])
{
    Value value;
    if (!cursor_value(cursor, &value)) {
        return false;
    }
    if (value.kind == VALUE_VECTOR && value.components == 2) {
        v[0] = value.v[0];
        v[1] = value.v[1];
        return true;
    }
    if (value.kind == VALUE_VECTOR) {
        return eval_fault(cursor->ev, DIAG_E0254, span, "surface coordinates are vectors of 2, not %s",
                          value_describe(&value));
    }
    bool is_number = value_number(cursor->ev, &value, span, &v[0]);
    v[1] = v[0];
    return is_number;
}

// ---- textures

bool mesh_reader_texture_of(MeshReader *reader, const Value *value, Span span, const TextureDesc **texture)
{
    Eval *ev = reader->block->ev;
    if (value->kind == VALUE_BLOCK && value->block == KIND_UNSUPPORTED) {
        block_unsupported_name(ev, value->record, span);
        reader->block->has_unsupported = true;
        return false;
    }
    if (value->kind != VALUE_BLOCK || value->block != KIND_TEXTURE) {
        return block_fault(reader->block, DIAG_E0258, span, "expected a texture, found %s", value_describe(value));
    }
    block_tell_lacks(ev, value, span);
    *texture = value->record;
    return true;
}

bool mesh_reader_add_texture(MeshReader *reader, const TextureDesc *texture, uint32_t *index)
{
    Block *block = reader->block;
    if (reader->texture_count == reader->texture_room) {
        uint32_t room = reader->texture_room ? 2 * reader->texture_room : 8;
        const TextureDesc **textures = arena_alloc(block->arena, room * sizeof *textures);
        if (!textures) {
            return eval_no_memory(block->ev, block->node->span);
        }
        if (reader->texture_count > 0) {
            memcpy(textures, reader->textures, reader->texture_count * sizeof *textures);
        }
        reader->textures = textures;
        reader->texture_room = room;
    }
    *index = reader->texture_count;
    reader->textures[reader->texture_count++] = texture;
    return true;
}

// Of a mesh2: whether the face that is being read has its corners on one line.
static bool face_is_line(const MeshReader *reader, uint32_t face)
{
    if (face >= reader->faces.room || reader->face_normals.room > 0) {
        return false; // of a `mesh`, which makes its faces' vertices later, and leaves such triangles out itself
    }
    const uint32_t *corners = ((uint32_t(*)[3])reader->faces.items)[face];
    const float(*vertices)[3] = reader->vertices.items;
    Vec3 a = mesh_vector(vertices[corners[0]]);
    Vec3 first = vec3_sub(mesh_vector(vertices[corners[1]]), a),
         second = vec3_sub(mesh_vector(vertices[corners[2]]), a);
    return vec3_equal(vec3_cross(first, second), vec3(0.0, 0.0, 0.0));
}

// The texture of a face with these at its corners: what lies between them. Where all are the same one, too: near the
// corners and edges POV-Ray draws less of it, see walk_corners of render/surface/texture.c.
bool mesh_reader_join_corners(MeshReader *reader, const uint32_t indices[3], uint32_t face, Span span,
                              uint32_t *texture)
{
    Block *block = reader->block;
    const TextureDesc *const corners[3] = {reader->textures[indices[0]], reader->textures[indices[1]],
                                           reader->textures[indices[2]]};
    bool is_same = indices[0] == indices[1] && indices[0] == indices[2], may_blend = mesh_textures_blend(corners);
    *texture = indices[0] + 1;
    if (face_is_line(reader, face) || (is_same && !may_blend)) {
        return true;
    }
    if (!may_blend) {
        return block_fault(block, DIAG_E0251, span,
                           "a face with patterns, layers or bumps at its corners is not supported by rtlang");
    }
    if (reader->corner_count == reader->corner_room) {
        uint32_t room = reader->corner_room ? 2 * reader->corner_room : 8;
        MeshCorners *all = arena_alloc(block->arena, room * sizeof *all);
        if (!all) {
            return eval_no_memory(block->ev, span);
        }
        if (reader->corner_count > 0) {
            memcpy(all, reader->corners, reader->corner_count * sizeof *all);
        }
        reader->corners = all;
        reader->corner_room = room;
    }
    *texture = MESH_FACE_OF_CORNERS | reader->corner_count;
    reader->corners[reader->corner_count++] = (MeshCorners){face, {indices[0], indices[1], indices[2]}};
    return true;
}

// ---- the record

// Faces behind the last one that has normals are flat.
static bool settle_face_normals(MeshReader *reader)
{
    MeshArray *normals = &reader->face_normals;
    while (normals->count > 0 && normals->count < reader->faces.count) {
        if (!mesh_reader_has_room(reader, normals, reader->faces.count)) {
            return false;
        }
        uint32_t *indices = ((uint32_t(*)[3])normals->items)[normals->count++];
        indices[0] = indices[1] = indices[2] = MESH_FLAT;
    }
    return true;
}

// Without indices of their own, normals are those of the vertices.
static bool settle_normals(MeshReader *reader)
{
    Block *block = reader->block;
    Mesh *mesh = reader->mesh;
    if (reader->normals.count > 0 && reader->face_normals.count == 0) {
        if (reader->normals.count != reader->vertices.count) {
            return block_fault(block, DIAG_E0474, block->node->span,
                               "%zu normals of %zu vertices need `normal_indices`", reader->normals.count,
                               reader->vertices.count);
        }
        mesh->face_normals = mesh->faces;
        return true;
    }
    mesh->face_normals = trim(&reader->face_normals);
    return true;
}

// Likewise surface coordinates.
static bool settle_uvs(MeshReader *reader)
{
    Block *block = reader->block;
    Mesh *mesh = reader->mesh;
    if (mesh->uv_count == 0 || mesh->face_uvs) {
        return true;
    }
    mesh->face_uvs = mesh->faces;
    return reader->uvs.count == reader->vertices.count ||
           block_fault(block, DIAG_E0474, block->node->span, "%zu uv vectors of %zu vertices need `uv_indices`",
                       reader->uvs.count, reader->vertices.count);
}

// After a fault nothing is said of the lists and triangles that are left.
static bool pass_over(Block *block)
{
    static const Word words[] = {W_vertex_vectors, W_normal_vectors, W_uv_vectors, W_texture_list,   W_face_indices,
                                 W_uv_indices,     W_normal_indices, W_triangle,   W_smooth_triangle};
    const AstNode *item;
    while ((item = cursor_peek(&block->cursor)) && item->kind == AST_BLOCK) {
        bool is_passed = false;
        for (size_t i = 0; i < RT_COUNT_OF(words); i++) {
            is_passed = is_passed || item->symbol == (Symbol)words[i];
        }
        if (!is_passed) {
            break;
        }
        block->cursor.has_comma = false;
        cursor_skip(&block->cursor);
    }
    return false;
}

// Faces behind the last one with a texture have that of the mesh.
static bool settle_face_textures(MeshReader *reader)
{
    MeshArray *textures = &reader->face_textures;
    while (textures->count > 0 && textures->count < reader->faces.count) {
        if (!mesh_reader_has_room(reader, textures, reader->faces.count)) {
            return false;
        }
        ((uint32_t *)textures->items)[textures->count++] = 0;
    }
    return true;
}

// Numbers the textures anew: those that some face has alone, then those of corners.
static bool settle_textures(MeshReader *reader, MeshDesc *desc)
{
    Block *block = reader->block;
    Mesh *mesh = reader->mesh;
    uint32_t *places = arena_alloc(block->arena, (reader->texture_count + 1) * sizeof *places);
    desc->singles = arena_alloc(block->arena, (reader->texture_count + 1) * sizeof *desc->singles);
    if (!places || !desc->singles) {
        return eval_no_memory(block->ev, block->node->span);
    }
    memset(places, 0, (reader->texture_count + 1) * sizeof *places);
    for (uint32_t face = 0; face < mesh->face_count; face++) {
        uint32_t texture = mesh->face_textures[face];
        places[texture & MESH_FACE_OF_CORNERS ? 0 : texture] = 1;
    }
    desc->single_count = 0;
    for (uint32_t i = 1; i <= reader->texture_count; i++) {
        if (places[i]) {
            desc->singles[desc->single_count++] = reader->textures[i - 1];
            places[i] = desc->single_count;
        }
    }
    places[0] = 0;
    for (uint32_t face = 0; face < mesh->face_count; face++) {
        uint32_t texture = mesh->face_textures[face];
        mesh->face_textures[face] = texture & MESH_FACE_OF_CORNERS
                                        ? desc->single_count + (texture & ~MESH_FACE_OF_CORNERS) + 1
                                        : places[texture];
    }
    mesh->texture_count = desc->single_count + reader->corner_count;
    return true;
}

bool mesh_reader_finish(MeshReader *reader, bool is_fine)
{
    Block *block = reader->block;
    Mesh *mesh = reader->mesh;
    is_fine = is_fine && settle_face_textures(reader) && settle_face_normals(reader);
    mesh->vertices = trim(&reader->vertices);
    mesh->normals = trim(&reader->normals);
    mesh->faces = trim(&reader->faces);
    mesh->face_textures = trim(&reader->face_textures);
    mesh->uvs = trim(&reader->uvs);
    mesh->face_uvs = trim(&reader->face_uvs);
    mesh->uv_count = (uint32_t)reader->uvs.count;
    mesh->vertex_count = (uint32_t)reader->vertices.count;
    mesh->normal_count = (uint32_t)reader->normals.count;
    mesh->face_count = (uint32_t)reader->faces.count;
    mesh->source = block->node->span.begin;
    mesh->face_normals = reader->face_normals.items;
    is_fine = is_fine && settle_normals(reader) && settle_uvs(reader);
    MeshDesc *desc = &block->record->mesh;
    is_fine = is_fine && (!mesh->face_textures || settle_textures(reader, desc));
    if (is_fine) {
        mesh_measure(mesh);
        is_fine = scene_add_mesh(block->ev->scene, mesh) || eval_no_memory(block->ev, block->node->span);
    }
    if (!is_fine) {
        mesh_free(mesh);
        return pass_over(block);
    }
    desc->mesh = mesh;
    desc->textures = reader->textures;
    desc->corners = reader->corners;
    desc->corner_count = reader->corner_count;
    return true;
}

bool mesh_reader_begin(MeshReader *reader, Block *block)
{
    *reader = (MeshReader){.block = block, .mesh = mesh_new()};
    reader->vertices.size = reader->normals.size = 3 * sizeof(float);
    reader->uvs.size = 2 * sizeof(float);
    reader->faces.size = reader->face_normals.size = reader->face_uvs.size = 3 * sizeof(uint32_t);
    reader->face_textures.size = sizeof(uint32_t);
    return reader->mesh || eval_no_memory(block->ev, block->node->span);
}
