// What the parser is given of a splice: tokens without directives and calls, and names with what they stand for.
//
// Runs the directives and calls that stand before the next token, and decides where one ends what is being parsed.
// Builds the nodes of names and operators, which are worked out as soon as they are whole. Owns nothing.
//
// SPDX-License-Identifier: MIT
#include "grammar/splice.h"

enum { MATRIX_COMPONENTS = 12 };

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
        return true;
    case '>':
        return state->ends_vector;
    default:
        return state->after_dot;
    }
}

// Keeps `<` as an opener where it begins a vector, and the place of a function's body.
static void track_more(GrammarState *state)
{
    const Token *last = &state->previous;
    const Opener *open = grammar_innermost(state);
    state->after_dot = state->last_but_one == '.';
    state->is_declared = state->last_but_one == TOKEN_HASH_DECLARE || state->last_but_one == TOKEN_HASH_LOCAL;
    state->is_target = last->kind != '=' && (state->is_target || state->is_declared);
    state->last_but_one = last->kind;
    if (last->kind == '<' && !state->ends_before) {
        Opener vector = {.kind = '<', .span = last->span};
        if (!ARRAY_PUSH(&state->openers, vector)) {
            state->ended = true;
        }
    }
    state->ends_vector = last->kind == '>' && open != NULL && open->kind == '<'; // else a relation
    if (state->ends_vector) {
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

// In the parameters or the numbers of a function, but not in a block that it is made of.
static bool is_in_function(const GrammarState *state)
{
    bool is_there = state->function_begins || state->function_level > 0;
    for (size_t i = state->function_level; is_there && state->function_level > 0 && i < state->openers.count; i++) {
        is_there = state->openers.items[i].kind != '{';
    }
    return is_there;
}

// Where an element of an array or an item in it begins or has ended, no directive and no call may stand.
static bool is_between_elements(const GrammarState *state)
{
    const Opener *open = state->array_level > 0 ? &state->openers.items[state->openers.count - 1] : NULL;
    int last = state->previous.kind;
    return open != NULL && open->kind == '{' && (state->ends_before || last == '{' || last == ',');
}

bool stream_is_at_call(GrammarStream *stream, const GrammarState *state, const Token *token)
{
    return token->kind == TOKEN_NAME && state->previous.kind != '.' &&
           stream->hooks->is_macro(stream->hooks->client, token->symbol) && stream_peek_kind(stream) == '(';
}

// True when a directive, which is complete, stands at the end of the text in which it began: what it declares belongs
// to the scope of that text, which is not left before.
static bool is_at_own_end(GrammarStream *stream, const GrammarState *state)
{
    size_t at;
    while ((at = stream_innermost_text(stream)) > state->own_frame && at == stream->frames.count) {
        const Frame *frame = &stream->frames.items[at - 1];
        if ((frame->kind != FRAME_MACRO && frame->kind != FRAME_FILE) || frame->at < frame->count) {
            return false;
        }
        stream_drop(stream, at - 1);
    }
    const Frame *own = at == state->own_frame && at > 0 ? &stream->frames.items[at - 1] : NULL;
    return own != NULL && own->kind != FRAME_LIVE && own->at == own->count;
}

// A directive or a call that ends what is parsed.
static void cut(GrammarStream *stream, GrammarState *state, Token *token)
{
    state->ended_by = *token;
    stream_unread(stream, token);
    *token = (Token){.kind = TOKEN_END_OF_FILE, .span = {token->span.begin, token->span.begin}};
}

static void capture(GrammarStream *stream, Token *token)
{
    // The base of an element is looked up with its index, which stands right behind it.
    if (token->kind == TOKEN_NAME && !stream_is_before(stream, '[')) {
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

// Where POV-Ray looks at the next token as it stands and runs no directive or call.
static bool is_as_it_stands(const GrammarState *state, const Token *token)
{
    const Opener *open = state->openers.count > 0 ? &state->openers.items[state->openers.count - 1] : NULL;
    if ((state->array_begins || state->is_target) && state->ends_before && open != NULL && open->kind == '[') {
        return true;
    }
    switch (state->previous.kind) {
    case TOKEN_HASH_DECLARE:
    case TOKEN_HASH_LOCAL:
    case TOKEN_HASH_UNDEF:
    case TOKEN_HASH_VERSION:
    case TOKEN_ARRAY: return true;
    case '.':
        return (state->base_depth != NO_BASE && state->openers.count <= (size_t)state->base_depth) ||
               (state->array_begins && open != NULL && open->kind == '[');
    case TOKEN_NAME: return state->is_declared;
    case '(':
        return state->openers.count == 1 && (state->fragment == TOKEN_START_SUBJECT ||
                                             (state->fragment == TOKEN_START_FOR && token->kind == TOKEN_NAME));
    case 0:
    case TOKEN_START_CONDITION:
    case TOKEN_START_RANGE: return state->fragment == TOKEN_START_CONDITION || state->fragment == TOKEN_START_RANGE;
    default: return false;
    }
}

// A part of a directive, in the head of another, that began before that head.
static bool ends_outside(const GrammarState *state, const Token *token)
{
    DirectiveRole role = grammar_role(token->kind);
    bool is_part = role == ROLE_ELSE || role == ROLE_MIDDLE || role == ROLE_END;
    return stream_is_head(state->fragment) && is_part && stream_open_directives(state->stream) <= state->open_before;
}

// Runs a directive or a call, if one may stand here.
static void resolve(GrammarState *state, const Token *token)
{
    GrammarStream *stream = state->stream;
    bool is_directive = grammar_is_directive(token->kind);
    if (is_between_elements(state)) {
        stream_fault(stream, DIAG_E0223, token->span,
                     "no directive and no macro call can stand here, in the elements of an array");
    } else if (is_directive && ends_outside(state, token)) {
        stream_fault_stray(stream, token);
    } else if (is_directive) {
        stream_run_directive(stream, token);
    } else {
        stream_call_macro(stream, token);
    }
}

// A string, a block, or the name of what is no number: no directive ends that.
static bool is_no_number(const GrammarStream *stream, const Token *token)
{
    const GrammarHooks *hooks = stream->hooks;
    return token->kind == TOKEN_STRING || token->kind == '}' ||
           (token->kind == TOKEN_NAME && token->known != NULL && !hooks->is_number(hooks->client, token->known));
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
        bool may_end = (state->ends_before || state->previous.kind == ';') && !state->function_begins;
        bool is_over = may_end && state->own_frame > 0 && state->openers.count == 0 && is_at_own_end(stream, state);
        if (is_over || stream->failed || state->ended || state->builder.failed) {
            stream_deliver_end(stream, token);
            return;
        }
        stream_read(stream, token);
        bool is_directive = grammar_is_directive(token->kind);
        if (begins) {
            state->takes_string = takes_string(token->kind);
            state->takes_mode = token->kind == TOKEN_HASH_FOPEN;
            state->takes_elements = token->kind == TOKEN_HASH_UNDEF || token->kind == TOKEN_HASH_READ;
            state->own_frame = stream_innermost_text(stream);
            if (stream->live != NULL && stream->frames.items[state->own_frame - 1].kind == FRAME_TEXT) {
                state->own_frame = 1; // what is read again ends where the live text goes on
            }
            break;
        }
        // What follows a declaration may be anything, but for a second semicolon.
        bool is_past_end = state->fragment == TOKEN_START_DIRECTIVE && state->previous.kind == ';' &&
                           state->openers.count == 0 && token->kind != ';';
        if (is_past_end) {
            stream_unread(stream, token);
            stream_deliver_end(stream, token);
            return;
        }
        // No operator continues a string.
        if (state->takes_string && state->ends_before && state->openers.count == 0 && token->kind != '[') {
            stream_unread(stream, token);
            stream_deliver_end(stream, token);
            return;
        }
        if (state->is_raw || is_as_it_stands(state, token) || (!is_directive && !stream_is_at_call(stream, state, token))) {
            break;
        }
        bool is_passed = state->fragment == TOKEN_START_SUBJECT && grammar_role(token->kind) == ROLE_SIMPLE;
        is_passed |= state->takes_mode;
        is_passed |= state->fragment == TOKEN_START_ARGUMENTS && is_no_number(stream, &state->previous);
        if (may_end && !is_passed && state->base_depth != NO_BASE &&
            state->openers.count <= (size_t)state->base_depth) {
            cut(stream, state, token);
            return;
        }
        resolve(state, token);
    }
    if (token->kind == '[' && state->previous.kind == TOKEN_NAME && state->previous.known != NULL) {
        stream_fault(stream, DIAG_E0106, token->span, "`[` must stand right behind the name of the array");
    }
    size_t from = stream_innermost_text(stream);
    if (state->fragment == TOKEN_START_FOR && token->kind == TOKEN_NAME && state->previous.kind == '(' &&
        state->openers.count == 1) {
        state->counter_frame = from > 0 && stream->frames.items[from - 1].kind == FRAME_TEXT ? 0 : from;
    }
    if (from > 0 && stream->frames.items[from - 1].kind == FRAME_MACRO) {
        stream->silent.kind = 0;
    }
    if (!state->is_raw) {
        capture(stream, token);
    }
}

AstNode *grammar_name(GrammarState *state, Symbol symbol, Span span)
{
    AstNode *node = ast_node(&state->builder, AST_NAME, AST_OP_NONE, symbol, span, NULL, NULL, NULL);
    if (RT_UNLIKELY(state->stream != NULL)) {
        // With a token after it read, the name is the one before.
        const Token *token = state->current.span.begin == span.begin ? &state->current : &state->previous;
        ast_flag(node, AST_KNOWN)->known = token->known;
    }
    return node;
}

// The name of a function that is called stands for what it is now, too. Its `(` is still open.
AstNode *grammar_call(GrammarState *state, AstNode *node)
{
    if (RT_LIKELY(state->stream == NULL) || !is_in_function(state)) {
        return grammar_fold(state, node);
    }
    node->b = ast_node(&state->builder, AST_NAME, AST_OP_NONE, node->symbol, node->span, NULL, NULL, NULL);
    ast_flag(node->b, AST_KNOWN)->known = grammar_innermost(state)->callee;
    return node;
}

AstNode *grammar_end_declare(GrammarState *state, AstNode *node)
{
    const AstNode *target = node->a;
    bool is_own = target != NULL && target->kind == AST_NAME && state->current.kind == TOKEN_NAME &&
                  state->current.symbol == target->symbol && state->current.span.begin >= node->span.end;
    return is_own ? ast_flag(node, AST_BEFORE_NAME) : node;
}

AstNode *grammar_end_version(GrammarState *state, AstNode *node)
{
    const GrammarHooks *hooks = state->context->hooks;
    const Token *next = state->ended_by.kind != 0 ? &state->ended_by : &state->current;
    bool is_name = next->kind == TOKEN_NAME && next->span.begin >= node->span.end;
    bool is_call = is_name && hooks != NULL && hooks->is_macro(hooks->client, next->symbol);
    return is_call ? ast_flag(node, AST_BEFORE_NAME) : node;
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
            // What a directive gives may be no argument, or several.
            pastes |= is_bare_call(part) || (part->kind == AST_INLINE && node->kind == AST_CALL);
        }
        break;
    default: break;
    }
    return pastes ? ast_flag(node, AST_PASTES) : node;
}

// Twelve components, which are worked out each by itself: no value holds them all.
static bool is_matrix(const AstNode *node)
{
    size_t count = 0;
    for (const AstNode *part = node->kind == AST_VECTOR ? node->a : NULL; part != NULL; part = part->next) {
        count++;
    }
    return count == MATRIX_COMPONENTS;
}

static AstNode *fold(GrammarState *state, AstNode *node)
{
    if (!is_matrix(node) && !(node->flags & AST_KNOWN) && !state->builder.failed && !state->stream->failed) {
        state->stream->hooks->fold(state->stream->hooks->client, node);
        state->stream->failed = state->stream->hooks->is_stopped(state->stream->hooks->client);
    }
    return node;
}

AstNode *grammar_fold(GrammarState *state, AstNode *node)
{
    if (RT_LIKELY(state->stream == NULL)) {
        return mark_pastes(node);
    }
    return is_in_function(state) ? node : fold(state, node);
}

// Before a token after it is read, which may be a call that changes the array.
AstNode *grammar_element(GrammarState *state, AstNode *node)
{
    if (RT_LIKELY(state->stream == NULL) || state->takes_elements) {
        return node;
    }
    GrammarHooks *hooks = state->stream->hooks;
    int next = stream_peek_kind(state->stream);
    bool is_whole = next != '[' && next != '=' && !hooks->lacks_index(hooks->client, node);
    return is_whole ? fold(state, node) : node;
}
