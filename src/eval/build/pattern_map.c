// What lies along a pattern: the entries of its map, or the blocks and colours that follow `checker` and the like.
//
// A map becomes a list of entries in the block's arena that is never changed again. Knows nothing of how a pattern is
// computed.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "base/number.h"
#include "eval/build/blocks.h"

enum { MAP_ENTRIES_MAX = 256 }; // as POV-Ray has it

// Entries while they are read.
typedef struct EntryList {
    PatternEntry *items;
    size_t count, capacity;
} EntryList;

static bool add_entry(Block *block, EntryList *list, const PatternEntry *entry, Span span)
{
    if (list->count == MAP_ENTRIES_MAX) {
        return block_fault(block, DIAG_E0291, span, "a map has at most %d entries", (int)MAP_ENTRIES_MAX);
    }
    if (list->count == list->capacity) {
        size_t capacity = list->capacity ? 2 * list->capacity : 4;
        PatternEntry *items = arena_alloc(block->arena, capacity * sizeof *items);
        if (!items) {
            return eval_no_memory(block->ev, span);
        }
        if (list->count) {
            memcpy(items, list->items, list->count * sizeof *items);
        }
        list->items = items;
        list->capacity = capacity;
    }
    list->items[list->count] = *entry;
    list->items[list->count++].at = number_single(entry->at); // as POV-Ray keeps it
    return true;
}

// The record of a pigment or texture that an entry holds.
static bool keep_entry(Block *block, SchemaKind kind, const Desc *record, Span span, PatternEntry *entry)
{
    const void *kept = arena_copy(block->arena, record, schema_kind(kind)->size);
    if (!kept) {
        return eval_no_memory(block->ev, span);
    }
    entry->pigment = kind == KIND_PIGMENT ? kept : NULL;
    entry->texture = kind == KIND_TEXTURE ? kept : NULL;
    entry->normal = kind == KIND_NORMAL ? kept : NULL;
    return true;
}

// A normal among others must have its pattern at once; one that is declared or the default may get it later.
static bool has_pattern(Block *block, SchemaKind kind, const Desc *record)
{
    return kind != KIND_NORMAL || !normal_lacks_pattern(&record->normal) || block->has_unsupported ||
           block_fault(block, DIAG_E0253, record->normal.span, "a normal needs a pattern");
}

// ---- maps

static bool read_colour(Block *block, Cursor *cursor, Rgbft *colour)
{
    Span span;
    if (!cursor_colour(cursor, colour, &span)) {
        block->has_fault = true;
        return false;
    }
    double sum = colour->red + colour->green + colour->blue + colour->filter + colour->transmit;
    return block_finite(block, sum - sum, span, "color_map");
}

static bool lacks_comma(Cursor *cursor)
{
    return cursor_lacks_comma(cursor, "the entry of a map");
}

// `[at colour]`, or in the old way `[from to colour colour]`.
static bool read_colour_entry(Block *block, Cursor *cursor, EntryList *list, const AstNode *node)
{
    PatternEntry entry = {0}, second = {0};
    Span span = node->span;
    if (!cursor_number(cursor, &entry.at, &span)) {
        return false;
    }
    cursor_take_comma(cursor);
    const AstNode *item = cursor_peek(cursor);
    bool is_old = item && cursor_at_value(cursor) && !block_begins_like_colour(block, item);
    if ((is_old && !(cursor_number(cursor, &second.at, &span) && lacks_comma(cursor))) || !read_colour(block, cursor, &entry.colour) ||
        !add_entry(block, list, &entry, node->span)) {
        return false;
    }
    // POV-Ray reads the second colour only after this word.
    if (is_old && !cursor_at_word(cursor, W_color) && !cursor_at_word(cursor, W_colour)) {
        item = cursor_peek(cursor);
        return block_fault(block, DIAG_E0253, item ? item->span : node->span,
                           "the second colour of an entry begins with `color`");
    }
    return !is_old ||
           (lacks_comma(cursor) && read_colour(block, cursor, &second.colour) && add_entry(block, list, &second, node->span));
}

// `[at <height, slope>]`
static bool read_slope_entry(Block *block, Cursor *cursor, EntryList *list, const AstNode *node)
{
    PatternEntry entry = {0};
    Value value;
    Span span = node->span;
    if (!cursor_number(cursor, &entry.at, &span)) {
        return false;
    }
    cursor_take_comma(cursor);
    const AstNode *item = cursor_peek(cursor);
    if (!item || !cursor_at_value(cursor)) {
        return block_fault(block, DIAG_E0253, node->span, "an entry of a slope_map needs `<height, slope>`");
    }
    if (!cursor_value(cursor, &value)) {
        return false;
    }
    bool is_pair = value.kind == VALUE_VECTOR && value.components == 2;
    if (!is_pair && value.kind != VALUE_NUMBER) {
        return block_fault(block, DIAG_E0254, item->span, "an entry of a slope_map needs `<height, slope>`, not %s",
                           value_describe(&value));
    }
    entry.height = value.v[0]; // a number is a vector of twice the same
    entry.slope = is_pair ? value.v[1] : value.number;
    return block_finite(block, entry.at + entry.height + entry.slope, node->span, "slope_map") &&
           add_entry(block, list, &entry, node->span);
}

static bool read_values(Block *block, EntryList *list, const AstNode *node)
{
    Cursor cursor;
    cursor_open(&cursor, block->ev, node->a, node->span);
    bool is_fine = block->kind == KIND_SLOPE_MAP ? read_slope_entry(block, &cursor, list, node)
                                                 : read_colour_entry(block, &cursor, list, node);
    const AstNode *rest = is_fine ? cursor_peek(&cursor) : NULL;
    if (rest) {
        is_fine = block_fault(block, DIAG_E0254, rest->span, "one value too many in the entry of a map");
    } else if (is_fine && !lacks_comma(&cursor)) {
        is_fine = false;
    }
    cursor_close(&cursor);
    return is_fine;
}

// An entry that begins with a word, a block or the name of one.
static bool begins_without_number(Block *block)
{
    const AstNode *item = cursor_peek(&block->cursor);
    if (!block->ev->objects->may_lack_weights || !item) {
        return false;
    }
    if (item->kind != AST_NAME) {
        return !cursor_at_value(&block->cursor);
    }
    const Value *value = item->flags & AST_KNOWN ? item->known : scope_find(block->ev, item->symbol);
    return value && value->kind == VALUE_BLOCK;
}

static bool read_weighed(Eval *ev, const AstNode *entry, SchemaKind kind, Arena *arena, double *at, Desc *record)
{
    Block block = {.ev = ev, .node = entry, .arena = arena, .record = record, .kind = kind, .is = kind};
    SchemaKind is;
    Span span = entry->span;
    cursor_open(&block.cursor, ev, entry->a, entry->span);
    *at = 1.0;
    if (begins_without_number(&block)) {
        return block_read_items(&block, &is);
    }
    if (!cursor_number(&block.cursor, at, &span)) {
        cursor_close(&block.cursor);
        return false;
    }
    cursor_take_comma(&block.cursor);
    return block_finite(&block, *at, span, schema_kind(kind)->word) && block_read_items(&block, &is);
}

static bool read_entry(Block *block, EntryList *list, const AstNode *node)
{
    if (block->kind == KIND_COLOUR_MAP || block->kind == KIND_SLOPE_MAP) {
        return read_values(block, list, node);
    }
    SchemaKind kind = block->kind == KIND_PIGMENT_MAP   ? KIND_PIGMENT
                      : block->kind == KIND_TEXTURE_MAP ? KIND_TEXTURE
                                                        : KIND_NORMAL;
    Desc record;
    PatternEntry entry = {0};
    block_defaults(block->ev, kind, &record);
    return read_weighed(block->ev, node, kind, block->arena, &entry.at, &record) && has_pattern(block, kind, &record) &&
           keep_entry(block, kind, &record, node->span, &entry) && add_entry(block, list, &entry, node->span);
}

bool pattern_map_body(Block *block)
{
    EntryList list = {0};
    bool is_fine = true;
    const AstNode *item;
    while ((item = cursor_peek(&block->cursor)) && item->kind == AST_ENTRY) {
        is_fine = cursor_lacks_comma(&block->cursor, block_word(block)) && read_entry(block, &list, item) && is_fine;
        cursor_skip(&block->cursor);
    }
    if (is_fine && list.count == 0) {
        return block_fault(block, DIAG_E0253, item ? item->span : block->node->span,
                           "a map needs entries such as `[0.5 …]`");
    }
    // Values may fall, as in woods.inc: the map is read from its start to the first entry beyond the value.
    block->record->map = (PatternMap){list.items, list.count};
    return is_fine;
}

// ---- blocks

// Blocks of one kind, pigments in a pigment, that follow `checker` and the like.
static bool read_blocks(Block *block, uint32_t wanted, EntryList *list)
{
    SchemaKind kind = block->kind;
    const AstNode *item;
    while (list->count < wanted && (item = cursor_peek(&block->cursor)) && block_kind(block->ev, item) == kind) {
        if (!cursor_lacks_comma(&block->cursor, block_word(block))) {
            return false;
        }
        PatternEntry entry = {.at = (double)list->count};
        Desc record;
        SchemaKind is;
        block_defaults(block->ev, kind, &record);
        bool is_kept = block_read(block->ev, item, kind, block->arena, &record, &is) &&
                       has_pattern(block, kind, &record) && keep_entry(block, kind, &record, item->span, &entry);
        cursor_skip(&block->cursor);
        cursor_take_comma(&block->cursor);
        if (!is_kept || !add_entry(block, list, &entry, item->span)) {
            return false;
        }
    }
    return true;
}

// Colours that follow them instead, in a pigment.
static bool read_colours(Block *block, uint32_t wanted, EntryList *list)
{
    const AstNode *item;
    while (list->count < wanted && (item = cursor_peek(&block->cursor)) && cursor_at_value(&block->cursor)) {
        if (!cursor_lacks_comma(&block->cursor, block_word(block))) {
            return false;
        }
        PatternEntry entry = {.at = (double)list->count};
        if (!read_colour(block, &block->cursor, &entry.colour) || !add_entry(block, list, &entry, item->span)) {
            return false;
        }
        cursor_take_comma(&block->cursor);
    }
    return true;
}

// The colours that POV-Ray takes where none are said, measured.
static bool fill_with_colours(Block *block, PatternType type, uint32_t wanted, EntryList *list, Span span)
{
    static const Rgbft blue = {0.0, 0.0, 1.0, 0.0, 0.0}, green = {0.0, 1.0, 0.0, 0.0, 0.0},
                       red = {1.0, 0.0, 0.0, 0.0, 0.0}, grey = {0.5, 0.5, 0.5, 0.0, 0.0},
                       brick = {0.6f, 0.15f, 0.15f, 0.0, 0.0};
    bool is_brick = type == PATTERN_BRICK;
    const PatternEntry defaults[3] = {{.at = 0.0, .colour = is_brick ? grey : blue},
                                      {.at = 1.0, .colour = is_brick ? brick : green},
                                      {.at = 2.0, .colour = red}};
    while (list->count < wanted) {
        if (!add_entry(block, list, &defaults[list->count], span)) {
            return false;
        }
    }
    return true;
}

// The default pigment, texture or normal in the place of those that are missing. Without a default normal POV-Ray
// crashes. Measured.
static bool fill_with_defaults(Block *block, PatternType type, uint32_t wanted, EntryList *list, Span span)
{
    Desc record;
    block_defaults(block->ev, block->kind, &record);
    if (block->kind == KIND_NORMAL && list->count < wanted && record.normal.part.pattern.type == PATTERN_NONE) {
        return block_fault(block, DIAG_E0253, span, "`%s` needs %u normals after it, or an amount",
                           pattern_info(type)->word, wanted);
    }
    while (list->count < wanted) {
        PatternEntry entry = {.at = (double)list->count};
        if (!keep_entry(block, block->kind, &record, span, &entry) || !add_entry(block, list, &entry, span)) {
            return false;
        }
    }
    return true;
}

bool pattern_read_blocks(Block *block, PatternType type, Span span)
{
    uint32_t wanted = pattern_info(type)->blocks;
    EntryList list = {0};
    if (!read_blocks(block, wanted, &list)) {
        return false;
    }
    bool has_colours = block->kind == KIND_PIGMENT && list.count == 0;
    if (has_colours && !read_colours(block, wanted, &list)) {
        return false;
    }
    if (block->kind == KIND_NORMAL && list.count == 0) {
        return true; // an amount follows
    }
    if (has_colours ? !fill_with_colours(block, type, wanted, &list, span)
                    : !fill_with_defaults(block, type, wanted, &list, span)) {
        return false;
    }
    PatternMap map = {list.items, list.count};
    PatternMap *kept = arena_copy(block->arena, &map, sizeof map);
    block->record->patterned.map = kept;
    return kept || eval_no_memory(block->ev, span);
}

// ---- a map among the words of a pattern

bool pattern_map_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    Desc record;
    SchemaKind is;
    SchemaKind kind = block_kind(block->ev, item);
    PatternType type = (PatternType)block->record->patterned.pattern.type;
    bool has_values = kind == KIND_SLOPE_MAP || kind == KIND_COLOUR_MAP;
    if (!pattern_may_follow(block, property, item)) {
        return false;
    }
    bool is_plain = block->kind == KIND_TEXTURE ||
                    (block->kind == KIND_PIGMENT && (block->arguments > 0 || block->has_name));
    if (type == PATTERN_NONE && is_plain && !block->has_unsupported) {
        return block_fault(block, DIAG_E0256, item->span, "`%s` needs a pattern before it", property->word);
    }
    bool is_closed = type == PATTERN_MATERIAL_MAP || type == PATTERN_BUMP_MAP;
    if (pattern_info(type)->blocks || is_closed || (type == PATTERN_AVERAGE && has_values)) {
        return block_fault(block, DIAG_E0256, item->span, "`%s` cannot stand beside `%s`", property->word,
                           pattern_info(type)->word);
    }
    block_defaults(block->ev, kind, &record);
    ObjectState *objects = block->ev->objects;
    bool may_lack = objects->may_lack_weights;
    objects->may_lack_weights = type == PATTERN_AVERAGE;
    bool is_read = block_read(block->ev, item, kind, block->arena, &record, &is);
    objects->may_lack_weights = may_lack;
    if (!is_read) {
        return false;
    }
    PatternMap *map = arena_copy(block->arena, &record.map, sizeof record.map);
    if (!map) {
        return eval_no_memory(block->ev, item->span);
    }
    if (block->kind == KIND_NORMAL) {
        block->record->normal.slopes = kind == KIND_SLOPE_MAP ? map : NULL;
        map = kind == KIND_SLOPE_MAP ? NULL : map;
    }
    block->record->patterned.map = map;
    return true;
}

// The next texture of a material_map.
bool material_texture_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    ImageDesc *image = &block->record->image;
    EntryList list = {image->textures, image->texture_count, image->texture_room};
    PatternEntry entry = {.at = (double)list.count};
    Desc record;
    SchemaKind is;
    (void)property;
    block_defaults(block->ev, KIND_TEXTURE, &record);
    if (!block_read(block->ev, item, KIND_TEXTURE, block->arena, &record, &is) ||
        !keep_entry(block, KIND_TEXTURE, &record, item->span, &entry) ||
        !add_entry(block, &list, &entry, item->span)) {
        return false;
    }
    image->textures = list.items;
    image->texture_count = list.count;
    image->texture_room = list.capacity;
    return true;
}
