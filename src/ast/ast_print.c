// The printable form of the AST: canonical scene text that parses to an equal tree.
//
// Items, values and directives, an item a line. Knows syntax only; printer.h has the other part.
//
// SPDX-License-Identifier: MIT
#include "ast/printer.h"

static void print_items(Printer *printer, const AstNode *items, int indent);

static void put_indent(Printer *printer, int indent)
{
    for (int i = 0; i < indent; i++) {
        printer_put(printer, "  ");
    }
}

static void print_block(Printer *printer, const AstNode *items, int indent, const char *end)
{
    if (!items) {
        text_printf(printer->out, " %s", end);
        return;
    }
    printer_put(printer, "\n");
    print_items(printer, items, indent + 1);
    put_indent(printer, indent);
    printer_put(printer, end);
}

static void print_function(Printer *printer, const AstNode *node, int indent)
{
    printer_put(printer, "function");
    if (node->a) {
        printer_put(printer, "(");
        printer_list(printer, node->a, indent);
        printer_put(printer, ")");
    } else if (node->c) {
        printer_put(printer, " ");
        printer_list(printer, node->c, indent);
    }
    printer_put(printer, " { ");
    if (node->b && printer_is_expression(node->b)) {
        printer_operand(printer, node->b, PRECEDENCE_CHOICE + 1);
    } else if (node->b) {
        printer_value(printer, node->b, indent);
    }
    printer_put(printer, " }");
}

static void print_array(Printer *printer, const AstNode *node, int indent)
{
    printer_put(printer, "array");
    for (const AstNode *size = node->a; size; size = size->next) {
        printer_put(printer, "[");
        printer_operand(printer, size, PRECEDENCE_SUM);
        printer_put(printer, "]");
    }
    if (node->b) {
        printer_put(printer, " ");
        printer_value(printer, node->b, indent);
    }
}

// As the items that it stands for.
static void print_packed(Printer *printer, const AstNode *node)
{
    const double *numbers = node->pack->numbers;
    for (uint32_t item = 0; item < node->count; item++) {
        unsigned width = node->pack->widths[item];
        printer_put(printer, item ? ", " : "");
        printer_put(printer, width > 1 ? "<" : "");
        for (unsigned i = 0; i < width; i++) {
            printer_put(printer, i ? ", " : "");
            text_append_double(printer->out, *numbers++);
        }
        printer_put(printer, width > 1 ? ">" : "");
    }
}

void printer_value(Printer *printer, const AstNode *node, int indent)
{
    switch (node->kind) {
    case AST_WORD:
        printer_put_symbol(printer, node->symbol);
        break;
    case AST_BLOCK:
        printer_put_symbol(printer, node->symbol);
        printer_put(printer, " {");
        print_block(printer, node->a, indent, "}");
        break;
    case AST_PACKED:
        print_packed(printer, node);
        break;
    case AST_ENTRY:
        printer_put(printer, "[");
        print_block(printer, node->a, indent, "]");
        break;
    case AST_TERM:
        printer_put_symbol(printer, node->symbol);
        printer_put(printer, "(");
        printer_list(printer, node->a, indent);
        printer_put(printer, "): ");
        printer_open_end(printer, node);
        break;
    case AST_SEQUENCE:
        for (const AstNode *part = node->a; part; part = part->next) {
            printer_put(printer, part == node->a ? "" : " ");
            printer_value(printer, part, indent);
        }
        break;
    case AST_INITIALISER:
        printer_put(printer, "{ ");
        printer_list(printer, node->a, indent);
        printer_put(printer, " }");
        break;
    case AST_ARRAY:
        print_array(printer, node, indent);
        break;
    case AST_FUNCTION:
        print_function(printer, node, indent);
        break;
    default:
        printer_operand(printer, node, PRECEDENCE_SUM);
        break;
    }
}

// One that could not be read is missing: it is in #ifdef, #ifndef and #range with a fault.
static void print_condition(Printer *printer, const char *directive, const AstNode *condition)
{
    printer_put(printer, directive);
    printer_put(printer, " (");
    if (condition) {
        printer_operand(printer, condition, PRECEDENCE_CHOICE);
    }
    printer_put(printer, ")");
}

static void print_branch(Printer *printer, const AstNode *items, int indent)
{
    printer_put(printer, "\n");
    print_items(printer, items, indent + 1);
}

// An IF alone is written as #elseif only when nothing about it says otherwise: its flags would have no place.
static bool is_elseif(const AstNode *rest)
{
    return rest->kind == AST_IF && !rest->next && rest->flags == 0;
}

static void print_if(Printer *printer, const AstNode *node, int indent)
{
    print_condition(printer, node->kind == AST_IF ? "#if" : ast_op_spelling((AstOp)node->op), node->a);
    print_branch(printer, node->b, indent);
    const AstNode *rest = node->c;
    while (rest) {
        put_indent(printer, indent);
        if (is_elseif(rest)) {
            print_condition(printer, "#elseif", rest->a);
            print_branch(printer, rest->b, indent);
            rest = rest->c;
        } else {
            printer_put(printer, "#else");
            print_branch(printer, rest, indent);
            rest = NULL;
        }
    }
    put_indent(printer, indent);
    printer_put(printer, "#end");
}

static void print_switch(Printer *printer, const AstNode *node, int indent)
{
    print_condition(printer, "#switch", node->a);
    print_branch(printer, node->c, indent);
    for (const AstNode *branch = node->b; branch; branch = branch->next) {
        put_indent(printer, indent);
        if (branch->kind == AST_CASE) {
            print_condition(printer, "#case", branch->a);
            print_branch(printer, branch->b, indent);
        } else if (branch->kind == AST_RANGE) {
            printer_put(printer, "#range (");
            printer_operand(printer, branch->a, PRECEDENCE_SUM);
            printer_put(printer, ", ");
            printer_operand(printer, branch->b, PRECEDENCE_SUM);
            printer_put(printer, ")");
            print_branch(printer, branch->c, indent);
        } else {
            printer_put(printer, "#else");
            print_branch(printer, branch->a, indent);
        }
    }
    put_indent(printer, indent);
    printer_put(printer, "#end");
}

static void print_body(Printer *printer, const AstNode *items, int indent)
{
    print_branch(printer, items, indent);
    put_indent(printer, indent);
    printer_put(printer, "#end");
}

// `name (first, more…)` of #for, #macro, #read and #write.
static void print_header(Printer *printer, const char *name, const AstNode *first, const AstNode *more, int indent)
{
    text_printf(printer->out, "%s (", name);
    printer_list(printer, first, indent);
    printer_put(printer, first && more ? ", " : "");
    printer_list(printer, more, indent);
    printer_put(printer, ")");
}

// The file name of an #include: backslashes stand for themselves there.
static void print_include(Printer *printer, const AstNode *node)
{
    printer_put(printer, "#include ");
    if (node->a->kind == AST_STRING) {
        printer_put(printer, "\"");
        printer_put_symbol(printer, node->a->symbol);
        printer_put(printer, "\"");
    } else {
        printer_open_end(printer, node);
    }
}

static void print_file_directive(Printer *printer, const AstNode *node, int indent)
{
    switch (node->kind) {
    case AST_INCLUDE:
        print_include(printer, node);
        break;
    case AST_FOPEN:
        printer_put(printer, "#fopen ");
        printer_put_symbol(printer, node->a->symbol);
        printer_put(printer, " ");
        printer_operand(printer, node->b, PRECEDENCE_SUM);
        printer_put(printer, " ");
        printer_put_symbol(printer, node->symbol);
        break;
    case AST_FCLOSE:
        printer_put(printer, "#fclose ");
        printer_put_symbol(printer, node->a->symbol);
        break;
    default:
        print_header(printer, ast_kind_name((AstKind)node->kind), node->a, node->b, indent);
        break;
    }
}

void printer_directive(Printer *printer, const AstNode *node, int indent)
{
    switch (node->kind) {
    case AST_DECLARE:
        text_printf(printer->out, "%s ", ast_op_spelling((AstOp)node->op));
        printer_operand(printer, node->a, PRECEDENCE_SUM);
        printer_put(printer, " = ");
        printer_value(printer, node->b, indent);
        printer_put(printer, ";");
        break;
    case AST_IF:
    case AST_IFDEF:
        print_if(printer, node, indent);
        break;
    case AST_SWITCH:
        print_switch(printer, node, indent);
        break;
    case AST_WHILE:
        print_condition(printer, "#while", node->a);
        print_body(printer, node->b, indent);
        break;
    case AST_FOR:
        print_header(printer, "#for", node->a, node->b, indent);
        print_body(printer, node->c, indent);
        break;
    case AST_MACRO:
        printer_put(printer, "#macro ");
        printer_put_symbol(printer, node->symbol);
        print_header(printer, "", node->a, NULL, indent);
        print_body(printer, node->b, indent);
        break;
    case AST_DEFAULT:
        printer_put(printer, "#default {");
        print_block(printer, node->a, indent, "}");
        break;
    case AST_VERSION:
    case AST_UNDEF:
        text_printf(printer->out, "%s ", ast_kind_name((AstKind)node->kind));
        printer_operand(printer, node->a, PRECEDENCE_SUM);
        printer_put(printer, node->kind == AST_VERSION ? ";" : "");
        break;
    case AST_MESSAGE:
        text_printf(printer->out, "%s ", ast_op_spelling((AstOp)node->op));
        printer_open_end(printer, node);
        break;
    case AST_BREAK:
        printer_put(printer, "#break");
        break;
    default:
        print_file_directive(printer, node, indent);
        break;
    }
}

static bool is_operand_of_line(const AstNode *node)
{
    return printer_is_expression(node) || node->kind == AST_WORD || node->kind == AST_PACKED;
}

static void print_item(Printer *printer, const AstNode *node, Neighbours *neighbours, int indent)
{
    if (printer_is_expression(node)) {
        bool closed = printer_needs_parentheses(node, neighbours);
        printer_put(printer, closed ? "(" : "");
        printer_operand(printer, node, closed ? PRECEDENCE_CHOICE : PRECEDENCE_SUM);
        printer_put(printer, closed ? ")" : "");
    } else if (node->kind >= AST_DECLARE) {
        printer_directive(printer, node, indent);
    } else {
        printer_value(printer, node, indent);
    }
    printer_put(printer, node->flags & AST_BEFORE_COMMA ? "," : "");
    printer_put(printer, node->flags & AST_BEFORE_SEMICOLON ? ";" : "");
}

// One item a line; a word and the expressions after it share one.
static void print_items(Printer *printer, const AstNode *items, int indent)
{
    Neighbours neighbours = {0};
    printer->indent = indent;
    for (const AstNode *node = items; node; node = node->next) {
        const AstNode *previous = neighbours.previous;
        bool is_value = printer_is_expression(node) || node->kind == AST_PACKED;
        bool same_line = previous && is_value && is_operand_of_line(previous);
        bool comma = node->flags & AST_AFTER_COMMA;
        if (same_line) {
            printer_put(printer, comma ? ", " : " ");
        } else {
            printer_put(printer, previous ? (comma ? ",\n" : "\n") : "");
            put_indent(printer, indent);
            printer_put(printer, !previous && comma ? ", " : "");
        }
        print_item(printer, node, &neighbours, indent);
        neighbours.previous = node;
    }
    printer_put(printer, items ? "\n" : "");
    printer->indent = indent - 1;
}

void ast_print(const AstNode *item, const InternTable *names, int indent, TextBuffer *out)
{
    AstNode alone = *item;
    alone.next = NULL;
    print_items(&(Printer){.names = names, .out = out}, &alone, indent);
}
