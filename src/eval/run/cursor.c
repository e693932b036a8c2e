// The cursor: walks the items of a block as if the text of macros and branches stood there.
//
// Each loop, branch, call and included text that is being walked is a frame, innermost first; frames are taken from the
// program arena and used again. Owns the frames. Knows nothing of what the items mean.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "eval/run/expansion.h"
#include "eval/values/kept.h"

enum { CURSOR_WEIGHT = 4 }; // of native recursion, see eval_deepen

CursorFrame *cursor_push(Cursor *cursor, FrameKind kind, const AstNode *items, const AstNode *node)
{
    Eval *ev = cursor->ev;
    CursorFrame *frame = ev->free_frames;
    if (frame != NULL) {
        ev->free_frames = frame->outer;
    } else {
        frame = arena_alloc(&ev->program, sizeof *frame);
        if (frame == NULL) {
            eval_no_memory(ev, cursor->span);
            return NULL;
        }
    }
    frame->outer = cursor->frame;
    frame->next = items;
    frame->node = node;
    frame->kind = kind;
    frame->is_text = false;
    frame->ends_in_comma = false;
    cursor->frame = frame;
    return frame;
}

// What a frame has entered is left.
void frame_leave(Cursor *cursor, CursorFrame *frame)
{
    Eval *ev = cursor->ev;
    if (frame->kind == FRAME_MACRO) {
        macro_leave(ev);
    } else if (frame->kind == FRAME_INCLUDE) {
        scope_pop(ev);
        eval_frame_leave(ev);
        ev->include_depth--;
    }
    if (RT_UNLIKELY(frame->is_text)) {
        cursor->expansion->feed.macros -= frame->kind == FRAME_MACRO && frame != cursor->expansion->bottom;
        free(frame->text.owned);
        frame->text.owned = NULL;
    }
}

void frame_free(Cursor *cursor, CursorFrame *frame)
{
    frame->outer = cursor->ev->free_frames;
    cursor->ev->free_frames = frame;
}

void cursor_pop(Cursor *cursor)
{
    CursorFrame *frame = cursor->frame;
    if (RT_UNLIKELY(cursor->ev->explains_steps) && frame->kind == FRAME_WHILE && !frame->is_text) {
        endless_explain(cursor->ev, frame->node);
    }
    frame_leave(cursor, frame);
    if (RT_UNLIKELY(frame->is_text) && frame == cursor->expansion->bottom) {
        expansion_end(cursor);
    }
    cursor->frame = frame->outer;
    frame_free(cursor, frame);
}

void cursor_open(Cursor *cursor, Eval *ev, const AstNode *items, Span span)
{
    *cursor = (Cursor){.ev = ev, .span = span, .since = ev->kept.births};
    cursor->counted = eval_deepen(ev, CURSOR_WEIGHT, span);
    if (cursor->counted) {
        cursor_push(cursor, FRAME_ITEMS, items, NULL);
    }
}

void cursor_close(Cursor *cursor)
{
    while (cursor->frame != NULL) {
        cursor_pop(cursor);
    }
    if (cursor->included) {
        arena_rewind(&cursor->ev->parse, cursor->mark);
    }
    if (cursor->counted) {
        eval_shallow(cursor->ev, CURSOR_WEIGHT);
    }
    cursor->counted = cursor->included = false;
    cursor->item = NULL;
}

// The end of what a frame walks: another turn, the next case, or back to the frame around it.
static void end_of_frame(Cursor *cursor)
{
    CursorFrame *frame = cursor->frame;
    switch (frame->kind) {
    case FRAME_WHILE:
        if (loop_continues(cursor, frame)) {
            frame->next = frame->node->b;
            return;
        }
        break;
    case FRAME_FOR:
        if (loop_continues(cursor, frame)) {
            frame->next = frame->node->c;
            return;
        }
        break;
    case FRAME_SWITCH:
        if (case_continues(cursor->ev, frame)) {
            return;
        }
        break;
    default: break;
    }
    cursor_pop(cursor);
}

bool cursor_push_text(Cursor *cursor, CursorFrame *frame, const GrammarText *text, GrammarText *owned)
{
    Eval *ev = cursor->ev;
    if (!cursor->included && !cursor->top) {
        cursor->included = true;
        cursor->mark = arena_mark(&ev->parse);
    }
    frame->text = (FrameText){.begin = arena_mark(&ev->parse)};
    frame_set_text(frame, text, owned);
    if (expansion_begin(cursor, NULL, !cursor->top && ev->inner > 0) == NULL) {
        free(owned);
        return false;
    }
    return true;
}

// The next item of the text of the innermost frames.
static const AstNode *take_from_text(Cursor *cursor)
{
    Eval *ev = cursor->ev;
    Expansion *expansion = cursor->expansion;
    cursor->is_cut = cursor->is_cut || expansion->is_cut;
    // At the top level the items before this one are done with.
    if (cursor->top) {
        arena_rewind(&ev->parse, expansion->bottom->text.begin);
    }
    const AstNode *item = reading_item(expansion, 0);
    ev->faulty = ev->faulty || expansion->feed.failed;
    if (item == NULL) {
        expansion->bottom->ends_in_comma = expansion->ends_in_comma;
        while (cursor->frame != expansion->bottom) {
            cursor_pop(cursor);
        }
    }
    return item;
}

// The item that a frame has next.
static const AstNode *take_next(Cursor *cursor)
{
    if (RT_UNLIKELY(cursor->expansion != NULL)) {
        return take_from_text(cursor);
    }
    CursorFrame *frame = cursor->frame;
    const AstNode *item = frame->next;
    if (item != NULL) {
        frame->next = item->next;
        frame->ends_in_comma = item->flags & AST_BEFORE_COMMA;
    }
    return item;
}

CursorFrame *cursor_enter(Cursor *cursor, const AstNode *call, CursorFrame *frame, Macro *macro)
{
    if (frame == NULL) {
        return NULL;
    }
    if (!macro_enter(cursor->ev, call, macro, &frame->diag)) {
        cursor_pop(cursor);
        return NULL;
    }
    frame->kind = FRAME_MACRO;
    return frame;
}

static void expand(Cursor *cursor, const AstNode *call)
{
    Eval *ev = cursor->ev;
    cursor->at_call = cursor->after_value && !(call->flags & AST_AFTER_COMMA);
    Macro *macro;
    CursorFrame *frame;
    bool was_lossy = cursor->is_lossy;
    cursor->is_lossy = true;
    if (!macro_find(ev, call, &macro) ||
        (frame = cursor_enter(cursor, call, cursor_push(cursor, FRAME_ITEMS, NULL, call), macro)) == NULL) {
        return;
    }
    cursor->is_lossy = was_lossy;
    if (!macro->is_torn) {
        frame->next = macro->body->b;
    } else if (!cursor_push_text(cursor, frame, macro->text, NULL)) {
        cursor_pop(cursor);
    }
}

// The text of a macro that begins with a sign continues with the value before it, which has been taken as whole.
static void check_pasted_sign(Cursor *cursor, const AstNode *item)
{
    bool is_value = item->kind <= AST_MEMBER;
    if (RT_UNLIKELY(cursor->at_call) && is_value && !(item->flags & AST_AFTER_COMMA)) {
        const AstNode *first = item;
        while (first->kind == AST_BINARY && !(first->flags & AST_IN_PARENTHESES)) {
            first = first->a;
        }
        bool is_sign = first->kind == AST_UNARY && first->op != AST_OP_NOT && !(first->flags & AST_IN_PARENTHESES);
        if (is_sign) {
            eval_fault(cursor->ev, DIAG_E0110, item->span,
                       "the macro's text starts with a sign and would continue the expression before the call");
        }
    }
    cursor->at_call = false;
    cursor->after_value = is_value;
}

// The `;` after an item. It may only end the value of a declaration.
static void take_semicolon(Cursor *cursor, const AstNode *item)
{
    if (cursor->takes_end && item->kind < AST_DECLARE) {
        cursor->ends++;
    } else {
        eval_fault(cursor->ev, DIAG_E0106, (Span){item->span.end, item->span.end}, "unexpected `;`");
    }
}

// The comma before an item. Where directives and calls stand between two of them, the second is one too many.
static void take_comma(Cursor *cursor, Span span)
{
    if (cursor->has_comma) {
        eval_fault(cursor->ev, DIAG_E0259, span, "a comma stands here already");
    }
    cursor->has_comma = true;
}

const AstNode *cursor_advance(Cursor *cursor)
{
    Eval *ev = cursor->ev;
    cursor->has_comma = cursor->has_comma && cursor->frame == NULL;
    cursor->is_cut = cursor->is_cut && cursor->frame == NULL;
    while (cursor->frame != NULL && !ev->stop) {
        if (RT_UNLIKELY(kept_is_due(ev))) {
            scope_settle(ev, cursor->since);
        }
        const AstNode *item = take_next(cursor);
        if (item == NULL) {
            bool is_text = cursor->frame->kind == FRAME_MACRO || cursor->frame->kind == FRAME_INCLUDE;
            if (RT_UNLIKELY(cursor->frame->ends_in_comma)) {
                take_comma(cursor, cursor_end(cursor));
            }
            cursor->is_cut = cursor->is_cut || (cursor->frame->outer != NULL && !is_text);
            end_of_frame(cursor);
            continue;
        }
        if (RT_UNLIKELY(item->flags & AST_AFTER_COMMA)) {
            take_comma(cursor, item->span);
        }
        if (RT_UNLIKELY(item->flags & AST_BEFORE_SEMICOLON)) {
            take_semicolon(cursor, item);
        }
        bool is_plain = item->kind == AST_WORD || item->kind == AST_NUMBER || item->kind == AST_BLOCK;
        if (RT_LIKELY(is_plain && !cursor->at_call)) {
            cursor->after_value = item->kind == AST_NUMBER;
            cursor->item = item;
            return item;
        }
        if (is_in_initialiser(ev) && item->kind <= AST_MEMBER && begins_with_call(ev, item)) {
            (void)initialiser_fault(ev, item->span);
            continue;
        }
        if (item->kind == AST_CALL && !(item->flags & AST_KNOWN) && !call_is_value(ev, item)) {
            expand(cursor, item);
        } else if (!directive_run(cursor, item)) {
            check_pasted_sign(cursor, item);
            cursor->item = item;
            return item;
        } else {
            cursor->is_cut = true;
        }
    }
    return NULL;
}

void cursor_skip(Cursor *cursor)
{
    cursor->item = NULL;
}

void cursor_take_comma(Cursor *cursor)
{
    (void)cursor_peek(cursor);
    cursor->has_comma = false;
}

Span cursor_end(const Cursor *cursor)
{
    Span span = cursor->span;
    return span.end > span.begin ? (Span){span.end - 1, span.end} : span;
}

bool cursor_lacks_comma(Cursor *cursor, const char *where)
{
    const AstNode *item = cursor_peek(cursor);
    bool has_comma = cursor->has_comma && !cursor->ev->stop;
    cursor->has_comma = false;
    return !has_comma || eval_fault(cursor->ev, DIAG_E0259, item != NULL ? item->span : cursor_end(cursor),
                                    item != NULL ? "no comma is expected here in %s"
                                                 : "no comma is expected at the end of %s", where);
}

bool cursor_at_word(Cursor *cursor, Word word)
{
    const AstNode *item = cursor_peek(cursor);
    return item != NULL && item->kind == AST_WORD && item->symbol == (Symbol)word && !cursor->has_comma;
}

bool cursor_at_value(Cursor *cursor)
{
    const AstNode *item = cursor_peek(cursor);
    return item != NULL && (item->kind <= AST_MEMBER ||
                            (item->kind == AST_WORD && word_class(item->symbol) == WORD_COLOUR));
}

// The next item; NULL where there is none, or a comma before it that does not belong there, which is reported.
static const AstNode *take_item(Cursor *cursor, Span *span)
{
    const AstNode *item = cursor_peek(cursor);
    if (item != NULL) {
        *span = item->span;
        bool is_next = cursor_lacks_comma(cursor, "front of this value");
        cursor->item = NULL;
        return is_next ? item : NULL;
    }
    *span = cursor_end(cursor);
    if (!cursor->ev->stop && !cursor->is_lossy && !eval_follows_syntax(cursor->ev, cursor->span)) {
        (void)eval_fault(cursor->ev, DIAG_E0213, *span, "a value is missing at the end");
    }
    return NULL;
}

static bool take(Cursor *cursor, Value *value, Span *span)
{
    const AstNode *item = take_item(cursor, span);
    return item != NULL && eval_expression(cursor->ev, item, value);
}

bool cursor_value(Cursor *cursor, Value *value)
{
    Span span;
    return take(cursor, value, &span);
}

bool cursor_number(Cursor *cursor, double *number, Span *span)
{
    Value value;
    return take(cursor, &value, span) && value_number(cursor->ev, &value, *span, number);
}

bool cursor_vector3(Cursor *cursor, Vec3 *vector, Span *span)
{
    const AstNode *item = take_item(cursor, span);
    return item != NULL && eval_vector3(cursor->ev, item, vector);
}
