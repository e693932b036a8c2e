// The printable form of the AST: canonical scene text that parses to an equal tree.
//
// Expressions get the parentheses that were written and those that precedence asks for. Items that stand side by side
// get more where the next one would otherwise continue the one before (`1 (-2)`, `(A) (2 + B)*3`). Knows syntax only.
//
// SPDX-License-Identifier: MIT
#include "ast/ast.h"
#include "ast/words.h"

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

static void print_items(Printer *printer, const AstNode *items, int indent);
static void print_value(Printer *printer, const AstNode *node, int indent);
static void print_directive(Printer *printer, const AstNode *node, int indent);

static const unsigned char op_precedences[AST_OP_COUNT] = {
#define AST_OP(op, spelling, precedence) [AST_OP_##op] = precedence,
#include "ast/ast_ops.def"
#undef AST_OP
};

static void put(Printer *printer, const char *text)
{
    text_append(printer->out, text);
}

static void put_symbol(Printer *printer, Symbol symbol)
{
    text_append_n(printer->out, intern_get(printer->names, symbol), intern_length(printer->names, symbol));
}

static void put_indent(Printer *printer, int indent)
{
    for (int i = 0; i < indent; i++) {
        put(printer, "  ");
    }
}

// ---- Expressions.

static bool is_expression(const AstNode *node)
{
    return node->kind <= AST_MEMBER;
}

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

static void print_string(Printer *printer, Symbol symbol)
{
    static const char controls[] = "\a\b\f\n\r\t\v\\\"", letters[] = "abfnrtv\\\"";
    const char *text = intern_get(printer->names, symbol);
    size_t length = intern_length(printer->names, symbol);
    text_append_char(printer->out, '"');
    for (size_t i = 0; i < length; i++) {
        unsigned letter = 0;
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

// At least as binding as `precedence`, or in parentheses.
static void print_operand(Printer *printer, const AstNode *node, int precedence);

static void print_list(Printer *printer, const AstNode *list, int indent)
{
    const char *separator = "";
    for (const AstNode *node = list; node != NULL; node = node->next) {
        put(printer, separator);
        print_value(printer, node, indent);
        separator = node->kind == AST_WORD ? " " : ", ";
    }
}

static bool ends_in_comma(const AstNode *list)
{
    while (list != NULL && list->next != NULL) {
        list = list->next;
    }
    return list != NULL && (list->flags & AST_BEFORE_COMMA);
}

// The parentheses of a function hold one relation without parentheses of its own.
static void print_builtin(Printer *printer, const AstNode *node)
{
    put_symbol(printer, node->symbol);
    put(printer, "(");
    for (const AstNode *operand = node->a; operand != NULL; operand = operand->next) {
        put(printer, operand == node->a ? "" : ", ");
        print_operand(printer, operand, operand == node->a ? PRECEDENCE_CHOICE : PRECEDENCE_SUM);
    }
    put(printer, ")");
}

static void print_binary(Printer *printer, const AstNode *node)
{
    int precedence = precedence_of(node);
    print_operand(printer, node->a, precedence);
    text_printf(printer->out, precedence > PRECEDENCE_SUM ? "%s" : " %s ", ast_op_spelling((AstOp)node->op));
    print_operand(printer, node->b, precedence + 1);
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
        put_symbol(printer, node->symbol);
        break;
    case AST_UNARY:
        put(printer, ast_op_spelling((AstOp)node->op));
        print_operand(printer, node->a, PRECEDENCE_UNARY);
        break;
    case AST_BINARY:
        print_binary(printer, node);
        break;
    case AST_CONDITIONAL:
        print_operand(printer, node->a, PRECEDENCE_CHOICE + 1);
        put(printer, " ? ");
        print_operand(printer, node->b, PRECEDENCE_CHOICE);
        put(printer, " : ");
        print_operand(printer, node->c, PRECEDENCE_CHOICE);
        break;
    case AST_VECTOR:
        put(printer, "<");
        print_list(printer, node->a, printer->indent);
        put(printer, ends_in_comma(node->a) ? ",>" : ">");
        break;
    case AST_CALL:
        if (node->b != NULL) {
            print_expression(printer, node->b);
        } else {
            put_symbol(printer, node->symbol);
        }
        put(printer, "(");
        print_list(printer, node->a, printer->indent);
        put(printer, ends_in_comma(node->a) ? ",)" : ")");
        break;
    case AST_BUILTIN:
        print_builtin(printer, node);
        break;
    case AST_INLINE:
        print_directive(printer, node->a, printer->indent);
        break;
    case AST_INDEX:
        print_operand(printer, node->a, PRECEDENCE_POSTFIX);
        put(printer, "[");
        print_operand(printer, node->b, PRECEDENCE_SUM);
        put(printer, "]");
        break;
    case AST_MEMBER:
        // `2.x` would be the number `2.` and x.
        print_operand(printer, node->a, node->a->kind == AST_NUMBER ? PRECEDENCE_POSTFIX + 1 : PRECEDENCE_POSTFIX);
        put(printer, ".");
        put_symbol(printer, node->symbol);
        break;
    default:
        break;
    }
}

static void print_operand(Printer *printer, const AstNode *node, int precedence)
{
    bool closed = needs_closing(node, precedence);
    put(printer, closed ? "(" : "");
    print_expression(printer, node);
    put(printer, closed ? ")" : "");
}

void ast_print_expression(const AstNode *node, const InternTable *names, TextBuffer *out)
{
    print_operand(&(Printer){.names = names, .out = out}, node, PRECEDENCE_SUM);
}

// ---- Expressions side by side.

static bool follows_bare(const AstNode *node)
{
    return node != NULL && is_expression(node) && !(node->flags & AST_AFTER_COMMA);
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
        if (operand == NULL) {
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
        if (next != NULL && next->kind == AST_ENTRY && !(next->flags & AST_AFTER_COMMA)) {
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

// Directives whose last expression has no end mark: what follows might continue it.
static bool is_open_ended(const AstNode *node)
{
    return node->kind == AST_MESSAGE || node->kind == AST_INCLUDE;
}

static void print_open_end(Printer *printer, const AstNode *directive)
{
    const AstNode *end;
    bool closed = ends_with_name(directive->a) && run_is_closed(directive, &end);
    print_operand(printer, directive->a, closed ? PRECEDENCE_POSTFIX + 1 : PRECEDENCE_SUM);
}

// ---- Values and items.

static void print_block(Printer *printer, const AstNode *items, int indent, const char *end)
{
    if (items == NULL) {
        text_printf(printer->out, " %s", end);
        return;
    }
    put(printer, "\n");
    print_items(printer, items, indent + 1);
    put_indent(printer, indent);
    put(printer, end);
}

static void print_function(Printer *printer, const AstNode *node, int indent)
{
    put(printer, "function");
    if (node->a != NULL) {
        bool sizes = node->a->kind == AST_NUMBER;
        put(printer, sizes ? " " : "(");
        print_list(printer, node->a, indent);
        put(printer, sizes ? "" : ")");
    }
    put(printer, " { ");
    if (node->b != NULL && is_expression(node->b)) {
        print_operand(printer, node->b, PRECEDENCE_CHOICE + 1);
    } else if (node->b != NULL) {
        print_value(printer, node->b, indent);
    }
    put(printer, " }");
}

static void print_array(Printer *printer, const AstNode *node, int indent)
{
    put(printer, "array");
    for (const AstNode *size = node->a; size != NULL; size = size->next) {
        put(printer, "[");
        print_operand(printer, size, PRECEDENCE_SUM);
        put(printer, "]");
    }
    if (node->b != NULL) {
        put(printer, " ");
        print_value(printer, node->b, indent);
    }
}

static void print_value(Printer *printer, const AstNode *node, int indent)
{
    switch (node->kind) {
    case AST_WORD:
        put_symbol(printer, node->symbol);
        break;
    case AST_BLOCK:
        put_symbol(printer, node->symbol);
        put(printer, " {");
        print_block(printer, node->a, indent, "}");
        break;
    case AST_ENTRY:
        put(printer, "[");
        print_block(printer, node->a, indent, "]");
        break;
    case AST_SEQUENCE:
        for (const AstNode *part = node->a; part != NULL; part = part->next) {
            put(printer, part == node->a ? "" : " ");
            print_value(printer, part, indent);
        }
        break;
    case AST_INITIALISER:
        put(printer, "{ ");
        print_list(printer, node->a, indent);
        put(printer, " }");
        break;
    case AST_ARRAY:
        print_array(printer, node, indent);
        break;
    case AST_FUNCTION:
        print_function(printer, node, indent);
        break;
    default:
        print_operand(printer, node, PRECEDENCE_SUM);
        break;
    }
}

static void print_condition(Printer *printer, const char *directive, const AstNode *condition)
{
    put(printer, directive);
    put(printer, " (");
    print_operand(printer, condition, PRECEDENCE_CHOICE);
    put(printer, ")");
}

static void print_branch(Printer *printer, const AstNode *items, int indent)
{
    put(printer, "\n");
    print_items(printer, items, indent + 1);
}

// An IF alone is written as #elseif only when nothing about it says otherwise: its flags would have no place.
static bool is_elseif(const AstNode *rest)
{
    return rest->kind == AST_IF && rest->next == NULL && rest->flags == 0;
}

static void print_if(Printer *printer, const AstNode *node, int indent)
{
    print_condition(printer, node->kind == AST_IF ? "#if" : ast_op_spelling((AstOp)node->op), node->a);
    print_branch(printer, node->b, indent);
    const AstNode *rest = node->c;
    while (rest != NULL) {
        put_indent(printer, indent);
        if (is_elseif(rest)) {
            print_condition(printer, "#elseif", rest->a);
            print_branch(printer, rest->b, indent);
            rest = rest->c;
        } else {
            put(printer, "#else");
            print_branch(printer, rest, indent);
            rest = NULL;
        }
    }
    put_indent(printer, indent);
    put(printer, "#end");
}

static void print_switch(Printer *printer, const AstNode *node, int indent)
{
    print_condition(printer, "#switch", node->a);
    print_branch(printer, node->c, indent);
    for (const AstNode *branch = node->b; branch != NULL; branch = branch->next) {
        put_indent(printer, indent);
        if (branch->kind == AST_CASE) {
            print_condition(printer, "#case", branch->a);
            print_branch(printer, branch->b, indent);
        } else if (branch->kind == AST_RANGE) {
            put(printer, "#range (");
            print_operand(printer, branch->a, PRECEDENCE_SUM);
            put(printer, ", ");
            print_operand(printer, branch->b, PRECEDENCE_SUM);
            put(printer, ")");
            print_branch(printer, branch->c, indent);
        } else {
            put(printer, "#else");
            print_branch(printer, branch->a, indent);
        }
    }
    put_indent(printer, indent);
    put(printer, "#end");
}

static void print_body(Printer *printer, const AstNode *items, int indent)
{
    print_branch(printer, items, indent);
    put_indent(printer, indent);
    put(printer, "#end");
}

// `name (first, more…)` of #for, #macro, #read and #write.
static void print_header(Printer *printer, const char *name, const AstNode *first, const AstNode *more, int indent)
{
    text_printf(printer->out, "%s (", name);
    print_list(printer, first, indent);
    put(printer, first != NULL && more != NULL ? ", " : "");
    print_list(printer, more, indent);
    put(printer, ")");
}

// The file name of an #include: backslashes stand for themselves there.
static void print_include(Printer *printer, const AstNode *node)
{
    put(printer, "#include ");
    if (node->a->kind == AST_STRING) {
        put(printer, "\"");
        put_symbol(printer, node->a->symbol);
        put(printer, "\"");
    } else {
        print_open_end(printer, node);
    }
}

static void print_file_directive(Printer *printer, const AstNode *node, int indent)
{
    switch (node->kind) {
    case AST_INCLUDE:
        print_include(printer, node);
        break;
    case AST_FOPEN:
        put(printer, "#fopen ");
        put_symbol(printer, node->a->symbol);
        put(printer, " ");
        print_operand(printer, node->b, PRECEDENCE_SUM);
        put(printer, " ");
        put_symbol(printer, node->symbol);
        break;
    case AST_FCLOSE:
        put(printer, "#fclose ");
        put_symbol(printer, node->a->symbol);
        break;
    default:
        print_header(printer, ast_kind_name((AstKind)node->kind), node->a, node->b, indent);
        break;
    }
}

static void print_directive(Printer *printer, const AstNode *node, int indent)
{
    switch (node->kind) {
    case AST_DECLARE:
        text_printf(printer->out, "%s ", ast_op_spelling((AstOp)node->op));
        print_operand(printer, node->a, PRECEDENCE_SUM);
        put(printer, " = ");
        print_value(printer, node->b, indent);
        put(printer, ";");
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
        put(printer, "#macro ");
        put_symbol(printer, node->symbol);
        print_header(printer, "", node->a, NULL, indent);
        print_body(printer, node->b, indent);
        break;
    case AST_DEFAULT:
        put(printer, "#default {");
        print_block(printer, node->a, indent, "}");
        break;
    case AST_VERSION:
    case AST_UNDEF:
        text_printf(printer->out, "%s ", ast_kind_name((AstKind)node->kind));
        print_operand(printer, node->a, PRECEDENCE_SUM);
        put(printer, node->kind == AST_VERSION ? ";" : "");
        break;
    case AST_MESSAGE:
        text_printf(printer->out, "%s ", ast_op_spelling((AstOp)node->op));
        print_open_end(printer, node);
        break;
    case AST_BREAK:
        put(printer, "#break");
        break;
    default:
        print_file_directive(printer, node, indent);
        break;
    }
}

typedef struct Neighbours {
    const AstNode *previous;
    const AstNode *run_end; // expressions before it share run_closed
    bool run_closed;
} Neighbours;

static bool needs_parentheses(const AstNode *node, Neighbours *neighbours)
{
    const AstNode *previous = neighbours->previous;
    if (!ends_with_name(node)) {
        neighbours->run_end = NULL;
    } else if (neighbours->run_end == NULL || neighbours->run_end == node) {
        neighbours->run_closed = run_is_closed(node, &neighbours->run_end);
    }
    bool continued = previous != NULL && follows_bare(node) && (is_expression(previous) || is_open_ended(previous));
    return (continued && begins_with_sign(node)) || (ends_with_name(node) && neighbours->run_closed);
}

static bool is_operand_of_line(const AstNode *node)
{
    return is_expression(node) || node->kind == AST_WORD;
}

static void print_item(Printer *printer, const AstNode *node, Neighbours *neighbours, int indent)
{
    if (is_expression(node)) {
        bool closed = needs_parentheses(node, neighbours);
        put(printer, closed ? "(" : "");
        print_operand(printer, node, closed ? PRECEDENCE_CHOICE : PRECEDENCE_SUM);
        put(printer, closed ? ")" : "");
    } else if (node->kind >= AST_DECLARE) {
        print_directive(printer, node, indent);
    } else {
        print_value(printer, node, indent);
    }
    put(printer, node->flags & AST_BEFORE_COMMA ? "," : "");
    put(printer, node->flags & AST_ENDED && node->kind != AST_DECLARE ? ";" : "");
}

// One item a line; a word and the expressions after it share one.
static void print_items(Printer *printer, const AstNode *items, int indent)
{
    Neighbours neighbours = {0};
    printer->indent = indent;
    for (const AstNode *node = items; node != NULL; node = node->next) {
        const AstNode *previous = neighbours.previous;
        bool same_line = previous != NULL && is_expression(node) && is_operand_of_line(previous);
        bool comma = node->flags & AST_AFTER_COMMA;
        if (same_line) {
            put(printer, comma ? ", " : " ");
        } else {
            put(printer, previous != NULL ? (comma ? ",\n" : "\n") : "");
            put_indent(printer, indent);
            put(printer, previous == NULL && comma ? ", " : "");
        }
        print_item(printer, node, &neighbours, indent);
        neighbours.previous = node;
    }
    put(printer, items != NULL ? "\n" : "");
    printer->indent = indent - 1;
}

void ast_print(const AstNode *item, const InternTable *names, int indent, TextBuffer *out)
{
    AstNode alone = *item;
    alone.next = NULL;
    print_items(&(Printer){.names = names, .out = out}, &alone, indent);
}
