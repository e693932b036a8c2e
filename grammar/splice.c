// Splices: text that is read as POV-Ray reads it, directive by directive and call by call, token by token.
//
// Turns kept or live tokens into tokens without conditionals, loops, includes and macro calls: a stack of frames says
// where the next token comes from. What each directive means is asked of the evaluator (GrammarHooks), which has worked
// out everything before it. Items and the parts of directives are parsed one by one as *fragments* of the grammar, each
// with a GrammarState of its own. Knows nothing of values.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "grammar/lexer.h"
#include "grammar/parser.h"

enum {
    NESTING_MAX = 100, // of fragments: each takes some 10 KiB of the stack
    FRAMES_MAX = 1000,
    NO_BASE = -1, // of a fragment in which a directive ends no expression
};

typedef enum FrameKind {
    FRAME_LIVE,   // what the scanner gives
    FRAME_TEXT,   // tokens
    FRAME_MACRO,  // tokens of a macro's body
    FRAME_FILE,   // tokens of an included file
    FRAME_WHILE,  // tokens of a loop, the condition included, up to its #end
    FRAME_FOR,    // tokens of a loop's body, up to its #end
    FRAME_BRANCH, // the chosen branch of an #if: no tokens of its own
    FRAME_SWITCH, // a #switch
    FRAME_LEFT,   // a text at its end, under directives that began in it: keeps their places
} FrameKind;

typedef struct Frame {
    FrameKind kind;
    GrammarText *owned; // freed with the frame
    const Token *tokens;
    size_t count, at;
    Token opened_by;
    GrammarLoop loop;
    double subject; // of a #switch
    bool is_found;  // its case
} Frame;

struct GrammarStream {
    const GrammarContext *context;
    GrammarHooks *hooks;
    GrammarState *live; // the state whose scanner gives the text after the kept tokens; NULL: there is none
    ARRAY(Frame) frames;
    bool within;  // the items stand inside braces or parentheses
    bool is_call; // the whole is a macro's body
    bool failed;  // reading cannot go on
    bool is_cut;  // a directive stood right after the last item
    bool is_open; // an item or a directive is being read
    Span end;     // of the last token
    Token silent; // the name of a macro that gave nothing before the present token
};

// ---- faults

static void fail(GrammarStream *stream)
{
    stream->failed = true;
}

static void fault(GrammarStream *stream, DiagCode code, Span span, const char *text)
{
    diag_report(stream->context->diags, code, span, "%s", text);
    fail(stream);
}

static void fault_stray(GrammarStream *stream, const Token *token)
{
    if (!stream->failed) {
        diag_report(stream->context->diags, DIAG_E0106, token->span, "`#%s` without the directive that it belongs to",
                    intern_get(stream->context->names, grammar_directive_word(token->kind)));
    }
    fail(stream);
}

static void fault_unclosed(GrammarStream *stream, const Token *token)
{
    if (stream->failed) {
        return;
    }
    const char *word = intern_get(stream->context->names, grammar_directive_word(token->kind));
    if (diag_report(stream->context->diags, DIAG_E0107, stream->end, "the file ends before the `#end` of `#%s`", word)) {
        diag_note(stream->context->diags, token->span, "`#%s` opened here", word);
    }
    fail(stream);
}

// ---- frames

static Frame *push(GrammarStream *stream, FrameKind kind, const Token *opened_by)
{
    if (stream->frames.count >= FRAMES_MAX) {
        fault(stream, DIAG_E0601, opened_by->span, "directives nest too deeply here");
        return NULL;
    }
    if (!ARRAY_PUSH(&stream->frames, (Frame){.kind = kind, .opened_by = *opened_by})) {
        fault(stream, DIAG_E0602, opened_by->span, "out of memory while reading the scene");
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

// Removes a frame, and those that were left under it.
static void drop(GrammarStream *stream, size_t at)
{
    Frame *frame = &stream->frames.items[at];
    leave(stream, frame);
    memmove(frame, frame + 1, (stream->frames.count - at - 1) * sizeof *frame);
    stream->frames.count--;
    while (stream->frames.count > 0 && stream->frames.items[stream->frames.count - 1].kind == FRAME_LEFT) {
        stream->frames.count--;
    }
}

static void drop_to(GrammarStream *stream, size_t count)
{
    while (stream->frames.count > count) {
        drop(stream, stream->frames.count - 1);
    }
}

static bool has_text(const Frame *frame)
{
    return frame->kind < FRAME_BRANCH;
}

// The frame that a `#else`, `#end` or the like belongs to: the innermost one, but for files, which may hold part of a
// directive. The count of frames when there is none.
static size_t owner_of_middle(const GrammarStream *stream)
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

static size_t innermost_text(const GrammarStream *stream)
{
    size_t at = stream->frames.count;
    while (at > 0 && !has_text(&stream->frames.items[at - 1])) {
        at--;
    }
    return at; // one more than its place; 0: none
}

// ---- tokens as they stand

static void deliver_end(const GrammarStream *stream, Token *token)
{
    *token = (Token){.kind = TOKEN_END_OF_FILE, .span = {stream->end.end, stream->end.end}};
}

// The next token of the text, wherever it stands; leaves frames whose text is at its end.
static void read_raw(GrammarStream *stream, Token *token)
{
    size_t at;
    while (!stream->failed && (at = innermost_text(stream)) > 0) {
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
            fault_unclosed(stream, &stream->frames.items[stream->frames.count - 1].opened_by);
            break;
        }
        if (at < stream->frames.count) {
            leave(stream, frame);
        } else {
            drop(stream, at - 1);
        }
    }
    deliver_end(stream, token);
}

// Takes back the token that was read last.
static void unread(GrammarStream *stream, const Token *token)
{
    size_t at = innermost_text(stream);
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

// The kind of the next token in the text of the innermost frame.
static int peek_kind(GrammarStream *stream)
{
    size_t at = innermost_text(stream);
    const Frame *frame = at > 0 ? &stream->frames.items[at - 1] : NULL;
    if (frame == NULL || frame->kind != FRAME_LIVE) {
        return frame != NULL && frame->at < frame->count ? frame->tokens[frame->at].kind : TOKEN_END_OF_FILE;
    }
    Token token;
    grammar_read_token(stream->live, &token);
    grammar_hold_token(stream->live, token);
    return token.kind;
}

// ---- skipping and keeping

typedef ARRAY(Token) Tokens;

// Reads up to the `#end` that closes `depth` open directives, or, at depth 1 and if wanted, to a token between its
// branches. Keeps what it read in *kept, if that is not NULL. Gives the last token.
static bool skip(GrammarStream *stream, const Token *opener, unsigned depth, bool stops_between, Tokens *kept, Token *last)
{
    for (;;) {
        read_raw(stream, last);
        if (last->kind == TOKEN_END_OF_FILE) {
            fault_unclosed(stream, opener);
            return false;
        }
        if (kept != NULL && !ARRAY_PUSH(kept, *last)) {
            fault(stream, DIAG_E0602, last->span, "out of memory while reading the scene");
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

static bool keep_to_end(GrammarStream *stream, const Token *opener, Tokens *kept)
{
    Token last;
    return skip(stream, opener, 1, false, kept, &last);
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

// ---- fragments

// Parses what `start` says from the stream; NULL after a fault. `within`: no directive ends an expression.
static AstNode *parse_fragment(GrammarStream *stream, int start, int base_depth, bool is_raw)
{
    GrammarState state;
    if (stream->failed) {
        return NULL;
    }
    if (*stream->hooks->nesting >= NESTING_MAX) {
        fault(stream, DIAG_E0601, stream->end, "directives and calls nest too deeply inside each other here");
        return NULL;
    }
    grammar_begin(&state, stream->context);
    state.offset = stream->end.end;
    state.stream = stream;
    state.start = start;
    state.base_depth = base_depth;
    state.is_raw = is_raw;
    state.takes_elements = start == TOKEN_START_SUBJECT;
    state.begins_raw = start == TOKEN_START_DIRECTIVE;
    bool was_open = stream->is_open;
    stream->is_open = true;
    ++*stream->hooks->nesting;
    bool fine = grammar_yyparse(&state) == 0 && !state.faulty && !state.builder.failed && !stream->failed;
    --*stream->hooks->nesting;
    stream->is_open = was_open;
    if (!fine) {
        fail(stream);
    } else if (state.has_lookahead && state.ended_by.kind == 0) {
        unread(stream, &state.current);
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

static int base_of_items(const GrammarStream *stream)
{
    return stream->within ? NO_BASE : 0;
}

// ---- directives

typedef struct Reading {
    GrammarStream *stream;
    Token directive;
} Reading;

static bool decide(GrammarStream *stream, AstKind kind, const Token *directive, AstNode *a, AstNode *b, double *subject)
{
    bool holds = false;
    if (a == NULL) {
        return false;
    }
    AstNode node = {.kind = (uint8_t)kind, .span = span_join(directive->span, stream->end), .a = a, .b = b};
    node.op = directive->kind == TOKEN_HASH_IFNDEF  ? AST_OP_IFNDEF
              : directive->kind == TOKEN_HASH_IFDEF ? AST_OP_IFDEF
                                                    : AST_OP_NONE;
    if (!stream->hooks->decide(stream->hooks->client, &node, subject, &holds)) {
        fail(stream);
    }
    return holds && !stream->failed;
}

static bool condition_holds(GrammarStream *stream, const Token *directive)
{
    ArenaMark mark = arena_mark(stream->context->arena);
    bool is_ifdef = directive->kind == TOKEN_HASH_IFDEF || directive->kind == TOKEN_HASH_IFNDEF;
    AstNode *node = parse_fragment(stream, is_ifdef ? TOKEN_START_SUBJECT : TOKEN_START_CONDITION, 1, false);
    bool holds = decide(stream, is_ifdef ? AST_IFDEF : AST_IF, directive, node, NULL, NULL);
    arena_rewind(stream->context->arena, mark);
    return holds;
}

static void begin_if(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    Token at = reading->directive;
    while (!stream->failed) {
        bool holds = at.kind == TOKEN_HASH_ELSE || condition_holds(stream, &at);
        if (stream->failed) {
            return;
        }
        if (holds) {
            push(stream, FRAME_BRANCH, &reading->directive);
            return;
        }
        if (!skip(stream, &reading->directive, 1, true, NULL, &at) || at.kind == TOKEN_HASH_END) {
            return;
        }
        if (at.kind != TOKEN_HASH_ELSE && at.kind != TOKEN_HASH_ELSEIF) {
            fault_stray(stream, &at);
        }
    }
}

static void begin_switch(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    double subject = 0;
    ArenaMark mark = arena_mark(stream->context->arena);
    decide(stream, AST_SWITCH, &reading->directive, parse_fragment(stream, TOKEN_START_CONDITION, 1, false), NULL,
           &subject);
    arena_rewind(stream->context->arena, mark);
    Frame *frame = stream->failed ? NULL : push(stream, FRAME_SWITCH, &reading->directive);
    if (frame != NULL) {
        frame->subject = subject;
    }
}

static bool case_holds(GrammarStream *stream, const Token *directive, double subject)
{
    ArenaMark mark = arena_mark(stream->context->arena);
    AstNode *a, *b = NULL;
    bool is_range = directive->kind == TOKEN_HASH_RANGE;
    if (is_range) {
        AstNode *range = parse_fragment(stream, TOKEN_START_RANGE, 1, false);
        a = range != NULL ? range->a : NULL;
        b = range != NULL ? range->b : NULL;
    } else {
        a = parse_fragment(stream, TOKEN_START_CONDITION, 1, false);
    }
    bool holds = decide(stream, is_range ? AST_RANGE : AST_CASE, directive, a, b, &subject);
    arena_rewind(stream->context->arena, mark);
    return holds;
}

// A case, or the #else, of the #switch at a place among the frames. The head of one that is run into is worked out, too.
static void next_case(GrammarStream *stream, size_t place, Token at)
{
    while (!stream->failed) {
        Frame *frame = &stream->frames.items[place];
        bool was_found = frame->is_found;
        bool holds = at.kind == TOKEN_HASH_ELSE || case_holds(stream, &at, frame->subject);
        frame = &stream->frames.items[place];
        if (stream->failed || was_found || holds) {
            frame->is_found = true;
            return;
        }
        Token opener = frame->opened_by;
        if (!skip(stream, &opener, 1, true, NULL, &at)) {
            return;
        }
        if (at.kind == TOKEN_HASH_END) {
            drop(stream, place);
            return;
        }
    }
}

static void between_branches(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    size_t place = owner_of_middle(stream);
    Token last;
    FrameKind kind = place < stream->frames.count ? stream->frames.items[place].kind : FRAME_LIVE;
    bool is_case = reading->directive.kind == TOKEN_HASH_CASE || reading->directive.kind == TOKEN_HASH_RANGE;
    if (kind == FRAME_SWITCH && reading->directive.kind != TOKEN_HASH_ELSEIF) {
        next_case(stream, place, reading->directive);
    } else if (kind == FRAME_BRANCH && !is_case) {
        Token opener = stream->frames.items[place].opened_by;
        if (skip(stream, &opener, 1, false, NULL, &last)) {
            drop(stream, place);
        }
    } else {
        fault_stray(stream, &reading->directive);
    }
}

// ---- loops

static void next_while(GrammarStream *stream, size_t place)
{
    Frame *frame = &stream->frames.items[place];
    Token opener = frame->opened_by;
    frame->at = 0;
    bool holds = condition_holds(stream, &opener);
    if (stream->failed) {
        return;
    }
    if (!holds) {
        drop_to(stream, place);
    } else if (!stream->hooks->step(stream->hooks->client, opener.span)) {
        fail(stream);
    }
}

static void next_for(GrammarStream *stream, size_t place)
{
    Frame *frame = &stream->frames.items[place];
    bool holds = false;
    frame->at = 0;
    if (!stream->hooks->loop_turn(stream->hooks->client, &frame->loop, &holds)) {
        fail(stream);
    } else if (!holds) {
        drop_to(stream, place);
    } else if (!stream->hooks->step(stream->hooks->client, frame->opened_by.span)) {
        fail(stream);
    }
}

// Keeps a loop's text up to its `#end` and pushes it.
static Frame *push_loop(GrammarStream *stream, FrameKind kind, const Token *opener)
{
    Tokens kept = {0};
    Frame *frame = NULL;
    if (keep_to_end(stream, opener, &kept) && (frame = push(stream, kind, opener)) != NULL) {
        frame->owned = grammar_text_new(kept.items, kept.count);
        frame->tokens = frame->owned != NULL ? frame->owned->tokens : NULL;
        frame->count = frame->owned != NULL ? kept.count : 0;
        if (frame->owned == NULL) {
            fault(stream, DIAG_E0602, opener->span, "out of memory while reading the scene");
        }
    }
    ARRAY_FREE(&kept);
    return stream->failed ? NULL : frame;
}

static void begin_while(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    if (push_loop(stream, FRAME_WHILE, &reading->directive) != NULL) {
        next_while(stream, stream->frames.count - 1);
    }
}

static void begin_for(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    ArenaMark mark = arena_mark(stream->context->arena);
    AstNode *head = parse_fragment(stream, TOKEN_START_FOR, NO_BASE, false);
    GrammarLoop loop = {0};
    bool holds = false;
    if (head == NULL || !stream->hooks->loop_begin(stream->hooks->client, head, &loop, &holds)) {
        fail(stream);
        return;
    }
    arena_rewind(stream->context->arena, mark);
    Token last;
    if (!holds) {
        (void)skip(stream, &reading->directive, 1, false, NULL, &last);
        return;
    }
    Frame *frame = push_loop(stream, FRAME_FOR, &reading->directive);
    if (frame != NULL) {
        frame->loop = loop;
        if (!stream->hooks->step(stream->hooks->client, reading->directive.span)) {
            fail(stream);
        }
    }
}

static void end_directive(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    size_t place = owner_of_middle(stream);
    if (place == stream->frames.count) {
        fault_stray(stream, &reading->directive);
        return;
    }
    switch (stream->frames.items[place].kind) {
    case FRAME_WHILE: next_while(stream, place); break;
    case FRAME_FOR: next_for(stream, place); break;
    default: drop(stream, place); break;
    }
}

// Leaves the innermost loop, #switch or macro.
static void break_out(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    unsigned branches = 0;
    for (size_t i = stream->frames.count; i > 0; i--) {
        Frame *frame = &stream->frames.items[i - 1];
        Token opener = frame->opened_by, last;
        switch (frame->kind) {
        case FRAME_BRANCH: branches++; break;
        case FRAME_SWITCH:
            if (skip(stream, &opener, branches + 1, false, NULL, &last)) {
                for (size_t j = stream->frames.count; j >= i; j--) {
                    if (j <= stream->frames.count && !has_text(&stream->frames.items[j - 1])) {
                        drop(stream, j - 1);
                    }
                }
            }
            return;
        case FRAME_WHILE:
        case FRAME_FOR:
        case FRAME_MACRO: drop_to(stream, i - 1); return;
        case FRAME_TEXT:
            if (stream->is_call) {
                drop_to(stream, i - 1);
                return;
            }
            break;
        default: break;
        }
    }
    fault(stream, DIAG_E0209, reading->directive.span, "no loop, `#switch` or macro that `#break` could leave");
}

// ---- macros and files

// The definition as a tree; NULL when its body holds no whole items.
static AstNode *parse_whole_macro(const GrammarStream *stream, const Token *opener, const Tokens *kept)
{
    GrammarContext context = *stream->context;
    GrammarState state;
    DiagSink quiet;
    AstList items = {0};
    diag_init(&quiet, context.diags->sources);
    context.diags = &quiet;
    context.hooks = NULL;
    grammar_begin(&state, &context);
    state.tokens = kept->items;
    state.token_count = kept->count;
    state.kept = &items;
    state.start = TOKEN_START_TEXT;
    state.can_splice = true;
    grammar_hold_token(&state, *opener);
    bool fine = grammar_yyparse(&state) == 0 && !state.torn && quiet.error_count == 0 && items.count == 1;
    ARRAY_FREE(&state.openers);
    diag_fini(&quiet);
    return fine && items.first->kind == AST_MACRO ? items.first : NULL;
}

// Its text is kept; the definition is kept parsed as well when its body holds whole items.
static void define_macro(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    Tokens kept = {0};
    ArenaMark mark = arena_mark(stream->context->arena);
    AstNode *definition = NULL, *whole = NULL;
    if (keep_to_end(stream, &reading->directive, &kept)) {
        // The head is read again from what was kept.
        Frame *frame = push(stream, FRAME_TEXT, &reading->directive);
        if (frame != NULL) {
            frame->tokens = kept.items;
            frame->count = kept.count;
            definition = parse_fragment(stream, TOKEN_START_MACRO, NO_BASE, true);
            size_t at = stream->frames.count - 1;
            frame = &stream->frames.items[at];
            size_t begin = frame->at;
            drop(stream, at);
            if (definition != NULL) {
                definition->span = span_join(reading->directive.span, kept.items[kept.count - 1].span);
                GrammarText *body = grammar_text_new(kept.items + begin, kept.count - 1 - begin);
                whole = parse_whole_macro(stream, &reading->directive, &kept);
                if (body == NULL || !stream->hooks->define(stream->hooks->client, whole != NULL ? whole : definition,
                                                           body)) {
                    fail(stream);
                }
                free(body);
            }
        }
    }
    arena_rewind(stream->context->arena, mark);
    ARRAY_FREE(&kept);
}

// Text inside an item; between items the evaluator reads the file.
static void include_file(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    GrammarHooks *hooks = stream->hooks;
    ArenaMark mark = arena_mark(stream->context->arena);
    unread(stream, &reading->directive);
    bool is_inside = stream->is_open || stream->within;
    AstNode *node = parse_fragment(stream, TOKEN_START_DIRECTIVE, 0, false);
    Source *source = node != NULL && is_inside ? hooks->include(hooks->client, node) : NULL;
    if (node != NULL && !is_inside && !hooks->run(hooks->client, node, false)) {
        fail(stream);
    }
    arena_rewind(stream->context->arena, mark);
    if (source == NULL) {
        stream->failed = stream->failed || hooks->is_stopped(hooks->client);
        return;
    }
    GrammarText *text = grammar_text_read(stream->context, source);
    source_close(source);
    Frame *frame = text != NULL ? push(stream, FRAME_FILE, &reading->directive) : NULL;
    if (frame == NULL) {
        hooks->leave(hooks->client);
        free(text);
        fail(stream);
        return;
    }
    frame->owned = text;
    frame->tokens = text->tokens;
    frame->count = text->count;
}

static void call_macro(GrammarStream *stream, const Token *name)
{
    ArenaMark mark = arena_mark(stream->context->arena);
    AstNode *call = parse_fragment(stream, TOKEN_START_ARGUMENTS, 1, false);
    if (call == NULL) {
        return;
    }
    call->symbol = name->symbol;
    call->span = span_join(name->span, call->span);
    const GrammarText *text = stream->hooks->call(stream->hooks->client, call);
    arena_rewind(stream->context->arena, mark);
    if (text == NULL) {
        fail(stream);
        return;
    }
    Frame *frame = push(stream, FRAME_MACRO, name);
    if (frame == NULL) {
        stream->hooks->leave(stream->hooks->client);
        return;
    }
    frame->tokens = text->tokens;
    frame->count = text->count;
    stream->silent = *name;
}

static void run_simple(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    bool within = stream->is_open || stream->within;
    ArenaMark mark = arena_mark(stream->context->arena);
    unread(stream, &reading->directive);
    AstNode *node = parse_fragment(stream, TOKEN_START_DIRECTIVE, 0, false);
    if (node != NULL && !stream->hooks->run(stream->hooks->client, node, within)) {
        fail(stream);
    }
    arena_rewind(stream->context->arena, mark);
}

static void run_directive(GrammarStream *stream, const Token *directive)
{
    static const struct {
        int token;
        void (*run)(Reading *reading);
    } table[] = {
        {TOKEN_HASH_IF, begin_if},           {TOKEN_HASH_IFDEF, begin_if},      {TOKEN_HASH_IFNDEF, begin_if},
        {TOKEN_HASH_ELSEIF, between_branches}, {TOKEN_HASH_ELSE, between_branches}, {TOKEN_HASH_CASE, between_branches},
        {TOKEN_HASH_RANGE, between_branches}, {TOKEN_HASH_END, end_directive},   {TOKEN_HASH_SWITCH, begin_switch},
        {TOKEN_HASH_BREAK, break_out},       {TOKEN_HASH_WHILE, begin_while},   {TOKEN_HASH_FOR, begin_for},
        {TOKEN_HASH_MACRO, define_macro},    {TOKEN_HASH_INCLUDE, include_file},
    };
    Reading reading = {stream, *directive};
    for (size_t i = 0; i < RT_COUNT_OF(table); i++) {
        if (table[i].token == directive->kind) {
            table[i].run(&reading);
            return;
        }
    }
    run_simple(&reading);
}

// ---- delivery to the parser

// Whether the last token delivered can be the end of an expression or a block.
static bool ends_operand(const GrammarState *state)
{
    switch (state->previous.kind) {
    case TOKEN_NUMBER:
    case TOKEN_STRING:
    case TOKEN_NAME:
    case TOKEN_CONSTANT:
    case ')':
    case ']':
    case '}':
    case '>':
        return true;
    default:
        return false;
    }
}

// Keeps `<` as an opener where it begins a vector, and the place of a function's body.
static void track_more(GrammarState *state)
{
    const Token *last = &state->previous;
    const Opener *open = grammar_innermost(state);
    if (last->kind == '<' && !state->ends_before) {
        Opener vector = {.kind = '<', .span = last->span};
        if (!ARRAY_PUSH(&state->openers, vector)) {
            state->ended = true;
        }
    } else if (last->kind == '>' && open != NULL && open->kind == '<') {
        state->openers.count--;
    }
    if (last->kind == TOKEN_ARRAY || last->kind == ',') {
        state->array_begins = last->kind == TOKEN_ARRAY;
    } else if (last->kind == '{' && state->array_begins) {
        state->array_begins = false;
        state->array_level = state->openers.count;
    } else if (state->openers.count < state->array_level) {
        state->array_level = 0;
    }
    if (last->kind == TOKEN_FUNCTION) {
        state->function_begins = true;
    } else if (last->kind == '{' && state->function_begins) {
        state->function_begins = false;
        state->function_level = state->openers.count;
    } else if (state->openers.count < state->function_level) {
        state->function_level = 0;
    }
}

static bool is_in_function(const GrammarState *state)
{
    return state->function_begins || state->function_level > 0;
}

// Where an element of an array or an item in it begins or has ended, no directive and no call may stand.
static bool is_between_elements(const GrammarState *state)
{
    const Opener *open = state->array_level > 0 ? &state->openers.items[state->openers.count - 1] : NULL;
    int last = state->previous.kind;
    return open != NULL && open->kind == '{' && (state->ends_before || last == '{' || last == ',');
}

static bool is_call(GrammarStream *stream, const GrammarState *state, const Token *token)
{
    return token->kind == TOKEN_NAME && state->previous.kind != '.' &&
           stream->hooks->is_macro(stream->hooks->client, token->symbol) && peek_kind(stream) == '(';
}

// True when a directive, which is complete, stands at the end of the text in which it began: what it declares belongs to
// the scope of that text, which is not left before.
static bool is_at_own_end(GrammarStream *stream, const GrammarState *state)
{
    size_t at;
    while ((at = innermost_text(stream)) > state->own_frame && at == stream->frames.count) {
        const Frame *frame = &stream->frames.items[at - 1];
        if ((frame->kind != FRAME_MACRO && frame->kind != FRAME_FILE) || frame->at < frame->count) {
            return false;
        }
        drop(stream, at - 1);
    }
    const Frame *own = at == state->own_frame && at > 0 ? &stream->frames.items[at - 1] : NULL;
    return own != NULL && own->kind != FRAME_LIVE && own->at == own->count;
}

// A directive or a call that ends what is parsed.
static void cut(GrammarStream *stream, GrammarState *state, Token *token)
{
    state->ended_by = *token;
    unread(stream, token);
    *token = (Token){.kind = TOKEN_END_OF_FILE, .span = {token->span.begin, token->span.begin}};
}

static void capture(GrammarStream *stream, const GrammarState *state, Token *token)
{
    // The base of an element is looked up with its index.
    if (token->kind == TOKEN_NAME && !is_in_function(state) && peek_kind(stream) != '[') {
        token->known = stream->hooks->capture(stream->hooks->client, token->symbol, token->span);
    }
}

static bool takes_string(int directive)
{
    switch (directive) {
    case TOKEN_HASH_INCLUDE:
    case TOKEN_HASH_DEBUG:
    case TOKEN_HASH_WARNING:
    case TOKEN_HASH_ERROR:
    case TOKEN_HASH_RENDER:
    case TOKEN_HASH_STATISTICS: return true;
    default: return false;
    }
}

void grammar_splice_token(GrammarState *state, Token *token)
{
    GrammarStream *stream = state->stream;
    track_more(state);
    stream->silent.kind = 0;
    state->ends_before = ends_operand(state);
    bool begins = state->begins_raw;
    state->begins_raw = false;
    for (;;) {
        bool may_end = state->ends_before || state->previous.kind == ';';
        bool is_over = may_end && state->own_frame > 0 && state->openers.count == 0 && is_at_own_end(stream, state);
        if (is_over || stream->failed || state->ended || state->builder.failed) {
            deliver_end(stream, token);
            return;
        }
        read_raw(stream, token);
        bool is_directive = grammar_is_directive(token->kind);
        if (begins) {
            state->takes_string = takes_string(token->kind);
            state->takes_elements = token->kind == TOKEN_HASH_UNDEF || token->kind == TOKEN_HASH_READ;
            state->own_frame = innermost_text(stream);
            break;
        }
        // No operator continues a string.
        if (state->takes_string && state->ends_before && state->openers.count == 0 && token->kind != '[') {
            unread(stream, token);
            deliver_end(stream, token);
            return;
        }
        if (state->is_raw || (!is_directive && !is_call(stream, state, token))) {
            break;
        }
        if (may_end && state->base_depth != NO_BASE && state->openers.count <= (size_t)state->base_depth) {
            cut(stream, state, token);
            return;
        }
        if (is_between_elements(state)) {
            fault(stream, DIAG_E0223, token->span, "no directive and no macro call can stand here, in the elements of an array");
        } else if (is_directive) {
            run_directive(stream, token);
        } else {
            call_macro(stream, token);
        }
    }
    size_t from = innermost_text(stream);
    if (from > 0 && stream->frames.items[from - 1].kind == FRAME_MACRO) {
        stream->silent.kind = 0;
    }
    if (!state->is_raw) {
        capture(stream, state, token);
    }
}

AstNode *grammar_name(GrammarState *state, Symbol symbol, Span span)
{
    AstNode *node = ast_node(&state->builder, AST_NAME, AST_OP_NONE, symbol, span, NULL, NULL, NULL);
    if (RT_UNLIKELY(state->stream != NULL) && !is_in_function(state)) {
        // With a token after it read, the name is the one before.
        const Token *token = state->current.span.begin == span.begin ? &state->current : &state->previous;
        ast_flag(node, AST_KNOWN)->known = token->known;
    }
    return node;
}

static bool is_bare_call(const AstNode *node)
{
    if (node == NULL || (node->flags & AST_IN_PARENTHESES)) {
        return false;
    }
    bool is_operation = node->kind == AST_UNARY || node->kind == AST_BINARY || node->kind == AST_MEMBER;
    return node->kind == AST_CALL || (is_operation && (node->flags & AST_PASTES));
}

// Marks what a macro's text may tear apart.
static AstNode *mark_pastes(AstNode *node)
{
    bool pastes = false;
    switch ((AstKind)node->kind) {
    case AST_UNARY:
    case AST_BINARY:
    case AST_MEMBER: pastes = is_bare_call(node->a) || is_bare_call(node->b); break;
    case AST_VECTOR:
    case AST_CALL:
    case AST_BUILTIN:
        for (const AstNode *part = node->a; part != NULL; part = part->next) {
            pastes |= is_bare_call(part);
        }
        break;
    default: break;
    }
    return pastes ? ast_flag(node, AST_PASTES) : node;
}

// Before a token after it is read, which may be a call that changes the array.
AstNode *grammar_element(GrammarState *state, AstNode *node)
{
    if (RT_LIKELY(state->stream == NULL) || state->takes_elements) {
        return node;
    }
    int next = peek_kind(state->stream);
    return next == '[' || next == '=' ? node : grammar_fold(state, node);
}

AstNode *grammar_fold(GrammarState *state, AstNode *node)
{
    if (RT_LIKELY(state->stream == NULL)) {
        return mark_pastes(node);
    }
    if (!is_in_function(state) && !(node->flags & AST_KNOWN) && !state->builder.failed && !state->stream->failed) {
        state->stream->hooks->fold(state->stream->hooks->client, node);
        state->stream->failed = state->stream->hooks->is_stopped(state->stream->hooks->client);
    }
    return node;
}

// ---- items

// Runs directives and calls up to the next item, and parses it; NULL at the end of the text, after a fault, or, for a
// live text, where nothing is open any more and the token `past` has been read.
static AstNode *next_item(GrammarStream *stream, uint64_t past)
{
    bool has_comma = false;
    GrammarState state; // of what stands between items: no fragment
    grammar_begin(&state, stream->context);
    state.stream = stream;
    while (!stream->failed) {
        const GrammarState *live = stream->live;
        bool is_done = live != NULL && stream->frames.count == 1 && stream->end.begin >= past &&
                       (live->held_count == 0 || live->held[live->held_count - 1].span.begin > past);
        Token token;
        if (is_done) {
            return NULL;
        }
        read_raw(stream, &token);
        if (token.kind == TOKEN_END_OF_FILE) {
            if (stream->frames.count > 0 && !has_text(&stream->frames.items[stream->frames.count - 1])) {
                fault_unclosed(stream, &stream->frames.items[stream->frames.count - 1].opened_by);
            }
            return NULL;
        }
        if (grammar_is_directive(token.kind)) {
            run_directive(stream, &token);
        } else if (is_call(stream, &state, &token)) {
            call_macro(stream, &token);
        } else if (token.kind == ',' && !has_comma) {
            has_comma = true;
        } else if (token.kind != ';' || live != NULL || peek_kind(stream) != TOKEN_END_OF_FILE) {
            unread(stream, &token);
            AstNode *item = parse_fragment(stream, TOKEN_START_ITEM, base_of_items(stream), false);
            return item != NULL && has_comma ? ast_flag(item, AST_AFTER_COMMA) : item;
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
    Frame *frame = push(stream, FRAME_TEXT, &none);
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
    return parse_fragment(stream, TOKEN_START_FULL, base_of_items(stream), false);
}

AstNode *grammar_stream_arguments(GrammarStream *stream)
{
    Token name;
    read_raw(stream, &name);
    return parse_fragment(stream, TOKEN_START_ARGUMENTS, 1, false);
}

bool grammar_stream_is_cut(const GrammarStream *stream)
{
    return stream->is_cut;
}

const Token *grammar_stream_silent(const GrammarStream *stream)
{
    return stream->silent.kind != 0 ? &stream->silent : NULL;
}

bool grammar_stream_has_failed(const GrammarStream *stream)
{
    return stream->failed;
}

void grammar_stream_close(GrammarStream *stream)
{
    drop_to(stream, 0);
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
    state->openers.count = 0;
    grammar_hold_token(state, torn);
    stream.end = (Span){begin, begin};
    if (push(&stream, FRAME_LIVE, &torn) != NULL && begin < torn.span.begin) {
        text = grammar_text_again(state->context, (Span){begin, torn.span.begin});
        Frame *frame = text != NULL ? push(&stream, FRAME_TEXT, &torn) : NULL;
        if (frame != NULL) {
            frame->tokens = text->tokens;
            frame->count = text->count;
        } else {
            fail(&stream);
        }
    }
    AstNode *item;
    while (!state->client_ended && (item = next_item(&stream, torn.span.begin)) != NULL) {
        (void)grammar_emit(state, item, false);
    }
    drop_to(&stream, 0);
    ARRAY_FREE(&stream.frames);
    free(text);
    arena_rewind(state->context->arena, state->mark);
    state->faulty |= stream.failed;
    state->item_begin = 0;
    return !stream.failed && !state->client_ended;
}
