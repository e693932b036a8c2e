// The printable form of expressions, and the parentheses that they need where they stand side by side.
//
// Expressions get the parentheses that were written and those that precedence asks for. Items that stand side by side
// get more where the next one would otherwise continue the one before (`1 (-2)`, `(A) (2 + B)*3`). Knows syntax only.
//
// SPDX-License-Identifier: MIT
#include "ast/printer.h"

static const unsigned char op_precedences[AST_OP_COUNT] = {
#define AST_OP(op, spelling, precedence) [AST_OP_##op] = precedence,
#include "ast/ast_ops.def"
#undef AST_OP
};

static int precedence_of(const AstNode *node)
{
    switch (node->kind) {
    case AST_CONDITIONAL:
    case AST_BINARY:
    case AST_UNARY:
        return op_precedences[node->op];
    default:
        return PRECEDENCE_POSTFIX;
    }
}

// What stands behind a mark, `length` bytes of it at most: an escape's character in UTF-8, or the mark itself. Returns its
// length.
static size_t print_marked(Printer *printer, const char *text, size_t length)
{
    const unsigned char *at = (const unsigned char *)text;
    size_t bytes = at[0] < 0xE0 ? 2 : 3;
    if (length < bytes || text[0] == TEXT_MARK) {
        text_append_char(printer->out, TEXT_MARK);
        return 1;
    }
    unsigned lead = bytes == 2 ? at[0] & 0x1Fu : (at[0] & 0x0Fu) << 6 | (at[1] & 0x3Fu);
    text_printf(printer->out, "\\u%04x", lead << 6 | (at[bytes - 1] & 0x3Fu));
    return bytes;
}

static void print_string(Printer *printer, Symbol symbol)
{
    static const char controls[] = "\a\b\f\n\r\t\v\\\"", letters[] = "abfnrtv\\\"";
    const char *text = intern_get(printer->names, symbol);
    size_t length = intern_length(printer->names, symbol);
    text_append_char(printer->out, '"');
    for (size_t i = 0; i < length; i++) {
        unsigned letter = 0;
        if (text[i] == TEXT_MARK && i + 1 < length) {
            i += print_marked(printer, text + i + 1, length - i - 1);
            continue;
        }
        while (controls[letter] != '\0' && controls[letter] != text[i]) {
            letter++;
        }
        if (controls[letter] != '\0') {
            text_printf(printer->out, "\\%c", letters[letter]);
        } else if ((unsigned char)text[i] < ' ' || text[i] == 0x7f) {
            text_printf(printer->out, "\\u%04x", (unsigned)(unsigned char)text[i]);
        } else {
            text_append_char(printer->out, text[i]);
        }
    }
    text_append_char(printer->out, '"');
}

// Parentheses that were written are kept: to a macro they make a difference. A directive without them would be an item.
static bool needs_closing(const AstNode *node, int precedence)
{
    return (node->flags & AST_IN_PARENTHESES) || node->kind == AST_INLINE || precedence_of(node) < precedence;
}

void printer_list(Printer *printer, const AstNode *list, int indent)
{
    const char *separator = "";
    for (const AstNode *node = list; node; node = node->next) {
        printer_put(printer, separator);
        printer_value(printer, node, indent);
        separator = node->kind == AST_WORD ? " " : ", ";
    }
}

static bool ends_in_comma(const AstNode *list)
{
    while (list && list->next) {
        list = list->next;
    }
    return list && (list->flags & AST_BEFORE_COMMA);
}

// The parentheses of a function hold one relation without parentheses of its own.
static void print_builtin(Printer *printer, const AstNode *node)
{
    printer_put_symbol(printer, node->symbol);
    printer_put(printer, "(");
    for (const AstNode *operand = node->a; operand; operand = operand->next) {
        printer_put(printer, operand == node->a ? "" : ", ");
        printer_operand(printer, operand, operand == node->a ? PRECEDENCE_CHOICE : PRECEDENCE_SUM);
    }
    printer_put(printer, ")");
}

static void print_binary(Printer *printer, const AstNode *node)
{
    int precedence = precedence_of(node);
    printer_operand(printer, node->a, precedence);
    text_printf(printer->out, precedence > PRECEDENCE_SUM ? "%s" : " %s ", ast_op_spelling((AstOp)node->op));
    printer_operand(printer, node->b, precedence + 1);
}

static void print_expression(Printer *printer, const AstNode *node);

static void print_call(Printer *printer, const AstNode *node)
{
    if (node->b) {
        print_expression(printer, node->b);
    } else {
        printer_put_symbol(printer, node->symbol);
    }
    printer_put(printer, "(");
    printer_list(printer, node->a, printer->indent);
    printer_put(printer, ends_in_comma(node->a) ? ",)" : ")");
}

static void print_expression(Printer *printer, const AstNode *node)
{
    switch (node->kind) {
    case AST_NUMBER:
        text_append_double(printer->out, node->number);
        break;
    case AST_STRING:
        print_string(printer, node->symbol);
        break;
    case AST_NAME:
    case AST_CONSTANT:
        printer_put_symbol(printer, node->symbol);
        break;
    case AST_UNARY:
        printer_put(printer, ast_op_spelling((AstOp)node->op));
        printer_operand(printer, node->a, PRECEDENCE_UNARY);
        break;
    case AST_BINARY:
        print_binary(printer, node);
        break;
    case AST_CONDITIONAL:
        printer_operand(printer, node->a, PRECEDENCE_CHOICE + 1);
        printer_put(printer, " ? ");
        printer_operand(printer, node->b, PRECEDENCE_CHOICE);
        printer_put(printer, " : ");
        printer_operand(printer, node->c, PRECEDENCE_CHOICE);
        break;
    case AST_VECTOR:
        printer_put(printer, "<");
        printer_list(printer, node->a, printer->indent);
        printer_put(printer, ends_in_comma(node->a) ? ",>" : ">");
        break;
    case AST_CALL:
        print_call(printer, node);
        break;
    case AST_BUILTIN:
        print_builtin(printer, node);
        break;
    case AST_INLINE:
        printer_directive(printer, node->a, printer->indent);
        break;
    case AST_INDEX:
        printer_operand(printer, node->a, PRECEDENCE_POSTFIX);
        printer_put(printer, "[");
        printer_operand(printer, node->b, PRECEDENCE_SUM);
        printer_put(printer, "]");
        break;
    case AST_MEMBER:
        // `2.x` would be the number `2.` and x.
        printer_operand(printer, node->a, node->a->kind == AST_NUMBER ? PRECEDENCE_POSTFIX + 1 : PRECEDENCE_POSTFIX);
        printer_put(printer, ".");
        printer_put_symbol(printer, node->symbol);
        break;
    default:
        break;
    }
}

void printer_operand(Printer *printer, const AstNode *node, int precedence)
{
    bool closed = needs_closing(node, precedence);
    printer_put(printer, closed ? "(" : "");
    print_expression(printer, node);
    printer_put(printer, closed ? ")" : "");
}

// ---- Expressions side by side.

static bool follows_bare(const AstNode *node)
{
    return node && printer_is_expression(node) && !(node->flags & AST_AFTER_COMMA);
}

static bool begins_with_sign(const AstNode *node)
{
    while (node->kind == AST_BINARY && !needs_closing(node, PRECEDENCE_SUM) &&
           !needs_closing(node->a, precedence_of(node))) {
        node = node->a;
    }
    return node->kind == AST_UNARY && node->op != AST_OP_NOT && !needs_closing(node, PRECEDENCE_SUM);
}

static bool begins_with_parenthesis(const AstNode *node)
{
    if (needs_closing(node, PRECEDENCE_SUM)) {
        return true;
    }
    const AstNode *first = node;
    for (;;) {
        const AstNode *operand = first->kind == AST_BINARY || first->kind == AST_MEMBER ? first->a : NULL;
        if (!operand) {
            return false;
        }
        int wanted = first->kind == AST_BINARY ? precedence_of(first) : PRECEDENCE_POSTFIX;
        if (needs_closing(operand, wanted) || (first->kind == AST_MEMBER && operand->kind == AST_NUMBER)) {
            return true;
        }
        first = operand;
    }
}

// A name before `(` is a call, a name or an element before `[` an element.
static bool ends_with_name(const AstNode *node)
{
    for (;;) {
        if (needs_closing(node, PRECEDENCE_SUM)) {
            return false;
        }
        switch (node->kind) {
        case AST_NAME:
        case AST_INDEX:
            return true;
        case AST_BINARY:
            if (needs_closing(node->b, precedence_of(node) + 1)) {
                return false;
            }
            node = node->b;
            break;
        case AST_UNARY:
            if (needs_closing(node->a, PRECEDENCE_UNARY)) {
                return false;
            }
            node = node->a;
            break;
        default:
            return false;
        }
    }
}

// Whether the expressions from here that end with a name must all be closed: the first other thing after them begins
// with a bracket. `*end` is that thing.
static bool run_is_closed(const AstNode *node, const AstNode **end)
{
    for (;;) {
        const AstNode *next = node->next;
        *end = next;
        if (next && next->kind == AST_ENTRY && !(next->flags & AST_AFTER_COMMA)) {
            return true;
        }
        if (!follows_bare(next)) {
            return false;
        }
        if (begins_with_sign(next) || begins_with_parenthesis(next)) {
            return true;
        }
        if (!ends_with_name(next)) {
            return false;
        }
        node = next;
    }
}

// What is not an expression and ends with one, without a mark: what follows might continue it.
static bool is_open_ended(const AstNode *node)
{
    return node->kind == AST_MESSAGE || node->kind == AST_INCLUDE || node->kind == AST_TERM;
}

void printer_open_end(Printer *printer, const AstNode *item)
{
    const AstNode *end, *last = item->kind == AST_TERM ? item->b : item->a;
    bool closed = ends_with_name(last) && run_is_closed(item, &end);
    printer_operand(printer, last, closed ? PRECEDENCE_POSTFIX + 1 : PRECEDENCE_SUM);
}

bool printer_needs_parentheses(const AstNode *node, Neighbours *neighbours)
{
    const AstNode *previous = neighbours->previous;
    if (!ends_with_name(node)) {
        neighbours->run_end = NULL;
    } else if (!neighbours->run_end || neighbours->run_end == node) {
        neighbours->run_closed = run_is_closed(node, &neighbours->run_end);
    }
    bool continued = previous && follows_bare(node) &&
                     (printer_is_expression(previous) || is_open_ended(previous));
    return (continued && begins_with_sign(node)) || (ends_with_name(node) && neighbours->run_closed);
}
