// A splice's stream, shared by the files that read, direct and deliver it; private to the grammar.
//
//   splice.c            items, one after the other, and statements that were found torn
//   splice_stream.c     frames, tokens as they stand, fragments
//   splice_directives.c what each directive and each call does to the frames
//   splice_tokens.c     what the parser is given, and what it builds of names and operators
//
// SPDX-License-Identifier: MIT
#ifndef GRAMMAR_SPLICE_H
#define GRAMMAR_SPLICE_H

#include "grammar/lexer.h"
#include "grammar/parser.h"

enum {
    NO_BASE = -1, // of a fragment in which a directive ends no expression
};

typedef enum FrameKind {
    FRAME_LIVE,   // what the scanner gives
    FRAME_TEXT,   // tokens
    FRAME_MACRO,  // tokens of a macro's body
    FRAME_FILE,   // tokens of an included file
    FRAME_WHILE,  // tokens of a loop, the condition included, up to its #end
    FRAME_FOR,    // tokens of a loop's body, up to its #end
    FRAME_BRANCH, // the chosen branch of an #if: no tokens of its own
    FRAME_SWITCH, // a #switch
    FRAME_LEFT,   // a text at its end, under directives that began in it: keeps their places
} FrameKind;

typedef struct Frame {
    FrameKind kind;
    GrammarText *owned; // freed with the frame
    const Token *tokens;
    size_t count, at;
    Token opened_by;
    GrammarLoop loop;
    double subject; // of a #switch
    bool is_found;  // its case
    bool has_cases; // at least one
    bool is_last;   // the #else of an #if: no other branch may follow
} Frame;

struct GrammarStream {
    const GrammarContext *context;
    GrammarHooks *hooks;
    GrammarState *live; // the state whose scanner gives the text after the kept tokens; NULL: there is none
    ARRAY(Frame) frames;
    size_t head_frames; // those that were there when the head that is being read began; 0: none is
    bool within;  // the items stand inside braces or parentheses
    bool is_call; // the whole is a macro's body
    bool failed;  // reading cannot go on
    bool is_refused; // at the place where the statement was torn: see grammar_stream_is_refused
    bool is_cut;  // a directive stood right after the last item
    bool ends_in_comma;
    bool is_open; // an item or a directive is being read
    Span end;     // of the last token
    Token silent; // the name of a macro that gave nothing before the present token
};

typedef ARRAY(Token) Tokens;

// ---- splice_stream.c

// Faults: each ends the reading of the stream.
void stream_fail(GrammarStream *stream); // reported already
void stream_fault(GrammarStream *stream, DiagCode code, Span span, const char *text);
void stream_fault_stray(GrammarStream *stream, const Token *token);    // part of a directive, without the rest
void stream_fault_unclosed(GrammarStream *stream, const Token *token); // a directive without its #end

// A frame on the top; NULL after a fault.
Frame *stream_push(GrammarStream *stream, FrameKind kind, const Token *opened_by);
// Removes a frame, and those that were left under it.
void stream_drop(GrammarStream *stream, size_t at);
void stream_drop_to(GrammarStream *stream, size_t count);
// The frame that a `#else`, `#end` or the like belongs to: the innermost one, but for files, which may hold part of a
// directive. The count of frames when there is none.
size_t stream_owner_of_middle(const GrammarStream *stream);
// One more than the place of the innermost frame that has tokens; 0: there is none.
size_t stream_innermost_text(const GrammarStream *stream);

static inline bool frame_has_text(const Frame *frame)
{
    return frame->kind < FRAME_BRANCH;
}

// The innermost text; what is read again goes on in the live one.
size_t stream_own_text(const GrammarStream *stream);
// Calls and files that began in a text, given as above, and have not ended.
unsigned stream_scopes_since(const GrammarStream *stream, size_t text);

// Directives that have not met their #end.
size_t stream_open_directives(const GrammarStream *stream);
// Whether a fragment is the head of a directive.
bool stream_is_head(int start);
// The next token of the text, wherever it stands; leaves frames whose text is at its end.
void stream_read(GrammarStream *stream, Token *token);
// Takes back the token that was read last.
void stream_unread(GrammarStream *stream, const Token *token);
// The kind of the next token in the text of the innermost frame.
int stream_peek_kind(GrammarStream *stream);
// Whether a token of that kind comes next in the text of the last one.
bool stream_is_before(GrammarStream *stream, int kind);
void stream_deliver_end(const GrammarStream *stream, Token *token);

// Reads up to the `#end` that closes `depth` open directives, or, at depth 1 and if wanted, to a token between its
// branches. Keeps what it read in *kept, if that is not NULL. Gives the last token. False after a fault.
bool stream_skip(GrammarStream *stream, const Token *opener, unsigned depth, bool stops_between, Tokens *kept,
                 Token *last);
bool stream_keep_to_end(GrammarStream *stream, const Token *opener, Tokens *kept);

// Parses what `start` says from the stream; NULL after a fault. Directives end an expression that is complete with
// `base_depth` openers.
AstNode *stream_parse(GrammarStream *stream, int start, int base_depth, bool is_raw);

// ---- splice_directives.c

void stream_run_directive(GrammarStream *stream, const Token *directive);
void stream_call_macro(GrammarStream *stream, const Token *name);

// ---- splice_tokens.c

bool stream_is_at_call(GrammarStream *stream, const GrammarState *state, const Token *token);

#endif
