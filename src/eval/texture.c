// Textures: pigment, finish and reflection become one layer.
//
// A block inside another one changes only what it says; the rest is the surrounding texture's, or that of #default at
// the time. Albedo forms are worked out at a finish's closing brace, with the exponents it has by then. Knows nothing
// of shapes.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/blocks.h"

static bool read_pigment(Eval *ev, const AstNode *item, TextureLayer *layer)
{
    Blueprint record;
    SchemaKind is;
    block_defaults(ev, KIND_PIGMENT, &record);
    record.pigment.colour = layer->pigment;
    if (!block_read(ev, item, KIND_PIGMENT, &ev->program, &record, &is)) {
        return false;
    }
    layer->pigment = record.pigment.colour;
    return true;
}

static bool read_finish(Eval *ev, const AstNode *item, TextureLayer *layer)
{
    Blueprint record;
    SchemaKind is;
    block_defaults(ev, KIND_FINISH, &record);
    record.finish.finish = layer->finish;
    if (!block_read(ev, item, KIND_FINISH, &ev->program, &record, &is)) {
        return false;
    }
    layer->finish = record.finish.finish;
    return true;
}

// A texture over another one hides it if no light gets through; only then is it the only one.
static void add_layer(Eval *ev, const TextureLayer *layer, Span span, bool has_texture, TextureLayer *texture)
{
    if (has_texture && (layer->pigment.filter != 0.0 || layer->pigment.transmit != 0.0)) {
        block_unsupported(ev, "texture", span, KIND_TEXTURE);
    }
    *texture = *layer;
}

static bool read_texture(Eval *ev, const AstNode *item, bool has_texture, TextureLayer *texture)
{
    Blueprint record;
    SchemaKind is;
    block_defaults(ev, KIND_TEXTURE, &record);
    if (!block_read(ev, item, KIND_TEXTURE, &ev->program, &record, &is)) {
        return false;
    }
    add_layer(ev, &record.texture.layer, item->span, has_texture, texture);
    return true;
}

bool texture_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    Eval *ev = block->ev;
    if (block->kind == KIND_TEXTURE) {
        TextureLayer *layer = &block->record->texture.layer;
        return property->action == ACTION_PIGMENT ? read_pigment(ev, item, layer) : read_finish(ev, item, layer);
    }
    ObjectPart *part = &block->record->part;
    bool had_texture = part->has_texture;
    if (!had_texture) {
        part->texture = ev->objects->defaults;
        part->has_texture = true;
    }
    switch (property->action) {
    case ACTION_PIGMENT: return read_pigment(ev, item, &part->texture);
    case ACTION_FINISH: return read_finish(ev, item, &part->texture);
    default: return read_texture(ev, item, had_texture, &part->texture);
    }
}

bool reflection_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    static const SchemaProperty alone = {"reflection", TYPE_RGB, ACTION_NONE,
                                         .at = offsetof(FinishBlueprint, finish.reflection_min)};
    Finish *finish = &block->record->finish.finish;
    (void)property;
    if (item->kind == AST_WORD) {
        bool is_read = block_value(block, &alone, item->span);
        finish->reflection_max = finish->reflection_min;
        return is_read;
    }
    Blueprint record;
    SchemaKind is;
    record.finish = block->record->finish;
    record.finish.finish.reflection_min = record.finish.finish.reflection_max = rgb_grey(0.0);
    if (!block_read(block->ev, item, KIND_REFLECTION, block->arena, &record, &is)) {
        return false;
    }
    *finish = record.finish.finish;
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
    FinishBlueprint *record = &block->record->finish;
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
    record->diffuse_is_albedo = record->phong_is_albedo = record->specular_is_albedo = false;
    double sum = finish->diffuse + finish->diffuse_back + finish->phong + finish->specular;
    return block_finite(block, sum, block->node->span, "albedo");
}

bool eval_texture_layers(Eval *ev, const AstNode *first, Value *value)
{
    TextureBlueprint *record = arena_alloc(&ev->program, sizeof *record);
    if (!record) {
        return eval_no_memory(ev, first->span);
    }
    *value = (Value){.kind = VALUE_BLOCK, .block = KIND_TEXTURE, .record = record};
    for (const AstNode *layer = first; layer; layer = layer->next) {
        Value one;
        if (!eval_block(ev, layer, &one)) {
            return false;
        }
        if (one.block == KIND_UNSUPPORTED) {
            *value = one;
            return true;
        }
        const TextureBlueprint *texture = one.record;
        bool is_seen_through = texture->layer.pigment.filter != 0.0 || texture->layer.pigment.transmit != 0.0;
        if (layer != first && is_seen_through) {
            UnsupportedBlueprint what = {layer->span, "texture", KIND_TEXTURE};
            void *kept = arena_copy(&ev->program, &what, sizeof what);
            if (!kept) {
                return eval_no_memory(ev, layer->span);
            }
            *value = (Value){.kind = VALUE_BLOCK, .block = KIND_UNSUPPORTED, .record = kept};
            return true;
        }
        *record = *texture;
    }
    return true;
}

bool eval_default(Eval *ev, const AstNode *directive)
{
    Cursor cursor;
    TextureLayer *defaults = &ev->objects->defaults;
    bool is_fine = true;
    const AstNode *item;
    cursor_open(&cursor, ev, directive->a, directive->span);
    while ((item = cursor_peek(&cursor))) {
        switch (block_kind(ev, item)) {
        case KIND_TEXTURE: is_fine = read_texture(ev, item, false, defaults) && is_fine; break;
        case KIND_PIGMENT: is_fine = read_pigment(ev, item, defaults) && is_fine; break;
        case KIND_FINISH: is_fine = read_finish(ev, item, defaults) && is_fine; break;
        default:
            is_fine = eval_fault(ev, DIAG_E0256, item->span,
                                 "#default holds texture, pigment and finish blocks only");
            break;
        }
        do {
            cursor_skip(&cursor); // what is not understood, with all that belongs to it
        } while (!is_fine && (item = cursor_peek(&cursor)) && item->kind != AST_BLOCK);
    }
    cursor_close(&cursor);
    return is_fine;
}
