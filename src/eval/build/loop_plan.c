// Plans of statements that a loop or a macro comes to again and again: their expressions are evaluated, nothing else.
//
// The second time that such a statement is evaluated it is watched, see plan.h; from then on its plan is followed. A
// value that is not of the usual kind takes all back, random numbers too, and the statement is evaluated as before.
//
// SPDX-License-Identifier: MIT
#include "eval/build/plan.h"

PlanPlace *plan_place_of(Eval *ev, const AstNode *item)
{
    return &ev->plan_places[(item->span.begin ^ item->span.begin >> 7) % PLAN_PLACES];
}

bool plan_place_is_known(const Eval *ev, const PlanPlace *place, const AstNode *item)
{
    return place->is_known && place->node == item && place->begin == item->span.begin && place->state == ev->watch.state;
}

bool plan_turn(Eval *ev, PlanPlace *place, const AstNode *item, bool *is_fine)
{
    PlanStreams kept;
    PlanNumbers numbers;
    PlanMade made;
    if (ev->streams.count > PLAN_STREAMS_MOST) {
        return false;
    }
    bool is_usual = plan_fetch(ev, place->plan, &numbers, &kept);
    if (RT_LIKELY(is_usual && place->plan->is_at_place)) {
        plan_make_at_place(place->plan, &numbers, &made);
        *is_fine = sphere_place_plain(ev, made.centre, made.radius, &made.material, item->span);
        return true;
    }
    if (!is_usual || !plan_make(ev, place->plan, &numbers, item->span, &made)) {
        place->is_known = false;
        plan_streams_take_back(ev, &kept);
        return false;
    }
    *is_fine = plan_add(ev, &made, item->span);
    return true;
}

// ---- turns of loops

// Whether a loop's body is nothing but shapes and what gives names their values.
static bool is_simple(const Eval *ev, const AstNode *body)
{
    for (const AstNode *item = body; item; item = item->next) {
        bool is_shape = item->kind == AST_BLOCK && plan_is_for(block_kind(ev, item));
        if (!is_shape && item->kind != AST_READ && item->kind != AST_DECLARE) {
            return false;
        }
    }
    return true;
}

// False: nothing was done, or the evaluation stops.
static bool run_item(Cursor *cursor, const AstNode *item)
{
    Eval *ev = cursor->ev;
    if (item->kind != AST_BLOCK) {
        return directive_run(cursor, item);
    }
    PlanPlace *place = plan_place_of(ev, item);
    bool is_fine;
    if (!plan_place_is_known(ev, place, item) || !plan_turn(ev, place, item, &is_fine)) {
        return false;
    }
    ev->has_stray = false;
    ev->faulty = ev->faulty || !is_fine;
    return true;
}

void plan_turns(Cursor *cursor)
{
    Eval *ev = cursor->ev;
    CursorFrame *frame = cursor->frame;
    bool is_loop = frame && (frame->kind == FRAME_WHILE || frame->kind == FRAME_FOR) && !frame->next && !frame->is_text;
    const AstNode *body = !is_loop ? NULL : frame->kind == FRAME_WHILE ? frame->node->b : frame->node->c;
    if (!body || ev->options.no_literals || !is_simple(ev, body)) {
        return;
    }
    while (!ev->stop) {
        if (!loop_continues(cursor, frame)) {
            cursor_pop(cursor);
            return;
        }
        for (const AstNode *item = body; item; item = item->next) {
            frame->next = item->next;
            if (ev->stop || !run_item(cursor, item)) {
                frame->next = item;
                return;
            }
        }
    }
}
