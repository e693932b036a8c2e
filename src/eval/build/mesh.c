// `mesh { triangles }` becomes a mesh: each triangle adds three vertices, its normals if it is smooth, and the number
// of the texture that it names. Triangles with their corners on one line are left out.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "eval/build/mesh_reader.h"

static bool add_corner(MeshReader *reader, const double v[3], Span span)
{
    if (!mesh_reader_has_room(reader, &reader->vertices, 0)) {
        return false;
    }
    if (!mesh_narrow(v, ((float(*)[3])reader->vertices.items)[reader->vertices.count])) {
        return block_fault(reader->block, DIAG_E0472, span, MESH_NOT_NARROW);
    }
    reader->vertices.count++;
    return true;
}

static bool add_normal(MeshReader *reader, double v[3], Span span)
{
    if (!mesh_reader_has_room(reader, &reader->normals, 0)) {
        return false;
    }
    mesh_normalise(reader->block->ev, v, span);
    float *normal = ((float(*)[3])reader->normals.items)[reader->normals.count];
    for (int i = 0; i < 3; i++) {
        normal[i] = (float)v[i];
        if (!isfinite(normal[i])) {
            return block_fault(reader->block, DIAG_E0472, span, "a normal of a mesh must be finite");
        }
    }
    reader->normals.count++;
    return true;
}

// A texture of a triangle is a name.
static bool read_named_texture(MeshReader *reader, Cursor *cursor, Span around, uint32_t *index)
{
    Value value;
    const TextureDesc *texture;
    const AstNode *item = cursor_peek(cursor);
    if (!item || !block_is_name(item)) {
        return block_fault(reader->block, DIAG_E0258, item ? item->span : around,
                           "a triangle of a mesh takes the name of a texture here");
    }
    Span span = item->span;
    cursor_skip(cursor);
    if (!eval_expression(reader->block->ev, item, &value) || !mesh_reader_texture_of(reader, &value, span, &texture)) {
        return false;
    }
    for (uint32_t i = 0; i < reader->texture_count; i++) {
        if (reader->textures[i] == texture) {
            *index = i;
            return true;
        }
    }
    return mesh_reader_add_texture(reader, texture, index);
}

static bool read_triangle_texture(MeshReader *reader, const AstNode *item, uint32_t *index)
{
    Cursor cursor;
    bool is_list = item->symbol == (Symbol)W_texture_list;
    uint32_t indices[3];
    cursor_open(&cursor, reader->block->ev, item->a, item->span);
    bool is_fine = true;
    for (int i = 0; i < (is_list ? 3 : 1) && is_fine; i++) {
        cursor_take_comma(&cursor);
        is_fine = read_named_texture(reader, &cursor, item->span, &indices[i]);
    }
    *index = is_fine ? indices[0] + 1 : 0;
    if (is_fine && is_list) {
        is_fine = mesh_reader_join_corners(reader, indices, (uint32_t)reader->faces.count, item->span, index);
    }
    if (is_fine && cursor_peek(&cursor)) {
        is_fine = block_fault(reader->block, DIAG_E0254, cursor_peek(&cursor)->span, "one value too many in %s",
                              eval_text(reader->block->ev, item->symbol));
    }
    cursor_close(&cursor);
    return is_fine;
}

// Surface coordinates of the corners.
typedef struct TriangleUv {
    double corners[3][2];
    bool is_given;
} TriangleUv;

static bool read_uv(MeshReader *reader, Cursor *cursor, Span word, TriangleUv *uv)
{
    uv->is_given = true;
    for (int i = 0; i < 3; i++) {
        float narrowed[2];
        cursor_take_comma(cursor);
        const AstNode *item = cursor_peek(cursor);
        if (!item || !cursor_at_value(cursor)) {
            return block_fault(reader->block, DIAG_E0253, item ? item->span : word,
                               "`uv_vectors` needs three vectors of 2 after it");
        }
        if (!mesh_read_uv(cursor, item->span, uv->corners[i])) {
            return false;
        }
        if (!mesh_narrow_uv(uv->corners[i], narrowed)) {
            return block_fault(reader->block, DIAG_E0472, item->span, MESH_NOT_NARROW);
        }
    }
    return true;
}

// Of a triangle that gives none they are 0; a mesh in which none does has no list of them.
static bool add_uv(MeshReader *reader, const TriangleUv *uv)
{
    if (!uv->is_given && reader->uvs.count == 0) {
        return true;
    }
    // The first one is 0, for the triangles so far that gave none.
    while (reader->uvs.count == 0 || reader->face_uvs.count < reader->faces.count) {
        if (!mesh_reader_has_room(reader, &reader->uvs, 0) || !mesh_reader_has_room(reader, &reader->face_uvs, 0)) {
            return false;
        }
        if (reader->uvs.count == 0) {
            memset(reader->uvs.items, 0, 2 * sizeof(float));
            reader->uvs.count = 1;
        } else {
            memset(((uint32_t(*)[3])reader->face_uvs.items)[reader->face_uvs.count++], 0, 3 * sizeof(uint32_t));
        }
    }
    uint32_t indices[3] = {0, 0, 0};
    for (int i = 0; uv->is_given && i < 3; i++) {
        if (!mesh_reader_has_room(reader, &reader->uvs, 0)) {
            return false;
        }
        indices[i] = (uint32_t)reader->uvs.count;
        (void)mesh_narrow_uv(uv->corners[i], ((float(*)[2])reader->uvs.items)[reader->uvs.count++]);
    }
    if (!mesh_reader_has_room(reader, &reader->face_uvs, 0)) {
        return false;
    }
    memcpy(((uint32_t(*)[3])reader->face_uvs.items)[reader->face_uvs.count++], indices, sizeof indices);
    return true;
}

// What may stand behind the corners: a texture, and uv_vectors.
static bool read_triangle_end(MeshReader *reader, Cursor *cursor, uint32_t *texture, TriangleUv *uv)
{
    const AstNode *item;
    while ((item = cursor_peek(cursor))) {
        bool is_texture =
            item->kind == AST_BLOCK && (item->symbol == (Symbol)W_texture || item->symbol == (Symbol)W_texture_list);
        bool is_uv = item->kind == AST_WORD && item->symbol == (Symbol)W_uv_vectors;
        if (!is_texture && !is_uv) {
            return block_fault(
                reader->block, DIAG_E0256, item->span,
                "a triangle of a mesh has nothing but its corners, uv_vectors and the name of a texture");
        }
        cursor_skip(cursor);
        reader->corner_count -= is_texture && (*texture & MESH_FACE_OF_CORNERS); // it has another one now
        if (is_texture && !read_triangle_texture(reader, item, texture)) {
            return false;
        }
        if (is_uv && !read_uv(reader, cursor, item->span, uv)) {
            return false;
        }
    }
    return true;
}

static bool is_degenerate(const double c[3][3])
{
    Vec3 a = vec3((float)c[0][0], (float)c[0][1], (float)c[0][2]),
         b = vec3((float)c[1][0], (float)c[1][1], (float)c[1][2]);
    Vec3 d = vec3((float)c[2][0], (float)c[2][1], (float)c[2][2]);
    return vec3_equal(vec3_cross(vec3_sub(b, a), vec3_sub(d, a)), vec3(0.0, 0.0, 0.0));
}

typedef struct ReadTriangle {
    double corners[3][3], normals[3][3];
    bool is_smooth; // it has normals
    uint32_t texture;
    TriangleUv uv;
} ReadTriangle;

static bool add_triangle(MeshReader *reader, const AstNode *item, ReadTriangle *own)
{
    if (is_degenerate((const double(*)[3])own->corners)) {
        eval_warn(reader->block->ev, DIAG_W0348, item->span, "a triangle with its corners on one line is not drawn");
        reader->corner_count -= (own->texture & MESH_FACE_OF_CORNERS) != 0;
        return true;
    }
    if (!mesh_reader_has_room(reader, &reader->faces, 0) || !mesh_reader_has_room(reader, &reader->face_normals, 0) ||
        !mesh_reader_has_room(reader, &reader->face_textures, 0) ||
        !mesh_reader_may_have_faces(reader, (uint32_t)reader->faces.count, item->span)) {
        return false;
    }
    if (reader->faces.count == MESH_FACES_MOST) {
        return block_fault(reader->block, DIAG_E0470, item->span, "a mesh has at most %d faces", MESH_FACES_MOST);
    }
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t *normal = &((uint32_t(*)[3])reader->face_normals.items)[reader->faces.count][i];
        ((uint32_t(*)[3])reader->faces.items)[reader->faces.count][i] = (uint32_t)reader->vertices.count;
        *normal = own->is_smooth ? (uint32_t)reader->normals.count : MESH_FLAT;
        if (!add_corner(reader, own->corners[i], item->span) ||
            (own->is_smooth && !add_normal(reader, own->normals[i], item->span))) {
            return false;
        }
    }
    if (!add_uv(reader, &own->uv)) {
        return false;
    }
    ((uint32_t *)reader->face_textures.items)[reader->faces.count] = own->texture;
    reader->face_textures.count = reader->face_normals.count = ++reader->faces.count;
    return true;
}

static bool read_triangle(MeshReader *reader, const AstNode *item)
{
    Cursor cursor;
    ReadTriangle own = {.is_smooth = item->symbol == (Symbol)W_smooth_triangle, .uv = {.is_given = false}};
    bool is_fine = true;
    cursor_open(&cursor, reader->block->ev, item->a, item->span);
    for (int i = 0; is_fine && i < (own.is_smooth ? 6 : 3); i++) {
        Vec3 vector;
        Span span;
        double *into = own.is_smooth ? (i % 2 ? own.normals : own.corners)[i / 2] : own.corners[i];
        cursor_take_comma(&cursor);
        is_fine = cursor_vector3(&cursor, &vector, &span);
        if (is_fine) {
            into[0] = vector.x;
            into[1] = vector.y;
            into[2] = vector.z;
        }
    }
    is_fine = is_fine && read_triangle_end(reader, &cursor, &own.texture, &own.uv);
    cursor_close(&cursor);
    return is_fine && add_triangle(reader, item, &own);
}

bool mesh_body(Block *block)
{
    MeshReader reader;
    const AstNode *item;
    bool is_fine = mesh_reader_begin(&reader, block);
    if (!is_fine) {
        return false;
    }
    while (is_fine && (item = cursor_peek(&block->cursor)) && item->kind == AST_BLOCK &&
           (item->symbol == (Symbol)W_triangle || item->symbol == (Symbol)W_smooth_triangle)) {
        block->cursor.has_comma = false;
        cursor_skip(&block->cursor);
        is_fine = read_triangle(&reader, item);
    }
    if (is_fine && reader.faces.count == 0) {
        is_fine = block_fault(block, DIAG_E0474, block->node->span, "a mesh needs at least one triangle");
    }
    if (reader.texture_count == 0) {
        reader.face_textures.count = 0;
        free(reader.face_textures.items);
        reader.face_textures.items = NULL;
    }
    if (reader.normals.count == 0) {
        reader.face_normals.count = 0;
        free(reader.face_normals.items);
        reader.face_normals.items = NULL;
    }
    return mesh_reader_finish(&reader, is_fine);
}

// An identifier may have made it any object; one of a mesh was closed before.
bool mesh_close(Block *block)
{
    MeshDesc *desc = &block->record->mesh;
    if (!block->has_name && desc->mesh) {
        desc->mesh->inside_vector = desc->inside_vector;
        desc->mesh->has_inside = !vec3_equal(desc->inside_vector, vec3(0.0, 0.0, 0.0));
    }
    return true;
}
