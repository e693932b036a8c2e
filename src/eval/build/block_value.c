// The values of a block's properties: numbers, vectors, colours, lists and braces become the field that the schema
// names.
//
// What is no value of the property's type, not finite or out of its range is a located fault, or is put right with a
// warning, as the range says. Knows nothing of where in a block a property may stand.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/build/blocks.h"

Span block_here(Block *block)
{
    const AstNode *item = cursor_peek(&block->cursor);
    return item ? item->span : cursor_end(&block->cursor);
}

bool block_finite(Block *block, double number, Span span, const char *word)
{
    return isfinite(number) || block_fault(block, DIAG_E0340, span, "`%s` is not a finite number", word);
}

bool block_pair(Block *block, const char *what, double pair[2])
{
    Value value;
    const char *word = block_word(block);
    if (!cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, block_here(block), "`%s` needs a vector of 2 here: %s", word, what);
    }
    Span span = cursor_peek(&block->cursor)->span;
    if (!cursor_value(&block->cursor, &value)) {
        return false;
    }
    bool is_number = value.kind == VALUE_NUMBER;
    if (!is_number && !(value.kind == VALUE_VECTOR && value.components == 2)) {
        return block_fault(block, DIAG_E0202, span, "`%s` needs a vector of 2 here, not %s: %s", word,
                           value_describe(&value), what);
    }
    pair[0] = is_number ? value.number : value.v[0];
    pair[1] = is_number ? value.number : value.v[1];
    return (isfinite(pair[0]) && isfinite(pair[1])) ||
           block_fault(block, DIAG_E0340, span, "`%s` needs finite numbers here: %s", word, what);
}

static bool check_range(Block *block, const SchemaProperty *property, double *number, Span span)
{
    const SchemaRange *range = &property->range;
    bool is_low = range->low_is_open ? *number <= range->low : *number < range->low;
    if (range->policy == RANGE_ANY || (!is_low && *number <= range->high)) {
        return true;
    }
    double end = is_low ? range->low : range->high;
    const char *relation = is_low ? range->low_is_open ? "greater than" : "at least" : "at most";
    if (range->policy == RANGE_FAULT || (range->policy == RANGE_RAISE && !is_low)) {
        return block_fault(block, DIAG_E0341, span, "`%s` must be %s %g, not %g", property->word, relation, end,
                           *number);
    }
    eval_warn(block->ev, DIAG_W0341, span, "`%s` should be %s %g, not %g", property->word, relation, end, *number);
    *number = range->policy == RANGE_WARN ? *number : end;
    return true;
}

static bool read_number(Block *block, const SchemaProperty *property, double *number)
{
    Span span = block_here(block);
    if (!cursor_number(&block->cursor, number, &span)) {
        block->has_fault = true;
        return false;
    }
    return block_finite(block, *number, span, property->word) && check_range(block, property, number, span);
}

static bool read_vector(Block *block, const SchemaProperty *property, Vec3 *vector)
{
    Span span = block_here(block);
    if (!cursor_vector3(&block->cursor, vector, &span)) {
        block->has_fault = true;
        return false;
    }
    return vec3_is_finite(*vector) ||
           block_fault(block, DIAG_E0340, span, "`%s` has a coordinate that is not finite", property->word);
}

// Numbers are read one by one: no value holds them all.
static bool read_numbers(Block *block, const SchemaProperty *property, Numbers *numbers)
{
    const AstNode *item = cursor_peek(&block->cursor);
    if (item->kind != AST_VECTOR) {
        return block_fault(block, DIAG_E0253, item->span, "`%s` needs %s here: its %s", block_word(block),
                           schema_type_need(TYPE_NUMBERS), property->word);
    }
    double *to = arena_alloc_array(block->arena, item->count, sizeof *to);
    if (!to) {
        return eval_no_memory(block->ev, item->span);
    }
    *numbers = (Numbers){to, item->count};
    for (const AstNode *component = item->a; component; component = component->next) {
        Value value;
        if (!eval_expression(block->ev, component, &value) || !value_number(block->ev, &value, component->span, to)) {
            block->has_fault = true;
            return false;
        }
        if (!block_finite(block, *to++, component->span, property->word)) {
            return false;
        }
        if (!component->next && (component->flags & AST_BEFORE_COMMA)) {
            return block_fault(block, DIAG_E0259, component->span, "no comma may follow the last of the %s",
                               property->word);
        }
    }
    cursor_skip(&block->cursor);
    return true;
}

static bool read_colour(Block *block, const SchemaProperty *property, Rgbft *colour)
{
    Span span = block_here(block);
    if (!cursor_colour(&block->cursor, colour, &span)) {
        block->has_fault = true;
        return false;
    }
    double sum = colour->red + colour->green + colour->blue + colour->filter + colour->transmit;
    return block_finite(block, sum - sum, span, property->word);
}

bool block_at_expression(Block *block)
{
    const AstNode *item = cursor_peek(&block->cursor);
    return item && item->kind != AST_WORD && cursor_at_value(&block->cursor);
}

// Whether a number begins with a component of a vector, which POV-Ray does not look for where a number may be left out.
static bool begins_with_vector(const AstNode *item)
{
    while ((item->kind == AST_BINARY || item->kind == AST_UNARY) && !(item->flags & AST_IN_PARENTHESES)) {
        item = item->a;
    }
    return item->kind == AST_MEMBER && !(item->flags & AST_IN_PARENTHESES);
}

static bool needs_value(const SchemaProperty *property)
{
    return property->type != TYPE_FLAG && property->type != TYPE_SWITCH && property->type != TYPE_OPTIONAL_NUMBER;
}

static bool read_share(Block *block, const SchemaProperty *property, double *shares)
{
    if (!read_number(block, property, &shares[0])) {
        return false;
    }
    if (property->type == TYPE_SHARE_PAIR) {
        cursor_take_comma(&block->cursor);
    }
    bool has_second = property->type == TYPE_SHARE_PAIR && block_at_expression(block);
    if (property->type == TYPE_SHARE_PAIR && !has_second) {
        shares[1] = 0.0;
    }
    return !has_second || read_number(block, property, &shares[1]);
}

static bool read_switch(Block *block, const SchemaProperty *property, bool *flag)
{
    double truth = 1.0;
    if (property->type == TYPE_SWITCH && block_at_expression(block) && !read_number(block, property, &truth)) {
        return false;
    }
    *flag = truth != 0.0;
    return true;
}

static bool read_integer(Block *block, const SchemaProperty *property, int *integer)
{
    double number;
    if (!read_number(block, property, &number)) {
        return false;
    }
    *integer = (int)fmax(fmin(number, INT32_MAX), INT32_MIN);
    return true;
}

static bool read_rgb(Block *block, const SchemaProperty *property, Rgb *rgb_at)
{
    Rgbft colour;
    if (!read_colour(block, property, &colour)) {
        return false;
    }
    *rgb_at = rgbft_rgb(colour);
    return true;
}

bool block_read_typed(Block *block, const SchemaProperty *property, void *at)
{
    switch (property->type) {
    case TYPE_FLAG:
    case TYPE_SWITCH:
        return read_switch(block, property, at);
    case TYPE_OPTIONAL_NUMBER:
        if (!block_at_expression(block)) {
            memcpy(at, &property->bare, sizeof property->bare);
            return true;
        }
        if (begins_with_vector(cursor_peek(&block->cursor))) {
            return block_fault(block, DIAG_E0253, cursor_peek(&block->cursor)->span,
                               "the number of `%s` may not begin with a vector; put it into parentheses",
                               property->word);
        }
        return read_number(block, property, at);
    case TYPE_NUMBER:
        return read_number(block, property, at);
    case TYPE_SHARE:
    case TYPE_SHARE_PAIR:
        return read_share(block, property, at);
    case TYPE_INTEGER:
        return read_integer(block, property, at);
    case TYPE_VECTOR:
        return read_vector(block, property, at);
    case TYPE_NUMBERS:
        return read_numbers(block, property, at);
    case TYPE_COLOUR:
        return read_colour(block, property, at);
    case TYPE_RGB:
        return read_rgb(block, property, at);
    case TYPE_BLOCK:
    case TYPE_ACTION:
        break; // never read by type
    }
    return false;
}

bool block_value(Block *block, const SchemaProperty *property, Span word)
{
    bool is_share = property->type == TYPE_SHARE || property->type == TYPE_SHARE_PAIR;
    bool is_given = !is_share;
    if (is_share && cursor_at_word(&block->cursor, W_albedo)) {
        cursor_skip(&block->cursor);
        is_given = true;
    }
    bool takes_colour = property->type == TYPE_COLOUR || property->type == TYPE_RGB;
    if (needs_value(property) && !(takes_colour ? cursor_at_value(&block->cursor) : block_at_expression(block))) {
        return block_fault(block, DIAG_E0253, word, "`%s` needs %s after it", property->word,
                           schema_type_need(property->type));
    }
    if (is_given && property->given) {
        *((bool *)block->record + property->given) = true;
    }
    return block_read_typed(block, property, (char *)block->record + property->at);
}
