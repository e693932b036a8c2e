// Words as tokens: the classes of reserved words, the directives by name, and what was meant by one that is none.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "base/suggest.h"
#include "grammar/lexer.h"
#include "grammar/parser.h"

enum { GUESS_COST = 3, GUESS_LENGTH = 3 };

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
        [WORD_IDENTIFIER] = TOKEN_NAME, [WORD_PLAIN] = TOKEN_WORD,        [WORD_COLOUR] = TOKEN_COLOUR,
        [WORD_TEXTURE] = TOKEN_TEXTURE, [WORD_ARRAY] = TOKEN_ARRAY,       [WORD_FUNCTION] = TOKEN_FUNCTION,
        [WORD_BUILTIN] = TOKEN_BUILTIN, [WORD_CONSTANT] = TOKEN_CONSTANT, [WORD_DIRECTIVE] = TOKEN_DIRECTIVE_WORD,
        [WORD_TERM] = TOKEN_TERM,
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

bool grammar_is_directive(int token)
{
    return token >= TOKEN_HASH_DECLARE && token <= TOKEN_HASH_WRITE;
}

DirectiveRole grammar_role(int token)
{
    return grammar_is_directive(token) ? find_directive(token)->role : ROLE_NONE;
}

bool grammar_is_name(int token)
{
    return token == TOKEN_NAME;
}

Symbol grammar_directive_word(int token)
{
    return (Symbol)find_directive(token)->word;
}

int grammar_directive_token(GrammarState *state, const char *word, size_t length, Span span)
{
    Symbol symbol = intern_find(state->context->names, word, length);
    for (size_t i = 0; i < RT_COUNT_OF(directives); i++) {
        if (symbol == (Symbol)directives[i].word) {
            return directives[i].token;
        }
    }
    if (grammar_scan_defers(state)) {
        return TOKEN_INVALID;
    }
    if (length == 0) {
        grammar_fault(state, DIAG_E0105, span, "the name of a directive must follow `#`");
        return TOKEN_INVALID;
    }
    Suggest suggest;
    bool stands_for_it = false;
    const char *foreign = grammar_foreign_directive(word, length, &stands_for_it);
    suggest_begin(&suggest, word);
    for (size_t i = 0; i < RT_COUNT_OF(directives) && foreign == NULL; i++) {
        suggest_offer(&suggest, intern_get(state->context->names, (Symbol)directives[i].word));
    }
    suggest.best = foreign != NULL ? foreign : suggest.best;
    size_t kept = state->context->diags->count;
    grammar_fault(state, DIAG_E0105, span, "`#%.40s` is not a directive", word);
    bool is_apart = span.end - span.begin > length + 1;
    if (suggest.best == NULL || (is_apart && foreign == NULL && suggest.best_cost > 0)) {
        if (is_apart && state->context->diags->count > kept) {
            diag_suggest(state->context->diags, "a comment begins with `//`");
        }
        state->unknown_directives++;
        return TOKEN_INVALID;
    }
    if (state->context->diags->count > kept) {
        diag_suggest(state->context->diags, "did you mean `#%s`?", suggest.best);
        diag_replace(state->context->diags, span, "#%s", suggest.best);
    }
    // Reading continues as if the suggestion stood there, unless it is far for such a short word.
    if (foreign != NULL ? !stands_for_it : suggest.best_cost > GUESS_COST && length <= GUESS_LENGTH) {
        state->unknown_directives++;
        return TOKEN_INVALID;
    }
    int meant = grammar_directive_token(state, suggest.best, strlen(suggest.best), span);
    DirectiveRole role = grammar_role(meant);
    bool belongs = role == ROLE_SIMPLE || role == ROLE_OPENS || state->openers.count > 0;
    return belongs ? meant : TOKEN_INVALID;
}

bool grammar_is_idle_hash(GrammarState *state, Span span)
{
    const Opener *open = grammar_innermost(state);
    bool is_idle = state->feed == NULL && state->source != NULL && open != NULL && open->kind == '{';
    for (size_t i = 0; i < state->openers.count; i++) { // but not among the elements of an array
        is_idle = is_idle && (state->openers.items[i].kind != '{' || state->openers.items[i].word != SYMBOL_NONE);
    }
    if (is_idle) {
        diag_report(state->context->diags, DIAG_W0102, span, "a `#` without the name of a directive means nothing");
    }
    return is_idle;
}
