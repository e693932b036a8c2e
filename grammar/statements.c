// Statements like earlier ones, between the items that are parsed.
//
// Turns text at the top level of a file into calls of the evaluator's plans, as long as it matches templates: a statement
// that matches none is parsed like any other, and when the evaluator has a plan for what it was, its text becomes a
// template, with slots for the numbers that the plan takes.
//
// SPDX-License-Identifier: MIT
#include "grammar/statements.h"

#include <stdlib.h>
#include <string.h>

#include "base/plain.h"
#include "grammar/parser.h"

enum {
    MISSES_MOST = 64, // so many texts in a row that no statement repeats: from then on few are kept
    MANY = 1024,      // so many in a row: it is worth while to look for more piece by piece
};

StatementReader *grammar_statements_new(void)
{
    return calloc(1, sizeof(StatementReader));
}

static void forget(const GrammarHooks *hooks, Template *template)
{
    if (template != NULL && template->plan != NULL) {
        hooks->plan_drop(hooks->client, template->plan);
    }
    template_free(template);
}

static void forget_all(const GrammarState *state)
{
    StatementReader *reader = state->statements;
    for (unsigned i = 0; i < TEMPLATES_MOST; i++) {
        forget(state->context->hooks, reader->templates[i]);
        reader->templates[i] = NULL;
    }
}

void grammar_statements_free(GrammarState *state)
{
    if (state->statements != NULL) {
        forget_all(state);
        free(state->statements->text);
        free(state->statements);
        state->statements = NULL;
    }
}

void statements_pass(GrammarState *state, int last, uint64_t end)
{
    state->previous = (Token){.kind = last, .span = {end - 1, end}};
    state->last_read = last;
    state->offset = end;
    state->has_moved = true;
}

// ---- learning

static void keep(GrammarState *state, Template *template)
{
    StatementReader *reader = state->statements;
    forget(state->context->hooks, reader->templates[TEMPLATES_MOST - 1]);
    memmove(reader->templates + 1, reader->templates, (TEMPLATES_MOST - 1) * sizeof *reader->templates);
    reader->templates[0] = template;
}

// The word that begins here, when a block or a call does.
static Symbol leading_word(const GrammarState *state, const char *begin)
{
    const char *at = begin;
    while (plain_is_in_word(*at)) {
        at++;
    }
    char next = *plain_skip_blanks(at);
    Symbol word = next == '{' || next == '(' ? intern_find(state->context->names, begin, (size_t)(at - begin)) : SYMBOL_NONE;
    return word != SYMBOL_NONE && (word < WORD_COUNT) == (next == '{') ? word : SYMBOL_NONE;
}

// Keeps the text of a statement that begins here, which is parsed as any other, to see what becomes of it.
static void begin_learning(GrammarState *state, const char *begin, const char *end)
{
    StatementReader *reader = state->statements;
    const GrammarHooks *hooks = state->context->hooks;
    Symbol word = leading_word(state, begin);
    if (word == SYMBOL_NONE || !hooks->plan_is_for(hooks->client, word) ||
        (++reader->misses > MISSES_MOST && reader->misses % MISSES_MOST != 0)) {
        return;
    }
    unsigned count;
    size_t length = template_survey(state->context, begin, end, state->offset, reader->slots, &count);
    char *text = length > 0 ? realloc(reader->text, length) : NULL;
    if (text == NULL) {
        return;
    }
    memcpy(text, begin, length);
    reader->text = text;
    reader->count = count;
    reader->learning = (Span){state->offset, state->offset + length};
    hooks->plan_watch(hooks->client, reader->learning, reader->slots, count);
}

// A text that has no plan is kept, too, so that it is not watched again: all of its numbers are slots.
static void end_learning(GrammarState *state)
{
    StatementReader *reader = state->statements;
    const GrammarHooks *hooks = state->context->hooks;
    bool is_batched = false;
    const GrammarPlan *plan = hooks->plan_learn(hooks->client, reader->learning, &is_batched);
    for (unsigned i = 0; i < reader->count; i++) {
        reader->slots[i].is_used = plan == NULL || reader->slots[i].is_used;
    }
    Span span = reader->learning;
    Template *template = template_new(reader->text, (size_t)(span.end - span.begin), span.begin, reader->slots, reader->count);
    reader->learning = (Span){0};
    if (template == NULL && plan != NULL) {
        hooks->plan_drop(hooks->client, plan);
    } else if (template != NULL) {
        template->plan = plan;
        template->is_batched = is_batched && !template->is_call;
        keep(state, template);
    }
}

// ---- reading

// The template that the text is like, which becomes the first one; NULL: it is like none.
static const Template *find(StatementReader *reader, const char *begin, const char *end, const char **after, double *numbers)
{
    for (unsigned i = 0; i < TEMPLATES_MOST && reader->templates[i] != NULL; i++) {
        Template *template = reader->templates[i];
        *after = template_match(template, begin, end, numbers);
        if (*after != NULL) {
            memmove(reader->templates + 1, reader->templates, i * sizeof *reader->templates);
            return reader->templates[0] = template;
        }
    }
    return NULL;
}

// One statement, if it is like an earlier one; *is_batched: it might have been taken together with others.
static bool read_one(GrammarState *state, bool *is_batched)
{
    const GrammarHooks *hooks = state->context->hooks;
    const char *end, *after, *at = grammar_window(state, &end), *begin = plain_skip_blanks(at);
    double numbers[GRAMMAR_SLOTS_MOST];
    if (state->ended || !plain_is_letter(*begin)) {
        return false;
    }
    uint64_t offset = state->offset + (uint64_t)(begin - at);
    const Template *template = find(state->statements, begin, end, &after, numbers);
    if (template == NULL) {
        state->has_moved = state->has_moved || offset != state->offset;
        state->offset = offset; // nothing before it but blanks
        begin_learning(state, begin, end);
        return false;
    }
    GrammarStatement statement = {{offset, offset + (uint64_t)(after - begin)}, template->plan, numbers};
    bool is_call = template->is_call;
    *is_batched = template->is_batched;
    GrammarTaken taken = template->plan != NULL ? hooks->plan_run(hooks->client, &statement) : GRAMMAR_LEFT;
    if (taken == GRAMMAR_LEFT) {
        return false;
    }
    state->statements->misses = 0;
    statements_pass(state, is_call ? ')' : '}', statement.span.end);
    state->client_ended = state->client_ended || taken == GRAMMAR_STOP;
    state->ended = state->ended || taken == GRAMMAR_STOP;
    return true;
}

void grammar_read_statements(GrammarState *state)
{
    StatementReader *reader = state->statements;
    const GrammarHooks *hooks = state->context->hooks;
    size_t batched = 0;
    bool is_batched = false;
    if (reader->learning.end > 0) {
        end_learning(state);
    }
    do {
        if (*hooks->plan_state != reader->plan_state) {
            forget_all(state);
            reader->plan_state = *hooks->plan_state;
        }
        batched = is_batched ? batched + 1 : 0;
        if (batched >= MANY) {
            batched = 0;
            (void)statements_read_many(state);
        }
        is_batched = false;
    } while (!state->ended && read_one(state, &is_batched));
}

bool grammar_reread_statements(GrammarState *state)
{
    uint64_t offset = state->offset, begin = state->current.span.begin;
    bool had_moved = state->has_moved;
    if (state->current.kind != TOKEN_NAME || state->held_count > 0 || state->ended || begin < state->window.begin) {
        return false;
    }
    state->offset = begin;
    grammar_read_statements(state);
    if (state->offset == begin) {
        state->offset = offset;
        state->has_moved = had_moved;
        return false;
    }
    state->passed = state->previous;
    state->current.kind = TOKEN_NUMBER; // nothing that opens or closes anything
    state->item_begin = 0;
    return true;
}
