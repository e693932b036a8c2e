// Names and what they stand for: globals, and levels of locals for each macro call and included file.
//
// A table indexed by Symbol holds the innermost meaning of each name, and each meaning knows the one that it hides, so
// a look-up is one step whatever the nesting. A callee sees its caller's locals, as in POV-Ray. Owns the table and the
// locals; globals stand in the program arena. Knows nothing of syntax.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "eval/run/scope.h"
#include "eval/values/kept.h"

// So many names are looked at for suggestions in a run: a scene of a million names and faults gets no more.
enum { LOOKED_AT_MOST = 1 << 26 };

bool scope_init(Eval *ev)
{
    ev->scope = calloc(1, sizeof *ev->scope);
    if (ev->scope == NULL) {
        return false;
    }
    arena_init_shared(&ev->scope->arena, &ev->memory);
    return true;
}

void scope_fini(Eval *ev)
{
    if (ev->scope != NULL) {
        arena_fini(&ev->scope->arena);
        ARRAY_FREE(&ev->scope->innermost);
        ARRAY_FREE(&ev->scope->levels);
        free(ev->scope);
    }
    ev->scope = NULL;
}

bool scope_push(Eval *ev, Span span)
{
    Scope *scope = ev->scope;
    Level level = {.mark = arena_mark(&scope->arena)};
    return ARRAY_PUSH(&scope->levels, level) || eval_no_memory(ev, span);
}

// How many parameters stand for a variable: for an element of an array, or else for a name.
static unsigned *references_to(Value *variable, ValueArray *array)
{
    return array != NULL ? &array->reference_count : &((Binding *)variable)->reference_count;
}

void scope_pop(Eval *ev)
{
    Scope *scope = ev->scope;
    Level *level = &scope->levels.items[scope->levels.count - 1];
    for (Binding *local = level->locals; local != NULL; local = local->next) {
        if (local->name != SYMBOL_NONE) {
            scope->innermost.items[local->name] = local->hidden;
        }
        if (local->is_counted) {
            *references_to(local->variable, local->array) -= 1;
        }
        if (RT_UNLIKELY(kept_is_owned(&local->own)) && !local->is_retired) {
            kept_give_back(ev, &local->own);
        }
    }
    memory_rewind(&scope->arena, level->mark);
    scope->levels.count--;
}

Value *scope_find(const Eval *ev, Symbol name)
{
    return scope_look(ev, name);
}

EvalNames scope_count(const Eval *ev)
{
    EvalNames names = {0};
    for (size_t i = 0; ev->scope != NULL && i < ev->scope->innermost.count; i++) {
        const Binding *binding = ev->scope->innermost.items[i];
        if (binding != NULL && binding->level == 0 && binding->is_given) {
            names.declared++;
            names.unused += !binding->is_used;
        }
    }
    return names;
}

ValueArray *scope_array(const Eval *ev, Symbol name)
{
    const Binding *binding = scope_binding(ev, name);
    return binding != NULL ? binding->array : NULL;
}

bool scope_is_reference(const Eval *ev, Symbol name)
{
    const Binding *binding = scope_binding(ev, name);
    return binding != NULL && binding->variable != &binding->own;
}

static bool make_room(Eval *ev, Symbol name, Span span)
{
    Scope *scope = ev->scope;
    if (name < scope->innermost.count) {
        return true;
    }
    size_t wanted = intern_count(ev->options.names);
    if (!ARRAY_RESERVE(&scope->innermost, wanted)) {
        return eval_no_memory(ev, span);
    }
    memset(scope->innermost.items + scope->innermost.count, 0,
           (wanted - scope->innermost.count) * sizeof *scope->innermost.items);
    scope->innermost.count = wanted;
    return true;
}

// That of the text in which a #local stands.
static size_t own_level(const Eval *ev)
{
    return ev->scope->levels.count - ev->scopes_within;
}

// A global is made only when the name has no meaning at all, so hiding is from further in, but for a #local whose value
// ends inside of a call.
static Binding *make(Eval *ev, Symbol name, size_t level, Span span)
{
    Scope *scope = ev->scope;
    if (!make_room(ev, name, span)) {
        return NULL;
    }
    bool is_innermost = level > 0 && level == scope->levels.count;
    Binding *binding = level == 0 ? scope->spare : NULL;
    if (binding != NULL) {
        scope->spare = binding->next;
    } else {
        binding = arena_alloc(is_innermost ? &scope->arena : &ev->program, sizeof *binding);
    }
    if (binding == NULL) {
        eval_no_memory(ev, span);
        return NULL;
    }
    binding->own.kind = VALUE_NONE; // the rest of it is not looked at
    binding->own.name = SYMBOL_NONE;
    binding->variable = &binding->own;
    binding->array = NULL;
    Binding **place = &scope->innermost.items[name];
    while (RT_UNLIKELY(*place != NULL && (*place)->level > level)) {
        place = &(*place)->hidden;
    }
    binding->hidden = *place;
    binding->next = NULL;
    binding->name = name;
    binding->level = (uint32_t)level;
    binding->is_given = span.end > 0;
    binding->is_used = binding->is_counted = binding->is_retired = false;
    binding->reference_count = 0;
    if (level > 0) {
        binding->next = scope->levels.items[level - 1].locals;
        scope->levels.items[level - 1].locals = binding;
    }
    *place = binding;
    return binding;
}

static Binding *find_or_make(Eval *ev, Symbol name, bool local, Span span)
{
    size_t level = own_level(ev);
    Binding *binding = scope_binding(ev, name);
    while (local && binding != NULL && binding->level > level) {
        binding = binding->hidden;
    }
    if (binding == NULL || (local && binding->level != level)) {
        return make(ev, name, local ? level : 0, span);
    }
    return binding;
}

// A function keeps its name, and no other value's name becomes a function's, until #undef.
static bool may_replace(Eval *ev, const Value *known, const Value *value, Symbol name, Span span)
{
    bool was_function = known->kind == VALUE_FUNCTION;
    bool is_new = known->kind <= VALUE_UNSET || value->kind == VALUE_NONE;
    if (is_new || (!was_function && value->kind != VALUE_FUNCTION)) {
        return true;
    }
    if (eval_report(ev, DIAG_E0262, span, "`%s` is %s and cannot become %s%s", eval_text(ev, name),
                    value_describe(known), was_function && value->kind == VALUE_FUNCTION ? "another " : "",
                    was_function && value->kind == VALUE_FUNCTION ? "function" : value_describe(value))) {
        diag_suggest(ev->options.diags, "write `#undef %s` before it", eval_text(ev, name));
    }
    return false;
}

bool scope_is_new(const Eval *ev, Symbol name, bool local)
{
    const Binding *binding = scope_binding(ev, name);
    return binding == NULL || (local && binding->level != own_level(ev));
}

bool scope_declare_begin(Eval *ev, Symbol name, bool local, Span span)
{
    if (RT_LIKELY(!scope_is_new(ev, name, local))) {
        return true;
    }
    const Binding *outer = scope_binding(ev, name);
    if (outer != NULL && (outer->variable->kind == VALUE_MACRO || outer->variable->kind == VALUE_FUNCTION)) {
        return true; // it is not hidden
    }
    Binding *binding = make(ev, name, local ? own_level(ev) : 0, span);
    if (binding != NULL) {
        binding->own = (Value){.kind = VALUE_UNSET};
    }
    return binding != NULL;
}

bool scope_declare(Eval *ev, Symbol name, bool local, const Value *value, Span span)
{
    const Binding *outer = scope_binding(ev, name);
    if (outer != NULL && outer->variable->kind == VALUE_MACRO) { // #local hides none
        return eval_fault(ev, DIAG_E0206, span, "`%s` is a macro and cannot become %s", eval_text(ev, name),
                          value_describe(value));
    }
    Binding *binding = find_or_make(ev, name, local, span);
    if (binding == NULL) {
        return false;
    }
    if (binding->variable->kind == VALUE_FILE) {
        return eval_fault(ev, DIAG_E0268, span, "`%s` is an open file and cannot become %s", eval_text(ev, name),
                          value_describe(value));
    }
    if (!may_replace(ev, binding->variable, value, name, span)) {
        return false;
    }
    if (binding->array != NULL) {
        return array_assign(ev, binding->array, binding->variable, value, span);
    }
    Value kept;
    if (!value_store(ev, value, NULL, span, &kept)) {
        return false;
    }
    kept_replace(ev, binding->variable, &kept);
    return true;
}

bool scope_bind_value(Eval *ev, Symbol name, const Value *value, Span span)
{
    Binding *binding = make(ev, name, ev->scope->levels.count, span);
    if (binding != NULL && value->kind == VALUE_NUMBER) {
        value_set_number(&binding->own, value->number);
        return true;
    }
    return binding != NULL && value_store(ev, value, NULL, span, &binding->own);
}

bool scope_bind_reference(Eval *ev, Symbol name, Value *variable, ValueArray *array, Span span)
{
    // An argument after it may have undefined its name, whose value is gone after the call began.
    if (RT_UNLIKELY(array == NULL && ((Binding *)variable)->is_retired)) {
        return scope_bind_value(ev, name, variable, span);
    }
    Binding *binding = make(ev, name, ev->scope->levels.count, span);
    if (binding == NULL) {
        return false;
    }
    binding->variable = variable;
    binding->array = array;
    binding->is_counted = array == NULL || array->arena == NULL;
    if (binding->is_counted) {
        *references_to(variable, array) += 1;
    }
    return true;
}

bool scope_define_macro(Eval *ev, Macro *macro)
{
    Binding *binding = scope_binding(ev, macro->name);
    if (binding == NULL) {
        binding = make(ev, macro->name, 0, macro->span);
    } else if (binding->variable->kind != VALUE_MACRO) {
        return eval_fault(ev, DIAG_E0206, macro->span, "`%s` is %s and cannot become a macro",
                          eval_text(ev, macro->name), value_describe(binding->variable));
    }
    if (binding == NULL) {
        return false;
    }
    *binding->variable = (Value){.kind = VALUE_MACRO, .macro = macro};
    return true;
}

static void retire_own(Eval *ev, Binding *binding)
{
    if (kept_is_owned(&binding->own) && !binding->is_retired) {
        kept_retire(ev, &binding->own);
    }
    binding->is_retired = true;
}

bool scope_undef(Eval *ev, Symbol name)
{
    Binding *binding = scope_binding(ev, name);
    if (binding == NULL) {
        return false;
    }
    ev->scope->innermost.items[name] = binding->hidden;
    binding->name = SYMBOL_NONE;
    if (binding->reference_count == 0) {
        retire_own(ev, binding);
    }
    // A local is still in the list of its level.
    if (binding->level == 0) {
        binding->next = ev->scope->undefined;
        ev->scope->undefined = binding;
        ev->kept.retired_bytes += sizeof *binding;
    }
    return true;
}

void scope_settle(Eval *ev, uint64_t since)
{
    Scope *scope = ev->scope;
    // A parameter of a call, or an argument of one that is about to begin, may stand for one of them.
    bool is_outermost = since == 0 && scope->levels.count == 0;
    while (is_outermost && scope->undefined != NULL) {
        Binding *binding = scope->undefined;
        scope->undefined = binding->next;
        retire_own(ev, binding);
        binding->next = scope->spare;
        scope->spare = binding;
    }
    kept_settle(ev, since);
}

Suggest scope_nearest(const Eval *ev, const AstNode *node)
{
    Suggest suggest;
    Scope *scope = ev->scope;
    WordClass wanted = node->kind == AST_CALL ? WORD_BUILTIN : WORD_CONSTANT;
    suggest_begin(&suggest, eval_text(ev, node->symbol));
    bool has_budget = scope->looked_at < LOOKED_AT_MOST;
    scope->looked_at += has_budget ? scope->innermost.count : 0;
    for (Symbol symbol = 1; has_budget && symbol < scope->innermost.count; symbol++) {
        const Binding *binding = ev->scope->innermost.items[symbol];
        if (binding != NULL && binding->variable->kind != VALUE_UNSET) {
            suggest_offer(&suggest, eval_text(ev, symbol));
        }
    }
    for (Symbol word = 1; word < WORD_COUNT; word++) {
        WordClass class = word_class(word);
        if (class == wanted || (class == WORD_COLOUR && ev->at_colour)) {
            suggest_offer(&suggest, eval_text(ev, word));
        }
    }
    return suggest;
}
