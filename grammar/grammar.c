// The facade: sets up one parse and runs it.
//
// Turns a Source into calls of the client, one top-level item at a time, and takes the memory of each item back when
// the client returns. Owns nothing beyond the call.
//
// SPDX-License-Identifier: MIT
#include "grammar/grammar.h"

#include "grammar/lexer.h"
#include "grammar/parser.h"

bool grammar_emit(GrammarState *state, AstNode *item)
{
    if (state->builder.failed) {
        return false;
    }
    if (state->kept != NULL) {
        *state->kept = ast_append(*state->kept, item);
        return true;
    }
    if (!state->item(state->client, item)) {
        state->client_ended = true;
        return false;
    }
    arena_rewind(state->context->arena, state->mark);
    return true;
}

static void begin(GrammarState *state, const GrammarContext *context, Source *source)
{
    *state = (GrammarState){
        .context = context,
        .builder = {.arena = context->arena, .diags = context->diags, .depth_limit = context->limits->ast_depth},
        .source = source,
        .mark = arena_mark(context->arena),
    };
}

static void report_no_memory(GrammarState *state)
{
    grammar_fault(state, DIAG_E0602, (Span){state->offset, state->offset}, "out of memory while reading the scene");
}

static bool run(GrammarState *state)
{
    if (setjmp(state->escape) != 0) {
        report_no_memory(state);
    } else if (!grammar_scan_begin(state)) {
        report_no_memory(state);
    } else if (grammar_yyparse(state) != 0) {
        state->faulty |= !state->client_ended;
    }
    grammar_scan_end(state);
    ARRAY_FREE(&state->openers);
    return !state->faulty && !state->client_ended && !state->builder.failed;
}

bool grammar_parse(const GrammarContext *context, Source *source, GrammarItemFn item, void *client)
{
    GrammarState state;
    begin(&state, context, source);
    state.item = item;
    state.client = client;
    return run(&state);
}

bool grammar_parse_all(const GrammarContext *context, Source *source, AstList *items)
{
    GrammarState state;
    begin(&state, context, source);
    *items = (AstList){0};
    state.kept = items;
    return run(&state);
}

static GrammarToken plain_token(const Token *token)
{
    GrammarToken plain = {.kind = GRAMMAR_TOKEN_MARK, .span = token->span};
    if (grammar_is_directive(token->kind)) {
        plain.kind = GRAMMAR_TOKEN_DIRECTIVE;
        plain.symbol = grammar_directive_word(token->kind);
    } else if (grammar_is_reserved(token->kind) || token->kind == TOKEN_NAME) {
        plain.kind = GRAMMAR_TOKEN_WORD;
        plain.symbol = token->symbol;
    } else if (token->kind == TOKEN_NUMBER || token->kind == TOKEN_STRING || token->kind == TOKEN_END_OF_FILE) {
        plain.kind = token->kind == TOKEN_NUMBER   ? GRAMMAR_TOKEN_NUMBER
                     : token->kind == TOKEN_STRING ? GRAMMAR_TOKEN_STRING
                                                   : GRAMMAR_TOKEN_END;
    }
    return plain;
}

static void hand_over_tokens(GrammarState *state, GrammarTokenFn token, void *client)
{
    do {
        grammar_next_token(state);
        GrammarToken plain = plain_token(&state->current);
        state->client_ended = !token(client, &plain);
    } while (!state->client_ended && state->current.kind != TOKEN_END_OF_FILE);
}

bool grammar_scan_all(const GrammarContext *context, Source *source, GrammarTokenFn token, void *client)
{
    GrammarState state;
    begin(&state, context, source);
    if (setjmp(state.escape) != 0 || !grammar_scan_begin(&state)) {
        report_no_memory(&state);
    } else {
        hand_over_tokens(&state, token, client);
    }
    grammar_scan_end(&state);
    return !state.faulty && !state.client_ended;
}

static void dump_token(const GrammarState *state, SourceMap *sources, TextBuffer *out)
{
    SourceLocation at;
    if (source_locate(sources, state->current.span, &at)) {
        text_printf(out, "%llu:%llu ", (unsigned long long)at.line, (unsigned long long)at.column);
    }
    grammar_describe_token(state, &state->current, out);
    text_append_char(out, '\n');
}

bool grammar_dump_tokens(const GrammarContext *context, Source *source, SourceMap *sources, TextBuffer *out)
{
    GrammarState state;
    begin(&state, context, source);
    if (setjmp(state.escape) != 0 || !grammar_scan_begin(&state)) {
        report_no_memory(&state);
    } else {
        do {
            grammar_next_token(&state);
            dump_token(&state, sources, out);
        } while (state.current.kind != TOKEN_END_OF_FILE);
    }
    grammar_scan_end(&state);
    return !state.faulty && !out->failed;
}
