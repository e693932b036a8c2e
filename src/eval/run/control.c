// Control: branches, loops, #switch and #break, of nodes and of texts.
//
// What decides, counts and searches is written once; a directive that is a node has its parts, one of a text reads each
// when it comes to it, since what stands before may change what it means. Knows nothing of blocks and of what
// expressions mean.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "eval/run/scope.h"
#include "eval/run/expansion.h"

enum { FAULTY_STEPS = 100000 }; // that say nothing new, before loops of a faulty scene end

// ---- what directives decide

static bool case_holds(Eval *ev, const AstNode *node, double value, bool *holds)
{
    double low, high;
    *holds = node->kind == AST_ELSE;
    if (node->kind == AST_CASE && node->a != NULL) { // else its head was not readable
        bool fine = eval_number(ev, node->a, &low);
        *holds = fine && number_is_case(value, low);
        return fine;
    }
    if (node->kind == AST_RANGE) {
        bool fine = eval_number(ev, node->a, &low) && eval_number(ev, node->b, &high);
        *holds = fine && low <= value && value <= high;
        return fine;
    }
    return true;
}

static bool head_decide(Eval *ev, const AstNode *node, double *subject, bool *holds)
{
    switch ((AstKind)node->kind) {
    case AST_IFDEF: *holds = name_is_declared(ev, node->a) == (node->op == AST_OP_IFDEF); return true;
    case AST_SWITCH: return eval_number(ev, node->a, subject);
    case AST_CASE:
    case AST_RANGE:
    case AST_ELSE: return case_holds(ev, node, *subject, holds);
    default: return eval_condition(ev, node->a, holds);
    }
}

// ---- heads of directives in a text

// Computes a head that was just parsed; false after a fault.
static bool decide(Expansion *expansion, AstKind kind, const Token *directive, AstNode *a, AstNode *b, double *subject,
                   bool *holds)
{
    Eval *ev = expansion_eval(expansion);
    *holds = false;
    if (a == NULL) {
        return false;
    }
    Symbol word = grammar_directive_word(directive->kind);
    AstNode node = {.kind = (uint8_t)kind, .span = span_join(directive->span, expansion->feed.end), .a = a, .b = b};
    node.op = word == W_ifndef ? AST_OP_IFNDEF : word == W_ifdef ? AST_OP_IFDEF : AST_OP_NONE;
    ArenaMark mark = arena_mark(&ev->scratch);
    bool fine = head_decide(ev, &node, subject, holds);
    arena_rewind(&ev->scratch, mark);
    ev->faulty = ev->faulty || !fine;
    if (!fine || ev->stop) {
        expansion_fail(expansion);
    }
    *holds = *holds && !expansion->feed.failed;
    return !expansion->feed.failed;
}

// The head of an #if, #while, #case or the like stands next.
static bool read_head(Expansion *expansion, const Token *directive, double *subject, bool *holds)
{
    Eval *ev = expansion_eval(expansion);
    ArenaMark mark = arena_mark(&ev->parse);
    AstKind kind = AST_IF;
    FragmentKind fragment = FRAGMENT_CONDITION;
    switch (grammar_directive_word(directive->kind)) {
    case W_ifdef:
    case W_ifndef: kind = AST_IFDEF; fragment = FRAGMENT_SUBJECT; break;
    case W_switch: kind = AST_SWITCH; break;
    case W_case: kind = AST_CASE; break;
    case W_range: kind = AST_RANGE; fragment = FRAGMENT_RANGE; break;
    default: break;
    }
    AstNode *head = expansion_parse(expansion, fragment, 1, false);
    bool is_range = head != NULL && kind == AST_RANGE;
    AstNode *first = is_range ? head->a : head, *second = is_range ? head->b : NULL;
    bool fine = decide(expansion, kind, directive, first, second, subject, holds);
    arena_rewind(&ev->parse, mark);
    return fine;
}

// ---- branches

// The parts of an #if or #switch, looked at one after the other.
typedef struct Choice {
    Cursor *cursor;
    double subject;      // of a #switch
    const AstNode *part; // of nodes: an #if, or a case; NULL: what an #if has else, or no further case
    bool is_switch, has_cases;
    const Token *opener; // of a text: the directive
    Token *at;           // and the head of the part
} Choice;

// A part of a text that belongs to another directive.
static bool is_stray(const Choice *choice)
{
    Symbol word = grammar_directive_word(choice->at->kind);
    if (choice->is_switch) {
        return word == W_elseif || (word == W_else && !choice->has_cases);
    }
    return grammar_role(choice->at->kind) == ROLE_MIDDLE && word != W_elseif;
}

// `expansion`: that of the cursor; NULL, which callers of nodes know: it walks nodes.
RT_ALWAYS_INLINE bool part_holds(Choice *choice, Expansion *expansion, bool *holds)
{
    if (expansion == NULL) {
        *holds = choice->part == NULL;
        return choice->part == NULL || head_decide(choice->cursor->ev, choice->part, &choice->subject, holds);
    }
    if (is_stray(choice)) {
        expansion_fault_stray(expansion, choice->at);
        return false;
    }
    choice->has_cases = true;
    *holds = grammar_role(choice->at->kind) == ROLE_ELSE;
    return *holds || read_head(expansion, choice->at, &choice->subject, holds);
}

// False: there is none, or after a fault.
RT_ALWAYS_INLINE bool next_part(Choice *choice, Expansion *expansion)
{
    if (expansion == NULL) {
        choice->part = choice->is_switch ? choice->part->next : NULL;
        return choice->part != NULL || !choice->is_switch;
    }
    return expansion_skip(expansion, choice->opener, 1, true, NULL, choice->at) &&
           grammar_role(choice->at->kind) != ROLE_END;
}

// The first part that holds, from the present one on. False after a fault.
RT_ALWAYS_INLINE bool find_part(Choice *choice, Expansion *expansion, bool *is_found)
{
    *is_found = false;
    bool fine = true, has_more = true;
    while (fine && has_more && !*is_found) {
        fine = part_holds(choice, expansion, is_found);
        has_more = fine && !*is_found && next_part(choice, expansion);
    }
    return fine;
}

static void push_branch(Cursor *cursor, const AstNode *items)
{
    if (items != NULL) {
        cursor_push(cursor, FRAME_ITEMS, items, NULL);
    }
}

const AstNode *case_items(const AstNode *node)
{
    return node->kind == AST_CASE ? node->b : node->kind == AST_RANGE ? node->c : node->a;
}

bool case_continues(Eval *ev, CursorFrame *frame)
{
    frame->node = frame->node->next;
    // The head of a case that is run into is computed, too, as in POV-Ray.
    bool is_next = frame->node != NULL && head_decide(ev, frame->node, &(double){0}, &(bool){false});
    frame->next = is_next ? case_items(frame->node) : NULL;
    return is_next;
}

void control_if(Cursor *cursor, const AstNode *node)
{
    Choice choice = {.cursor = cursor, .part = node};
    bool is_found;
    if (node->a != NULL && find_part(&choice, NULL, &is_found)) { // else its condition was not readable
        push_branch(cursor, choice.part != NULL ? node->b : node->c);
    }
}

void control_switch(Cursor *cursor, const AstNode *node)
{
    Choice choice = {.cursor = cursor, .part = node->b, .is_switch = true};
    bool is_found = false;
    if (!head_decide(cursor->ev, node, &choice.subject, &is_found) ||
        (choice.part != NULL && !find_part(&choice, NULL, &is_found))) {
        return;
    }
    if (is_found && cursor_push(cursor, FRAME_SWITCH, case_items(choice.part), choice.part) == NULL) {
        return;
    }
    push_branch(cursor, node->c); // what stands before the first case
}

// The first branch that holds, of an #if in a text.
void control_begin_if(Expansion *expansion, const Token *directive)
{
    Token at = *directive;
    Choice choice = {.cursor = expansion->cursor, .opener = directive, .at = &at};
    bool is_found;
    bool fine = find_part(&choice, expansion, &is_found);
    CursorFrame *frame = fine && is_found ? expansion_push(expansion, FRAME_BRANCH, directive) : NULL;
    if (frame != NULL) {
        frame->text.is_last = grammar_role(at.kind) == ROLE_ELSE;
    }
}

void control_begin_switch(Expansion *expansion, const Token *directive)
{
    double subject = 0;
    bool holds;
    CursorFrame *frame = read_head(expansion, directive, &subject, &holds)
                             ? expansion_push(expansion, FRAME_SWITCH, directive)
                             : NULL;
    if (frame != NULL) {
        frame->text.subject = subject;
    }
}

// A case, or the #else, of a #switch in a text. The head of one that is run into is computed.
static void next_case(Expansion *expansion, CursorFrame *frame, const Token *directive)
{
    FrameText *text = &frame->text;
    Token at = *directive;
    Choice choice = {.cursor = expansion->cursor, .subject = text->subject, .is_switch = true,
                     .has_cases = text->has_cases, .opener = &text->opened_by, .at = &at};
    bool is_found = text->is_found;
    bool fine = is_found ? part_holds(&choice, expansion, &(bool){false}) : find_part(&choice, expansion, &is_found);
    text->has_cases = true;
    text->is_found = is_found;
    if (fine && !is_found && !expansion->feed.failed) {
        expansion_drop(expansion, frame);
    }
}

// A `#else`, `#case` or the like: what was chosen ends before it.
void control_between(Expansion *expansion, const Token *directive)
{
    CursorFrame *frame = expansion_owner_of_middle(expansion);
    Token last;
    Symbol word = grammar_directive_word(directive->kind);
    if (frame != NULL && frame->kind == FRAME_SWITCH && word != W_elseif) {
        next_case(expansion, frame, directive);
    } else if (frame != NULL && frame->kind == FRAME_BRANCH && (word == W_else || word == W_elseif) &&
               !frame->text.is_last) {
        Token opener = frame->text.opened_by;
        if (expansion_skip(expansion, &opener, 1, false, NULL, &last)) {
            expansion_drop(expansion, frame);
        }
    } else {
        expansion_fault_stray(expansion, directive);
    }
}

// ---- loops

// As measured, with the language's tolerance at the end.
static bool for_holds(double number, double end, double step)
{
    return step > 0.0 ? number < end + 1e-10 : number > end - 1e-10;
}

static bool for_begins(Eval *ev, const AstNode *node, ForLoop *loop, bool *holds)
{
    double from = 0, end = 0, step = 1;
    const AstNode *third = node->b->next->next;
    ev->inner++;
    bool fine = eval_number(ev, node->b, &from);
    fine = eval_number(ev, node->b->next, &end) && fine;
    fine = (third == NULL || eval_number(ev, third, &step)) && fine;
    ev->inner--;
    if (!fine) {
        return false;
    }
    if (step == 0.0) {
        return eval_fault(ev, DIAG_E0305, third->span, "the step of a loop must not be zero");
    }
    if (third != NULL && third->next != NULL) {
        return eval_fault(ev, DIAG_E0203, third->next->span, "`#for` takes a name and at most three numbers");
    }
    Symbol name = node->a->symbol;
    Value value = value_of_number(from);
    if (scope_is_reference(ev, name)) {
        return eval_fault(ev, DIAG_E0220, node->a->span,
                          "`%s` stands for the caller's variable and cannot count a loop", eval_text(ev, name));
    }
    *loop = (ForLoop){.counter = name, .span = node->a->span, .end = end, .step = step};
    *holds = for_holds(from, end, step);
    return scope_declare(ev, name, true, &value, node->a->span);
}

static bool for_continues(Eval *ev, const ForLoop *loop, bool *holds)
{
    Value *counter = scope_find(ev, loop->counter);
    *holds = false;
    if (counter == NULL || counter->kind != VALUE_NUMBER) {
        return (counter == NULL || counter->kind != VALUE_NONE) &&
               eval_fault(ev, DIAG_E0220, loop->span, "the loop has lost its counter: `%s` is %s now",
                          eval_text(ev, loop->counter), counter != NULL ? value_describe(counter) : "not declared");
    }
    counter->number += loop->step;
    *holds = for_holds(counter->number, loop->end, loop->step);
    return true;
}

// The condition of a loop stands at the beginning of its text.
RT_SELDOM bool read_condition(Expansion *expansion, CursorFrame *frame, bool *holds)
{
    Token opener = frame->text.opened_by;
    return read_head(expansion, &opener, NULL, holds);
}

static __attribute__((noinline)) bool while_continues(Cursor *cursor, CursorFrame *frame, bool *holds)
{
    Eval *ev = cursor->ev;
    double number;
    *holds = false;
    if (ev->options.diags->error_count > 0 && ev->steps - ev->steps_reported > FAULTY_STEPS) {
        return true; // what would have ended the loop may be what is not understood
    }
    if (frame->is_text) {
        return read_condition(cursor->expansion, frame, holds);
    }
    if (quick_number(ev, frame->node->a, &number)) {
        *holds = number_is_true(number);
        return true;
    }
    ArenaMark mark = scratch_mark(ev);
    bool fine = eval_condition(ev, frame->node->a, holds);
    scratch_rewind(ev, mark);
    return fine;
}

// Whether a loop has another turn; false after a fault.
RT_ALWAYS_INLINE bool has_turn(Cursor *cursor, CursorFrame *frame, bool *holds)
{
    return frame->kind == FRAME_FOR ? for_continues(cursor->ev, &frame->loop, holds)
                                    : while_continues(cursor, frame, holds);
}

bool loop_continues(Cursor *cursor, CursorFrame *frame)
{
    bool holds;
    return has_turn(cursor, frame, &holds) && holds && eval_turn(cursor->ev, frame->node->span, frame->node->span);
}

void control_while(Cursor *cursor, const AstNode *node)
{
    bool holds;
    if (eval_condition(cursor->ev, node->a, &holds) && holds && eval_turn(cursor->ev, node->span, node->span)) {
        cursor_push(cursor, FRAME_WHILE, node->b, node);
    }
}

void control_for(Cursor *cursor, const AstNode *node)
{
    ForLoop loop;
    bool holds = false;
    if (node->a == NULL || !for_begins(cursor->ev, node, &loop, &holds) || !holds ||
        !eval_turn(cursor->ev, node->span, node->span)) {
        return; // at the first, its head was not readable
    }
    CursorFrame *frame = cursor_push(cursor, FRAME_FOR, node->c, node);
    if (frame != NULL) {
        frame->loop = loop;
    }
}

// Its tokens, which are parsed once more.
static bool take_turn(Eval *ev, const CursorFrame *frame)
{
    enum { WORK_OF_A_TOKEN = 64 };
    Span span = frame->text.opened_by.span;
    return eval_step(ev, span) && eval_work(ev, WORK_OF_A_TOKEN * frame->text.count, span);
}

// The `#end` of a loop in a text, or its beginning.
static void next_turn(Expansion *expansion, CursorFrame *frame)
{
    Eval *ev = expansion_eval(expansion);
    bool holds;
    frame->text.at = 0;
    bool fine = has_turn(expansion->cursor, frame, &holds) && (!holds || take_turn(ev, frame)) && !ev->stop;
    if (!fine) {
        ev->faulty = true;
        expansion_fail(expansion);
    } else if (!holds) {
        expansion_drop_from(expansion, frame);
    }
}

// Keeps a loop's text up to its `#end` and pushes it.
static CursorFrame *push_loop(Expansion *expansion, FrameKind kind, const Token *opener)
{
    Tokens kept = {0};
    Token last;
    CursorFrame *frame = NULL;
    if (expansion_skip(expansion, opener, 1, false, &kept, &last) &&
        (frame = expansion_push(expansion, kind, opener)) != NULL) {
        GrammarText *text = grammar_text_new(kept.items, kept.count);
        if (text != NULL) {
            frame_set_text(frame, text, text);
        } else {
            grammar_feed_fault(&expansion->feed, DIAG_E0602, opener->span, "out of memory while reading the scene");
        }
    }
    ARRAY_FREE(&kept);
    return expansion->feed.failed ? NULL : frame;
}

void control_begin_while(Expansion *expansion, const Token *directive)
{
    CursorFrame *frame = push_loop(expansion, FRAME_WHILE, directive);
    if (frame != NULL) {
        next_turn(expansion, frame);
    }
}

void control_begin_for(Expansion *expansion, const Token *directive)
{
    Eval *ev = expansion_eval(expansion);
    ArenaMark mark = arena_mark(&ev->parse);
    AstNode *head = expansion_parse(expansion, FRAGMENT_FOR, GRAMMAR_NO_BASE, false);
    ForLoop loop = {0};
    bool holds = false;
    bool fine = head != NULL && for_begins(ev, head, &loop, &holds);
    ev->faulty = ev->faulty || (head != NULL && !fine);
    if (!fine || ev->stop) {
        expansion_fail(expansion);
        return;
    }
    arena_rewind(&ev->parse, mark);
    Token last;
    if (!holds) {
        (void)expansion_skip(expansion, directive, 1, false, NULL, &last);
        return;
    }
    CursorFrame *frame = push_loop(expansion, FRAME_FOR, directive);
    if (frame != NULL) {
        frame->loop = loop;
        if (!take_turn(ev, frame)) {
            expansion_fail(expansion);
        }
    }
}

void control_end(Expansion *expansion, const Token *directive)
{
    CursorFrame *frame = expansion_owner_of_middle(expansion);
    if (frame == NULL || (frame->kind == FRAME_SWITCH && !frame->text.has_cases)) {
        expansion_fault_stray(expansion, directive);
    } else if (frame->kind == FRAME_WHILE || frame->kind == FRAME_FOR) {
        next_turn(expansion, frame);
    } else {
        expansion_drop(expansion, frame);
    }
}

// ---- #break

// The innermost directive that is a #switch at a place or stands in it.
static CursorFrame *directive_since(const Expansion *expansion, unsigned place)
{
    CursorFrame *frame = expansion->cursor->frame;
    while (frame->text.place > place && frame->kind != FRAME_BRANCH && frame->kind != FRAME_SWITCH) {
        frame = frame->outer;
    }
    return frame->text.place >= place && !frame_has_text(frame) ? frame : NULL;
}

// Out of a #switch in a text, with `branches` open inside it.
static void leave_switch(Expansion *expansion, CursorFrame *frame, unsigned branches)
{
    Token opener = frame->text.opened_by, last;
    unsigned place = frame->text.place;
    if (expansion_skip(expansion, &opener, branches + 1, false, NULL, &last)) {
        while ((frame = directive_since(expansion, place)) != NULL) {
            expansion_drop(expansion, frame);
        }
    }
}

static void pop_from(Cursor *cursor, const CursorFrame *frame)
{
    const CursorFrame *rest = frame->outer;
    while (cursor->frame != rest) {
        cursor_pop(cursor);
    }
}

static void leave_frame(Cursor *cursor, CursorFrame *frame, unsigned branches)
{
    if (cursor->expansion == NULL) {
        pop_from(cursor, frame);
    } else if (frame->kind == FRAME_SWITCH) {
        leave_switch(cursor->expansion, frame, branches);
    } else {
        expansion_drop_from(cursor->expansion, frame);
    }
}

static void fault_break(Cursor *cursor, Span span, const char *text)
{
    if (cursor->expansion != NULL) {
        grammar_feed_fault(&cursor->expansion->feed, DIAG_E0209, span, text);
    } else {
        eval_fault(cursor->ev, DIAG_E0209, span, "%s", text);
    }
}

void control_break(Cursor *cursor, Span span, bool is_from_file)
{
    Eval *ev = cursor->ev;
    Expansion *expansion = cursor->expansion;
    unsigned branches = 0;
    CursorFrame *frame = cursor->frame, *last = NULL;
    const CursorFrame *end = expansion != NULL ? expansion->bottom->outer : NULL;
    for (; frame != end; last = frame, frame = frame->outer) {
        if (expansion != NULL && frame->text.place <= expansion->head_place) {
            fault_break(cursor, span, "`#break` cannot leave the head of a directive");
            return;
        }
        bool is_left = frame->kind == FRAME_WHILE || frame->kind == FRAME_FOR || frame->kind == FRAME_SWITCH;
        if (is_left || (frame->kind == FRAME_MACRO && !is_from_file)) {
            leave_frame(cursor, frame, branches);
            return;
        }
        if (frame->kind == FRAME_MACRO) {
            break; // as in POV-Ray
        }
        branches += frame->kind == FRAME_BRANCH;
        is_from_file |= frame->kind == FRAME_INCLUDE;
    }
    bool is_of_file = cursor->top && ev->include_depth > 0 && (expansion == NULL || expansion->feed.live != NULL);
    if (frame == NULL && last != NULL && cursor->is_call && !is_from_file) {
        leave_frame(cursor, last, 0);
    } else if (frame == NULL && is_of_file) {
        ev->break_at = span; // what it leaves may stand around the #include
        if (expansion != NULL) {
            expansion_fail(expansion);
        } else if (last != NULL) {
            pop_from(cursor, last);
        }
    } else {
        fault_break(cursor, span, "no loop, `#switch` or macro that `#break` could leave");
    }
}
