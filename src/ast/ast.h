// The abstract syntax tree: what was written, before anything is looked up or computed.
//
// Turns parser actions into nodes (ast_* builders) and nodes into text again (ast_print). Nodes live in the arena that
// the builder was given and are never changed after the statement they belong to is complete. Knows nothing of kinds of
// objects, of values or of scopes; a block is just `word { items }`.
//
// SPDX-License-Identifier: MIT
#ifndef AST_AST_H
#define AST_AST_H

#include <stdbool.h>
#include <stdint.h>

#include "ast/pack.h"
#include "base/arena.h"
#include "base/diag.h"
#include "base/intern.h"
#include "base/limits.h"
#include "base/source.h"
#include "base/text.h"

typedef enum AstKind {
#define AST(kind, name, a, b, c) AST_##kind,
#include "ast/ast_kinds.def"
#undef AST
    AST_KIND_COUNT
} AstKind;

typedef enum AstOp {
#define AST_OP(op, spelling, precedence) AST_OP_##op,
#include "ast/ast_ops.def"
#undef AST_OP
    AST_OP_COUNT
} AstOp;

enum {
    AST_AFTER_COMMA = 1,  // an item with a comma before it
    AST_BEFORE_COMMA = 2, // the last item of a body, argument of a call or component, with a comma after it
    AST_ENDED = 4,        // a #declare with its `;`; ast_equal does not look at it
    AST_UNREADABLE = 16,  // a #declare whose value was not understood and has been reported; 0 stands for it
    AST_IN_PARENTHESES =
        8, // an expression with its own parentheses: a macro's argument, value or call may depend on them
    AST_WITHOUT_COMMA = 16, // an argument that follows another with a blank only; ast_equal does not look at it
    AST_KNOWN = 32,         // an expression that was computed while it was read: its value is in `known`
    AST_BEFORE_NAME = 128,  // a #declare or #version without `;` right before the declared name, or before a macro's
    AST_ENDED_TWICE = 256,  // a #declare with `;;`
    AST_BEFORE_SEMICOLON = 512, // the last item of a body, with a `;` after it that is not its own
    AST_PASTES = 64, // an expression with a macro call for an operand or an element, whose text may fall apart there
};

typedef struct AstNode AstNode;
struct AstNode {
    uint8_t kind;   // AstKind
    uint8_t op;     // AstOp
    uint16_t flags; // AST_AFTER_COMMA, …
    Symbol symbol;
    uint32_t depth; // height of the tree below and including this node
    uint32_t count; // number of elements in list a
    Span span;
    union {
        double number; // NUMBER only
        const AstPack *pack; // PACKED only
        AstNode *a;
    };
    AstNode *b;
    union {
        AstNode *c;
        const void *known; // with AST_KNOWN: the evaluator's value; NULL: a name that was not declared
    };
    AstNode *next; // the following element when this node is in a list
};

// A list under construction. An empty one is {0}.
typedef struct AstList {
    AstNode *first, *last;
    uint32_t count;
    uint32_t depth; // of the deepest element
} AstList;

// What the builders need. They never return NULL: when memory or depth runs out they record one diagnostic, set
// `failed` and return the builder's dummy node, so that grammar actions need no checks; the parser stops as soon as it
// sees `failed`.
typedef struct AstBuilder {
    Arena *arena;
    DiagSink *diags;
    unsigned depth_limit;
    bool failed;
    AstNode dummy; // zeros to begin with
} AstBuilder;

// What a node is, without its children.
typedef struct AstHead {
    AstKind kind;
    AstOp op;
    Symbol symbol;
    Span span;
} AstHead;

// A node of any kind with up to three children (each NULL or complete).
AstNode *ast_node(AstBuilder *builder, AstHead head, AstNode *a, AstNode *b, AstNode *c);
// The same with a list as child a, and b or c as further lists by their first elements; depths are taken from all.
AstNode *ast_node_list(AstBuilder *builder, AstHead head, AstList a, AstList b, AstList c);
AstNode *ast_number(AstBuilder *builder, double number, Span span);
// Of so many items, see ast/pack.h, which are copied.
AstNode *ast_packed(AstBuilder *builder, const uint8_t *widths, uint32_t count, const double *numbers,
                    uint32_t number_count, Span span);

// Appends to a list and returns it.
AstList ast_append(AstList list, AstNode *node);
// The same for an item with a comma before it.
AstList ast_append_after_comma(AstList list, AstNode *node);
// Set flags of the first or the last element (of none in an empty list).
AstList ast_flag_first(AstList list, unsigned flags);
AstList ast_flag_last(AstList list, unsigned flags);
// Sets flags of a node and returns it.
AstNode *ast_flag(AstNode *node, unsigned flags);

// A copy of a tree and of everything in it, in another arena. NULL when out of memory.
AstNode *ast_clone(const AstNode *node, Arena *arena) RT_MUST_CHECK;

// True when both trees say the same; spans do not count.
bool ast_equal(const AstNode *one, const AstNode *other);

// Appends one item as canonical `.scn` text that parses to an equal tree, indented by `indent` steps of two blanks and
// ended by a newline.
void ast_print(const AstNode *item, const InternTable *names, int indent, TextBuffer *out);

const char *ast_kind_name(AstKind kind);
const char *ast_op_spelling(AstOp op);

#endif
