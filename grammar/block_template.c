// Blocks like earlier ones: a copy of their nodes, with other numbers.
//
// Turns `{ … }` after a word into the nodes that the parser made of such a text before, when it matches its template:
// each node's span is bound to the text between two numbers, or to a number. Owns what it has learnt.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "ast/words.h"
#include "base/plain.h"
#include "grammar/lexer.h"
#include "grammar/template.h"

enum {
    KEPT = 8, // templates
    NODES_MOST = 256,
    MISSES_MOST = 32, // so many texts in a row of a word's block that no other is like: from then on few are kept
};

// A node and where its span begins and ends: in the text before a slot, or behind the last one.
typedef struct BlockNode {
    AstNode node; // links lead to others of these
    unsigned short slot, parent; // 1 + the number's; 1 + place of the node that it is below; 0: none
    unsigned short begin_piece, begin, end_piece, end;
} BlockNode;

typedef struct BlockTemplate {
    Symbol word; // before the brace
    Template *template;
    uint64_t begin, end; // of the text that it is learnt from
    GrammarSlot slots[GRAMMAR_SLOTS_MOST];
    unsigned slot_count;
    BlockNode *nodes;
    unsigned count;
    AstList list;
} BlockTemplate;

struct GrammarBlocks {
    BlockTemplate *kept[KEPT]; // the one used last first
    BlockTemplate *learning;   // its text is being parsed
    unsigned char misses[WORD_COUNT];
};

GrammarBlocks *grammar_blocks_new(void)
{
    return calloc(1, sizeof(GrammarBlocks));
}

static void block_free(BlockTemplate *block)
{
    if (block != NULL) {
        template_free(block->template);
        free(block->nodes);
        free(block);
    }
}

void grammar_blocks_free(GrammarBlocks *blocks)
{
    for (unsigned i = 0; blocks != NULL && i < KEPT; i++) {
        block_free(blocks->kept[i]);
    }
    block_free(blocks != NULL ? blocks->learning : NULL);
    free(blocks);
}

// Keeps the text of a block that is now parsed, if it may come again.
static void begin_learning(GrammarBlocks *blocks, const GrammarState *state, const char *at, const char *end)
{
    Symbol word = state->previous.symbol;
    unsigned char *misses = &blocks->misses[word < WORD_COUNT ? word : 0];
    *misses = *misses < 2 * MISSES_MOST - 1 ? (unsigned char)(*misses + 1) : MISSES_MOST;
    BlockTemplate *block = *misses > MISSES_MOST ? NULL : calloc(1, sizeof *block);
    if (block == NULL) {
        return;
    }
    block_free(blocks->learning);
    blocks->learning = block;
    size_t length = template_survey(state->context, at, end, state->offset, block->slots, &block->slot_count);
    block->word = word;
    block->begin = state->offset;
    block->end = state->offset + length;
    block->template = length > 0 ? template_new(at, length, state->offset, block->slots, block->slot_count) : NULL;
}

// ---- nodes of what was parsed

// The text between two numbers without the blanks around it, as it stood when it was learnt.
static Span piece_of(const BlockTemplate *block, unsigned piece)
{
    const TemplatePiece *text = &block->template->pieces[piece];
    uint64_t begin = piece > 0 ? block->slots[piece - 1].span.end : block->begin;
    size_t blanks = (size_t)(plain_skip_blanks(text->bytes) - text->bytes), length = text->length;
    while (length > blanks && plain_is_blank(text->bytes[length - 1])) {
        length--;
    }
    return (Span){begin + blanks, begin + length};
}

// Binds a place of the text to a piece. False: it is in none.
static bool bind(const BlockTemplate *block, uint64_t at, unsigned short *piece, unsigned short *offset)
{
    for (unsigned i = 0; i <= block->slot_count; i++) {
        Span span = piece_of(block, i);
        if (at >= span.begin && at <= span.end && span.end > span.begin) {
            *piece = (unsigned short)i;
            *offset = (unsigned short)(at - span.begin);
            return true;
        }
    }
    return false;
}

// The slot of a number; slot_count: none.
static unsigned find_slot(const BlockTemplate *block, Span number)
{
    unsigned slot = 0;
    while (slot < block->slot_count && (block->slots[slot].span.begin != number.begin ||
                                        block->slots[slot].span.end != number.end)) {
        slot++;
    }
    return slot;
}

static bool add_node(BlockTemplate *block, const AstNode *node, unsigned parent);

static bool add_list(BlockTemplate *block, const AstNode *first, unsigned parent, AstNode **link)
{
    *link = NULL;
    for (const AstNode *node = first; node != NULL; node = node->next) {
        unsigned place = block->count;
        if (!add_node(block, node, parent)) {
            return false;
        }
        *link = &block->nodes[place].node;
        link = &(*link)->next;
    }
    return true;
}

// A node and all below it, behind those that there are. False for one that no template has.
static bool add_node(BlockTemplate *block, const AstNode *node, unsigned parent)
{
    if (block->count == NODES_MOST) {
        return false;
    }
    unsigned place = block->count++;
    BlockNode *kept = &block->nodes[place];
    *kept = (BlockNode){.node = *node, .parent = (unsigned short)parent};
    kept->node.next = NULL;
    bool is_negative = node->kind == AST_UNARY && node->op == AST_OP_NEG && node->a->kind == AST_NUMBER;
    if (node->kind == AST_NUMBER || is_negative) {
        unsigned slot = find_slot(block, node->span);
        kept->slot = (unsigned short)(slot + 1);
        return slot < block->slot_count;
    }
    bool is_leaf = node->kind == AST_WORD || node->kind == AST_CONSTANT;
    if ((!is_leaf && node->kind != AST_VECTOR && node->kind != AST_BLOCK) || node->b != NULL || node->c != NULL ||
        !bind(block, node->span.begin, &kept->begin_piece, &kept->begin) ||
        !bind(block, node->span.end, &kept->end_piece, &kept->end)) {
        return false;
    }
    return add_list(block, node->a, place + 1, &kept->node.a);
}

void grammar_blocks_learn(GrammarBlocks *blocks, const GrammarState *state, Span braces, AstList list)
{
    BlockTemplate *block = blocks->learning;
    if (block == NULL || block->template == NULL || block->begin != braces.begin || block->end != braces.end) {
        return;
    }
    bool is_fine = list.count > 0 && !state->builder.failed && state->context->diags->error_count == state->faults_before;
    block->nodes = is_fine ? malloc(NODES_MOST * sizeof *block->nodes) : NULL;
    blocks->learning = NULL;
    if (block->nodes == NULL || !add_list(block, list.first, 0, &block->list.first)) {
        block_free(block);
        return;
    }
    block->list.count = list.count;
    block->list.last = block->list.first;
    while (block->list.last->next != NULL) {
        block->list.last = block->list.last->next;
    }
    block_free(blocks->kept[KEPT - 1]);
    memmove(blocks->kept + 1, blocks->kept, (KEPT - 1) * sizeof *blocks->kept);
    blocks->kept[0] = block;
}

// ---- reading what is like it

typedef struct Found {
    double numbers[GRAMMAR_SLOTS_MOST];
    TemplatePlace places[GRAMMAR_SLOTS_MOST];
    uint64_t pieces[GRAMMAR_SLOTS_MOST + 1]; // where each begins
} Found;

static AstNode *moved(const AstNode *node, const BlockTemplate *block, AstNode *to)
{
    // The node is the first member of a BlockNode.
    return node != NULL ? to + ((const BlockNode *)(const void *)node - block->nodes) : NULL;
}

// A number, with its sign as a node of its own before it.
static void put_number(const Found *found, unsigned slot, Span span, AstNode *node, AstNode *digits)
{
    bool is_negative = *found->places[slot].begin == '-';
    unsigned flags = node->flags;
    AstNode *next = node->next;
    *node = (AstNode){.kind = AST_NUMBER, .depth = 1, .span = span, .number = found->numbers[slot]};
    if (is_negative) {
        *digits = *node;
        digits->number = -digits->number;
        digits->span.begin++;
        *node = (AstNode){.kind = AST_UNARY, .op = AST_OP_NEG, .depth = 2, .span = span, .a = digits};
    }
    node->flags = (uint16_t)flags;
    node->next = next;
}

// The nodes with what was found, whose text begins at `at`; their depths depend on signs. False: out of memory, or too
// deep.
static bool copy(GrammarState *state, const BlockTemplate *block, const char *at, Found *found)
{
    AstNode *nodes = arena_alloc_array(state->builder.arena, block->count + block->slot_count, sizeof *nodes);
    unsigned depths[NODES_MOST];
    if (nodes == NULL) {
        return false;
    }
    for (unsigned i = 0; i <= block->slot_count; i++) {
        const char *piece = i > 0 ? plain_skip_blanks(found->places[i - 1].end) : at;
        found->pieces[i] = state->offset + (uint64_t)(piece - at);
    }
    state->list = block->list;
    state->list.depth = 0;
    memset(depths, 0, block->count * sizeof *depths);
    for (unsigned i = block->count; i-- > 0;) { // what is below a node stands behind it
        const BlockNode *kept = &block->nodes[i];
        AstNode *node = &nodes[i];
        *node = kept->node;
        node->next = moved(node->next, block, nodes);
        if (kept->slot > 0) {
            const TemplatePlace *place = &found->places[kept->slot - 1];
            Span span = {state->offset + (uint64_t)(place->begin - at), state->offset + (uint64_t)(place->end - at)};
            put_number(found, kept->slot - 1u, span, node, &nodes[block->count + kept->slot - 1u]);
        } else {
            node->a = moved(node->a, block, nodes);
            node->span.begin = found->pieces[kept->begin_piece] + kept->begin;
            node->span.end = found->pieces[kept->end_piece] + kept->end;
            node->depth = depths[i] + 1;
        }
        unsigned *above = kept->parent > 0 ? &depths[kept->parent - 1] : &state->list.depth;
        *above = node->depth > *above ? node->depth : *above;
    }
    state->list.first = moved(state->list.first, block, nodes);
    state->list.last = moved(state->list.last, block, nodes);
    return state->list.depth < state->builder.depth_limit;
}

const char *grammar_blocks_read(GrammarBlocks *blocks, GrammarState *state, const char *at, const char *end)
{
    Symbol word = state->previous.symbol;
    for (unsigned i = 0; i < KEPT && blocks->kept[i] != NULL; i++) {
        BlockTemplate *block = blocks->kept[i];
        Found found;
        const char *after = block->word == word ? template_find(block->template, at, end, found.numbers, found.places)
                                                : NULL;
        if (after != NULL) {
            memmove(blocks->kept + 1, blocks->kept, i * sizeof *blocks->kept);
            blocks->kept[0] = block;
            blocks->misses[word < WORD_COUNT ? word : 0] = 0;
            return copy(state, block, at, &found) ? after : NULL;
        }
    }
    begin_learning(blocks, state, at, end);
    return NULL;
}
