// What the files of this room make of values: operators, numbers, arrays, built-in functions.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_VALUES_VALUES_H
#define EVAL_VALUES_VALUES_H

#include <math.h>

#include "base/number.h"
#include "eval/values/value.h"

// ---- what is asked of the text that a value stands in

static inline bool ask_expression(Eval *ev, const AstNode *node, Value *value)
{
    return ev->text->expression(ev, node, value);
}

static inline bool ask_number(Eval *ev, const AstNode *node, double *number)
{
    return ev->text->number(ev, node, number);
}

static inline bool ask_vector3(Eval *ev, const AstNode *node, Vec3 *vector)
{
    return ev->text->vector3(ev, node, vector);
}

static inline bool ask_string(Eval *ev, const AstNode *node, Value *value)
{
    return ev->text->string(ev, node, value);
}

// ---- operators and numbers

// The nodes of operators.
bool operator_unary(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool operator_binary(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool operator_conditional(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;

// As the language compares: numbers that differ by 1e-10 or less are equal, and such a number is false.
bool numbers_equal(double one, double other);
// A #case of a #switch: the same, but for what is infinite or not a number, which no case holds for.
bool number_is_case(double subject, double number);
// The whole number that an index or a size of an array means, as measured: whatever is less than 1e-10 below one is that
// one. Not a number, and what is out of range, stays so.
static inline double number_index(double number)
{
    return floor(number + 1e-10);
}
bool number_is_true(double number);

// Warns when a result is not finite; called where all that it is made of is.
void number_fault(Eval *ev, double number, Span span);
static inline void number_check(Eval *ev, double number, Span span)
{
    if (RT_UNLIKELY(!(number - number == 0.0))) {
        number_fault(ev, number, span);
    }
}

enum { EPOCH_2000 = 946684800 };     // seconds from 1970 to the first moment of the year 2000, universal time
double number_gray(const double v[3]);

// The place of a component in a tuple of `width` components, COMPONENT_GRAY for `gray`; false when it has none.
enum { COMPONENT_GRAY = 5, COMPONENT_HEIGHT = 6 }; // the last one: `hf`, in the body of a function
bool value_component(Symbol name, unsigned width, unsigned *component);

// ---- arrays

bool array_takes(Eval *ev, const ValueArray *array, const Value *element, const Value *value, Span span) RT_MUST_CHECK;
bool array_assign(Eval *ev, ValueArray *array, Value *element, const Value *value, Span span) RT_MUST_CHECK;

// ---- built-in functions and constants

// The tables of noise, made by the first call; NULL when a fault was reported.
const Noise *eval_noise(Eval *ev, Span span);
// That of the scene's settings so far.
NoiseGenerator eval_noise_generator(const Eval *ev);
// The function of a word that takes one number and has a value at each; NULL: it is none.
typedef double (*NumberFn)(double number);
NumberFn builtin_of_number(Symbol word);
// The generator of POV-Ray, as measured: state' = state * 1812433253 + 12345 modulo 2^32, value = state' / (2^32 - 1).
static inline double random_next(uint32_t *state)
{
    *state = *state * 1812433253u + 12345u;
    return *state / 4294967295.0;
}

bool builtin_call(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_constant(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
// Functions of strings, entries of the table in builtins.c.
typedef bool (*BuiltinFn)(Eval *ev, const AstNode *node, Value *value);
bool builtin_str(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_vstr(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_concat(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_chr(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_asc(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_val(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_strlen(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_strcmp(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_substr(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_strupr(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_strlwr(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_datetime(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;

#endif
