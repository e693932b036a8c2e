// Functions: `function (a, b) { … }`, and functions made of a transform or a spline.
//
// Turns a FUNCTION node into a value that calls can use: its parameters are named, its body is compiled. What rtlang
// has not is kept as a function that is a fault where it is called. Knows nothing of calls.
//
// SPDX-License-Identifier: MIT
#include "scene/description.h"
#include "eval/run/callable.h"

static bool fault_parameter(FunctionBody *body, const AstNode *node, const char *why)
{
    return eval_fault(body->ev, DIAG_E0260, node->span, "`%s` cannot be a parameter%s",
                      eval_text(body->ev, node->symbol), why);
}

static bool add_parameter(FunctionBody *body, const AstNode *node)
{
    Symbol name = function_slot_name(node->symbol);
    bool is_word = node->symbol < WORD_COUNT;
    if (is_word && name != W_x && name != W_y && name != W_z) {
        return fault_parameter(body, node, "; of the words of the language only x, y, z, u and v can");
    }
    if (!is_word && function_meaning(body->ev, node) != NULL) {
        return fault_parameter(body, node, ", since it is declared already");
    }
    for (unsigned i = 0; i < body->count; i++) {
        if (body->names[i] == name) {
            return fault_parameter(body, node, " twice (u is x, and v is y)");
        }
    }
    if (body->count == FUNCTION_SLOTS_MAX) {
        return eval_fault(body->ev, DIAG_E0260, node->span, "a function has at most %d parameters", FUNCTION_SLOTS_MAX);
    }
    body->names[body->count++] = name;
    return true;
}

static bool name_parameters(FunctionBody *body, const AstNode *parameters)
{
    bool fine = true;
    if (parameters == NULL) {
        body->names[0] = W_x;
        body->names[1] = W_y;
        body->names[2] = W_z;
        body->count = 3;
    }
    for (const AstNode *node = parameters; node != NULL; node = node->next) {
        fine = add_parameter(body, node) && fine;
    }
    return fine;
}

static bool make_numeric(Eval *ev, const AstNode *node, Function *function)
{
    FunctionBody body = {.ev = ev};
    if (node->b->kind == AST_BUILTIN && node->b->symbol == W_internal) {
        return function_given(ev, node->b, function); // whatever parameters are listed
    }
    if (!name_parameters(&body, node->a)) {
        return false;
    }
    function->body = function_compile(&body, node->b);
    function->parameter_count = body.count;
    if (body.unsupported != NULL) {
        function->kind = FUNCTION_UNSUPPORTED;
        function->word = body.unsupported;
    }
    return function->body != NULL;
}

static bool make_transform(Eval *ev, const AstNode *block, Function *function)
{
    Value value;
    if (!ev->builder->block(ev, block, &value)) {
        return false;
    }
    if (value.block == KIND_UNSUPPORTED) {
        function->kind = FUNCTION_UNSUPPORTED;
        function->word = ((const UnsupportedDesc *)value.record)->word;
        return true;
    }
    function->kind = FUNCTION_TRANSFORM;
    function->parameter_count = 3;
    function->transform = ((const TransformDesc *)value.record)->transform;
    return true;
}

static bool make_spline(Eval *ev, const AstNode *block, Function *function)
{
    Value value;
    if (!spline_create(ev, block, &value)) {
        return false;
    }
    function->kind = FUNCTION_SPLINE;
    function->parameter_count = 1;
    function->spline = value.spline;
    return true;
}

static bool make_painted(Eval *ev, const AstNode *block, Function *function)
{
    const char *unsupported = NULL;
    function->kind = block->symbol == W_pattern ? FUNCTION_PATTERN : FUNCTION_PIGMENT;
    function->parameter_count = 3;
    if (!ev->builder->painted_create(ev, block, &function->painted, &unsupported)) {
        return false;
    }
    if (unsupported != NULL) {
        function->kind = FUNCTION_UNSUPPORTED;
        function->word = unsupported;
    }
    return true;
}

static bool make_of_block(Eval *ev, const AstNode *node, Function *function)
{
    const AstNode *block = node->b;
    bool is_known = block->symbol == W_transform || block->symbol == W_spline || block->symbol == W_pigment ||
                    block->symbol == W_pattern;
    if (!is_known) {
        return eval_fault(ev, DIAG_E0261, block->span, "`%s` cannot stand in the body of a function",
                          eval_text(ev, block->symbol));
    }
    if (node->a != NULL) {
        return eval_fault(ev, DIAG_E0260, node->a->span, "a function of a `%s` takes no list of parameters",
                          eval_text(ev, block->symbol));
    }
    switch (block->symbol) {
    case W_transform: return make_transform(ev, block, function);
    case W_spline: return make_spline(ev, block, function);
    default: return make_painted(ev, block, function);
    }
}

bool function_create(Eval *ev, const AstNode *node, Value *value)
{
    if (node->c != NULL) {
        return eval_fault(ev, DIAG_E0260, node->c->span,
                          "a function has so many values along each side in a `height_field` only");
    }
    if (paste_is_needed_in_function(ev, node)) {
        return !is_in_initialiser(ev) ? paste_function(ev, node, value) : initialiser_fault(ev, node->span);
    }
    Function *function = arena_alloc(&ev->program, sizeof *function);
    if (function == NULL) {
        return eval_no_memory(ev, node->span);
    }
    *function = (Function){.kind = FUNCTION_NUMBER, .span = node->span};
    *value = (Value){.kind = VALUE_FUNCTION, .function = function};
    if (node->b == NULL) {
        return false; // the body has had its message
    }
    return node->b->kind == AST_BLOCK ? make_of_block(ev, node, function) : make_numeric(ev, node, function);
}
