// From a token that the parser refuses to a place where reading can continue.
//
// Tokens are passed over by the stack of open brackets and directives, which is then as at that place; the parser is
// given TOKEN_RESYNC.
//
// SPDX-License-Identifier: MIT
#include "grammar/lexer.h"
#include "grammar/parser.h"

// In the parentheses after a directive: to their end, or to what cannot stand in them.
static void skip_header(GrammarState *state, size_t level, Token token)
{
    for (Token last = {0};; last = token, grammar_read_token(state, &token)) {
        if (token.kind == TOKEN_END_OF_FILE || token.kind == '{' || token.kind == '}' || token.kind == ';' ||
            grammar_is_directive(token.kind)) {
            grammar_hold_token(state, token);
            if (token.kind == '{' && (grammar_is_reserved(last.kind) || last.kind == TOKEN_NAME)) {
                grammar_hold_token(state, last); // the block is whole
            }
            state->openers.count = level;
            state->openers.items[level - 1].header_done = true;
            return;
        }
        grammar_track(state, &token);
        if (state->openers.count == level && state->openers.items[level - 1].header_done) {
            return;
        }
    }
}

// Whether skipping among items ends before this token, which is then delivered.
static bool ends_skipping(const GrammarState *state, size_t level, const Token *token)
{
    DirectiveRole role = grammar_role(token->kind);
    const Opener *openers = state->openers.items;
    size_t count = state->openers.count;
    if (token->kind == TOKEN_END_OF_FILE) {
        return true;
    }
    if (count <= level) {
        return role != ROLE_NONE || (token->kind == '}' && level > 0 && openers[level - 1].kind == '{');
    }
    // An open brace among what is skipped does not outlive the branch that it stands in.
    bool ends_branch = role == ROLE_MIDDLE || role == ROLE_ELSE || role == ROLE_END;
    return ends_branch && level > 0 && grammar_is_directive(openers[level - 1].kind) &&
           !grammar_is_directive(openers[count - 1].kind);
}

// A `;` right after what was skipped ends the same statement.
static void skip_semicolon(GrammarState *state)
{
    Token token;
    grammar_read_token(state, &token);
    if (token.kind != ';') {
        grammar_hold_token(state, token);
    }
}

// Those of a case that belongs to nothing.
static void skip_parentheses(GrammarState *state, DirectiveRole role)
{
    Token token;
    if (role != ROLE_MIDDLE) {
        return;
    }
    grammar_read_token(state, &token);
    if (token.kind != '(') {
        grammar_hold_token(state, token);
        return;
    }
    for (unsigned depth = 1; depth > 0;) {
        grammar_read_token(state, &token);
        depth += token.kind == '(';
        depth -= token.kind == ')';
        if (token.kind == TOKEN_END_OF_FILE || token.kind == ';' || grammar_is_directive(token.kind)) {
            grammar_hold_token(state, token);
            return;
        }
    }
}

// Among items: to the `}` that ends the block, up to a directive, or past a `;` or a whole block.
static void skip_items(GrammarState *state, size_t level, Token token)
{
    bool was_among_items = state->openers.count == level;
    state->openers.count = level;
    DirectiveRole role = grammar_role(token.kind);
    bool inside_value = state->past_directive;
    unsigned semicolons = inside_value && role == ROLE_SIMPLE ? 2 : 1;
    if (was_among_items && role != ROLE_NONE && !inside_value && role != ROLE_SIMPLE && role != ROLE_OPENS) {
        skip_parentheses(state, role);
        return; // it belongs to nothing
    }
    bool passes = inside_value;
    while (passes || !ends_skipping(state, level, &token)) {
        passes = false;
        bool among_items = state->openers.count <= level;
        grammar_track(state, &token);
        if (token.kind == ';' && among_items && --semicolons == 0) {
            return;
        }
        if (token.kind == '}' && state->openers.count <= level) {
            skip_semicolon(state);
            return;
        }
        grammar_read_token(state, &token);
    }
    state->openers.count = level;
    grammar_hold_token(state, token);
}

void grammar_skip(GrammarState *state)
{
    state->skips = false;
    size_t level = state->openers.count;
    while (level > 0 && (state->openers.items[level - 1].kind == '(' || state->openers.items[level - 1].kind == '[')) {
        level--;
    }
    const Opener *opener = level > 0 ? &state->openers.items[level - 1] : NULL;
    if (opener != NULL && grammar_is_directive(opener->kind) && !opener->header_done) {
        skip_header(state, level, state->current);
    } else {
        skip_items(state, level, state->current);
    }
    state->current.kind = TOKEN_RESYNC;
    state->current.span = (Span){state->current.span.end, state->current.span.end};
}
