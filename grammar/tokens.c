// The token stream between the scanner and the parser.
//
// Passes tokens on and keeps the stack of open brackets and directives. What words are is the matter of directives.c,
// what is said of a fault that of messages.c, and where reading continues then that of recovery.c; the shape of
// statements is the parser's alone.
//
// SPDX-License-Identifier: MIT
#include <stdarg.h>
#include <string.h>

#include "grammar/lexer.h"
#include "grammar/parser.h"

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

// ---- What is open.

Opener *grammar_innermost(GrammarState *state)
{
    return state->openers.count > 0 ? &state->openers.items[state->openers.count - 1] : NULL;
}

static bool is_open(GrammarState *state, int kind)
{
    return state->openers.count > 0 && grammar_innermost(state)->kind == kind;
}

static void push_opener(GrammarState *state, const Token *token)
{
    Opener opener = {.kind = token->kind, .span = token->span};
    if (token->kind == '(' && state->previous.kind == TOKEN_NAME) {
        opener.callee = state->previous.known;
    }
    if (token->kind == '(' && state->previous.kind == TOKEN_WORD) {
        opener.word = state->previous.symbol; // a block that was meant
    }
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
    Opener *open = grammar_innermost(state);
    bool within = open != NULL && grammar_is_directive(open->kind);
    switch (grammar_role(token->kind)) {
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

void grammar_track(GrammarState *state, const Token *token)
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
        if (state->openers.count > 0 && grammar_is_directive(grammar_innermost(state)->kind)) {
            state->head_end = grammar_innermost(state)->header_done ? state->head_end : token->span.end;
            grammar_innermost(state)->header_done = true;
        }
        break;
    default:
        if (grammar_is_directive(token->kind)) {
            track_directive(state, token);
        }
        break;
    }
}

// ---- Delivery.

// Old scenes write `declare` and `default` without `#`; POV-Ray warns and continues, and so do we.
static void supply_hash(GrammarState *state, Token *token, int before)
{
    if ((token->symbol == W_declare || token->symbol == W_default) && before != '.') {
        const char *word = intern_get(state->context->names, token->symbol);
        diag_report(state->context->diags, DIAG_W0101, token->span, "`%s` should have a `#` before it", word);
        token->kind = grammar_directive_token(state, word, strlen(word), token->span);
    }
}

void grammar_read_token(GrammarState *state, Token *token)
{
    if (state->held_count > 0) {
        *token = state->held[--state->held_count];
    } else if (state->token_count > 0) {
        *token = *state->tokens++;
        state->token_count--;
        state->offset = token->span.end;
    } else if (state->scanner == NULL) {
        state->ended = true;
    } else if (!state->ended && !state->builder.failed) {
        state->file_name = state->last_read == TOKEN_HASH_INCLUDE;
        // What is scanned behind the last fault that is reported is not there any more.
        if (grammar_scan(state, token) == TOKEN_DIRECTIVE_WORD && !state->ended) {
            supply_hash(state, token, state->last_read);
        }
        token->known = NULL;
        if (RT_UNLIKELY(state->is_unreadable)) {
            state->is_unreadable = false;
            token->kind = TOKEN_INVALID;
            token->known = token;
        }
        state->last_read = token->kind;
    }
    if (RT_UNLIKELY(state->ended || state->builder.failed)) {
        *token = (Token){.kind = TOKEN_END_OF_FILE, .span = {state->offset, state->offset}};
    }
}

void grammar_hold_token(GrammarState *state, Token token)
{
    state->held[state->held_count++] = token; // the last one held is the first to be delivered
}

void grammar_next_token(GrammarState *state)
{
    grammar_read_token(state, &state->current);
}

static const char *kind_name(int kind)
{
    if (kind == TOKEN_END_OF_FILE) {
        return "end";
    }
    if (kind == TOKEN_NUMBER || kind == TOKEN_STRING) {
        return kind == TOKEN_NUMBER ? "number" : "string";
    }
    if (grammar_is_directive(kind)) {
        return "directive";
    }
    return kind == TOKEN_NAME ? "name" : grammar_is_reserved(kind) ? "word" : "mark";
}

void grammar_describe_token(const GrammarState *state, const Token *token, TextBuffer *out)
{
    text_printf(out, "%s ", kind_name(token->kind));
    if (token->kind == TOKEN_STRING) {
        text_printf(out, "\"%s\"", intern_get(state->context->names, token->symbol));
    } else {
        grammar_describe(state, token, out);
    }
}

// A sign right after the head, an #else or the end of a directive (or the string that it takes) may belong to the value
// before it, or the value may continue after the #end: then it is not a value of its own.
static bool is_doubtful_sign(const GrammarState *state)
{
    if (state->current.kind != '+' && state->current.kind != '-') {
        return false;
    }
    const Opener *open = state->openers.items;
    size_t count = state->openers.count;
    switch (state->previous.kind) {
    case TOKEN_HASH_ELSE:
    case TOKEN_HASH_END:
    case TOKEN_STRING:
    case ';': return true;
    case ')':
        return count > 0 && state->previous.span.end == state->head_end && open[count - 1].kind != TOKEN_HASH_MACRO;
    default: return false;
    }
}

// Faults within what was found to be wrong when it was read again, too, are reported as they are met.
static bool can_tear(const GrammarState *state)
{
    return state->can_splice && state->context->diags->error_count == state->faults_before &&
           state->current.span.begin >= state->told_to;
}

// Whether the text is read again with its directives resolved, or never: what is wrong in it may not matter.
static bool is_deferred(const GrammarState *state)
{
    bool defers = state->is_quiet;
    for (size_t i = 0; i < state->openers.count && !defers && can_tear(state); i++) {
        defers = grammar_is_directive(state->openers.items[i].kind);
    }
    return defers;
}

bool grammar_scan_defers(GrammarState *state)
{
    state->is_unreadable = is_deferred(state);
    return state->is_unreadable;
}

bool grammar_tear(GrammarState *state)
{
    if (!can_tear(state)) {
        return false;
    }
    state->torn = state->ended = true;
    state->skips = false;
    state->torn_at = state->current;
    return true;
}

// The name of a macro whose text opens or closes what others close or open.
static bool calls_unbalanced(const GrammarState *state)
{
    const GrammarHooks *hooks = state->context->hooks;
    return hooks != NULL && *hooks->has_unbalanced && state->current.kind == TOKEN_NAME &&
           state->previous.kind != TOKEN_HASH_MACRO && hooks->is_unbalanced(hooks->client, state->current.symbol);
}

// The function `internal(N)`; without parentheses it is a word, which begins a font of `text`.
static void settle_internal(GrammarState *state)
{
    Token next;
    grammar_read_token(state, &next);
    grammar_hold_token(state, next);
    state->current.kind = next.kind == '(' ? TOKEN_BUILTIN : TOKEN_WORD;
}

// From the scanner's buffer at once, if nothing forbids it.
static bool read_quick(GrammarState *state)
{
    bool may_be_quick = state->quick != NULL && state->held_count == 0 && !state->ended && !state->builder.failed &&
                        state->last_read != TOKEN_HASH_INCLUDE;
    if (!may_be_quick || !grammar_scan_quick(state, &state->current)) {
        return false;
    }
    int kind = state->current.kind;
    state->last_read = kind == TOKEN_VECTOR ? '>' : kind == TOKEN_ITEMS ? '}' : kind;
    return true;
}

// What stands before the next token: of several that were read at once the last.
static void pass_current(GrammarState *state)
{
    state->after_dot = state->previous.kind == '.';
    state->previous = state->current;
    int kind = state->current.kind;
    if (kind == TOKEN_VECTOR || kind == TOKEN_ITEMS) {
        state->previous.kind = kind == TOKEN_VECTOR ? '>' : '}';
        state->previous.span.begin = state->previous.span.end - 1;
        state->previous.symbol = SYMBOL_NONE;
    }
}

// A name that is not declared begins where a number ends: 0x1F, 1.5f. Reading continues as if it were not there.
static bool refuse_suffix(GrammarState *state)
{
    const GrammarHooks *hooks = state->context->hooks;
    const Token *name = &state->current;
    if (name->kind != TOKEN_NAME || state->previous.kind != TOKEN_NUMBER ||
        name->span.begin != state->previous.span.end || hooks == NULL || is_deferred(state) ||
        hooks->capture(hooks->client, name->symbol, name->span) != NULL) {
        return false;
    }
    grammar_fault(state, DIAG_E0106, name->span, "`%s` stands at the end of a number, which is decimal and has no suffix",
                  intern_get(state->context->names, name->symbol));
    return true;
}

static void next_token(GrammarState *state)
{
    grammar_track(state, &state->current);
    if (RT_UNLIKELY(state->feed != NULL)) {
        state->previous = state->current;
        grammar_fragment_token(state, &state->current);
        return;
    }
    pass_current(state);
    if (RT_UNLIKELY(state->passed.kind != 0)) {
        state->previous = state->passed;
        state->passed.kind = 0;
    } else if (state->item_begin == 0 && state->statements != NULL && state->held_count == 0) {
        grammar_read_statements(state);
    }
    if (!read_quick(state)) {
        grammar_read_token(state, &state->current);
    }
    if (RT_UNLIKELY(state->current.kind == TOKEN_BUILTIN && state->current.symbol == W_internal)) {
        settle_internal(state);
    }
    if (RT_UNLIKELY(refuse_suffix(state))) {
        state->current.kind = TOKEN_INVALID;
    }
    if (state->item_begin == 0) {
        state->item_begin = state->current.span.begin;
        state->faults_before = state->context->diags->error_count;
    }
    if (RT_UNLIKELY(is_doubtful_sign(state) || calls_unbalanced(state)) && grammar_tear(state)) {
        grammar_read_token(state, &state->current); // the end, from now on
    }
}

int grammar_yylex(GRAMMAR_YYSTYPE *value, Span *span, GrammarState *state)
{
    if (RT_UNLIKELY(state->start != 0)) {
        state->current = state->previous = (Token){.span = {state->offset, state->offset}};
        *span = state->current.span;
        int start = state->start;
        state->start = 0;
        return start;
    }
    if (RT_UNLIKELY(state->skips)) {
        grammar_skip(state);
    } else {
        next_token(state);
    }
    switch (state->current.kind) {
    case TOKEN_NUMBER: value->number = state->current.number; break;
    case TOKEN_VECTOR: value->node = state->node; break;
    case TOKEN_ITEMS: value->list = state->list; break;
    default: value->symbol = state->current.symbol; break;
    }
    *span = state->current.span;
    return state->current.kind;
}
