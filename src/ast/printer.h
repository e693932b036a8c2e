// The printer of the AST, shared by its two files; private to the module.
//
//   ast_print.c             items, values and directives
//   ast_print_expression.c  expressions, and the parentheses that they need
//
// SPDX-License-Identifier: MIT
#ifndef AST_PRINTER_H
#define AST_PRINTER_H

#include "ast/ast.h"

enum {
    PRECEDENCE_CHOICE = 1,
    PRECEDENCE_RELATION = 3,
    PRECEDENCE_SUM = 4,
    PRECEDENCE_UNARY = 6,
    PRECEDENCE_POSTFIX = 7,
};

typedef struct Printer {
    const InternTable *names;
    TextBuffer *out;
    int indent; // of the item being printed, for directives inside expressions
} Printer;

// Where an item stands among others.
typedef struct Neighbours {
    const AstNode *previous;
    const AstNode *run_end; // expressions before it share run_closed
    bool run_closed;
} Neighbours;

static inline void printer_put(Printer *printer, const char *text)
{
    text_append(printer->out, text);
}

static inline void printer_put_symbol(Printer *printer, Symbol symbol)
{
    text_append_n(printer->out, intern_get(printer->names, symbol), intern_length(printer->names, symbol));
}

static inline bool printer_is_expression(const AstNode *node)
{
    return node->kind <= AST_MEMBER;
}

// ---- ast_print_expression.c

// At least as binding as `precedence`, or in parentheses.
void printer_operand(Printer *printer, const AstNode *node, int precedence);
// Values with commas between them.
void printer_list(Printer *printer, const AstNode *list, int indent);
// The last expression of a directive without an end mark.
void printer_open_end(Printer *printer, const AstNode *item);
// Whether an item needs parentheses so that it does not continue the one before, nor the next one continues it.
bool printer_needs_parentheses(const AstNode *node, Neighbours *neighbours);

// ---- ast_print.c

void printer_value(Printer *printer, const AstNode *node, int indent);
void printer_directive(Printer *printer, const AstNode *node, int indent);

#endif
