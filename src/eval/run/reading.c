// Items and expressions from text whose directives are resolved while it is read, and what the grammar asks meanwhile.
//
// Runs directives and calls up to the next item, and parses it. A value that was read is kept in the parse arena,
// beside the node that stands for it.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "eval/run/expansion.h"

// ---- what names and expressions are

// A copy that outlives the scope in which the value stands.
static const Value *keep(Eval *ev, const Value *value, Span span)
{
    Value *kept = arena_alloc(&ev->parse, sizeof *kept);
    if (kept == NULL) {
        eval_no_memory(ev, span);
        return NULL;
    }
    *kept = *value;
    bool has_memory = value->kind == VALUE_STRING || value->kind == VALUE_ARRAY;
    if (has_memory && !value_store(ev, value, &ev->parse, span, kept)) {
        kept->kind = VALUE_NONE;
    }
    kept->name = value->name;
    return kept;
}

static Eval *eval_of(void *client)
{
    Eval *ev = client;
    lint_give_up(ev); // the names in this text are not all seen as items
    return ev;
}

static const void *capture(void *client, Symbol name, Span span)
{
    Eval *ev = eval_of(client);
    const Value *found = scope_find(ev, name);
    if (found == NULL) {
        return NULL;
    }
    Value value = *found;
    value.name = name;
    return keep(ev, &value, span);
}

static bool is_number(void *client, const void *captured)
{
    const Value *value = captured;
    (void)client;
    return value->kind == VALUE_NUMBER || value_is_tuple(value);
}

static bool is_macro(void *client, Symbol name)
{
    const Value *found = scope_find(eval_of(client), name);
    return found != NULL && found->kind == VALUE_MACRO;
}

static bool lacks_index(void *client, const AstNode *element)
{
    unsigned count = 0;
    for (; element->kind == AST_INDEX; element = element->a) {
        count++;
    }
    const Value *found = element->kind == AST_NAME ? scope_find(eval_of(client), element->symbol) : NULL;
    return found != NULL && found->kind == VALUE_ARRAY && count < found->array->dimension_count;
}

static bool takes_braces(void *client, Symbol word)
{
    const Eval *ev = eval_of(client);
    return ev->builder->takes_braces(ev, word);
}

static bool is_unbalanced(void *client, Symbol name)
{
    const Value *found = scope_find(eval_of(client), name);
    return found != NULL && found->kind == VALUE_MACRO && found->macro->is_unbalanced;
}

// A sum that begins with an object is two arguments of a macro, see macro.c.
static bool begins_with_object(const Eval *ev, const AstNode *node)
{
    while (node->kind == AST_BINARY && !(node->flags & AST_IN_PARENTHESES)) {
        node = node->a;
    }
    const Value *value = node->kind != AST_NAME       ? NULL
                         : node->flags & AST_KNOWN ? node->known
                                                   : scope_find(ev, node->symbol);
    return value != NULL && value->kind == VALUE_BLOCK;
}

static bool fold(void *client, AstNode *node)
{
    Eval *ev = eval_of(client);
    Value value;
    if (node->kind == AST_BINARY && begins_with_object(ev, node)) {
        return !ev->stop;
    }
    ArenaMark mark = arena_mark(&ev->scratch);
    if (!eval_expression(ev, node, &value)) {
        ev->faulty = true;
        value = (Value){.kind = VALUE_NONE};
    }
    node->known = keep(ev, &value, node->span);
    if (node->known != NULL) {
        ast_flag(node, AST_KNOWN);
    }
    arena_rewind(&ev->scratch, mark);
    return !ev->stop;
}

// ---- items

static int base_of_items(const Expansion *expansion)
{
    return expansion->within ? GRAMMAR_NO_BASE : 0;
}

// What was read again is at its end: the live text continues.
static void leave_kept(Expansion *expansion)
{
    CursorFrame *frame = expansion->cursor->frame;
    bool is_kept = frame->outer == expansion->bottom && frame->kind == FRAME_ITEMS;
    if (frame != expansion->bottom && is_kept && frame->text.at == frame->text.count) {
        expansion_drop(expansion, frame);
    }
}

static AstNode *parse_item(Expansion *expansion, bool has_comma)
{
    AstNode *item = expansion_parse(expansion, FRAGMENT_ITEM, base_of_items(expansion), false);
    bool is_ended = item != NULL && expansion->feed.live == NULL && reading_take_semicolon(expansion);
    unsigned flags = (has_comma ? AST_AFTER_COMMA : 0) | (is_ended ? AST_BEFORE_SEMICOLON : 0);
    return item != NULL ? ast_flag(item, flags) : NULL;
}

AstNode *reading_item(Expansion *expansion, uint64_t past)
{
    GrammarFeed *feed = &expansion->feed;
    bool has_comma = false;
    Span comma = {0};
    while (!feed->failed) {
        if (feed->live != NULL) {
            leave_kept(expansion);
        }
        const CursorFrame *top = expansion->cursor->frame;
        bool is_done = feed->live != NULL && top == expansion->bottom && feed->end.begin >= past &&
                       grammar_live_is_before(feed->live, past);
        Token token = {0};
        if (!is_done) {
            expansion_read(expansion, &token);
        }
        if (has_comma && feed->live != NULL && token.kind == GRAMMAR_END_OF_TEXT) {
            grammar_feed_fault(feed, DIAG_E0259, comma, "no comma is expected here");
        }
        if (is_done) {
            return NULL;
        }
        if (token.kind == GRAMMAR_END_OF_TEXT) {
            expansion->ends_in_comma = has_comma;
            top = expansion->cursor->frame;
            if (top != expansion->bottom && !frame_has_text(top)) {
                expansion_fault_unclosed(expansion, &top->text.opened_by);
            }
            return NULL;
        }
        if (grammar_is_directive(token.kind)) {
            text_directive(expansion, &token);
        } else if (expansion_is_at_call(expansion, &token)) {
            text_call(expansion, &token);
        } else if (token.kind == ',' && !has_comma) {
            has_comma = true;
            comma = token.span;
        } else {
            expansion_unread(expansion, &token);
            return parse_item(expansion, has_comma);
        }
    }
    return NULL;
}

AstNode *reading_expression(Expansion *expansion)
{
    return expansion_parse(expansion, FRAGMENT_EXPRESSION, base_of_items(expansion), false);
}

AstNode *reading_arguments(Expansion *expansion)
{
    Token name;
    expansion_read(expansion, &name);
    return expansion_parse(expansion, FRAGMENT_ARGUMENTS, 1, false);
}

bool reading_take_semicolon(Expansion *expansion)
{
    Token token;
    if (expansion->feed.failed || expansion_peek(expansion) != ';') {
        return false;
    }
    expansion_read(expansion, &token);
    expansion->is_cut = grammar_is_directive(expansion_peek(expansion));
    return true;
}

// ---- statements that directives tear apart

// What stands before the tear is read again, and the rest as the parse's scanner gives it.
static bool push_torn(Expansion *expansion, uint64_t begin, const Token *torn)
{
    if (begin >= torn->span.begin) {
        return true;
    }
    GrammarText *text = grammar_text_again(expansion->feed.context, (Span){begin, torn->span.begin});
    CursorFrame *frame = text != NULL ? expansion_push(expansion, FRAME_ITEMS, torn) : NULL;
    if (frame == NULL) {
        expansion_fail(expansion);
        free(text);
        return false;
    }
    frame_set_text(frame, text, text);
    return true;
}

static bool read_torn(void *client, GrammarState *live, uint64_t begin, const Token *torn, bool *is_refused)
{
    Eval *ev = eval_of(client);
    Cursor cursor = {.ev = ev, .top = true, .since = ev->kept.births};
    CursorFrame *frame = cursor_push(&cursor, FRAME_LIVE, NULL, NULL);
    if (frame == NULL) {
        return false;
    }
    frame->text = (FrameText){.owned = NULL};
    Expansion *expansion = expansion_begin(&cursor, live, false);
    bool fine = expansion != NULL;
    if (fine) {
        expansion->feed.end = (Span){begin, begin};
        AstNode *item = NULL;
        bool goes_on = push_torn(expansion, begin, torn);
        while (goes_on && (item = reading_item(expansion, torn->span.begin)) != NULL) {
            goes_on = grammar_live_emit(live, item);
        }
        fine = !expansion->feed.failed;
        *is_refused = expansion->feed.is_refused;
    }
    cursor_close(&cursor);
    return fine;
}

// ---- what the grammar is given

typedef struct Reading {
    GrammarContext context;
    GrammarHooks hooks;
} Reading;

bool reading_init(Eval *ev)
{
    Reading *reading = arena_alloc(&ev->program, sizeof *reading);
    if (reading == NULL) {
        return false;
    }
    *reading = (Reading){
        .context = {ev->options.names, &ev->parse, ev->options.diags, ev->options.limits, &reading->hooks,
                    ev->options.no_literals, &ev->has_mark},
        .hooks = {.client = ev,
                  .takes_braces = takes_braces,
                  .is_macro = is_macro,
                  .is_unbalanced = is_unbalanced,
                  .has_unbalanced = &ev->has_unbalanced,
                  .read_torn = read_torn,
                  .capture = capture,
                  .is_number = is_number,
                  .lacks_index = lacks_index,
                  .fold = fold},
    };
    ev->builder->plan_hooks(ev, &reading->hooks);
    ev->grammar = &reading->context;
    return true;
}
