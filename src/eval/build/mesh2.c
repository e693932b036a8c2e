// `mesh2 { lists }` becomes a mesh: vertices, normals, textures and the faces that refer to them are read, item by
// item, into the record's own arrays. Coordinates of images are checked and forgotten.
//
// SPDX-License-Identifier: MIT
#include "eval/build/mesh_list.h"
#include "eval/build/mesh_reader.h"

// ---- vectors

// In single precision, as POV-Ray has it.
static bool narrow(MeshList *list, const double v[3], float narrowed[3])
{
    return mesh_narrow(v, narrowed) || eval_fault(list->ev, DIAG_E0472, mesh_list_span(list), MESH_NOT_NARROW);
}

static bool read_vectors(MeshReader *reader, const AstNode *node, MeshArray *into, bool is_normal)
{
    MeshList list;
    bool is_fine = mesh_list_open(&list, reader->block, node);
    for (uint32_t i = 0; is_fine && i < list.wanted; i++) {
        double v[3];
        is_fine = mesh_list_next(&list, i, 3, v);
        if (is_fine && is_normal && !mesh_normal_is_unit(v)) {
            bool warns = v[0] * v[0] + v[1] * v[1] + v[2] * v[2] == 0.0;
            mesh_normalise(reader->block->ev, v, warns ? mesh_list_span(&list) : SPAN_NONE);
        }
        is_fine = is_fine && mesh_reader_has_room(reader, into, list.wanted) &&
                  narrow(&list, v, ((float(*)[3])into->items)[into->count]);
        into->count += is_fine;
    }
    return mesh_list_close(&list, is_fine);
}

static bool read_vertices(MeshReader *reader, const AstNode *node)
{
    return read_vectors(reader, node, &reader->vertices, false);
}

static bool read_normals(MeshReader *reader, const AstNode *node)
{
    return read_vectors(reader, node, &reader->normals, true);
}

static bool read_uvs(MeshReader *reader, const AstNode *node)
{
    MeshList list;
    bool is_fine = mesh_list_open(&list, reader->block, node);
    for (uint32_t i = 0; is_fine && i < list.wanted; i++) {
        double v[3];
        is_fine = mesh_list_next(&list, i, 2, v) && mesh_reader_has_room(reader, &reader->uvs, list.wanted);
        if (is_fine && !mesh_narrow_uv(v, ((float(*)[2])reader->uvs.items)[reader->uvs.count])) {
            is_fine = eval_fault(list.ev, DIAG_E0472, mesh_list_span(&list), MESH_NOT_NARROW);
        }
        reader->uvs.count += is_fine;
    }
    return mesh_list_close(&list, is_fine);
}

// ---- faces

// Cut towards zero, as POV-Ray does.
static bool to_indices(MeshList *list, const double v[3], size_t count, const char *of, uint32_t indices[3])
{
    if (RT_UNLIKELY(count == 0)) { // of which -0.5, cut, would be one
        return eval_fault(list->ev, DIAG_E0473, mesh_list_span(list), "there are no %s: %g is none of them", of, v[0]);
    }
    for (int i = 0; i < 3; i++) {
        if (RT_UNLIKELY(!(v[i] > -1.0 && v[i] < (double)count))) {
            return eval_fault(list->ev, DIAG_E0473, mesh_list_span(list),
                              "there are %zu %s, 0 to %zu: %g is none of them", count, of, count - 1, v[i]);
        }
        indices[i] = (uint32_t)v[i];
    }
    return true;
}

// The textures of a face: none, one, or one for each corner.
static bool read_face_textures(MeshReader *reader, MeshList *list, uint32_t face)
{
    double numbers[3];
    uint32_t indices[3];
    int count = 0;
    bool is_there = true;
    while (count < 3 && is_there) {
        if (!mesh_list_number(list, &numbers[count], &is_there)) {
            return false;
        }
        count += is_there;
    }
    if (count == 0) {
        return true;
    }
    numbers[1] = count > 1 ? numbers[1] : numbers[0];
    numbers[2] = count > 2 ? numbers[2] : numbers[0];
    if (reader->texture_count == 0) {
        return eval_fault(list->ev, DIAG_E0473, mesh_list_span(list),
                          "a face has a texture, and there is no `texture_list`");
    }
    if (!to_indices(list, numbers, reader->texture_count, "textures", indices)) {
        return false;
    }
    uint32_t texture = indices[0] + 1;
    if (count > 1 && !mesh_reader_join_corners(reader, indices, face, mesh_list_span(list), &texture)) {
        return false;
    }
    while (reader->face_textures.count <= face) {
        if (!mesh_reader_has_room(reader, &reader->face_textures, list->wanted)) {
            return false;
        }
        ((uint32_t *)reader->face_textures.items)[reader->face_textures.count++] = 0;
    }
    ((uint32_t *)reader->face_textures.items)[face] = texture;
    return true;
}

static bool read_faces(MeshReader *reader, const AstNode *node)
{
    MeshList list;
    bool is_fine =
        mesh_list_open(&list, reader->block, node) && mesh_reader_may_have_faces(reader, list.wanted, list.span);
    for (uint32_t i = 0; is_fine && i < list.wanted; i++) {
        double v[3];
        is_fine = mesh_list_next(&list, i, 3, v) && mesh_reader_has_room(reader, &reader->faces, list.wanted) &&
                  to_indices(&list, v, reader->vertices.count, "vertices",
                             ((uint32_t(*)[3])reader->faces.items)[reader->faces.count]) &&
                  read_face_textures(reader, &list, i);
        reader->faces.count += is_fine;
    }
    return mesh_list_close(&list, is_fine);
}

// Faces beyond those that the list holds are flat.
static bool read_normal_indices(MeshReader *reader, const AstNode *node)
{
    MeshList list;
    bool is_fine = mesh_list_open(&list, reader->block, node);
    if (is_fine && list.wanted > reader->faces.count) {
        is_fine = eval_fault(reader->block->ev, DIAG_E0470, list.span,
                             "`normal_indices` is of %u faces, and there are %zu", list.wanted, reader->faces.count);
    }
    for (uint32_t i = 0; is_fine && i < list.wanted; i++) {
        double v[3];
        is_fine = mesh_list_next(&list, i, 3, v) &&
                  mesh_reader_has_room(reader, &reader->face_normals, reader->faces.count) &&
                  to_indices(&list, v, reader->normals.count, "normals",
                             ((uint32_t(*)[3])reader->face_normals.items)[reader->face_normals.count]);
        reader->face_normals.count += is_fine;
    }
    return mesh_list_close(&list, is_fine);
}

static bool read_uv_indices(MeshReader *reader, const AstNode *node)
{
    MeshList list;
    bool is_fine = mesh_list_open(&list, reader->block, node);
    if (is_fine && list.wanted != reader->faces.count) {
        is_fine = eval_fault(reader->block->ev, DIAG_E0470, list.span,
                             "`uv_indices` is of %u faces, and there are %zu", list.wanted, reader->faces.count);
    }
    for (uint32_t i = 0; is_fine && i < list.wanted; i++) {
        double v[3];
        is_fine = mesh_list_next(&list, i, 3, v) && mesh_reader_has_room(reader, &reader->face_uvs, list.wanted) &&
                  to_indices(&list, v, reader->uvs.count, "uv vectors",
                             ((uint32_t(*)[3])reader->face_uvs.items)[reader->face_uvs.count]);
        reader->face_uvs.count += is_fine;
    }
    return mesh_list_close(&list, is_fine);
}

// ---- textures

static bool read_textures(MeshReader *reader, const AstNode *node)
{
    MeshList list;
    bool is_fine = mesh_list_open(&list, reader->block, node);
    for (uint32_t i = 0; is_fine && i < list.wanted; i++) {
        cursor_take_comma(&list.cursor);
        const AstNode *item = cursor_peek(&list.cursor);
        Value value;
        const TextureDesc *texture;
        uint32_t index;
        if (!item || item->kind != AST_BLOCK || item->symbol != (Symbol)W_texture) {
            is_fine = mesh_list_ends_early(&list, i);
            break;
        }
        cursor_skip(&list.cursor);
        is_fine = eval_block(reader->block->ev, item, &value) &&
                  mesh_reader_texture_of(reader, &value, item->span, &texture) &&
                  mesh_reader_add_texture(reader, texture, &index);
    }
    return mesh_list_close(&list, is_fine);
}

// ---- the lists

// In the order of the table.
enum { LIST_VERTICES, LIST_NORMALS, LIST_UVS, LIST_TEXTURES, LIST_FACES, LIST_UV_INDICES, LIST_NORMAL_INDICES, LISTS };

static const struct Mesh2List {
    Word word;
    unsigned place; // they rise
    bool (*read)(MeshReader *reader, const AstNode *node);
} mesh2_lists[LISTS] = {
    {W_vertex_vectors, 1, read_vertices},       {W_normal_vectors, 2, read_normals}, {W_uv_vectors, 2, read_uvs},
    {W_texture_list, 2, read_textures},         {W_face_indices, 3, read_faces},     {W_uv_indices, 4, read_uv_indices},
    {W_normal_indices, 4, read_normal_indices},
};

static bool read_list(MeshReader *reader, const AstNode *item, unsigned number, bool is_repeated)
{
    if (is_repeated) {
        eval_warn(reader->block->ev, DIAG_W0471, item->span, "`%s` stands here again; this one is not looked at",
                  eval_text(reader->block->ev, item->symbol));
        return true;
    }
    return mesh2_lists[number].read(reader, item);
}

static bool order_fault(MeshReader *reader, const AstNode *item, unsigned place)
{
    const char *missing = place < 3 ? "vertex_vectors" : "face_indices";
    Span end = item ? item->span : cursor_end(&reader->block->cursor);
    return block_fault(reader->block, DIAG_E0474, end, "`%s` must stand here%s%s%s", missing, item ? " before `" : "",
                       item ? eval_text(reader->block->ev, item->symbol) : "", item ? "`" : "");
}

static bool read_lists(MeshReader *reader)
{
    Block *block = reader->block;
    bool is_read[LISTS] = {false};
    unsigned place = 0;
    const AstNode *item;
    while ((item = cursor_peek(&block->cursor)) && item->kind == AST_BLOCK) {
        unsigned number = 0;
        while (number < LISTS && (Symbol)mesh2_lists[number].word != item->symbol) {
            number++;
        }
        if (number == LISTS) {
            break;
        }
        unsigned wanted = mesh2_lists[number].place;
        bool is_missing = (wanted > 1 && !is_read[LIST_VERTICES]) || (wanted > 3 && !is_read[LIST_FACES]);
        if (is_missing) {
            return order_fault(reader, item, is_read[LIST_VERTICES] ? 3 : 1);
        }
        if (wanted < place && !(wanted < 3 && place < 3)) {
            return block_fault(block, DIAG_E0474, item->span, "`%s` must stand before the lists of faces",
                               eval_text(block->ev, item->symbol));
        }
        block->cursor.has_comma = false;
        cursor_skip(&block->cursor);
        if (!read_list(reader, item, number, is_read[number])) {
            return false;
        }
        is_read[number] = true;
        place = wanted;
    }
    return is_read[LIST_FACES] || order_fault(reader, NULL, is_read[LIST_VERTICES] ? 3 : 1);
}

bool mesh2_body(Block *block)
{
    MeshReader reader;
    return mesh_reader_begin(&reader, block) && mesh_reader_finish(&reader, read_lists(&reader));
}
