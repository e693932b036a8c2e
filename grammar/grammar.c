// The facade: sets up one parse and runs it.
//
// Turns a Source into calls of the client, one top-level item at a time, and takes the memory of each item back when
// the client returns. Owns nothing beyond the call.
//
// SPDX-License-Identifier: MIT
#include "grammar/grammar.h"

#include <stdlib.h>
#include <string.h>

#include "grammar/lexer.h"
#include "grammar/parser.h"

static bool holds_word(const AstNode *items);

// Whether a branch or a turn of a loop gives the word of a block, whose braces must stand after the #end.
static bool gives_word(const AstNode *item)
{
    switch ((AstKind)item->kind) {
    case AST_IF:
    case AST_IFDEF:
    case AST_SWITCH:
    case AST_WHILE:
    case AST_CASE: return holds_word(item->b) || holds_word(item->c);
    case AST_RANGE:
    case AST_FOR: return holds_word(item->c);
    case AST_ELSE: return holds_word(item->a);
    default: return false;
    }
}

static bool holds_word(const AstNode *items)
{
    for (; items != NULL; items = items->next) {
        if (items->kind == AST_WORD || gives_word(items)) {
            return true;
        }
    }
    return false;
}

// A declaration of what a directive gives, which may be nothing, before what may be its value then: a sign behind a
// directive has torn the statement already.
static bool may_lack_value(const GrammarState *state, const AstNode *item)
{
    int next = state->current.kind;
    return item->kind == AST_DECLARE && item->b->kind == AST_INLINE && !(item->flags & AST_ENDED) &&
           !(item->b->flags & AST_IN_PARENTHESES) && (state->torn || next == TOKEN_NUMBER);
}

// A block's word before a directive, which may give the `{`.
static bool may_lack_brace(const GrammarState *state, const AstNode *item)
{
    const GrammarHooks *hooks = state->context->hooks;
    return item->kind == AST_WORD && grammar_is_directive(state->current.kind) && hooks != NULL &&
           hooks->takes_braces(hooks->client, item->symbol);
}

bool grammar_emit(GrammarState *state, AstNode *item, bool has_lookahead)
{
    if (state->builder.failed) {
        return false;
    }
    bool is_doubtful =
        gives_word(item) || (has_lookahead && (may_lack_value(state, item) || may_lack_brace(state, item)));
    if (state->kept == NULL && is_doubtful && (state->torn || grammar_tear(state))) {
        state->torn_by_fault = true;
        return false;
    }
    if (state->kept != NULL) {
        *state->kept = ast_append(*state->kept, item);
        return true;
    }
    // It was run when it was found torn, as far as that went.
    bool is_told = item->span.begin < state->told_to && item->kind != AST_MACRO;
    if (!is_told && !state->item(state->client, item)) {
        state->client_ended = true;
        return false;
    }
    bool has_nodes = has_lookahead && (state->current.kind == TOKEN_VECTOR || state->current.kind == TOKEN_ITEMS);
    if (!has_nodes) { // else with the next item
        arena_rewind(state->context->arena, state->mark);
    }
    state->item_begin = has_lookahead ? state->current.span.begin : 0;
    state->faults_before = state->context->diags->error_count;
    return true;
}

void grammar_end_in_comma(GrammarState *state, Span comma)
{
    if (state->kept != NULL) {
        *state->kept = ast_flag_last(*state->kept, AST_BEFORE_COMMA);
    } else {
        grammar_fault(state, DIAG_E0259, comma, "no comma is expected here");
    }
}

void grammar_begin(GrammarState *state, const GrammarContext *context)
{
    *state = (GrammarState){
        .context = context,
        .builder = {.arena = context->arena, .diags = context->diags, .depth_limit = context->limits->ast_depth},
        .mark = arena_mark(context->arena),
    };
}

static void begin(GrammarState *state, const GrammarContext *context, Source *source)
{
    grammar_begin(state, context);
    state->source = source;
    state->offset = source_base(source);
    state->start = TOKEN_START_TEXT;
    state->can_splice = context->hooks != NULL;
}

static void report_no_memory(GrammarState *state)
{
    grammar_fault(state, DIAG_E0602, (Span){state->offset, state->offset}, "out of memory while reading the scene");
}

// Has the statement that was found torn read again, with its directives resolved. False when the parse is to stop.
static bool read_torn(GrammarState *state)
{
    const GrammarHooks *hooks = state->context->hooks;
    Token torn = state->torn_at;
    uint64_t begin = state->item_begin;
    bool is_refused = false;
    state->torn = state->ended = state->skips = false;
    state->is_quiet = true;
    state->openers.count = 0;
    grammar_hold_token(state, torn);
    bool fine = hooks->read_torn(hooks->client, state, begin, &torn, &is_refused);
    arena_rewind(state->context->arena, state->mark);
    state->faulty |= !fine;
    state->item_begin = 0;
    state->is_quiet = state->torn_by_fault = false;
    if (is_refused && !state->client_ended) {
        state->told_to = torn.span.begin + 1;
        grammar_scan_seek(state, begin);
    }
    return (fine || is_refused) && !state->client_ended;
}

void grammar_live_read(GrammarState *live, Token *token)
{
    grammar_read_token(live, token);
}

void grammar_live_unread(GrammarState *live, const Token *token)
{
    grammar_hold_token(live, *token);
}

bool grammar_live_is_before(const GrammarState *live, uint64_t offset)
{
    return live->held_count == 0 || live->held[live->held_count - 1].span.begin > offset;
}

bool grammar_live_emit(GrammarState *live, AstNode *item)
{
    (void)grammar_emit(live, item, false);
    return !live->client_ended;
}

// Statement by statement; one that is torn apart by directives is read again with them resolved.
static void parse(GrammarState *state)
{
    bool goes_on = true;
    while (goes_on) {
        state->start = TOKEN_START_TEXT;
        bool fine = grammar_yyparse(state) == 0;
        goes_on = state->torn && state->kept == NULL && read_torn(state);
        state->faulty |= !fine && !state->torn && !goes_on && !state->client_ended;
    }
}

static bool run(GrammarState *state)
{
    if (setjmp(state->escape) != 0) {
        report_no_memory(state);
    } else if (!grammar_scan_begin(state)) {
        report_no_memory(state);
    } else {
        state->quick = state->context->token_by_token ? NULL : grammar_quick_new(); // without it all is read as well
        parse(state);
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
    bool has_plans = context->hooks != NULL && context->hooks->plan_run != NULL;
    state.statements = has_plans ? grammar_statements_new() : NULL; // without it all is read as well
    return run(&state);
}

bool grammar_parse_all(const GrammarContext *context, Source *source, AstList *items, bool *torn)
{
    GrammarState state;
    begin(&state, context, source);
    *items = (AstList){0};
    state.kept = items;
    bool fine = run(&state);
    *torn = state.torn;
    return fine && !state.torn;
}

// ---- text that is kept as tokens

// Whether an expression may be continuing beyond the first or the last token of a text.
static bool goes_on(const GrammarText *text)
{
    if (text->count == 0) {
        return false;
    }
    int first = text->tokens[0].kind, last = text->tokens[text->count - 1].kind;
    bool goes_on_before = first < 256 && strchr("*/.)]>:?", first) != NULL;
    bool goes_on_after = last < 256 && strchr("}])>;", last) == NULL;
    return goes_on_before || goes_on_after;
}

bool grammar_text_is_balanced(const GrammarText *text)
{
    long depth = 0;
    if (goes_on(text)) {
        return false;
    }
    unsigned open = 0, skipped = 0; // directives; from the first one of which another branch is passed over
    for (size_t i = 0; i < text->count; i++) {
        DirectiveRole role = grammar_role(text->tokens[i].kind);
        open += role == ROLE_OPENS;
        if (skipped == 0 && open > 0 && (role == ROLE_ELSE || role == ROLE_MIDDLE)) {
            skipped = open;
        }
        if (role == ROLE_END && open > 0) {
            skipped = skipped == open ? 0 : skipped;
            open--;
        }
        if (skipped == 0) {
            int kind = text->tokens[i].kind;
            depth += (kind == '{' || kind == '(' || kind == '[') - (kind == '}' || kind == ')' || kind == ']');
        }
        if (depth < 0) {
            return false;
        }
    }
    return depth == 0;
}

bool grammar_text_is_empty(const GrammarText *text)
{
    return text->count == 0;
}

typedef ARRAY(Token) Tokens;

static bool read_tokens(GrammarState *state, Tokens *tokens)
{
    Token token = {0};
    state->is_quiet = true;
    bool fine = setjmp(state->escape) == 0 && grammar_scan_begin(state);
    while (fine) {
        grammar_read_token(state, &token);
        if (token.kind == TOKEN_END_OF_FILE) {
            break;
        }
        fine = ARRAY_PUSH(tokens, token);
    }
    if (!fine) {
        report_no_memory(state);
    }
    grammar_scan_end(state);
    return fine;
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

static GrammarText *read_text(GrammarState *state)
{
    Tokens tokens = {0};
    GrammarText *text = read_tokens(state, &tokens) ? grammar_text_new(tokens.items, tokens.count) : NULL;
    ARRAY_FREE(&tokens);
    return text;
}

GrammarText *grammar_text_read(const GrammarContext *context, Source *source)
{
    GrammarState state;
    begin(&state, context, source);
    return read_text(&state);
}

GrammarText *grammar_text_again(const GrammarContext *context, Span span)
{
    // What is wrong with it has been reported when it was read first.
    GrammarContext quiet_context = *context;
    GrammarState state;
    DiagSink quiet;
    char *bytes = malloc((size_t)(span.end - span.begin) + 1);
    bool is_there = bytes != NULL && source_read_span(context->diags->sources, span, bytes);
    GrammarText *text = NULL;
    diag_init(&quiet, context->diags->sources);
    quiet_context.diags = &quiet;
    if (is_there) {
        grammar_begin(&state, &quiet_context);
        state.offset = span.begin;
        state.text = bytes;
        state.text_length = (size_t)(span.end - span.begin);
        text = read_text(&state);
    }
    diag_fini(&quiet);
    free(bytes);
    if (text == NULL) {
        diag_report(context->diags, DIAG_E0502, span, "this text cannot be read again");
    }
    return text;
}

// Scans its text once more.
void grammar_report_unreadable(GrammarState *state, const Token *token)
{
    if (token->known == NULL) {
        return;
    }
    GrammarState again;
    DiagSink *diags = state->context->diags;
    size_t length = (size_t)(token->span.end - token->span.begin), errors = diags->error_count;
    char *bytes = malloc(length + 1);
    grammar_begin(&again, state->context);
    if (bytes != NULL && source_read_span(diags->sources, token->span, bytes)) {
        again.offset = token->span.begin;
        again.text = bytes;
        again.text_length = length;
        if (setjmp(again.escape) == 0 && grammar_scan_begin(&again)) {
            do {
                grammar_next_token(&again);
            } while (again.current.kind != TOKEN_END_OF_FILE);
        }
        grammar_scan_end(&again);
    }
    free(bytes);
    if (diags->error_count == errors) {
        grammar_fault(state, DIAG_E0101, token->span, "this cannot be read");
    }
    state->faulty = true;
}

GrammarText *grammar_text_body(const GrammarContext *context, Span macro)
{
    GrammarText *text = grammar_text_again(context, macro);
    if (text == NULL) {
        return NULL;
    }
    size_t begin = 0;
    while (begin < text->count && text->tokens[begin].kind != ')') {
        begin++;
    }
    size_t count = begin + 2 <= text->count ? text->count - begin - 2 : 0;
    memmove(text->tokens, text->tokens + begin + 1, count * sizeof *text->tokens);
    text->count = count;
    return text;
}

AstNode *grammar_text_macro(const GrammarContext *context, const Token *macro, const Token *tokens, size_t count)
{
    GrammarContext quiet_context = *context;
    GrammarState state;
    DiagSink quiet;
    AstList items = {0};
    diag_init(&quiet, context->diags->sources);
    quiet_context.diags = &quiet;
    quiet_context.hooks = NULL;
    grammar_begin(&state, &quiet_context);
    state.tokens = tokens;
    state.token_count = count;
    state.kept = &items;
    state.start = TOKEN_START_TEXT;
    state.can_splice = true;
    grammar_hold_token(&state, *macro);
    bool fine = grammar_yyparse(&state) == 0 && !state.torn && quiet.error_count == 0 && items.count == 1;
    ARRAY_FREE(&state.openers);
    diag_fini(&quiet);
    return fine && items.first->kind == AST_MACRO ? items.first : NULL;
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
