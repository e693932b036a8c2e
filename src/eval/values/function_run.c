// What the nodes of a function's body compute.
//
// Turns a compiled body and its arguments into a number. As in POV-Ray nothing is checked inside a body: the functions
// are those of C, comparisons are exact, and a number that is not finite is passed on. Owns nothing. Knows nothing of
// syntax.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/values/function.h"

static double value_of(const FunctionNode *node, FunctionRun *run)
{
    return node->run(node, run);
}

double function_run_number(const FunctionNode *node, FunctionRun *run)
{
    (void)run;
    return node->number;
}

double function_run_slot(const FunctionNode *node, FunctionRun *run)
{
    return run->slots[node->slot];
}

static double run_of_one(const FunctionNode *node, FunctionRun *run)
{
    return node->of_one(value_of(node->arguments, run));
}

static double run_of_two(const FunctionNode *node, FunctionRun *run)
{
    double first = value_of(node->arguments, run);
    return node->of_two(first, value_of(node->arguments->next, run));
}

// ---- operators

#define BINARY(name, expression)                                                                                       \
    static double run_##name(const FunctionNode *node, FunctionRun *run)                                               \
    {                                                                                                                  \
        double a = value_of(node->arguments, run), b = value_of(node->arguments->next, run);                          \
        return expression;                                                                                             \
    }

BINARY(add, a + b)
BINARY(sub, a - b)
BINARY(mul, a * b)
BINARY(div, a / b)
BINARY(eq, a == b)
BINARY(ne, a != b)
BINARY(lt, a < b)
BINARY(le, a <= b)
BINARY(gt, a > b)
BINARY(ge, a >= b)
BINARY(and, a != 0.0 && b != 0.0)
BINARY(or, a != 0.0 || b != 0.0)

static double run_neg(const FunctionNode *node, FunctionRun *run)
{
    return -value_of(node->arguments, run);
}

static double run_plus(const FunctionNode *node, FunctionRun *run)
{
    return value_of(node->arguments, run);
}

FunctionNodeFn function_operator(AstOp op)
{
    static const FunctionNodeFn operators[AST_OP_COUNT] = {
        [AST_OP_ADD] = run_add, [AST_OP_SUB] = run_sub, [AST_OP_MUL] = run_mul, [AST_OP_DIV] = run_div,
        [AST_OP_EQ] = run_eq,   [AST_OP_NE] = run_ne,   [AST_OP_LT] = run_lt,   [AST_OP_LE] = run_le,
        [AST_OP_GT] = run_gt,   [AST_OP_GE] = run_ge,   [AST_OP_AND] = run_and, [AST_OP_OR] = run_or,
        [AST_OP_NEG] = run_neg, [AST_OP_PLUS] = run_plus,
    };
    return operators[op];
}

// ---- built-in functions

static double whole_quotient(double one, double other)
{
    return number_to_int(one / other);
}

static double run_extreme(const FunctionNode *node, FunctionRun *run)
{
    double best = value_of(node->arguments, run);
    for (const FunctionNode *argument = node->arguments->next; argument != NULL; argument = argument->next) {
        double number = value_of(argument, run);
        bool is_new = node->slot == W_max ? number > best : !(best <= number); // as POV-Ray, where one is no number, too
        best = is_new ? number : best;
    }
    return best;
}

// All arguments are computed, as in POV-Ray.
static double run_select(const FunctionNode *node, FunctionRun *run)
{
    double a[4] = {0};
    unsigned count = 0;
    for (const FunctionNode *argument = node->arguments; argument != NULL; argument = argument->next) {
        a[count++] = value_of(argument, run);
    }
    return a[0] < 0.0 ? a[1] : count == 3 || a[0] == 0.0 ? a[2] : a[3];
}

static double run_sequence(const FunctionNode *node, FunctionRun *run, double result)
{
    const FunctionNode *end = node->arguments->next, *term = end->next;
    double number = value_of(node->arguments, run), last = value_of(end, run);
    for (; number <= last; number += 1.0) {
        if (!eval_step(run->ev, run->span)) {
            return result;
        }
        run->slots[node->slot] = number;
        double part = value_of(term, run);
        result = node->run == function_run_sum ? result + part : result * part;
    }
    return result;
}

double function_run_sum(const FunctionNode *node, FunctionRun *run)
{
    return run_sequence(node, run, 0.0);
}

double function_run_product(const FunctionNode *node, FunctionRun *run)
{
    return run_sequence(node, run, 1.0);
}

typedef struct BodyBuiltin {
    double (*of_one)(double);
    double (*of_two)(double, double);
    FunctionNodeFn run;
    uint8_t least, greatest;
} BodyBuiltin;

#define OF_ONE(function) {.of_one = function, .least = 1, .greatest = 1}
#define OF_TWO(function) {.of_two = function, .least = 2, .greatest = 2}

bool function_builtin(Word word, FunctionNode *node, unsigned *least, unsigned *greatest)
{
    static const BodyBuiltin table[WORD_COUNT] = {
        [W_abs] = OF_ONE(fabs),     [W_sin] = OF_ONE(sin),     [W_cos] = OF_ONE(cos),     [W_tan] = OF_ONE(tan),
        [W_asin] = OF_ONE(asin),    [W_acos] = OF_ONE(acos),   [W_atan] = OF_ONE(atan),   [W_sinh] = OF_ONE(sinh),
        [W_cosh] = OF_ONE(cosh),    [W_tanh] = OF_ONE(tanh),   [W_asinh] = OF_ONE(asinh), [W_acosh] = OF_ONE(acosh),
        [W_atanh] = OF_ONE(atanh),  [W_exp] = OF_ONE(exp),     [W_ln] = OF_ONE(log),      [W_log] = OF_ONE(log10),
        [W_sqrt] = OF_ONE(sqrt),    [W_floor] = OF_ONE(floor), [W_ceil] = OF_ONE(ceil),
        [W_int] = OF_ONE(number_to_int),
        [W_degrees] = OF_ONE(number_degrees), [W_radians] = OF_ONE(number_radians),
        [W_atan2] = OF_TWO(atan2),  [W_pow] = OF_TWO(pow),     [W_mod] = OF_TWO(fmod),
        [W_div] = OF_TWO(whole_quotient),
        [W_min] = {.run = run_extreme, .least = 2, .greatest = UINT8_MAX},
        [W_max] = {.run = run_extreme, .least = 2, .greatest = UINT8_MAX},
        [W_select] = {.run = run_select, .least = 3, .greatest = 4},
    };
    const BodyBuiltin *entry = &table[word];
    if (entry->greatest == 0) {
        return false;
    }
    *least = entry->least;
    *greatest = entry->greatest;
    node->slot = word;
    if (entry->of_one != NULL) {
        node->run = run_of_one;
        node->of_one = entry->of_one;
    } else if (entry->of_two != NULL) {
        node->run = run_of_two;
        node->of_two = entry->of_two;
    } else {
        node->run = entry->run;
    }
    return true;
}

// ---- calls

unsigned function_width(const Function *function)
{
    switch (function->kind) {
    case FUNCTION_SPLINE: return function->spline->components;
    case FUNCTION_TRANSFORM: return 3;
    case FUNCTION_PIGMENT: return 5;
    case FUNCTION_NUMBER:
    case FUNCTION_PATTERN:
    case FUNCTION_UNSUPPORTED: break;
    }
    return 1;
}

static bool run_body(Eval *ev, const Function *function, const double *arguments, Span span, double *number)
{
    FunctionRun run;
    enum { WORK_OF_A_NODE = 16 };
    if (!eval_step(ev, span) || !eval_work(ev, WORK_OF_A_NODE * function->body->size, span)) {
        return false;
    }
    run.ev = ev;
    run.span = span;
    memcpy(run.slots, arguments, function->parameter_count * sizeof *arguments);
    *number = value_of(function->body, &run);
    return !ev->stop;
}

static bool apply_made(Eval *ev, const Function *function, const double *arguments, Span span, double v[5])
{
    if (function->painted != NULL) {
        return ev->builder->painted_at(ev, function->painted, arguments, span, v);
    }
    if (function->kind == FUNCTION_SPLINE) {
        spline_at(function->spline, function->spline->type, arguments[0], v);
        return true;
    }
    Vec3 point = transform_point(&function->transform, vec3(arguments[0], arguments[1], arguments[2]));
    v[0] = point.x;
    v[1] = point.y;
    v[2] = point.z;
    v[3] = v[4] = 0.0;
    return true;
}

// The height of the body counts all calls inside it, so no call further in needs to be counted.
unsigned function_apply(Eval *ev, const Function *function, const double *arguments, Span span, double v[5])
{
    if (function->kind != FUNCTION_NUMBER) {
        return apply_made(ev, function, arguments, span, v) ? function_width(function) : 0;
    }
    if (!eval_deepen(ev, function->body->height, span)) {
        return 0;
    }
    bool fine = run_body(ev, function, arguments, span, v);
    eval_shallow(ev, function->body->height);
    return fine ? 1 : 0;
}

// The manual's formula, 2.2.2.5.4 "Pigment Functions".
static double height_of(const double v[5])
{
    return (v[0] + v[1] / 255.0) * 0.996093;
}

double function_run_call(const FunctionNode *node, FunctionRun *run)
{
    double arguments[FUNCTION_SLOTS_MAX], v[5] = {0};
    unsigned count = 0;
    for (const FunctionNode *argument = node->arguments; argument != NULL; argument = argument->next) {
        arguments[count++] = value_of(argument, run);
    }
    if (node->function->kind == FUNCTION_NUMBER) {
        return run_body(run->ev, node->function, arguments, run->span, v) ? v[0] : 0.0;
    }
    if (!apply_made(run->ev, node->function, arguments, run->span, v)) {
        return 0.0;
    }
    switch (node->slot) {
    case COMPONENT_GRAY: return number_gray(v);
    case COMPONENT_HEIGHT: return height_of(v);
    default: return v[node->slot];
    }
}
