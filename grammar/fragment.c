// Fragments: an item, an expression or the head of a directive, parsed from tokens that somebody else delivers.
//
// Has the directives and calls resolved that stand before the next token, and decides where one ends what is being
// parsed. Builds the nodes of names and operators, which are computed as soon as they are whole. Owns nothing. Knows
// nothing of what directives do.
//
// SPDX-License-Identifier: MIT
#include "grammar/lexer.h"
#include "grammar/parser.h"

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

static bool is_at_call(const GrammarState *state, const Token *token)
{
    const GrammarHooks *hooks = state->context->hooks;
    return token->kind == TOKEN_NAME && state->previous.kind != '.' && hooks->is_macro(hooks->client, token->symbol) &&
           state->feed->calls->peek(state->feed) == '(';
}

// A directive or a call that ends what is parsed.
static void cut(GrammarState *state, Token *token)
{
    state->ended_by = *token;
    state->feed->calls->unread(state->feed, token);
    *token = (Token){.kind = TOKEN_END_OF_FILE, .span = {token->span.begin, token->span.begin}};
}

static void capture(const GrammarState *state, Token *token)
{
    // The base of an element is looked up with its index, which stands right behind it.
    if (token->kind == TOKEN_NAME && !state->feed->calls->is_before(state->feed, '[')) {
        const GrammarHooks *hooks = state->context->hooks;
        token->known = hooks->capture(hooks->client, token->symbol, token->span);
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
        return (state->base_depth != GRAMMAR_NO_BASE && state->openers.count <= (size_t)state->base_depth) ||
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

// Has a directive or a call resolved, if one may stand here.
static void resolve(const GrammarState *state, const Token *token)
{
    if (is_between_elements(state)) {
        grammar_feed_fault(state->feed, DIAG_E0223, token->span,
                           "no directive and no macro call can stand here, in the elements of an array");
    } else {
        state->feed->calls->resolve(state->feed, token);
    }
}

// A string, a block, or the name of what is no number: no directive ends that.
static bool is_no_number(const GrammarState *state, const Token *token)
{
    const GrammarHooks *hooks = state->context->hooks;
    return token->kind == TOKEN_STRING || token->kind == '}' ||
           (token->kind == TOKEN_NAME && token->known != NULL && !hooks->is_number(hooks->client, token->known));
}

static void deliver_end(const GrammarFeed *feed, Token *token)
{
    *token = (Token){.kind = TOKEN_END_OF_FILE, .span = {feed->end.end, feed->end.end}};
}

// The first token of a directive, whose text it is in.
static void begin_directive(GrammarState *state, const Token *token)
{
    const GrammarFeed *feed = state->feed;
    state->takes_string = takes_string(token->kind);
    state->takes_mode = token->kind == TOKEN_HASH_FOPEN;
    state->takes_elements = token->kind == TOKEN_HASH_UNDEF || token->kind == TOKEN_HASH_READ;
    // What is read again ends where the live text continues.
    state->own_place = feed->live != NULL && feed->is_kept ? 1 : feed->place;
}

void grammar_fragment_token(GrammarState *state, Token *token)
{
    GrammarFeed *feed = state->feed;
    track_more(state);
    feed->silent.kind = 0;
    state->ends_before = ends_operand(state);
    bool begins = state->begins_raw;
    state->begins_raw = false;
    for (;;) {
        bool may_end = (state->ends_before || state->previous.kind == ';') && !state->function_begins;
        bool is_over = may_end && state->own_place > 0 && state->openers.count == 0 &&
                       feed->calls->is_at_end(feed, state->own_place);
        if (is_over || feed->failed || state->ended || state->builder.failed) {
            deliver_end(feed, token);
            return;
        }
        feed->calls->read(feed, token);
        bool is_directive = grammar_is_directive(token->kind);
        if (begins) {
            begin_directive(state, token);
            break;
        }
        // What follows a declaration may be anything, but for a second semicolon.
        bool is_past_end = state->fragment == TOKEN_START_DIRECTIVE && state->previous.kind == ';' &&
                           state->openers.count == 0 && token->kind != ';';
        // No operator continues a string.
        bool is_past_string = state->takes_string && state->ends_before && state->openers.count == 0 &&
                              token->kind != '[';
        if (is_past_end || is_past_string) {
            feed->calls->unread(feed, token);
            deliver_end(feed, token);
            return;
        }
        if (state->is_raw || is_as_it_stands(state, token) || (!is_directive && !is_at_call(state, token))) {
            break;
        }
        bool is_passed = state->fragment == TOKEN_START_SUBJECT && grammar_role(token->kind) == ROLE_SIMPLE;
        is_passed |= state->takes_mode;
        is_passed |= state->fragment == TOKEN_START_ARGUMENTS && is_no_number(state, &state->previous);
        if (may_end && !is_passed && state->base_depth != GRAMMAR_NO_BASE &&
            state->openers.count <= (size_t)state->base_depth) {
            cut(state, token);
            return;
        }
        resolve(state, token);
    }
    if (token->kind == '[' && state->previous.kind == TOKEN_NAME && state->previous.known != NULL) {
        grammar_feed_fault(feed, DIAG_E0106, token->span, "`[` must stand right behind the name of the array");
    }
    if (state->fragment == TOKEN_START_FOR && token->kind == TOKEN_NAME && state->previous.kind == '(' &&
        state->openers.count == 1) {
        state->counter_place = feed->is_kept ? 0 : feed->place;
    }
    if (feed->is_call) {
        feed->silent.kind = 0;
    }
    if (!state->is_raw) {
        capture(state, token);
    }
}

AstNode *grammar_name(GrammarState *state, Symbol symbol, Span span)
{
    AstNode *node = ast_node(&state->builder, (AstHead){AST_NAME, AST_OP_NONE, symbol, span}, NULL, NULL, NULL);
    if (RT_UNLIKELY(state->feed != NULL)) {
        // With a token after it read, the name is the one before.
        const Token *token = state->current.span.begin == span.begin ? &state->current : &state->previous;
        ast_flag(node, AST_KNOWN)->known = token->known;
    }
    return node;
}

// The name of a function that is called stands for what it is now, too. Its `(` is still open.
AstNode *grammar_call(GrammarState *state, AstNode *node)
{
    if (RT_LIKELY(state->feed == NULL) || !is_in_function(state)) {
        return grammar_fold(state, node);
    }
    node->b = ast_node(&state->builder, (AstHead){AST_NAME, AST_OP_NONE, node->symbol, node->span}, NULL, NULL, NULL);
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

// Twelve components, which are computed each by itself: no value holds them all.
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
    const GrammarHooks *hooks = state->context->hooks;
    if (!is_matrix(node) && !(node->flags & AST_KNOWN) && !state->builder.failed && !state->feed->failed) {
        state->feed->failed = !hooks->fold(hooks->client, node);
    }
    return node;
}

AstNode *grammar_fold(GrammarState *state, AstNode *node)
{
    if (RT_LIKELY(state->feed == NULL)) {
        return mark_pastes(node);
    }
    return is_in_function(state) ? node : fold(state, node);
}

// Before a token after it is read, which may be a call that changes the array.
AstNode *grammar_element(GrammarState *state, AstNode *node)
{
    if (RT_LIKELY(state->feed == NULL) || state->takes_elements) {
        return node;
    }
    const GrammarHooks *hooks = state->context->hooks;
    int next = state->feed->calls->peek(state->feed);
    bool is_whole = next != '[' && next != '=' && !hooks->lacks_index(hooks->client, node);
    return is_whole ? fold(state, node) : node;
}

// ---- the whole

static const int starts[] = {
    [FRAGMENT_ITEM] = TOKEN_START_ITEM,           [FRAGMENT_EXPRESSION] = TOKEN_START_FULL,
    [FRAGMENT_DIRECTIVE] = TOKEN_START_DIRECTIVE, [FRAGMENT_CONDITION] = TOKEN_START_CONDITION,
    [FRAGMENT_SUBJECT] = TOKEN_START_SUBJECT,     [FRAGMENT_RANGE] = TOKEN_START_RANGE,
    [FRAGMENT_FOR] = TOKEN_START_FOR,             [FRAGMENT_MACRO] = TOKEN_START_MACRO,
    [FRAGMENT_ARGUMENTS] = TOKEN_START_ARGUMENTS,
};

AstNode *grammar_parse_fragment(GrammarFeed *feed, Fragment *fragment)
{
    GrammarState state;
    grammar_begin(&state, feed->context);
    state.offset = feed->end.end;
    state.feed = feed;
    state.start = state.fragment = starts[fragment->kind];
    state.base_depth = fragment->base_depth;
    state.is_raw = fragment->is_raw;
    state.takes_elements = fragment->kind == FRAGMENT_SUBJECT;
    state.begins_raw = fragment->kind == FRAGMENT_DIRECTIVE;
    bool fine = grammar_yyparse(&state) == 0 && !state.faulty && !state.builder.failed && !feed->failed;
    fragment->counter_place = state.counter_place;
    fragment->is_cut = state.ended_by.kind != 0;
    if (fine && state.has_lookahead && state.ended_by.kind == 0) {
        feed->calls->unread(feed, &state.current);
    }
    ARRAY_FREE(&state.openers);
    return fine ? state.result : NULL;
}

void grammar_finish(GrammarState *state, AstNode *result, bool has_lookahead)
{
    state->result = result;
    state->has_lookahead = has_lookahead;
}

bool grammar_feed_is_refused(GrammarFeed *feed, Span at)
{
    const GrammarState *live = feed->live;
    // The text of a macro was fine when it was defined.
    bool is_there = live != NULL && live->torn_by_fault && at.begin == live->torn_at.span.begin && feed->macros == 0;
    feed->is_refused = feed->is_refused || (is_there && !feed->failed);
    feed->failed = feed->failed || is_there;
    return feed->is_refused;
}

bool grammar_feed_may_report(GrammarFeed *feed)
{
    return !feed->failed && !grammar_feed_is_refused(feed, feed->end);
}

void grammar_feed_fault(GrammarFeed *feed, DiagCode code, Span span, const char *text)
{
    if (!grammar_feed_is_refused(feed, feed->end)) {
        diag_report(feed->context->diags, code, span, "%s", text);
    }
    feed->failed = true;
}
