// AST builders, copies and comparison.
//
// Turns what a grammar action knows into one node in the builder's arena. Keeps the height of each tree, so that a text
// that nests too deeply is refused while it is built and no later walk can overflow the stack.
//
// SPDX-License-Identifier: MIT
#include "ast/ast.h"

#include <string.h>

static const char *const kind_names[AST_KIND_COUNT] = {
#define AST(kind, name, a, b, c) [AST_##kind] = name,
#include "ast/ast_kinds.def"
#undef AST
};

static const char *const op_spellings[AST_OP_COUNT] = {
#define AST_OP(op, spelling, precedence) [AST_OP_##op] = spelling,
#include "ast/ast_ops.def"
#undef AST_OP
};

const char *ast_kind_name(AstKind kind)
{
    return kind_names[kind];
}

const char *ast_op_spelling(AstOp op)
{
    return op_spellings[op];
}

static AstNode *fail(AstBuilder *builder, DiagCode code, Span span)
{
    if (!builder->failed) {
        builder->failed = true;
        if (code == DIAG_E0601) {
            if (diag_report(builder->diags, code, span, "expressions and blocks nest deeper than %u levels here",
                            builder->depth_limit) &&
                builder->depth_limit < LIMIT_DEPTH_MAX) {
                diag_suggest(builder->diags, "`--max-depth` allows more");
            }
        } else {
            limits_report_memory(builder->diags, span, builder->arena->shared, "reading the scene");
        }
    }
    builder->dummy = (AstNode){.span = span};
    return &builder->dummy;
}

static uint32_t greater(uint32_t one, uint32_t other)
{
    return one > other ? one : other;
}

static AstNode *new_node(AstBuilder *builder, AstNode content)
{
    if (RT_UNLIKELY(content.depth > builder->depth_limit)) {
        return fail(builder, DIAG_E0601, content.span);
    }
    AstNode *node = arena_alloc(builder->arena, sizeof *node);
    if (RT_UNLIKELY(!node)) {
        return fail(builder, DIAG_E0602, content.span);
    }
    *node = content;
    return node;
}

AstNode *ast_node(AstBuilder *builder, AstHead head, AstNode *a, AstNode *b, AstNode *c)
{
    uint32_t depth = a ? a->depth : 0;
    depth = b ? greater(depth, b->depth) : depth;
    depth = c ? greater(depth, c->depth) : depth;
    return new_node(builder, (AstNode){.kind = (uint8_t)head.kind,
                                       .op = (uint8_t)head.op,
                                       .symbol = head.symbol,
                                       .depth = depth + 1,
                                       .span = head.span,
                                       .a = a,
                                       .b = b,
                                       .c = c});
}

AstNode *ast_node_list(AstBuilder *builder, AstHead head, AstList a, AstList b, AstList c)
{
    return new_node(builder, (AstNode){.kind = (uint8_t)head.kind,
                                       .op = (uint8_t)head.op,
                                       .symbol = head.symbol,
                                       .depth = greater(a.depth, greater(b.depth, c.depth)) + 1,
                                       .count = a.count,
                                       .span = head.span,
                                       .a = a.first,
                                       .b = b.first,
                                       .c = c.first});
}

AstNode *ast_number(AstBuilder *builder, double number, Span span)
{
    return new_node(builder, (AstNode){.kind = AST_NUMBER, .depth = 1, .span = span, .number = number});
}

AstList ast_append(AstList list, AstNode *node)
{
    if (!list.first) {
        list.first = node;
    } else {
        list.last->next = node;
    }
    list.last = node;
    list.count++;
    list.depth = greater(list.depth, node->depth);
    return list;
}

AstList ast_append_after_comma(AstList list, AstNode *node)
{
    return ast_append(list, ast_flag(node, AST_AFTER_COMMA));
}

AstList ast_flag_first(AstList list, unsigned flags)
{
    if (list.first) {
        ast_flag(list.first, flags);
    }
    return list;
}

AstList ast_flag_last(AstList list, unsigned flags)
{
    if (list.last) {
        ast_flag(list.last, flags);
    }
    return list;
}

AstNode *ast_flag(AstNode *node, unsigned flags)
{
    node->flags = (uint16_t)(node->flags | flags);
    return node;
}

static bool clone_list(const AstNode *from, Arena *arena, AstNode **to)
{
    for (; from; from = from->next) {
        *to = ast_clone(from, arena);
        if (!*to) {
            return false;
        }
        to = &(*to)->next;
    }
    return true;
}

static const AstPack *pack_copy(Arena *arena, const AstPack *pack, uint32_t count)
{
    AstPack *copy = arena_alloc(arena, sizeof *copy);
    double *numbers = arena_copy(arena, pack->numbers, pack->number_count * sizeof *numbers);
    uint8_t *widths = arena_copy(arena, pack->widths, count);
    if (!copy || !numbers || !widths) {
        return NULL;
    }
    *copy = (AstPack){pack->number_count, widths, numbers};
    return copy;
}

AstNode *ast_packed(AstBuilder *builder, const uint8_t *widths, uint32_t count, const double *numbers,
                    uint32_t number_count, Span span)
{
    const AstPack *pack = pack_copy(builder->arena, &(AstPack){number_count, widths, numbers}, count);
    AstNode node = {.kind = AST_PACKED, .depth = 1, .count = count, .span = span, .pack = pack};
    return pack ? new_node(builder, node) : fail(builder, DIAG_E0602, span);
}

AstNode *ast_clone(const AstNode *node, Arena *arena)
{
    AstNode *copy = arena_alloc(arena, sizeof *copy);
    if (!copy) {
        return NULL;
    }
    *copy = *node;
    copy->next = NULL;
    if (node->kind == AST_NUMBER || (node->flags & AST_KNOWN)) {
        return copy;
    }
    if (node->kind == AST_PACKED) {
        copy->pack = pack_copy(arena, node->pack, node->count);
        return copy->pack ? copy : NULL;
    }
    copy->a = copy->b = copy->c = NULL;
    bool complete = clone_list(node->a, arena, &copy->a) && clone_list(node->b, arena, &copy->b) &&
                    clone_list(node->c, arena, &copy->c);
    return complete ? copy : NULL;
}

static bool lists_equal(const AstNode *one, const AstNode *other)
{
    while (one && other) {
        if (!ast_equal(one, other)) {
            return false;
        }
        one = one->next;
        other = other->next;
    }
    return one == other;
}

bool ast_equal(const AstNode *one, const AstNode *other)
{
    const unsigned commas = AST_AFTER_COMMA | AST_BEFORE_COMMA;
    if (one->kind != other->kind || one->op != other->op || one->symbol != other->symbol ||
        (one->flags & commas) != (other->flags & commas)) {
        return false;
    }
    if (one->kind == AST_NUMBER) {
        return memcmp(&one->number, &other->number, sizeof one->number) == 0;
    }
    if (one->kind == AST_PACKED) {
        return one->count == other->count && one->pack->number_count == other->pack->number_count &&
               memcmp(one->pack->widths, other->pack->widths, one->count) == 0 &&
               memcmp(one->pack->numbers, other->pack->numbers, one->pack->number_count * sizeof *one->pack->numbers) ==
                   0;
    }
    return lists_equal(one->a, other->a) && lists_equal(one->b, other->b) && lists_equal(one->c, other->c);
}
