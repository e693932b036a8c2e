// Operators: what they make of values, with the language's promotions and its tolerance of comparisons.
//
// A number beside a vector fills all of its components, a shorter vector is continued with zeros. Both sides are always
// computed. Owns nothing. Knows nothing of names and blocks.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/values/values.h"

// Measured: numbers that differ by 1e-10 are equal, and 1e-10 itself is false. Absolute, whatever the size. What is not
// a number is equal to any, and false.
static const double comparison_tolerance = 1e-10;

bool numbers_equal(double one, double other)
{
    return one == other || !(fabs(one - other) > comparison_tolerance);
}

bool number_is_case(double subject, double number)
{
    return fabs(subject - number) <= comparison_tolerance;
}

bool number_is_true(double number)
{
    return fabs(number) > comparison_tolerance;
}

void number_fault(Eval *ev, double number, Span span)
{
    if (isnan(number)) {
        eval_warn(ev, DIAG_W0304, span, "the result is not a number");
    } else {
        eval_warn(ev, DIAG_W0305, span, "the result is infinite");
    }
}

static const char *spelling(const AstNode *node)
{
    return ast_op_spelling((AstOp)node->op);
}

bool operator_unary(Eval *ev, const AstNode *node, Value *value)
{
    if (!ask_expression(ev, node->a, value)) {
        return false;
    }
    value->name = SYMBOL_NONE;
    if (value->kind == VALUE_NUMBER) {
        switch (node->op) {
        case AST_OP_NEG: value->number = -value->number; break;
        case AST_OP_NOT: value->number = number_is_true(value->number) ? 0.0 : 1.0; break;
        default: break;
        }
        return true;
    }
    if (!value_is_tuple(value)) {
        return eval_fault(ev, DIAG_E0202, node->a->span, "`%s` needs a number or a vector, found %s", spelling(node),
                          value_describe(value));
    }
    for (unsigned i = 0; node->op != AST_OP_PLUS && i < 5; i++) {
        if (i >= value->components && !(i == 4 && value->has_third)) {
            continue;
        }
        value->v[i] = node->op == AST_OP_NEG ? -value->v[i] : !number_is_true(value->v[i]);
    }
    return true;
}

// As measured: whatever the numerator, the quotient by zero is +infinity.
static double divide(Eval *ev, const AstNode *node, double one, double other)
{
    if (RT_UNLIKELY(other == 0.0)) {
        eval_warn(ev, DIAG_W0301, node->b->span, "division by zero gives infinity");
        return HUGE_VAL;
    }
    double result = one / other;
    if (RT_UNLIKELY(!isfinite(result)) && isfinite(one) && isfinite(other)) {
        number_fault(ev, result, node->span);
    }
    return result;
}

static double arithmetic(Eval *ev, const AstNode *node, double one, double other)
{
    double result;
    switch (node->op) {
    case AST_OP_ADD: result = one + other; break;
    case AST_OP_SUB: result = one - other; break;
    case AST_OP_MUL: result = one * other; break;
    default: return divide(ev, node, one, other);
    }
    if (RT_UNLIKELY(!isfinite(result)) && isfinite(one) && isfinite(other)) {
        number_fault(ev, result, node->span);
    }
    return result;
}

static bool relation(AstOp op, double one, double other)
{
    switch (op) {
    case AST_OP_EQ: return numbers_equal(one, other);
    case AST_OP_NE: return !numbers_equal(one, other);
    case AST_OP_LT: return one < other;
    case AST_OP_LE: return one < other || numbers_equal(one, other);
    case AST_OP_GT: return one > other;
    case AST_OP_GE: return one > other || numbers_equal(one, other);
    case AST_OP_AND: return number_is_true(one) && number_is_true(other);
    default: return number_is_true(one) || number_is_true(other);
    }
}

static bool is_arithmetic(const AstNode *node)
{
    return node->op >= AST_OP_ADD && node->op <= AST_OP_DIV;
}

// A number fills all components, a narrower vector is continued with zeros.
static void widen(Value *value, unsigned components)
{
    if (value->kind == VALUE_NUMBER) {
        double number = value->number;
        for (unsigned i = 0; i < components; i++) {
            value->v[i] = number;
        }
    } else {
        for (unsigned i = value->components; i < components; i++) {
            value->v[i] = 0.0;
        }
    }
}

static unsigned width(const Value *value)
{
    return value->kind == VALUE_NUMBER ? 0 : value->components;
}

static double operate(const AstNode *node, double one, double other)
{
    switch (node->op) {
    case AST_OP_ADD: return one + other;
    case AST_OP_SUB: return one - other;
    case AST_OP_MUL: return one * other;
    case AST_OP_DIV: return other == 0.0 ? HUGE_VAL : one / other;
    default: return relation((AstOp)node->op, one, other);
    }
}

// As measured: where a vector of 3 is wanted, what the expression begins with has three components at once, unless it is
// a vector, or the component of one, without parentheses.
static bool third_component(const Value *left, double *third)
{
    *third = left->kind == VALUE_NUMBER ? left->number : left->has_third ? left->v[4] : 0.0;
    return left->is_closed || left->has_third || (left->kind == VALUE_NUMBER && left->kept == 0);
}

// As measured: a vector plus a number times a longer vector has as many components as the longer one, but those beyond
// its own are 0: <1, 2> + 3 * z is <1, 2, 0>, and <1, 2> + z * 3 is <1, 2, 3>. What began with a component of a vector
// keeps that vector's components behind its own.
static bool tuple_arithmetic(Eval *ev, const AstNode *node, Value *left, Value *right)
{
    unsigned components = width(left) > width(right) ? width(left) : width(right);
    bool is_colour = left->kind == VALUE_COLOUR || right->kind == VALUE_COLOUR;
    bool is_sum = node->op == AST_OP_ADD || node->op == AST_OP_SUB;
    bool is_product = node->op == AST_OP_MUL || node->op == AST_OP_DIV;
    for (unsigned i = width(left); is_sum && right->is_scaled && width(left) > 0 && i < width(right); i++) {
        right->v[i] = 0.0;
    }
    double third, right_third = right->kind == VALUE_NUMBER ? right->number : 0.0;
    left->has_third = third_component(left, &third) && components == 2;
    left->is_scaled = is_product && (left->kind == VALUE_NUMBER ? left->kept == 0 : left->is_scaled);
    widen(left, components);
    widen(right, components);
    for (unsigned i = 0; i < components; i++) {
        left->v[i] = is_sum || is_product ? arithmetic(ev, node, left->v[i], right->v[i])
                                          : relation((AstOp)node->op, left->v[i], right->v[i]);
    }
    if (left->has_third) {
        left->v[4] = operate(node, third, right_third);
        left->kept = left->kept < 4 ? left->kept : 4;
    }
    left->is_closed = false;
    left->kind = is_colour ? VALUE_COLOUR : VALUE_VECTOR;
    left->components = (uint8_t)components;
    return true;
}

static int compare_strings(const Value *one, const Value *other)
{
    size_t shorter = one->length < other->length ? one->length : other->length;
    int order = memcmp(one->text, other->text, shorter);
    return order != 0 ? order : (one->length > other->length) - (one->length < other->length);
}

static bool is_arithmetic_value(const Value *value)
{
    return value->kind == VALUE_NUMBER || value_is_tuple(value);
}

static bool fault_operand(Eval *ev, const AstNode *node, const Value *left, const Value *right)
{
    bool left_fits = is_arithmetic_value(left);
    return eval_fault(ev, DIAG_E0202, left_fits ? node->b->span : node->a->span,
                      "`%s` needs a number or a vector, found %s", spelling(node),
                      value_describe(left_fits ? right : left));
}

// Almost but not quite equal: the tolerance decides, and whoever wrote it may not think of that.
static void check_nearness(Eval *ev, const AstNode *node, double one, double other)
{
    static const double nearness = 1e-9;
    double difference = fabs(one - other);
    if (RT_UNLIKELY(difference > 0.0 && difference < nearness)) {
        eval_warn(ev, DIAG_W0306, node->span, "the numbers differ by %g, which `%s` takes as %s", difference,
                  spelling(node), numbers_equal(one, other) ? "equal" : "different");
    }
}

bool operator_binary(Eval *ev, const AstNode *node, Value *value)
{
    Value right;
    bool left_fine = ask_expression(ev, node->a, value);
    if (!ask_expression(ev, node->b, &right) || !left_fine) {
        return false;
    }
    value->name = SYMBOL_NONE;
    if (value->kind == VALUE_NUMBER && right.kind == VALUE_NUMBER) {
        if (node->op == AST_OP_EQ || node->op == AST_OP_NE) {
            check_nearness(ev, node, value->number, right.number);
        }
        value->number = is_arithmetic(node) ? arithmetic(ev, node, value->number, right.number)
                                            : relation((AstOp)node->op, value->number, right.number);
        return true;
    }
    if (is_arithmetic_value(value) && is_arithmetic_value(&right)) {
        return tuple_arithmetic(ev, node, value, &right);
    }
    bool compares = node->op >= AST_OP_EQ && node->op <= AST_OP_GE;
    if (compares && value->kind == VALUE_STRING && right.kind == VALUE_STRING) {
        if (!eval_work(ev, value->length < right.length ? value->length : right.length, node->span)) {
            return false;
        }
        value_set_number(value, relation((AstOp)node->op, compare_strings(value, &right), 0.0));
        return true;
    }
    return fault_operand(ev, node, value, &right);
}

// Both branches are always computed, as in POV-Ray.
bool operator_conditional(Eval *ev, const AstNode *node, Value *value)
{
    double condition = 0;
    Value otherwise;
    bool fine = ask_number(ev, node->a, &condition);
    fine = ask_expression(ev, node->b, value) && fine;
    fine = ask_expression(ev, node->c, &otherwise) && fine;
    if (!fine) {
        return false;
    }
    const AstNode *branches[] = {node->b, node->c};
    const Value *values[] = {value, &otherwise};
    for (unsigned i = 0; i < 2; i++) {
        if (!is_arithmetic_value(values[i])) {
            return eval_fault(ev, DIAG_E0202, branches[i]->span, "`?` chooses between numbers or vectors, found %s",
                              value_describe(values[i]));
        }
    }
    if (!number_is_true(condition)) {
        *value = otherwise;
    }
    value->name = SYMBOL_NONE;
    return true;
}
