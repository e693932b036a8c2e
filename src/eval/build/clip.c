// clipped_by, bounded_by and inverse: what is said of the inside of an object.
//
// Clips are kept beside the object, each with the transforms that came after it, because what stands before a transform
// is moved by it and what stands behind is not. Lists may be shared by copies of an object, so they are never changed,
// only copied. Knows nothing of how a clip is traced.
//
// SPDX-License-Identifier: MIT
#include "eval/build/blocks.h"

bool inverse_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    (void)property;
    (void)item;
    block->record->part.is_inverse = !block->record->part.is_inverse;
    block->record->part.was_turned = true;
    return true;
}

bool clip_body(Block *block)
{
    UnionDesc *group = &block->record->group;
    Word other = block->kind == KIND_CLIPPED_BY ? W_bounded_by : W_clipped_by;
    if (cursor_at_word(&block->cursor, other)) {
        cursor_skip(&block->cursor);
        group->is_other_block = true;
        return !cursor_peek(&block->cursor) ||
               block_fault(block, DIAG_E0254, cursor_peek(&block->cursor)->span, "nothing may stand behind `%s` in %s",
                           eval_text(block->ev, (Symbol)other), block_word(block));
    }
    if (!object_members(block)) {
        return false;
    }
    block->is_lost = group->count == 0 || block->is_lost;
    return group->count > 0 || block->has_unsupported ||
           block_fault(block, DIAG_E0253, block->node->span, "`%s` needs an object in its braces",
                       schema_kind(block->kind)->word);
}

// POV-Ray takes solids without textures of their own only, and discs, by whose box it cuts too.
static bool is_plain_solid(SchemaKind kind, const void *object)
{
    const ObjectPart *part = object;
    if (kind == KIND_LIGHT_SOURCE || shape_is_flat(kind, object) || part->texture) {
        return false;
    }
    const UnionMember *member = object_is_group(kind) ? ((const UnionDesc *)object)->members : NULL;
    for (; member; member = member->next) {
        if (!is_plain_solid(member->kind, member->object)) {
            return false;
        }
    }
    return true;
}

// Adds a moved copy of `from` at *end; returns the new end, NULL when out of memory.
static const Clip **clips_copy(Block *block, const Clip *from, const Transform *moved, const Clip **end)
{
    for (; from; from = from->next) {
        Clip *clip = arena_copy(block->arena, from, sizeof *from);
        if (!clip) {
            eval_no_memory(block->ev, block->node->span);
            return NULL;
        }
        if (moved) {
            clip->transform = transform_compose(clip->transform, *moved);
        }
        clip->next = NULL;
        *end = clip;
        end = &clip->next;
    }
    return end;
}

static bool clips_move(Block *block, const Clip **list, const Transform *transform)
{
    const Clip *first = NULL;
    if (!clips_copy(block, *list, transform, &first)) {
        return false;
    }
    *list = first;
    return true;
}

bool clips_transform(Block *block, const Transform *transform)
{
    ObjectPart *part = &block->record->part;
    return clips_move(block, &part->clips, transform) && clips_move(block, &part->bounds, transform);
}

static bool add_members(Block *block, const UnionDesc *group, const Clip **end, Span span)
{
    for (const UnionMember *member = group->members; member; member = member->next) {
        if (!is_plain_solid(member->kind, member->object)) {
            return block_fault(block, DIAG_E0360, span,
                               "what clips or bounds an object is a solid without a texture of its own");
        }
        if (member->kind == KIND_SPHERE && ((const SphereDesc *)member->object)->radius < 0.0 &&
            !extent_is_stretched(member->kind, member->object)) {
            return block_fault(block, DIAG_E0366, span, "a sphere of a negative radius clips or bounds an object");
        }
        Clip *clip = arena_alloc(block->arena, sizeof *clip);
        if (!clip) {
            return eval_no_memory(block->ev, span);
        }
        *clip = (Clip){NULL, member->object, member->kind, group->part.transform};
        *end = clip;
        end = &clip->next;
    }
    return true;
}

bool clip_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    ObjectPart *part = &block->record->part;
    SchemaKind kind = item->symbol == W_clipped_by ? KIND_CLIPPED_BY : KIND_BOUNDED_BY;
    const Clip **list = kind == KIND_CLIPPED_BY ? &part->clips : &part->bounds;
    const Clip *other = kind == KIND_CLIPPED_BY ? part->bounds : part->clips;
    Desc inner;
    SchemaKind is;
    (void)property;
    block_defaults(block->ev, kind, &inner);
    if (!block_read(block->ev, item, kind, block->arena, &inner, &is)) {
        return false;
    }
    const Clip *all = NULL;
    const Clip **end = clips_copy(block, *list, NULL, &all);
    if (!end) {
        return false;
    }
    if (inner.group.is_other_block ? !clips_copy(block, other, NULL, end)
                                   : !add_members(block, &inner.group, end, item->span)) {
        return false;
    }
    *list = all;
    return true;
}
