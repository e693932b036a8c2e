// Calls of functions and splines inside expressions.
//
// Turns a CALL node whose name stands for a function or a spline into its value. Owns nothing. Knows nothing of how
// they are made.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/run/callable.h"

const Value *call_callee(Eval *ev, const AstNode *call)
{
    Value *element;
    ValueArray *array;
    if (call->b == NULL) {
        return scope_find(ev, call->symbol);
    }
    if (call->b->flags & AST_KNOWN) {
        return call->b->known;
    }
    return array_locate(ev, call->b, &element, &array) ? element : NULL;
}

bool call_is_of_element(const AstNode *call)
{
    return call->b != NULL && call->b->kind == AST_INDEX;
}

bool call_is_value(const Eval *ev, const AstNode *call)
{
    if (call_is_of_element(call)) {
        return true;
    }
    const Value *callee = call->b == NULL ? scope_find(ev, call->symbol) : call->b->known;
    return callee != NULL && (callee->kind == VALUE_FUNCTION || callee->kind == VALUE_SPLINE);
}

// With its quotes; an element has no name.
#define QUOTE(call) (call_is_of_element(call) ? "" : "`")

static const char *name_of(const Eval *ev, const AstNode *call)
{
    return call_is_of_element(call) ? "this element" : eval_text(ev, call->symbol);
}

void call_fault_callee(Eval *ev, const AstNode *call, const Value *callee)
{
    if (callee == NULL) {
        (void)name_fault_undeclared(ev, call, "the macro");
    } else if (callee->kind != VALUE_NONE) {
        eval_fault(ev, DIAG_E0208, call->span, "`%s` is %s and cannot be called", eval_text(ev, call->symbol),
                   value_describe(callee));
    }
}

bool call_fault_count(Eval *ev, const AstNode *call, const char *what, unsigned wanted)
{
    return eval_fault(ev, DIAG_E0203, call->span, "the %s %s%s%s takes %u argument%s, and %u %s given", what,
                      QUOTE(call), name_of(ev, call), QUOTE(call), wanted, wanted == 1 ? "" : "s",
                      (unsigned)call->count, call->count == 1 ? "is" : "are");
}

// Reports the use of a function that is not supported; returns false.
static bool function_fault_unsupported(Eval *ev, const Function *function, const AstNode *call)
{
    if (eval_report(ev, DIAG_E0210, call->span, "%s%s%s is a function of `%s`, which is not supported",
                    QUOTE(call), name_of(ev, call), QUOTE(call), function->word)) {
        diag_note(ev->options.diags, function->span, "it stands here");
    }
    return false;
}

// A macro may be called with a comma at the end, a function or spline not.
bool call_ends_well(Eval *ev, const AstNode *call)
{
    for (const AstNode *argument = call->a; argument != NULL; argument = argument->next) {
        if (argument->flags & AST_BEFORE_COMMA) {
            return eval_fault(ev, DIAG_E0203, argument->span, "an argument is missing after the last comma");
        }
    }
    return true;
}

static void give(Value *value, unsigned components, const double v[5])
{
    *value = (Value){.kind = components == 1 ? VALUE_NUMBER : VALUE_VECTOR,
                     .components = (uint8_t)(components == 1 ? 0 : components)};
    if (components == 1) {
        value->number = v[0];
    } else {
        memcpy(value->v, v, 5 * sizeof *v);
    }
}

static bool call_function(Eval *ev, const AstNode *call, const Function *function, Value *value)
{
    double arguments[FUNCTION_SLOTS_MAX] = {0}, v[5] = {0};
    if (function->kind == FUNCTION_UNSUPPORTED) {
        return function_fault_unsupported(ev, function, call);
    }
    if (call->count != function->parameter_count) {
        return call_fault_count(ev, call, "function", function->parameter_count);
    }
    bool fine = true, is_finite = true;
    unsigned count = 0;
    for (const AstNode *node = call->a; node != NULL; node = node->next) {
        arguments[count] = 0.0;
        fine = eval_number(ev, node, &arguments[count]) && fine;
        is_finite = is_finite && isfinite(arguments[count]);
        count++;
    }
    unsigned components = fine ? function_apply(ev, function, arguments, call->span, v) : 0;
    give(value, components, v);
    if (components == 1 && is_finite) {
        number_check(ev, v[0], call->span);
    }
    return components > 0;
}

static bool call_spline(Eval *ev, const AstNode *call, const Spline *spline, Value *value)
{
    double t, v[5];
    SplineType type = spline->type;
    const AstNode *word = call->a != NULL ? call->a->next : NULL;
    if (call->count < 1 || call->count > 2) {
        return call_fault_count(ev, call, "spline", 1);
    }
    if (word != NULL && (word->kind != AST_WORD || !spline_type((Word)word->symbol, &type))) {
        return eval_fault(ev, DIAG_E0263, word->span,
                          "expected `linear_spline`, `quadratic_spline`, `cubic_spline` or `natural_spline`");
    }
    if (!eval_number(ev, call->a, &t)) {
        return false;
    }
    spline_at(spline, type, t, v);
    give(value, spline->components, v);
    return true;
}

bool call_value(Eval *ev, const AstNode *call, Value *value)
{
    const Value *callee = call_callee(ev, call);
    if (callee == NULL || !eval_deepen(ev, 1, call->span)) {
        return false;
    }
    bool fine = false;
    ev->inner++;
    if (!call_ends_well(ev, call)) {
        fine = false;
    } else if (callee->kind == VALUE_FUNCTION) {
        fine = call_function(ev, call, callee->function, value);
    } else if (callee->kind == VALUE_SPLINE) {
        fine = call_spline(ev, call, callee->spline, value);
    } else if (callee->kind == VALUE_NONE) {
        eval_fault(ev, DIAG_E0207, call_is_of_element(call) ? call->b->span : call->span,
                   "this element of the array has no value yet");
    } else if (eval_report(ev, DIAG_E0208, call->span, "%s%s%s is %s and cannot be called", QUOTE(call),
                           name_of(ev, call), QUOTE(call), value_describe(callee))) {
        diag_suggest(ev->options.diags, "put a comma before the parenthesis if it begins another value");
    }
    ev->inner--;
    eval_shallow(ev, 1);
    return fine;
}
