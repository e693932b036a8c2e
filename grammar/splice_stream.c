// The stream of a splice: frames of text that tokens come from, and fragments that are parsed from them.
//
// Turns kept or live tokens into one sequence: a stack of frames says where the next token comes from. Fragments of the
// grammar are parsed from it, each with a GrammarState of its own. Knows nothing of what directives mean.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "grammar/splice.h"

enum {
    NESTING_MAX = 100, // of fragments: each takes some 10 KiB of the stack
    FRAMES_MAX = 1000,
};

// ---- faults

void stream_fail(GrammarStream *stream)
{
    stream->failed = true;
}

void stream_fault(GrammarStream *stream, DiagCode code, Span span, const char *text)
{
    if (!grammar_stream_is_refused(stream, stream->end)) {
        diag_report(stream->context->diags, code, span, "%s", text);
    }
    stream_fail(stream);
}

void stream_fault_stray(GrammarStream *stream, const Token *token)
{
    if (!stream->failed && !grammar_stream_is_refused(stream, stream->end)) {
        diag_report(stream->context->diags, DIAG_E0106, token->span, "`#%s` without the directive that it belongs to",
                    intern_get(stream->context->names, grammar_directive_word(token->kind)));
    }
    stream_fail(stream);
}

void stream_fault_unclosed(GrammarStream *stream, const Token *token)
{
    if (stream->failed || grammar_stream_is_refused(stream, stream->end)) {
        return;
    }
    const char *word = intern_get(stream->context->names, grammar_directive_word(token->kind));
    DiagSink *diags = stream->context->diags;
    if (diag_report(diags, DIAG_E0107, stream->end, "the file ends before the `#end` of `#%s`", word)) {
        diag_note(diags, token->span, "`#%s` opened here", word);
    }
    stream_fail(stream);
}

// ---- frames

Frame *stream_push(GrammarStream *stream, FrameKind kind, const Token *opened_by)
{
    if (stream->frames.count >= FRAMES_MAX) {
        stream_fault(stream, DIAG_E0601, opened_by->span, "directives nest too deeply here");
        return NULL;
    }
    if (!ARRAY_PUSH(&stream->frames, (Frame){.kind = kind, .opened_by = *opened_by})) {
        stream_fault(stream, DIAG_E0602, opened_by->span, "out of memory while reading the scene");
        return NULL;
    }
    return &stream->frames.items[stream->frames.count - 1];
}

static void leave(GrammarStream *stream, Frame *frame)
{
    if (frame->kind == FRAME_MACRO || frame->kind == FRAME_FILE) {
        stream->hooks->leave(stream->hooks->client);
    }
    free(frame->owned);
    frame->owned = NULL;
    frame->kind = FRAME_LEFT;
}

void stream_drop(GrammarStream *stream, size_t at)
{
    Frame *frame = &stream->frames.items[at];
    leave(stream, frame);
    memmove(frame, frame + 1, (stream->frames.count - at - 1) * sizeof *frame);
    stream->frames.count--;
    while (stream->frames.count > 0 && stream->frames.items[stream->frames.count - 1].kind == FRAME_LEFT) {
        stream->frames.count--;
    }
}

void stream_drop_to(GrammarStream *stream, size_t count)
{
    while (stream->frames.count > count) {
        stream_drop(stream, stream->frames.count - 1);
    }
}

size_t stream_owner_of_middle(const GrammarStream *stream)
{
    for (size_t i = stream->frames.count; i > 0; i--) {
        FrameKind kind = stream->frames.items[i - 1].kind;
        if (kind >= FRAME_WHILE && kind != FRAME_LEFT) {
            return i - 1;
        }
        if (kind != FRAME_FILE && kind != FRAME_LEFT) {
            break;
        }
    }
    return stream->frames.count;
}

size_t stream_innermost_text(const GrammarStream *stream)
{
    size_t at = stream->frames.count;
    while (at > 0 && !frame_has_text(&stream->frames.items[at - 1])) {
        at--;
    }
    return at;
}

// ---- tokens as they stand

void stream_deliver_end(const GrammarStream *stream, Token *token)
{
    *token = (Token){.kind = TOKEN_END_OF_FILE, .span = {stream->end.end, stream->end.end}};
}

void stream_read(GrammarStream *stream, Token *token)
{
    size_t at;
    while (!stream->failed && (at = stream_innermost_text(stream)) > 0) {
        Frame *frame = &stream->frames.items[at - 1];
        if (frame->kind == FRAME_LIVE) {
            grammar_read_token(stream->live, token);
            stream->end = token->span;
            return;
        }
        if (frame->at < frame->count) {
            *token = frame->tokens[frame->at++];
            stream->end = token->span;
            return;
        }
        bool is_unbalanced = frame->kind != FRAME_FILE && frame->kind != FRAME_TEXT && at < stream->frames.count;
        if (is_unbalanced || frame->kind == FRAME_WHILE || frame->kind == FRAME_FOR) {
            stream_fault_unclosed(stream, &stream->frames.items[stream->frames.count - 1].opened_by);
            break;
        }
        if (at < stream->frames.count) {
            leave(stream, frame);
        } else {
            stream_drop(stream, at - 1);
        }
    }
    stream_deliver_end(stream, token);
}

void stream_unread(GrammarStream *stream, const Token *token)
{
    size_t at = stream_innermost_text(stream);
    if (at == 0 || token->kind == TOKEN_END_OF_FILE) {
        return;
    }
    Frame *frame = &stream->frames.items[at - 1];
    if (frame->kind == FRAME_LIVE) {
        grammar_hold_token(stream->live, *token);
    } else if (frame->at > 0) {
        frame->at--;
    }
}

int stream_peek_kind(GrammarStream *stream)
{
    size_t at = stream->frames.count;
    const Frame *frame = NULL;
    while (at > 0) {
        frame = &stream->frames.items[--at];
        if (frame->kind == FRAME_LIVE) {
            break;
        }
        if (frame_has_text(frame) && frame->at < frame->count) {
            return frame->tokens[frame->at].kind;
        }
        frame = NULL;
    }
    if (frame == NULL) {
        return TOKEN_END_OF_FILE;
    }
    Token token;
    grammar_read_token(stream->live, &token);
    grammar_hold_token(stream->live, token);
    return token.kind;
}

bool stream_is_before(GrammarStream *stream, int kind)
{
    size_t at = stream_innermost_text(stream);
    const Frame *frame = at > 0 ? &stream->frames.items[at - 1] : NULL;
    bool has_more = frame != NULL && (frame->kind == FRAME_LIVE || frame->kind == FRAME_TEXT || frame->at < frame->count);
    return has_more && stream_peek_kind(stream) == kind;
}

// ---- skipping and keeping

bool stream_skip(GrammarStream *stream, const Token *opener, unsigned depth, bool stops_between, Tokens *kept,
                 Token *last)
{
    for (;;) {
        stream_read(stream, last);
        if (last->kind == TOKEN_END_OF_FILE) {
            stream_fault_unclosed(stream, opener);
            return false;
        }
        if (kept != NULL && !ARRAY_PUSH(kept, *last)) {
            stream_fault(stream, DIAG_E0602, last->span, "out of memory while reading the scene");
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

bool stream_keep_to_end(GrammarStream *stream, const Token *opener, Tokens *kept)
{
    Token last;
    return stream_skip(stream, opener, 1, false, kept, &last);
}

GrammarText *grammar_text_new(const Token *tokens, size_t count)
{
    GrammarText *text = malloc(sizeof *text + count * sizeof *tokens);
    if (text != NULL) {
        text->count = count;
        if (count > 0) {
            memcpy(text->tokens, tokens, count * sizeof *tokens);
        }
    }
    return text;
}

GrammarText *grammar_text_copy(const GrammarText *text, Arena *arena)
{
    return arena_copy(arena, text, sizeof *text + text->count * sizeof *text->tokens);
}

size_t stream_own_text(const GrammarStream *stream)
{
    size_t at = stream_innermost_text(stream);
    return stream->live != NULL && at > 0 && stream->frames.items[at - 1].kind == FRAME_TEXT ? 1 : at;
}

unsigned stream_scopes_since(const GrammarStream *stream, size_t text)
{
    unsigned count = 0;
    for (size_t i = text; i < stream->frames.count; i++) {
        count += stream->frames.items[i].kind == FRAME_MACRO || stream->frames.items[i].kind == FRAME_FILE;
    }
    return count;
}

size_t stream_open_directives(const GrammarStream *stream)
{
    size_t count = 0;
    for (size_t i = 0; i < stream->frames.count; i++) {
        count += stream->frames.items[i].kind >= FRAME_WHILE && stream->frames.items[i].kind <= FRAME_SWITCH;
    }
    return count;
}

// ---- fragments

bool stream_is_head(int start)
{
    return start == TOKEN_START_CONDITION || start == TOKEN_START_SUBJECT || start == TOKEN_START_RANGE ||
           start == TOKEN_START_FOR;
}

// Where a head ends in a text that its directive is not in, POV-Ray loses its names: it refuses what follows, or crashes.
static bool ends_elsewhere(const GrammarStream *stream, int start, size_t head, size_t counter)
{
    size_t last = stream_own_text(stream);
    bool is_elsewhere = start == TOKEN_START_FOR && (last > head || counter > head);
    for (size_t i = head; i < last && !is_elsewhere; i++) {
        is_elsewhere = stream->frames.items[i].kind == FRAME_MACRO;
    }
    return is_elsewhere;
}

AstNode *stream_parse(GrammarStream *stream, int start, int base_depth, bool is_raw)
{
    GrammarState state;
    if (stream->failed) {
        return NULL;
    }
    if (*stream->hooks->nesting >= NESTING_MAX) {
        stream_fault(stream, DIAG_E0601, stream->end, "directives and calls nest too deeply inside each other here");
        return NULL;
    }
    grammar_begin(&state, stream->context);
    state.offset = stream->end.end;
    state.stream = stream;
    state.start = start;
    state.fragment = start;
    state.open_before = stream_open_directives(stream);
    state.base_depth = base_depth;
    state.is_raw = is_raw;
    state.takes_elements = start == TOKEN_START_SUBJECT;
    state.begins_raw = start == TOKEN_START_DIRECTIVE;
    size_t head = stream_own_text(stream);
    size_t before = stream->head_frames;
    bool was_open = stream->is_open;
    stream->head_frames = stream_is_head(start) ? stream->frames.count : before;
    stream->is_open = true;
    ++*stream->hooks->nesting;
    bool fine = grammar_yyparse(&state) == 0 && !state.faulty && !state.builder.failed && !stream->failed;
    if (fine && stream_is_head(start) && stream_open_directives(stream) > state.open_before) {
        stream_fault(stream, DIAG_E0106, stream->end, "a directive in the head of another ends in it");
        fine = false;
    }
    if (fine && stream_is_head(start) && ends_elsewhere(stream, start, head, state.counter_frame)) {
        stream_fault(stream, DIAG_E0106, stream->end, "the head of a directive ends in another text than it begins in");
        fine = false;
    }
    --*stream->hooks->nesting;
    stream->is_open = was_open;
    stream->head_frames = before;
    if (!fine) {
        stream_fail(stream);
    } else if (state.has_lookahead && state.ended_by.kind == 0) {
        stream_unread(stream, &state.current);
    }
    stream->is_cut = state.ended_by.kind != 0;
    ARRAY_FREE(&state.openers);
    return fine ? state.result : NULL;
}

void grammar_finish(GrammarState *state, AstNode *result, bool has_lookahead)
{
    state->result = result;
    state->has_lookahead = has_lookahead;
}
