// Directives and calls that stand in a text: what each one does to the frames of its cursor.
//
// Macros that are called and files that are included give their tokens; what stands alone is parsed and run like any
// other. Knows nothing of branches and loops.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "eval/run/expansion.h"
#include "eval/values/kept.h"

// ---- macros and files

// A part of a directive that began outside of the body.
static const Token *find_stray(const Tokens *kept)
{
    unsigned depth = 0;
    for (size_t i = 0; i < kept->count; i++) {
        DirectiveRole role = grammar_role(kept->items[i].kind);
        if (depth == 0 && (role == ROLE_ELSE || role == ROLE_MIDDLE)) {
            return &kept->items[i];
        }
        depth += role == ROLE_OPENS;
        depth -= role == ROLE_END && depth > 0;
    }
    return NULL;
}

// The head is read again from what was kept; its text is kept, too, and parsed as well where it holds whole items.
static void define_kept(Expansion *expansion, const Token *directive, const Tokens *kept)
{
    Eval *ev = expansion_eval(expansion);
    CursorFrame *frame = expansion_push(expansion, FRAME_ITEMS, directive);
    if (frame == NULL) {
        return;
    }
    frame->text.tokens = kept->items;
    frame->text.count = kept->count;
    AstNode *definition = expansion_parse(expansion, FRAGMENT_MACRO, GRAMMAR_NO_BASE, true);
    size_t begin = frame->text.at;
    expansion_drop(expansion, frame);
    if (definition == NULL) {
        return;
    }
    definition->span = span_join(directive->span, kept->items[kept->count - 1].span);
    GrammarText *body = grammar_text_new(kept->items + begin, kept->count - 1 - begin);
    AstNode *whole = grammar_text_macro(expansion->feed.context, directive, kept->items, kept->count);
    if (body != NULL) {
        macro_define(ev, whole != NULL ? whole : definition, body);
    }
    if (body == NULL || ev->stop) {
        expansion_fail(expansion);
    }
    free(body);
}

static void define_macro(Expansion *expansion, const Token *directive)
{
    Eval *ev = expansion_eval(expansion);
    Tokens kept = {0};
    Token last;
    ArenaMark mark = arena_mark(&ev->parse);
    bool is_whole = expansion_skip(expansion, directive, 1, false, &kept, &last);
    const Token *stray = is_whole ? find_stray(&kept) : NULL;
    if (stray != NULL) {
        expansion_fault_stray(expansion, stray);
    } else if (is_whole) {
        define_kept(expansion, directive, &kept);
    }
    arena_rewind(&ev->parse, mark);
    ARRAY_FREE(&kept);
}

// A call whose arguments stand next becomes the macro's text.
void text_call(Expansion *expansion, const Token *name)
{
    Eval *ev = expansion_eval(expansion);
    Cursor *cursor = expansion->cursor;
    ArenaMark mark = arena_mark(&ev->parse);
    AstNode *call = expansion_parse(expansion, FRAGMENT_ARGUMENTS, 1, false);
    if (call == NULL) {
        return;
    }
    call->symbol = name->symbol;
    call->span = span_join(name->span, call->span);
    Macro *macro;
    const GrammarText *text = macro_find(ev, call, &macro) ? macro_text(ev, macro) : NULL;
    CursorFrame *frame =
        text != NULL ? cursor_enter(cursor, call, expansion_push(expansion, FRAME_ITEMS, name), macro) : NULL;
    arena_rewind(&ev->parse, mark);
    if (frame == NULL) {
        ev->faulty = true;
        expansion_fail(expansion);
        return;
    }
    frame_set_text(frame, text, NULL);
    expansion->feed.macros++;
    expansion->feed.silent = *name;
}

// A file inside an item gives its text; what stands between items is evaluated item by item.
static void include_file(Expansion *expansion, const Token *directive)
{
    Eval *ev = expansion_eval(expansion);
    Cursor *cursor = expansion->cursor;
    ArenaMark mark = arena_mark(&ev->parse);
    bool is_inside = expansion->is_open || expansion->within || !cursor->top;
    expansion_unread(expansion, directive);
    AstNode *node = expansion_parse(expansion, FRAGMENT_DIRECTIVE, 0, false);
    if (node != NULL && !is_inside) {
        directive_run(cursor, node);
    }
    CursorFrame *frame =
        node != NULL && is_inside ? expansion_push(expansion, FRAME_ITEMS, directive) : NULL;
    Source *source = frame != NULL ? include_enter(ev, frame, node) : NULL;
    arena_rewind(&ev->parse, mark);
    if (source == NULL) {
        if (frame != NULL) {
            cursor_pop(cursor);
        }
        expansion->feed.failed = expansion->feed.failed || ev->stop;
        return;
    }
    GrammarText *text = grammar_text_read(expansion->feed.context, source);
    source_close(source);
    if (text == NULL) {
        cursor_pop(cursor);
        expansion_fail(expansion);
        return;
    }
    frame_set_text(frame, text, text);
}

// ---- the other directives

// Calls and files that began in a text, given by its place, and have not ended.
static unsigned scopes_since(const Expansion *expansion, unsigned place)
{
    unsigned count = 0;
    for (const CursorFrame *frame = expansion->cursor->frame; frame->text.place > place; frame = frame->outer) {
        count += frame->kind == FRAME_MACRO || frame->kind == FRAME_INCLUDE;
        if (frame == expansion->bottom) {
            break;
        }
    }
    return count;
}

// The first place among expressions where a name was read, or NULL.
static const AstNode *find_name(const AstNode *node, Symbol name)
{
    const AstNode *found = NULL;
    for (; node != NULL && found == NULL; node = node->next) {
        bool is_leaf = node->kind == AST_NUMBER || node->kind == AST_NAME;
        found = node->kind == AST_NAME && node->symbol == name ? node : NULL;
        found = found == NULL && !is_leaf ? find_name(node->a, name) : found;
        found = found == NULL && !is_leaf ? find_name(node->b, name) : found;
        found = found == NULL && !is_leaf && !(node->flags & AST_KNOWN) ? find_name(node->c, name) : found;
    }
    return found;
}

// Its value was computed before the name is made, which in POV-Ray is the other way round.
static bool uses_hidden(Eval *ev, const AstNode *directive)
{
    const AstNode *target = directive->a;
    bool is_new = directive->kind == AST_DECLARE && directive->op == AST_OP_LOCAL && target->kind == AST_NAME &&
                  scope_is_new(ev, target->symbol, true);
    const AstNode *use = is_new ? find_name(directive->b, target->symbol) : NULL;
    return use != NULL && !name_fault_unset(ev, use);
}

static bool may_run(Eval *ev, const AstNode *directive, bool within)
{
    if (within && directive->kind == AST_DEFAULT) {
        return eval_fault(ev, DIAG_E0111, directive->span,
                          "`#default` cannot stand inside an item whose text directives tear apart");
    }
    return !uses_hidden(ev, directive);
}

static void run_simple(Expansion *expansion, const Token *directive)
{
    Eval *ev = expansion_eval(expansion);
    bool within = expansion->is_open || expansion->within;
    if (RT_UNLIKELY(kept_is_due(ev))) {
        scope_settle(ev, expansion->cursor->since);
    }
    ArenaMark mark = arena_mark(&ev->parse);
    expansion_unread(expansion, directive);
    unsigned own = expansion_own_place(expansion);
    AstNode *node = expansion_parse(expansion, FRAGMENT_DIRECTIVE, 0, false);
    if (node != NULL && may_run(ev, node, within)) {
        ev->scopes_within = node->kind == AST_DECLARE ? scopes_since(expansion, own) : 0;
        directive_run(expansion->cursor, node);
        ev->scopes_within = 0;
        expansion->feed.failed = expansion->feed.failed || ev->stop;
    } else {
        expansion_fail(expansion);
    }
    arena_rewind(&ev->parse, mark);
}

void text_directive(Expansion *expansion, const Token *directive)
{
    switch (grammar_directive_word(directive->kind)) {
    case W_if:
    case W_ifdef:
    case W_ifndef: control_begin_if(expansion, directive); break;
    case W_elseif:
    case W_else:
    case W_case:
    case W_range: control_between(expansion, directive); break;
    case W_end: control_end(expansion, directive); break;
    case W_switch: control_begin_switch(expansion, directive); break;
    case W_break: control_break(expansion->cursor, directive->span, false); break;
    case W_while: control_begin_while(expansion, directive); break;
    case W_for: control_begin_for(expansion, directive); break;
    case W_macro: define_macro(expansion, directive); break;
    case W_include: include_file(expansion, directive); break;
    default: run_simple(expansion, directive); break;
    }
}
