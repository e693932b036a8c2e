// Values: what they are called in messages, how they convert where a number, a vector or a colour is wanted, and how
// they are kept.
//
// Turns a Value of one kind into another with the language's promotions. Owns nothing. Knows nothing of syntax.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "eval/values/kept.h"
#include "eval/values/values.h"
#include "scene/schema.h"

const char *value_describe(const Value *value)
{
    static const char *const tuples[] = {"", "", "a vector of 2", "a vector of 3", "a vector of 4", "a vector of 5"};
    switch ((ValueKind)value->kind) {
    case VALUE_NONE: return "nothing";
    case VALUE_UNSET: return "a name without a value";
    case VALUE_NUMBER: return "a number";
    case VALUE_VECTOR: return tuples[value->components];
    case VALUE_COLOUR: return "a colour";
    case VALUE_STRING: return "a string";
    case VALUE_ARRAY: return "an array";
    case VALUE_MACRO: return "a macro";
    case VALUE_FUNCTION: return "a function";
    case VALUE_SPLINE: return "a spline";
    case VALUE_FILE: return "an open file";
    case VALUE_BLOCK: return schema_kind((SchemaKind)value->block)->what;
    }
    return "nothing";
}

static bool fault_expected(Eval *ev, const Value *value, Span span, const char *wanted)
{
    if (value->kind == VALUE_NONE) {
        return false;
    }
    return eval_fault(ev, DIAG_E0202, span, "expected %s, found %s", wanted, value_describe(value));
}

bool value_number(Eval *ev, const Value *value, Span span, double *number)
{
    if (RT_UNLIKELY(value->kind != VALUE_NUMBER)) {
        return fault_expected(ev, value, span, "a number");
    }
    *number = value->number;
    return true;
}

unsigned value_components(const Value *value, double v[5])
{
    unsigned own = value->kind == VALUE_NUMBER ? 1 : value->components, count = value->kept > own ? value->kept : own;
    for (unsigned i = 0; i < 5; i++) {
        v[i] = i < count ? value->v[i] : 0.0;
    }
    return count;
}

bool value_vector3(Eval *ev, const Value *value, Span span, Vec3 *vector)
{
    if (value->kind != VALUE_NUMBER && (value->kind != VALUE_VECTOR || value->components > 3)) {
        return fault_expected(ev, value, span, "a vector of 3");
    }
    double v[5];
    (void)value_components(value, v);
    bool is_filled = value->is_closed || value->has_third || value->kept == 0;
    if (value->kind == VALUE_NUMBER && is_filled) {
        *vector = vec3(v[0], v[0], v[0]);
    } else {
        bool is_short = value->components == 2 && is_filled;
        *vector = vec3(v[0], v[1], !is_short ? v[2] : value->has_third ? value->v[4] : 0.0);
    }
    return true;
}

// Colours are kept in single precision, as POV-Ray keeps them.
bool value_colour(Eval *ev, const Value *value, Span span, Rgbft *colour)
{
    double v[5] = {0};
    if (value->kind == VALUE_NUMBER) {
        for (unsigned i = 0; i < 5; i++) {
            v[i] = value->number;
        }
    } else if (value_is_tuple(value)) {
        memcpy(v, value->v, value->components * sizeof *v);
    } else {
        return fault_expected(ev, value, span, "a colour");
    }
    *colour = (Rgbft){(float)v[0], (float)v[1], (float)v[2], (float)v[3], (float)v[4]};
    return true;
}

bool value_string(Eval *ev, const Value *value, Span span)
{
    return value->kind == VALUE_STRING || fault_expected(ev, value, span, "a string");
}

bool value_array(Eval *ev, const Value *value, Span span)
{
    return value->kind == VALUE_ARRAY || fault_expected(ev, value, span, "an array");
}

static char *store_text(Eval *ev, const Value *value, Arena *arena)
{
    if (arena != NULL) {
        return arena_copy_text(arena, value->text, value->length);
    }
    char *copy = value->length < SIZE_MAX ? kept_take(ev, value->length + 1, false) : NULL;
    if (copy != NULL) {
        memcpy(copy, value->text, value->length);
        copy[value->length] = '\0';
    }
    return copy;
}

static bool store_array(Eval *ev, const ValueArray *array, Arena *arena, Span span, Value *copy)
{
    if (!eval_work(ev, array->count * sizeof *array->elements, span)) {
        return false;
    }
    size_t size = sizeof *array + array->count * sizeof *array->elements; // of at most ARRAY_ELEMENTS_MAX
    ValueArray *kept = arena != NULL ? arena_alloc(arena, size) : kept_take(ev, size, true);
    if (kept == NULL) {
        return eval_no_memory(ev, span);
    }
    *kept = *array;
    Value *elements = (Value *)(kept + 1);
    kept->elements = elements;
    kept->arena = arena;
    kept->reference_count = 0;
    for (size_t i = 0; i < array->count; i++) {
        if (!value_store(ev, &array->elements[i], arena, span, &elements[i])) {
            return false;
        }
    }
    copy->array = kept;
    return true;
}

bool value_store(Eval *ev, const Value *value, Arena *arena, Span span, Value *copy)
{
    *copy = *value;
    copy->name = SYMBOL_NONE;
    copy->block = value->kind == VALUE_BLOCK ? value->block : 0;
    if (value->kind == VALUE_COLOUR || (value->kind == VALUE_VECTOR && value->components == 5)) {
        copy->kind = VALUE_COLOUR;
        for (unsigned i = 0; i < 5; i++) {
            copy->v[i] = (float)value->v[i];
        }
    } else if (value->kind == VALUE_STRING) {
        if (!eval_work(ev, value->length, span)) {
            return false;
        }
        copy->text = store_text(ev, value, arena);
        if (copy->text == NULL) {
            return eval_no_memory(ev, span);
        }
    } else if (value->kind == VALUE_ARRAY) {
        // Arrays of arrays nest as deep as the scene makes them.
        if (!eval_deepen(ev, 1, span)) {
            return false;
        }
        bool fine = store_array(ev, value->array, arena, span, copy);
        eval_shallow(ev, 1);
        return fine;
    }
    return true;
}

// ---- elements of arrays

// Objects are of one type, whatever their shapes; of what is not supported nobody knows.
static bool same_block(const Value *one, const Value *other)
{
    bool are_objects =
        schema_kind((SchemaKind)one->block)->is_object && schema_kind((SchemaKind)other->block)->is_object;
    return one->block == other->block || are_objects || one->block == KIND_UNSUPPORTED ||
           other->block == KIND_UNSUPPORTED;
}

static bool same_type(const Value *one, const Value *other)
{
    return one->kind == other->kind && one->components == other->components &&
           (one->kind != VALUE_BLOCK || same_block(one, other));
}

bool array_takes(Eval *ev, const ValueArray *array, const Value *element, const Value *value, Span span)
{
    const Value *other = &array->first;
    if (element->kind == VALUE_FUNCTION) {
        return eval_fault(ev, DIAG_E0262, span, "this element is a function, which cannot be declared again");
    }
    return other->kind == VALUE_NONE || same_type(other, value) ||
           eval_fault(ev, DIAG_E0215, span, "the elements of this array are each %s, not %s", value_describe(other),
                      value_describe(value));
}

bool array_assign(Eval *ev, ValueArray *array, Value *element, const Value *value, Span span)
{
    Value kept;
    bool is_owner = array->arena == NULL;
    if (!value_store(ev, value, array->arena, span, &kept)) {
        return false;
    }
    if (!array_takes(ev, array, element, &kept, span)) {
        if (is_owner && kept_is_owned(&kept)) {
            kept_give_back(ev, &kept);
        }
        return false;
    }
    if (is_owner) {
        kept_replace(ev, element, &kept);
    } else {
        *element = kept;
    }
    if (array->first.kind == VALUE_NONE || (kept.kind == VALUE_BLOCK && kept.block != KIND_UNSUPPORTED)) {
        array->first = kept;
    }
    return true;
}

// ---- components

static const struct {
    Word word;
    unsigned component;
} members[] = {
    {W_x, 0}, {W_y, 1}, {W_z, 2}, {W_t, 3}, {W_u, 0}, {W_v, 1},
    {W_red, 0}, {W_green, 1}, {W_blue, 2}, {W_filter, 3}, {W_transmit, 4},
};

double number_gray(const double v[3])
{
    // The weights of POV-Ray's manual, 2.2.1.4.4 "Vector Expressions".
    return 0.297 * v[0] + 0.589 * v[1] + 0.114 * v[2];
}

bool value_component(Symbol name, unsigned width, unsigned *component)
{
    if (name == W_gray && width >= 2) {
        *component = COMPONENT_GRAY;
        return true;
    }
    for (size_t i = 0; i < RT_COUNT_OF(members); i++) {
        if (members[i].word == (Word)name && members[i].component < width) {
            *component = members[i].component;
            return true;
        }
    }
    return false;
}
