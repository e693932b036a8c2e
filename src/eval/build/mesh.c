// Meshes: `mesh { triangles }` and `mesh2 { lists }` become records that all copies share.
//
// Lists are read item by item into the record's own arrays; vectors that the grammar has packed come without nodes.
// What POV-Ray holds in single precision is rounded to it here. Textures of faces stay descriptions until the mesh is
// placed.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ast/pack.h"
#include "base/pages.h"
#include "eval/build/blocks.h"
#include "scene/room.h"

// A list of the mesh while it grows.
typedef struct Growing {
    void *items; // of Mesh
    size_t count, room, size;
} Growing;

typedef struct MeshReader {
    Block *block;
    Mesh *mesh;
    Growing vertices, normals, faces, face_normals, face_textures;
    uint32_t uv_count;
    bool has_uvs;
    const TextureDesc **textures;
    uint32_t texture_count, texture_room;
    MeshCorners *corners;
    uint32_t corner_count, corner_room;
} MeshReader;

#define FACE_OF_CORNERS (UINT32_C(1) << 31) // until all textures are known, with its place among the corners

// One list in braces while it is read: numbers and vectors, some of them packed.
typedef struct ListReader {
    Eval *ev;
    const AstNode *node;
    Cursor cursor;
    const char *word;
    uint32_t wanted;
    const AstNode *packed; // that is being read; NULL: none
    uint32_t at;           // in it
    const double *numbers;
    Span span; // of the last item
} ListReader;

// ---- memory

static bool grow(MeshReader *reader, Growing *list, size_t wanted)
{
    Eval *ev = reader->block->ev;
    size_t room = list->room * 2 > 1024 ? list->room * 2 : 1024;
    room = room < wanted && list->room * 4 >= wanted ? wanted : room;
    size_t taken =
        (reader->vertices.room + reader->normals.room + reader->faces.room + reader->face_normals.room) * 12 +
        reader->face_textures.room * 4;
    if (eval_cancelled(ev)) {
        return false;
    }
    if (!memory_has(ev, taken + room * list->size)) {
        ev->memory.refused = true;
        return eval_no_memory(ev, reader->block->node->span);
    }
    void *items = pages_grow(list->items, list->room * list->size, room * list->size);
    if (!items) {
        return eval_no_memory(ev, reader->block->node->span);
    }
    list->items = items;
    list->room = room;
    return true;
}

// Room for one more; `wanted` is how many the text says there will be.
RT_ALWAYS_INLINE bool grows(MeshReader *reader, Growing *list, size_t wanted)
{
    return RT_LIKELY(list->count < list->room) || grow(reader, list, wanted);
}

// The memory beyond a list's end goes back.
static void *trim(Growing *list)
{
    void *items = list->count > 0 ? realloc(list->items, list->count * list->size) : NULL;
    return items ? items : list->items;
}

// ---- lists

// Where an item of a pack stands: its text is read once more.
static Span pack_item_span(Eval *ev, const AstNode *packed, uint32_t number)
{
    GrammarText *text = grammar_text_again(ev->grammar, packed->span);
    Span span = packed->span;
    uint32_t item = 0, depth = 0;
    bool is_begun = false;
    for (size_t i = 0; text && i < text->count && item <= number; i++) {
        const Token *token = &text->tokens[i];
        depth += token->kind == '<';
        depth -= token->kind == '>';
        if (token->kind == ',' && depth == 0) {
            item++;
        } else if (item == number) {
            span = is_begun ? (Span){span.begin, token->span.end} : token->span;
            is_begun = true;
        }
    }
    free(text);
    return span;
}

// Reads how many there are.
static bool list_open(ListReader *list, Block *block, const AstNode *node)
{
    double count;
    *list = (ListReader){.ev = block->ev, .node = node, .word = eval_text(block->ev, node->symbol)};
    cursor_open(&list->cursor, block->ev, node->a, node->span);
    if (!cursor_number(&list->cursor, &count, &list->span)) {
        return false;
    }
    if (!(count >= 1.0 && count <= MESH_FACES_MOST)) {
        return eval_fault(block->ev, DIAG_E0470, list->span, "`%s` must say that there are 1 to %d, not %g", list->word,
                          MESH_FACES_MOST, count);
    }
    list->wanted = (uint32_t)count;
    return true;
}

static bool list_ends_early(ListReader *list, uint32_t number)
{
    const AstNode *item = cursor_peek(&list->cursor);
    return list->ev->stop
               ? false
               : eval_fault(list->ev, DIAG_E0471, item ? item->span : cursor_end(&list->cursor),
                            "`%s` says that there are %u, and ends after %u", list->word, list->wanted, number);
}

// The next item, of which there are `number` so far, as three numbers: those of a vector, or one that stands for all.
RT_ALWAYS_INLINE bool list_next(ListReader *list, uint32_t number, unsigned least, double v[3]);

static bool list_next_item(ListReader *list, uint32_t number, unsigned least, double v[3])
{
    list->packed = NULL;
    cursor_take_comma(&list->cursor);
    const AstNode *item = cursor_peek(&list->cursor);
    if (item && item->kind == AST_PACKED) {
        cursor_skip(&list->cursor);
        list->packed = item;
        list->at = 0;
        list->numbers = item->pack->numbers;
        return list_next(list, number, least, v);
    }
    if (!item || !cursor_at_value(&list->cursor)) {
        return list_ends_early(list, number);
    }
    Value value;
    Vec3 vector;
    list->span = item->span;
    if (least == 2) {
        if (!cursor_value(&list->cursor, &value)) {
            return false;
        }
        bool is_vector = value.kind == VALUE_VECTOR && value.components >= 2;
        v[0] = is_vector ? value.v[0] : 0.0;
        v[1] = is_vector ? value.v[1] : 0.0;
        return is_vector || value_number(list->ev, &value, list->span, &v[0]);
    }
    if (!cursor_vector3(&list->cursor, &vector, &list->span)) {
        return false;
    }
    v[0] = vector.x;
    v[1] = vector.y;
    v[2] = vector.z;
    return true;
}

RT_ALWAYS_INLINE bool list_next(ListReader *list, uint32_t number, unsigned least, double v[3])
{
    if (RT_UNLIKELY(!list->packed || list->at == list->packed->count)) {
        return list_next_item(list, number, least, v);
    }
    unsigned width = list->packed->pack->widths[list->at];
    v[0] = list->numbers[0];
    v[1] = width > 1 ? list->numbers[1] : v[0];
    v[2] = width > 2 ? list->numbers[2] : width > 1 ? 0.0 : v[0];
    list->numbers += width;
    list->at++;
    return true;
}

// Where the item stands that list_next gave last.
static Span list_span(const ListReader *list)
{
    return list->packed && list->at > 0 ? pack_item_span(list->ev, list->packed, list->at - 1) : list->span;
}

// A number that may follow a vector.
static bool list_number(ListReader *list, double *number, bool *is_there)
{
    *is_there = false;
    if (list->packed && list->at < list->packed->count) {
        if (list->packed->pack->widths[list->at] == 1) {
            *number = *list->numbers++;
            list->at++;
            *is_there = true;
        }
        return true;
    }
    list->packed = NULL;
    cursor_take_comma(&list->cursor);
    const AstNode *item = cursor_peek(&list->cursor);
    if (item && item->kind == AST_PACKED && item->pack->widths[0] == 1) {
        cursor_skip(&list->cursor);
        list->packed = item;
        list->at = 1;
        list->numbers = item->pack->numbers + 1;
        *number = item->pack->numbers[0];
        *is_there = true;
        return true;
    }
    if (!item || item->kind == AST_PACKED || item->kind == AST_VECTOR || !cursor_at_value(&list->cursor)) {
        return true;
    }
    // Whether it is a number is known when it is evaluated; of a vector in a name nothing is lost.
    Value value;
    list->span = item->span;
    if (!eval_expression(list->ev, item, &value)) {
        return false;
    }
    if (value.kind != VALUE_NUMBER) {
        return true;
    }
    cursor_skip(&list->cursor);
    *number = value.number;
    *is_there = true;
    return true;
}

static bool list_close(ListReader *list, bool is_fine)
{
    if (is_fine && !list->ev->stop) {
        cursor_take_comma(&list->cursor);
        const AstNode *item = cursor_peek(&list->cursor);
        bool has_more = item || (list->packed && list->at < list->packed->count);
        if (has_more) {
            Span span = item ? item->span : pack_item_span(list->ev, list->packed, list->at);
            is_fine = eval_fault(list->ev, DIAG_E0471, span, "`%s` says that there are %u, and has more", list->word,
                                 list->wanted);
        }
    }
    cursor_close(&list->cursor);
    return is_fine && !list->ev->stop;
}

// ---- vectors

// What is too large for single precision is no place.
static bool narrow(ListReader *list, const double v[3], float narrowed[3])
{
    for (int i = 0; i < 3; i++) {
        narrowed[i] = (float)v[i];
    }
    float nothing = narrowed[0] * 0.0F + narrowed[1] * 0.0F + narrowed[2] * 0.0F;
    return RT_LIKELY(nothing == 0.0F) ||
           eval_fault(list->ev, DIAG_E0472, list_span(list),
                      "a coordinate of a mesh must be finite and within single precision, about 3.4e38");
}

// Of unit length, in single precision; one that is so already stays as it is, so that a dump reads back as the same.
static void normalise(Eval *ev, double v[3], Span span)
{
    double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    if (square == 0.0) {
        eval_warn(ev, DIAG_W0470, span, "a normal of 0 has no direction; x is taken instead");
        v[0] = 1.0;
    } else if (!(fabs(square - 1.0) < 0x1p-22)) {
        double length = sqrt(square);
        for (int i = 0; i < 3; i++) {
            v[i] /= length;
        }
    }
}

static bool read_vectors(MeshReader *reader, const AstNode *node, Growing *into, bool is_normal)
{
    ListReader list;
    bool is_fine = list_open(&list, reader->block, node);
    for (uint32_t i = 0; is_fine && i < list.wanted; i++) {
        double v[3];
        is_fine = list_next(&list, i, 3, v);
        if (is_fine && is_normal) {
            double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
            bool is_unit = fabs(square - 1.0) < 0x1p-22;
            if (!is_unit) {
                normalise(reader->block->ev, v, square == 0.0 ? list_span(&list) : SPAN_NONE);
            }
        }
        is_fine =
            is_fine && grows(reader, into, list.wanted) && narrow(&list, v, ((float(*)[3])into->items)[into->count]);
        into->count += is_fine;
    }
    return list_close(&list, is_fine);
}

static bool read_uvs(MeshReader *reader, const AstNode *node)
{
    ListReader list;
    bool is_fine = list_open(&list, reader->block, node);
    for (uint32_t i = 0; is_fine && i < list.wanted; i++) {
        double v[3];
        is_fine = list_next(&list, i, 2, v);
    }
    reader->uv_count = is_fine ? list.wanted : 0;
    reader->has_uvs = is_fine;
    return list_close(&list, is_fine);
}

// ---- faces

// Cut towards zero, as POV-Ray does.
static bool to_indices(ListReader *list, const double v[3], size_t count, const char *of, uint32_t indices[3])
{
    if (RT_UNLIKELY(count == 0)) { // of which -0.5, cut, would be one
        return eval_fault(list->ev, DIAG_E0473, list_span(list), "there are no %s: %g is none of them", of, v[0]);
    }
    for (int i = 0; i < 3; i++) {
        if (RT_UNLIKELY(!(v[i] > -1.0 && v[i] < (double)count))) {
            return eval_fault(list->ev, DIAG_E0473, list_span(list), "there are %zu %s, 0 to %zu: %g is none of them",
                              count, of, count - 1, v[i]);
        }
        indices[i] = (uint32_t)v[i];
    }
    return true;
}

// Of a mesh2: whether the face that is being read has its corners on one line.
static bool face_is_line(const MeshReader *reader, uint32_t face)
{
    if (face >= reader->faces.room || reader->face_normals.room > 0) {
        return false; // of a `mesh`, which leaves such triangles out
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
static bool join_corners(MeshReader *reader, const uint32_t indices[3], uint32_t face, Span span, uint32_t *texture)
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
    *texture = FACE_OF_CORNERS | reader->corner_count;
    reader->corners[reader->corner_count++] = (MeshCorners){face, {indices[0], indices[1], indices[2]}};
    return true;
}

// The textures of a face: none, one, or one for each corner.
static bool read_face_textures(MeshReader *reader, ListReader *list, uint32_t face)
{
    double numbers[3];
    uint32_t indices[3];
    int count = 0;
    bool is_there = true;
    while (count < 3 && is_there) {
        if (!list_number(list, &numbers[count], &is_there)) {
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
        return eval_fault(list->ev, DIAG_E0473, list_span(list),
                          "a face has a texture, and there is no `texture_list`");
    }
    if (!to_indices(list, numbers, reader->texture_count, "textures", indices)) {
        return false;
    }
    uint32_t texture = indices[0] + 1;
    if (count > 1 && !join_corners(reader, indices, face, list_span(list), &texture)) {
        return false;
    }
    while (reader->face_textures.count <= face) {
        if (!grows(reader, &reader->face_textures, list->wanted)) {
            return false;
        }
        ((uint32_t *)reader->face_textures.items)[reader->face_textures.count++] = 0;
    }
    ((uint32_t *)reader->face_textures.items)[face] = texture;
    return true;
}

static bool may_have_faces(MeshReader *reader, uint32_t count, Span span)
{
    Eval *ev = reader->block->ev;
    if (scene_has_room(ev->scene, count, ev->options.limits, ev->options.diags, span)) {
        return true;
    }
    ev->stop = true;
    return false;
}

static bool read_faces(MeshReader *reader, const AstNode *node)
{
    ListReader list;
    bool is_fine = list_open(&list, reader->block, node) && may_have_faces(reader, list.wanted, list.span);
    for (uint32_t i = 0; is_fine && i < list.wanted; i++) {
        double v[3];
        is_fine = list_next(&list, i, 3, v) && grows(reader, &reader->faces, list.wanted) &&
                  to_indices(&list, v, reader->vertices.count, "vertices",
                             ((uint32_t(*)[3])reader->faces.items)[reader->faces.count]) &&
                  read_face_textures(reader, &list, i);
        reader->faces.count += is_fine;
    }
    return list_close(&list, is_fine);
}

// Faces beyond those that it tells of are flat.
static bool read_normal_indices(MeshReader *reader, const AstNode *node)
{
    ListReader list;
    bool is_fine = list_open(&list, reader->block, node);
    if (is_fine && list.wanted > reader->faces.count) {
        is_fine = eval_fault(reader->block->ev, DIAG_E0470, list.span,
                             "`normal_indices` is of %u faces, and there are %zu", list.wanted, reader->faces.count);
    }
    for (uint32_t i = 0; is_fine && i < list.wanted; i++) {
        double v[3];
        is_fine = list_next(&list, i, 3, v) && grows(reader, &reader->face_normals, reader->faces.count) &&
                  to_indices(&list, v, reader->normals.count, "normals",
                             ((uint32_t(*)[3])reader->face_normals.items)[reader->face_normals.count]);
        reader->face_normals.count += is_fine;
    }
    return list_close(&list, is_fine);
}

static bool read_uv_indices(MeshReader *reader, const AstNode *node)
{
    ListReader list;
    bool is_fine = list_open(&list, reader->block, node);
    for (uint32_t i = 0; is_fine && i < list.wanted; i++) {
        double v[3];
        uint32_t indices[3];
        is_fine = list_next(&list, i, 3, v) && to_indices(&list, v, reader->uv_count, "uv vectors", indices);
    }
    return list_close(&list, is_fine);
}

// ---- textures

static bool add_texture(MeshReader *reader, const TextureDesc *texture, uint32_t *index)
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

static bool texture_of(MeshReader *reader, const Value *value, Span span, const TextureDesc **texture)
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

static bool read_textures(MeshReader *reader, const AstNode *node)
{
    ListReader list;
    bool is_fine = list_open(&list, reader->block, node);
    for (uint32_t i = 0; is_fine && i < list.wanted; i++) {
        cursor_take_comma(&list.cursor);
        const AstNode *item = cursor_peek(&list.cursor);
        Value value;
        const TextureDesc *texture;
        uint32_t index;
        if (!item || item->kind != AST_BLOCK || item->symbol != (Symbol)W_texture) {
            is_fine = list_ends_early(&list, i);
            break;
        }
        cursor_skip(&list.cursor);
        is_fine = eval_block(reader->block->ev, item, &value) && texture_of(reader, &value, item->span, &texture) &&
                  add_texture(reader, texture, &index);
    }
    return list_close(&list, is_fine);
}

// ---- mesh2

static const struct MeshList {
    Word word;
    unsigned place; // they rise
    bool (*read)(MeshReader *reader, const AstNode *node);
} mesh_lists[] = {
    {W_vertex_vectors, 1, NULL},
    {W_normal_vectors, 2, NULL},
    {W_uv_vectors, 2, read_uvs},
    {W_texture_list, 2, read_textures},
    {W_face_indices, 3, read_faces},
    {W_uv_indices, 4, read_uv_indices},
    {W_normal_indices, 4, read_normal_indices},
};

enum { MESH_LISTS = sizeof mesh_lists / sizeof *mesh_lists };

static bool read_list(MeshReader *reader, const AstNode *item, unsigned number, bool is_repeated)
{
    const struct MeshList *list = &mesh_lists[number];
    if (is_repeated) {
        eval_warn(reader->block->ev, DIAG_W0471, item->span, "`%s` stands here again; this one is not looked at",
                  eval_text(reader->block->ev, item->symbol));
        return true;
    }
    if (list->word == W_vertex_vectors) {
        return read_vectors(reader, item, &reader->vertices, false);
    }
    if (list->word == W_normal_vectors) {
        return read_vectors(reader, item, &reader->normals, true);
    }
    return list->read(reader, item);
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
    bool is_read[MESH_LISTS] = {false};
    unsigned place = 0;
    const AstNode *item;
    while ((item = cursor_peek(&block->cursor)) && item->kind == AST_BLOCK) {
        unsigned number = 0;
        while (number < MESH_LISTS && (Symbol)mesh_lists[number].word != item->symbol) {
            number++;
        }
        if (number == MESH_LISTS) {
            break;
        }
        unsigned wanted = mesh_lists[number].place;
        bool is_missing = (wanted > 1 && !is_read[0]) || (wanted > 3 && !is_read[4]);
        if (is_missing) {
            return order_fault(reader, item, is_read[0] ? 3 : 1);
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
    return is_read[4] || order_fault(reader, NULL, is_read[0] ? 3 : 1);
}

// Faces behind the last one that has normals are flat.
static bool settle_face_normals(MeshReader *reader)
{
    Growing *normals = &reader->face_normals;
    while (normals->count > 0 && normals->count < reader->faces.count) {
        if (!grows(reader, normals, reader->faces.count)) {
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
    Growing *textures = &reader->face_textures;
    while (textures->count > 0 && textures->count < reader->faces.count) {
        if (!grows(reader, textures, reader->faces.count)) {
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
        places[texture & FACE_OF_CORNERS ? 0 : texture] = 1;
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
        mesh->face_textures[face] =
            texture & FACE_OF_CORNERS ? desc->single_count + (texture & ~FACE_OF_CORNERS) + 1 : places[texture];
    }
    mesh->texture_count = desc->single_count + reader->corner_count;
    return true;
}

// The record of what was read. It belongs to the scene from then on.
static bool keep_mesh(MeshReader *reader, bool is_fine)
{
    Block *block = reader->block;
    Mesh *mesh = reader->mesh;
    is_fine = is_fine && settle_face_textures(reader) && settle_face_normals(reader);
    mesh->vertices = trim(&reader->vertices);
    mesh->normals = trim(&reader->normals);
    mesh->faces = trim(&reader->faces);
    mesh->face_textures = trim(&reader->face_textures);
    mesh->vertex_count = (uint32_t)reader->vertices.count;
    mesh->normal_count = (uint32_t)reader->normals.count;
    mesh->face_count = (uint32_t)reader->faces.count;
    mesh->source = block->node->span.begin;
    mesh->face_normals = reader->face_normals.items;
    is_fine = is_fine && settle_normals(reader);
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

static bool begin_mesh(MeshReader *reader, Block *block)
{
    *reader = (MeshReader){.block = block, .mesh = mesh_new()};
    reader->vertices.size = reader->normals.size = 3 * sizeof(float);
    reader->faces.size = reader->face_normals.size = 3 * sizeof(uint32_t);
    reader->face_textures.size = sizeof(uint32_t);
    return reader->mesh || eval_no_memory(block->ev, block->node->span);
}

bool mesh2_body(Block *block)
{
    MeshReader reader;
    return begin_mesh(&reader, block) && keep_mesh(&reader, read_lists(&reader));
}

// ---- mesh

static bool add_corner(MeshReader *reader, const double v[3], Span span)
{
    float *vertex;
    if (!grows(reader, &reader->vertices, 0)) {
        return false;
    }
    vertex = ((float(*)[3])reader->vertices.items)[reader->vertices.count];
    for (int i = 0; i < 3; i++) {
        vertex[i] = (float)v[i];
        if (!isfinite(vertex[i])) {
            return block_fault(reader->block, DIAG_E0472, span,
                               "a coordinate of a mesh must be finite and within single precision, about 3.4e38");
        }
    }
    reader->vertices.count++;
    return true;
}

static bool add_normal(MeshReader *reader, double v[3], Span span)
{
    if (!grows(reader, &reader->normals, 0)) {
        return false;
    }
    normalise(reader->block->ev, v, span);
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
    if (!eval_expression(reader->block->ev, item, &value) || !texture_of(reader, &value, span, &texture)) {
        return false;
    }
    for (uint32_t i = 0; i < reader->texture_count; i++) {
        if (reader->textures[i] == texture) {
            *index = i;
            return true;
        }
    }
    return add_texture(reader, texture, index);
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
        is_fine = join_corners(reader, indices, (uint32_t)reader->faces.count, item->span, index);
    }
    if (is_fine && cursor_peek(&cursor)) {
        is_fine = block_fault(reader->block, DIAG_E0254, cursor_peek(&cursor)->span, "one value too many in %s",
                              eval_text(reader->block->ev, item->symbol));
    }
    cursor_close(&cursor);
    return is_fine;
}

// What may stand behind the corners: a texture, and uv_vectors.
static bool read_triangle_end(MeshReader *reader, Cursor *cursor, uint32_t *texture)
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
        reader->corner_count -= is_texture && (*texture & FACE_OF_CORNERS); // it has another one now
        if (is_texture && !read_triangle_texture(reader, item, texture)) {
            return false;
        }
        for (int i = 0; is_uv && i < 3; i++) {
            Value value;
            cursor_take_comma(cursor);
            if (!cursor_value(cursor, &value)) {
                return false;
            }
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

static bool add_triangle(MeshReader *reader, const AstNode *item, double corners[3][3], double normals[3][3],
                         bool is_smooth, uint32_t texture)
{
    if (is_degenerate((const double(*)[3])corners)) {
        eval_warn(reader->block->ev, DIAG_W0348, item->span, "a triangle with its corners on one line is not drawn");
        reader->corner_count -= (texture & FACE_OF_CORNERS) != 0;
        return true;
    }
    if (!grows(reader, &reader->faces, 0) || !grows(reader, &reader->face_normals, 0) ||
        !grows(reader, &reader->face_textures, 0) ||
        !may_have_faces(reader, (uint32_t)reader->faces.count, item->span)) {
        return false;
    }
    if (reader->faces.count == MESH_FACES_MOST) {
        return block_fault(reader->block, DIAG_E0470, item->span, "a mesh has at most %d faces", MESH_FACES_MOST);
    }
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t *normal = &((uint32_t(*)[3])reader->face_normals.items)[reader->faces.count][i];
        ((uint32_t(*)[3])reader->faces.items)[reader->faces.count][i] = (uint32_t)reader->vertices.count;
        *normal = is_smooth ? (uint32_t)reader->normals.count : MESH_FLAT;
        if (!add_corner(reader, corners[i], item->span) || (is_smooth && !add_normal(reader, normals[i], item->span))) {
            return false;
        }
    }
    ((uint32_t *)reader->face_textures.items)[reader->faces.count] = texture;
    reader->face_textures.count = reader->face_normals.count = ++reader->faces.count;
    return true;
}

static bool read_triangle(MeshReader *reader, const AstNode *item)
{
    Cursor cursor;
    double corners[3][3], normals[3][3];
    uint32_t texture = 0;
    bool is_smooth = item->symbol == (Symbol)W_smooth_triangle, is_fine = true;
    cursor_open(&cursor, reader->block->ev, item->a, item->span);
    for (int i = 0; is_fine && i < (is_smooth ? 6 : 3); i++) {
        Vec3 vector;
        Span span;
        double *into = is_smooth ? (i % 2 ? normals : corners)[i / 2] : corners[i];
        cursor_take_comma(&cursor);
        is_fine = cursor_vector3(&cursor, &vector, &span);
        if (is_fine) {
            into[0] = vector.x;
            into[1] = vector.y;
            into[2] = vector.z;
        }
    }
    is_fine = is_fine && read_triangle_end(reader, &cursor, &texture);
    cursor_close(&cursor);
    return is_fine && add_triangle(reader, item, corners, normals, is_smooth, texture);
}

bool mesh_body(Block *block)
{
    MeshReader reader;
    const AstNode *item;
    bool is_fine = begin_mesh(&reader, block);
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
    return keep_mesh(&reader, is_fine);
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
