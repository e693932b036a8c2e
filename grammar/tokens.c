// The token stream between the scanner and the parser.
//
// Passes tokens on, keeps the stack of open brackets and directives, says in the user's words what is wrong with a token
// that the parser refuses, and skips from there to a place where reading can go on. It owns the tables of word classes and
// directives; the shape of statements is the parser's alone.
//
// SPDX-License-Identifier: MIT
#include <stdarg.h>
#include <string.h>

#include "base/suggest.h"
#include "grammar/lexer.h"
#include "grammar/parser.h"

typedef enum DirectiveRole {
    ROLE_NONE,
    ROLE_SIMPLE, // stands alone
    ROLE_OPENS,  // wants an #end
    ROLE_MIDDLE, // inside one that wants an #end, with parentheses of its own
    ROLE_ELSE,
    ROLE_END,
} DirectiveRole;

typedef struct Directive {
    Word word;
    int token;
    DirectiveRole role;
} Directive;

static const Directive directives[] = {
    {W_declare, TOKEN_HASH_DECLARE, ROLE_SIMPLE},
    {W_local, TOKEN_HASH_LOCAL, ROLE_SIMPLE},
    {W_undef, TOKEN_HASH_UNDEF, ROLE_SIMPLE},
    {W_if, TOKEN_HASH_IF, ROLE_OPENS},
    {W_ifdef, TOKEN_HASH_IFDEF, ROLE_OPENS},
    {W_ifndef, TOKEN_HASH_IFNDEF, ROLE_OPENS},
    {W_elseif, TOKEN_HASH_ELSEIF, ROLE_MIDDLE},
    {W_else, TOKEN_HASH_ELSE, ROLE_ELSE},
    {W_end, TOKEN_HASH_END, ROLE_END},
    {W_switch, TOKEN_HASH_SWITCH, ROLE_OPENS},
    {W_case, TOKEN_HASH_CASE, ROLE_MIDDLE},
    {W_range, TOKEN_HASH_RANGE, ROLE_MIDDLE},
    {W_break, TOKEN_HASH_BREAK, ROLE_SIMPLE},
    {W_while, TOKEN_HASH_WHILE, ROLE_OPENS},
    {W_for, TOKEN_HASH_FOR, ROLE_OPENS},
    {W_macro, TOKEN_HASH_MACRO, ROLE_OPENS},
    {W_include, TOKEN_HASH_INCLUDE, ROLE_SIMPLE},
    {W_default, TOKEN_HASH_DEFAULT, ROLE_SIMPLE},
    {W_version, TOKEN_HASH_VERSION, ROLE_SIMPLE},
    {W_debug, TOKEN_HASH_DEBUG, ROLE_SIMPLE},
    {W_warning, TOKEN_HASH_WARNING, ROLE_SIMPLE},
    {W_error, TOKEN_HASH_ERROR, ROLE_SIMPLE},
    {W_render, TOKEN_HASH_RENDER, ROLE_SIMPLE},
    {W_statistics, TOKEN_HASH_STATISTICS, ROLE_SIMPLE},
    {W_fopen, TOKEN_HASH_FOPEN, ROLE_SIMPLE},
    {W_fclose, TOKEN_HASH_FCLOSE, ROLE_SIMPLE},
    {W_read, TOKEN_HASH_READ, ROLE_SIMPLE},
    {W_write, TOKEN_HASH_WRITE, ROLE_SIMPLE},
};

int grammar_word_token(Symbol symbol)
{
    static const short tokens[] = {
        [WORD_IDENTIFIER] = TOKEN_NAME,    [WORD_PLAIN] = TOKEN_WORD,         [WORD_COLOUR] = TOKEN_COLOUR,
        [WORD_TEXTURE] = TOKEN_TEXTURE,    [WORD_ARRAY] = TOKEN_ARRAY,        [WORD_FUNCTION] = TOKEN_FUNCTION,
        [WORD_BUILTIN] = TOKEN_BUILTIN,    [WORD_CONSTANT] = TOKEN_CONSTANT,  [WORD_DIRECTIVE] = TOKEN_DIRECTIVE_WORD,
    };
    return symbol == W_deprecated ? TOKEN_DEPRECATED : tokens[word_class(symbol)];
}

static const Directive *find_directive(int token)
{
    for (size_t i = 0; i < RT_COUNT_OF(directives); i++) {
        if (directives[i].token == token) {
            return &directives[i];
        }
    }
    return NULL;
}

static bool is_directive(int token)
{
    return token >= TOKEN_HASH_DECLARE && token <= TOKEN_HASH_WRITE;
}

static DirectiveRole role_of(int token)
{
    return is_directive(token) ? find_directive(token)->role : ROLE_NONE;
}

void grammar_fault(GrammarState *state, DiagCode code, Span span, const char *format, ...)
{
    TextBuffer text;
    va_list arguments;
    text_init(&text);
    va_start(arguments, format);
    text_vprintf(&text, format, arguments);
    va_end(arguments);
    diag_report(state->context->diags, code, span, "%s", text_get(&text));
    text_fini(&text);
    state->faulty = true;
    if (diag_is_full(state->context->diags)) {
        state->ended = true;
    }
}

int grammar_directive_token(GrammarState *state, const char *word, size_t length, Span span)
{
    Symbol symbol = intern_find(state->context->names, word, length);
    for (size_t i = 0; i < RT_COUNT_OF(directives); i++) {
        if (symbol == (Symbol)directives[i].word) {
            return directives[i].token;
        }
    }
    if (length == 0) {
        grammar_fault(state, DIAG_E0105, span, "the name of a directive must follow `#`");
        return TOKEN_INVALID;
    }
    Suggest suggest;
    suggest_begin(&suggest, word);
    for (size_t i = 0; i < RT_COUNT_OF(directives); i++) {
        suggest_offer(&suggest, intern_get(state->context->names, (Symbol)directives[i].word));
    }
    size_t kept = state->context->diags->count;
    grammar_fault(state, DIAG_E0105, span, "`#%.40s` is not a directive", word);
    if (suggest.best == NULL) {
        return TOKEN_INVALID;
    }
    if (state->context->diags->count > kept) {
        diag_suggest(state->context->diags, "did you mean `#%s`?", suggest.best);
    }
    int meant = grammar_directive_token(state, suggest.best, strlen(suggest.best), span);
    DirectiveRole role = role_of(meant);
    bool belongs = role == ROLE_SIMPLE || role == ROLE_OPENS || state->openers.count > 0;
    return belongs ? meant : TOKEN_INVALID;
}

// ---- What is open.

static Opener *innermost(GrammarState *state)
{
    return state->openers.count > 0 ? &state->openers.items[state->openers.count - 1] : NULL;
}

static bool is_open(GrammarState *state, int kind)
{
    return state->openers.count > 0 && innermost(state)->kind == kind;
}

static void push_opener(GrammarState *state, const Token *token)
{
    Opener opener = {.kind = token->kind, .span = token->span};
    switch (token->kind == '{' ? state->previous.kind : token->kind) {
    case TOKEN_NAME:
    case TOKEN_WORD:
    case TOKEN_TEXTURE:
    case TOKEN_FUNCTION:
        opener.word = state->previous.symbol;
        opener.span = span_join(state->previous.span, token->span);
        break;
    default:
        break;
    }
    if (!ARRAY_PUSH(&state->openers, opener)) {
        grammar_fault(state, DIAG_E0602, token->span, "out of memory while reading the scene");
        state->ended = true;
    }
}

static void pop_opener(GrammarState *state, int kind)
{
    if (is_open(state, kind)) {
        state->openers.count--;
    }
}

static void track_directive(GrammarState *state, const Token *token)
{
    Opener *open = innermost(state);
    bool within = open != NULL && is_directive(open->kind);
    switch (role_of(token->kind)) {
    case ROLE_OPENS:
        push_opener(state, token);
        break;
    case ROLE_MIDDLE:
        if (within) {
            open->header_done = false;
        }
        break;
    case ROLE_END:
        if (within) {
            state->openers.count--;
        }
        break;
    case ROLE_NONE:
    case ROLE_SIMPLE:
    case ROLE_ELSE:
        break;
    }
}

static void track(GrammarState *state, const Token *token)
{
    switch (token->kind) {
    case '{':
    case '(':
    case '[':
        push_opener(state, token);
        break;
    case '}':
        pop_opener(state, '{');
        break;
    case ']':
        pop_opener(state, '[');
        break;
    case ')':
        pop_opener(state, '(');
        if (state->openers.count > 0 && is_directive(innermost(state)->kind)) {
            innermost(state)->header_done = true;
        }
        break;
    default:
        if (is_directive(token->kind)) {
            track_directive(state, token);
        }
        break;
    }
}

// ---- Words for messages.

static void describe(const GrammarState *state, const Token *token, TextBuffer *out)
{
    const Directive *directive = find_directive(token->kind);
    if (directive != NULL) {
        text_printf(out, "`#%s`", intern_get(state->context->names, (Symbol)directive->word));
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
        describe(state, &(Token){.kind = opener->kind}, out);
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
        {"a number", EXPECT_VALUE}, {"a string", EXPECT_VALUE},  {"a constant", EXPECT_VALUE},
        {"a function", EXPECT_VALUE}, {"'!'", EXPECT_VALUE},     {"a name", EXPECT_NAME},
        {"'+'", EXPECT_SIGN},       {"'-'", EXPECT_SIGN},        {"'*'", EXPECT_OPERATOR},
        {"'/'", EXPECT_OPERATOR},   {"'.'", EXPECT_OPERATOR},    {"'['", EXPECT_OPERATOR},
        {"'&'", EXPECT_OPERATOR},   {"'|'", EXPECT_OPERATOR},    {"'?'", EXPECT_OPERATOR},
        {"'<'", EXPECT_RELATION},   {"'>'", EXPECT_RELATION},    {"'='", EXPECT_RELATION},
        {"<=", EXPECT_OPERATOR},    {">=", EXPECT_OPERATOR},     {"!=", EXPECT_OPERATOR},
        {"a word", EXPECT_WORD},    {"a colour word", EXPECT_WORD}, {"texture", EXPECT_WORD},
        {"array", EXPECT_WORD},     {"function", EXPECT_WORD},   {"#declare", EXPECT_ITEM},
        {"#if", EXPECT_NOTHING},    {"#ifdef", EXPECT_NOTHING},  {"#ifndef", EXPECT_NOTHING},
        {"#switch", EXPECT_NOTHING}, {"#include", EXPECT_NOTHING},
        {"an unreadable token", EXPECT_NOTHING},                 {"the next item", EXPECT_NOTHING},
        {"a directive's word", EXPECT_NOTHING},                {"deprecated", EXPECT_NOTHING},
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

static bool is_reserved_word(int token)
{
    switch (token) {
    case TOKEN_CONSTANT:
    case TOKEN_BUILTIN:
    case TOKEN_WORD:
    case TOKEN_COLOUR:
    case TOKEN_TEXTURE:
    case TOKEN_ARRAY:
    case TOKEN_FUNCTION:
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
    bool header = is_directive(outer->kind) && !outer->header_done && outer[1].kind == '(';
    return header && ((outer->kind == TOKEN_HASH_FOR && state->previous.kind == '(') || outer->kind == TOKEN_HASH_MACRO);
}

static bool report_reserved(GrammarState *state)
{
    if (!is_reserved_word(state->current.kind) || !names_something(state)) {
        return false;
    }
    grammar_fault(state, DIAG_E0106, state->current.span, "`%s` is a reserved word and cannot be declared",
                  intern_get(state->context->names, state->current.symbol));
    return true;
}

static void report_end_of_file(GrammarState *state, const char *expected)
{
    const Opener *opener = innermost(state);
    if (opener == NULL) {
        grammar_fault(state, DIAG_E0106, state->current.span, "%s, found the end of the file", expected);
    } else {
        size_t kept = state->context->diags->count;
        const char *end = is_directive(opener->kind) ? "#end" : opener->kind == '{' ? "}" : opener->kind == '(' ? ")" : "]";
        TextBuffer text;
        text_init(&text);
        describe_opener(state, opener, &text);
        grammar_fault(state, DIAG_E0107, state->current.span, "the file ends before the `%s` of %s", end, text_get(&text));
        text_fini(&text);
        note_opener(state, opener, kept);
    }
    state->ended = true;
}

// The innermost opener below the innermost one that is (or is not) a directive; NULL if there is none.
static const Opener *outer_opener(GrammarState *state, bool directive)
{
    for (size_t i = state->openers.count; i > 1; i--) {
        const Opener *outer = &state->openers.items[i - 2];
        if (is_directive(outer->kind) == directive) {
            return outer;
        }
    }
    return NULL;
}

// One end of a bracket inside a directive's branch and the other outside, or the reverse: nothing after it can be trusted.
static bool report_split(GrammarState *state)
{
    DirectiveRole role = role_of(state->current.kind);
    bool ends_branch = role == ROLE_MIDDLE || role == ROLE_ELSE || role == ROLE_END;
    const Opener *opener = innermost(state);
    if (opener == NULL || (!ends_branch && state->current.kind != '}') || ends_branch == is_directive(opener->kind)) {
        return false;
    }
    const Opener *outer = outer_opener(state, ends_branch);
    if (outer == NULL || (ends_branch ? opener->kind : outer->kind) != '{') {
        return false;
    }
    TextBuffer found, inner;
    text_init(&found);
    text_init(&inner);
    describe(state, &state->current, &found);
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
    const Opener *opener = innermost(state);
    DirectiveRole role = role_of(state->current.kind);
    if (role == ROLE_NONE || expected->seen[EXPECT_ITEM] == (role == ROLE_SIMPLE || role == ROLE_OPENS)) {
        return false;
    }
    text_init(&text);
    describe(state, &state->current, &text);
    if (role == ROLE_SIMPLE || role == ROLE_OPENS) {
        bool in_value = expected->seen[EXPECT_VALUE] || expected->seen[EXPECT_OPERATOR];
        if (in_value) {
            state->past_directive = true;
            grammar_fault(state, DIAG_E0109, state->current.span,
                          "%s stands inside an expression or a list of values; a directive stands between whole items",
                          text_get(&text));
        }
        text_fini(&text);
        return in_value;
    }
    if (opener == NULL || !is_directive(opener->kind)) {
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

static void report_general(GrammarState *state, const Expected *expected)
{
    TextBuffer text;
    text_init(&text);
    bool listed = !expected->seen[EXPECT_ITEM] && expected->count > 0 && expected->count <= ALTERNATIVES;
    if (listed) {
        text_append(&text, "expected ");
        describe_expected(expected, &text);
    } else {
        text_append(&text, "unexpected ");
        describe(state, &state->current, &text);
    }
    if (state->previous.kind != 0) {
        text_append(&text, " after ");
        describe(state, &state->previous, &text);
    }
    if (state->current.kind == TOKEN_END_OF_FILE) {
        report_end_of_file(state, text_get(&text));
    } else {
        if (listed) {
            text_append(&text, ", found ");
            describe(state, &state->current, &text);
        }
        grammar_fault(state, DIAG_E0106, state->current.span, "%s", text_get(&text));
    }
    text_fini(&text);
}

void grammar_report_syntax(GrammarState *state, const char *const *names, size_t count)
{
    if (state->ended || state->builder.failed) {
        return;
    }
    state->skips = true;
    state->past_directive = false;
    Expected expected = sort_expected(names, count);
    if (state->current.kind != TOKEN_INVALID && !report_reserved(state) && !report_split(state) &&
        !report_misplaced_directive(state, &expected)) {
        report_general(state, &expected);
    }
}

// ---- Delivery, and going on after a fault.

// Old scenes write `declare` and `default` without `#`; POV-Ray warns and goes on, and so do we.
static void supply_hash(GrammarState *state, Token *token, int before)
{
    if ((token->symbol == W_declare || token->symbol == W_default) && before != '.') {
        const char *word = intern_get(state->context->names, token->symbol);
        diag_report(state->context->diags, DIAG_W0101, token->span, "`%s` should have a `#` before it", word);
        token->kind = grammar_directive_token(state, word, strlen(word), token->span);
    }
}

static void next_token(GrammarState *state, Token *token)
{
    if (state->held_count > 0) {
        *token = state->held[--state->held_count];
    } else if (!state->ended && !state->builder.failed) {
        int before = state->current.kind;
        state->file_name = before == TOKEN_HASH_INCLUDE;
        if (grammar_scan(token, state->scanner) == TOKEN_DIRECTIVE_WORD) {
            supply_hash(state, token, before);
        }
    }
    if (RT_UNLIKELY(state->ended || state->builder.failed)) {
        *token = (Token){.kind = TOKEN_END_OF_FILE, .span = {state->offset, state->offset}};
    }
}

static void hold_token(GrammarState *state, Token token)
{
    state->held[state->held_count++] = token; // the last one held is the first to be delivered
}

// In the parentheses after a directive: to their end, or to what cannot stand in them.
static void skip_header(GrammarState *state, size_t level, Token token)
{
    for (Token last = {0};; last = token, next_token(state, &token)) {
        if (token.kind == TOKEN_END_OF_FILE || token.kind == '{' || token.kind == '}' || token.kind == ';' ||
            is_directive(token.kind)) {
            hold_token(state, token);
            if (token.kind == '{' && (is_reserved_word(last.kind) || last.kind == TOKEN_NAME)) {
                hold_token(state, last); // the block is whole
            }
            state->openers.count = level;
            state->openers.items[level - 1].header_done = true;
            return;
        }
        track(state, &token);
        if (state->openers.count == level && state->openers.items[level - 1].header_done) {
            return;
        }
    }
}

// Whether skipping among items ends before this token, which is then delivered.
static bool ends_skipping(const GrammarState *state, size_t level, const Token *token)
{
    DirectiveRole role = role_of(token->kind);
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
    return ends_branch && level > 0 && is_directive(openers[level - 1].kind) && !is_directive(openers[count - 1].kind);
}

// Among items: to the `}` that ends the block, up to a directive, or past a `;` or a whole block.
static void skip_items(GrammarState *state, size_t level, Token token)
{
    bool was_among_items = state->openers.count == level;
    state->openers.count = level;
    DirectiveRole role = role_of(token.kind);
    bool inside_value = state->past_directive;
    unsigned semicolons = inside_value && role == ROLE_SIMPLE ? 2 : 1;
    if (was_among_items && role != ROLE_NONE && !inside_value && role != ROLE_SIMPLE && role != ROLE_OPENS) {
        return; // it belongs to nothing
    }
    bool passes = inside_value;
    while (passes || !ends_skipping(state, level, &token)) {
        passes = false;
        bool among_items = state->openers.count <= level;
        track(state, &token);
        if ((token.kind == ';' && among_items && --semicolons == 0) ||
            (token.kind == '}' && state->openers.count <= level)) {
            return;
        }
        next_token(state, &token);
    }
    state->openers.count = level;
    hold_token(state, token);
}

static void skip(GrammarState *state)
{
    state->skips = false;
    size_t level = state->openers.count;
    while (level > 0 && (state->openers.items[level - 1].kind == '(' || state->openers.items[level - 1].kind == '[')) {
        level--;
    }
    const Opener *opener = level > 0 ? &state->openers.items[level - 1] : NULL;
    if (opener != NULL && is_directive(opener->kind) && !opener->header_done) {
        skip_header(state, level, state->current);
    } else {
        skip_items(state, level, state->current);
    }
    state->current.kind = TOKEN_RESYNC;
    state->current.span = (Span){state->current.span.end, state->current.span.end};
}

void grammar_next_token(GrammarState *state)
{
    next_token(state, &state->current);
}

static const char *kind_name(int kind)
{
    if (kind == TOKEN_END_OF_FILE) {
        return "end";
    }
    if (kind == TOKEN_NUMBER || kind == TOKEN_STRING) {
        return kind == TOKEN_NUMBER ? "number" : "string";
    }
    if (is_directive(kind)) {
        return "directive";
    }
    return kind == TOKEN_NAME ? "name" : is_reserved_word(kind) ? "word" : "mark";
}

void grammar_describe_token(const GrammarState *state, const Token *token, TextBuffer *out)
{
    text_printf(out, "%s ", kind_name(token->kind));
    if (token->kind == TOKEN_STRING) {
        text_printf(out, "\"%s\"", intern_get(state->context->names, token->symbol));
    } else {
        describe(state, token, out);
    }
}

int grammar_yylex(GRAMMAR_YYSTYPE *value, Span *span, GrammarState *state)
{
    if (RT_UNLIKELY(state->skips)) {
        skip(state);
    } else {
        track(state, &state->current);
        state->previous = state->current;
        next_token(state, &state->current);
    }
    if (state->current.kind == TOKEN_NUMBER) {
        value->number = state->current.number;
    } else {
        value->symbol = state->current.symbol;
    }
    *span = state->current.span;
    return state->current.kind;
}
