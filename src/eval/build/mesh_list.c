// Lists in braces become numbers, item by item: what the header's inline half leaves over, which is where a list begins
// and ends, nodes, and where an item stands.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "eval/build/mesh_list.h"

// Where an item of a pack stands: its text is read once more.
static Span pack_item_span(Eval *ev, const AstNode *packed, uint32_t number)
{
    GrammarText *text = grammar_text_again(ev->grammar, packed->span);
    Span span = packed->span;
    uint32_t item = 0, depth = 0;
    bool is_begun = false;
    for (size_t i = 0; text && i < text->count && item <= number; i++) {
        const Token *token = &text->tokens[i];
        depth += token->kind == '<';
        depth -= token->kind == '>';
        if (token->kind == ',' && depth == 0) {
            item++;
        } else if (item == number) {
            span = is_begun ? (Span){span.begin, token->span.end} : token->span;
            is_begun = true;
        }
    }
    free(text);
    return span;
}

bool mesh_list_open(MeshList *list, Block *block, const AstNode *node)
{
    double count;
    *list = (MeshList){.ev = block->ev, .node = node, .word = eval_text(block->ev, node->symbol)};
    cursor_open(&list->cursor, block->ev, node->a, node->span);
    if (!cursor_number(&list->cursor, &count, &list->span)) {
        return false;
    }
    if (!(count >= 1.0 && count <= MESH_FACES_MOST)) {
        return eval_fault(block->ev, DIAG_E0470, list->span, "`%s` must say that there are 1 to %d, not %g", list->word,
                          MESH_FACES_MOST, count);
    }
    list->wanted = (uint32_t)count;
    return true;
}

bool mesh_list_ends_early(MeshList *list, uint32_t number)
{
    const AstNode *item = cursor_peek(&list->cursor);
    return list->ev->stop
               ? false
               : eval_fault(list->ev, DIAG_E0471, item ? item->span : cursor_end(&list->cursor),
                            "`%s` says that there are %u, and ends after %u", list->word, list->wanted, number);
}

bool mesh_list_next_item(MeshList *list, uint32_t number, unsigned least, double v[3])
{
    list->packed = NULL;
    cursor_take_comma(&list->cursor);
    const AstNode *item = cursor_peek(&list->cursor);
    if (item && item->kind == AST_PACKED) {
        cursor_skip(&list->cursor);
        list->packed = item;
        list->at = 0;
        list->numbers = item->pack->numbers;
        return mesh_list_next(list, number, least, v);
    }
    if (!item || !cursor_at_value(&list->cursor)) {
        return mesh_list_ends_early(list, number);
    }
    Value value;
    Vec3 vector;
    list->span = item->span;
    if (least == 2) {
        if (!cursor_value(&list->cursor, &value)) {
            return false;
        }
        bool is_vector = value.kind == VALUE_VECTOR && value.components >= 2;
        v[0] = is_vector ? value.v[0] : 0.0;
        v[1] = is_vector ? value.v[1] : 0.0;
        if (!is_vector && !value_number(list->ev, &value, list->span, &v[0])) {
            return false;
        }
        v[1] = is_vector ? v[1] : v[0];
        return true;
    }
    if (!cursor_vector3(&list->cursor, &vector, &list->span)) {
        return false;
    }
    v[0] = vector.x;
    v[1] = vector.y;
    v[2] = vector.z;
    return true;
}

Span mesh_list_span(const MeshList *list)
{
    return list->packed && list->at > 0 ? pack_item_span(list->ev, list->packed, list->at - 1) : list->span;
}

bool mesh_list_number_item(MeshList *list, double *number, bool *is_there)
{
    list->packed = NULL;
    cursor_take_comma(&list->cursor);
    const AstNode *item = cursor_peek(&list->cursor);
    if (item && item->kind == AST_PACKED && item->pack->widths[0] == 1) {
        cursor_skip(&list->cursor);
        list->packed = item;
        list->at = 1;
        list->numbers = item->pack->numbers + 1;
        *number = item->pack->numbers[0];
        *is_there = true;
        return true;
    }
    if (!item || item->kind == AST_PACKED || item->kind == AST_VECTOR || !cursor_at_value(&list->cursor)) {
        return true;
    }
    // Whether it is a number is known when it is evaluated; of a vector in a name nothing is lost.
    Value value;
    list->span = item->span;
    if (!eval_expression(list->ev, item, &value)) {
        return false;
    }
    if (value.kind != VALUE_NUMBER) {
        return true;
    }
    cursor_skip(&list->cursor);
    *number = value.number;
    *is_there = true;
    return true;
}

bool mesh_list_close(MeshList *list, bool is_fine)
{
    if (is_fine && !list->ev->stop) {
        cursor_take_comma(&list->cursor);
        const AstNode *item = cursor_peek(&list->cursor);
        bool has_more = item || (list->packed && list->at < list->packed->count);
        if (has_more) {
            Span span = item ? item->span : pack_item_span(list->ev, list->packed, list->at);
            is_fine = eval_fault(list->ev, DIAG_E0471, span, "`%s` says that there are %u, and has more", list->word,
                                 list->wanted);
        }
    }
    cursor_close(&list->cursor);
    return is_fine && !list->ev->stop;
}
