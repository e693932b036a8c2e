// `bicubic_patch { items, sixteen points }` becomes a mesh of smooth triangles, where it is placed: as in POV-Ray its
// points are moved, and what is drawn of it depends on where they are then.
//
// A piece that is not flat enough is halved along both sides, until it was as often as is said. Of a piece that is left
// two triangles are drawn, with the surface's own normals at their corners; where it has none, x. Pieces beside each
// other that were not halved as often leave cracks, as in POV-Ray. All measured. Knows nothing of textures.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "eval/build/mesh_reader.h"
#include "scene/room.h"

enum { POINTS = 16, STEPS_MOST = 28 };

// What is drawn: the whole patch, how, and the mesh that it becomes, which is NULL while pieces are counted.
typedef struct PatchDrawing {
    Eval *ev;
    const PatchDesc *patch;
    const Vec3 (*whole)[4];
    Mesh *mesh;
    uint32_t pieces, pieces_most;
    bool has_uv; // some texture asks for them
} PatchDrawing;

// Surface coordinates of the corners, round the patch, if nothing is said.
static const double plain_uv[4][2] = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};

// A part of it: from `low` to `high` across the rows and along them, halved `depth` times.
typedef struct PatchPiece {
    Vec3 points[4][4];
    double low[2], high[2];
    unsigned depth[2];
} PatchPiece;

// ---- the surface

static void bernstein(double t, double weights[4], double slopes[4])
{
    double s = 1.0 - t;
    weights[0] = s * s * s;
    weights[1] = 3.0 * t * s * s;
    weights[2] = 3.0 * t * t * s;
    weights[3] = t * t * t;
    slopes[0] = -3.0 * s * s;
    slopes[1] = 3.0 * s * s - 6.0 * t * s;
    slopes[2] = 6.0 * t * s - 3.0 * t * t;
    slopes[3] = 3.0 * t * t;
}

static Vec3 weighted(const Vec3 (*points)[4], const double across[4], const double along[4])
{
    Vec3 sum = vec3(0.0, 0.0, 0.0);
    for (int row = 0; row < 4; row++) {
        for (int i = 0; i < 4; i++) {
            sum = vec3_add_scaled(sum, across[row] * along[i], points[row][i]);
        }
    }
    return sum;
}

static void surface_at(const Vec3 (*points)[4], double across, double along, Vec3 *point, Vec3 *normal)
{
    double row_weights[4], row_slopes[4], weights[4], slopes[4];
    bernstein(across, row_weights, row_slopes);
    bernstein(along, weights, slopes);
    *point = weighted(points, row_weights, weights);
    Vec3 cross = vec3_cross(weighted(points, row_slopes, weights), weighted(points, row_weights, slopes));
    double length = vec3_length(cross);
    *normal = length > 0.0 ? vec3_scale(1.0 / length, cross) : vec3(1.0, 0.0, 0.0);
}

// Halves the points of one row or column, `step` apart, into both parts.
static void halve_line(const Vec3 *from, Vec3 *low, Vec3 *high, int step)
{
    Vec3 p[4];
    for (int i = 0; i < 4; i++) {
        p[i] = from[i * step];
    }
    for (int i = 0; i < 4; i++) {
        low[i * step] = p[0];
        high[(3 - i) * step] = p[3 - i];
        for (int k = 0; k + i < 3; k++) {
            p[k] = vec3_scale(0.5, vec3_add(p[k], p[k + 1]));
        }
    }
}

static void halve(const PatchPiece *piece, int side, PatchPiece *low, PatchPiece *high)
{
    *low = *high = *piece;
    low->high[side] = high->low[side] = (piece->low[side] + piece->high[side]) / 2.0;
    low->depth[side] = high->depth[side] = piece->depth[side] + 1;
    const Vec3 *from = &piece->points[0][0];
    Vec3 *into_low = &low->points[0][0], *into_high = &high->points[0][0];
    for (int i = 0; i < 4; i++) {
        int first = side == 0 ? i : 4 * i;
        halve_line(from + first, into_low + first, into_high + first, side == 0 ? 4 : 1);
    }
}

// Whether no point is as far as that from the plane through three of the corners. Where the first row is one point the
// last corner takes part; where there is no plane, nothing is flat. Measured.
static bool is_flat(const PatchPiece *patch, double flatness)
{
    Vec3 corner = patch->points[0][0];
    Vec3 along = vec3_sub(patch->points[0][3], corner);
    if (vec3_equal(along, vec3(0.0, 0.0, 0.0))) {
        along = vec3_sub(patch->points[3][3], corner);
    }
    Vec3 normal = vec3_cross(along, vec3_sub(patch->points[3][0], corner));
    double length = vec3_length(normal);
    bool is_near = length > 0.0;
    for (int i = 0; is_near && i < POINTS; i++) {
        is_near = fabs(vec3_dot(normal, vec3_sub(patch->points[i / 4][i % 4], corner))) / length < flatness;
    }
    return is_near;
}

// ---- triangles

static bool add_corner(PatchDrawing *drawing, double across, double along)
{
    Mesh *mesh = drawing->mesh;
    Vec3 point, normal;
    surface_at(drawing->whole, across, along, &point, &normal);
    float *vertex = mesh->vertices[mesh->vertex_count++], *kept = mesh->normals[mesh->normal_count++];
    kept[0] = (float)normal.x;
    kept[1] = (float)normal.y;
    kept[2] = (float)normal.z;
    if (mesh->uvs) {
        float *uv = mesh->uvs[mesh->uv_count++];
        uv[0] = (float)along;
        uv[1] = (float)across;
    }
    return mesh_narrow((double[]){point.x, point.y, point.z}, vertex) ||
           eval_fault(drawing->ev, DIAG_E0472, drawing->patch->part.span, MESH_NOT_NARROW);
}

static void add_face(Mesh *mesh, uint32_t first, uint32_t second, uint32_t third)
{
    Vec3 p = mesh_vector(mesh->vertices[first]);
    Vec3 normal =
        vec3_cross(vec3_sub(mesh_vector(mesh->vertices[second]), p), vec3_sub(mesh_vector(mesh->vertices[third]), p));
    if (!vec3_equal(normal, vec3(0.0, 0.0, 0.0))) {
        uint32_t *face = mesh->faces[mesh->face_count++];
        face[0] = first;
        face[1] = second;
        face[2] = third;
    }
}

static bool draw(PatchDrawing *drawing, const PatchPiece *piece)
{
    Mesh *mesh = drawing->mesh;
    Span span = drawing->patch->part.span;
    if (!eval_step(drawing->ev, span)) {
        return false;
    }
    drawing->pieces++;
    if (!mesh) {
        return drawing->pieces <= drawing->pieces_most ||
               eval_fault(drawing->ev, DIAG_E0475, span, "a bicubic_patch of more than %d pieces",
                          (int)drawing->pieces_most);
    }
    uint32_t first = mesh->vertex_count;
    bool is_fine =
        add_corner(drawing, piece->low[0], piece->low[1]) && add_corner(drawing, piece->low[0], piece->high[1]) &&
        add_corner(drawing, piece->high[0], piece->high[1]) && add_corner(drawing, piece->high[0], piece->low[1]);
    if (is_fine) {
        add_face(mesh, first, first + 1, first + 2);
        add_face(mesh, first, first + 2, first + 3);
    }
    return is_fine;
}

// Recursive, no deeper than STEPS_MOST.
static bool divide(PatchDrawing *drawing, const PatchPiece *piece)
{
    PatchPiece pieces[4] = {*piece};
    unsigned count = 1;
    bool is_whole = true;
    for (int side = 0; side < 2 && !is_flat(piece, drawing->patch->flatness); side++) {
        if (!(piece->depth[side] < drawing->patch->steps[side])) {
            continue;
        }
        for (unsigned i = count; i-- > 0;) {
            PatchPiece whole = pieces[i];
            halve(&whole, side, &pieces[2 * i], &pieces[2 * i + 1]);
        }
        count *= 2;
        is_whole = false;
    }
    if (is_whole) {
        return draw(drawing, piece);
    }
    for (unsigned i = 0; i < count; i++) {
        if (!divide(drawing, &pieces[i])) {
            return false;
        }
    }
    return true;
}

// ---- where it is placed

static bool draw_all(PatchDrawing *drawing)
{
    PatchPiece piece = {.low = {0.0, 0.0}, .high = {1.0, 1.0}, .depth = {0, 0}};
    memcpy(piece.points, drawing->whole, sizeof piece.points);
    drawing->pieces = 0;
    return divide(drawing, &piece);
}

// Room for the pieces that were counted.
static bool make_room(PatchDrawing *drawing)
{
    Eval *ev = drawing->ev;
    size_t pieces = drawing->pieces;
    Span span = drawing->patch->part.span;
    size_t bytes = pieces * (8 * sizeof *drawing->mesh->vertices + 2 * sizeof *drawing->mesh->faces +
                             (drawing->has_uv ? 4 * sizeof *drawing->mesh->uvs : 0));
    if (!scene_has_room(ev->scene, 2 * pieces, ev->options.limits, ev->options.diags, span)) {
        ev->stop = true;
        return false;
    }
    Mesh *mesh = memory_has(ev, bytes) ? mesh_new() : NULL;
    if (!mesh) {
        return eval_no_memory(ev, span);
    }
    mesh->vertices = malloc(4 * pieces * sizeof *mesh->vertices);
    mesh->normals = malloc(4 * pieces * sizeof *mesh->normals);
    mesh->faces = malloc(2 * pieces * sizeof *mesh->faces);
    mesh->face_normals = mesh->faces; // a vertex has one normal
    mesh->uvs = drawing->has_uv ? malloc(4 * pieces * sizeof *mesh->uvs) : NULL;
    mesh->face_uvs = drawing->has_uv ? mesh->faces : NULL;
    bool has_corners = drawing->has_uv && memcmp(drawing->patch->uv, plain_uv, sizeof plain_uv) != 0;
    mesh->uv_corners = has_corners ? malloc(sizeof plain_uv) : NULL;
    mesh->source = span.begin;
    if (!mesh->vertices || !mesh->normals || !mesh->faces || (drawing->has_uv && !mesh->uvs) ||
        (has_corners && !mesh->uv_corners)) {
        mesh_free(mesh);
        return eval_no_memory(ev, span);
    }
    if (has_corners) {
        memcpy(mesh->uv_corners, drawing->patch->uv, sizeof plain_uv);
    }
    drawing->mesh = mesh;
    return true;
}

// The mesh stands around the first point, so that single precision does not suffer from where it is, and is made as the
// scene's text says it: `flatness` does not grow with a scene that is drawn at another scale.
ShapeResult bicubic_make(Eval *ev, const PatchDesc *patch, const Transform *transform, Primitive *primitive)
{
    Transform own = transform_compose(*transform, world_inverse(ev));
    Vec3 points[4][4], origin = transform_point(&own, patch->points[0][0]);
    for (int i = 0; i < POINTS; i++) {
        Vec3 point = transform_point(&own, patch->points[i / 4][i % 4]);
        points[i / 4][i % 4] = vec3_sub(point, origin);
    }
    PatchDrawing drawing = {
        .ev = ev, .patch = patch, .whole = (const Vec3(*)[4])points, .pieces_most = MESH_FACES_MOST / 4,
        .has_uv = ev->objects->uses_uv};
    bool is_fine = draw_all(&drawing) && make_room(&drawing) && draw_all(&drawing);
    Mesh *mesh = drawing.mesh;
    if (is_fine && mesh->face_count > 0) {
        mesh_measure(mesh);
        is_fine = scene_add_mesh(ev->scene, mesh) || eval_no_memory(ev, patch->part.span);
    }
    if (!is_fine || mesh->face_count == 0) {
        mesh_free(mesh);
        ev->faulty = ev->faulty || !is_fine;
        return is_fine ? SHAPE_NOTHING : SHAPE_FAULT;
    }
    *primitive = part_empty(patch->part.span.begin);
    primitive->kind = PRIMITIVE_MESH;
    primitive->to_world = transform_compose(transform_translate(origin), world_transform(ev));
    primitive->mesh = (PrimitiveMesh){mesh->low, mesh->high, mesh, 0};
    return part_finish(primitive) ? SHAPE_MADE : SHAPE_FAULT;
}

bool bicubic_box(const void *object, OwnBox *own)
{
    const PatchDesc *patch = object;
    own->low = own->high = patch->points[0][0];
    for (int i = 1; i < POINTS; i++) {
        own->low = vec3_least(own->low, patch->points[i / 4][i % 4]);
        own->high = vec3_greatest(own->high, patch->points[i / 4][i % 4]);
    }
    return false;
}

// ---- the block

static bool read_number(Block *block, const char *word, double *number)
{
    const AstNode *item = cursor_peek(&block->cursor);
    Span span;
    if (!item || !cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, block_here(block), "`%s` needs a number after it", word);
    }
    return cursor_number(&block->cursor, number, &span) && block_finite(block, *number, span, word);
}

// Words and numbers, in any order.
static bool read_words(Block *block, PatchDesc *patch)
{
    bool has_type = false;
    for (const AstNode *item;
         (item = cursor_peek(&block->cursor)) && item->kind == AST_WORD && !block->cursor.has_comma;) {
        double type = 0.0, *into;
        switch ((Word)item->symbol) {
        case W_type:
            into = &type;
            break;
        case W_flatness:
            into = &patch->flatness;
            break;
        case W_u_steps:
            into = &patch->steps[0];
            break;
        case W_v_steps:
            into = &patch->steps[1];
            break;
        default:
            into = NULL;
        }
        if (!into) {
            break;
        }
        Span span = item->span;
        cursor_skip(&block->cursor);
        if (!read_number(block, eval_text(block->ev, item->symbol), into)) {
            return false;
        }
        has_type = has_type || into == &type;
        if (into == &type && trunc(type) != 0.0 && trunc(type) != 1.0) {
            return block_fault(block, DIAG_E0341, span, "the type of a bicubic_patch must be 0 or 1, not %g", type);
        }
        if (into != &type && into != &patch->flatness && !(*into >= 0.0 && *into <= STEPS_MOST)) {
            return block_fault(block, DIAG_E0341, span, "`%s` must be from 0 to %d, not %g",
                               eval_text(block->ev, item->symbol), STEPS_MOST, *into);
        }
    }
    patch->steps[0] = trunc(patch->steps[0]);
    patch->steps[1] = trunc(patch->steps[1]);
    return has_type || block_fault(block, DIAG_E0253, block_here(block), "a bicubic_patch needs a `type`: 0 or 1");
}

// The surface coordinates of the corners, round the patch.
static bool read_uv_vectors(Block *block, PatchDesc *patch)
{
    memcpy(patch->uv, plain_uv, sizeof plain_uv);
    if (!cursor_at_word(&block->cursor, W_uv_vectors)) {
        return true;
    }
    cursor_skip(&block->cursor);
    for (int i = 0; i < 4; i++) {
        float narrowed[2];
        Span span = block_here(block);
        if (!cursor_at_value(&block->cursor)) {
            return block_fault(block, DIAG_E0253, span, "`uv_vectors` needs four vectors after it");
        }
        if (!mesh_read_uv(&block->cursor, span, patch->uv[i])) {
            return false;
        }
        if (!mesh_narrow_uv(patch->uv[i], narrowed)) {
            return block_fault(block, DIAG_E0472, span, MESH_NOT_NARROW);
        }
        cursor_take_comma(&block->cursor);
    }
    return true;
}

static bool read_points(Block *block, PatchDesc *patch)
{
    for (int i = 0; i < POINTS; i++) {
        Vec3 *point = &patch->points[i / 4][i % 4];
        Span span;
        if (!cursor_at_value(&block->cursor)) {
            return block_fault(block, DIAG_E0253, block_here(block),
                               "a bicubic_patch needs %d points here, and there are %d", POINTS, i);
        }
        if (!cursor_vector3(&block->cursor, point, &span)) {
            return false;
        }
        if (!vec3_is_finite(*point)) {
            return block_fault(block, DIAG_E0340, span, "a point of a bicubic_patch is not finite");
        }
        cursor_take_comma(&block->cursor);
    }
    return true;
}

bool bicubic_body(Block *block)
{
    PatchDesc *patch = &block->record->patch;
    bool has_words = read_words(block, patch);
    cursor_take_comma(&block->cursor);
    return has_words && read_uv_vectors(block, patch) && read_points(block, patch);
}
