// Interiors, and materials that hold one together with a texture.
//
// An object's interior is never changed in place, for copies may share it. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include "eval/build/blocks.h"

static const InteriorDesc **interior_place(Block *block)
{
    return block->kind == KIND_MATERIAL ? &block->record->material.interior : &block->record->part.interior;
}

// A second block changes what it says.
bool interior_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    (void)property;
    const InteriorDesc **place = interior_place(block);
    Desc record;
    SchemaKind is;
    block_defaults(block->ev, KIND_INTERIOR, &record);
    if (*place) {
        record.interior = **place;
    }
    if (!block_read(block->ev, item, KIND_INTERIOR, block->arena, &record, &is)) {
        return false;
    }
    *place = arena_copy(block->arena, &record.interior, sizeof record.interior);
    return *place || eval_no_memory(block->ev, item->span);
}

bool material_take_name(Block *block, const MaterialDesc *material, Span span)
{
    MaterialDesc *record = &block->record->material;
    const TextureDesc *texture = material->texture;
    if (texture && record->texture) {
        texture = texture_laid_over(block->ev, block->arena, texture, record->texture, span);
        if (!texture) {
            return false;
        }
    }
    record->texture = texture ? texture : record->texture;
    record->interior = material->interior;
    return true;
}

// A material continues from what the object is: it moves its texture, too.
bool material_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    (void)property;
    Desc record;
    SchemaKind is;
    block_defaults(block->ev, KIND_MATERIAL, &record);
    ObjectPart *part = &block->record->part;
    record.material.texture = part->texture;
    record.material.interior = part->interior;
    if (!block_read(block->ev, item, KIND_MATERIAL, block->arena, &record, &is)) {
        return false;
    }
    part->texture = record.material.texture;
    part->interior = record.material.interior;
    return true;
}
