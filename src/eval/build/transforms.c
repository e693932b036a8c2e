// Transforms as properties: translate, rotate, scale, matrix and transform, applied in the order in which they stand.
//
// Each one is composed onto the transform at the start of the block's description; a light is moved at once, because
// what is said after a transform is not moved by it, and so is a camera of old versions. Knows nothing of shapes.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/build/blocks.h"

static bool move_texture(Block *block, const TextureDesc **place, const Transform *transform)
{
    if (place && *place) {
        TextureDesc *texture = arena_copy(block->arena, *place, sizeof *texture);
        if (!texture) {
            return eval_no_memory(block->ev, block->node->span);
        }
        texture_transform(texture, transform);
        *place = texture;
    }
    return true;
}

// An object's texture moves with it, and so do its clips.
bool block_transform(Block *block, const Transform *transform)
{
    if (block->is == KIND_LIGHT_SOURCE) {
        light_transform(&block->record->light, transform);
    } else if (block->is == KIND_CAMERA) {
        camera_transform(block, transform);
    } else {
        block->record->transform = transform_compose(block->record->transform, *transform);
    }
    if (block->is == KIND_FOG) {
        block->record->fog.up = transform_direction(transform, block->record->fog.up);
    }
    return move_texture(block, texture_place(block), transform) &&
           move_texture(block, inner_texture_place(block), transform) &&
           (!schema_kind(block->is)->is_object || clips_transform(block, transform));
}

static bool read_vector(Block *block, const char *word, Span word_span, Vec3 *vector, Span *span)
{
    const AstNode *item = cursor_peek(&block->cursor);
    if (!item || item->kind == AST_WORD || !cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, word_span, "`%s` needs a vector after it", word);
    }
    *span = item->span;
    if (!cursor_vector3(&block->cursor, vector, span)) {
        return false;
    }
    return vec3_is_finite(*vector) ||
           block_fault(block, DIAG_E0340, *span, "`%s` has a coordinate that is not finite", word);
}

// POV-Ray takes 1 for a factor of 0, and says so.
static Vec3 scale_without_zeros(Block *block, Vec3 by, Span span)
{
    if (by.x == 0.0 || by.y == 0.0 || by.z == 0.0) {
        eval_warn(block->ev, DIAG_W0343, span, "`scale` by 0 would leave nothing; 1 is taken instead");
    }
    return vec3(by.x == 0.0 ? 1.0 : by.x, by.y == 0.0 ? 1.0 : by.y, by.z == 0.0 ? 1.0 : by.z);
}

static bool read_matrix_numbers(Block *block, const AstNode *vector, Transform *matrix)
{
    double *numbers = &matrix->m[0][0];
    for (const AstNode *component = vector->a; component; component = component->next) {
        Value value;
        if (!eval_expression(block->ev, component, &value) ||
            !value_number(block->ev, &value, component->span, numbers) ||
            !block_finite(block, *numbers, component->span, "matrix")) {
            return false;
        }
        if (component->flags & AST_BEFORE_COMMA) {
            return block_fault(block, DIAG_E0259, component->span, "no comma may follow the last number of `matrix`");
        }
        numbers++;
    }
    return true;
}

static bool column_is_empty(const Transform *matrix, int column)
{
    return matrix->m[0][column] == 0.0 && matrix->m[1][column] == 0.0 && matrix->m[2][column] == 0.0;
}

static bool read_matrix(Block *block, Span word, Transform *matrix)
{
    const AstNode *item = cursor_peek(&block->cursor);
    if (!item || item->kind != AST_VECTOR || item->count != 12) {
        return block_fault(block, DIAG_E0344, item ? item->span : word,
                           "`matrix` needs twelve numbers after it, as in <1,0,0, 0,1,0, 0,0,1, 0,0,0>");
    }
    if (!cursor_lacks_comma(&block->cursor, "front of the numbers") ||
        !read_matrix_numbers(block, item, matrix)) {
        return false;
    }
    for (int column = 0; column < 3; column++) {
        if (column_is_empty(matrix, column)) {
            eval_warn(block->ev, DIAG_W0343, item->span, "a column of `matrix` is 0; 1 is taken on its diagonal");
            matrix->m[column][column] = 1.0;
        }
    }
    cursor_skip(&block->cursor);
    return true;
}

// `transform { … }`, or the name of a declared transform.
static bool read_transform(Block *block, const AstNode *item, Transform *transform)
{
    Desc inner;
    SchemaKind is;
    if (item->kind == AST_BLOCK) {
        block_defaults(block->ev, KIND_TRANSFORM, &inner);
        if (!block_read(block->ev, item, KIND_TRANSFORM, block->arena, &inner, &is)) {
            return false;
        }
        *transform = inner.transform;
        return true;
    }
    const AstNode *name = cursor_peek(&block->cursor);
    Value value;
    if (!name || !block_is_name(name)) {
        return block_fault(block, DIAG_E0253, item->span,
                           "`transform` needs braces or the name of a transform after it");
    }
    if (!eval_expression(block->ev, name, &value)) {
        return false;
    }
    if (value.kind != VALUE_BLOCK || value.block != KIND_TRANSFORM) {
        return block_fault(block, DIAG_E0258, name->span, "expected a transform, found %s", value_describe(&value));
    }
    *transform = ((const TransformDesc *)value.record)->transform;
    cursor_skip(&block->cursor);
    return true;
}

bool transform_of_numbers(Symbol word, const double *numbers, unsigned count, Transform *transform)
{
    bool is_fine = count == (word == W_matrix ? 12 : count == 1 ? 1 : 3);
    for (unsigned i = 0; i < count; i++) {
        is_fine = is_fine && isfinite(numbers[i]);
    }
    if (!is_fine) {
        return false;
    }
    if (word == W_matrix) {
        memcpy(transform->m, numbers, sizeof transform->m);
        return !column_is_empty(transform, 0) && !column_is_empty(transform, 1) && !column_is_empty(transform, 2);
    }
    Vec3 by = count == 1 ? vec3(numbers[0], numbers[0], numbers[0]) : vec3(numbers[0], numbers[1], numbers[2]);
    *transform = word == W_translate ? transform_translate(by)
                 : word == W_rotate  ? transform_rotate(by)
                                     : transform_scale(by);
    return word != W_scale || (by.x != 0.0 && by.y != 0.0 && by.z != 0.0);
}

bool transform_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    Transform transform;
    Vec3 by = {0};
    Span span = item->span;
    bool takes_vector = property->action != ACTION_MATRIX && property->action != ACTION_TRANSFORM;
    if (takes_vector && !read_vector(block, property->word, item->span, &by, &span)) {
        return false;
    }
    switch (property->action) {
    case ACTION_TRANSLATE: transform = transform_translate(by); break;
    case ACTION_ROTATE: transform = transform_rotate(by); break;
    case ACTION_SCALE: transform = transform_scale(scale_without_zeros(block, by, span)); break;
    case ACTION_MATRIX:
        if (!read_matrix(block, item->span, &transform)) {
            return false;
        }
        break;
    default:
        if (!read_transform(block, item, &transform)) {
            return false;
        }
        break;
    }
    bool is_even = property->action != ACTION_SCALE ||
                   (transform.m[0][0] == transform.m[1][1] && transform.m[1][1] == transform.m[2][2]);
    if (!extent_note(block, &transform, takes_vector && is_even, span)) {
        return false;
    }
    if (!block_transform(block, &transform)) {
        return false;
    }
    return transform_is_finite(&block->record->transform) || block->is == KIND_LIGHT_SOURCE ||
           block_fault(block, DIAG_E0340, item->span, "the transforms leave the range of numbers");
}

bool transform_close(Block *block)
{
    TransformDesc *record = &block->record->transformation;
    if (record->is_inverse && !transform_invert(&record->transform, &record->transform)) {
        return block_fault(block, DIAG_E0345, block->node->span, "the transform has no inverse");
    }
    record->is_inverse = false;
    return true;
}
