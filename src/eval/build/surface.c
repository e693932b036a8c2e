// `uv_mapping`: textures and parts of them that are laid out by surface coordinates.
//
// What is on the surface keeps the transform that it has at the closing brace of the block where the word stands;
// nothing that comes later, of textures, objects or groups around it, moves it. Where the word stands in a texture, what
// comes later turns its bumps nevertheless. All measured. Knows nothing of what the coordinates of a shape are.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "eval/build/blocks.h"

void surface_read_first(Block *block)
{
    SchemaKind kind = block->kind;
    while ((kind == KIND_PIGMENT || kind == KIND_NORMAL || kind == KIND_TEXTURE) &&
           cursor_at_word(&block->cursor, W_uv_mapping)) {
        cursor_skip(&block->cursor);
        block->on_surface = true;
    }
}

bool surface_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    const TextureDesc **texture = texture_place(block);
    if (!texture) {
        return block_fault(block, DIAG_E0256, item->span, "`%s` must stand before everything else in %s",
                           property->word, block_word(block));
    }
    if (*texture) {
        return block_fault(block, DIAG_E0256, item->span, "`%s` must stand before the texture of %s", property->word,
                           block_word(block));
    }
    block->on_surface = true;
    return true;
}

static bool map_asks(const PatternMap *map)
{
    bool asks = false;
    for (size_t i = 0; map && !asks && i < map->count; i++) {
        const PatternEntry *entry = &map->entries[i];
        asks = (entry->pigment && entry->pigment->part.asks_uv) || (entry->normal && entry->normal->part.asks_uv) ||
               (entry->texture && texture_asks_uv(entry->texture));
    }
    return asks;
}

bool surface_close(Block *block, PatternPart *part)
{
    part->asks_uv = part->on_surface || map_asks(part->map);
    return !block->on_surface || surface_hold(block->ev, block->arena, part, block->node->span);
}

bool surface_hold(Eval *ev, Arena *arena, PatternPart *part, Span span)
{
    if (part->pattern.type == PATTERN_NONE || part->on_surface) {
        return true;
    }
    part->on_surface = arena_copy(arena, &part->transform, sizeof part->transform);
    part->asks_uv = true;
    ev->objects->uses_uv = true;
    part->pattern.flags |= PATTERN_ON_SURFACE;
    return part->on_surface || eval_no_memory(ev, span);
}

bool texture_asks_uv(const TextureDesc *texture)
{
    bool asks = false;
    for (; texture && !asks; texture = texture->below) {
        asks = texture->part.asks_uv || texture->pigment.part.asks_uv || texture->normal.part.asks_uv;
    }
    return asks;
}

bool surface_moves(const PatternPart *part, const Transform *outer, Transform *later)
{
    Transform back;
    if (!part->turns || !part->on_surface || !transform_invert(part->on_surface, &back)) {
        return false;
    }
    bool is_same = memcmp(part->on_surface, &part->transform, sizeof back) == 0;
    *later = is_same ? *outer : transform_compose(transform_compose(back, part->transform), *outer);
    return !transform_is_identity(later);
}
