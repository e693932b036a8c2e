// Expressions: AST nodes become values.
//
// One function for each kind of node, in a table; operators.c has those of operators. Owns nothing. Knows nothing of
// blocks and of what directives do.
//
// SPDX-License-Identifier: MIT
#include <limits.h>
#include <string.h>

#include "eval/values/characters.h"
#include "eval/run/callable.h"
#include "scene/description.h"

bool eval_number(Eval *ev, const AstNode *node, double *number)
{
    Value value;
    double quick;
    if (node->kind == AST_NUMBER) {
        *number = node->number;
        return true;
    }
    if (quick_number(ev, node, &quick)) {
        *number = quick;
        return true;
    }
    return eval_expression(ev, node, &value) && value_number(ev, &value, node->span, number);
}

bool eval_vector3(Eval *ev, const AstNode *node, Vec3 *vector)
{
    Value value;
    return eval_expression(ev, node, &value) && value_vector3(ev, &value, node->span, vector);
}

bool eval_string(Eval *ev, const AstNode *node, Value *value)
{
    if (is_in_initialiser(ev) && begins_with_call(ev, node)) {
        return initialiser_fault(ev, node->span);
    }
    ev->inner++;
    bool fine = eval_expression(ev, node, value) && value_string(ev, value, node->span);
    ev->inner--;
    return fine;
}

bool eval_condition(Eval *ev, const AstNode *node, bool *holds)
{
    double number = 0;
    unsigned inner = ev->inner;
    bool takes_end = ev->takes_end;
    ev->inner = 0;
    ev->takes_end = false;
    bool fine = eval_number(ev, node, &number);
    ev->inner = inner;
    ev->takes_end = takes_end;
    *holds = fine && number_is_true(number);
    return fine;
}

// ---- leaves

static bool eval_text_literal(Eval *ev, const AstNode *node, Value *value)
{
    return characters_of_text(ev, intern_get(ev->options.names, node->symbol),
                              intern_length(ev->options.names, node->symbol), node->span, value);
}

// Once for each name, and not where the true fault is an #include that was not found.
bool name_fault_undeclared(Eval *ev, const AstNode *node, const char *what)
{
    bool is_told = ev->include_is_missing || (ev->macro_is_missing && node->kind == AST_CALL);
    if (is_told || !eval_is_first(ev, DIAG_E0201, node->symbol)) {
        return false;
    }
    if (eval_report(ev, DIAG_E0201, node->span, "%s `%s` is not declared", what, eval_text(ev, node->symbol))) {
        Suggest suggest = scope_nearest(ev, node);
        char file[NAME_MAX + 1];
        if (name_find_include(ev, eval_text(ev, node->symbol), file)) {
            diag_suggest(ev->options.diags, "`#include \"%s\"` declares it", file);
        } else if (suggest.best != NULL) {
            diag_did_you_mean(ev->options.diags, eval_word_span(ev, node), suggest.best);
        }
    }
    return false;
}

// The declaration that is being computed makes the name, which hides any other from then on, as in POV-Ray.
bool name_fault_unset(Eval *ev, const AstNode *node)
{
    const char *name = eval_text(ev, node->symbol);
    if (eval_report(ev, DIAG_E0224, node->span, "`%s` has no value before its declaration ends", name)) {
        diag_suggest(ev->options.diags, "if another `%s` is meant, copy it to a name of its own first", name);
    }
    return false;
}

static bool eval_name(Eval *ev, const AstNode *node, Value *value)
{
    const Value *found = node->flags & AST_KNOWN ? node->known : scope_find(ev, node->symbol);
    if (RT_UNLIKELY(found == NULL)) {
        return name_fault_undeclared(ev, node, "the name");
    }
    if (RT_UNLIKELY(found->kind == VALUE_NONE)) {
        return false; // its declaration has been reported
    }
    if (RT_UNLIKELY(found->kind == VALUE_UNSET)) {
        return name_fault_unset(ev, node);
    }
    if (RT_UNLIKELY(found->kind == VALUE_MACRO)) {
        return eval_fault(ev, DIAG_E0208, node->span, "the macro `%s` is called without its parentheses",
                          eval_text(ev, node->symbol));
    }
    if (RT_UNLIKELY(found->kind == VALUE_FILE)) {
        return eval_fault(ev, DIAG_E0268, node->span, "`%s` is an open file, not a value", eval_text(ev, node->symbol));
    }
    *value = *found;
    value->name = node->symbol;
    return true;
}

static bool eval_element(Eval *ev, const AstNode *node, Value *value)
{
    Value *element;
    ValueArray *array;
    if (!array_locate(ev, node, &element, &array)) {
        return false;
    }
    if (element->kind == VALUE_NONE) {
        return eval_fault(ev, DIAG_E0207, node->span, "this element of the array has no value yet");
    }
    *value = *element;
    return true;
}

// ---- calls

bool macro_find(Eval *ev, const AstNode *call, Macro **macro)
{
    const Value *found = scope_find(ev, call->symbol);
    if (found == NULL || found->kind != VALUE_MACRO) {
        call_fault_callee(ev, call, found);
        return false;
    }
    *macro = found->macro;
    return true;
}

static bool eval_call(Eval *ev, const AstNode *node, Value *value)
{
    return macro_value(ev, node, false, value);
}

static bool eval_inline(Eval *ev, const AstNode *node, Value *value)
{
    return inline_value(ev, node, false, value);
}

// ---- vectors

// A component, or those that a directive between them gives.
static bool take_components(Eval *ev, const AstNode *part, Value *value, unsigned *count)
{
    double number = 0;
    if (part->kind != AST_INLINE) {
        bool fine = eval_number(ev, part, &number);
        value->v[*count < 5 ? *count : 4] = number;
        ++*count;
        return fine;
    }
    Cursor cursor;
    Span span;
    bool fine = true;
    unsigned initialiser = ev->initialiser;
    ev->initialiser = 0;
    cursor_open(&cursor, ev, part->a, part->span);
    while (cursor_peek(&cursor) != NULL) {
        if (*count > 0) { // none before the first of all
            cursor_take_comma(&cursor);
        }
        fine = cursor_number(&cursor, &number, &span) && fine;
        value->v[*count < 5 ? *count : 4] = number;
        ++*count;
    }
    cursor_close(&cursor);
    ev->initialiser = initialiser;
    return fine && !ev->stop;
}

static bool eval_vector(Eval *ev, const AstNode *node, Value *value)
{
    unsigned count = 0;
    bool fine = true;
    const AstNode *last = NULL;
    ev->inner++;
    for (const AstNode *part = node->a; part != NULL; part = part->next) {
        fine = take_components(ev, part, value, &count) && fine;
        last = part;
    }
    ev->inner--;
    if (RT_UNLIKELY(count == 5 && (last->flags & AST_BEFORE_COMMA))) {
        return eval_fault(ev, DIAG_E0204, last->span, "no comma may follow the fifth component of a vector");
    }
    if (count < 2 || count > 5) {
        return eval_fault(ev, DIAG_E0204, node->span, "a vector has 2 to 5 components, not %u", count);
    }
    value->kind = VALUE_VECTOR;
    value->components = (uint8_t)count;
    value->block = 0;
    value->name = SYMBOL_NONE;
    return fine;
}

static bool eval_member(Eval *ev, const AstNode *node, Value *value)
{
    unsigned component;
    if (node->a->kind == AST_MEMBER && !(node->a->flags & AST_IN_PARENTHESES)) {
        return eval_fault(ev, DIAG_E0204, node->span, "a component has no component `%s`", eval_text(ev, node->symbol));
    }
    if (!eval_expression(ev, node->a, value)) {
        return false;
    }
    bool is_number = value->kind == VALUE_NUMBER;
    if ((!is_number && !value_is_tuple(value)) ||
        !value_component(node->symbol, is_number ? 1 : value->components, &component)) {
        return eval_fault(ev, DIAG_E0204, node->span, "%s has no component `%s`", value_describe(value),
                          eval_text(ev, node->symbol));
    }
    if (is_number) {
        value_set_number(value, value->number);
        return true;
    }
    uint8_t kept = value->kept > value->components ? value->kept : value->components;
    if (value->components == 2 && kept == 2) {
        value->v[2] = 0.0; // for `gray`
    }
    value_set_number(value, component == COMPONENT_GRAY ? number_gray(value->v) : value->v[component]);
    value->kept = kept;
    return true;
}

// ---- the table

typedef bool (*EvalFn)(Eval *ev, const AstNode *node, Value *value);

// All kinds of expressions but numbers, which need no call.
static const EvalFn evaluators[AST_KIND_COUNT] = {
    [AST_STRING] = eval_text_literal,
    [AST_NAME] = eval_name,
    [AST_CONSTANT] = builtin_constant,
    [AST_UNARY] = operator_unary,
    [AST_BINARY] = operator_binary,
    [AST_CONDITIONAL] = operator_conditional,
    [AST_VECTOR] = eval_vector,
    [AST_CALL] = eval_call,
    [AST_BUILTIN] = builtin_call,
    [AST_INDEX] = eval_element,
    [AST_MEMBER] = eval_member,
    [AST_INLINE] = eval_inline,
};

static bool fault_no_expression(Eval *ev, const AstNode *node)
{
    if (node->kind == AST_WORD && word_class(node->symbol) == WORD_COLOUR) {
        return eval_fault(ev, DIAG_E0214, node->span, "a colour word such as `%s` cannot stand inside an expression",
                          eval_text(ev, node->symbol));
    }
    bool has_word = node->kind == AST_WORD || node->kind == AST_BLOCK;
    return eval_fault(ev, DIAG_E0202, node->span, "expected an expression, found %s%s%s",
                      has_word ? "`" : "", has_word ? eval_text(ev, node->symbol) : ast_kind_name((AstKind)node->kind),
                      has_word ? "`" : "");
}

// What was computed while it was read, and what may have to be read again.
static bool eval_special(Eval *ev, const AstNode *node, EvalFn evaluate, Value *value)
{
    if ((node->flags & AST_KNOWN) && node->kind != AST_NAME) {
        *value = *(const Value *)node->known;
        return value->kind != VALUE_NONE;
    }
    bool is_pasted = (node->flags & AST_PASTES) && paste_is_needed(ev, node);
    return is_pasted ? paste_value(ev, node, value) : evaluate(ev, node, value);
}

// They stand around numbers and vectors only.
static bool check_parentheses(Eval *ev, const AstNode *node, Value *value)
{
    if (value->kind == VALUE_NUMBER || value_is_tuple(value)) {
        value->is_scaled = value->has_third = false;
        value->is_closed = true;
        return true;
    }
    if (eval_report(ev, DIAG_E0202, node->span, "%s cannot stand in parentheses", value_describe(value))) {
        diag_suggest(ev->options.diags, "leave the parentheses out");
    }
    return false;
}

bool eval_expression(Eval *ev, const AstNode *node, Value *value)
{
    if (node->kind == AST_NUMBER) {
        value_set_number(value, node->number);
        return true;
    }
    EvalFn evaluate = evaluators[node->kind];
    if (RT_UNLIKELY(evaluate == NULL)) {
        return fault_no_expression(ev, node);
    }
    if (!eval_deepen(ev, 1, node->span)) {
        return false;
    }
    unsigned closes = node->flags & AST_IN_PARENTHESES ? 1 : 0;
    ev->inner += closes;
    bool is_special = node->flags & (AST_KNOWN | AST_PASTES);
    bool fine = RT_UNLIKELY(is_special) ? eval_special(ev, node, evaluate, value) : evaluate(ev, node, value);
    ev->inner -= closes;
    eval_shallow(ev, 1);
    return RT_UNLIKELY(closes != 0) && fine ? check_parentheses(ev, node, value) : fine;
}

// ---- right-hand sides

static bool eval_sequence(Eval *ev, const AstNode *node, Value *value)
{
    if (node->a->kind == AST_BLOCK) {
        return ev->builder->texture_layers(ev, node->a, value);
    }
    Cursor cursor;
    Rgbft colour;
    Span span;
    cursor_open(&cursor, ev, node->a, node->span);
    bool fine = cursor_colour(&cursor, &colour, &span);
    const AstNode *rest = fine ? cursor_peek(&cursor) : NULL;
    if (rest != NULL) {
        fine = eval_fault(ev, DIAG_E0213, rest->span, "a colour ends before this");
    }
    cursor_close(&cursor);
    *value = (Value){.kind = VALUE_COLOUR, .components = 5};
    memcpy(value->v, (double[]){colour.red, colour.green, colour.blue, colour.filter, colour.transmit},
           sizeof value->v);
    return fine;
}

static bool eval_braces(Eval *ev, const AstNode *node, Value *value)
{
    ev->inner++;
    bool fine = node->symbol == W_spline ? spline_create(ev, node, value) : ev->builder->block(ev, node, value);
    ev->inner--;
    return fine;
}

bool eval_rvalue(Eval *ev, const AstNode *node, Value *value)
{
    switch (node->kind) {
    case AST_SEQUENCE: return eval_sequence(ev, node, value);
    case AST_ARRAY: return array_create(ev, node, value);
    case AST_BLOCK:
    case AST_FUNCTION: {
        bool fine = node->kind == AST_BLOCK ? eval_braces(ev, node, value) : function_create(ev, node, value);
        ev->is_value_made = true;
        return fine;
    }
    case AST_CALL:
        if (!(node->flags & (AST_IN_PARENTHESES | AST_KNOWN))) {
            return macro_value(ev, node, true, value);
        }
        return eval_expression(ev, node, value);
    case AST_INLINE:
        if (!(node->flags & AST_IN_PARENTHESES)) {
            return inline_value(ev, node, true, value);
        }
        return eval_expression(ev, node, value);
    default: return eval_expression(ev, node, value);
    }
}

// In POV-Ray's language no value begins with `t`, which is a word of transforms and maps, too.
static bool begins_with_t(const AstNode *node)
{
    while ((node->kind == AST_BINARY || node->kind == AST_MEMBER) && !(node->flags & AST_IN_PARENTHESES)) {
        node = node->a;
    }
    return node->kind == AST_CONSTANT && node->symbol == W_t && !(node->flags & AST_IN_PARENTHESES);
}

bool eval_open_rvalue(Eval *ev, const AstNode *node, Value *value)
{
    if (RT_UNLIKELY(begins_with_t(node))) {
        if (eval_report(ev, DIAG_E0265, node->span, "a value cannot begin with `t` here")) {
            diag_suggest(ev->options.diags, "write `(t)`");
        }
        return false;
    }
    unsigned inner = ev->inner;
    ev->inner = 0;
    bool fine = eval_rvalue(ev, node, value);
    ev->inner = inner;
    return fine;
}

const EvalText text_of_scene = {
    .expression = eval_expression,
    .number = eval_number,
    .vector3 = eval_vector3,
    .string = eval_string,
    .is_declared = name_is_declared,
    .has_file = file_is_there,
};
