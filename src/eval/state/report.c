// Faults and warnings of an evaluation: each is reported once for each place, whatever the number of turns of the loop
// around it, with the stack of calls and includes; and the counters that keep an evaluation within its limits.
//
// Owns the table of what was reported. Knows nothing of values.
//
// SPDX-License-Identifier: MIT
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "eval/state/state.h"

enum {
    BYTES_A_STEP = 256, // of a string: as many are compared or copied in the time of a loop's turn
    TEXT_A_STEP = 64,   // of statements that are run
};

enum { REPORTED_SLOTS_FIRST = 64 };

const char *eval_text(const Eval *ev, Symbol symbol)
{
    return intern_get(ev->options.names, symbol);
}

Span eval_word_span(const Eval *ev, const AstNode *node)
{
    return (Span){node->span.begin, node->span.begin + intern_length(ev->options.names, node->symbol)};
}

static uint64_t place_of(DiagCode code, Span span)
{
    uint64_t key = (span.begin * 0x9e3779b97f4a7c15u) ^ ((uint64_t)code << 48) ^ span.end;
    key ^= key >> 29;
    return key != 0 ? key : 1;
}

static void insert(Eval *ev, uint64_t key)
{
    size_t mask = ev->reported.count - 1;
    size_t slot = key & mask;
    while (ev->reported.items[slot] != 0) {
        slot = (slot + 1) & mask;
    }
    ev->reported.items[slot] = key;
}

// Twice the slots, or the first ones. Without memory the table stays, and is then used as long as it has room.
static void grow(Eval *ev)
{
    size_t old_count = ev->reported.count;
    uint64_t *old = ev->reported.items;
    size_t count = old_count > 0 ? 2 * old_count : REPORTED_SLOTS_FIRST;
    ev->reported.items = NULL;
    ev->reported.capacity = 0;
    if (!ARRAY_RESERVE(&ev->reported, count)) {
        ev->reported.items = old;
        ev->reported.capacity = old_count;
        return;
    }
    ev->reported.count = count;
    memset(ev->reported.items, 0, count * sizeof *ev->reported.items);
    for (size_t i = 0; i < old_count; i++) {
        if (old[i] != 0) {
            insert(ev, old[i]);
        }
    }
    size_t capacity = old_count;
    array_free((void **)&old, &old_count, &capacity);
}

// True the first time.
static bool is_new(Eval *ev, DiagCode code, Span span)
{
    uint64_t key = place_of(code, span);
    if (2 * (ev->reported_count + 1) > ev->reported.count) {
        grow(ev);
    }
    if (ev->reported_count + 1 >= ev->reported.count) {
        return true;
    }
    size_t mask = ev->reported.count - 1;
    for (size_t slot = key & mask; ev->reported.items[slot] != 0; slot = (slot + 1) & mask) {
        if (ev->reported.items[slot] == key) {
            return false;
        }
    }
    insert(ev, key);
    ev->reported_count++;
    ev->steps_reported = ev->steps;
    return true;
}

bool eval_is_first(Eval *ev, DiagCode code, Symbol symbol)
{
    return is_new(ev, code, (Span){symbol, UINT64_MAX}); // no place ends there
}

RT_PRINTF(4, 0) static bool report(Eval *ev, DiagCode code, Span span, const char *format, va_list arguments)
{
    char message[1024];
    if (ev->stop || !is_new(ev, code, span)) {
        return false;
    }
    vsnprintf(message, sizeof message, format, arguments);
    bool kept = diag_report(ev->options.diags, code, span, "%s", message);
    ev->stop = ev->stop || diag_is_full(ev->options.diags);
    return kept;
}

bool eval_report(Eval *ev, DiagCode code, Span span, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    bool kept = report(ev, code, span, format, arguments);
    va_end(arguments);
    return kept;
}

void eval_tell_statement(Eval *ev, Span span)
{
    if (ev->options.statement && ev->include_depth == 0) {
        ev->options.statement(ev->options.client, span);
        ev->tells_plan = false;
    }
}

bool eval_leaves_out(const Eval *ev)
{
    return ev->options.is_lenient && !ev->stop && ev->options.diags->error_count == ev->errors_before;
}

bool eval_follows_syntax(const Eval *ev, Span whole)
{
    const DiagSink *diags = ev->options.diags;
    for (size_t i = 0; i < diags->count; i++) {
        const Diag *diag = &diags->items[i];
        bool is_inside = diag->span.begin >= whole.begin && diag->span.begin < whole.end;
        if (is_inside && diag->code >= DIAG_E0101 && diag->code <= DIAG_E0109) {
            return true;
        }
    }
    return false;
}

bool eval_fault(Eval *ev, DiagCode code, Span span, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    report(ev, code, span, format, arguments);
    va_end(arguments);
    return false;
}

void eval_warn(Eval *ev, DiagCode code, Span span, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    report(ev, code, span, format, arguments);
    va_end(arguments);
}

bool eval_no_memory(Eval *ev, Span span)
{
    if (!ev->stop) {
        limits_report_memory(ev->options.diags, span, &ev->memory, "evaluating the scene");
    }
    ev->stop = true;
    return false;
}

void eval_frame_enter(Eval *ev, DiagFrame *frame, const char *what, const char *name, Span span)
{
    *frame = (DiagFrame){.outer = ev->frame, .what = what, .name = name, .span = span};
    ev->frame = frame;
    ev->options.diags->frame = frame;
}

void eval_frame_leave(Eval *ev)
{
    ev->frame = ev->frame->outer;
    ev->options.diags->frame = ev->frame;
}

bool eval_cancelled(Eval *ev)
{
    const atomic_bool *cancel = ev->options.cancel;
    ev->stop = ev->stop || (cancel != NULL && atomic_load_explicit(cancel, memory_order_relaxed));
    return ev->stop;
}

static bool take_steps(Eval *ev, uint64_t steps, Span span)
{
    if (RT_UNLIKELY(eval_cancelled(ev))) {
        return false;
    }
    if (RT_LIKELY(steps <= ev->options.limits->steps - ev->steps)) {
        ev->steps += steps;
        return true;
    }
    if (eval_report(ev, DIAG_E0605, span, "more than %llu loop turns and calls of macros and functions",
                    (unsigned long long)ev->options.limits->steps)) {
        diag_suggest(ev->options.diags, "if all of them are wanted, `--max-steps` allows more");
        ev->explains_steps = true;
    }
    ev->stop = true;
    return false;
}

bool eval_step(Eval *ev, Span span)
{
    return take_steps(ev, 1, span);
}

bool eval_turn(Eval *ev, Span text, Span span)
{
    uint64_t bytes = text.end > text.begin ? text.end - text.begin : 0;
    return take_steps(ev, 1 + bytes / TEXT_A_STEP, span);
}

bool eval_work(Eval *ev, size_t bytes, Span span)
{
    return take_steps(ev, bytes / BYTES_A_STEP, span);
}

bool eval_too_deep(Eval *ev, Span span)
{
    eval_fault(ev, DIAG_E0606, span, "expressions, blocks and macro calls nest too deeply");
    ev->stop = true;
    return false;
}
