// What scanner, token stream and parser share; private to the grammar.
//
// One GrammarState is one parse. The scanner (lexer.l) turns text into tokens; the token stream (tokens.c) stands
// between it and the parser: it knows the brackets and directives that are open and skips what cannot be understood;
// fragment.c parses parts of a text whose tokens somebody else delivers, with directives and macro calls resolved;
// messages.c says what is wrong; the facade (grammar.c) sets all up.
//
// SPDX-License-Identifier: MIT
#ifndef GRAMMAR_LEXER_H
#define GRAMMAR_LEXER_H

#include <setjmp.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/array.h"
#include "grammar/grammar.h"

// A bracket or a directive that still wants its other end.
typedef struct Opener {
    int kind;
    Span span;
    Symbol word;      // the word before a `{`, or the directive's; SYMBOL_NONE if there is none
    bool header_done; // of a directive: its parentheses are closed
    const void *callee; // of a `(` in a fragment: what the name before it stands for
} Opener;

typedef struct StatementReader StatementReader; // statements.c
typedef struct GrammarQuick GrammarQuick; // quick.c
typedef struct GrammarBlocks GrammarBlocks; // block_template.c

// The text from a little before the next byte on (window.c).
typedef struct Window {
    char *text; // WINDOW_PADDING zeros stand behind it
    size_t length, room;
    uint64_t begin; // global offset of its first byte
    uint64_t given; // the scanner has all before this
    size_t piece;   // bytes that it gets next
    bool is_checked; // the first block was looked at for bytes that no text has
    bool is_last;    // nothing follows it
    int fault;       // errno of why nothing follows; 0: the text ends
} Window;

typedef struct GrammarState {
    const GrammarContext *context;
    void *new_buffer; // of flex, until it has its bytes: they fail by a jump that forgets it
    AstBuilder builder;
    Source *source;    // NULL: `text` or `tokens` are read
    const char *text;  // the rest of a text in memory
    size_t text_length;
    const Token *tokens; // the rest of tokens that were read before
    size_t token_count;
    GrammarItemFn item;
    void *client;
    ArenaMark mark;    // where the present top-level item begins
    AstList *kept;     // where items are collected; NULL when each goes to the client
    bool client_ended; // the client returned false
    bool faulty;       // a fault was reported
    bool ended;        // a fault that ends the parse: only the end of the file is delivered from now on
    bool can_splice;   // a statement that a directive tears apart is to be read again, see grammar_tear
    bool torn;         // it was found to be one: nothing is said of it, and the end of the file is delivered
    Token torn_at;       // the token where that was found
    bool torn_by_fault;  // which the parser refused: what is skipped may be anything
    uint64_t told_to;    // the end of what is parsed once more for its messages, as reading it again failed, too
    uint64_t item_begin; // where the present top-level item begins; 0 before its first token
    size_t faults_before; // errors that were reported before it

    // Scanner.
    void *scanner;
    jmp_buf escape;     // taken when the scanner is out of memory
    uint64_t offset;    // global offset of the next byte
    Window window;
    bool has_moved;     // `offset` was moved by somebody else: what the scanner has of the text is out of date
    bool is_quiet;      // what cannot be read is a token INVALID, reported when somebody wants to have it
    bool is_unreadable; // so is the token that is being read
    bool file_name;     // the next string is the file name of an #include: backslashes stand for themselves
    uint64_t begin;     // of the string or comment being read
    uint64_t hash;      // of the directive being read; a comment may stand in it
    unsigned comment_depth;
    int comment_return; // start condition
    TextBuffer string;

    // Tokens that are read at once.
    GrammarQuick *quick; // NULL: there are none
    bool after_dot;      // the token before the previous one was a `.`; in a fragment, the one before the current
    bool in_list;        // within the braces of a list of a mesh, see quick.c
    AstNode *node;       // of the current token VECTOR
    AstList list;        // of the current token ITEMS

    StatementReader *statements; // NULL: all are parsed
    Token passed; // the last token of what they took while a token was read ahead; 0: none did

    // Token stream.
    Token previous, current; // the last two delivered to the parser
    Token held[4];           // to be delivered again: the last one first
    unsigned held_count;
    int last_read;           // kind of the last token from the scanner
    int start;               // the token that says what is parsed: delivered first, then 0
    uint64_t head_end;   // where the parentheses of a directive ended last
    bool skips;          // a fault was reported: skip before the next token
    unsigned unknown_directives; // not guessed; an #end may belong to each
    size_t unopened_braces;      // `}` that were left unreported, each after a report that its `{` is missing
    bool past_directive; // the fault is a directive inside an expression: skip all of it
    ARRAY(Opener) openers;

    // A fragment: one item, one directive, one list of arguments.
    GrammarFeed *feed;     // NULL: not a fragment
    int base_depth;        // directives end an expression that is complete with so many openers
    bool is_raw;           // names and directives are delivered as they stand
    bool begins_raw;       // so is its first token
    size_t function_level; // openers around the body of a function, whose names stand for themselves; 0: none
    bool function_begins;  // the next brace opens one
    size_t array_level;    // openers around the elements of an array; 0: none
    bool array_begins;     // the next brace opens them
    unsigned own_place;    // of the feed, where this directive began; 0: it is none
    bool takes_elements;   // elements of arrays may stand for themselves in it
    bool is_target;        // the last token delivered is that name, or an index of it
    unsigned counter_place; // of the feed, where the name of a #for stands
    int fragment;          // what it begins with: TOKEN_START_…
    bool is_declared;      // the last token delivered is the name that it declares
    bool takes_mode;       // it is #fopen, which continues behind the name of the file
    bool takes_string;     // it is a directive that takes a string
    bool ends_before;      // the last token delivered may end an expression
    bool ends_vector;      // it is the `>` of a vector
    int last_but_one;      // kind of the token before it
    Token ended_by;        // the directive or call that ended it
    bool has_lookahead;    // the current token was read too much
    AstNode *result;
} GrammarState;

// Scanner: the next token into *token.
int grammar_scan(GrammarState *state, Token *token);
bool grammar_scan_begin(GrammarState *state) RT_MUST_CHECK;
void grammar_scan_end(GrammarState *state);
// Whether a fault of the scanner is reported later, see is_quiet; the token is INVALID then.
bool grammar_scan_defers(GrammarState *state);
// Reports what is wrong with a token INVALID, if that was deferred.
void grammar_report_unreadable(GrammarState *state, const Token *token);

// Window: the text at `offset`, and its end. WINDOW_AHEAD bytes or more are at hand unless the text ends before.
enum { WINDOW_AHEAD = 8192, WINDOW_PADDING = 64 };
const char *grammar_window(GrammarState *state, const char **end);
// The next piece for the scanner, which has `pending` bytes of a token that has not ended; returns its length, 0 at the
// end of the text.
size_t grammar_window_give(GrammarState *state, char *buffer, size_t size, size_t pending);
void grammar_window_rewind(GrammarState *state); // the scanner continues at `offset`, which is in the window
// Goes back or forth to an offset of the source, among items.
void grammar_scan_seek(GrammarState *state, uint64_t offset);
void grammar_window_restart(GrammarState *state); // nothing is in it: the source continues at `offset`

// Statements like earlier ones: hands those over that come next, between two top-level items. The second one when a token
// was read ahead, which is forgotten when the answer is true.
void grammar_read_statements(GrammarState *state);
bool grammar_reread_statements(GrammarState *state);
StatementReader *grammar_statements_new(void) RT_MUST_CHECK; // NULL when out of memory
void grammar_statements_free(GrammarState *state);

// The next token, if it can be read at once from the scanner's buffer (quick.c).
bool grammar_scan_quick(GrammarState *state, Token *token);
// The same for the buffer, which ends with a zero: returns where reading continues, and moves `offset` there; NULL:
// nothing was read.
const char *grammar_quick_read(GrammarState *state, const char *at, const char *end, Token *token);
// The current token was refused: it becomes the mark that it begins with, and the scanner goes back to what follows.
void grammar_scan_apart(GrammarState *state);
GrammarQuick *grammar_quick_new(void) RT_MUST_CHECK; // NULL when out of memory
void grammar_quick_free(GrammarQuick *quick);
// The items between braces have been parsed: their nodes.
void grammar_learn_items(GrammarState *state, Span braces, AstList list);
// The same, for what quick.c owns; and items after the previous token, a word, that are like some that were learnt:
// their nodes into `list`, and where reading continues; NULL: there are none, or they are perhaps learnt now.
GrammarBlocks *grammar_blocks_new(void) RT_MUST_CHECK; // NULL when out of memory
void grammar_blocks_free(GrammarBlocks *blocks);
void grammar_blocks_learn(GrammarBlocks *blocks, const GrammarState *state, Span braces, AstList list);
const char *grammar_blocks_read(GrammarBlocks *blocks, GrammarState *state, const char *at, const char *end);

// Token stream: the symbol and directive tables.
int grammar_word_token(Symbol symbol);
// The token of a `#word`; reports E0105 and gives the one that was probably meant, or the token INVALID.
int grammar_directive_token(GrammarState *state, const char *word, size_t length, Span span);
// Whether a `#` before a `}` is passed over, with a warning: in a block of items.
bool grammar_is_idle_hash(GrammarState *state, Span span);
Opener *grammar_innermost(GrammarState *state); // NULL when nothing is open

// The next token as the text has it.
void grammar_read_token(GrammarState *state, Token *token);
void grammar_hold_token(GrammarState *state, Token token);
void grammar_track(GrammarState *state, const Token *token); // keeps the stack of openers
// After a fault (recovery.c): to where reading can continue; state->current is then TOKEN_RESYNC.
void grammar_skip(GrammarState *state);
// Gives the present statement up so that it is read again with its directives resolved. False when that cannot be.
bool grammar_tear(GrammarState *state);

// Fragments (fragment.c): the token after the current one.
void grammar_fragment_token(GrammarState *state, Token *token);
// Whether the place at which the statement was torn is wrong for those who read it again, too: the parser reads it once
// more, and what it then says of it is all that is said. Ends the reading.
bool grammar_feed_is_refused(GrammarFeed *feed, Span at);

// Builders for names and expressions, which are computed at once in a fragment.
AstNode *grammar_name(GrammarState *state, Symbol symbol, Span span);
AstNode *grammar_element(GrammarState *state, AstNode *node);
AstNode *grammar_call(GrammarState *state, AstNode *node); // of a name
AstNode *grammar_fold(GrammarState *state, AstNode *node);
// A #declare or #version without `;`: the token after it has been read.
AstNode *grammar_end_declare(GrammarState *state, AstNode *node);
AstNode *grammar_end_version(GrammarState *state, AstNode *node);
// Ends a fragment: `has_lookahead` when a token after it was read.
void grammar_finish(GrammarState *state, AstNode *result, bool has_lookahead);

// Messages: reports a fault at the current token; `expected` names the tokens that would do.
void grammar_report_syntax(GrammarState *state, const char *const *expected, size_t count);

// ---- hints.c

// The directive that another language's word most likely stands for, or NULL; *stands_for_it: reading can continue as
// if it stood there.
const char *grammar_foreign_directive(const char *word, size_t length, bool *stands_for_it);
// The help for a mark that is an operator in other languages, or NULL.
const char *grammar_foreign_mark(char mark);
// The length of the typographic quote that a text begins with, in UTF-8 or Windows-1252; 0: there is none.
size_t grammar_quote_length(const char *text, size_t length);
// Adds to the fault that was kept last, of a string without an end: it may have been closed with another quote.
void grammar_hint_string(GrammarState *state);
// Add to the fault that was kept last: help for the current token, `only_closes` when nothing but `)` could stand
// there; a note where a `}` is missing by the indentation, with the outermost of the braces that are open at the end of
// the file.
void grammar_hint_token(GrammarState *state, bool only_closes);
void grammar_hint_brace(GrammarState *state, const Opener *outermost);
void grammar_fault(GrammarState *state, DiagCode code, Span span, const char *format, ...) RT_PRINTF(4, 5);

// Appends a token as messages name it, for example "`rgb`" or "the end of the file".
void grammar_describe(const GrammarState *state, const Token *token, TextBuffer *out);
bool grammar_is_reserved(int token);

// The next token into state->current, without the stack of openers: for a dump.
void grammar_next_token(GrammarState *state);
// `kind text` of a token, for a dump.
void grammar_describe_token(const GrammarState *state, const Token *token, TextBuffer *out);

// Facade: hands a completed top-level item over; `has_lookahead`: a token after it was read. False when the parse is to
// stop.
bool grammar_emit(GrammarState *state, AstNode *item, bool has_lookahead);
void grammar_end_in_comma(GrammarState *state, Span comma); // of a text
void grammar_begin(GrammarState *state, const GrammarContext *context);

#endif
