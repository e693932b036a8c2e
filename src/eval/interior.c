// Interiors, and materials that hold one together with a texture.
//
// An object's interior is never changed in place, for copies may share it. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include "eval/blocks.h"

static const InteriorBlueprint **interior_place(Block *block)
{
    return block->kind == KIND_MATERIAL ? &block->record->material.interior : &block->record->part.interior;
}

// A second block changes what it says.
bool interior_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    (void)property;
    const InteriorBlueprint **place = interior_place(block);
    Blueprint record;
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

bool material_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    (void)property;
    Blueprint record;
    SchemaKind is;
    block_defaults(block->ev, KIND_MATERIAL, &record);
    if (!block_read(block->ev, item, KIND_MATERIAL, block->arena, &record, &is)) {
        return false;
    }
    ObjectPart *part = &block->record->part;
    const TextureBlueprint *texture = record.material.texture;
    if (texture && part->texture) {
        texture = texture_laid_over(block->ev, block->arena, texture, part->texture, item->span);
        if (!texture) {
            return false;
        }
    }
    part->texture = texture ? texture : part->texture;
    part->interior = record.material.interior ? record.material.interior : part->interior;
    return true;
}
