// What was most likely meant by text that the parser refuses: habits of other languages, and the brace that is missing.
//
// Adds help and notes to the fault that was reported last. The place of a missing brace is guessed from the
// indentation, for which the text is read once more. Changes nothing of the state.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "base/utf8.h"
#include "grammar/lexer.h"
#include "grammar/parser.h"

// ---- words of other languages

const char *grammar_foreign_directive(const char *word, size_t length, bool *stands_for_it)
{
    static const struct {
        const char *word, *ours;
        bool stands_for_it; // what follows is written alike
    } table[] = {
        {"endif", "end", true},      {"endfor", "end", true},      {"endwhile", "end", true},
        {"endmacro", "end", true},   {"endswitch", "end", true},   {"wend", "end", true},
        {"next", "end", true},       {"fi", "end", true},          {"done", "end", true},
        {"elif", "elseif", true},    {"elsif", "elseif", true},    {"import", "include", true},
        {"require", "include", true}, {"define", "declare", false}, {"set", "declare", false},
        {"let", "declare", false},   {"var", "declare", false},    {"const", "declare", false},
        {"function", "macro", true}, {"def", "macro", true},       {"print", "debug", true},
        {"echo", "debug", true},
    };
    for (size_t i = 0; i < RT_COUNT_OF(table); i++) {
        if (strlen(table[i].word) == length && memcmp(table[i].word, word, length) == 0) {
            *stands_for_it = table[i].stands_for_it;
            return table[i].ours;
        }
    }
    return NULL;
}

const char *grammar_foreign_mark(char mark)
{
    return mark == '^' ? "a power is `pow(A, B)`" : mark == '%' ? "what a division leaves is `mod(A, B)`" : NULL;
}

// ---- quotes of word processors

size_t grammar_quote_length(const char *text, size_t length)
{
    static const char *const quotes[] = {
        "\xe2\x80\x98", "\xe2\x80\x99", "\xe2\x80\x9a", "\xe2\x80\x9b", "\xe2\x80\x9c", "\xe2\x80\x9d",
        "\xe2\x80\x9e", "\xe2\x80\x9f", "\xe2\x80\xb9", "\xe2\x80\xba", "\xc2\xab",     "\xc2\xbb",
        "\xef\xbc\x82", "\xef\xbc\x87",                                                     // UTF-8
        "\x82",         "\x84",         "\x8b",         "\x91",         "\x92",         "\x93",
        "\x94",         "\x9b",         "\xab",         "\xbb",                               // Windows-1252
    };
    for (size_t i = 0; i < RT_COUNT_OF(quotes); i++) {
        size_t size = strlen(quotes[i]);
        if (size <= length && memcmp(text, quotes[i], size) == 0) {
            return size;
        }
    }
    return 0;
}

void grammar_hint_string(GrammarState *state)
{
    const char *text = text_get(&state->string);
    size_t length = strcspn(text, "\n");
    for (const char *end = text + length; text < end; text++) {
        size_t character = utf8_length(text, end);
        if (grammar_quote_length(text, (size_t)(end - text)) > 0) {
            diag_suggest(state->context->diags, "there is a typographic quote in it; write `\"`");
            return;
        }
        text += character > 1 ? character - 1 : 0;
    }
}

// Marks that other languages write twice.
static const char *doubled(const GrammarState *state)
{
    if (state->current.kind != state->previous.kind || state->current.span.begin != state->previous.span.end) {
        return NULL;
    }
    switch (state->current.kind) {
    case '=': return "`=` alone compares";
    case '&': return "*and* is a single `&`";
    case '|': return "*or* is a single `|`";
    case '*': return "a power is `pow(A, B)`";
    default: return NULL;
    }
}

enum { VECTOR_BYTES = 120, COMPONENTS_LEAST = 2, COMPONENTS_MOST = 5 };

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

static bool ends_there(const char *at, const char *end)
{
    bool is_comment = *at == '/' && at + 1 < end && (at[1] == '/' || at[1] == '*');
    return strchr("{}\"#;", *at) != NULL || is_comment;
}

// What stands in the parentheses that begin at `at`, if it is two to five components: appends `<` to `>`, with a blank
// behind each comma, and returns how long the parentheses are; 0: it is none.
static size_t append_vector(const char *at, const char *end, TextBuffer *out)
{
    int depth = 1, components = 1;
    char last = '(';
    text_append_char(out, '<');
    for (const char *c = at + 1; c < end && !ends_there(c, end); c++) {
        if (is_blank(*c)) {
            continue;
        }
        depth += (*c == '(' || *c == '<') - (*c == ')' || *c == '>');
        if (depth == 0) {
            text_append_char(out, '>');
            bool is_vector = *c == ')' && components >= COMPONENTS_LEAST && components <= COMPONENTS_MOST;
            return is_vector && !out->failed ? (size_t)(c + 1 - at) : 0;
        }
        bool is_apart = last == ',' || (is_blank(c[-1]) && strchr("(<,)>", *c) == NULL && strchr("(<", last) == NULL);
        text_append(out, is_apart ? " " : "");
        text_append_char(out, *c);
        components += *c == ',' && depth == 1;
        last = *c;
    }
    return 0;
}

// Parentheses in the place of a vector's brackets, as the text has them.
static void suggest_vector(GrammarState *state, const Opener *open)
{
    DiagSink *diags = state->context->diags;
    char bytes[VECTOR_BYTES];
    Span span = {open->span.begin, open->span.begin + sizeof bytes};
    TextBuffer vector;
    text_init(&vector);
    uint64_t last = state->source != NULL ? source_extent(state->source).end : 0;
    span.end = span.end < last ? span.end : last;
    bool is_read = span.begin < span.end && source_read_span(diags->sources, span, bytes);
    size_t length = is_read ? append_vector(bytes, bytes + (span.end - span.begin), &vector) : 0;
    if (length > 0) {
        diag_suggest(diags, "a vector is written `%s`", text_get(&vector));
        diag_replace(diags, (Span){span.begin, span.begin + length}, "%s", text_get(&vector));
    } else {
        diag_suggest(diags, "a vector stands in `< >`");
    }
    text_fini(&vector);
}

static bool takes_braces(const GrammarState *state, Symbol word)
{
    const GrammarHooks *hooks = state->context->hooks;
    return word != SYMBOL_NONE && (hooks == NULL || hooks->takes_braces(hooks->client, word));
}

void grammar_hint_token(GrammarState *state, bool only_closes)
{
    DiagSink *diags = state->context->diags;
    const Token *token = &state->current;
    const Opener *open = state->openers.items;
    size_t count = state->openers.count;
    bool is_in_for = count > 1 && open[count - 2].kind == TOKEN_HASH_FOR && !open[count - 2].header_done;
    const char *twice = doubled(state);
    if (twice != NULL) {
        diag_suggest(diags, "%s", twice);
    } else if (count > 0 && open[count - 1].kind == '(' && takes_braces(state, open[count - 1].word)) {
        diag_suggest(diags, "what belongs to `%s` stands in `{ }`",
                     intern_get(state->context->names, open[count - 1].word));
    } else if (token->kind == ',' && only_closes && count > 0 && open[count - 1].kind == '(') {
        suggest_vector(state, &open[count - 1]);
    } else if (token->kind == '=' && is_in_for) {
        diag_suggest(diags, "a loop is `#for (Name, From, To, Step) ... #end`");
    } else if (state->previous.kind == TOKEN_ARRAY) {
        diag_suggest(diags, "the size of an array stands before its elements: `array[2] { 1, 2 }`");
    } else if (token->kind == TOKEN_DIRECTIVE_WORD) {
        const char *word = intern_get(state->context->names, token->symbol);
        diag_suggest(diags, "did you mean `#%s`?", word);
        diag_replace(diags, token->span, "#%s", word);
    }
}

// ---- the missing brace

enum { LOOKED_AT_MOST = 1 << 20 }; // bytes

typedef struct Brace {
    const Token *word; // the block's, or the brace
    size_t indent;     // of the line that it stands in
    size_t line;       // where that begins
    bool ends_line;    // it is the last of its line
    bool has_lines;    // a line that stands in it was seen
    bool is_flat;      // what is in it does not stand deeper: indentation tells nothing
} Brace;

typedef struct Braces {
    const char *bytes; // of the text
    uint64_t begin;    // where it begins
    ARRAY(Brace) open;
} Braces;

static size_t line_of(const Braces *braces, const Token *token)
{
    size_t at = (size_t)(token->span.begin - braces->begin);
    while (at > 0 && braces->bytes[at - 1] != '\n' && braces->bytes[at - 1] != '\r') {
        at--;
    }
    return at;
}

static size_t indent_of(const Braces *braces, size_t line)
{
    size_t at = line;
    while (braces->bytes[at] == ' ' || braces->bytes[at] == '\t') {
        at++;
    }
    return at - line;
}

static bool is_word(const Token *token)
{
    return grammar_is_reserved(token->kind) || token->kind == TOKEN_NAME;
}

// True when the first token of a line shows that the innermost brace should have been closed before.
static bool shows_gap(Braces *braces, const Token *token, bool begins_block)
{
    Brace *inner = &braces->open.items[braces->open.count - 1];
    size_t line = line_of(braces, token), indent = indent_of(braces, line);
    if (line + indent != (size_t)(token->span.begin - braces->begin) || line == inner->line) {
        return false;
    }
    bool is_first = !inner->has_lines;
    inner->has_lines = true;
    if (token->kind == '}') {
        return indent < inner->indent;
    }
    inner->is_flat |= is_first && inner->ends_line && indent <= inner->indent;
    return begins_block && indent <= inner->indent && !inner->is_flat;
}

// The first token before which a brace is missing by the indentation; *word: the block that should have ended.
static const Token *find_gap(Braces *braces, const GrammarText *text, const Token **word)
{
    for (size_t i = 0; i < text->count; i++) {
        const Token *token = &text->tokens[i], *next = i + 1 < text->count ? token + 1 : NULL;
        bool begins_block = is_word(token) && next != NULL && next->kind == '{';
        if (braces->open.count > 0 && shows_gap(braces, token, begins_block)) {
            *word = braces->open.items[braces->open.count - 1].word;
            return token;
        }
        if (token->kind == '{') {
            const Token *named = i > 0 && is_word(token - 1) ? token - 1 : token;
            size_t line = line_of(braces, named);
            Brace brace = {.word = named, .line = line, .indent = indent_of(braces, line)};
            brace.ends_line = next == NULL || line_of(braces, next) != line_of(braces, token);
            if (!ARRAY_PUSH(&braces->open, brace)) {
                return NULL;
            }
        } else if (token->kind == '}' && braces->open.count > 0) {
            braces->open.count--;
        }
    }
    return NULL;
}

void grammar_hint_brace(GrammarState *state, const Opener *outermost)
{
    uint64_t begin = outermost->span.begin, end = state->current.span.begin;
    end = end - begin < LOOKED_AT_MOST ? end : begin + LOOKED_AT_MOST;
    Braces braces = {.begin = begin};
    char *bytes = calloc((size_t)(end - begin) + 1, 1);
    GrammarText *text = NULL;
    const Token *word = NULL, *gap = NULL;
    if (bytes != NULL && source_read_span(state->context->diags->sources, (Span){begin, end}, bytes)) {
        braces.bytes = bytes;
        text = grammar_text_again(state->context, (Span){begin, end});
        gap = text != NULL ? find_gap(&braces, text, &word) : NULL;
    }
    if (gap != NULL) {
        TextBuffer name;
        text_init(&name);
        grammar_describe(state, word, &name);
        diag_note(state->context->diags, gap->span, "by the indentation, %s should end before this", text_get(&name));
        text_fini(&name);
    }
    ARRAY_FREE(&braces.open);
    free(text);
    free(bytes);
}
