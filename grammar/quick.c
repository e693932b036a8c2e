// Tokens that are read at once: what scenes are mostly made of is taken from the scanner's buffer without its tables,
// a vector of numbers as one token, and a block whose items were read before as a copy of their nodes.
//
// Turns text into a token with its nodes, or leaves it to the scanner: whatever is not wholly in the buffer, begins a
// comment or a string, or is not written in the most usual way. The nodes are those that the parser would have made.
// Owns the words and the items that it has seen.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "ast/words.h"
#include "grammar/lexer.h"
#include "grammar/parser.h"
#include "grammar/plain.h"

enum {
    AHEAD = 32,          // bytes at hand wherever a token begins
    WORD_LONGEST = 16,   // a longer one is left to the scanner
    WORDS = 512,         // places for words, by their hash
    COMPONENTS_MOST = 5,
    ITEMS_KEPT = 8,      // texts of items
    ITEMS_LONGEST = 1024, // bytes of one
    ITEMS_NODES = 256,
    MISSES_MOST = 32,    // so many texts in a row of a word's block that no other repeats: from then on few are kept
};

typedef struct QuickWord {
    uint64_t text[2]; // padded with zeros
    Symbol symbol;    // SYMBOL_NONE: the place is free
    int kind;
} QuickWord;

// `{ … }` after a word, and the nodes of the items in it.
typedef struct QuickItems {
    Symbol word;
    char *text;
    size_t length;
    uint64_t begin;  // where it stood when it was learnt
    AstNode *nodes;  // NULL: not known yet
    size_t count;
    AstList list;    // of the outermost nodes
} QuickItems;

struct GrammarQuick {
    QuickWord words[WORDS];
    QuickItems *items[ITEMS_KEPT]; // the one used last first
    QuickItems *learning;          // its text is being parsed, or NULL
    unsigned char misses[WORD_COUNT];
};

GrammarQuick *grammar_quick_new(void)
{
    return calloc(1, sizeof(GrammarQuick));
}

static void items_free(QuickItems *items)
{
    if (items != NULL) {
        free(items->text);
        free(items->nodes);
        free(items);
    }
}

void grammar_quick_free(GrammarQuick *quick)
{
    for (unsigned i = 0; quick != NULL && i < ITEMS_KEPT; i++) {
        items_free(quick->items[i]);
    }
    items_free(quick != NULL ? quick->learning : NULL);
    free(quick);
}

// ---- words

static bool is_in_word(char c)
{
    return plain_goes_on(c) && c != '.';
}

static const char *read_word(GrammarState *state, const char *at, Token *token)
{
    static const uint64_t masks[] = {0,
                                     UINT64_C(0xff),
                                     UINT64_C(0xffff),
                                     UINT64_C(0xffffff),
                                     UINT64_C(0xffffffff),
                                     UINT64_C(0xffffffffff),
                                     UINT64_C(0xffffffffffff),
                                     UINT64_C(0xffffffffffffff),
                                     UINT64_MAX};
    const char *after = at + 1;
    while (is_in_word(*after)) {
        after++;
    }
    size_t length = (size_t)(after - at);
    if (length > WORD_LONGEST) {
        return NULL;
    }
    uint64_t text[2];
    memcpy(text, at, sizeof text);
#if defined __BYTE_ORDER__ && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    text[0] &= masks[length < 8 ? length : 8];
    text[1] &= masks[length > 8 ? length - 8 : 0];
#else
    memset((char *)text + length, 0, sizeof text - length);
    (void)masks;
#endif
    uint64_t hash = (text[0] ^ text[1] * UINT64_C(0x9e3779b97f4a7c15)) * UINT64_C(0xff51afd7ed558ccd);
    QuickWord *word = &state->quick->words[hash >> 55];
    if (RT_UNLIKELY(word->text[0] != text[0] || word->text[1] != text[1] || word->symbol == SYMBOL_NONE)) {
        Symbol symbol = intern_find(state->context->names, at, length);
        int kind = symbol != SYMBOL_NONE ? grammar_word_token(symbol) : 0;
        if (kind == 0 || kind == TOKEN_DIRECTIVE_WORD) {
            return NULL; // to be entered, or perhaps a directive without its `#`
        }
        *word = (QuickWord){{text[0], text[1]}, symbol, kind};
    }
    token->symbol = word->symbol;
    token->kind = word->kind;
    return after;
}

// ---- vectors

typedef struct Component {
    double number; // without its sign
    const char *begin, *end;
    bool is_negative;
} Component;

static const char *read_components(const char *at, const char *end, Component *components, unsigned *count)
{
    for (*count = 0; *count < COMPONENTS_MOST; at++) {
        Component *component = &components[(*count)++];
        component->begin = at = plain_skip_blanks(at);
        component->is_negative = *at == '-';
        at += component->is_negative;
        component->end = at = plain_is_digit(*at) ? plain_read_number(at, end, &component->number) : NULL;
        if (at == NULL) {
            return NULL;
        }
        at = plain_skip_blanks(at);
        if (*at != ',') {
            break;
        }
    }
    return *at == '>' && *count > 1 ? at + 1 : NULL;
}

static AstNode *component_node(GrammarState *state, const Component *component, const char *at)
{
    Span span = {state->offset + (uint64_t)(component->begin - at), state->offset + (uint64_t)(component->end - at)};
    if (!component->is_negative) {
        return ast_number(&state->builder, component->number, span);
    }
    AstNode *number = ast_number(&state->builder, component->number, (Span){span.begin + 1, span.end});
    return ast_node(&state->builder, AST_UNARY, AST_OP_NEG, SYMBOL_NONE, span, number, NULL, NULL);
}

// Where a `<` can begin nothing but a vector.
static bool begins_vector(const GrammarState *state)
{
    switch (state->previous.kind) {
    case '{':
    case '(':
    case ',':
    case '=':
    case TOKEN_WORD:
    case TOKEN_COLOUR: return !state->after_dot;
    default: return false;
    }
}

static const char *read_vector(GrammarState *state, const char *at, const char *end, Token *token)
{
    Component components[COMPONENTS_MOST];
    unsigned count;
    const char *after = begins_vector(state) ? read_components(at + 1, end, components, &count) : NULL;
    if (after == NULL || after >= end) {
        return NULL;
    }
    AstList list = {0};
    for (unsigned i = 0; i < count; i++) {
        list = ast_append(list, component_node(state, &components[i], at));
    }
    Span span = {state->offset, state->offset + (uint64_t)(after - at)};
    state->node = ast_node_list(&state->builder, AST_VECTOR, AST_OP_NONE, SYMBOL_NONE, span, list, (AstList){0},
                                (AstList){0});
    token->kind = TOKEN_VECTOR;
    return after;
}

// ---- items

// The end of `{ … }` when it holds nothing but words of the language, numbers, commas and brackets; else NULL.
static const char *survey(const GrammarState *state, const char *at, const char *end)
{
    const char *limit = end - at > ITEMS_LONGEST ? at + ITEMS_LONGEST : end;
    unsigned depth = 0;
    while (at < limit) {
        const char *begin = at;
        if (plain_is_letter(*at)) {
            while (is_in_word(*at)) {
                at++;
            }
            Symbol word = intern_find(state->context->names, begin, (size_t)(at - begin));
            if (word == SYMBOL_NONE || word >= WORD_COUNT || word_class(word) == WORD_DIRECTIVE ||
                word_class(word) == WORD_BUILTIN) {
                return NULL;
            }
            continue;
        }
        if (!plain_is_digit(*at) && (*at == '\0' || strchr("{}<>,. \n\t\r-+", *at) == NULL)) {
            return NULL;
        }
        depth += (*at == '{') - (unsigned)(*at == '}');
        at++;
        if (depth == 0) {
            return at;
        }
    }
    return NULL;
}

// Keeps the text of items that are now parsed, if they may come again.
static void begin_learning(GrammarState *state, const char *at, const char *end)
{
    GrammarQuick *quick = state->quick;
    Symbol word = state->previous.symbol;
    unsigned char *misses = &quick->misses[word < WORD_COUNT ? word : 0];
    *misses = *misses < 2 * MISSES_MOST - 1 ? (unsigned char)(*misses + 1) : MISSES_MOST;
    if (*misses > MISSES_MOST) {
        return;
    }
    const char *after = survey(state, at, end);
    if (after == NULL) {
        return;
    }
    QuickItems *items = quick->learning != NULL ? quick->learning : calloc(1, sizeof *items);
    char *text = items != NULL ? realloc(items->text, (size_t)(after - at)) : NULL;
    quick->learning = items;
    if (text == NULL) {
        items_free(items);
        quick->learning = NULL;
        return;
    }
    memcpy(text, at, (size_t)(after - at));
    items->text = text;
    items->word = word;
    items->length = (size_t)(after - at);
    items->begin = state->offset;
}

static size_t count_nodes(const AstNode *node)
{
    size_t count = 0;
    for (; node != NULL; node = node->next) {
        count++;
        if (node->kind != AST_NUMBER) {
            count += count_nodes(node->a) + count_nodes(node->b) + count_nodes(node->c);
        }
    }
    return count;
}

// Copies a list and all below it to *to, which moves on; returns the first.
static AstNode *flatten(const AstNode *node, AstNode **to)
{
    AstNode *first = NULL, **link = &first;
    for (; node != NULL; node = node->next) {
        AstNode *copy = (*to)++;
        *copy = *node;
        copy->next = NULL;
        *link = copy;
        link = &copy->next;
        if (node->kind != AST_NUMBER) {
            copy->a = flatten(node->a, to);
            copy->b = flatten(node->b, to);
            copy->c = flatten(node->c, to);
        }
    }
    return first;
}

void grammar_learn_items(GrammarState *state, Span braces, AstList list)
{
    GrammarQuick *quick = state->quick;
    QuickItems *items = quick != NULL ? quick->learning : NULL;
    if (items == NULL || items->begin != braces.begin || items->length != braces.end - braces.begin ||
        state->context->diags->error_count != state->faults_before || state->builder.failed) {
        return;
    }
    size_t count = count_nodes(list.first);
    items->nodes = count > 0 && count <= ITEMS_NODES ? malloc(count * sizeof *items->nodes) : NULL;
    if (items->nodes == NULL) {
        return;
    }
    AstNode *to = items->nodes;
    items->list = list;
    items->count = count;
    items->list.first = items->list.last = flatten(list.first, &to);
    while (items->list.last->next != NULL) {
        items->list.last = items->list.last->next;
    }
    items_free(quick->items[ITEMS_KEPT - 1]);
    memmove(quick->items + 1, quick->items, (ITEMS_KEPT - 1) * sizeof *quick->items);
    quick->items[0] = items;
    quick->learning = NULL;
}

static AstNode *moved(AstNode *node, const AstNode *from, AstNode *to)
{
    return node != NULL ? to + (node - from) : NULL;
}

static bool copy_items(GrammarState *state, const QuickItems *items)
{
    AstNode *nodes = arena_alloc_array(state->builder.arena, items->count, sizeof *nodes), *from = items->nodes;
    if (nodes == NULL) {
        return false;
    }
    uint64_t shift = state->offset - items->begin;
    for (size_t i = 0; i < items->count; i++) {
        AstNode *node = &nodes[i];
        *node = from[i];
        node->span.begin += shift;
        node->span.end += shift;
        node->next = moved(node->next, from, nodes);
        if (node->kind != AST_NUMBER) {
            node->a = moved(node->a, from, nodes);
            node->b = moved(node->b, from, nodes);
            node->c = moved(node->c, from, nodes);
        }
    }
    state->list = items->list;
    state->list.first = moved(state->list.first, from, nodes);
    state->list.last = moved(state->list.last, from, nodes);
    return true;
}

// Items that were read before, or NULL; then they are perhaps learnt now.
static const char *read_items(GrammarState *state, const char *at, const char *end, Token *token)
{
    GrammarQuick *quick = state->quick;
    Symbol word = state->previous.symbol;
    bool follows_word = state->previous.kind == TOKEN_WORD || state->previous.kind == TOKEN_TEXTURE;
    if (!follows_word || state->after_dot) {
        return NULL;
    }
    for (unsigned i = 0; i < ITEMS_KEPT && quick->items[i] != NULL; i++) {
        QuickItems *items = quick->items[i];
        if (items->word == word && (size_t)(end - at) > items->length && memcmp(at, items->text, items->length) == 0) {
            if (!copy_items(state, items)) {
                return NULL;
            }
            memmove(quick->items + 1, quick->items, i * sizeof *quick->items);
            quick->items[0] = items;
            quick->misses[word < WORD_COUNT ? word : 0] = 0;
            token->kind = TOKEN_ITEMS;
            return at + items->length;
        }
    }
    begin_learning(state, at, end);
    return NULL;
}

// ---- any

// Marks that are tokens whatever follows them.
static const bool marks[256] = {
    ['('] = true, [')'] = true, ['{'] = true, ['}'] = true, ['['] = true, [']'] = true, [','] = true, [';'] = true,
    ['+'] = true, ['-'] = true, ['*'] = true, ['='] = true, ['?'] = true, [':'] = true, ['&'] = true, ['|'] = true,
};

static const char *read_mark(char c, const char *at, Token *token)
{
    bool is_mark = marks[(unsigned char)c] || ((c == '<' || c == '>') && at[1] != '=') ||
                   (c == '/' && at[1] != '/' && at[1] != '*') || (c == '.' && !plain_is_digit(at[1]));
    token->kind = (unsigned char)c;
    token->symbol = SYMBOL_NONE;
    return is_mark ? at + 1 : NULL;
}

const char *grammar_quick_read(GrammarState *state, const char *at, const char *end, Token *token)
{
    const char *begin = plain_skip_blanks(at), *after = NULL;
    uint64_t before = state->offset;
    char c = *begin;
    if (end - begin < AHEAD) {
        return NULL;
    }
    state->offset += (uint64_t)(begin - at);
    if (plain_is_letter(c)) {
        after = read_word(state, begin, token);
    } else if (plain_is_digit(c)) {
        token->kind = TOKEN_NUMBER;
        after = plain_read_number(begin, end, &token->number);
    } else {
        after = c == '<' ? read_vector(state, begin, end, token) : c == '{' ? read_items(state, begin, end, token) : NULL;
        after = after != NULL ? after : read_mark(c, begin, token);
    }
    if (after == NULL || after >= end) {
        state->offset = before;
        return NULL;
    }
    token->span = (Span){state->offset, state->offset + (uint64_t)(after - begin)};
    token->known = NULL;
    state->offset = token->span.end;
    return after;
}
