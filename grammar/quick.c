// Tokens that are read at once: what scenes are mostly made of is taken from the scanner's buffer without its tables,
// and a vector of numbers as one token; items that differ from earlier ones in their numbers only are the matter of
// block_template.c.
//
// Turns text into a token with its nodes, or leaves it to the scanner: whatever is not wholly in the buffer, begins a
// comment or a string, or is not written in the most usual way. The nodes are those that the parser would have made.
// Owns the words that it has seen.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "grammar/lexer.h"
#include "grammar/parser.h"
#include "base/plain.h"

enum {
    AHEAD = 32,          // bytes at hand wherever a token begins
    WORD_LONGEST = 16,   // a longer one is left to the scanner
    WORDS = 512,         // places for words, by their hash
    COMPONENTS_MOST = 5,
};

typedef struct QuickWord {
    uint64_t text[2]; // padded with zeros
    Symbol symbol;    // SYMBOL_NONE: the place is free
    int kind;
} QuickWord;

struct GrammarQuick {
    QuickWord words[WORDS];
    GrammarBlocks *blocks;
};

GrammarQuick *grammar_quick_new(void)
{
    GrammarQuick *quick = calloc(1, sizeof(GrammarQuick));
    if (quick != NULL) {
        quick->blocks = grammar_blocks_new(); // without it all is read as well
    }
    return quick;
}

void grammar_quick_free(GrammarQuick *quick)
{
    if (quick != NULL) {
        grammar_blocks_free(quick->blocks);
        free(quick);
    }
}

void grammar_learn_items(GrammarState *state, Span braces, AstList list)
{
    state->in_list = false;
    if (state->quick != NULL && state->quick->blocks != NULL) {
        grammar_blocks_learn(state->quick->blocks, state, braces, list);
    }
}

// ---- words

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
    while (plain_is_in_word(*after)) {
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
    return ast_node(&state->builder, (AstHead){AST_UNARY, AST_OP_NEG, SYMBOL_NONE, span}, number, NULL, NULL);
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

// ---- packs

enum {
    PACK_ITEMS = 384,
    PACK_NUMBERS = 1152,
    PACK_AHEAD = 512, // bytes at hand where an item begins: it may be as long
};

typedef struct Pack {
    uint32_t count, number_count;
    double numbers[PACK_NUMBERS];
    uint8_t widths[PACK_ITEMS];
} Pack;

// A vector of numbers, or a number, written behind what the pack has.
static const char *read_packed_item(const char *at, const char *end, Pack *pack)
{
    double *numbers = &pack->numbers[pack->number_count];
    unsigned width = 0;
    if (*at != '<') {
        pack->widths[pack->count] = 1;
        return plain_is_digit(*at) || *at == '-' ? plain_read_number(at, end, numbers) : NULL;
    }
    do {
        at = plain_skip_blanks(at + 1);
        bool is_number = plain_is_digit(at[*at == '-']) && width < COMPONENTS_MOST;
        at = is_number ? plain_read_number(at, end, &numbers[width++]) : NULL;
        at = at != NULL ? plain_skip_blanks(at) : NULL;
    } while (at != NULL && *at == ',');
    pack->widths[pack->count] = (uint8_t)width;
    return at != NULL && *at == '>' && width > 1 && width <= 3 ? at + 1 : NULL;
}

// Items that commas or the list's end follow, so that nothing continues them. Returns the end of the last.
static const char *read_packed_items(const char *at, const char *end, Pack *pack)
{
    const char *last = NULL;
    pack->count = pack->number_count = 0;
    while (end - at >= PACK_AHEAD && pack->count < PACK_ITEMS && pack->number_count + COMPONENTS_MOST <= PACK_NUMBERS) {
        const char *after = read_packed_item(at, end, pack);
        if (after == NULL) {
            break;
        }
        at = plain_skip_blanks(after);
        if (*at != ',' && *at != '}') {
            break;
        }
        last = after;
        pack->number_count += pack->widths[pack->count++];
        if (*at == '}') {
            break;
        }
        at = plain_skip_blanks(at + 1);
    }
    return last;
}

// Several vectors and numbers of a list of a mesh.
static const char *read_pack(GrammarState *state, const char *at, const char *end, Token *token)
{
    Pack pack;
    const char *after = state->previous.kind == ',' && !state->after_dot ? read_packed_items(at, end, &pack) : NULL;
    if (after == NULL || pack.count < 2) {
        return NULL;
    }
    Span span = {state->offset, state->offset + (uint64_t)(after - at)};
    state->node = ast_packed(&state->builder, pack.widths, pack.count, pack.numbers, pack.number_count, span);
    token->kind = TOKEN_VECTOR;
    return after;
}

// The words whose braces hold nothing but numbers and vectors, by the thousand.
static bool begins_list(const GrammarState *state)
{
    if (state->previous.kind != TOKEN_WORD) {
        return false;
    }
    switch (state->previous.symbol) {
    case W_vertex_vectors:
    case W_normal_vectors:
    case W_uv_vectors:
    case W_face_indices:
    case W_uv_indices:
    case W_normal_indices: return true;
    default: return false;
    }
}

static const char *read_vector(GrammarState *state, const char *at, const char *end, Token *token)
{
    if (RT_UNLIKELY(state->in_list)) {
        const char *packed = read_pack(state, at, end, token);
        if (packed != NULL) {
            return packed;
        }
    }
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
    state->node = ast_node_list(&state->builder, (AstHead){AST_VECTOR, AST_OP_NONE, SYMBOL_NONE, span}, list, (AstList){0},
                                (AstList){0});
    token->kind = TOKEN_VECTOR;
    return after;
}

// ---- any

// Items after a word, if they are like some that were read before.
static const char *read_items(GrammarState *state, const char *at, const char *end, Token *token)
{
    state->in_list = begins_list(state);
    bool follows_word = state->previous.kind == TOKEN_WORD || state->previous.kind == TOKEN_TEXTURE;
    if (!follows_word || state->in_list || state->after_dot || state->quick->blocks == NULL) {
        return NULL;
    }
    token->kind = TOKEN_ITEMS;
    return grammar_blocks_read(state->quick->blocks, state, at, end);
}

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
        after = c == '<'   ? read_vector(state, begin, end, token)
                : c == '{' ? read_items(state, begin, end, token)
                           : NULL;
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
