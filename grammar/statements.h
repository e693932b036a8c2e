// What the readers of statements share: one by one (statements.c), and long runs of them (statements_many.c). Private to the
// grammar.
//
// SPDX-License-Identifier: MIT
#ifndef GRAMMAR_STATEMENTS_H
#define GRAMMAR_STATEMENTS_H

#include "grammar/lexer.h"
#include "grammar/template.h"

enum {
    TEMPLATES_MOST = 8,
    STATEMENT_LONGEST = WINDOW_AHEAD, // bytes, with its numbers and as many blanks as there are usually
};

struct StatementReader {
    Template *templates[TEMPLATES_MOST]; // the one used last first
    Span learning;       // the statement that is being parsed; empty: none that may become a template
    char *text;          // of it
    GrammarSlot slots[GRAMMAR_SLOTS_MOST];
    unsigned count;      // of these
    uint64_t plan_state; // of the hooks, when they were learnt
    unsigned misses;     // in a row
};

// A statement that ends here was taken: as if its tokens had been delivered.
void statements_pass(GrammarState *state, int last, uint64_t end);

// From `offset` on, piece by piece. False: nothing was read. True: reading continues in the source at `offset`, and the
// window is out of date.
bool statements_read_many(GrammarState *state);

#endif
