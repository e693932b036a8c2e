// The pattern `slope`: how a surface faces a direction or a point, and how high it lies.
//
// Turns a vector, or what stands in braces behind the word, into the numbers of a Pattern. Knows nothing of surfaces.
//
// SPDX-License-Identifier: MIT
#include "eval/build/blocks.h"

static bool read_number(Block *block, const char *word, size_t at, Span span)
{
    const SchemaProperty number = {word, TYPE_NUMBER, ACTION_NONE, .at = (uint16_t)at};
    return block_value(block, &number, span);
}

// A vector, and the two numbers that may follow it.
static bool read_range(Block *block, const char *word, size_t vector_at, size_t low_at, size_t high_at, Span span)
{
    const SchemaProperty vector = {word, TYPE_VECTOR, ACTION_NONE, .at = (uint16_t)vector_at};
    if (!block_value(block, &vector, span)) {
        return false;
    }
    cursor_take_comma(&block->cursor);
    if (!block_at_expression(block)) {
        return true;
    }
    if (!read_number(block, word, low_at, span)) {
        return false;
    }
    cursor_take_comma(&block->cursor);
    return !block_at_expression(block) || read_number(block, word, high_at, span);
}

bool slope_item_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    SlopeDesc *slope = &block->record->slope;
    if (item->symbol == W_altitude) {
        return !slope->is_point && block->arguments > 0
                   ? read_range(block, property->word, offsetof(SlopeDesc, altitude), offsetof(SlopeDesc, low_altitude),
                                offsetof(SlopeDesc, high_altitude), item->span)
                   : block_fault(block, DIAG_E0256, item->span, "`altitude` can stand only behind a direction");
    }
    if (block->arguments > 0 || slope->is_point) {
        return block_fault(block, DIAG_E0256, item->span, "`slope` takes a direction or a point, not both");
    }
    slope->is_point = true;
    return read_range(block, property->word, offsetof(SlopeDesc, direction), offsetof(SlopeDesc, low),
                      offsetof(SlopeDesc, high), item->span);
}

static bool has_direction(Block *block, Vec3 direction, Span span)
{
    return vec3_length_squared(direction) > 0.0 ||
           block_fault(block, DIAG_E0342, span, "the direction of a slope cannot be <0, 0, 0>");
}

bool slope_close(Block *block)
{
    const SlopeDesc *slope = &block->record->slope;
    if (block->arguments == 0 && !slope->is_point) {
        return block->has_unsupported ||
               block_fault(block, DIAG_E0253, block->node->span, "`slope` needs a direction or `point_at`");
    }
    return slope->is_point || has_direction(block, slope->direction, block->node->span);
}

static bool read_braces(Block *block, const AstNode *item, SlopeDesc *slope)
{
    Desc record;
    SchemaKind is;
    block_defaults(block->ev, KIND_SLOPE, &record);
    if (!block_read(block->ev, item, KIND_SLOPE, block->arena, &record, &is)) {
        return false;
    }
    *slope = record.slope;
    return true;
}

bool slope_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    const SchemaProperty direction = {property->word, TYPE_VECTOR, ACTION_NONE,
                                      .at = offsetof(PatternPart, pattern.vector)};
    Pattern *pattern = &block->record->patterned.pattern;
    SlopeDesc slope = {.is_point = false};
    if (!pattern_may_begin(block, property, item) || !pattern_begin(block, PATTERN_SLOPE, item) ||
        (item->kind == AST_BLOCK && !read_braces(block, item, &slope))) {
        return false;
    }
    pattern->vector = slope.direction;
    if (item->kind != AST_BLOCK &&
        !(block_value(block, &direction, item->span) && has_direction(block, pattern->vector, item->span))) {
        return false;
    }
    pattern->form = slope.altitude;
    pattern->flags |= slope.is_point ? PATTERN_TO_POINT : 0;
    pattern->metric = slope.low;
    pattern->offset = slope.high;
    pattern->exterior_factor = slope.low_altitude;
    pattern->interior_factor = slope.high_altitude;
    return pattern_read_amount(block);
}
