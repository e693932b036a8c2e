// Textures: pigments, finishes and layers.
//
// A block inside another one changes only what it says; the rest is the surrounding texture's, or that of #default at
// the time. An object's texture is never changed in place, for copies may share it. Albedo forms are computed at a
// finish's closing brace, with the exponents it has by then. Knows nothing of shapes.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/build/blocks.h"
#include "eval/build/shared_maps.h"

void texture_transform(TextureDesc *texture, const Transform *transform)
{
    texture->part.transform = transform_compose(texture->part.transform, *transform);
}

// Whether anything was said of bumps.
static bool has_normal(const TextureDesc *texture)
{
    return texture->normal.part.pattern.type != PATTERN_NONE || normal_lacks_pattern(&texture->normal);
}

// Hands the transform of a texture on to what it has by now, so that a part that comes later is not moved by it. Each
// texture has a pigment, if only the default one.
static bool settle(Eval *ev, Arena *arena, TextureDesc *texture, Span span)
{
    const Transform *transform = &texture->part.transform;
    if (texture->part.pattern.type != PATTERN_NONE) {
        return true;
    }
    texture->pigment.part.transform = transform_compose(texture->pigment.part.transform, *transform);
    if (has_normal(texture)) {
        texture->normal.part.transform = transform_compose(texture->normal.part.transform, *transform);
    }
    if (texture->below) {
        TextureDesc *below = arena_copy(arena, texture->below, sizeof *below);
        if (!below) {
            return eval_no_memory(ev, span);
        }
        texture_transform(below, transform);
        texture->below = below;
    }
    texture->part.transform = transform_identity();
    return true;
}

bool texture_put_on_surface(Eval *ev, Arena *arena, TextureDesc *texture, bool with_below, Span span)
{
    for (TextureDesc *layer = texture; layer; layer = (TextureDesc *)layer->below) { // a copy that settle has made
        if (!settle(ev, arena, layer, span) || !surface_hold(ev, arena, &layer->part, span) ||
            !surface_hold(ev, arena, &layer->pigment.part, span) ||
            !surface_hold(ev, arena, &layer->normal.part, span)) {
            return false;
        }
        layer->part.turns |= !with_below;
        layer->normal.part.turns |= !with_below;
        if (!with_below || layer->part.pattern.type != PATTERN_NONE) {
            return true;
        }
    }
    return true;
}

static Rgbft without_filter(Rgbft colour)
{
    colour.transmit += colour.filter;
    colour.filter = 0.0;
    return colour;
}

static bool makes_filters_clear(const Eval *ev)
{
    return ev->version < 3.1 || numbers_equal(ev->version, 3.1);
}

static bool clear_filters(Eval *ev, Arena *arena, SharedMaps *shared, PigmentDesc *pigment, Span span);

static bool clear_entries(Eval *ev, Arena *arena, SharedMaps *shared, const PatternMap *map, Span span,
                          const PatternMap **cleared)
{
    PatternMap *changed = arena_copy(arena, map, sizeof *map);
    PatternEntry *entries = changed ? arena_alloc_array(arena, map->count, sizeof *entries) : NULL;
    bool is_fine = entries != NULL;
    for (size_t i = 0; is_fine && i < map->count; i++) {
        entries[i] = map->entries[i];
        entries[i].colour = without_filter(entries[i].colour);
        if (entries[i].pigment) {
            PigmentDesc *inner = arena_copy(arena, entries[i].pigment, sizeof *inner);
            is_fine = inner && clear_filters(ev, arena, shared, inner, span);
            entries[i].pigment = inner;
        }
    }
    if (!is_fine) {
        return eval_no_memory(ev, span);
    }
    changed->entries = entries;
    *cleared = changed;
    return true;
}

static bool clear_filters(Eval *ev, Arena *arena, SharedMaps *shared, PigmentDesc *pigment, Span span)
{
    const PatternMap *map = pigment->part.map;
    uint32_t place;
    bool is_new;
    pigment->colour = without_filter(pigment->colour);
    if (!map) {
        return true;
    }
    if (!shared_maps_place(shared, map, &place, &is_new)) {
        return eval_no_memory(ev, span);
    }
    if (is_new) {
        const PatternMap *cleared = NULL;
        if (!clear_entries(ev, arena, shared, map, span, &cleared)) {
            return false;
        }
        shared->made.items[place].changed = cleared;
    }
    pigment->part.map = shared->made.items[place].changed;
    return true;
}

// Up to version 3.1 the filters of what lies over something let light through unchanged: POV-Ray makes `transmit` of
// them. Measured, also of maps.
static bool take_filters(Eval *ev, Arena *arena, PigmentDesc *pigment, Span span)
{
    SharedMaps shared = {0};
    bool is_fine = clear_filters(ev, arena, &shared, pigment, span);
    shared_maps_fini(&shared);
    return is_fine;
}

static bool read_pigment(Eval *ev, const AstNode *item, Arena *arena, TextureDesc *texture)
{
    Desc record;
    SchemaKind is;
    if (!settle(ev, arena, texture, item->span)) {
        return false;
    }
    record.pigment = texture->pigment;
    if (!block_read(ev, item, KIND_PIGMENT, arena, &record, &is)) {
        return false;
    }
    texture->pigment = record.pigment;
    return true;
}

static bool read_normal(Eval *ev, const AstNode *item, Arena *arena, TextureDesc *texture)
{
    Desc record;
    SchemaKind is;
    if (!settle(ev, arena, texture, item->span)) {
        return false;
    }
    // A texture without bumps, of before the #default, begins with those that are the default now. Measured.
    record.normal = has_normal(texture) ? texture->normal : ev->objects->defaults->normal;
    if (!block_read(ev, item, KIND_NORMAL, arena, &record, &is)) {
        return false;
    }
    texture->normal = record.normal;
    return true;
}

static bool read_finish(Eval *ev, const AstNode *item, Arena *arena, TextureDesc *texture)
{
    Desc record;
    SchemaKind is;
    block_defaults(ev, KIND_FINISH, &record);
    record.finish.finish = texture->finish;
    record.finish.ior = texture->ior;
    record.finish.is_fresnel = texture->finish.flags & FINISH_FRESNEL;
    if (!block_read(ev, item, KIND_FINISH, arena, &record, &is)) {
        return false;
    }
    texture->finish = record.finish.finish;
    texture->ior = record.finish.ior;
    return true;
}

// Lays `top`, which may have layers of its own, over `below`.
static bool lay_over(Eval *ev, Arena *arena, TextureDesc *top, const TextureDesc *below, Span span)
{
    TextureDesc *layer = top;
    for (;;) {
        if (!settle(ev, arena, layer, span) || !eval_step(ev, span)) {
            return false;
        }
        if (layer->part.pattern.type != PATTERN_NONE || below->part.pattern.type != PATTERN_NONE) {
            return eval_fault(ev, DIAG_E0290, span, "a pattern of textures can be no layer");
        }
        if (layer->part.turns || below->part.turns) {
            return eval_fault(ev, DIAG_E0290, span,
                              "a texture that begins with `uv_mapping` can be no layer: its "
                              "pigment can");
        }
        if (makes_filters_clear(ev) && !take_filters(ev, arena, &layer->pigment, span)) {
            return false;
        }
        if (!layer->below) {
            layer->below = below;
            return true;
        }
        layer = (TextureDesc *)layer->below; // a copy that settle has made
    }
}

const TextureDesc *texture_laid_over(Eval *ev, Arena *arena, const TextureDesc *top, const TextureDesc *below,
                                     Span span)
{
    TextureDesc *texture = arena_copy(arena, top, sizeof *texture);
    if (!texture) {
        (void)eval_no_memory(ev, span);
        return NULL;
    }
    return lay_over(ev, arena, texture, below, span) ? texture : NULL;
}

static bool read_texture(Eval *ev, const AstNode *item, Arena *arena, const TextureDesc *below, TextureDesc *texture)
{
    Desc record;
    SchemaKind is;
    block_defaults(ev, KIND_TEXTURE, &record);
    if (!block_read(ev, item, KIND_TEXTURE, arena, &record, &is) ||
        (below && !lay_over(ev, arena, &record.texture, below, item->span))) {
        return false;
    }
    *texture = record.texture;
    return true;
}

static bool read_part(Eval *ev, SchemaAction action, const AstNode *item, Arena *arena, TextureDesc *texture)
{
    switch (action) {
    case ACTION_PIGMENT:
        return read_pigment(ev, item, arena, texture);
    case ACTION_NORMAL:
        return read_normal(ev, item, arena, texture);
    default:
        return read_finish(ev, item, arena, texture);
    }
}

// The object of a `looks_like` may be missing: that is reported, and what follows it is read nevertheless.
static bool has_object(const Block *block)
{
    return schema_kind(block->is)->is_object || block->kind == KIND_LOOKS_LIKE;
}

const TextureDesc **texture_place(Block *block)
{
    bool is_object = has_object(block) || block->kind == KIND_BLOB_BALL || block->kind == KIND_BLOB_ROD;
    return block->kind == KIND_MATERIAL ? &block->record->material.texture
           : is_object                  ? &block->record->part.texture
                                        : NULL;
}

bool texture_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    Eval *ev = block->ev;
    const TextureDesc **place = texture_place(block);
    const TextureDesc *before = block->kind == KIND_TEXTURE ? &block->record->texture : *place;
    if (before && before->part.pattern.type != PATTERN_NONE && property->action != ACTION_TEXTURE) {
        return eval_fault(ev, DIAG_E0290, item->span, "a pattern of textures has no %s of its own", property->word);
    }
    if (block->kind == KIND_TEXTURE) {
        return read_part(ev, property->action, item, block->arena, &block->record->texture);
    }
    TextureDesc *texture = arena_copy(block->arena, before ? before : ev->objects->defaults, sizeof *texture);
    if (!texture) {
        return eval_no_memory(ev, item->span);
    }
    *place = texture;
    bool is_read = property->action == ACTION_TEXTURE ? read_texture(ev, item, block->arena, before, texture)
                                                      : read_part(ev, property->action, item, block->arena, texture);
    return is_read && (!block->on_surface || texture_put_on_surface(ev, block->arena, texture, true, item->span));
}

// ---- what is seen from inside

const TextureDesc **inner_texture_place(Block *block)
{
    return block->kind == KIND_MATERIAL ? &block->record->material.inner
           : has_object(block)          ? &block->record->part.inner
                                        : NULL;
}

bool inner_texture_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    (void)property;
    const TextureDesc **place = inner_texture_place(block);
    TextureDesc *texture = arena_copy(block->arena, block->ev->objects->defaults, sizeof *texture);
    if (!texture) {
        return eval_no_memory(block->ev, item->span);
    }
    const TextureDesc *before = *place;
    *place = texture;
    return read_texture(block->ev, item, block->arena, before, texture) &&
           (!block->on_surface || texture_put_on_surface(block->ev, block->arena, texture, true, item->span));
}

bool inner_texture_fits(Block *block)
{
    const ObjectPart *part = &block->record->part;
    return !part->inner || part->texture ||
           block_fault(block, DIAG_E0253, block->node->span, "`interior_texture` needs a texture for the outside");
}

// The layers of one kind of tile, up to `tile2` or the end.
static bool read_tile(Block *block, Cursor *cursor, Span span, const TextureDesc **texture)
{
    const AstNode *item;
    *texture = NULL;
    while ((item = cursor_peek(cursor)) && block_kind(block->ev, item) == KIND_TEXTURE) {
        TextureDesc layer;
        if (!read_texture(block->ev, item, block->arena, *texture, &layer)) {
            return false;
        }
        *texture = arena_copy(block->arena, &layer, sizeof layer);
        if (!*texture) {
            return eval_no_memory(block->ev, item->span);
        }
        cursor_skip(cursor);
    }
    return *texture ||
           block_fault(block, DIAG_E0253, item ? item->span : span, "`tiles` needs textures before and after `tile2`");
}

static bool read_tiles(Block *block, Cursor *cursor, Span span, PatternEntry *entries)
{
    if (!read_tile(block, cursor, span, &entries[1].texture)) {
        return false;
    }
    if (!cursor_at_word(cursor, W_tile2)) {
        return block_fault(block, DIAG_E0253, span, "`tiles` needs textures before and after `tile2`");
    }
    cursor_skip(cursor);
    if (!read_tile(block, cursor, span, &entries[0].texture)) {
        return false;
    }
    const AstNode *rest = cursor_peek(cursor);
    return !rest || block_fault(block, DIAG_E0256, rest->span, "`tiles` holds textures and `tile2` only");
}

// The cubes of `checker`, the other way round. Measured.
bool tiles_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    Cursor cursor;
    PatternEntry entries[2] = {{.at = 0.0}, {.at = 1.0}};
    PatternPart *part = &block->record->patterned;
    if (!pattern_may_begin(block, property, item)) {
        return false;
    }
    cursor_open(&cursor, block->ev, item->a, item->span);
    bool is_read = read_tiles(block, &cursor, item->span, entries);
    cursor_close(&cursor);
    if (!is_read) {
        return false;
    }
    PatternMap map = {arena_copy(block->arena, entries, sizeof entries), 2};
    part->map = map.entries ? arena_copy(block->arena, &map, sizeof map) : NULL;
    part->pattern.type = PATTERN_CHECKER;
    part->pattern.frequency = 0.0; // the numbers of blocks stay as they are
    block->is_plain = true;        // only transforms follow
    return part->map || eval_no_memory(block->ev, item->span);
}

bool reflection_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    static const SchemaProperty alone = {"reflection", TYPE_RGB, ACTION_NONE,
                                         .at = offsetof(FinishDesc, finish.reflection_min)};
    Finish *finish = &block->record->finish.finish;
    (void)property;
    if (item->kind == AST_WORD) {
        bool is_read = block_value(block, &alone, item->span);
        finish->reflection_max = finish->reflection_min;
        return is_read;
    }
    Desc record;
    SchemaKind is;
    record.finish = block->record->finish;
    record.finish.finish.reflection_min = record.finish.finish.reflection_max = rgb_grey(0.0);
    if (!block_read(block->ev, item, KIND_REFLECTION, block->arena, &record, &is)) {
        return false;
    }
    *finish = record.finish.finish;
    block->record->finish.is_fresnel = record.finish.is_fresnel;
    return true;
}

bool finish_irid_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    Desc record;
    SchemaKind is;
    (void)property;
    record.finish = block->record->finish;
    if (!block_read(block->ev, item, KIND_IRID, block->arena, &record, &is)) {
        return false;
    }
    block->record->finish.finish = record.finish.finish;
    return true;
}

bool reflection_close(Block *block)
{
    Finish *finish = &block->record->finish.finish;
    if (block->arguments == 1) {
        finish->reflection_max = finish->reflection_min;
    }
    return true;
}

// The factors that make an albedo the share of light given back in all, as measured from POV-Ray 3.7; `specular`'s is
// the normalisation of the Blinn-Phong lobe with exponent n = 1 / roughness.
bool finish_close(Block *block)
{
    FinishDesc *record = &block->record->finish;
    Finish *finish = &record->finish;
    if (record->diffuse_is_albedo) {
        double factor = (finish->brilliance + 1.0) / 2.0;
        finish->diffuse *= factor;
        finish->diffuse_back *= factor;
    }
    if (record->phong_is_albedo) {
        finish->phong *= (finish->phong_size + 1.0) / 2.0;
    }
    if (record->specular_is_albedo) {
        double n = 1.0 / finish->roughness;
        finish->specular *= (n + 2.0) / (4.0 * (2.0 - exp2(-n / 2.0)));
    }
    if (record->conserve_energy) {
        finish->flags |= FINISH_CONSERVE_ENERGY;
    }
    finish->flags = record->is_fresnel ? finish->flags | FINISH_FRESNEL : finish->flags & ~(uint64_t)FINISH_FRESNEL;
    record->diffuse_is_albedo = record->phong_is_albedo = record->specular_is_albedo = false;
    double sum = finish->diffuse + finish->diffuse_back + finish->phong + finish->specular;
    return block_finite(block, sum, block->node->span, "albedo");
}

bool eval_texture_layer(Eval *ev, const AstNode *node, Value *layers)
{
    Value one;
    const TextureDesc *below = layers->kind == VALUE_BLOCK ? layers->record : NULL;
    if (!eval_block(ev, node, &one)) {
        return false;
    }
    if (one.block == KIND_UNSUPPORTED || (below && layers->block == KIND_UNSUPPORTED)) {
        *layers = one.block == KIND_UNSUPPORTED ? one : *layers;
        return true;
    }
    TextureDesc *layer = arena_copy(&ev->program, one.record, sizeof *layer);
    if (!layer) {
        return eval_no_memory(ev, node->span);
    }
    Value lower = *layers;
    *layers = (Value){.kind = VALUE_BLOCK, .block = KIND_TEXTURE, .record = layer, .lacks = one.lacks};
    if (below && !block_join_lacks(ev, layers, &lower, node->span)) {
        return false;
    }
    return !below || lay_over(ev, &ev->program, layer, below, node->span);
}

bool eval_texture_layers(Eval *ev, const AstNode *first, Value *value)
{
    bool fine = true;
    *value = (Value){.kind = VALUE_NONE};
    for (const AstNode *node = first; node && fine; node = node->next) {
        fine = eval_texture_layer(ev, node, value);
    }
    return fine;
}

void texture_take_part(TextureDesc *texture, SchemaKind kind, const void *part)
{
    const FinishDesc *finish = part;
    switch (kind) {
    case KIND_PIGMENT:
        texture->pigment = *(const PigmentDesc *)part;
        break;
    case KIND_NORMAL:
        texture->normal = *(const NormalDesc *)part;
        break;
    default:
        texture->finish = finish->finish;
        texture->ior = finish->ior;
        break;
    }
}

static bool read_default(Eval *ev, const AstNode *item, TextureDesc *texture)
{
    switch (block_kind(ev, item)) {
    case KIND_TEXTURE:
        return read_texture(ev, item, &ev->program, NULL, texture);
    case KIND_PIGMENT:
        return read_pigment(ev, item, &ev->program, texture);
    case KIND_NORMAL:
        return read_normal(ev, item, &ev->program, texture);
    case KIND_FINISH:
        return read_finish(ev, item, &ev->program, texture);
    default:
        return eval_fault(ev, DIAG_E0256, item->span, "#default holds texture, pigment, normal and finish blocks only");
    }
}

bool eval_default(Eval *ev, const AstNode *directive)
{
    Cursor cursor;
    bool is_fine = true;
    const AstNode *item;
    TextureDesc *texture = arena_copy(&ev->program, ev->objects->defaults, sizeof *texture);
    if (!texture) {
        return eval_no_memory(ev, directive->span);
    }
    cursor_open(&cursor, ev, directive->a, directive->span);
    while ((item = cursor_peek(&cursor))) {
        is_fine = cursor_lacks_comma(&cursor, "`#default`") && read_default(ev, item, texture) && is_fine;
        do {
            cursor_skip(&cursor); // what is not understood, with all that belongs to it
        } while (!is_fine && (item = cursor_peek(&cursor)) && item->kind != AST_BLOCK);
    }
    is_fine = cursor_lacks_comma(&cursor, "`#default`") && is_fine;
    cursor_close(&cursor);
    // What is made from it has its pigment and its bumps as they were moved, in the entries of maps, too.
    is_fine = settle(ev, &ev->program, texture, directive->span) && is_fine;
    if (is_fine && texture->part.pattern.type != PATTERN_NONE) {
        return eval_fault(ev, DIAG_E0290, directive->span, "a pattern of textures can be no #default");
    }
    ev->objects->defaults = texture;
    return is_fine;
}
