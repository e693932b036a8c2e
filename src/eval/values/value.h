// Values of the language, and their conversions.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_VALUES_VALUE_H
#define EVAL_VALUES_VALUE_H

#include "eval/state/state.h"

typedef enum ValueKind {
    VALUE_NONE,  // an uninitialised array element, or the result of a fault that has been reported
    VALUE_UNSET, // what a name stands for while its first value is computed
    VALUE_NUMBER,
    VALUE_VECTOR, // 2 to 5 components
    VALUE_COLOUR, // red, green, blue, filter, transmit
    VALUE_STRING,
    VALUE_ARRAY,
    VALUE_MACRO,
    VALUE_FUNCTION,
    VALUE_SPLINE,
    VALUE_FILE,  // the name of a file that is open
    VALUE_BLOCK, // a declared texture, sphere, camera, …: an immutable struct of its kind
} ValueKind;

typedef struct Macro Macro;           // run/run.h
typedef struct Function Function;     // function.h
typedef struct Spline Spline;

struct Value {
    uint8_t kind;       // ValueKind
    uint8_t components; // of a vector
    union {
        uint16_t block; // VALUE_BLOCK: its SchemaKind
        struct {
            uint8_t kept; // so many of `v` hold what a vector had whose component this is, or began with; 0: none
            bool is_scaled : 1; // a number times a vector, see operators.c
            bool is_closed : 1; // parentheses stand around it, or around the number that a number begins with
            bool has_third : 1; // a vector of 2: v[4] is its third component where a vector of 3 is wanted
        };
    };
    Symbol name;        // the identifier it was read from, for messages; SYMBOL_NONE
    union {
        double number;
        double v[5];
        struct {
            const char *text;
            size_t length;
        };
        ValueArray *array;
        Macro *macro;
        const Function *function;
        const Spline *spline;
        struct {
            DataFile *file;       // for reading, or NULL
            WrittenFile *written; // for writing, or NULL
        };
        struct {
            const void *record; // of schema_kind(block)->size bytes, in the scene arena
            const struct UnsupportedDesc *lacks; // what it was read without
        };
    };
};

enum { ARRAY_DIMENSIONS_MAX = 5, ARRAY_ELEMENTS_MAX = 1 << 28 };

// All elements are of one kind, that of the first one that was set.
struct ValueArray {
    unsigned dimension_count;
    uint32_t sizes[ARRAY_DIMENSIONS_MAX];
    size_t count; // the product of the sizes
    Value *elements;
    Arena *arena; // where the elements keep texts and arrays; NULL: they own them (kept.h)
    unsigned reference_count; // parameters of macros that stand for elements
    Value first; // what was set first, for its kind; VALUE_NONE: none ever was
};

// "a number", "a vector of 3", "a colour", "a string", "an array", "a macro", "a texture"
const char *value_describe(const Value *value);

// Conversions with the language's promotions; on failure they report "expected …, found …" at the span. A value of
// VALUE_NONE has been reported already and fails quietly.
bool value_number(Eval *ev, const Value *value, Span span, double *number) RT_MUST_CHECK;
// The components, and behind them what a vector leaves there that the expression began with, then 0; how many.
unsigned value_components(const Value *value, double v[5]);
bool value_vector3(Eval *ev, const Value *value, Span span, Vec3 *vector) RT_MUST_CHECK;
bool value_colour(Eval *ev, const Value *value, Span span, Rgbft *colour) RT_MUST_CHECK;
bool value_string(Eval *ev, const Value *value, Span span) RT_MUST_CHECK;
bool value_array(Eval *ev, const Value *value, Span span) RT_MUST_CHECK;

static inline Value value_of_number(double number)
{
    return (Value){.kind = VALUE_NUMBER, .number = number};
}

static inline void value_set_number(Value *value, double number)
{
    value->kind = VALUE_NUMBER;
    value->components = 0;
    value->block = 0;
    value->name = SYMBOL_NONE;
    value->number = number;
}

static inline bool value_is_tuple(const Value *value)
{
    return value->kind == VALUE_VECTOR || value->kind == VALUE_COLOUR;
}

// A copy that lives as long as the arena: colours in single precision, texts and arrays copied. Without an arena it
// owns its texts and arrays (kept.h).
bool value_store(Eval *ev, const Value *value, Arena *arena, Span span, Value *copy) RT_MUST_CHECK;

#endif
