// Arrays: making them, with or without their elements, and finding and setting an element.
//
// Elements stand in one block, the last index running fastest; an element may be an array itself.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/run/run.h"

bool initialiser_fault(Eval *ev, Span span)
{
    ev->faulty = true;
    if (eval_report(ev, DIAG_E0223, span,
                    "no directive and no macro call can stand here, in the elements of an array")) {
        diag_suggest(ev->options.diags, "put it into parentheses if it is part of a number or vector, or declare the "
                                        "element before the array");
    }
    return false;
}

bool begins_with_call(const Eval *ev, const AstNode *node)
{
    while ((node->kind == AST_BINARY || node->kind == AST_MEMBER) && !(node->flags & AST_IN_PARENTHESES)) {
        node = node->a;
    }
    bool is_call = node->kind == AST_CALL && !(node->flags & AST_KNOWN) && !call_is_value(ev, node);
    return (is_call || node->kind == AST_INLINE) && !(node->flags & AST_IN_PARENTHESES);
}

static bool fill(Eval *ev, ValueArray *array, const AstNode *initialiser, unsigned dimension, size_t *at)
{
    if (initialiser->count != array->sizes[dimension]) {
        return eval_fault(ev, DIAG_E0215, initialiser->span, "%u values for an array of %u",
                          (unsigned)initialiser->count, (unsigned)array->sizes[dimension]);
    }
    bool is_last = dimension + 1 == array->dimension_count;
    for (const AstNode *part = initialiser->a; part != NULL; part = part->next) {
        bool is_row = part->kind == AST_INITIALISER;
        if (is_row == is_last) {
            return eval_fault(ev, DIAG_E0215, part->span, is_row ? "one value is expected here, not a row of values"
                                                                 : "a row of values in braces is expected here");
        }
        if (is_row) {
            if (!fill(ev, array, part, dimension + 1, at)) {
                return false;
            }
            continue;
        }
        Value value;
        if (begins_with_call(ev, part)) {
            return initialiser_fault(ev, part->span);
        }
        if (!eval_open_rvalue(ev, part, &value) ||
            !array_assign(ev, array, &array->elements[*at], &value, part->span)) {
            return false;
        }
        (*at)++;
    }
    return true;
}

static bool read_sizes(Eval *ev, const AstNode *node, ValueArray *array)
{
    array->count = 1;
    for (const AstNode *part = node->a; part != NULL; part = part->next) {
        double size;
        if (array->dimension_count == ARRAY_DIMENSIONS_MAX) {
            return eval_fault(ev, DIAG_E0306, part->span, "an array has at most %d dimensions", ARRAY_DIMENSIONS_MAX);
        }
        if (!eval_number(ev, part, &size)) {
            return false;
        }
        double whole = number_index(size);
        if (!(whole >= 1.0)) {
            return eval_fault(ev, DIAG_E0306, part->span, "the size of an array must be at least 1, not %g", size);
        }
        if (!(whole * (double)array->count <= (double)ARRAY_ELEMENTS_MAX)) {
            return eval_fault(ev, DIAG_E0306, part->span, "an array has at most %d elements", ARRAY_ELEMENTS_MAX);
        }
        array->sizes[array->dimension_count++] = (uint32_t)whole;
        array->count *= (size_t)whole;
    }
    return true;
}

bool array_create(Eval *ev, const AstNode *node, Value *value)
{
    ValueArray *array = arena_alloc(&ev->scratch, sizeof *array);
    if (array == NULL) {
        return eval_no_memory(ev, node->span);
    }
    *array = (ValueArray){.arena = &ev->scratch};
    if (!read_sizes(ev, node, array)) {
        return false;
    }
    array->elements = arena_alloc_array(&ev->scratch, array->count, sizeof *array->elements);
    if (array->elements == NULL) {
        return eval_no_memory(ev, node->span);
    }
    for (size_t i = 0; i < array->count; i++) {
        array->elements[i] = (Value){.kind = VALUE_NONE};
    }
    *value = (Value){.kind = VALUE_ARRAY, .array = array};
    size_t at = 0;
    if (node->b == NULL) {
        return true;
    }
    unsigned outer = ev->initialiser;
    ev->initialiser = ev->call_depth + 1;
    bool fine = fill(ev, array, node->b, 0, &at);
    ev->initialiser = outer;
    return fine;
}

// One index of a chain base[…][…]: turns the base into an offset within `array`, after `used` of its dimensions.
typedef struct Place {
    ValueArray *array;
    unsigned used;
    size_t offset;
} Place;

static bool begin_array(Eval *ev, const Value *value, Span span, Place *place)
{
    if (value->kind != VALUE_ARRAY) {
        return value->kind != VALUE_NONE &&
               eval_fault(ev, DIAG_E0202, span, "expected an array before `[`, found %s", value_describe(value));
    }
    *place = (Place){.array = value->array};
    return true;
}

static bool locate(Eval *ev, const AstNode *node, Place *place);

static bool locate_base(Eval *ev, const AstNode *base, Place *place)
{
    Value value;
    if (base->kind != AST_INDEX) {
        return eval_expression(ev, base, &value) && begin_array(ev, &value, base->span, place);
    }
    if (!locate(ev, base, place)) {
        return false;
    }
    if (place->used < place->array->dimension_count) {
        return true;
    }
    const Value *element = &place->array->elements[place->offset];
    if (element->kind == VALUE_NONE) {
        return eval_fault(ev, DIAG_E0207, base->span, "this element of the array has no value yet");
    }
    return begin_array(ev, element, base->span, place);
}

static bool locate(Eval *ev, const AstNode *node, Place *place)
{
    double index;
    if (!eval_deepen(ev, 1, node->span)) {
        return false;
    }
    ev->inner++;
    bool fine = locate_base(ev, node->a, place) && eval_number(ev, node->b, &index);
    ev->inner--;
    eval_shallow(ev, 1);
    if (!fine) {
        return false;
    }
    uint32_t size = place->array->sizes[place->used];
    double whole = number_index(index);
    if (!(whole >= 0.0 && whole < (double)size)) {
        return eval_fault(ev, DIAG_E0301, node->b->span, "index %g is outside 0 to %u", index, (unsigned)size - 1);
    }
    place->offset = place->offset * size + (size_t)whole;
    place->used++;
    return true;
}

bool array_locate(Eval *ev, const AstNode *node, Value **element, ValueArray **array)
{
    Place place;
    if (!locate(ev, node, &place)) {
        return false;
    }
    if (place.used < place.array->dimension_count) {
        return eval_fault(ev, DIAG_E0216, node->span, "this array has %u dimensions and needs as many indices, not %u",
                          place.array->dimension_count, place.used);
    }
    *array = place.array;
    *element = &place.array->elements[place.offset];
    return true;
}

bool name_is_declared(Eval *ev, const AstNode *target)
{
    if (target->kind == AST_NAME) {
        return scope_find(ev, target->symbol) != NULL;
    }
    Value *element;
    ValueArray *array;
    return target->kind == AST_INDEX && array_locate(ev, target, &element, &array) && element->kind != VALUE_NONE;
}
