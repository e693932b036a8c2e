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

// ---- tokens

typedef struct Token {
    int kind; // enum grammar_yytokentype, or a character
    Span span;
    union {
        Symbol symbol; // words, names, strings; the directive's word
        double number;
    };
    const void *known; // of a name of a fragment: what it stood for when it was read; NULL: nothing. Of INVALID: not
                       // NULL while it is not reported
} Token;

// Text that was read to be read again: a macro's body, a loop's.
typedef struct GrammarText {
    size_t count;
    Token tokens[];
} GrammarText;

typedef enum DirectiveRole {
    ROLE_NONE,
    ROLE_SIMPLE, // stands alone
    ROLE_OPENS,  // wants an #end
    ROLE_MIDDLE, // inside one that wants an #end, with parentheses of its own
    ROLE_ELSE,
    ROLE_END,
} DirectiveRole;

enum { GRAMMAR_END_OF_TEXT = 0 }; // the kind of a token

bool grammar_is_directive(int token);
DirectiveRole grammar_role(int token);
Symbol grammar_directive_word(int token); // of a token that is a directive
bool grammar_is_name(int token);          // of something declared, or of nothing

// ---- statements by their plans

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

typedef struct GrammarContext GrammarContext;
typedef struct GrammarState GrammarState; // one parse

// What a process has read of its pieces of a text, of which others read those between.
typedef struct GrammarRound {
    uint64_t begin, end;    // of the first statement and where the next one begins
    uint64_t last, count;   // where the last one ends, and how many there are
    uint64_t pieces;        // 0: none was this process's
    uint64_t is_whole;      // all of its pieces were read
} GrammarRound;

// What the grammar asks of those who know what names stand for, and of plans.
typedef struct GrammarHooks {
    void *client;
    bool (*takes_braces)(void *client, Symbol word); // `{` stands after this word of the language
    bool (*is_macro)(void *client, Symbol name);
    // A macro whose text holds unpaired braces; *has_unbalanced: there are any.
    bool (*is_unbalanced)(void *client, Symbol name);
    const bool *has_unbalanced;
    // A statement that directives tear apart, begun at `begin`, found torn at a token that is held: reads it from the
    // parse with its directives resolved, and hands its items over. False after a fault; *is_refused: it is to be
    // parsed once more for its messages.
    bool (*read_torn)(void *client, GrammarState *live, uint64_t begin, const Token *torn, bool *is_refused);
    // Of the fragments of such a text. What a name stands for now, kept in the parse arena; NULL: nothing.
    const void *(*capture)(void *client, Symbol name, Span span);
    bool (*is_number)(void *client, const void *captured); // or a vector or colour
    bool (*lacks_index)(void *client, const AstNode *element); // its array has more dimensions
    // Works an expression out: sets AST_KNOWN and `known`. False: stop.
    bool (*fold)(void *client, AstNode *node);
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
    // Where `plan_parts` > 1 processes read one text, each keeps the statements of its own pieces, which plan_keep gets.
    // The others are passed, by their number. Then plan_exchange tells each what all have read in a round; false: one of
    // them cannot continue, and the client stops.
    int plan_part, plan_parts;
    bool (*plan_pass)(void *client, size_t count);
    bool (*plan_exchange)(void *client, const GrammarRound *own, GrammarRound *all);
} GrammarHooks;

// Everything a parse needs; plain data, filled by the caller, shared by nested parses (#include).
struct GrammarContext {
    InternTable *names; // reserved words interned
    Arena *arena;       // parse arena
    DiagSink *diags;
    const Limits *limits;
    GrammarHooks *hooks; // NULL: text is parsed only, and what directives tear apart is a fault
    bool token_by_token; // all tokens come from flex one by one, for comparison: the same comes of it
    bool *has_mark;      // set where the text begins with a byte order mark; may be NULL
};

// Called for each complete top-level item (a directive, a block, an expression, a word). The node is valid during the
// call only. Returning false stops the parse.
typedef bool (*GrammarItemFn)(void *client, const AstNode *item);

// Parses the whole source. After a syntax fault the parser resynchronises at `}`, `;` or a directive and continues, so
// that one run reports many faults; items that are whole are still handed over. True when no fault was found and the
// client never returned false.
bool grammar_parse(const GrammarContext *context, Source *source, GrammarItemFn item, void *client) RT_MUST_CHECK;

// The same, but keeps all items in the arena as one list, for an #include inside a block. *torn: nothing was reported,
// but the text is torn.
bool grammar_parse_all(const GrammarContext *context, Source *source, AstList *items, bool *torn) RT_MUST_CHECK;

// ---- fragments: parts of a text whose tokens somebody else delivers, with directives and macro calls resolved

enum { GRAMMAR_NO_BASE = -1 };

typedef enum FragmentKind {
    FRAGMENT_ITEM,
    FRAGMENT_EXPRESSION,
    FRAGMENT_DIRECTIVE, // a simple one, which comes next
    FRAGMENT_CONDITION, // the heads of others, in their parentheses
    FRAGMENT_SUBJECT,
    FRAGMENT_RANGE,
    FRAGMENT_FOR,
    FRAGMENT_MACRO,
    FRAGMENT_ARGUMENTS, // of a call
} FragmentKind;

typedef struct Fragment {
    FragmentKind kind;
    int base_depth; // directives end an expression that is complete with so many brackets open, or GRAMMAR_NO_BASE
    bool is_raw;    // names and directives are delivered as they stand
    // What came of it.
    bool is_cut;            // a directive or a call ended it
    unsigned counter_place; // of a #for: where its name stands
} Fragment;

typedef struct GrammarFeed GrammarFeed;

typedef struct GrammarFeedCalls {
    void (*read)(GrammarFeed *feed, Token *token);         // the next token, as it stands
    void (*unread)(GrammarFeed *feed, const Token *token); // takes back the one that was read last
    int (*peek)(GrammarFeed *feed);                        // the kind of the next one
    bool (*is_before)(GrammarFeed *feed, int kind);        // one of this kind comes next in the same text
    void (*resolve)(GrammarFeed *feed, const Token *token); // the text of a directive or call takes its place
    bool (*is_at_end)(GrammarFeed *feed, unsigned place);  // a directive that began there has no more text
} GrammarFeedCalls;

// Those who deliver. `place` counts the texts around a token from 1 on.
struct GrammarFeed {
    const GrammarContext *context;
    const GrammarFeedCalls *calls;
    GrammarState *live; // the parse that gives the text after the one that is kept; NULL: there is none
    unsigned macros;    // that the text stands in
    bool failed;        // reading cannot continue: nothing but the end is delivered
    bool is_refused;    // at the place where the statement was torn, see GrammarHooks
    Span end;           // of the last token
    unsigned place;     // of the last token
    bool is_kept, is_call; // it stands in a text that was kept for reading; in that of a macro
    Token silent;       // the name of a macro that gave nothing before the present token; kind 0: none
};

// NULL after a fault.
AstNode *grammar_parse_fragment(GrammarFeed *feed, Fragment *fragment);
// Reports once for each feed, and ends its reading.
void grammar_feed_fault(GrammarFeed *feed, DiagCode code, Span span, const char *text);
// Whether a fault may be reported still.
bool grammar_feed_may_report(GrammarFeed *feed);

// What the parse of a torn statement delivers and takes.
void grammar_live_read(GrammarState *live, Token *token);
void grammar_live_unread(GrammarState *live, const Token *token);
// Nothing was read ahead that begins after an offset.
bool grammar_live_is_before(const GrammarState *live, uint64_t offset);
bool grammar_live_emit(GrammarState *live, AstNode *item); // false: the client wants no more

GrammarText *grammar_text_new(const Token *tokens, size_t count) RT_MUST_CHECK;
// The definition of a macro from its tokens as a tree; NULL when its body holds no whole items.
AstNode *grammar_text_macro(const GrammarContext *context, const Token *macro, const Token *tokens, size_t count);
// Reads all of a source, or a span of one again, as tokens; NULL after a fault. The caller's to free.
GrammarText *grammar_text_read(const GrammarContext *context, Source *source) RT_MUST_CHECK;
GrammarText *grammar_text_again(const GrammarContext *context, Span span) RT_MUST_CHECK;
// The body of a macro, whose definition stands in the span.
GrammarText *grammar_text_body(const GrammarContext *context, Span macro) RT_MUST_CHECK;
// Whether its brackets pair up and no expression continues beyond it, taking the first branch of each directive.
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
