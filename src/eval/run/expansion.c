// Tokens of a text whose directives are resolved while it is read, and fragments that are parsed from them.
//
// A stack of frames says where the next token comes from; fragments of the grammar are parsed from these, each by a
// parse of its own. Knows nothing of what directives mean.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "eval/run/expansion.h"

enum {
    NESTING_MAX = 100, // of fragments: each takes some 10 KiB of the stack
    FRAMES_MAX = 1000,
};

static Expansion *of_feed(const GrammarFeed *feed)
{
    return (Expansion *)feed;
}

// ---- faults

void expansion_fault_stray(Expansion *expansion, const Token *token)
{
    if (grammar_feed_may_report(&expansion->feed)) {
        const Eval *ev = expansion_eval(expansion);
        diag_report(ev->options.diags, DIAG_E0106, token->span, "`#%s` without the directive that it belongs to",
                    eval_text(ev, grammar_directive_word(token->kind)));
    }
    expansion_fail(expansion);
}

void expansion_fault_unclosed(Expansion *expansion, const Token *token)
{
    if (grammar_feed_may_report(&expansion->feed)) {
        const Eval *ev = expansion_eval(expansion);
        const char *word = eval_text(ev, grammar_directive_word(token->kind));
        if (diag_report(ev->options.diags, DIAG_E0107, expansion->feed.end,
                        "the file ends before the `#end` of `#%s`", word)) {
            diag_note(ev->options.diags, token->span, "`#%s` opened here", word);
        }
    }
    expansion_fail(expansion);
}

// ---- frames

static CursorFrame *top(const Expansion *expansion)
{
    return expansion->cursor->frame;
}

CursorFrame *expansion_push(Expansion *expansion, FrameKind kind, const Token *opened_by)
{
    unsigned place = top(expansion)->text.place;
    if (place >= FRAMES_MAX) {
        grammar_feed_fault(&expansion->feed, DIAG_E0601, opened_by->span, "directives nest too deeply here");
        return NULL;
    }
    CursorFrame *frame = cursor_push(expansion->cursor, kind, NULL, NULL);
    if (frame == NULL) {
        expansion_fail(expansion);
        return NULL;
    }
    frame->is_text = true;
    frame->text = (FrameText){.opened_by = *opened_by, .place = place + 1};
    return frame;
}

void frame_set_text(CursorFrame *frame, const GrammarText *text, GrammarText *owned)
{
    frame->text.owned = owned;
    frame->text.tokens = text->tokens;
    frame->text.count = text->count;
}

// The text continues, in the frames above.
static void leave(Expansion *expansion, CursorFrame *frame)
{
    frame_leave(expansion->cursor, frame);
    frame->kind = FRAME_LEFT;
}

void expansion_drop(Expansion *expansion, CursorFrame *frame)
{
    CursorFrame **link = &expansion->cursor->frame;
    while (*link != frame) {
        (*link)->text.place--;
        link = &(*link)->outer;
    }
    CursorFrame *above = expansion->cursor->frame;
    leave(expansion, frame);
    if (above != frame) {
        *link = frame->outer;
        frame_free(expansion->cursor, frame);
    }
    while (top(expansion)->kind == FRAME_LEFT) {
        cursor_pop(expansion->cursor);
    }
}

void expansion_drop_from(Expansion *expansion, const CursorFrame *frame)
{
    const CursorFrame *rest = frame == expansion->bottom ? frame : frame->outer;
    while (top(expansion) != rest) {
        cursor_pop(expansion->cursor);
    }
    while (top(expansion)->kind == FRAME_LEFT) {
        cursor_pop(expansion->cursor);
    }
    if (frame == expansion->bottom) {
        expansion->bottom->text.at = expansion->bottom->text.count;
    }
}

CursorFrame *expansion_owner_of_middle(const Expansion *expansion)
{
    for (CursorFrame *frame = top(expansion); frame != expansion->bottom; frame = frame->outer) {
        if (frame->kind >= FRAME_WHILE && frame->kind != FRAME_LEFT) {
            return frame;
        }
        if (frame->kind != FRAME_INCLUDE && frame->kind != FRAME_LEFT) {
            break;
        }
    }
    return NULL;
}

// The innermost frame that has tokens.
static CursorFrame *innermost(const Expansion *expansion)
{
    CursorFrame *frame = top(expansion);
    while (frame != expansion->bottom && !frame_has_text(frame)) {
        frame = frame->outer;
    }
    return frame;
}

static bool is_kept(const Expansion *expansion, const CursorFrame *frame)
{
    return frame->kind == FRAME_ITEMS || (frame == expansion->bottom && frame->kind != FRAME_LIVE);
}

unsigned expansion_own_place(const Expansion *expansion)
{
    const CursorFrame *frame = innermost(expansion);
    return expansion->feed.live != NULL && is_kept(expansion, frame) ? 1 : frame->text.place;
}

static size_t expansion_open_directives(const Expansion *expansion)
{
    size_t count = 0;
    for (const CursorFrame *frame = top(expansion); frame != expansion->bottom; frame = frame->outer) {
        count += frame->kind >= FRAME_WHILE && frame->kind <= FRAME_SWITCH;
    }
    return count;
}

// ---- tokens as they stand

static void read_from(Expansion *expansion, const CursorFrame *frame, const Token *token)
{
    GrammarFeed *feed = &expansion->feed;
    feed->end = token->span;
    feed->place = frame->text.place;
    feed->is_kept = is_kept(expansion, frame);
    feed->is_call = frame->kind == FRAME_MACRO && !feed->is_kept;
}

void expansion_read(Expansion *expansion, Token *token)
{
    GrammarFeed *feed = &expansion->feed;
    while (!feed->failed) {
        CursorFrame *frame = innermost(expansion);
        if (frame->kind == FRAME_LIVE) {
            grammar_live_read(feed->live, token);
            read_from(expansion, frame, token);
            return;
        }
        if (frame->text.at < frame->text.count) {
            *token = frame->text.tokens[frame->text.at++];
            read_from(expansion, frame, token);
            return;
        }
        if (frame == expansion->bottom) {
            break;
        }
        bool is_last = frame == top(expansion);
        bool is_unbalanced = frame->kind != FRAME_INCLUDE && frame->kind != FRAME_ITEMS && !is_last;
        if (is_unbalanced || frame->kind == FRAME_WHILE || frame->kind == FRAME_FOR) {
            expansion_fault_unclosed(expansion, &top(expansion)->text.opened_by);
            break;
        }
        if (is_last) {
            expansion_drop(expansion, frame);
        } else {
            leave(expansion, frame);
        }
    }
    *token = (Token){.kind = GRAMMAR_END_OF_TEXT, .span = {feed->end.end, feed->end.end}};
}

void expansion_unread(Expansion *expansion, const Token *token)
{
    CursorFrame *frame = innermost(expansion);
    if (token->kind == GRAMMAR_END_OF_TEXT) {
        return;
    }
    if (frame->kind == FRAME_LIVE) {
        grammar_live_unread(expansion->feed.live, token);
    } else if (frame->text.at > 0) {
        frame->text.at--;
    }
}

int expansion_peek(Expansion *expansion)
{
    const CursorFrame *frame = top(expansion);
    while (!(frame->kind == FRAME_LIVE || (frame_has_text(frame) && frame->text.at < frame->text.count))) {
        if (frame == expansion->bottom) {
            return GRAMMAR_END_OF_TEXT;
        }
        frame = frame->outer;
    }
    if (frame->kind != FRAME_LIVE) {
        return frame->text.tokens[frame->text.at].kind;
    }
    Token token;
    grammar_live_read(expansion->feed.live, &token);
    grammar_live_unread(expansion->feed.live, &token);
    return token.kind;
}

bool expansion_skip(Expansion *expansion, const Token *opener, unsigned depth, bool stops_between, Tokens *kept,
                    Token *last)
{
    for (;;) {
        expansion_read(expansion, last);
        if (last->kind == GRAMMAR_END_OF_TEXT) {
            expansion_fault_unclosed(expansion, opener);
            return false;
        }
        if (kept != NULL && !ARRAY_PUSH(kept, *last)) {
            grammar_feed_fault(&expansion->feed, DIAG_E0602, last->span, "out of memory while reading the scene");
            return false;
        }
        DirectiveRole role = grammar_role(last->kind);
        if (role == ROLE_OPENS) {
            depth++;
        } else if (role == ROLE_END && --depth == 0) {
            return true;
        } else if (stops_between && depth == 1 && (role == ROLE_ELSE || role == ROLE_MIDDLE)) {
            return true;
        }
    }
}

bool expansion_is_at_call(Expansion *expansion, const Token *token)
{
    const GrammarHooks *hooks = expansion->feed.context->hooks;
    return grammar_is_name(token->kind) && hooks->is_macro(hooks->client, token->symbol) &&
           expansion_peek(expansion) == '(';
}

// ---- what the grammar calls

static void feed_read(GrammarFeed *feed, Token *token)
{
    expansion_read(of_feed(feed), token);
}

static void feed_unread(GrammarFeed *feed, const Token *token)
{
    expansion_unread(of_feed(feed), token);
}

static int feed_peek(GrammarFeed *feed)
{
    return expansion_peek(of_feed(feed));
}

static bool feed_is_before(GrammarFeed *feed, int kind)
{
    Expansion *expansion = of_feed(feed);
    const CursorFrame *frame = innermost(expansion);
    bool has_more = frame->kind == FRAME_LIVE || is_kept(expansion, frame) || frame->text.at < frame->text.count;
    return has_more && expansion_peek(expansion) == kind;
}

static void feed_resolve(GrammarFeed *feed, const Token *token)
{
    Expansion *expansion = of_feed(feed);
    DirectiveRole role = grammar_role(token->kind);
    bool is_part = role == ROLE_ELSE || role == ROLE_MIDDLE || role == ROLE_END;
    if (is_part && expansion->is_in_head && expansion_open_directives(expansion) <= expansion->head_open) {
        expansion_fault_stray(expansion, token); // it began before the head that it stands in
    } else if (role != ROLE_NONE) {
        text_directive(expansion, token);
    } else {
        text_call(expansion, token);
    }
}

// What a directive declares belongs to the scope of the text in which it began, which is not left before.
static bool feed_is_at_end(GrammarFeed *feed, unsigned place)
{
    Expansion *expansion = of_feed(feed);
    CursorFrame *frame;
    while ((frame = innermost(expansion))->text.place > place && frame == top(expansion)) {
        if ((frame->kind != FRAME_MACRO && frame->kind != FRAME_INCLUDE) || frame->text.at < frame->text.count) {
            return false;
        }
        expansion_drop(expansion, frame);
    }
    return frame->text.place == place && frame->kind != FRAME_LIVE && frame->text.at == frame->text.count;
}

static const GrammarFeedCalls feed_calls = {
    .read = feed_read,
    .unread = feed_unread,
    .peek = feed_peek,
    .is_before = feed_is_before,
    .resolve = feed_resolve,
    .is_at_end = feed_is_at_end,
};

Expansion *expansion_begin(Cursor *cursor, GrammarState *live, bool within)
{
    Eval *ev = cursor->ev;
    CursorFrame *frame = cursor->frame;
    Expansion *expansion = calloc(1, sizeof *expansion);
    if (expansion == NULL) {
        eval_no_memory(ev, cursor->span);
        return NULL;
    }
    lint_give_up(ev); // the names in this text are not all seen as items
    expansion->feed.context = ev->grammar;
    expansion->feed.calls = &feed_calls;
    expansion->feed.live = live;
    expansion->cursor = cursor;
    expansion->within = within;
    expansion->bottom = frame;
    frame->is_text = true;
    frame->text.place = 1;
    cursor->expansion = expansion;
    if (frame->text.count > 0) {
        expansion->feed.end = frame->text.tokens[0].span;
    }
    return expansion;
}

void expansion_end(Cursor *cursor)
{
    free(cursor->expansion);
    cursor->expansion = NULL;
}

// ---- fragments

// Where a head ends in a text that its directive is not in, POV-Ray loses its names: it refuses what follows, or
// crashes.
static bool ends_elsewhere(const Expansion *expansion, FragmentKind kind, unsigned head, unsigned counter)
{
    unsigned last = expansion_own_place(expansion);
    bool is_elsewhere = kind == FRAGMENT_FOR && (last > head || counter > head);
    for (const CursorFrame *frame = top(expansion); frame != expansion->bottom; frame = frame->outer) {
        bool is_between = frame->text.place > head && frame->text.place <= last;
        is_elsewhere = is_elsewhere || (is_between && frame->kind == FRAME_MACRO);
    }
    return is_elsewhere;
}

AstNode *expansion_parse(Expansion *expansion, FragmentKind kind, int base_depth, bool is_raw)
{
    Eval *ev = expansion_eval(expansion);
    GrammarFeed *feed = &expansion->feed;
    if (feed->failed) {
        return NULL;
    }
    if (ev->fragment_nesting >= NESTING_MAX) {
        grammar_feed_fault(feed, DIAG_E0601, feed->end,
                           "directives and calls nest too deeply inside each other here");
        return NULL;
    }
    Fragment fragment = {.kind = kind, .base_depth = base_depth, .is_raw = is_raw};
    bool is_head = kind >= FRAGMENT_CONDITION && kind <= FRAGMENT_FOR;
    const Expansion before = *expansion;
    unsigned head = expansion_own_place(expansion);
    size_t open = expansion_open_directives(expansion);
    expansion->head_place = is_head ? top(expansion)->text.place : before.head_place;
    expansion->is_in_head = is_head;
    expansion->head_open = open;
    expansion->is_open = true;
    ev->fragment_nesting++;
    AstNode *node = grammar_parse_fragment(feed, &fragment);
    if (node != NULL && is_head && expansion_open_directives(expansion) > open) {
        grammar_feed_fault(feed, DIAG_E0106, feed->end, "a directive in the head of another ends in it");
    } else if (node != NULL && is_head && ends_elsewhere(expansion, kind, head, fragment.counter_place)) {
        grammar_feed_fault(feed, DIAG_E0106, feed->end,
                           "the head of a directive ends in another text than it begins in");
    }
    ev->fragment_nesting--;
    expansion->is_open = before.is_open;
    expansion->head_place = before.head_place;
    expansion->head_open = before.head_open;
    expansion->is_in_head = before.is_in_head;
    expansion->is_cut = fragment.is_cut;
    feed->failed = feed->failed || node == NULL;
    return feed->failed ? NULL : node;
}
