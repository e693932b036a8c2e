// Short words for what the grammar's actions do with nodes and lists of them: `state` is the parser's.
//
// SPDX-License-Identifier: MIT
#ifndef GRAMMAR_ACTIONS_H
#define GRAMMAR_ACTIONS_H

#include "ast/ast.h"
#include "grammar/lexer.h"

#define EMPTY ((AstList){0})
#define NODE(kind, op, symbol, at, a, b, c)                                                                            \
    ast_node(&state->builder, (AstHead){AST_##kind, AST_OP_##op, (symbol), (at)}, (a), (b), (c))
#define LEAF(kind, symbol, at) NODE(kind, NONE, symbol, at, NULL, NULL, NULL)
#define BINARY(op, at, left, right) NODE(BINARY, op, SYMBOL_NONE, at, left, right, NULL)
#define LISTS(kind, op, symbol, at, a, b, c)                                                                           \
    ast_node_list(&state->builder, (AstHead){AST_##kind, AST_OP_##op, (symbol), (at)}, (a), (b), (c))
#define LIST(kind, symbol, at, a) LISTS(kind, NONE, symbol, at, a, EMPTY, EMPTY)
#define ONE(node) ast_append(EMPTY, (node))
#define LEARN(items, opens, closes) grammar_learn_items(state, (Span){(opens).begin, (closes).end}, (items))
#define FOLD(node) grammar_fold(state, (node))
#define CALL(node) grammar_call(state, (node))

#endif
