// Directives and macro calls of a splice: what each one does to the frames of the stream.
//
// One function for each kind of directive, in a table. What conditions, loops and names mean is asked of the evaluator
// (GrammarHooks), which has worked out everything before. Knows nothing of values.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "grammar/splice.h"

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
        stream_fail(stream);
    }
    return holds && !stream->failed;
}

static bool condition_holds(GrammarStream *stream, const Token *directive)
{
    ArenaMark mark = arena_mark(stream->context->arena);
    bool is_ifdef = directive->kind == TOKEN_HASH_IFDEF || directive->kind == TOKEN_HASH_IFNDEF;
    AstNode *node = stream_parse(stream, is_ifdef ? TOKEN_START_SUBJECT : TOKEN_START_CONDITION, 1, false);
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
        Frame *frame = holds ? stream_push(stream, FRAME_BRANCH, &reading->directive) : NULL;
        if (holds && frame != NULL) {
            frame->is_last = at.kind == TOKEN_HASH_ELSE;
        }
        if (holds) {
            return;
        }
        if (!stream_skip(stream, &reading->directive, 1, true, NULL, &at) || at.kind == TOKEN_HASH_END) {
            return;
        }
        if (at.kind != TOKEN_HASH_ELSE && at.kind != TOKEN_HASH_ELSEIF) {
            stream_fault_stray(stream, &at);
        }
    }
}

static void begin_switch(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    double subject = 0;
    ArenaMark mark = arena_mark(stream->context->arena);
    decide(stream, AST_SWITCH, &reading->directive, stream_parse(stream, TOKEN_START_CONDITION, 1, false), NULL,
           &subject);
    arena_rewind(stream->context->arena, mark);
    Frame *frame = stream->failed ? NULL : stream_push(stream, FRAME_SWITCH, &reading->directive);
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
        AstNode *range = stream_parse(stream, TOKEN_START_RANGE, 1, false);
        a = range != NULL ? range->a : NULL;
        b = range != NULL ? range->b : NULL;
    } else {
        a = stream_parse(stream, TOKEN_START_CONDITION, 1, false);
    }
    bool holds = decide(stream, is_range ? AST_RANGE : AST_CASE, directive, a, b, &subject);
    arena_rewind(stream->context->arena, mark);
    return holds;
}

// A case, or the #else, of the #switch at a place among the frames. The head of one that is run into is worked out.
static void next_case(GrammarStream *stream, size_t place, Token at)
{
    while (!stream->failed) {
        Frame *frame = &stream->frames.items[place];
        if (at.kind == TOKEN_HASH_ELSEIF || (at.kind == TOKEN_HASH_ELSE && !frame->has_cases)) {
            stream_fault_stray(stream, &at);
            return;
        }
        bool was_found = frame->is_found;
        frame->has_cases = true;
        bool holds = at.kind == TOKEN_HASH_ELSE || case_holds(stream, &at, frame->subject);
        frame = &stream->frames.items[place];
        if (stream->failed || was_found || holds) {
            frame->is_found = true;
            return;
        }
        Token opener = frame->opened_by;
        if (!stream_skip(stream, &opener, 1, true, NULL, &at)) {
            return;
        }
        if (at.kind == TOKEN_HASH_END) {
            stream_drop(stream, place);
            return;
        }
    }
}

static void between_branches(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    size_t place = stream_owner_of_middle(stream);
    Token last;
    FrameKind kind = place < stream->frames.count ? stream->frames.items[place].kind : FRAME_LIVE;
    bool is_case = reading->directive.kind == TOKEN_HASH_CASE || reading->directive.kind == TOKEN_HASH_RANGE;
    if (kind == FRAME_SWITCH && reading->directive.kind != TOKEN_HASH_ELSEIF) {
        next_case(stream, place, reading->directive);
    } else if (kind == FRAME_BRANCH && !is_case && !stream->frames.items[place].is_last) {
        Token opener = stream->frames.items[place].opened_by;
        if (stream_skip(stream, &opener, 1, false, NULL, &last)) {
            stream_drop(stream, place);
        }
    } else {
        stream_fault_stray(stream, &reading->directive);
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
        stream_drop_to(stream, place);
    } else if (!stream->hooks->step(stream->hooks->client, opener.span)) {
        stream_fail(stream);
    }
}

static void next_for(GrammarStream *stream, size_t place)
{
    Frame *frame = &stream->frames.items[place];
    bool holds = false;
    frame->at = 0;
    if (!stream->hooks->loop_turn(stream->hooks->client, &frame->loop, &holds)) {
        stream_fail(stream);
    } else if (!holds) {
        stream_drop_to(stream, place);
    } else if (!stream->hooks->step(stream->hooks->client, frame->opened_by.span)) {
        stream_fail(stream);
    }
}

// Keeps a loop's text up to its `#end` and pushes it.
static Frame *push_loop(GrammarStream *stream, FrameKind kind, const Token *opener)
{
    Tokens kept = {0};
    Frame *frame = NULL;
    if (stream_keep_to_end(stream, opener, &kept) && (frame = stream_push(stream, kind, opener)) != NULL) {
        frame->owned = grammar_text_new(kept.items, kept.count);
        frame->tokens = frame->owned != NULL ? frame->owned->tokens : NULL;
        frame->count = frame->owned != NULL ? kept.count : 0;
        if (frame->owned == NULL) {
            stream_fault(stream, DIAG_E0602, opener->span, "out of memory while reading the scene");
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
    AstNode *head = stream_parse(stream, TOKEN_START_FOR, NO_BASE, false);
    GrammarLoop loop = {0};
    bool holds = false;
    if (head == NULL || !stream->hooks->loop_begin(stream->hooks->client, head, &loop, &holds)) {
        stream_fail(stream);
        return;
    }
    arena_rewind(stream->context->arena, mark);
    Token last;
    if (!holds) {
        (void)stream_skip(stream, &reading->directive, 1, false, NULL, &last);
        return;
    }
    Frame *frame = push_loop(stream, FRAME_FOR, &reading->directive);
    if (frame != NULL) {
        frame->loop = loop;
        if (!stream->hooks->step(stream->hooks->client, reading->directive.span)) {
            stream_fail(stream);
        }
    }
}

static void end_directive(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    size_t place = stream_owner_of_middle(stream);
    if (place == stream->frames.count) {
        stream_fault_stray(stream, &reading->directive);
        return;
    }
    switch (stream->frames.items[place].kind) {
    case FRAME_WHILE: next_while(stream, place); break;
    case FRAME_FOR: next_for(stream, place); break;
    case FRAME_SWITCH:
        if (!stream->frames.items[place].has_cases) {
            stream_fault_stray(stream, &reading->directive);
            return;
        }
        stream_drop(stream, place);
        break;
    default: stream_drop(stream, place); break;
    }
}

// Leaves the innermost loop, #switch or macro.
static void break_out(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    unsigned branches = 0;
    bool is_from_file = false; // it leaves no macro that is called around the #include
    for (size_t i = stream->frames.count; i > 0; i--) {
        Frame *frame = &stream->frames.items[i - 1];
        Token opener = frame->opened_by, last;
        if (i <= stream->head_frames) {
            stream_fault(stream, DIAG_E0209, reading->directive.span, "`#break` cannot leave the head of a directive");
            return;
        }
        switch (frame->kind) {
        case FRAME_BRANCH: branches++; break;
        case FRAME_FILE: is_from_file = true; break;
        case FRAME_SWITCH:
            if (stream_skip(stream, &opener, branches + 1, false, NULL, &last)) {
                for (size_t j = stream->frames.count; j >= i; j--) {
                    if (j <= stream->frames.count && !frame_has_text(&stream->frames.items[j - 1])) {
                        stream_drop(stream, j - 1);
                    }
                }
            }
            return;
        case FRAME_MACRO:
            if (is_from_file) {
                i = 1;
                break;
            }
            stream_drop_to(stream, i - 1);
            return;
        case FRAME_WHILE:
        case FRAME_FOR: stream_drop_to(stream, i - 1); return;
        case FRAME_TEXT:
            if (stream->is_call) {
                stream_drop_to(stream, i - 1);
                return;
            }
            break;
        default: break;
        }
    }
    stream_fault(stream, DIAG_E0209, reading->directive.span, "no loop, `#switch` or macro that `#break` could leave");
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

// A part of a directive that began outside of the body.
static const Token *find_stray(const Tokens *kept)
{
    unsigned depth = 0;
    for (size_t i = 0; i < kept->count; i++) {
        DirectiveRole role = grammar_role(kept->items[i].kind);
        if (depth == 0 && (role == ROLE_ELSE || role == ROLE_MIDDLE)) {
            return &kept->items[i];
        }
        depth += role == ROLE_OPENS;
        depth -= role == ROLE_END && depth > 0;
    }
    return NULL;
}

// Its text is kept; the definition is kept parsed as well when its body holds whole items.
static void define_macro(Reading *reading)
{
    GrammarStream *stream = reading->stream;
    Tokens kept = {0};
    ArenaMark mark = arena_mark(stream->context->arena);
    AstNode *definition = NULL, *whole = NULL;
    bool is_whole = stream_keep_to_end(stream, &reading->directive, &kept);
    const Token *stray = is_whole ? find_stray(&kept) : NULL;
    if (stray != NULL) {
        stream_fault_stray(stream, stray);
    } else if (is_whole) {
        // The head is read again from what was kept.
        Frame *frame = stream_push(stream, FRAME_TEXT, &reading->directive);
        if (frame != NULL) {
            frame->tokens = kept.items;
            frame->count = kept.count;
            definition = stream_parse(stream, TOKEN_START_MACRO, NO_BASE, true);
            size_t at = stream->frames.count - 1;
            frame = &stream->frames.items[at];
            size_t begin = frame->at;
            stream_drop(stream, at);
            if (definition != NULL) {
                definition->span = span_join(reading->directive.span, kept.items[kept.count - 1].span);
                GrammarText *body = grammar_text_new(kept.items + begin, kept.count - 1 - begin);
                whole = parse_whole_macro(stream, &reading->directive, &kept);
                if (body == NULL || !stream->hooks->define(stream->hooks->client, whole != NULL ? whole : definition,
                                                           body)) {
                    stream_fail(stream);
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
    stream_unread(stream, &reading->directive);
    bool is_inside = stream->is_open || stream->within || !hooks->is_top;
    AstNode *node = stream_parse(stream, TOKEN_START_DIRECTIVE, 0, false);
    Source *source = node != NULL && is_inside ? hooks->include(hooks->client, node) : NULL;
    if (node != NULL && !is_inside && !hooks->run(hooks->client, node, false, 0)) {
        stream_fail(stream);
    }
    arena_rewind(stream->context->arena, mark);
    if (source == NULL) {
        stream->failed = stream->failed || hooks->is_stopped(hooks->client);
        return;
    }
    GrammarText *text = grammar_text_read(stream->context, source);
    source_close(source);
    Frame *frame = text != NULL ? stream_push(stream, FRAME_FILE, &reading->directive) : NULL;
    if (frame == NULL) {
        hooks->leave(hooks->client);
        free(text);
        stream_fail(stream);
        return;
    }
    frame->owned = text;
    frame->tokens = text->tokens;
    frame->count = text->count;
}

void stream_call_macro(GrammarStream *stream, const Token *name)
{
    ArenaMark mark = arena_mark(stream->context->arena);
    AstNode *call = stream_parse(stream, TOKEN_START_ARGUMENTS, 1, false);
    if (call == NULL) {
        return;
    }
    call->symbol = name->symbol;
    call->span = span_join(name->span, call->span);
    const GrammarText *text = stream->hooks->call(stream->hooks->client, call);
    arena_rewind(stream->context->arena, mark);
    if (text == NULL) {
        stream_fail(stream);
        return;
    }
    Frame *frame = stream_push(stream, FRAME_MACRO, name);
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
    stream_unread(stream, &reading->directive);
    size_t own = stream_own_text(stream);
    AstNode *node = stream_parse(stream, TOKEN_START_DIRECTIVE, 0, false);
    if (node != NULL &&
        !stream->hooks->run(stream->hooks->client, node, within, stream_scopes_since(stream, own))) {
        stream_fail(stream);
    }
    arena_rewind(stream->context->arena, mark);
}

void stream_run_directive(GrammarStream *stream, const Token *directive)
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
