// #include: reads a file's text and hands its items to the cursor that came to the directive.
//
// At the top level text is evaluated item by item while it is read; inside a block all its items are read first. Knows
// nothing of where files are: that is files.c.
//
// SPDX-License-Identifier: MIT
#include "eval/run/run.h"

static bool take_item(void *client, const AstNode *item)
{
    Eval *ev = client;
    lint_items(ev, item);
    eval_item(ev, item);
    return !span_exists(ev->break_at) && !eval_cancelled(ev);
}

static bool enter(Eval *ev, DiagFrame *frame, const Source *source, Span span)
{
    if (!scope_push(ev, span)) {
        return false;
    }
    ev->include_depth++;
    eval_frame_enter(ev, frame, "included", source_name(source), span);
    return true;
}

// At the top level: item by item.
static void stream(Eval *ev, Source *source, Span span)
{
    DiagFrame frame;
    if (!enter(ev, &frame, source, span)) {
        return;
    }
    // What it finds stands in the diagnostics, which decide in the end.
    bool is_whole = grammar_parse(ev->grammar, source, take_item, ev);
    ev->faulty = ev->faulty || (!is_whole && !span_exists(ev->break_at));
    scope_pop(ev);
    eval_frame_leave(ev);
    ev->include_depth--;
}

// A text with items that directives tear apart is read again, item by item.
static void read_again(Cursor *cursor, CursorFrame *frame, const Source *source)
{
    Eval *ev = cursor->ev;
    GrammarText *text = grammar_text_again(ev->grammar, source_extent(source));
    frame->next = NULL;
    if (text == NULL || !cursor_push_text(cursor, frame, text, text)) {
        ev->faulty = true;
    }
}

// Inside a block: all items, kept until the block is closed.
static void keep(Cursor *cursor, Source *source, Span span)
{
    Eval *ev = cursor->ev;
    AstList items = {0};
    if (!cursor->included) {
        cursor->included = true;
        cursor->mark = arena_mark(&ev->parse);
    }
    CursorFrame *frame = cursor_push(cursor, FRAME_ITEMS, NULL, NULL);
    if (frame == NULL || !enter(ev, &frame->diag, source, span)) {
        return;
    }
    frame->kind = FRAME_INCLUDE;
    bool is_torn = false;
    bool is_whole = grammar_parse_all(ev->grammar, source, &items, &is_torn);
    lint_items(ev, items.first);
    frame->next = items.first;
    if (is_torn) {
        read_again(cursor, frame, source);
    } else {
        ev->faulty = ev->faulty || !is_whole;
    }
}

enum { WORK_OF_A_BYTE = 16 }; // of text that is parsed

static Source *open_included(Eval *ev, const AstNode *node)
{
    Source *source = NULL;
    if (ev->include_depth >= ev->options.limits->include_depth) {
        eval_fault(ev, DIAG_E0603, node->a->span, "includes nest deeper than %u levels: does a file include itself?",
                   ev->options.limits->include_depth);
        ev->stop = true;
        return NULL;
    }
    if (node->a->kind == AST_VECTOR && !(node->a->flags & AST_KNOWN)) {
        if (eval_report(ev, DIAG_E0202, node->a->span, "expected a string, found a vector")) {
            diag_suggest(ev->options.diags, "the name of a file stands between two `\"`");
        }
        ev->faulty = true;
        return NULL;
    }
    if (!file_open(ev, node->a, FILE_INCLUDE, &source)) {
        return NULL;
    }
    // What is read once is work in proportion to the files that there are.
    Span text = source_extent(source);
    if (source_is_again(source) && !eval_work(ev, WORK_OF_A_BYTE * (text.end - text.begin), node->span)) {
        source_close(source);
        return NULL;
    }
    ev->memory.limit = limits_memory(ev->options.limits, source_map_bytes(ev->options.sources));
    return source;
}

Source *include_enter(Eval *ev, CursorFrame *frame, const AstNode *node)
{
    Source *source = open_included(ev, node);
    if (source == NULL) {
        return NULL;
    }
    if (!enter(ev, &frame->diag, source, node->span)) {
        source_close(source);
        return NULL;
    }
    frame->kind = FRAME_INCLUDE;
    return source;
}

void include_run(Cursor *cursor, const AstNode *node)
{
    Eval *ev = cursor->ev;
    Source *source = open_included(ev, node);
    if (source == NULL) {
        return;
    }
    if (cursor->top) {
        stream(ev, source, node->span);
        Span span = ev->break_at;
        ev->break_at = SPAN_NONE;
        if (span_exists(span)) {
            control_break(cursor, span, true);
        }
    } else {
        keep(cursor, source, node->span);
    }
    source_close(source);
}
