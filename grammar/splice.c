// Splices: text that is read as POV-Ray reads it, directive by directive and call by call, token by token.
//
// Turns kept or live tokens into tokens without conditionals, loops, includes and macro calls, and these into items,
// one by one. What each directive means is asked of the evaluator (GrammarHooks), which has worked out everything
// before. Knows nothing of values. See splice.h for the other files.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "grammar/splice.h"

static int base_of_items(const GrammarStream *stream)
{
    return stream->within ? NO_BASE : 0;
}

static bool is_at_end(const Frame *frame)
{
    return frame->kind == FRAME_TEXT && frame->at == frame->count;
}

// Runs directives and calls up to the next item, and parses it; NULL at the end of the text, after a fault, or, for a
// live text, where nothing is open any more and the token `past` has been read.
static AstNode *next_item(GrammarStream *stream, uint64_t past)
{
    bool has_comma = false;
    Span comma = {0};
    GrammarState state; // of what stands between items: no fragment
    grammar_begin(&state, stream->context);
    state.stream = stream;
    while (!stream->failed) {
        const GrammarState *live = stream->live;
        if (live != NULL && stream->frames.count == 2 && is_at_end(&stream->frames.items[1])) {
            stream_drop(stream, 1);
        }
        bool is_done = live != NULL && stream->frames.count == 1 && stream->end.begin >= past &&
                       (live->held_count == 0 || live->held[live->held_count - 1].span.begin > past);
        Token token;
        if (!is_done) {
            stream_read(stream, &token);
        }
        if (has_comma && live != NULL && (is_done || token.kind == TOKEN_END_OF_FILE)) {
            stream_fault(stream, DIAG_E0259, comma, "no comma is expected here");
        }
        if (is_done) {
            return NULL;
        }
        if (token.kind == TOKEN_END_OF_FILE) {
            stream->ends_in_comma = has_comma;
            if (stream->frames.count > 0 && !frame_has_text(&stream->frames.items[stream->frames.count - 1])) {
                stream_fault_unclosed(stream, &stream->frames.items[stream->frames.count - 1].opened_by);
            }
            return NULL;
        }
        if (grammar_is_directive(token.kind)) {
            stream_run_directive(stream, &token);
        } else if (stream_is_at_call(stream, &state, &token)) {
            stream_call_macro(stream, &token);
        } else if (token.kind == ',' && !has_comma) {
            has_comma = true;
            comma = token.span;
        } else {
            stream_unread(stream, &token);
            AstNode *item = stream_parse(stream, TOKEN_START_ITEM, base_of_items(stream), false);
            bool is_ended = item != NULL && live == NULL && grammar_stream_take_semicolon(stream);
            return item == NULL ? NULL
                                : ast_flag(item, (has_comma ? AST_AFTER_COMMA : 0) | (is_ended ? AST_BEFORE_SEMICOLON : 0));
        }
    }
    return NULL;
}

static void stream_begin(GrammarStream *stream, const GrammarContext *context, bool within)
{
    *stream = (GrammarStream){.context = context, .hooks = context->hooks, .within = within};
}

GrammarStream *grammar_stream_open(const GrammarContext *context, const GrammarText *text, bool within, bool is_call)
{
    GrammarStream *stream = malloc(sizeof *stream);
    if (stream == NULL) {
        return NULL;
    }
    stream_begin(stream, context, within);
    stream->is_call = is_call;
    Token none = {0};
    Frame *frame = stream_push(stream, FRAME_TEXT, &none);
    if (frame == NULL) {
        free(stream);
        return NULL;
    }
    frame->tokens = text->tokens;
    frame->count = text->count;
    stream->end = text->count > 0 ? text->tokens[0].span : (Span){0};
    return stream;
}

AstNode *grammar_stream_next(GrammarStream *stream, bool *failed)
{
    AstNode *item = next_item(stream, 0);
    *failed = stream->failed;
    return item;
}

AstNode *grammar_stream_expression(GrammarStream *stream)
{
    return stream_parse(stream, TOKEN_START_FULL, base_of_items(stream), false);
}

bool grammar_stream_take_semicolon(GrammarStream *stream)
{
    Token token;
    if (stream->failed || stream_peek_kind(stream) != ';') {
        return false;
    }
    stream_read(stream, &token);
    stream->is_cut = grammar_is_directive(stream_peek_kind(stream));
    return true;
}

AstNode *grammar_stream_arguments(GrammarStream *stream)
{
    Token name;
    stream_read(stream, &name);
    return stream_parse(stream, TOKEN_START_ARGUMENTS, 1, false);
}

bool grammar_stream_is_cut(const GrammarStream *stream)
{
    return stream->is_cut;
}

bool grammar_stream_ends_in_comma(const GrammarStream *stream)
{
    return stream->ends_in_comma;
}

const Token *grammar_stream_silent(const GrammarStream *stream)
{
    return stream->silent.kind != 0 ? &stream->silent : NULL;
}

bool grammar_stream_has_failed(const GrammarStream *stream)
{
    return stream->failed;
}

bool grammar_stream_is_refused(GrammarStream *stream, Span at)
{
    const GrammarState *live = stream->live;
    bool is_there = live != NULL && live->torn_by_fault && at.begin == live->torn_at.span.begin;
    for (size_t i = 0; i < stream->frames.count && is_there; i++) {
        is_there = stream->frames.items[i].kind != FRAME_MACRO; // a text that was fine when it was defined
    }
    stream->is_refused = stream->is_refused || (is_there && !stream->failed);
    stream->failed = stream->failed || is_there;
    return stream->is_refused;
}

void grammar_stream_close(GrammarStream *stream)
{
    stream_drop_to(stream, 0);
    ARRAY_FREE(&stream->frames);
    free(stream);
}

bool grammar_splice_statement(GrammarState *state)
{
    GrammarStream stream;
    Token torn = state->torn_at;
    uint64_t begin = state->item_begin;
    GrammarText *text = NULL;
    stream_begin(&stream, state->context, false);
    stream.live = state;
    state->torn = state->ended = state->skips = false;
    state->is_quiet = true;
    state->openers.count = 0;
    grammar_hold_token(state, torn);
    stream.end = (Span){begin, begin};
    if (stream_push(&stream, FRAME_LIVE, &torn) != NULL && begin < torn.span.begin) {
        text = grammar_text_again(state->context, (Span){begin, torn.span.begin});
        Frame *frame = text != NULL ? stream_push(&stream, FRAME_TEXT, &torn) : NULL;
        if (frame != NULL) {
            frame->tokens = text->tokens;
            frame->count = text->count;
        } else {
            stream_fail(&stream);
        }
    }
    AstNode *item;
    while (!state->client_ended && (item = next_item(&stream, torn.span.begin)) != NULL) {
        (void)grammar_emit(state, item, false);
    }
    stream_drop_to(&stream, 0);
    ARRAY_FREE(&stream.frames);
    free(text);
    arena_rewind(state->context->arena, state->mark);
    state->faulty |= stream.failed;
    state->item_begin = 0;
    state->is_quiet = state->torn_by_fault = false;
    if (stream.is_refused && !state->client_ended) {
        state->told_to = torn.span.begin + 1;
        grammar_scan_seek(state, begin);
    }
    return (!stream.failed || stream.is_refused) && !state->client_ended;
}
