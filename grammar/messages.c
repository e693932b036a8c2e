// What is said about a token that the parser refuses, in the user's words.
//
// Turns the tokens that the parser would take into a short list of alternatives, and knows the faults that deserve more
// than that: ends of file, reserved words, brackets split by a directive, directives inside values. Reads the state of
// the token stream; what happens after the message is the stream's matter.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "grammar/lexer.h"
#include "grammar/parser.h"

// ---- Words for messages.

void grammar_describe(const GrammarState *state, const Token *token, TextBuffer *out)
{
    if (grammar_is_directive(token->kind)) {
        text_printf(out, "`#%s`", intern_get(state->context->names, grammar_directive_word(token->kind)));
    } else if (token->kind == TOKEN_NUMBER) {
        text_append_char(out, '`');
        text_append_double(out, token->number);
        text_append_char(out, '`');
    } else if (token->kind == TOKEN_STRING) {
        text_append(out, "the string");
    } else if (token->kind == TOKEN_END_OF_FILE) {
        text_append(out, "the end of the file");
    } else if (token->kind < 256) {
        text_printf(out, "`%c`", token->kind);
    } else if (token->kind == TOKEN_LESS_EQUAL || token->kind == TOKEN_GREATER_EQUAL) {
        text_append(out, token->kind == TOKEN_LESS_EQUAL ? "`<=`" : "`>=`");
    } else if (token->kind == TOKEN_NOT_EQUAL) {
        text_append(out, "`!=`");
    } else {
        text_printf(out, "`%.60s`", intern_get(state->context->names, token->symbol));
    }
}

static void describe_opener(GrammarState *state, const Opener *opener, TextBuffer *out)
{
    if (opener->kind == '{' && opener->word != SYMBOL_NONE) {
        text_printf(out, "`%.60s {`", intern_get(state->context->names, opener->word));
    } else {
        grammar_describe(state, &(Token){.kind = opener->kind}, out);
    }
}

static void note_opener(GrammarState *state, const Opener *opener, size_t kept)
{
    if (state->context->diags->count > kept) {
        TextBuffer text;
        text_init(&text);
        describe_opener(state, opener, &text);
        diag_note(state->context->diags, opener->span, "%s opened here", text_get(&text));
        text_fini(&text);
    }
}

// What the parser would take, by the names that its tokens have in parser.y.
typedef enum ExpectedClass {
    EXPECT_OTHER,    // named by itself
    EXPECT_VALUE,    // starts an expression
    EXPECT_NAME,     // so does a name, which is also wanted alone
    EXPECT_SIGN,     // starts or continues one
    EXPECT_OPERATOR, // continues one
    EXPECT_RELATION, // inside parentheses, else a vector's brackets
    EXPECT_WORD,     // starts a block, a colour, an array, a function
    EXPECT_ITEM,     // a directive that is no value: here an item can start
    EXPECT_NOTHING,  // never named
} ExpectedClass;

static ExpectedClass expected_class(const char *name)
{
    static const struct {
        const char *name;
        ExpectedClass class;
    } classes[] = {
        {"a number", EXPECT_VALUE},
        {"a string", EXPECT_VALUE},
        {"a constant", EXPECT_VALUE},
        {"a function", EXPECT_VALUE},
        {"'!'", EXPECT_VALUE},
        {"a name", EXPECT_NAME},
        {"'+'", EXPECT_SIGN},
        {"'-'", EXPECT_SIGN},
        {"'*'", EXPECT_OPERATOR},
        {"'/'", EXPECT_OPERATOR},
        {"'.'", EXPECT_OPERATOR},
        {"'['", EXPECT_OPERATOR},
        {"'&'", EXPECT_OPERATOR},
        {"'|'", EXPECT_OPERATOR},
        {"'?'", EXPECT_OPERATOR},
        {"'<'", EXPECT_RELATION},
        {"'>'", EXPECT_RELATION},
        {"'='", EXPECT_RELATION},
        {"<=", EXPECT_OPERATOR},
        {">=", EXPECT_OPERATOR},
        {"!=", EXPECT_OPERATOR},
        {"a word", EXPECT_WORD},
        {"a colour word", EXPECT_WORD},
        {"texture", EXPECT_WORD},
        {"array", EXPECT_WORD},
        {"function", EXPECT_WORD},
        {"xyz", EXPECT_WORD},
        {"#declare", EXPECT_ITEM},
        {"#if", EXPECT_NOTHING},
        {"#ifdef", EXPECT_NOTHING},
        {"#ifndef", EXPECT_NOTHING},
        {"#switch", EXPECT_NOTHING},
        {"#include", EXPECT_NOTHING},
        {"an unreadable token", EXPECT_NOTHING},
        {"the next item", EXPECT_NOTHING},
        {"a directive's word", EXPECT_NOTHING},
        {"deprecated", EXPECT_NOTHING},
        {"a vector of numbers", EXPECT_NOTHING},
        {"the items of a block", EXPECT_NOTHING},
    };
    for (size_t i = 0; i < RT_COUNT_OF(classes); i++) {
        if (strcmp(name, classes[i].name) == 0) {
            return classes[i].class;
        }
    }
    return EXPECT_OTHER;
}

enum { ALTERNATIVES = 4 };

typedef struct Expected {
    bool seen[EXPECT_NOTHING + 1];
    bool relations; // `<`, `=` and `>` are operators here
    const char *names[ALTERNATIVES];
    size_t count; // may be greater than ALTERNATIVES
} Expected;

static void expect(Expected *expected, const char *name)
{
    if (expected->count < ALTERNATIVES) {
        expected->names[expected->count] = name;
    }
    expected->count++;
}

static Expected sort_expected(const char *const *names, size_t count)
{
    Expected expected = {0};
    for (size_t i = 0; i < count; i++) {
        expected.seen[expected_class(names[i])] = true;
        expected.relations |= strcmp(names[i], "<=") == 0;
    }
    const bool *seen = expected.seen;
    // After a whole expression the signs and operators are not what is missing.
    bool continues = seen[EXPECT_OPERATOR] && (seen[EXPECT_SIGN] || !seen[EXPECT_VALUE]);
    if (!continues && seen[EXPECT_VALUE]) {
        expect(&expected, seen[EXPECT_WORD] ? "a value" : "a number or vector");
    } else if (!continues && seen[EXPECT_NAME]) {
        expect(&expected, seen[EXPECT_WORD] ? "a word" : "a name");
    }
    for (size_t i = 0; i < count; i++) {
        ExpectedClass class = expected_class(names[i]);
        bool bracket = strcmp(names[i], "'('") == 0;
        bool closes = strcmp(names[i], "'>'") == 0 || (strcmp(names[i], "'='") == 0 && !seen[EXPECT_VALUE]);
        if ((class == EXPECT_OTHER && !(bracket && (seen[EXPECT_VALUE] || seen[EXPECT_OPERATOR]))) ||
            (class == EXPECT_RELATION && closes && !expected.relations)) {
            expect(&expected, names[i]);
        }
    }
    return expected;
}

static void describe_expected(const Expected *expected, TextBuffer *out)
{
    for (size_t i = 0; i < expected->count; i++) {
        const char *name = expected->names[i];
        text_append(out, i == 0 ? "" : i + 1 == expected->count ? " or " : ", ");
        if (*name == '\'') {
            text_printf(out, "`%c`", name[1]);
        } else if (*name == '#') {
            text_printf(out, "`%s`", name);
        } else {
            text_append(out, name);
        }
    }
}

// ---- Faults at the current token.

bool grammar_is_reserved(int token)
{
    switch (token) {
    case TOKEN_CONSTANT:
    case TOKEN_BUILTIN:
    case TOKEN_WORD:
    case TOKEN_COLOUR:
    case TOKEN_TEXTURE:
    case TOKEN_ARRAY:
    case TOKEN_FUNCTION:
    case TOKEN_TERM:
    case TOKEN_DIRECTIVE_WORD:
    case TOKEN_DEPRECATED:
        return true;
    default:
        return false;
    }
}

// A place where the scene gives a name to something: after #declare, or in the parentheses of #for and #macro.
static bool names_something(const GrammarState *state)
{
    switch (state->previous.kind) {
    case TOKEN_HASH_DECLARE:
    case TOKEN_HASH_LOCAL:
    case TOKEN_HASH_UNDEF:
    case TOKEN_HASH_MACRO:
    case TOKEN_HASH_FOPEN:
        return true;
    default:
        break;
    }
    if (state->openers.count < 2) {
        return false;
    }
    const Opener *outer = &state->openers.items[state->openers.count - 2];
    bool header = grammar_is_directive(outer->kind) && !outer->header_done && outer[1].kind == '(';
    return header &&
           ((outer->kind == TOKEN_HASH_FOR && state->previous.kind == '(') || outer->kind == TOKEN_HASH_MACRO);
}

static bool report_reserved(GrammarState *state)
{
    if (!grammar_is_reserved(state->current.kind) || !names_something(state)) {
        return false;
    }
    grammar_fault(state, DIAG_E0106, state->current.span, "`%s` is a reserved word and cannot be declared",
                  intern_get(state->context->names, state->current.symbol));
    return true;
}

// The first of the braces that are open within each other.
static const Opener *outermost_brace(const GrammarState *state)
{
    size_t at = state->openers.count - 1;
    while (at > 0 && state->openers.items[at - 1].kind == '{') {
        at--;
    }
    return &state->openers.items[at];
}

static void report_end_of_file(GrammarState *state, const char *expected)
{
    const Opener *opener = grammar_innermost(state);
    if (opener == NULL) {
        grammar_fault(state, DIAG_E0106, state->current.span, "%s, found the end of the file", expected);
    } else {
        size_t kept = state->context->diags->count;
        const char *end = grammar_is_directive(opener->kind) ? "#end"
                          : opener->kind == '{'              ? "}"
                          : opener->kind == '('              ? ")"
                                                             : "]";
        TextBuffer text;
        text_init(&text);
        describe_opener(state, opener, &text);
        grammar_fault(state, DIAG_E0107, state->current.span, "the file ends before the `%s` of %s", end,
                      text_get(&text));
        text_fini(&text);
        note_opener(state, opener, kept);
        if (opener->kind == '{' && state->context->diags->count > kept) {
            grammar_hint_brace(state, outermost_brace(state));
        }
    }
    state->ended = true;
}

// The innermost opener below the innermost one that is (or is not) a directive; NULL if there is none.
static const Opener *outer_opener(GrammarState *state, bool directive)
{
    for (size_t i = state->openers.count; i > 1; i--) {
        const Opener *outer = &state->openers.items[i - 2];
        if (grammar_is_directive(outer->kind) == directive) {
            return outer;
        }
    }
    return NULL;
}

// A macro without a text where one is needed, and a directive that ends what is parsed.
static bool report_cut(GrammarState *state)
{
    const Token *silent = &state->feed->silent;
    if (silent->kind != 0) {
        grammar_fault(state, DIAG_E0213, silent->span, "the macro `%s` gives no value here",
                      intern_get(state->context->names, silent->symbol));
        return true;
    }
    if (state->ended_by.kind == 0 || state->current.kind != TOKEN_END_OF_FILE) {
        return false;
    }
    TextBuffer text;
    text_init(&text);
    grammar_describe(state, &state->ended_by, &text);
    grammar_fault(state, DIAG_E0221, state->ended_by.span, "%s ends the expression before it, which is not whole here",
                  text_get(&text));
    text_fini(&text);
    return true;
}

// One end of a bracket inside a directive's branch and the other outside, or the reverse: nothing after it can be
// trusted.
static bool is_in_macro(const GrammarState *state)
{
    for (size_t i = 0; i < state->openers.count; i++) {
        if (state->openers.items[i].kind == TOKEN_HASH_MACRO) {
            return true;
        }
    }
    return false;
}

static bool report_split(GrammarState *state)
{
    DirectiveRole role = grammar_role(state->current.kind);
    bool ends_branch = role == ROLE_MIDDLE || role == ROLE_ELSE || role == ROLE_END;
    const Opener *opener = grammar_innermost(state);
    if (opener == NULL || (!ends_branch && state->current.kind != '}') ||
        ends_branch == grammar_is_directive(opener->kind)) {
        return false;
    }
    const Opener *outer = outer_opener(state, ends_branch);
    bool closes_callers = !ends_branch && outer == NULL && is_in_macro(state);
    if (!closes_callers && (outer == NULL || (ends_branch ? opener->kind : outer->kind) != '{')) {
        return false;
    }
    if (grammar_tear(state)) {
        return true;
    }
    if (closes_callers) {
        return false;
    }
    TextBuffer found, inner;
    text_init(&found);
    text_init(&inner);
    grammar_describe(state, &state->current, &found);
    describe_opener(state, opener, &inner);
    size_t kept = state->context->diags->count;
    grammar_fault(state, DIAG_E0109, state->current.span,
                  "%s stands inside %s: each branch or body of a directive must hold whole items", text_get(&found),
                  text_get(&inner));
    text_fini(&found);
    text_fini(&inner);
    note_opener(state, opener, kept);
    note_opener(state, outer, kept);
    state->ended = true;
    return true;
}

static bool report_misplaced_directive(GrammarState *state, const Expected *expected)
{
    TextBuffer text;
    const Opener *opener = grammar_innermost(state);
    DirectiveRole role = grammar_role(state->current.kind);
    if (role == ROLE_NONE || expected->seen[EXPECT_ITEM] == (role == ROLE_SIMPLE || role == ROLE_OPENS)) {
        return false;
    }
    if (opener == NULL && state->unknown_directives > 0 && role != ROLE_SIMPLE && role != ROLE_OPENS) {
        state->unknown_directives -= role == ROLE_END;
        return true; // it belongs to a directive that has been reported
    }
    text_init(&text);
    grammar_describe(state, &state->current, &text);
    if (role == ROLE_SIMPLE || role == ROLE_OPENS) {
        bool in_value = expected->seen[EXPECT_VALUE] || expected->seen[EXPECT_OPERATOR];
        if (in_value && !grammar_tear(state)) {
            state->past_directive = true;
            grammar_fault(state, DIAG_E0109, state->current.span,
                          "%s stands inside an expression or a list of values; a directive stands between whole items",
                          text_get(&text));
        }
        text_fini(&text);
        return in_value;
    }
    if (opener == NULL || !grammar_is_directive(opener->kind)) {
        grammar_fault(state, DIAG_E0106, state->current.span, "%s without the directive that it belongs to",
                      text_get(&text));
    } else {
        text_append(&text, " does not belong to ");
        describe_opener(state, opener, &text);
        grammar_fault(state, DIAG_E0106, state->current.span, "%s here", text_get(&text));
    }
    text_fini(&text);
    return true;
}

// The other end of a bracket that is not open; false: it is open, or the current token is none.
static bool report_unopened(GrammarState *state)
{
    int kind = state->current.kind;
    bool knows_openers = state->feed == NULL; // a fragment knows its own only
    int opener = !knows_openers ? 0 : kind == '}' ? '{' : kind == ')' ? '(' : kind == ']' ? '[' : 0;
    for (size_t i = 0; i < state->openers.count; i++) {
        opener = state->openers.items[i].kind == opener ? 0 : opener;
    }
    if (opener == 0) {
        return false;
    }
    if (kind == '}' && state->unopened_braces < state->context->diags->reported[DIAG_E0257]) {
        state->unopened_braces++; // it belongs to the brace whose lack was reported
        state->faulty = true;
    } else {
        grammar_fault(state, DIAG_E0106, state->current.span, "no `%c` is open here", opener);
    }
    return true;
}

static bool report_missing_brace(GrammarState *state, const Expected *expected)
{
    int before = state->previous.kind;
    bool is_word = before == TOKEN_WORD || before == TOKEN_TEXTURE;
    if (!is_word || expected->count != 1 || strcmp(expected->names[0], "'{'") != 0) {
        return false;
    }
    grammar_fault(state, DIAG_E0257, state->previous.span, "`{` is missing after `%s`",
                  intern_get(state->context->names, state->previous.symbol));
    state->unopened_braces++; // skipping ends with it
    return true;
}

static void report_general(GrammarState *state, const Expected *expected)
{
    TextBuffer text;
    bool listed = !expected->seen[EXPECT_ITEM] && expected->count > 0 && expected->count <= ALTERNATIVES;
    if ((!listed && report_unopened(state)) || (listed && report_missing_brace(state, expected))) {
        return;
    }
    text_init(&text);
    if (listed) {
        text_append(&text, "expected ");
        describe_expected(expected, &text);
    } else {
        text_append(&text, "unexpected ");
        grammar_describe(state, &state->current, &text);
    }
    if (state->previous.kind != 0 && state->previous.kind != TOKEN_RESYNC) {
        text_append(&text, " after ");
        grammar_describe(state, &state->previous, &text);
    }
    if (state->current.kind == TOKEN_END_OF_FILE) {
        report_end_of_file(state, text_get(&text));
    } else {
        if (listed) {
            text_append(&text, ", found ");
            grammar_describe(state, &state->current, &text);
        }
        size_t kept = state->context->diags->count;
        grammar_fault(state, DIAG_E0106, state->current.span, "%s", text_get(&text));
        if (state->context->diags->count > kept) {
            grammar_hint_token(state, listed && expected->count == 1 && strcmp(expected->names[0], "')'") == 0);
        }
    }
    text_fini(&text);
}

// The first token of a branch, or the one after its #end: the text around the directive may make sense of it.
static bool is_after_branch(const GrammarState *state)
{
    const Opener *opener = state->openers.count > 0 ? &state->openers.items[state->openers.count - 1] : NULL;
    int before = state->previous.kind;
    bool is_first = opener != NULL && grammar_is_directive(opener->kind) && opener->header_done && before == ')';
    DirectiveRole role = grammar_role(state->current.kind);
    bool may_begin = role == ROLE_NONE || role == ROLE_SIMPLE || role == ROLE_OPENS;
    return may_begin && state->current.kind != TOKEN_END_OF_FILE &&
           (is_first || before == TOKEN_HASH_ELSE || before == TOKEN_HASH_END);
}

// A call in a place where none can stand: its text may make sense there.
static bool is_at_macro(const GrammarState *state)
{
    const GrammarHooks *hooks = state->context->hooks;
    return hooks != NULL && state->current.kind == TOKEN_NAME && hooks->is_macro(hooks->client, state->current.symbol);
}

// The end of a branch, where more is expected.
static bool cuts_branch(GrammarState *state)
{
    DirectiveRole role = grammar_role(state->current.kind);
    const Opener *opener = grammar_innermost(state);
    bool is_item = grammar_is_directive(state->previous.kind); // what is wrong is the directive itself
    bool is_inside =
        !is_item && opener != NULL && (grammar_is_directive(opener->kind) || outer_opener(state, true) != NULL);
    return is_inside && (role == ROLE_MIDDLE || role == ROLE_ELSE || role == ROLE_END);
}

// Whether the fault is a directive, or one that holds other text, or a call of a macro, stands in the present item before
// it: it may make sense once they are resolved, or never be read.
static bool has_directives(const GrammarState *state)
{
    if (grammar_role(state->current.kind) == ROLE_OPENS && !grammar_is_directive(state->previous.kind)) {
        return true;
    }
    for (size_t i = 0; i < state->openers.count; i++) {
        if (grammar_is_directive(state->openers.items[i].kind)) {
            return true;
        }
    }
    const GrammarHooks *hooks = state->context->hooks;
    bool has_text = hooks != NULL && state->item_begin != 0 && state->item_begin < state->current.span.begin;
    GrammarText *text =
        has_text ? grammar_text_again(state->context, (Span){state->item_begin, state->current.span.begin}) : NULL;
    bool found = false;
    for (size_t i = 0; text != NULL && i < text->count && !found; i++) {
        const Token *token = &text->tokens[i];
        DirectiveRole role = grammar_role(token->kind);
        bool is_before_brace = role == ROLE_SIMPLE && i > 0 && state->current.kind == '{';
        found = is_before_brace || (role != ROLE_NONE && role != ROLE_SIMPLE) || token->kind == TOKEN_HASH_INCLUDE ||
                (token->kind == TOKEN_NAME && hooks->is_macro(hooks->client, token->symbol));
    }
    free(text);
    return found;
}

void grammar_report_syntax(GrammarState *state, const char *const *names, size_t count)
{
    if (state->ended || state->builder.failed) {
        return;
    }
    state->skips = true;
    state->past_directive = false;
    Expected expected = sort_expected(names, count);
    if (state->feed != NULL) {
        state->ended = true;
        state->skips = false;
        Span at = state->ended_by.kind != 0 ? state->ended_by.span : state->current.span;
        if (state->feed->failed || grammar_feed_is_refused(state->feed, at)) {
            return;
        }
        if (state->current.kind == TOKEN_INVALID) {
            grammar_report_unreadable(state, &state->current);
        } else if (!report_cut(state)) {
            report_general(state, &expected);
        }
        return;
    }
    if ((is_after_branch(state) || cuts_branch(state) || is_at_macro(state)) && grammar_tear(state)) {
        return;
    }
    bool is_reported = state->current.kind == TOKEN_INVALID && state->current.known == NULL;
    bool in_value = expected.seen[EXPECT_VALUE] || expected.seen[EXPECT_OPERATOR];
    bool is_resolved = grammar_role(state->current.kind) == ROLE_SIMPLE && !in_value;
    if (!is_reported && state->current.kind != TOKEN_END_OF_FILE && (is_resolved || has_directives(state)) &&
        grammar_tear(state)) {
        state->torn_by_fault = true;
        return;
    }
    if (state->current.kind == TOKEN_INVALID) {
        grammar_report_unreadable(state, &state->current);
        return;
    }
    if (!report_reserved(state) && !report_split(state) && !report_misplaced_directive(state, &expected)) {
        report_general(state, &expected);
    }
}
