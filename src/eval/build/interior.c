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

// What a name says of textures is laid over what there is.
static bool take_texture(Block *block, const TextureDesc *named, Span span, const TextureDesc **place)
{
    if (named && *place) {
        named = texture_laid_over(block->ev, block->arena, named, *place, span);
        if (!named) {
            return false;
        }
    }
    *place = named ? named : *place;
    return true;
}

bool material_take_name(Block *block, const MaterialDesc *material, Span span)
{
    MaterialDesc *record = &block->record->material;
    record->interior = material->interior;
    return take_texture(block, material->texture, span, &record->texture) &&
           take_texture(block, material->inner, span, &record->inner);
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
    record.material.inner = part->inner;
    record.material.interior = part->interior;
    if (!block_read(block->ev, item, KIND_MATERIAL, block->arena, &record, &is)) {
        return false;
    }
    part->texture = record.material.texture;
    part->inner = record.material.inner;
    part->interior = record.material.interior;
    return true;
}
