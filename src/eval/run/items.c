// Items of the top level: directives are run, macros expanded, and objects given to those who place them.
//
// Knows nothing of single directives or kinds of blocks.
//
// SPDX-License-Identifier: MIT
#include "eval/run/run.h"

bool eval_knows_37(const Eval *ev)
{
    return ev->version_given && (ev->version > 3.7 || numbers_equal(ev->version, 3.7));
}

static void fault_not_an_object(Eval *ev, const AstNode *item)
{
    Value value;
    bool begins = item->kind == AST_WORD && ev->builder->takes_braces(ev, item->symbol);
    bool is_whole = begins && ev->builder->is_statement(ev, item);
    bool belongs_to_last = (ev->lacks_brace && !is_whole) || (ev->has_stray && item->kind <= AST_MEMBER);
    ev->has_stray = belongs_to_last || item->kind == AST_WORD;
    if (belongs_to_last) {
        return; // reported with what stands before it
    }
    if (begins) {
        ev->lacks_brace = true;
        eval_fault(ev, DIAG_E0257, item->span, "`{` is missing after `%s`", eval_text(ev, item->symbol));
    } else if (item->kind == AST_WORD) {
        eval_fault(ev, DIAG_E0222, item->span, "expected an object or a directive, found `%s`",
                   eval_text(ev, item->symbol));
    } else if (item->kind > AST_MEMBER) {
        eval_fault(ev, DIAG_E0222, item->span, "expected an object or a directive, found %s",
                   ast_kind_name((AstKind)item->kind));
    } else if (eval_expression(ev, item, &value)) {
        eval_fault(ev, DIAG_E0222, item->span, "expected an object or a directive, found %s", value_describe(&value));
    }
}

static void place(Eval *ev, const AstNode *item)
{
    bool is_placeable = item->kind == AST_BLOCK || item->kind == AST_NAME || item->kind == AST_INDEX;
    ArenaMark mark = scratch_mark(ev);
    bool is_property = ev->lacks_brace && (!is_placeable || !ev->builder->is_statement(ev, item));
    if (!is_placeable || is_property) {
        fault_not_an_object(ev, item);
    } else {
        ev->lacks_brace = false;
        bool fine = ev->builder->place(ev, item);
        ev->has_stray = !fine && item->kind != AST_BLOCK;
        ev->faulty = !fine || ev->faulty;
    }
    scratch_rewind(ev, mark);
}

void eval_item(Eval *ev, const AstNode *item)
{
    // What is no statement has a fault of its own.
    bool is_statement = item->kind == AST_BLOCK || item->kind >= AST_DECLARE || item->kind == AST_CALL;
    if (RT_UNLIKELY(item->flags & AST_AFTER_COMMA) && is_statement && !ev->lacks_brace) {
        eval_fault(ev, DIAG_E0259, item->span, "no comma is expected between statements");
    }
    if (item->kind == AST_BLOCK) {
        place(ev, item);
        return;
    }
    if (item->kind == AST_CALL) {
        ev->builder->plan_watch_call(ev, item);
    }
    Cursor cursor;
    const AstNode *found;
    cursor_open(&cursor, ev, item, item->span);
    cursor.top = true;
    cursor.since = 0;
    while ((found = cursor_peek(&cursor)) != NULL) {
        bool is_told = (item->flags & AST_AFTER_COMMA) || ev->lacks_brace || found->kind != AST_BLOCK;
        ev->faulty = (!is_told && !cursor_lacks_comma(&cursor, "the scene")) || ev->faulty;
        place(ev, found);
        cursor_skip(&cursor);
        ev->builder->plan_turns(&cursor);
    }
    ev->faulty = (!ev->lacks_brace && !cursor_lacks_comma(&cursor, "the scene")) || ev->faulty;
    cursor_close(&cursor);
}
