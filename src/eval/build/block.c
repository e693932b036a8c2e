// The generic evaluator of blocks: `word { … }` becomes a description, as the schema says.
//
// Takes a leading identifier or the positional arguments, then the properties, each by its type or by the action that
// the table names. Whatever does not fit is a located fault and is passed over, so that one run reports all faults.
// Knows nothing of what a property means.
//
// SPDX-License-Identifier: MIT
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/suggest.h"
#include "eval/build/blocks.h"

typedef bool (*BlockAction)(Block *block, const SchemaProperty *property, const AstNode *item);
typedef bool (*BlockHook)(Block *block);

static const BlockAction actions[ACTION_COUNT] = {
    [ACTION_TRANSLATE] = transform_action,
    [ACTION_ROTATE] = transform_action,
    [ACTION_SCALE] = transform_action,
    [ACTION_MATRIX] = transform_action,
    [ACTION_TRANSFORM] = transform_action,
    [ACTION_TEXTURE] = texture_action,
    [ACTION_INNER_TEXTURE] = inner_texture_action,
    [ACTION_PIGMENT] = texture_action,
    [ACTION_FINISH] = texture_action,
    [ACTION_NORMAL] = texture_action,
    [ACTION_PATTERN] = pattern_action,
    [ACTION_WAVE] = pattern_wave_action,
    [ACTION_PATTERN_SOLID] = pattern_solid_action,
    [ACTION_MAP] = pattern_map_action,
    [ACTION_INTERIOR] = interior_action,
    [ACTION_MATERIAL] = material_action,
    [ACTION_IMAGE_MAP] = image_map_action,
    [ACTION_IMAGE] = image_action,
    [ACTION_REFLECTION] = reflection_action,
    [ACTION_ANGLE] = camera_angle_action,
    [ACTION_LOOK_AT] = camera_look_at_action,
    [ACTION_BLUR_SAMPLES] = camera_blur_action,
    [ACTION_POINT_AT] = light_point_at_action,
    [ACTION_ASSUMED_GAMMA] = settings_gamma_action,
    [ACTION_CLIP] = clip_action,
    [ACTION_BLOB_PART] = blob_part_action,
    [ACTION_SHAPE_FUNCTION] = shape_function_action,
    [ACTION_CONTAINED_BY] = contained_by_action,
    [ACTION_CONTAINER] = container_action,
    [ACTION_EVALUATE] = isosurface_evaluate_action,
    [ACTION_PRECOMPUTE] = parametric_precompute_action,
    [ACTION_JULIA] = julia_action,
    [ACTION_FRACTAL] = pattern_fractal_action,
    [ACTION_INVERSE] = inverse_action,
    [ACTION_LIGHT_TYPE] = light_type_action,
    [ACTION_CONE] = light_cone_action,
    [ACTION_SKY_LAYER] = sky_layer_action,
    [ACTION_WARP] = warp_action,
    [ACTION_TILES] = tiles_action,
    [ACTION_INSIDE] = pattern_inside_action,

    [ACTION_WARP_TYPE] = warp_type_action,
    [ACTION_SLOPE] = slope_action,
    [ACTION_SLOPE_ITEM] = slope_item_action,
    [ACTION_FUNCTION] = pattern_function_action,
    [ACTION_IRID] = finish_irid_action,
    [ACTION_CYLINDER] = camera_cylinder_action,
    [ACTION_CHARSET] = settings_charset_action,
    [ACTION_NOISE_GENERATOR] = settings_generator_action,
    [ACTION_RAINBOW_MAP] = rainbow_map_action,
    [ACTION_CAMERA_NORMAL] = camera_normal_action,
    [ACTION_AREA_LIGHT] = light_area_action,
    [ACTION_SURFACE] = surface_action,
    [ACTION_PICTURE] = pattern_picture_action,
    [ACTION_DENSITY] = density_action,
    [ACTION_MAP_MATERIAL] = material_texture_action,
    [ACTION_SHADOWLESS] = light_shadowless_action,
    [ACTION_LOOKS_LIKE] = light_look_action,
};

// Between the arguments and the properties.
static const BlockHook bodies[KIND_COUNT] = {
    [KIND_UNION] = object_members,
    [KIND_MERGE] = object_members,
    [KIND_INTERSECTION] = object_members,
    [KIND_DIFFERENCE] = object_members,
    [KIND_LIGHT_GROUP] = object_members,
    [KIND_OBJECT] = object_body,
    [KIND_CLIPPED_BY] = clip_body,
    [KIND_BOUNDED_BY] = clip_body,
    [KIND_LOOKS_LIKE] = object_body,
    [KIND_TEXT] = text_body,
    [KIND_PRISM] = prism_body,
    [KIND_POLYGON] = polygon_body,
    [KIND_LATHE] = lathe_body,
    [KIND_SOR] = sor_body,
    [KIND_SUPERELLIPSOID] = superellipsoid_body,
    [KIND_POLYNOMIAL] = polynomial_body,
    [KIND_SPHERE_SWEEP] = sweep_body,
    [KIND_PARAMETRIC] = parametric_body,
    [KIND_JULIA_FRACTAL] = julia_body,
    [KIND_MESH] = mesh_body,
    [KIND_MESH2] = mesh2_body,
    [KIND_HEIGHT_FIELD] = height_field_body,
    [KIND_BICUBIC_PATCH] = bicubic_body,
    [KIND_COLOUR_MAP] = pattern_map_body,
    [KIND_PIGMENT_MAP] = pattern_map_body,
    [KIND_TEXTURE_MAP] = pattern_map_body,
    [KIND_IMAGE_MAP] = image_body,
    [KIND_IMAGE_PATTERN] = image_body,
    [KIND_BUMP_MAP] = image_body,
    [KIND_MATERIAL_MAP] = image_body,
    [KIND_NORMAL_MAP] = pattern_map_body,
    [KIND_SLOPE_MAP] = pattern_map_body,
};

// At the closing brace.
static const BlockHook closings[KIND_COUNT] = {
    [KIND_CAMERA] = camera_close,
    [KIND_UNION] = union_close,
    [KIND_MERGE] = union_close,
    [KIND_INTERSECTION] = union_close,
    [KIND_DIFFERENCE] = union_close,
    [KIND_LIGHT_GROUP] = light_group_close,
    [KIND_FINISH] = finish_close,
    [KIND_REFLECTION] = reflection_close,
    [KIND_TRANSFORM] = transform_close,
    [KIND_PATTERN] = pattern_close,
    [KIND_WARP] = warp_close,
    [KIND_SLOPE] = slope_close,
    [KIND_MESH] = mesh_close,
    [KIND_MESH2] = mesh_close,
    [KIND_HEIGHT_FIELD] = height_field_close,
    [KIND_SKY_SPHERE] = sky_close,
    [KIND_FOG] = fog_close,
    [KIND_RAINBOW] = rainbow_close,
    [KIND_TEXTURE] = pattern_close,
    [KIND_PIGMENT] = pattern_close,
    [KIND_NORMAL] = normal_close,
    [KIND_IMAGE_MAP] = image_close,
    [KIND_IMAGE_PATTERN] = image_close,
    [KIND_BUMP_MAP] = image_close,
    [KIND_MATERIAL_MAP] = image_close,
    [KIND_LIGHT_SOURCE] = light_close,
};

SchemaKind block_kind(const Eval *ev, const AstNode *node)
{
    return node->kind == AST_BLOCK && node->symbol < WORD_COUNT ? (SchemaKind)ev->objects->kinds[node->symbol]
                                                                : KIND_NONE;
}

bool block_is_name(const AstNode *item)
{
    return item->kind == AST_NAME || item->kind == AST_INDEX;
}

void block_defaults(const Eval *ev, SchemaKind kind, Desc *record)
{
    const SchemaBlock *schema = schema_kind(kind);
    const Settings *settings = &ev->scene->settings;
    memcpy(record, schema->defaults, schema->size);
    switch (kind) {
    case KIND_TEXTURE:
        record->texture = *ev->objects->defaults;
        break;
    case KIND_PIGMENT:
        record->pigment = ev->objects->defaults->pigment;
        break;
    case KIND_NORMAL:
        record->normal = ev->objects->defaults->normal;
        break;
    case KIND_FINISH:
        record->finish.finish = ev->objects->defaults->finish;
        break;
    case KIND_GLOBAL_SETTINGS:
        record->settings.ambient_light = settings->ambient_light;
        record->settings.adc_bailout = settings->adc_bailout;
        record->settings.max_trace_level = settings->max_trace_level;
        record->settings.noise_generator = settings->noise_generator;
        record->settings.number_of_waves = settings->number_of_waves;
        record->settings.irid_wavelength = settings->irid_wavelength;
        break;
    default:
        break;
    }
}

// ---- the beginning of a block

static bool name_fits(const Block *block, const Value *value)
{
    if (schema_kind(block->kind)->is_object || block->kind == KIND_LOOKS_LIKE) {
        return schema_kind((SchemaKind)value->block)->is_object;
    }
    bool is_part = value->block == KIND_PIGMENT || value->block == KIND_NORMAL || value->block == KIND_FINISH;
    return value->block == block->kind || (block->kind == KIND_TEXTURE && is_part);
}

static void take_name(Block *block, const Value *value, const AstNode *item)
{
    if (value->block == KIND_UNSUPPORTED) {
        block_unsupported_name(block->ev, value->record, item->span);
        block->has_unsupported = block->is_lost = true;
        return;
    }
    block_tell_lacks(block->ev, value, item->span);
    if (!name_fits(block, value)) {
        block_fault(block, DIAG_E0258, item->span, "`%s` cannot begin with %s", block_word(block),
                    value_describe(value));
    } else if (block->kind == KIND_TEXTURE && value->block != KIND_TEXTURE) {
        texture_take_part(&block->record->texture, (SchemaKind)value->block, value->record);
    } else if (block->kind == KIND_MATERIAL) {
        block->has_fault = !material_take_name(block, value->record, item->span) || block->has_fault;
    } else {
        block->is = (SchemaKind)value->block;
        memcpy(block->record, value->record, schema_kind(block->is)->size);
    }
}

static bool is_declared(const Eval *ev, const AstNode *name)
{
    return name->flags & AST_KNOWN ? name->known != NULL : scope_find(ev, name->symbol) != NULL;
}

static const SchemaProperty *find_property(const Block *block, const AstNode *item)
{
    Symbol word = item->kind == AST_FUNCTION ? (Symbol)W_function : item->symbol;
    bool is_word = item->kind == AST_WORD || item->kind == AST_BLOCK || item->kind == AST_FUNCTION;
    if (!is_word || word >= WORD_COUNT) {
        return NULL;
    }
    // What is said of how roots are found may be said of a copy, too.
    bool is_of_shape = block->kind == KIND_OBJECT && (word == W_sturm || word == W_hierarchy);
    SchemaKind kind = is_of_shape ? block->is : block->kind;
    unsigned place = block->ev->objects->properties[kind][word];
    return place ? schema_property(kind, place - 1) : NULL;
}

const SchemaProperty *block_transform_word(const Block *block, const AstNode *item)
{
    const SchemaProperty *property = find_property(block, item);
    return property && schema_is_transform(property) ? property : NULL;
}

// Passes over what belongs to a word that is left out: numbers, colours and names, none of them a mistyped property.
static void skip_own_values(Block *block)
{
    const AstNode *item;
    while ((item = cursor_peek(&block->cursor)) && item->kind != AST_BLOCK && !find_property(block, item)) {
        bool is_word = item->kind == AST_WORD && word_class(item->symbol) != WORD_COLOUR;
        bool is_name = item->kind == AST_NAME && !is_declared(block->ev, item);
        if (is_word || is_name) {
            return;
        }
        cursor_skip(&block->cursor);
    }
}

// Passes over what belongs to a word that was not understood.
static void skip_values(Block *block)
{
    const AstNode *item;
    while ((item = cursor_peek(&block->cursor)) && item->kind != AST_BLOCK && !find_property(block, item) &&
           !block_is_misspelt(block, item)) {
        cursor_skip(&block->cursor);
    }
}

// A leading identifier of a block. One that stands for a number or a colour is left for the arguments.
static void read_name(Block *block)
{
    const AstNode *item = cursor_peek(&block->cursor);
    Value value;
    bool takes_members = block->kind == KIND_CLIPPED_BY || block->kind == KIND_BOUNDED_BY ||
                         block->kind == KIND_LIGHT_GROUP; // names, too
    if (!item || !block_is_name(item) || takes_members) {
        return;
    }
    // A misspelt property rather than an identifier: where nothing but a block's name may stand, or where it is near.
    const SchemaList *arguments = &schema_kind(block->kind)->arguments;
    bool takes_values = arguments->count > 0 || bodies[block->kind];
    bool may_lack_values = arguments->count == 0 || arguments->items[0].is_optional;
    if ((item->kind == AST_NAME && !takes_values && !is_declared(block->ev, item)) ||
        (may_lack_values && block_is_misspelt(block, item))) {
        return;
    }
    block->ev->at_colour = block->kind == KIND_PIGMENT;
    bool is_value = eval_expression(block->ev, item, &value);
    block->ev->at_colour = false;
    if (!is_value) {
        block->has_fault = true;
        block->has_name = !object_is_group(block->kind); // of a group it may have been a member
        cursor_skip(&block->cursor);
        if (block->kind == KIND_PIGMENT) {
            skip_values(block); // of a colour word that was not understood
        }
    } else if (value.kind == VALUE_BLOCK) {
        block->has_name = true;
        cursor_skip(&block->cursor);
        take_name(block, &value, item);
    }
}

static bool read_argument(Block *block, const SchemaProperty *argument)
{
    bool takes_colour = argument->type == TYPE_COLOUR || argument->type == TYPE_RGB;
    bool is_component = block->kind == KIND_BLOB_BALL || block->kind == KIND_BLOB_ROD;
    if (is_component && block->arguments > 1 && cursor_at_word(&block->cursor, W_strength)) {
        cursor_skip(&block->cursor);
    }
    if (!(takes_colour ? cursor_at_value(&block->cursor) : block_at_expression(block))) {
        return argument->is_optional ||
               block_fault(block, DIAG_E0253, block_here(block), "`%s` needs %s here: its %s", block_word(block),
                           schema_type_need(argument->type), argument->word);
    }
    const AstNode *item = cursor_peek(&block->cursor);
    if (argument->is_optional && block_is_misspelt(block, item)) {
        return true;
    }
    if (block->arguments == 0 && block->cursor.has_comma) {
        block->cursor.has_comma = false;
        block_fault(block, DIAG_E0259, item->span, "no comma may stand before the %s", argument->word);
    }
    bool has_colour_first = block->kind == KIND_PIGMENT || argument->is_anywhere;
    block->ev->wants_colour = has_colour_first && block_begins_with_macro(block, item);
    if (has_colour_first && !block->ev->wants_colour && !block_begins_like_colour(block, item)) {
        block_fault(block, DIAG_E0254, item->span,
                    "the colour of a %s begins with a colour word such as `rgb`, or with the name of a colour",
                    block_word(block));
    }
    block->arguments++;
    if (block->kind == KIND_PIGMENT) {
        block->record->patterned.pattern.type = PATTERN_NONE; // of #default, or of what stood before
    }
    return block_read_typed(block, argument, (char *)block->record + argument->at);
}

static void read_arguments(Block *block)
{
    const SchemaList *list = &schema_kind(block->kind)->arguments;
    // `pigment { P rgb … }` takes P's place in everything else, as does `normal { N 0.3 … }`.
    if (block->has_name && block->kind != KIND_PIGMENT && block->kind != KIND_NORMAL) {
        return;
    }
    for (size_t i = 0; i < list->count; i++) {
        size_t before = block->arguments;
        if (!read_argument(block, &list->items[i])) {
            block->has_fault = true;
        }
        if (block->arguments == before) {
            return; // left out, or missing
        }
        if (i + 1 < list->count) {
            cursor_take_comma(&block->cursor);
        }
    }
}

// ---- properties

static bool is_property_elsewhere(const Block *block, Symbol symbol)
{
    for (size_t kind = 0; kind < KIND_COUNT; kind++) {
        if (block->ev->objects->properties[kind][symbol]) {
            return true;
        }
    }
    return false;
}

// POV-Ray has the word in many blocks, and rtlang in other ones than this.
static bool is_advised_against(const Block *block, Symbol symbol)
{
    return block->ev->objects->advice[symbol] != 0;
}

// The type of a camera or light changes what its other words mean, so nothing more is said about those.
static void refuse_unsupported(Block *block, const AstNode *item)
{
    if (!block->has_unsupported || block->ev->options.is_lenient) {
        block->has_unsupported = true;
        const char *word = item->kind == AST_FUNCTION ? "function" : eval_text(block->ev, item->symbol);
        block_unsupported(block->ev, word, item->span, block->kind);
    }
    while (schema_kind(block->kind)->is_fixed && !block->ev->options.is_lenient && cursor_peek(&block->cursor)) {
        cursor_skip(&block->cursor);
    }
}

// A word or block that is no property of this kind.
static void refuse_word(Block *block, const AstNode *item)
{
    SchemaKind kind = block_kind(block->ev, item);
    bool is_member = item->kind == AST_WORD && item->symbol < WORD_COUNT && object_is_group(block->kind) &&
                     schema_kind((SchemaKind)block->ev->objects->kinds[item->symbol])->is_object;
    if (block_is_lacking(block, item->symbol)) {
        refuse_unsupported(block, item);
    } else if (is_member) {
        block_fault(block, DIAG_E0257, item->span, "`{` is missing after `%s`", eval_text(block->ev, item->symbol));
    } else if (object_is_group(block->kind) && schema_kind(kind)->is_object) {
        block_fault(block, DIAG_E0256, item->span, "`%s` must stand before the properties of the %s",
                    schema_kind(kind)->word, block_word(block));
    } else if (object_is_statement(kind)) {
        block_fault(block, DIAG_E0256, item->span, "`%s` cannot stand here", schema_kind(kind)->word);
    } else if (word_class(item->symbol) == WORD_COLOUR) {
        block_refuse_colour(block, item);
    } else if (item->kind == AST_BLOCK && item->symbol >= WORD_COUNT && object_is_group(block->kind)) {
        block->has_fault = true;
        block_unknown(block->ev, item);
    } else if (item->symbol >= WORD_COUNT ||
               (is_property_elsewhere(block, item->symbol) && !is_advised_against(block, item->symbol))) {
        block_unknown_property(block, item);
    } else {
        refuse_unsupported(block, item);
        if (block->ev->options.is_lenient) {
            bool has_values = item->kind == AST_WORD;
            cursor_skip(&block->cursor);
            if (has_values) {
                skip_own_values(block);
            }
            return;
        }
    }
    cursor_skip(&block->cursor);
    skip_values(block);
}

// An expression where a property should stand; a name that was never declared is a misspelt one.
static void refuse_value(Block *block, const AstNode *item)
{
    Value value;
    item = block_leading_name(block, item);
    bool is_undeclared = item->kind == AST_NAME && !is_declared(block->ev, item);
    if (is_undeclared && (bodies[block->kind] || block_is_capital(block, item)) && !block_is_misspelt(block, item)) {
        // Where objects stand it is more likely one of them, and no property begins with a capital.
        block->has_fault = !eval_expression(block->ev, item, &value);
    } else if (is_undeclared) {
        block_unknown_property(block, item);
    } else if (item->kind == AST_FUNCTION) {
        refuse_unsupported(block, item);
    } else if (block->has_fault) {
        // It may be a value that would have had its place.
    } else if (item->kind == AST_NAME) {
        block_fault(block, DIAG_E0254, item->span, "`%s` cannot stand here in %s", eval_text(block->ev, item->symbol),
                    block_word(block));
    } else {
        block_fault(block, DIAG_E0254, item->span, "one value too many in %s", block_word(block));
    }
    cursor_skip(&block->cursor);
    skip_values(block);
}

static bool takes_braces(const SchemaProperty *property)
{
    return property->type == TYPE_BLOCK || property->action == ACTION_TRANSFORM ||
           property->action == ACTION_REFLECTION || property->action == ACTION_SLOPE;
}

static bool may_stand_here(Block *block, const SchemaProperty *property, const AstNode *item)
{
    if ((property->is_first || property->is_leading) && (block->items > 0 || block->has_name)) {
        return block_fault(block, DIAG_E0256, item->span, "`%s` must stand first in %s", property->word,
                           block_word(block));
    }
    if (block->has_name && schema_kind(block->kind)->is_fixed && !schema_is_transform(property)) {
        return block_fault(block, DIAG_E0255, item->span, "`%s` cannot follow an identifier in %s: only transforms can",
                           property->word, block_word(block));
    }
    bool is_patterned = block->kind == KIND_TEXTURE || block->kind == KIND_PIGMENT || block->kind == KIND_NORMAL ||
                        block->kind == KIND_PATTERN;
    if ((is_patterned && !pattern_allows(block, property, item)) ||
        (block->kind == KIND_WARP && !warp_allows(block, property, item))) {
        return false;
    }
    if (item->kind == AST_BLOCK && !takes_braces(property)) {
        return block_fault(block, DIAG_E0257, item->span, "`%s` takes no braces", property->word);
    }
    if (item->kind == AST_WORD && property->type == TYPE_BLOCK) {
        return block_fault(block, DIAG_E0257, item->span, "`{` is missing after `%s`", property->word);
    }
    return true;
}

static void read_property(Block *block, const SchemaProperty *property, const AstNode *item)
{
    bool is_allowed = may_stand_here(block, property, item);
    cursor_skip(&block->cursor);
    block->items += !property->is_leading;
    bool is_action = property->type == TYPE_ACTION || property->type == TYPE_BLOCK;
    if (!is_allowed ||
        !(is_action ? actions[property->action](block, property, item) : block_value(block, property, item->span))) {
        bool is_left_out = eval_leaves_out(block->ev);
        block->has_unsupported = is_left_out || block->has_unsupported;
        block->has_fault = !is_left_out || block->has_fault;
        skip_values(block);
    }
}

// An argument that may stand among the properties, at its place; else NULL.
static const SchemaProperty *find_loose_argument(Block *block, const AstNode *item)
{
    const SchemaList *list = &schema_kind(block->kind)->arguments;
    bool is_loose = list->count == 1 && list->items[0].is_anywhere && cursor_at_value(&block->cursor);
    return is_loose && !block_is_misspelt(block, item) && block_begins_like_colour(block, item) ? list->items : NULL;
}

// After a fault it may belong to what was not understood.
static void check_comma(Block *block)
{
    if (!block->has_fault && !block->has_unsupported && !cursor_lacks_comma(&block->cursor, block_word(block))) {
        block->has_fault = true;
    }
}

static void read_properties(Block *block)
{
    const AstNode *item;
    while ((item = cursor_peek(&block->cursor))) {
        const SchemaProperty *property = find_property(block, item);
        bool is_word = item->kind == AST_WORD || item->kind == AST_BLOCK;
        if (is_word) {
            check_comma(block);
        }
        const SchemaProperty *loose = property ? NULL : find_loose_argument(block, item);
        if (property) {
            read_property(block, property, item);
        } else if (loose) {
            block->has_fault = !block_value(block, loose, item->span) || block->has_fault;
        } else if (!property && block_is_idle_colour(block, item)) {
            if (!block_pass_colour(block)) {
                skip_values(block);
            }
        } else if (is_word) {
            refuse_word(block, item);
        } else {
            refuse_value(block, item);
        }
    }
    check_comma(block);
}

bool block_read_items(Block *block, SchemaKind *is)
{
    SchemaKind kind = block->kind;
    surface_read_first(block);
    read_name(block);
    read_arguments(block);
    if (bodies[kind] && !block->has_name && !bodies[kind](block)) {
        block->has_fault = true;
    }
    if (block->moved && !block->has_fault && !block->has_unsupported && !block_transform(block, block->moved)) {
        block->has_fault = true;
    }
    read_properties(block);
    cursor_close(&block->cursor);
    BlockHook closing = shape_class(kind)->settle || shape_class(kind)->close ? shape_close : closings[kind];
    if (block->ev->stop || block->has_fault || (closing && !closing(block))) {
        return false;
    }
    *is = block->is;
    return block->ev->options.is_lenient ? !block->is_lost
                                         : !block->has_unsupported || block->ev->objects->is_deferring;
}

bool block_read(Eval *ev, const AstNode *node, SchemaKind kind, Arena *arena, Desc *record, SchemaKind *is)
{
    return block_read_moved(ev, node, kind, (BlockRoom){arena, NULL}, record, is);
}

bool block_read_moved(Eval *ev, const AstNode *node, SchemaKind kind, BlockRoom room, Desc *record, SchemaKind *is)
{
    Block block = {
        .ev = ev, .node = node, .arena = room.arena, .record = record, .kind = kind, .is = kind, .moved = room.moved};
    cursor_open(&block.cursor, ev, node->a, node->span);
    if (!block_read_items(&block, is)) {
        return false;
    }
    if (schema_kind(block.is)->is_object) {
        record->part.span = node->span;
        return inner_texture_fits(&block);
    }
    return true;
}
