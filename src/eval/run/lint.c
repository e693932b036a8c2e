// What is suspicious in a scene's text and not wrong: names that nothing uses, branches and items that are never
// reached.
//
// Walks the AST of each top-level item before it is evaluated, and looks at nothing but the text: a name is used when
// it stands anywhere but where it is declared, so that none is reported that a branch or a macro may need. Declarations
// and branches of the scene's own file count only, uses in all files. Owns what it remembers of names.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "eval/run/run.h"

enum { NAME_USED = 1, NAME_DECLARED = 2 };

typedef struct Declared {
    Symbol name;
    DiagCode code;
    Span span;
} Declared;

struct Lint {
    ARRAY(uint8_t) marks; // by symbol
    ARRAY(Declared) declared;
    bool failed; // out of memory, or not all text was seen: nothing is reported of names
};

bool lint_init(Eval *ev)
{
    static const DiagCode codes[] = {DIAG_W0205, DIAG_W0206, DIAG_W0207, DIAG_W0208, DIAG_W0209};
    bool is_wanted = false;
    for (size_t i = 0; i < RT_COUNT_OF(codes); i++) {
        is_wanted = is_wanted || diag_is_on(ev->options.diags, codes[i]);
    }
    ev->lint = is_wanted ? calloc(1, sizeof *ev->lint) : NULL;
    return ev->lint != NULL || !is_wanted;
}

void lint_fini(Eval *ev)
{
    if (ev->lint != NULL) {
        ARRAY_FREE(&ev->lint->marks);
        ARRAY_FREE(&ev->lint->declared);
        free(ev->lint);
    }
    ev->lint = NULL;
}

static bool tells(const Eval *ev)
{
    return ev->include_depth == 0 && ev->options.diags->error_count == 0;
}

// The mark of a name; NULL when there is no memory for it.
static uint8_t *mark_of(Eval *ev, Symbol name)
{
    Lint *lint = ev->lint;
    if (name >= lint->marks.count) {
        size_t count = intern_count(ev->options.names);
        if (!ARRAY_RESERVE(&lint->marks, count)) {
            lint->failed = true;
            return NULL;
        }
        memset(lint->marks.items + lint->marks.count, 0, count - lint->marks.count);
        lint->marks.count = count;
    }
    return &lint->marks.items[name];
}

static void use(Eval *ev, Symbol name)
{
    uint8_t *mark = mark_of(ev, name);
    if (mark != NULL) {
        *mark |= NAME_USED;
    }
}

// The first declaration of a name is the one that is reported.
static void declare(Eval *ev, Symbol name, DiagCode code, Span span)
{
    uint8_t *mark = mark_of(ev, name);
    if (mark == NULL || (*mark & NAME_DECLARED) || ev->include_depth > 0) {
        return;
    }
    *mark |= NAME_DECLARED;
    ev->lint->failed = !ARRAY_PUSH(&ev->lint->declared, ((Declared){name, code, span})) || ev->lint->failed;
}

// ---- conditions that hold always or never

static bool is_constant(const AstNode *node)
{
    static const Word words[] = {W_true, W_false, W_yes, W_no, W_on, W_off, W_pi};
    bool is_found = node->kind == AST_NUMBER;
    for (size_t i = 0; node->kind == AST_CONSTANT && i < RT_COUNT_OF(words); i++) {
        is_found = is_found || node->symbol == (Symbol)words[i];
    }
    return is_found || (node->kind == AST_UNARY && is_constant(node->a)) ||
           (node->kind == AST_BINARY && node->op != AST_OP_DIV && is_constant(node->a) && is_constant(node->b));
}

static const char *dead_part(const AstNode *node, bool holds)
{
    if (node->kind == AST_CONDITIONAL) {
        return holds ? "what follows `:` is never used" : "what follows `?` is never used";
    }
    if (node->kind == AST_WHILE) {
        return holds ? NULL : "the loop is never run";
    }
    return holds ? node->c != NULL ? "the `#else` is never run" : NULL
                 : node->b != NULL ? "the branch is never run" : NULL;
}

static void check_condition(Eval *ev, const AstNode *node)
{
    bool holds;
    bool has_condition = node->kind == AST_IF || node->kind == AST_WHILE || node->kind == AST_CONDITIONAL;
    if (!has_condition || !tells(ev) || !is_constant(node->a) || !eval_condition(ev, node->a, &holds)) {
        return;
    }
    const char *dead = dead_part(node, holds);
    if (dead != NULL) {
        eval_warn(ev, DIAG_W0208, node->a->span, "the condition %s: %s", holds ? "always holds" : "never holds", dead);
    }
}

static void check_reached(Eval *ev, const AstNode *item)
{
    bool leaves = item->kind == AST_BREAK || (item->kind == AST_MESSAGE && item->op == AST_OP_ERROR);
    if (leaves && item->next != NULL && tells(ev) &&
        eval_report(ev, DIAG_W0209, item->next->span, "this is never reached")) {
        diag_note(ev->options.diags, item->span, item->kind == AST_BREAK ? "`#break` stands before it"
                                                                         : "`#error` stands before it");
    }
}

// ---- the walk

static void walk_list(Eval *ev, const AstNode *first);

// A name or an element that is given a value: what its indices need is used, itself is not.
static void walk_target(Eval *ev, const AstNode *target)
{
    while (target->kind == AST_INDEX) {
        walk_list(ev, target->b);
        target = target->a;
    }
}

static void walk_declare(Eval *ev, const AstNode *node)
{
    walk_list(ev, node->b);
    walk_target(ev, node->a);
    if (node->a->kind == AST_NAME) {
        declare(ev, node->a->symbol, node->op == AST_OP_LOCAL ? DIAG_W0206 : DIAG_W0205, node->a->span);
    }
}

static void walk(Eval *ev, const AstNode *node)
{
    switch (node->kind) {
    case AST_NUMBER:
    case AST_PACKED: return;
    case AST_NAME: use(ev, node->symbol); return;
    case AST_CALL: use(ev, node->symbol); break;
    case AST_DECLARE: walk_declare(ev, node); return;
    case AST_UNDEF: walk_target(ev, node->a); return;
    case AST_MACRO:
        if (node->symbol != SYMBOL_NONE) {
            declare(ev, node->symbol, DIAG_W0207, node->span);
        }
        walk_list(ev, node->b);
        return;
    case AST_FUNCTION:
        walk_list(ev, node->b);
        walk_list(ev, node->c);
        return;
    case AST_FOR:
        walk_list(ev, node->b);
        walk_list(ev, node->c);
        return;
    default: break;
    }
    if (node->flags & AST_KNOWN) {
        return; // `c` is its value
    }
    check_condition(ev, node);
    walk_list(ev, node->a);
    walk_list(ev, node->b);
    walk_list(ev, node->c);
}

static void walk_list(Eval *ev, const AstNode *first)
{
    for (const AstNode *node = first; node != NULL; node = node->next) {
        walk(ev, node);
        check_reached(ev, node);
    }
}

void lint_items(Eval *ev, const AstNode *first)
{
    if (ev->lint != NULL) {
        walk_list(ev, first);
    }
}

void lint_give_up(Eval *ev)
{
    if (ev->lint != NULL) {
        ev->lint->failed = true;
    }
}

void lint_finish(Eval *ev)
{
    const Lint *lint = ev->lint;
    if (lint == NULL || lint->failed || !tells(ev)) {
        return;
    }
    for (size_t i = 0; i < lint->declared.count; i++) {
        const Declared *declared = &lint->declared.items[i];
        if (!(lint->marks.items[declared->name] & NAME_USED)) {
            eval_warn(ev, declared->code, declared->span, "%s `%s` is never used",
                      declared->code == DIAG_W0207 ? "the macro" : "the name", eval_text(ev, declared->name));
        }
    }
}
