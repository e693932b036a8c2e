// Macros: what a definition keeps, how a call begins and ends, and the value that a call stands for.
//
// A macro's text is copied into the program arena. Parameters are values, or stand for the caller's variable when the
// argument is a bare name or element. Knows nothing of blocks.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "eval/run/scope.h"

enum {
    CALL_WEIGHT = 8,   // of native recursion, see eval_deepen
    ARGUMENTS_FEW = 6, // more of them take scratch memory
};

// What the items of a body, or of a branch in it, may give where a value is wanted.
typedef struct Yield {
    unsigned values; // at most 2
    bool is_loose;
} Yield;

static Yield yield_of(const AstNode *items);

static Yield one_or_other(Yield one, Yield other)
{
    bool differ = one.values != other.values;
    return (Yield){one.values > other.values ? one.values : other.values, one.is_loose || other.is_loose || differ};
}

static Yield yield_of_item(const AstNode *item)
{
    Yield yield = {0, false};
    switch ((AstKind)item->kind) {
    case AST_IF:
    case AST_IFDEF: return one_or_other(yield_of(item->b), yield_of(item->c));
    case AST_SWITCH:
        for (const AstNode *branch = item->b; branch != NULL; branch = branch->next) {
            yield = one_or_other(yield, yield_of(case_items(branch)));
        }
        // One that runs on into the next gives more than one value.
        yield.is_loose |= yield.values > 0;
        return yield;
    case AST_WHILE: yield = yield_of(item->b); break;
    case AST_FOR: yield = yield_of(item->c); break;
    case AST_INCLUDE:
    case AST_CALL: return (Yield){1, true};
    default:
        if (item->kind < AST_DECLARE) {
            yield.values = item->kind != AST_WORD;
            bool is_operation = item->kind == AST_BINARY || item->kind == AST_CONDITIONAL || item->kind == AST_UNARY;
            yield.is_loose = (is_operation || item->kind == AST_INLINE) && !(item->flags & AST_IN_PARENTHESES);
        }
        return yield;
    }
    return (Yield){yield.values * 2, yield.is_loose || yield.values > 0};
}

static Yield yield_of(const AstNode *items)
{
    Yield yield = {0, false};
    for (; items != NULL; items = items->next) {
        Yield more = yield_of_item(items);
        yield.values = yield.values + more.values > 1 ? 2 : yield.values + more.values;
        yield.is_loose |= more.is_loose || (items->flags & (AST_AFTER_COMMA | AST_BEFORE_COMMA | AST_BEFORE_SEMICOLON));
    }
    return yield;
}

// Whether the macro's text may be more than one value, or fall apart among operators.
static bool is_loose(const AstNode *body)
{
    Yield yield = yield_of(body);
    return yield.is_loose || yield.values != 1;
}

static Macro *copy_macro(Eval *ev, const AstNode *node)
{
    Macro *macro = arena_alloc(&ev->program, sizeof *macro);
    Symbol *parameters = arena_alloc_array(&ev->program, node->count, sizeof *parameters);
    AstNode *body = ast_clone(node, &ev->program);
    if (macro == NULL || parameters == NULL || body == NULL) {
        eval_no_memory(ev, node->span);
        return NULL;
    }
    *macro = (Macro){.name = node->symbol, .span = node->span, .parameters = parameters, .body = body};
    for (const AstNode *parameter = node->a; parameter != NULL; parameter = parameter->next) {
        parameters[macro->parameter_count++] = parameter->symbol;
    }
    return macro;
}

// In a text that says it is of before 3.1 there are none.
static bool knows_macros(Eval *ev, Span span)
{
    return ev->version >= 3.1 || numbers_equal(ev->version, 3.1) ||
           eval_fault(ev, DIAG_E0212, span, "macros need `#version 3.1` or later, and it is %g here", ev->version);
}

void macro_define(Eval *ev, const AstNode *node, const GrammarText *text)
{
    if (!knows_macros(ev, node->span)) {
        return;
    }
    const Value *known = scope_find(ev, node->symbol);
    bool is_same = known != NULL && known->kind == VALUE_MACRO && known->macro->span.begin == node->span.begin;
    // A definition in a loop is kept once. One without a name has had its message.
    ev->macro_is_missing = ev->macro_is_missing || node->symbol == SYMBOL_NONE;
    if (is_same || node->symbol == SYMBOL_NONE) {
        return;
    }
    Macro *macro = copy_macro(ev, node);
    bool is_kept = macro != NULL && scope_define_macro(ev, macro);
    if (is_kept && text != NULL) {
        macro->text = grammar_text_copy(text, &ev->program);
        is_kept = macro->text != NULL || eval_no_memory(ev, node->span);
        macro->is_unbalanced = !grammar_text_is_balanced(text);
        ev->has_unbalanced = ev->has_unbalanced || macro->is_unbalanced;
        macro->is_torn = node->b == NULL && !grammar_text_is_empty(text);
        lint_give_up(ev);
    }
    if (is_kept) {
        macro->is_loose = macro->is_torn || is_loose(macro->body->b);
    }
    ev->faulty = ev->faulty || !is_kept;
}

const GrammarText *macro_text(Eval *ev, Macro *macro)
{
    if (macro->text == NULL) {
        GrammarContext context = {ev->options.names, &ev->parse, ev->options.diags, ev->options.limits, NULL,
                              ev->options.no_literals, NULL};
        GrammarText *text = grammar_text_body(&context, macro->span);
        macro->text = text != NULL ? grammar_text_copy(text, &ev->program) : NULL;
        free(text);
        ev->faulty = ev->faulty || macro->text == NULL;
    }
    return macro->text;
}

// ---- calls

typedef struct Argument {
    Value value;
    Value *variable; // by reference, or NULL
    ValueArray *array;
} Argument;

// A name that has a value of any kind stands for itself.
static bool read_name(const Eval *ev, const AstNode *node, Argument *argument)
{
    Binding *binding = scope_binding(ev, node->symbol);
    unsigned kind = binding != NULL ? binding->variable->kind : VALUE_NONE;
    if (kind == VALUE_NONE || kind == VALUE_UNSET || kind == VALUE_MACRO || kind == VALUE_FILE) {
        return false;
    }
    binding->is_used = true;
    argument->variable = binding->variable;
    argument->array = binding->array;
    return true;
}

// False: it is to be read the usual way.
static bool read_quickly(Eval *ev, const AstNode *node, Argument *argument)
{
    if (!quick_has_room(ev) || !quick_is_flat(node) || (node->flags & AST_KNOWN)) {
        return false;
    }
    if ((node->kind == AST_NAME || node->kind == AST_INDEX) && !(node->flags & AST_IN_PARENTHESES)) {
        return node->kind == AST_NAME && read_name(ev, node, argument);
    }
    Value *value = &argument->value;
    unsigned width = quick_three_of(ev, node, false, value->v);
    value->kind = width == 3 ? VALUE_VECTOR : VALUE_NUMBER;
    value->components = width == 3 ? 3 : 0;
    value->block = 0;
    value->name = SYMBOL_NONE;
    return width != 0;
}

static bool read_argument(Eval *ev, const AstNode *node, Argument *argument)
{
    bool is_bare = !(node->flags & AST_IN_PARENTHESES);
    argument->variable = NULL;
    argument->array = NULL;
    if (read_quickly(ev, node, argument)) {
        return true;
    }
    if (is_bare && node->kind == AST_INDEX) {
        return array_locate(ev, node, &argument->variable, &argument->array) &&
               (argument->variable->kind != VALUE_NONE ||
                eval_fault(ev, DIAG_E0207, node->span, "this element of the array has no value yet"));
    }
    // The look-up reports undeclared names and macros.
    if (!eval_open_rvalue(ev, node, &argument->value)) {
        return false;
    }
    if (is_bare && node->kind == AST_NAME) {
        argument->variable = scope_find(ev, node->symbol);
        argument->array = scope_array(ev, node->symbol);
    }
    return true;
}

static bool bind(Eval *ev, Symbol name, const Argument *argument, Span span)
{
    return argument->variable != NULL ? scope_bind_reference(ev, name, argument->variable, argument->array, span)
                                      : scope_bind_value(ev, name, &argument->value, span);
}

static bool is_open_sum(const AstNode *node)
{
    return node->kind == AST_BINARY && (node->op == AST_OP_ADD || node->op == AST_OP_SUB) &&
           !(node->flags & AST_IN_PARENTHESES);
}

// A sum without its first operand, whose sign becomes that of the second one: of `S - y + z` it is `-y + z`.
static const AstNode *without_first(Eval *ev, const AstNode *sum)
{
    AstNode *rest = arena_copy(&ev->scratch, sum, sizeof *rest);
    if (rest == NULL) {
        return NULL;
    }
    rest->next = NULL;
    rest->flags = (uint16_t)(rest->flags & ~(unsigned)AST_PASTES);
    if (is_open_sum(sum->a)) {
        rest->a = (AstNode *)without_first(ev, sum->a);
        return rest->a != NULL ? rest : NULL;
    }
    rest->kind = AST_UNARY;
    rest->op = sum->op == AST_OP_ADD ? AST_OP_PLUS : AST_OP_NEG;
    rest->a = sum->b;
    rest->b = NULL;
    rest->span.begin = sum->b->span.begin;
    return rest;
}

// An object ends its argument, with or without a comma after it, so that what looks like a sum is two arguments.
static bool read_object_and_rest(Eval *ev, const AstNode *sum, Argument arguments[2], bool *is_object)
{
    const AstNode *first = sum;
    while (is_open_sum(first)) {
        first = first->a;
    }
    if (!read_argument(ev, first, &arguments[0])) {
        return false;
    }
    *is_object = (arguments[0].variable != NULL ? arguments[0].variable : &arguments[0].value)->kind == VALUE_BLOCK;
    const AstNode *rest = *is_object ? without_first(ev, sum) : NULL;
    return *is_object && (rest != NULL ? read_argument(ev, rest, &arguments[1]) : eval_no_memory(ev, sum->span));
}

static bool fault_count(Eval *ev, const AstNode *call, const Macro *macro)
{
    if (eval_report(ev, DIAG_E0203, call->span, "the macro `%s` takes %u argument%s, and %u %s given",
                    eval_text(ev, macro->name), macro->parameter_count, macro->parameter_count == 1 ? "" : "s",
                    (unsigned)call->count, call->count == 1 ? "is" : "are")) {
        diag_note(ev->options.diags, macro->span, "it is defined here");
    }
    return false;
}

// Fewer than there are parameters: some may be an object and what follows it.
static bool read_fewer(Eval *ev, const AstNode *call, const Macro *macro, Argument *arguments)
{
    unsigned missing = macro->parameter_count - call->count;
    for (const AstNode *node = call->a; node != NULL; node = node->next) {
        bool is_divided = missing > 0 && is_open_sum(node), is_object = true;
        if (!(is_divided ? read_object_and_rest(ev, node, arguments, &is_object)
                         : read_argument(ev, node, arguments))) {
            return is_object ? false : fault_count(ev, call, macro);
        }
        missing -= is_divided;
        arguments += is_divided ? 2 : 1;
    }
    return missing == 0 || fault_count(ev, call, macro);
}

// All arguments are computed in the caller's scope before the first is bound.
static bool bind_all(Eval *ev, const AstNode *call, const Macro *macro)
{
    Argument few[ARGUMENTS_FEW];
    Argument *arguments = macro->parameter_count <= ARGUMENTS_FEW
                              ? few
                              : arena_alloc_array(&ev->scratch, macro->parameter_count, sizeof *arguments);
    if (arguments == NULL) {
        return eval_no_memory(ev, call->span);
    }
    bool has_all = call->count == macro->parameter_count;
    bool fine = has_all || read_fewer(ev, call, macro, arguments);
    unsigned i = 0;
    for (const AstNode *node = has_all ? call->a : NULL; node != NULL; node = node->next) {
        fine = read_argument(ev, node, &arguments[i++]) && fine;
    }
    if (!fine || !scope_push(ev, call->span)) {
        return false;
    }
    for (i = 0; i < macro->parameter_count; i++) {
        if (!bind(ev, macro->parameters[i], &arguments[i], call->span)) {
            scope_pop(ev);
            return false;
        }
    }
    return true;
}

bool macro_enter(Eval *ev, const AstNode *call, Macro *macro, DiagFrame *frame)
{
    if (!knows_macros(ev, call->span) || !eval_turn(ev, macro->span, call->span)) {
        return false;
    }
    if ((call->flags & (AST_PASTES | AST_KNOWN)) == AST_PASTES && paste_is_needed(ev, call)) {
        const AstNode *pasted = paste_arguments(ev, call);
        return pasted != NULL && macro_enter(ev, pasted, macro, frame);
    }
    if (ev->call_depth >= ev->options.limits->call_depth) {
        eval_fault(ev, DIAG_E0604, call->span, "macro calls nest deeper than %u levels",
                   ev->options.limits->call_depth);
        ev->stop = true;
        return false;
    }
    bool may_divide = false;
    for (const AstNode *node = call->a; node != NULL && call->count < macro->parameter_count; node = node->next) {
        may_divide = may_divide || is_open_sum(node);
    }
    if (call->count != macro->parameter_count && !may_divide) {
        return fault_count(ev, call, macro);
    }
    ArenaMark mark = scratch_mark(ev);
    bool fine = bind_all(ev, call, macro);
    scratch_rewind(ev, mark);
    if (fine) {
        ev->call_depth++;
        eval_frame_enter(ev, frame, "in macro", eval_text(ev, macro->name), call->span);
    }
    return fine;
}

void macro_leave(Eval *ev)
{
    eval_frame_leave(ev);
    ev->call_depth--;
    scope_pop(ev);
}

// ---- the value of a call

// Where a value is wanted from items: the span and a name for messages.
typedef struct Wanted {
    Span span;
    const char *name; // of the macro; NULL for a directive
} Wanted;

static bool fault_no_value(Eval *ev, const Wanted *wanted)
{
    return !ev->stop && eval_fault(ev, DIAG_E0213, wanted->span, "%s%s%s gives no value here",
                                   wanted->name != NULL ? "the macro `" : "the directive",
                                   wanted->name != NULL ? wanted->name : "", wanted->name != NULL ? "`" : "");
}

static bool fault_followed(Eval *ev, const Wanted *wanted)
{
    if (eval_report(ev, DIAG_E0221, wanted->span, "the directive after the value%s%s%s ends the expression",
                    wanted->name != NULL ? " in the macro `" : "", wanted->name != NULL ? wanted->name : "",
                    wanted->name != NULL ? "`" : "")) {
        diag_suggest(ev->options.diags, wanted->name != NULL ? "put parentheses around the call"
                                                             : "put parentheses around the directive");
    }
    return false;
}

static bool take_expression(Cursor *cursor, const Wanted *wanted, Value *value)
{
    Eval *ev = cursor->ev;
    if (cursor_peek(cursor) == NULL) {
        return fault_no_value(ev, wanted);
    }
    ev->takes_end = cursor->takes_end;
    bool fine = cursor_value(cursor, value);
    ev->takes_end = false;
    cursor->ends += ev->value_ends;
    return fine;
}

static bool take_colour(Cursor *cursor, Value *value)
{
    Rgbft colour;
    Span span;
    bool fine = cursor_colour(cursor, &colour, &span);
    *value = (Value){.kind = VALUE_COLOUR,
                     .components = 5,
                     .v = {colour.red, colour.green, colour.blue, colour.filter, colour.transmit}};
    return fine;
}

static bool take_layer(Eval *ev, const AstNode *texture, Value *layers)
{
    ev->inner++;
    bool fine = ev->builder->texture_layer(ev, texture, layers);
    ev->inner--;
    return fine;
}

static bool take_whole(Cursor *cursor, const Wanted *wanted, Value *value)
{
    const AstNode *item = cursor_peek(cursor);
    if (item != NULL && item->kind == AST_WORD && word_class(item->symbol) == WORD_COLOUR) {
        return take_colour(cursor, value);
    }
    if (item != NULL && (item->kind == AST_BLOCK || item->kind == AST_ARRAY || item->kind == AST_FUNCTION)) {
        bool is_texture = item->kind == AST_BLOCK && item->symbol == W_texture, fine;
        cursor_skip(cursor);
        fine = eval_rvalue(cursor->ev, item, value);
        while (fine && is_texture && (item = cursor_peek(cursor)) != NULL && !cursor->is_cut &&
               item->kind == AST_BLOCK && item->symbol == W_texture) {
            cursor_skip(cursor);
            fine = take_layer(cursor->ev, item, value);
        }
        return fine;
    }
    return take_expression(cursor, wanted, value);
}

// What belongs to the call's scope is copied before the call ends.
static bool keep(Eval *ev, Value *value, Span span)
{
    value->name = SYMBOL_NONE;
    bool has_memory = value->kind == VALUE_STRING || value->kind == VALUE_ARRAY;
    return !has_memory || value_store(ev, value, &ev->scratch, span, value);
}

// Nothing may follow the value but its end; a directive ends numbers, vectors and colours that are not ended.
static bool finish(Cursor *cursor, const Wanted *wanted, const Value *value)
{
    Eval *ev = cursor->ev;
    const AstNode *rest = cursor_peek(cursor);
    bool is_expression = value->kind == VALUE_NUMBER || value_is_tuple(value);
    if (ev->inner == 0 && is_expression && cursor->ends == 0 && cursor->is_cut) {
        return fault_followed(ev, wanted);
    }
    return rest == NULL || eval_fault(ev, DIAG_E0213, rest->span, "the value has ended before this");
}

static bool take_value(Cursor *cursor, const Wanted *wanted, bool whole, Value *value)
{
    Eval *ev = cursor->ev;
    ev->value_ends = 0;
    ev->is_value_cut = false;
    bool fine = (whole ? take_whole(cursor, wanted, value) : take_expression(cursor, wanted, value)) &&
                keep(ev, value, wanted->span);
    bool is_cut = ev->is_value_cut;
    fine = fine && finish(cursor, wanted, value);
    ev->value_ends = cursor->ends;
    ev->is_value_cut = ev->inner == 0 && (is_cut || cursor->is_cut);
    return fine;
}

// Whether a `;` may end the value that is taken now; it may end none of those that are computed on the way.
static bool begin_end(Eval *ev, bool *outer)
{
    *outer = ev->takes_end;
    ev->takes_end = false;
    return *outer && ev->inner == 0;
}

static bool call_for_value(Eval *ev, const AstNode *call, bool whole, Value *value)
{
    Macro *macro;
    DiagFrame frame;
    bool outer;
    if (!macro_find(ev, call, &macro) || !eval_deepen(ev, CALL_WEIGHT, call->span)) {
        return false;
    }
    bool takes_end = begin_end(ev, &outer);
    bool fine = macro_enter(ev, call, macro, &frame);
    if (fine) {
        Cursor cursor;
        Wanted wanted = {call->span, eval_text(ev, call->symbol)};
        cursor_open(&cursor, ev, macro->is_torn ? NULL : macro->body->b, call->span);
        cursor.takes_end = takes_end;
        cursor.is_call = true;
        if (macro->is_torn && cursor.frame != NULL &&
            !cursor_push_text(&cursor, cursor.frame, macro->text, NULL)) {
            ev->faulty = true;
        }
        fine = take_value(&cursor, &wanted, whole, value);
        cursor_close(&cursor);
        macro_leave(ev);
    }
    eval_shallow(ev, CALL_WEIGHT);
    ev->takes_end = outer;
    return fine && !ev->stop;
}

bool macro_value(Eval *ev, const AstNode *call, bool whole, Value *value)
{
    return call_is_value(ev, call) ? call_value(ev, call, value) : call_for_value(ev, call, whole, value);
}

bool inline_value(Eval *ev, const AstNode *node, bool whole, Value *value)
{
    Cursor cursor;
    Wanted wanted = {node->span, NULL};
    unsigned initialiser = ev->initialiser;
    bool outer, takes_end = begin_end(ev, &outer);
    ev->initialiser = 0;
    cursor_open(&cursor, ev, node->a, node->span);
    cursor.takes_end = takes_end;
    bool fine = take_value(&cursor, &wanted, whole, value);
    cursor_close(&cursor);
    ev->initialiser = initialiser;
    ev->takes_end = outer;
    return fine && !ev->stop;
}
