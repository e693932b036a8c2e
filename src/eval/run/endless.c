// Why a loop does not end: nothing that runs in it changes a name of its condition.
//
// Looks at the text alone, and only once too many steps were taken. Says nothing where a text may do more than it
// shows: calls in the condition, included files, macros that are read token by token.
//
// SPDX-License-Identifier: MIT
#include "eval/run/run.h"

enum { NAMES_MOST = 4, CALLS_MOST = 8 };

typedef struct Condition {
    Symbol names[NAMES_MOST];
    size_t count;
    bool is_open; // its value may change by itself, or it has too many names
} Condition;

static void collect(Condition *condition, const AstNode *first)
{
    for (const AstNode *node = first; node != NULL; node = node->next) {
        bool is_known = false;
        for (size_t i = 0; i < condition->count; i++) {
            is_known = is_known || condition->names[i] == node->symbol;
        }
        condition->is_open |= node->kind == AST_CALL || node->kind == AST_INLINE ||
                              (node->kind == AST_BUILTIN && node->symbol == W_rand) ||
                              (node->kind == AST_NAME && !is_known && condition->count == NAMES_MOST);
        if (node->kind == AST_NAME && !is_known && condition->count < NAMES_MOST) {
            condition->names[condition->count++] = node->symbol;
        }
        if (node->kind != AST_NUMBER && node->kind != AST_NAME) {
            collect(condition, node->a);
            collect(condition, node->b);
            collect(condition, node->c);
        }
    }
}

static bool may_change(Eval *ev, const AstNode *first, Symbol name, unsigned calls);

static bool names(const AstNode *target, Symbol name)
{
    while (target->kind == AST_INDEX) {
        target = target->a;
    }
    return target->kind == AST_NAME && target->symbol == name;
}

static bool any_names(const AstNode *first, Symbol name)
{
    for (const AstNode *node = first; node != NULL; node = node->next) {
        if (names(node, name)) {
            return true;
        }
    }
    return false;
}

// The macro's own text, and a variable that is passed to it, which it may change.
static bool call_may_change(Eval *ev, const AstNode *call, Symbol name, unsigned calls)
{
    const Value *found = call->symbol != SYMBOL_NONE ? scope_find(ev, call->symbol) : NULL;
    if (found == NULL || found->kind != VALUE_MACRO) {
        return false; // functions change nothing
    }
    return calls == 0 || found->macro->is_torn || any_names(call->a, name) ||
           may_change(ev, found->macro->body->b, name, calls - 1);
}

static bool may_change(Eval *ev, const AstNode *first, Symbol name, unsigned calls)
{
    for (const AstNode *node = first; node != NULL; node = node->next) {
        bool does;
        switch (node->kind) {
        case AST_NUMBER:
        case AST_PACKED:
        case AST_NAME: continue;
        case AST_INCLUDE: return true;
        case AST_DECLARE:
        case AST_UNDEF: does = names(node->a, name); break;
        case AST_FOR: does = node->a != NULL && names(node->a, name); break;
        case AST_READ: does = any_names(node->b, name); break;
        case AST_CALL: does = call_may_change(ev, node, name, calls); break;
        default: does = (node->flags & AST_PASTES) != 0; break;
        }
        if (does || may_change(ev, node->a, name, calls) || may_change(ev, node->b, name, calls) ||
            may_change(ev, node->c, name, calls)) {
            return true;
        }
    }
    return false;
}

void endless_explain(Eval *ev, const AstNode *loop)
{
    Condition condition = {.count = 0};
    collect(&condition, loop->a);
    bool changes = condition.is_open || condition.count == 0;
    for (size_t i = 0; i < condition.count && !changes; i++) {
        changes = may_change(ev, loop->b, condition.names[i], CALLS_MOST);
    }
    if (changes) {
        return;
    }
    TextBuffer text;
    text_init(&text);
    for (size_t i = 0; i < condition.count; i++) {
        text_printf(&text, "%s`%s`", i == 0 ? "" : i + 1 == condition.count ? " or " : ", ",
                    eval_text(ev, condition.names[i]));
    }
    diag_note(ev->options.diags, loop->a->span, "nothing in the loop changes %s", text_get(&text));
    text_fini(&text);
    ev->explains_steps = false;
}
