// The facade of the grammar: text in, AST items out, one top-level item at a time.
//
// Turns a Source into a stream of items. Each item is handed to the client and its memory is taken back when the client
// returns, so a scene of ten million spheres does not cost its syntax. Others include this header only; lexer.h and the
// generated headers are private. Knows nothing of values, kinds or scopes.
//
// SPDX-License-Identifier: MIT
#ifndef GRAMMAR_GRAMMAR_H
#define GRAMMAR_GRAMMAR_H

#include <stdbool.h>
#include <stdint.h>

#include "ast/ast.h"
#include "ast/words.h"
#include "base/text.h"

// Text that was read to be read again: a macro's body, a loop's. Opaque.
typedef struct GrammarText GrammarText;

// A #for while it runs.
typedef struct GrammarLoop {
    Symbol counter;
    Span span;
    double end, step;
} GrammarLoop;

// Statements of a text that are like an earlier one but for their numbers (grammar/template.h). What becomes of the
// numbers is the evaluator's plan.
typedef struct GrammarPlan GrammarPlan;

enum { GRAMMAR_SLOTS_MOST = 64 };

// A number of the statement that a plan is made of.
typedef struct GrammarSlot {
    Span span; // with its sign
    double number;
    bool is_used; // the plan takes it; else it is like any other text
} GrammarSlot;

typedef struct GrammarStatement {
    Span span;
    const GrammarPlan *plan;
    const double *numbers; // of the slots that are used, in their order
} GrammarStatement;

typedef enum GrammarTaken {
    GRAMMAR_TAKEN,
    GRAMMAR_LEFT, // nothing was done: to be parsed as any other statement
    GRAMMAR_STOP, // taken, and reading is to stop
} GrammarTaken;

// Where a directive holds no whole items, text is read again in a *splice*: conditions, loops and macro calls are
// resolved token by token, as POV-Ray does it, and what is left is parsed. These functions are the evaluator's part:
// all before a token has been worked out when it is delivered. None of them is called otherwise.
typedef struct GrammarHooks {
    void *client;
    unsigned *nesting; // of fragments, all together; kept by the grammar
    // What a name stands for now, kept in the parse arena; NULL: nothing.
    const void *(*capture)(void *client, Symbol name, Span span);
    bool (*is_number)(void *client, const void *captured); // or a vector or colour
    bool (*is_macro)(void *client, Symbol name);
    bool (*lacks_index)(void *client, const AstNode *element); // its array has more dimensions
    bool (*takes_braces)(void *client, Symbol word); // `{` stands after this word of the language
    // A macro whose text holds unpaired braces; *has_unbalanced: there are any.
    bool (*is_unbalanced)(void *client, Symbol name);
    const bool *has_unbalanced;
    // Works an expression out: sets AST_KNOWN and `known`.
    void (*fold)(void *client, AstNode *node);
    // Runs a directive other than those below; `within`: inside an item. Since it began so many calls and files have
    // begun that have not ended. False: stop.
    bool (*run)(void *client, const AstNode *directive, bool within, unsigned scopes);
    // Whether the condition holds (IF, IFDEF, WHILE) or *subject meets it (CASE, RANGE); SWITCH sets *subject. False: a
    // fault was reported.
    bool (*decide)(void *client, const AstNode *directive, double *subject, bool *holds);
    // Begins a #for, and takes its next turn.
    bool (*loop_begin)(void *client, const AstNode *header, GrammarLoop *loop, bool *holds);
    bool (*loop_turn)(void *client, const GrammarLoop *loop, bool *holds);
    bool (*step)(void *client, Span span); // counts a turn; false: stop
    // Defines a macro: MACRO without a body when it holds no whole items, and all its text after the parameters.
    bool (*define)(void *client, const AstNode *macro, const GrammarText *body);
    // Begins a call: its body; NULL after a fault. `leave` ends it, and an included file.
    const GrammarText *(*call)(void *client, const AstNode *call);
    // Opens an #include inside an item; NULL after a fault.
    Source *(*include)(void *client, const AstNode *directive);
    void (*leave)(void *client);
    bool (*is_stopped)(void *client);
    bool is_top; // what stands between items is of the scene and no part of anything
    // Statements by their plans. Whether one that begins with this word may have one. A statement of these numbers is
    // the next item: to be watched. Then: its plan; NULL: it has none; *is_batched: those of a text may be handed over
    // together, as below. Each plan is dropped once. Then others of that kind, without a tree. `plan_state` changes
    // whenever a plan may not hold any more. NULL in `plan_run`: all are parsed.
    const uint64_t *plan_state;
    bool (*plan_is_for)(void *client, Symbol word);
    void (*plan_watch)(void *client, Span statement, GrammarSlot *slots, unsigned count);
    const GrammarPlan *(*plan_learn)(void *client, Span statement, bool *is_batched);
    void (*plan_drop)(void *client, const GrammarPlan *plan);
    GrammarTaken (*plan_run)(void *client, const GrammarStatement *statement);
    // The same for those that are batched: makes a record of one that begins at an offset, on any thread; false: it is
    // left. Then takes `count`
    // >= 1 records at once; it seems that about `more` will follow. False: nothing was done, they are to be given one by
    // one.
    size_t plan_record_bytes;
    bool (*plan_prepare)(const GrammarPlan *plan, const double *numbers, uint64_t begin, void *record);
    bool (*plan_keep)(void *client, const void *records, size_t count, size_t more);
    int plan_threads;  // long runs of them are read on so many; 0 and 1: on the caller's alone
    size_t plan_piece; // bytes of text that each of these takes at a time; 0: as is best
} GrammarHooks;

// Everything a parse needs; plain data, filled by the caller, shared by nested parses (#include).
typedef struct GrammarContext {
    InternTable *names; // reserved words interned
    Arena *arena;       // parse arena
    DiagSink *diags;
    const Limits *limits;
    GrammarHooks *hooks; // NULL: text is parsed only, and what would need a splice is a fault
    bool token_by_token; // all tokens come from flex one by one, for comparison: the same comes of it
    bool *has_mark;      // set where the text begins with a byte order mark; may be NULL
} GrammarContext;

// Called for each complete top-level item (a directive, a block, an expression, a word). The node is valid during the
// call only. Returning false stops the parse.
typedef bool (*GrammarItemFn)(void *client, const AstNode *item);

// Parses the whole source. After a syntax fault the parser resynchronises at `}`, `;` or a directive and goes on, so
// that one run reports many faults; items that are whole are still handed over. True when no fault was found and the
// client never returned false.
bool grammar_parse(const GrammarContext *context, Source *source, GrammarItemFn item, void *client) RT_MUST_CHECK;

// The same, but keeps all items in the arena as one list, for an #include inside a block. *torn: nothing was reported,
// but the text needs a splice.
bool grammar_parse_all(const GrammarContext *context, Source *source, AstList *items, bool *torn) RT_MUST_CHECK;

// A text that is read in a splice, item by item, on demand. The items live in the parse arena.
typedef struct GrammarStream GrammarStream;

// The text stays the caller's. `within`: it stands inside braces or parentheses; `is_call`: it is a macro's, which
// #break leaves. NULL when out of memory.
GrammarStream *grammar_stream_open(const GrammarContext *context, const GrammarText *text, bool within,
                                   bool is_call) RT_MUST_CHECK;
// The next item; NULL at the end, or when reading cannot go on (`*failed`).
AstNode *grammar_stream_next(GrammarStream *stream, bool *failed) RT_MUST_CHECK;
// One expression, or `name(arguments)` as a CALL; NULL when there is none, which is reported.
AstNode *grammar_stream_expression(GrammarStream *stream) RT_MUST_CHECK;
AstNode *grammar_stream_arguments(GrammarStream *stream) RT_MUST_CHECK;
// Reads a `;` that stands right after what was read last; false: there is none.
bool grammar_stream_take_semicolon(GrammarStream *stream);
// True when a directive stood right after the last item, and may have ended it.
bool grammar_stream_is_cut(const GrammarStream *stream);
// After the last item: a comma stood behind it.
bool grammar_stream_ends_in_comma(const GrammarStream *stream);
void grammar_stream_close(GrammarStream *stream);

// Reads all of a source, or a span of one again, for a splice; NULL after a fault. The caller's to free.
GrammarText *grammar_text_read(const GrammarContext *context, Source *source) RT_MUST_CHECK;
GrammarText *grammar_text_again(const GrammarContext *context, Span span) RT_MUST_CHECK;
// The body of a macro, whose definition stands in the span.
GrammarText *grammar_text_body(const GrammarContext *context, Span macro) RT_MUST_CHECK;
// Whether its brackets pair up and no expression goes on beyond it, taking the first branch of each directive.
bool grammar_text_is_balanced(const GrammarText *text);
bool grammar_text_is_empty(const GrammarText *text);
// A copy in an arena; NULL when out of memory.
GrammarText *grammar_text_copy(const GrammarText *text, Arena *arena) RT_MUST_CHECK;

// What a token is, for those who want tokens and no syntax.
typedef enum GrammarTokenKind {
    GRAMMAR_TOKEN_END, // after the last one; empty
    GRAMMAR_TOKEN_MARK,
    GRAMMAR_TOKEN_NUMBER,
    GRAMMAR_TOKEN_STRING,
    GRAMMAR_TOKEN_WORD,      // a name or a reserved word, `symbol`
    GRAMMAR_TOKEN_DIRECTIVE, // from `#` to the end of the word, `symbol`; what stands between them is in the span
} GrammarTokenKind;

typedef struct GrammarToken {
    GrammarTokenKind kind;
    Symbol symbol; // SYMBOL_NONE where the kind has none
    Span span;
} GrammarToken;

typedef bool (*GrammarTokenFn)(void *client, const GrammarToken *token);

// Hands over every token of the source, whatever its syntax is. True when no fault was found and the client never
// returned false, which stops the reading.
bool grammar_scan_all(const GrammarContext *context, Source *source, GrammarTokenFn token, void *client) RT_MUST_CHECK;

// Writes one token a line, `line:column kind text`, for --dump=tokens.
bool grammar_dump_tokens(const GrammarContext *context, Source *source, SourceMap *sources,
                         TextBuffer *out) RT_MUST_CHECK;

#endif
