// Items that differ from earlier ones in their numbers only: a copy of their nodes, with these numbers.
//
// Turns `{ … }` after a word into the nodes that the parser made of such a text before, when words, marks and order are
// the same and only numbers and the blanks around them differ. What was parsed is taken apart into pieces of text with
// gaps for numbers between them; each node's span is bound to its piece or gap. Owns what it has learnt.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "ast/words.h"
#include "grammar/lexer.h"
#include "base/plain.h"

enum {
    KEPT = 8,         // forms
    LONGEST = 1024,   // bytes of text of one
    GAPS_MOST = 64,
    NODES_MOST = 256,
    MISSES_MOST = 32, // so many texts in a row of a word's block that no other is like: from then on few are kept
};

// Text without numbers, and without blanks at its ends.
typedef struct Piece {
    unsigned short begin, length;
    bool needs_blank; // it ends with a letter: a number cannot follow at once
    bool takes_sign;  // the number after it may have a minus sign of its own
} Piece;

// A node and where its span begins and ends: in a piece, or at the number behind it.
typedef struct Part {
    AstNode node; // links lead to nodes of other parts
    unsigned short gap, parent; // 1 + the number's; 1 + place of the node that it is below; 0: none
    unsigned short begin_piece, begin, end_piece, end;
} Part;

typedef struct Form {
    Symbol word;   // before the brace
    char *text;    // as it was learnt
    size_t length;
    uint64_t begin; // where it stood
    Piece pieces[GAPS_MOST + 1];
    unsigned short gap_begin[GAPS_MOST], gap_end[GAPS_MOST]; // of the digits, in `text`
    unsigned gaps;
    Part *parts;
    unsigned count;
    AstList list;
} Form;

struct GrammarItems {
    Form *forms[KEPT];  // the one used last first
    Form *learning;     // its text is being parsed
    bool is_learning;
    unsigned char misses[WORD_COUNT];
};

GrammarItems *grammar_items_new(void)
{
    return calloc(1, sizeof(GrammarItems));
}

static void form_free(Form *form)
{
    if (form != NULL) {
        free(form->text);
        free(form->parts);
        free(form);
    }
}

void grammar_items_free(GrammarItems *items)
{
    for (unsigned i = 0; items != NULL && i < KEPT; i++) {
        form_free(items->forms[i]);
    }
    form_free(items != NULL ? items->learning : NULL);
    free(items);
}

// ---- taking a text apart

// The class of a word of the language; WORD_IDENTIFIER for those that no form has.
static WordClass class_of(const GrammarState *state, const char *word, size_t length)
{
    Symbol symbol = intern_find(state->context->names, word, length);
    WordClass class = symbol != SYMBOL_NONE && symbol < WORD_COUNT ? word_class(symbol) : WORD_IDENTIFIER;
    return class == WORD_DIRECTIVE || class == WORD_BUILTIN ? WORD_IDENTIFIER : class;
}

static void end_piece(Form *form, const char *text, size_t end, char last, WordClass class)
{
    Piece *piece = &form->pieces[form->gaps];
    size_t length = end - piece->begin;
    while (length > 0 && plain_is_blank(text[piece->begin + length - 1])) {
        length--;
    }
    piece->length = (unsigned short)length;
    piece->needs_blank = length > 0 && plain_is_in_word(last);
    piece->takes_sign = length > 0 && (piece->needs_blank ? class == WORD_PLAIN || class == WORD_COLOUR
                                                          : last == ',' || last == '{' || last == '<');
}

// The text from its opening brace to the one that closes it; 0 when it holds anything but words of the language, plain
// numbers, commas and brackets.
static size_t take_apart(const GrammarState *state, Form *form, const char *text, const char *limit)
{
    unsigned depth = 0;
    char last = '\0'; // character that is no blank
    WordClass class = WORD_PLAIN;
    form->gaps = 0;
    form->pieces[0].begin = 0;
    for (const char *at = text; at < limit;) {
        const char *begin = at;
        if (plain_is_digit(*at) || *at == '-') {
            double number;
            end_piece(form, text, (size_t)(at - text), last, class);
            if (form->gaps == GAPS_MOST || (*at == '-' && !form->pieces[form->gaps].takes_sign)) {
                return 0;
            }
            begin += *at == '-';
            at = plain_is_digit(*begin) ? plain_read_number(begin, limit, &number) : NULL;
            if (at == NULL) {
                return 0;
            }
            form->gap_begin[form->gaps] = (unsigned short)(begin - text);
            form->gap_end[form->gaps++] = (unsigned short)(at - text);
            form->pieces[form->gaps].begin = (unsigned short)(plain_skip_blanks(at) - text);
            last = '\0';
            continue;
        }
        if (plain_is_letter(*at)) {
            while (plain_is_in_word(*at)) {
                at++;
            }
            class = class_of(state, begin, (size_t)(at - begin));
            if (class == WORD_IDENTIFIER) {
                return 0;
            }
            last = at[-1];
            continue;
        }
        if (*at == '\0' || strchr("{}<>, \n\t\r", *at) == NULL) {
            return 0;
        }
        last = plain_is_blank(*at) ? last : *at;
        depth += (*at == '{') - (unsigned)(*at == '}');
        at++;
        if (depth == 0) {
            end_piece(form, text, (size_t)(at - text), last, class);
            return (size_t)(at - text);
        }
    }
    return 0;
}

// Keeps the text of items that are now parsed, if they may come again.
static void begin_learning(GrammarItems *items, const GrammarState *state, const char *at, const char *end)
{
    Symbol word = state->previous.symbol;
    unsigned char *misses = &items->misses[word < WORD_COUNT ? word : 0];
    *misses = *misses < 2 * MISSES_MOST - 1 ? (unsigned char)(*misses + 1) : MISSES_MOST;
    if (*misses > MISSES_MOST) {
        return;
    }
    Form *form = items->learning;
    if (form == NULL && (form = items->learning = calloc(1, sizeof *form)) == NULL) {
        return;
    }
    items->is_learning = false;
    form->length = take_apart(state, form, at, end - at > LONGEST ? at + LONGEST : end);
    char *text = form->length > 0 ? realloc(form->text, form->length) : NULL;
    if (text == NULL) {
        return;
    }
    memcpy(text, at, form->length);
    form->text = text;
    form->word = word;
    form->begin = state->offset;
    items->is_learning = true;
}

// ---- nodes of what was parsed

// Binds a place of the text to a piece. False: it is in none.
static bool bind(const Form *form, uint64_t at, unsigned short *piece, unsigned short *offset)
{
    for (unsigned i = 0; i <= form->gaps; i++) {
        uint64_t begin = form->begin + form->pieces[i].begin;
        if (form->pieces[i].length > 0 && at >= begin && at <= begin + form->pieces[i].length) {
            *piece = (unsigned short)i;
            *offset = (unsigned short)(at - begin);
            return true;
        }
    }
    return false;
}

// The number of a gap by its place; form->gaps: none.
static unsigned find_gap(const Form *form, Span digits)
{
    unsigned gap = 0;
    while (gap < form->gaps && (form->begin + form->gap_begin[gap] != digits.begin ||
                                form->begin + form->gap_end[gap] != digits.end)) {
        gap++;
    }
    return gap;
}

static bool add_part(Form *form, const AstNode *node, unsigned parent);

static bool add_list(Form *form, const AstNode *first, unsigned parent, AstNode **link)
{
    *link = NULL;
    for (const AstNode *node = first; node != NULL; node = node->next) {
        unsigned place = form->count;
        if (!add_part(form, node, parent)) {
            return false;
        }
        *link = &form->parts[place].node;
        link = &(*link)->next;
    }
    return true;
}

// A node and all below it, behind those that there are. False for one that no form has.
static bool add_part(Form *form, const AstNode *node, unsigned parent)
{
    if (form->count == NODES_MOST) {
        return false;
    }
    unsigned place = form->count++;
    Part *part = &form->parts[place];
    *part = (Part){.node = *node, .parent = (unsigned short)parent};
    part->node.next = NULL;
    bool is_negative = node->kind == AST_UNARY && node->op == AST_OP_NEG && node->a->kind == AST_NUMBER;
    if (node->kind == AST_NUMBER || is_negative) {
        const AstNode *digits = is_negative ? node->a : node;
        unsigned gap = find_gap(form, digits->span);
        part->gap = (unsigned short)(gap + 1);
        return gap < form->gaps && (!is_negative || node->span.begin + 1 == digits->span.begin);
    }
    bool is_leaf = node->kind == AST_WORD || node->kind == AST_CONSTANT;
    if ((!is_leaf && node->kind != AST_VECTOR && node->kind != AST_BLOCK) || node->b != NULL || node->c != NULL ||
        !bind(form, node->span.begin, &part->begin_piece, &part->begin) ||
        !bind(form, node->span.end, &part->end_piece, &part->end)) {
        return false;
    }
    return add_list(form, node->a, place + 1, &part->node.a);
}

void grammar_items_learn(GrammarItems *items, const GrammarState *state, Span braces, AstList list)
{
    Form *form = items->learning;
    if (!items->is_learning || form->begin != braces.begin || form->length != braces.end - braces.begin) {
        return;
    }
    items->is_learning = false;
    if (list.count == 0 || state->builder.failed || state->context->diags->error_count != state->faults_before) {
        return;
    }
    form->parts = malloc(NODES_MOST * sizeof *form->parts);
    form->count = 0;
    if (form->parts == NULL || !add_list(form, list.first, 0, &form->list.first)) {
        free(form->parts);
        form->parts = NULL;
        return;
    }
    form->list.count = list.count;
    form->list.last = form->list.first;
    while (form->list.last->next != NULL) {
        form->list.last = form->list.last->next;
    }
    form_free(items->forms[KEPT - 1]);
    memmove(items->forms + 1, items->forms, (KEPT - 1) * sizeof(Form *));
    items->forms[0] = form;
    items->learning = NULL;
}

// ---- reading what is like it

typedef struct Found {
    uint64_t piece_at[GAPS_MOST + 1]; // global offsets
    Span digits[GAPS_MOST];
    double number[GAPS_MOST];
    bool is_negative[GAPS_MOST];
} Found;

// Where a text that has the form ends; NULL: it has not.
static const char *match(const Form *form, const char *text, const char *end, uint64_t offset, Found *found)
{
    const char *at = text;
    for (unsigned i = 0;; i++) {
        const Piece *piece = &form->pieces[i];
        if ((size_t)(end - at) <= piece->length || memcmp(at, form->text + piece->begin, piece->length) != 0) {
            return NULL;
        }
        found->piece_at[i] = offset + (uint64_t)(at - text);
        at += piece->length;
        if (i == form->gaps) {
            return at;
        }
        const char *number = plain_skip_blanks(at);
        found->is_negative[i] = *number == '-';
        number += *number == '-';
        if ((piece->needs_blank && number == at) || (found->is_negative[i] && !piece->takes_sign) ||
            !plain_is_digit(*number)) {
            return NULL;
        }
        at = plain_read_number(number, end, &found->number[i]);
        if (at == NULL) {
            return NULL;
        }
        found->digits[i] = (Span){offset + (uint64_t)(number - text), offset + (uint64_t)(at - text)};
        at = plain_skip_blanks(at);
    }
}

static AstNode *moved(const AstNode *node, const Form *form, AstNode *to)
{
    // The node is the first member of its part.
    return node != NULL ? to + ((const Part *)(const void *)node - form->parts) : NULL;
}

// A number, with its sign as a node of its own before it.
static void put_number(const Found *found, unsigned gap, AstNode *node, AstNode *digits)
{
    AstNode number = {.kind = AST_NUMBER, .depth = 1, .span = found->digits[gap], .number = found->number[gap]};
    unsigned flags = node->flags;
    AstNode *next = node->next;
    *node = number;
    if (found->is_negative[gap]) {
        *digits = number;
        *node = (AstNode){.kind = AST_UNARY, .op = AST_OP_NEG, .depth = 2, .span = number.span, .a = digits};
        node->span.begin--;
    }
    node->flags = (uint16_t)flags;
    node->next = next;
}

// The nodes of the form with what was found; their depths depend on signs. False: out of memory, or too deep.
static bool copy(GrammarState *state, const Form *form, const Found *found)
{
    AstNode *nodes = arena_alloc_array(state->builder.arena, form->count + form->gaps, sizeof *nodes);
    unsigned depths[NODES_MOST];
    if (nodes == NULL) {
        return false;
    }
    state->list = form->list;
    state->list.depth = 0;
    memset(depths, 0, form->count * sizeof *depths);
    for (unsigned i = form->count; i-- > 0;) { // what is below a node stands behind it
        const Part *part = &form->parts[i];
        AstNode *node = &nodes[i];
        *node = part->node;
        node->next = moved(node->next, form, nodes);
        if (part->gap > 0) {
            put_number(found, part->gap - 1u, node, &nodes[form->count + part->gap - 1u]);
        } else {
            node->a = moved(node->a, form, nodes);
            node->span.begin = found->piece_at[part->begin_piece] + part->begin;
            node->span.end = found->piece_at[part->end_piece] + part->end;
            node->depth = depths[i] + 1;
        }
        unsigned *above = part->parent > 0 ? &depths[part->parent - 1] : &state->list.depth;
        *above = node->depth > *above ? node->depth : *above;
    }
    state->list.first = moved(state->list.first, form, nodes);
    state->list.last = moved(state->list.last, form, nodes);
    return state->list.depth < state->builder.depth_limit;
}

const char *grammar_items_read(GrammarItems *items, GrammarState *state, const char *at, const char *end)
{
    Symbol word = state->previous.symbol;
    for (unsigned i = 0; i < KEPT && items->forms[i] != NULL; i++) {
        Form *form = items->forms[i];
        Found found;
        const char *after = form->word == word ? match(form, at, end, state->offset, &found) : NULL;
        if (after != NULL) {
            memmove(items->forms + 1, items->forms, i * sizeof(Form *));
            items->forms[0] = form;
            items->misses[word < WORD_COUNT ? word : 0] = 0;
            return copy(state, form, &found) ? after : NULL;
        }
    }
    begin_learning(items, state, at, end);
    return NULL;
}
