// Numbers that are computed at once: expressions of numbers and of names and elements that are numbers, of which
// loops are full.
//
// Gives what expression.c and operators.c give where that is one number, or a vector of three, and nothing is to be
// said of it. Anything else is refused and goes the usual way, which reports what is to be reported; nothing has happened
// then but that random numbers were drawn, and those only where the caller takes them back. Owns nothing.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/run/scope.h"

// Numbers that are nearer to one another than this, and differ, are reported where they are compared.
#define NEARNESS 1e-9

static inline bool number_of(Eval *ev, const AstNode *node, bool draws, double *number);

// An element of an array of one dimension; NULL: refused.
static const Value *element_of(Eval *ev, const AstNode *node, bool draws)
{
    double index;
    const Value *base = node->a->kind == AST_NAME && !(node->a->flags & (AST_KNOWN | AST_PASTES)) ? scope_look(ev, node->a->symbol)
                                                                                  : NULL;
    if (base == NULL || base->kind != VALUE_ARRAY || base->array->dimension_count != 1 ||
        !number_of(ev, node->b, draws, &index)) {
        return NULL;
    }
    double whole = number_index(index);
    bool is_inside = whole >= 0.0 && whole < (double)base->array->count;
    return is_inside ? &base->array->elements[(size_t)whole] : NULL;
}

static const Value *value_of(Eval *ev, const AstNode *node, bool draws)
{
    return node->kind == AST_NAME ? scope_look(ev, node->symbol) : element_of(ev, node, draws);
}

static bool member_of(Eval *ev, const AstNode *node, bool draws, double *number)
{
    const AstNode *base = node->a;
    bool is_plain = (base->kind == AST_NAME || base->kind == AST_INDEX) && !(base->flags & (AST_KNOWN | AST_PASTES));
    unsigned component = node->symbol == W_x ? 0 : node->symbol == W_y ? 1 : node->symbol == W_z ? 2 : 3;
    const Value *value = is_plain && component < 3 ? value_of(ev, base, draws) : NULL;
    if (value == NULL || value->kind != VALUE_VECTOR || component >= value->components) {
        return false;
    }
    *number = value->v[component];
    return true;
}

static bool compare(AstOp op, double one, double other, double *number)
{
    double difference = fabs(one - other);
    bool is_told = (op == AST_OP_EQ || op == AST_OP_NE) && difference > 0.0 && difference < NEARNESS;
    if (!isfinite(difference) || is_told) {
        return false;
    }
    switch (op) {
    case AST_OP_EQ: *number = difference == 0.0; return true;
    case AST_OP_NE: *number = difference != 0.0; return true;
    case AST_OP_LT: *number = one < other; return true;
    case AST_OP_LE: *number = one < other || numbers_equal(one, other); return true;
    case AST_OP_GT: *number = one > other; return true;
    case AST_OP_GE: *number = one > other || numbers_equal(one, other); return true;
    case AST_OP_AND: *number = number_is_true(one) && number_is_true(other); return true;
    case AST_OP_OR: *number = number_is_true(one) || number_is_true(other); return true;
    default: return false;
    }
}

static inline bool operate(AstOp op, double one, double other, double *number)
{
    switch (op) {
    case AST_OP_ADD: *number = one + other; break;
    case AST_OP_SUB: *number = one - other; break;
    case AST_OP_MUL: *number = one * other; break;
    case AST_OP_DIV:
        if (other == 0.0) {
            return false;
        }
        *number = one / other;
        break;
    default: return compare(op, one, other, number);
    }
    return isfinite(*number);
}

// ---- functions

static bool two_numbers(const AstNode *node, const double *a, double *number)
{
    if (node->symbol == W_mod) {
        *number = fmod(a[0], a[1]);
    } else if (node->symbol == W_div) {
        *number = number_to_int(a[0] / a[1]);
    } else {
        if (!number_is_true(a[0]) && !number_is_true(a[1])) {
            return false;
        }
        *number = node->symbol == W_pow ? pow(a[0], a[1]) : atan2(a[0], a[1]);
    }
    return isfinite(*number);
}

static bool least_or_greatest(Eval *ev, const AstNode *node, bool draws, double *number)
{
    double next;
    if (!number_of(ev, node->a, draws, number)) {
        return false;
    }
    for (const AstNode *argument = node->a->next; argument != NULL; argument = argument->next) {
        if ((argument->flags & AST_WITHOUT_COMMA) || !number_of(ev, argument, draws, &next)) {
            return false;
        }
        bool is_better = node->symbol == W_max ? next > *number : next < *number;
        *number = is_better ? next : *number;
    }
    return true;
}

static bool random_of(Eval *ev, double handle, double *number)
{
    if (!(handle > -1.0 && handle < (double)ev->streams.count)) {
        return false;
    }
    *number = random_next(&ev->streams.items[handle > 0.0 ? (size_t)handle : 0]);
    return true;
}

static bool call_of(Eval *ev, const AstNode *node, bool draws, double *number)
{
    double a[2];
    const AstNode *first = node->a;
    bool has_relation = first != NULL && first->kind == AST_BINARY && first->op < AST_OP_ADD;
    if (first == NULL || has_relation) {
        return false;
    }
    switch (node->symbol) {
    case W_defined:
        *number = first->kind == AST_NAME && scope_look(ev, first->symbol) != NULL ? 1.0 : 0.0;
        return node->count == 1 && first->kind == AST_NAME &&
               !(first->flags & (AST_KNOWN | AST_IN_PARENTHESES));
    case W_rand: return draws && node->count == 1 && number_of(ev, first, draws, a) && random_of(ev, a[0], number);
    case W_min:
    case W_max: return least_or_greatest(ev, node, draws, number);
    case W_mod:
    case W_div:
    case W_pow:
    case W_atan2:
        return node->count == 2 && number_of(ev, first, draws, &a[0]) && number_of(ev, first->next, draws, &a[1]) &&
               two_numbers(node, a, number);
    case W_sqrt:
        if (node->count != 1 || !number_of(ev, first, draws, a) || !(a[0] >= 0.0)) {
            return false;
        }
        *number = sqrt(a[0]);
        return true;
    default: break;
    }
    NumberFn function = builtin_of_number(node->symbol);
    if (function == NULL || node->count != 1 || !number_of(ev, first, draws, a)) {
        return false;
    }
    *number = function(a[0]);
    return isfinite(*number);
}

// ---- numbers

static bool unary_of(Eval *ev, const AstNode *node, bool draws, double *number)
{
    if ((node->op != AST_OP_NEG && node->op != AST_OP_PLUS) || !number_of(ev, node->a, draws, number)) {
        return false;
    }
    *number = node->op == AST_OP_NEG ? -*number : *number;
    return true;
}

// All but the leaves, which are most of them.
__attribute__((noinline)) static bool tree_of(Eval *ev, const AstNode *node, bool draws, double *number)
{
    const Value *value;
    double one, other;
    switch ((AstKind)node->kind) {
    case AST_INDEX:
        value = element_of(ev, node, draws);
        if (value == NULL || value->kind != VALUE_NUMBER) {
            return false;
        }
        *number = value->number;
        return true;
    case AST_CONSTANT:
        *number = NUMBER_PI;
        return node->symbol == W_pi;
    case AST_MEMBER: return member_of(ev, node, draws, number);
    case AST_UNARY: return unary_of(ev, node, draws, number);
    case AST_BINARY:
        return number_of(ev, node->a, draws, &one) && number_of(ev, node->b, draws, &other) &&
               operate((AstOp)node->op, one, other, number);
    case AST_BUILTIN: return call_of(ev, node, draws, number);
    default: return false;
    }
}

static inline bool number_of(Eval *ev, const AstNode *node, bool draws, double *number)
{
    if (RT_UNLIKELY(node->flags & (AST_KNOWN | AST_PASTES))) {
        return false;
    }
    if (node->kind == AST_NUMBER) {
        *number = node->number;
        return true;
    }
    if (node->kind != AST_NAME) {
        return tree_of(ev, node, draws, number);
    }
    const Value *value = scope_look(ev, node->symbol);
    if (value == NULL || value->kind != VALUE_NUMBER) {
        return false;
    }
    *number = value->number;
    return true;
}

bool quick_number_of(Eval *ev, const AstNode *node, bool draws, double *number)
{
    return number_of(ev, node, draws, number);
}

// ---- vectors

static unsigned value_as_three(const Value *value, double *three)
{
    if (value == NULL || (value->kind != VALUE_NUMBER && (value->kind != VALUE_VECTOR || value->components != 3))) {
        return 0;
    }
    bool is_number = value->kind == VALUE_NUMBER;
    for (unsigned i = 0; i < 3; i++) {
        three[i] = is_number ? value->number : value->v[i];
    }
    return is_number ? 1 : 3;
}

static unsigned binary_as_three(Eval *ev, const AstNode *node, bool draws, double *three)
{
    double other[3];
    unsigned left = quick_three_of(ev, node->a, draws, three), right = left != 0 ? quick_three_of(ev, node->b, draws, other) : 0;
    if (right == 0 || (node->op < AST_OP_ADD && left + right > 2)) {
        return 0;
    }
    for (unsigned i = 0; i < 3; i++) {
        if (!operate((AstOp)node->op, three[i], other[i], &three[i])) {
            return 0;
        }
    }
    return left > right ? left : right;
}

static unsigned unary_as_three(Eval *ev, const AstNode *node, bool draws, double *three)
{
    unsigned width = node->op == AST_OP_NEG || node->op == AST_OP_PLUS ? quick_three_of(ev, node->a, draws, three) : 0;
    for (unsigned i = 0; width != 0 && i < 3; i++) {
        three[i] = node->op == AST_OP_NEG ? -three[i] : three[i];
    }
    return width;
}

// 1: a number, which stands in all three; 3: a vector; 0: refused.
unsigned quick_three_of(Eval *ev, const AstNode *node, bool draws, double *three)
{
    if (RT_UNLIKELY(node->flags & (AST_KNOWN | AST_PASTES))) {
        return 0;
    }
    switch ((AstKind)node->kind) {
    case AST_VECTOR: {
        const AstNode *part = node->a;
        bool is_fine = node->count == 3;
        for (unsigned i = 0; is_fine && i < 3; i++, part = part->next) {
            is_fine = number_of(ev, part, draws, &three[i]);
        }
        return is_fine ? 3 : 0;
    }
    case AST_NAME:
    case AST_INDEX: return value_as_three(value_of(ev, node, draws), three);
    case AST_CONSTANT:
        for (unsigned i = 0; i < 3; i++) {
            three[i] = node->symbol == (Symbol[]){W_x, W_y, W_z}[i] ? 1.0 : 0.0;
        }
        return three[0] + three[1] + three[2] == 1.0 ? 3 : 0;
    case AST_UNARY: return unary_as_three(ev, node, draws, three);
    case AST_BINARY: return binary_as_three(ev, node, draws, three);
    default:
        if (!number_of(ev, node, draws, three)) {
            return 0;
        }
        three[1] = three[2] = three[0];
        return 1;
    }
}
