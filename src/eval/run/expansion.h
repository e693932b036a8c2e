// Text that is read with its directives and macro calls resolved, token by token, as POV-Ray reads it: where directives
// hold no whole items, and where a macro gives more or less than one value.
//
// The text is that of the innermost frames of a cursor: tokens that were kept, or those that a parse's scanner gives.
//
//   expansion.c  the next token, and fragments that are parsed from tokens
//   control.c    what directives that choose, repeat and leave do to frames, of nodes and of texts
//   text_directives.c  the others, and calls
//   reading.c    items and expressions from such a text, and what the grammar asks meanwhile
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_RUN_EXPANSION_H
#define EVAL_RUN_EXPANSION_H

#include "eval/run/run.h"

typedef struct Expansion {
    GrammarFeed feed; // the grammar gives a pointer to it back
    Cursor *cursor;
    CursorFrame *bottom;   // the outermost frame of the text
    unsigned head_place;   // of the innermost frame that was there when the head that is being read began; 0: none is
    size_t head_open;      // directives that were open when the present fragment began
    bool is_in_head;       // which is the head of a directive
    bool within;           // the items stand inside braces or parentheses
    bool is_cut;           // a directive stood right after the last item
    bool ends_in_comma;
    bool is_open;          // an item or a directive is being read
} Expansion;

typedef ARRAY(Token) Tokens;

// ---- expansion.c

// Begins the text of the cursor's innermost frame, which has the tokens already or is a FRAME_LIVE of `live`. NULL when
// out of memory, which is reported.
Expansion *expansion_begin(Cursor *cursor, GrammarState *live, bool within) RT_MUST_CHECK;
// Its outermost frame is about to go.
void expansion_end(Cursor *cursor);

static inline Eval *expansion_eval(const Expansion *expansion)
{
    return expansion->cursor->ev;
}

static inline void expansion_fail(Expansion *expansion)
{
    expansion->feed.failed = true;
}

// The head of a `#end` or the like without the directive that it belongs to, and the other way round.
void expansion_fault_stray(Expansion *expansion, const Token *token);
void expansion_fault_unclosed(Expansion *expansion, const Token *token);

// A frame on the top; NULL after a fault.
CursorFrame *expansion_push(Expansion *expansion, FrameKind kind, const Token *opened_by);
void frame_set_text(CursorFrame *frame, const GrammarText *text, GrammarText *owned);
// Removes a frame and those that were left under it; all above and including one, of which the outermost only comes to
// its end.
void expansion_drop(Expansion *expansion, CursorFrame *frame);
void expansion_drop_from(Expansion *expansion, const CursorFrame *frame);

static inline bool frame_has_text(const CursorFrame *frame)
{
    return frame->kind < FRAME_BRANCH;
}

// The frame that a `#else`, `#end` or the like belongs to: the innermost one, but for files, which may hold part of a
// directive; NULL: there is none.
CursorFrame *expansion_owner_of_middle(const Expansion *expansion);
// The place of the innermost text; what is read again continues in the live one.
unsigned expansion_own_place(const Expansion *expansion);

// Tokens as they stand, see GrammarFeedCalls.
void expansion_read(Expansion *expansion, Token *token);
void expansion_unread(Expansion *expansion, const Token *token);
int expansion_peek(Expansion *expansion);

// Reads up to the `#end` that closes `depth` open directives, or, at depth 1 and if wanted, to a token between its
// branches. Keeps what it read in *kept, if that is not NULL. Gives the last token. False after a fault.
bool expansion_skip(Expansion *expansion, const Token *opener, unsigned depth, bool stops_between, Tokens *kept,
                    Token *last);

// Parses a fragment; NULL after a fault.
AstNode *expansion_parse(Expansion *expansion, FragmentKind kind, int base_depth, bool is_raw);
bool expansion_is_at_call(Expansion *expansion, const Token *token);

// ---- control.c: each runs up to what it chooses, or to the end of what it leaves

void control_begin_if(Expansion *expansion, const Token *directive);
void control_begin_switch(Expansion *expansion, const Token *directive);
void control_begin_while(Expansion *expansion, const Token *directive);
void control_begin_for(Expansion *expansion, const Token *directive);
void control_between(Expansion *expansion, const Token *directive); // a `#else`, `#case` or the like
void control_end(Expansion *expansion, const Token *directive);

// ---- text_directives.c

void text_directive(Expansion *expansion, const Token *directive);
void text_call(Expansion *expansion, const Token *name);

// ---- reading.c

// The next item; NULL at the end, or after a fault (feed.failed). Of a live text: nothing is open any more and the
// token `past` has been read.
AstNode *reading_item(Expansion *expansion, uint64_t past);
// One expression; NULL when there is none, which is reported.
AstNode *reading_expression(Expansion *expansion);
// `name(arguments)` as a CALL.
AstNode *reading_arguments(Expansion *expansion);
// Reads a `;` that stands right behind what was read last; false: there is none.
bool reading_take_semicolon(Expansion *expansion);

#endif
