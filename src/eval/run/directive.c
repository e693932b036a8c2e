// Directives: what each one does when the walk through a block, or through the top level, comes to it.
//
// One function for each kind of directive, in a table; those of branches and loops are in control.c. Knows nothing of
// kinds of blocks.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/run/scope.h"
#include "eval/values/kept.h"

// Measured: before it numbers have operators in parentheses only, so that <1 -2 3> is a vector of three.
static const double VERSION_OF_OPERATORS = 1.5;

typedef void (*DirectiveFn)(Cursor *cursor, const AstNode *node);

// ---- declarations

// Before its end POV-Ray has read the name that comes next, which is the one that is being declared.
static bool runs_into_name(const AstNode *node)
{
    const AstNode *value = node->b->kind == AST_SEQUENCE ? node->b->a : node->b;
    bool is_open = value->kind == AST_ARRAY || (value->kind == AST_BLOCK && value->symbol == W_texture);
    return (node->flags & AST_BEFORE_NAME) && is_open;
}

// Since version 3.5 of the language numbers, vectors and colours end with a semicolon. So do functions and splines that
// have a name already; before 3.5 POV-Ray takes these without one where no directive comes next.
static bool needs_end(const Eval *ev, const AstNode *node, const Value *value)
{
    bool is_callable = value->kind == VALUE_FUNCTION || value->kind == VALUE_SPLINE;
    bool is_expression = value->kind == VALUE_NUMBER || value_is_tuple(value);
    return (is_expression && !(ev->version < 3.5)) || (is_callable && !ev->is_value_made) || runs_into_name(node);
}

// A second `;` may end numbers, vectors, colours and copies of functions and splines; none may follow the last directive
// of the value.
static bool has_too_many_ends(Eval *ev, const AstNode *node, const Value *value)
{
    Span last = {node->span.end - 1, node->span.end};
    bool is_callable = value->kind == VALUE_FUNCTION || value->kind == VALUE_SPLINE;
    bool takes_two = value->kind == VALUE_NUMBER || value_is_tuple(value) || (is_callable && !ev->is_value_made);
    unsigned after = node->flags & AST_ENDED_TWICE ? 2 : node->flags & AST_ENDED ? 1 : 0;
    if (after > 0 && ev->is_value_cut) {
        return !eval_fault(ev, DIAG_E0106, last, "unexpected `;`: the directive before it ends the declaration");
    }
    if (takes_two && after + ev->value_ends > 2) {
        return !eval_fault(ev, DIAG_E0106, last, "a third `;` cannot end %s", value_describe(value));
    }
    return !takes_two && after + ev->value_ends > 1 &&
           !eval_fault(ev, DIAG_E0106, last, "a second `;` may end a number, a vector or a colour, not %s",
                       value_describe(value));
}

static void check_end(Eval *ev, const AstNode *node, const Value *value)
{
    bool is_ended = (node->flags & AST_ENDED) || ev->value_ends > 0;
    if (has_too_many_ends(ev, node, value) || is_ended || !needs_end(ev, node, value)) {
        return;
    }
    Span end = {node->span.end > node->span.begin ? node->span.end - 1 : node->span.begin, node->span.end};
    if (!eval_report(ev, DIAG_E0205, end, "a `;` is missing after the declaration of %s", value_describe(value))) {
        return;
    }
    diag_suggest(ev->options.diags, "write `;` after it");
    diag_replace(ev->options.diags, (Span){end.end, end.end}, ";");
}

// After a fault the name is kept without a value, so that its uses are not reported as well.
static void forget_value(Eval *ev, const AstNode *target, bool local)
{
    const Value *known = scope_find(ev, target->symbol);
    bool is_free = target->kind == AST_NAME && (known == NULL || known->kind != VALUE_MACRO) &&
                   scope_array(ev, target->symbol) == NULL;
    ev->faulty = true;
    if (is_free && !scope_declare(ev, target->symbol, local, &(Value){.kind = VALUE_NONE}, target->span)) {
        ev->stop = true; // no memory even for that
    }
}

// What a declaration gives a value to: an element of an array, or else a name.
typedef struct Target {
    Value *element; // NULL: the name
    ValueArray *array;
    bool is_left; // the element keeps the value that it has
} Target;

// As measured: #local leaves an array that it finds further out as it is, unless no element of it was ever set.
static bool is_left(const Eval *ev, const AstNode *node, const ValueArray *array)
{
    const AstNode *base = node->a;
    while (base->kind == AST_INDEX) {
        base = base->a;
    }
    return node->op == AST_OP_LOCAL && array->first.kind != VALUE_NONE && scope_is_new(ev, base->symbol, true);
}

// Before the value is computed: the macros that are called in an index come first.
static bool find_target(Eval *ev, const AstNode *node, Target *target)
{
    *target = (Target){0};
    if (node->a->kind == AST_NAME) {
        return scope_declare_begin(ev, node->a->symbol, node->op == AST_OP_LOCAL, node->a->span);
    }
    bool is_found = array_locate(ev, node->a, &target->element, &target->array);
    target->is_left = is_found && is_left(ev, node, target->array);
    return is_found;
}

static bool assign(Eval *ev, const AstNode *node, const Target *target, const Value *value)
{
    if (target->is_left) {
        Value kept;
        return value_store(ev, value, &ev->scratch, node->b->span, &kept) &&
               array_takes(ev, target->array, target->element, &kept, node->b->span);
    }
    return target->element == NULL
               ? scope_declare(ev, node->a->symbol, node->op == AST_OP_LOCAL, value, node->a->span)
               : array_assign(ev, target->array, target->element, value, node->b->span);
}

// A name that is a number becomes another one. False: nothing was done.
static bool declare_number(Eval *ev, const AstNode *node)
{
    double number;
    const AstNode *target = node->a;
    if (target->kind != AST_NAME || (node->flags & (AST_ENDED | AST_UNREADABLE)) != AST_ENDED) {
        return false;
    }
    const Binding *binding = scope_binding(ev, target->symbol);
    Value *known = scope_number(binding);
    bool is_here = known != NULL && (node->op == AST_OP_DECLARE || binding->level == ev->scope->levels.count);
    if (!is_here || !quick_number(ev, node->b, &number)) {
        return false;
    }
    value_set_number(known, number);
    ev->value_ends = 0;
    ev->is_value_cut = false;
    return true;
}

static void run_declare(Cursor *cursor, const AstNode *node)
{
    Eval *ev = cursor->ev;
    Value value;
    Target target;
    if (declare_number(ev, node)) {
        return;
    }
    if (!find_target(ev, node, &target)) {
        ev->faulty = true;
        return;
    }
    ev->is_value_cut = ev->is_value_made = false;
    ev->value_ends = 0;
    ev->takes_end = true;
    unsigned scopes = ev->scopes_within; // of this name, not of those that macros in its value declare
    ev->scopes_within = 0;
    ev->at_colour = node->b->kind == AST_NAME && !(node->flags & AST_ENDED); // with a vector behind it
    bool fine = !(node->flags & AST_UNREADABLE) && eval_open_rvalue(ev, node->b, &value);
    ev->at_colour = ev->takes_end = false;
    ev->scopes_within = scopes;
    if (!fine) {
        forget_value(ev, node->a, node->op == AST_OP_LOCAL);
        return;
    }
    check_end(ev, node, &value);
    ev->is_value_made = ev->is_value_cut = false;
    ev->value_ends = 0;
    ev->faulty = !assign(ev, node, &target, &value) || ev->faulty;
}

static void run_undef(Cursor *cursor, const AstNode *node)
{
    Eval *ev = cursor->ev;
    if (node->a->kind == AST_NAME) {
        if (!scope_undef(ev, node->a->symbol)) {
            eval_warn(ev, DIAG_W0202, node->a->span, "`%s` is not declared", eval_text(ev, node->a->symbol));
        }
        return;
    }
    Value *element;
    ValueArray *array;
    if (array_locate(ev, node->a, &element, &array)) {
        if (array->arena == NULL && kept_is_owned(element)) {
            kept_retire(ev, element);
        }
        element->kind = VALUE_NONE;
    }
}

static void run_macro(Cursor *cursor, const AstNode *node)
{
    macro_define(cursor->ev, node, NULL);
}

static void run_default(Cursor *cursor, const AstNode *node)
{
    Eval *ev = cursor->ev;
    ev->faulty = !ev->builder->set_default(ev, node) || ev->faulty;
    ev->watch.state++;
}

static void run_version(Cursor *cursor, const AstNode *node)
{
    Eval *ev = cursor->ev;
    double version;
    const AstNode *first = node->a;
    while (first->kind == AST_BINARY && !(first->flags & AST_IN_PARENTHESES)) {
        first = first->a;
    }
    if (first->kind == AST_CALL && !(first->flags & AST_KNOWN) && !call_is_value(ev, first)) {
        eval_fault(ev, DIAG_E0202, first->span, "`#version` takes a number, not the call of a macro");
        return;
    }
    ev->inner++;
    bool fine = eval_number(ev, node->a, &version);
    ev->inner--;
    if (!fine) {
        return;
    }
    if (!(version <= 3.7 || numbers_equal(version, 3.7))) {
        eval_fault(ev, DIAG_E0212, node->a->span, "the scene asks for version %g of the language; this is 3.7",
                   version);
        return;
    }
    if (version < VERSION_OF_OPERATORS) {
        eval_fault(ev, DIAG_E0212, node->a->span, "before version 1.5 the language is another one; %g is not supported",
                   version);
        return;
    }
    if (node->flags & AST_BEFORE_NAME) {
        Span end = {node->span.end, node->span.end};
        if (eval_report(ev, DIAG_E0205, end, "a `;` is missing between `#version` and the call of a macro")) {
            diag_suggest(ev->options.diags, "write `;` after the number");
            diag_replace(ev->options.diags, end, ";");
        }
    }
    ev->version = version;
    ev->version_given = true;
    ev->watch.state++;
}

static void run_break(Cursor *cursor, const AstNode *node)
{
    control_break(cursor, node->span, false);
}

// ---- messages

static const EvalStream streams[AST_OP_COUNT] = {
    [AST_OP_DEBUG] = EVAL_STREAM_DEBUG,
    [AST_OP_RENDER] = EVAL_STREAM_RENDER,
    [AST_OP_STATISTICS] = EVAL_STREAM_STATISTICS,
};

// What is said, on one line.
static int one_line(const Value *value, char *line, size_t size)
{
    size_t length = value->length < size ? value->length : size - 1;
    for (size_t i = 0; i < length; i++) {
        line[i] = (unsigned char)value->text[i] < ' ' ? ' ' : value->text[i];
    }
    while (length > 0 && line[length - 1] == ' ') {
        length--;
    }
    return (int)length;
}

static void run_message(Cursor *cursor, const AstNode *node)
{
    Eval *ev = cursor->ev;
    Value value;
    char line[512];
    if (!eval_string(ev, node->a, &value)) {
        return;
    }
    if (node->op == AST_OP_WARNING) {
        int length = one_line(&value, line, sizeof line);
        eval_warn(ev, DIAG_W0201, node->span, "%.*s", length, line);
    } else if (node->op == AST_OP_ERROR) {
        int length = one_line(&value, line, sizeof line);
        eval_fault(ev, DIAG_E0211, node->span, "%.*s", length, line);
        ev->stop = true;
    } else {
        message_write(ev, streams[node->op], value.text, value.length, node->span);
    }
}

// ---- the table

static const DirectiveFn directives[AST_KIND_COUNT] = {
    [AST_DECLARE] = run_declare, [AST_UNDEF] = run_undef,     [AST_IF] = control_if,     [AST_IFDEF] = control_if,
    [AST_SWITCH] = control_switch, [AST_BREAK] = run_break, [AST_WHILE] = control_while, [AST_FOR] = control_for,
    [AST_MACRO] = run_macro,     [AST_INCLUDE] = include_run, [AST_DEFAULT] = run_default, [AST_VERSION] = run_version,
    [AST_MESSAGE] = run_message, [AST_FOPEN] = data_file_run, [AST_FCLOSE] = data_file_run, [AST_READ] = data_file_run,
    [AST_WRITE] = data_file_run,
};

bool directive_run(Cursor *cursor, const AstNode *node)
{
    DirectiveFn run = directives[node->kind];
    if (run == NULL) {
        return false;
    }
    if (is_in_initialiser(cursor->ev)) {
        (void)initialiser_fault(cursor->ev, node->span);
        return true;
    }
    ArenaMark mark = scratch_mark(cursor->ev);
    run(cursor, node);
    scratch_rewind(cursor->ev, mark);
    return true;
}
