// Pasting: an expression in which macros are called is read again with their text in it, where values would not do.
//
// A macro stands for its text: in `M() * 2` a body `1 + 2` means 1 + 2*2, and `<M(), 3>` may be a vector of three.
// Turns such an expression, found by its place in the source, into a value. Owns the texts that it keeps for the next
// time.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "eval/run/expansion.h"

static bool is_open_operation(const AstNode *node)
{
    bool is_operation = node->kind == AST_UNARY || node->kind == AST_BINARY || node->kind == AST_MEMBER;
    return is_operation && (node->flags & AST_PASTES) && !(node->flags & AST_IN_PARENTHESES);
}

// The macro that is called, or NULL.
static const Macro *called(const Eval *ev, const AstNode *part)
{
    bool is_call = part->kind == AST_CALL && part->b == NULL && !(part->flags & AST_IN_PARENTHESES);
    const Value *found = is_call ? scope_find(ev, part->symbol) : NULL;
    return found != NULL && found->kind == VALUE_MACRO ? found->macro : NULL;
}

static bool is_loose_part(const Eval *ev, const AstNode *part)
{
    const Macro *macro = part != NULL ? called(ev, part) : NULL;
    if (part == NULL || macro != NULL) {
        return macro != NULL && macro->is_loose;
    }
    return is_open_operation(part) && (is_loose_part(ev, part->a) || is_loose_part(ev, part->b));
}

bool paste_is_needed(const Eval *ev, const AstNode *node)
{
    bool is_list = node->kind == AST_VECTOR || node->kind == AST_CALL || node->kind == AST_BUILTIN;
    if (!is_list) {
        return is_loose_part(ev, node->a) || is_loose_part(ev, node->b);
    }
    const AstNode *before = NULL;
    for (const AstNode *part = node->a; part != NULL; before = part, part = part->next) {
        // A name and the parenthesis of its call may come from two texts.
        bool is_joined = (part->flags & AST_WITHOUT_COMMA) && (called(ev, part) != NULL || called(ev, before) != NULL);
        if (part->kind == AST_INLINE || is_joined || is_loose_part(ev, part)) {
            return true;
        }
    }
    return false;
}

// Items of a block are walked with their directives, wherever it stands.
static bool has_directive(const Eval *ev, const AstNode *node)
{
    bool has_primitives = node->kind != AST_NUMBER && !(node->flags & AST_KNOWN) && node->kind != AST_BLOCK;
    if (node->kind == AST_CALL && node->b == NULL) {
        const Value *found = scope_find(ev, node->symbol);
        if (found != NULL && found->kind == VALUE_MACRO) {
            return true;
        }
    }
    for (const AstNode *part = has_primitives ? node->a : NULL; part != NULL; part = part->next) {
        if (has_directive(ev, part)) {
            return true;
        }
    }
    return node->kind == AST_INLINE || (has_primitives && node->b != NULL && has_directive(ev, node->b)) ||
           (has_primitives && node->c != NULL && has_directive(ev, node->c));
}

bool paste_is_needed_in_function(const Eval *ev, const AstNode *function)
{
    return function->b != NULL && has_directive(ev, function->b);
}

// ---- texts, kept in order of their place

static size_t place_of(const Eval *ev, Span span)
{
    size_t low = 0, high = ev->pasted.count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        const PastedText *text = &ev->pasted.items[middle];
        bool is_before = text->begin < span.begin || (text->begin == span.begin && text->end < span.end);
        low = is_before ? middle + 1 : low;
        high = is_before ? high : middle;
    }
    return low;
}

static const GrammarText *text_of(Eval *ev, Span span)
{
    size_t at = place_of(ev, span);
    if (at < ev->pasted.count && ev->pasted.items[at].begin == span.begin && ev->pasted.items[at].end == span.end) {
        return ev->pasted.items[at].text;
    }
    GrammarContext context = {ev->options.names, &ev->parse, ev->options.diags, ev->options.limits, NULL,
                              ev->options.no_literals, NULL};
    GrammarText *read = grammar_text_again(&context, span);
    const GrammarText *kept = read != NULL ? grammar_text_copy(read, &ev->program) : NULL;
    free(read);
    if (kept == NULL || !ARRAY_PUSH(&ev->pasted, (PastedText){0})) {
        ev->faulty = true;
        return kept;
    }
    PastedText *items = ev->pasted.items;
    memmove(items + at + 1, items + at, (ev->pasted.count - 1 - at) * sizeof *items);
    items[at] = (PastedText){span.begin, span.end, kept};
    return kept;
}

// ---- values

static bool read_value(Eval *ev, const AstNode *node, Expansion *expansion, Value *value)
{
    const AstNode *read = reading_expression(expansion);
    if (read == NULL) {
        ev->faulty = true;
        return false;
    }
    if (expansion->is_cut) {
        if (eval_report(ev, DIAG_E0221, node->span, "a directive after the value of a macro ends the expression")) {
            diag_suggest(ev->options.diags, "put parentheses around the call");
        }
        return false;
    }
    bool is_ended = reading_take_semicolon(expansion), is_cut = expansion->is_cut;
    if (!eval_expression(ev, read, value)) {
        return false;
    }
    bool has_memory = value->kind == VALUE_STRING || value->kind == VALUE_ARRAY;
    if (has_memory && !value_store(ev, value, &ev->scratch, node->span, value)) {
        return false;
    }
    const AstNode *rest = reading_item(expansion, 0);
    bool failed = expansion->feed.failed;
    if (rest != NULL) {
        return eval_fault(ev, DIAG_E0213, node->span, "macros give more than one value here");
    }
    ev->faulty = ev->faulty || failed;
    ev->value_ends = is_ended;
    ev->is_value_cut = is_cut;
    return !failed;
}

// Begins to read a text, from a cursor that is closed after it; NULL after a fault.
static Expansion *begin(Eval *ev, Cursor *cursor, const AstNode *node, bool is_inner)
{
    *cursor = (Cursor){.ev = ev, .span = node->span, .top = true, .since = ev->kept.births};
    const GrammarText *text = text_of(ev, node->span);
    CursorFrame *frame = text != NULL ? cursor_push(cursor, FRAME_ITEMS, NULL, NULL) : NULL;
    if (frame == NULL) {
        return NULL;
    }
    frame->text = (FrameText){.owned = NULL};
    frame_set_text(frame, text, NULL);
    return expansion_begin(cursor, NULL, is_inner);
}

// Reads from the text of a node, its macros and directives carried out, by a function; the text is let go again.
static bool paste(Eval *ev, const AstNode *node, bool is_inner,
                  bool (*read)(Eval *ev, const AstNode *node, Expansion *expansion, Value *value), Value *value)
{
    Cursor cursor;
    ArenaMark mark = arena_mark(&ev->parse);
    Expansion *expansion = begin(ev, &cursor, node, is_inner);
    bool fine = expansion != NULL && read(ev, node, expansion, value);
    cursor_close(&cursor);
    arena_rewind(&ev->parse, mark);
    return fine && !ev->stop;
}

bool paste_value(Eval *ev, const AstNode *node, Value *value)
{
    bool takes_end = ev->takes_end;
    ev->takes_end = ev->is_value_cut = false;
    ev->value_ends = 0;
    bool fine = paste(ev, node, ev->inner > 0, read_value, value);
    ev->takes_end = takes_end;
    return fine && (ev->value_ends == 0 || (takes_end && ev->inner == 0) ||
                    eval_fault(ev, DIAG_E0106, node->span, "the text of a macro ends with a `;` here"));
}

const AstNode *paste_arguments(Eval *ev, const AstNode *call)
{
    Cursor cursor;
    Expansion *expansion = begin(ev, &cursor, call, false);
    AstNode *pasted = expansion != NULL ? reading_arguments(expansion) : NULL;
    if (pasted != NULL) {
        pasted->symbol = call->symbol;
        pasted->span = call->span;
    }
    cursor_close(&cursor);
    ev->faulty = ev->faulty || pasted == NULL;
    return pasted;
}

static bool read_function(Eval *ev, const AstNode *function, Expansion *expansion, Value *value)
{
    const AstNode *read = reading_item(expansion, 0); // the expansion holds its text
    bool fine = read != NULL && read->kind == AST_FUNCTION;
    if (fine) {
        AstNode made = *read;
        made.c = function->c; // its sizes may have been taken already
        fine = function_create(ev, &made, value);
    }
    const AstNode *rest = fine ? reading_item(expansion, 0) : NULL;
    bool failed = expansion->feed.failed;
    if (rest != NULL) {
        fine = eval_fault(ev, DIAG_E0213, rest->span, "the function has ended before this");
    }
    ev->faulty = ev->faulty || failed;
    return fine && !failed;
}

bool paste_function(Eval *ev, const AstNode *function, Value *value)
{
    return paste(ev, function, false, read_function, value);
}
