// What scanner, token stream and parser share; private to the grammar.
//
// One GrammarState is one parse. The scanner (lexer.l) turns text into tokens; the token stream (tokens.c) stands
// between it and the parser: it knows the brackets and directives that are open and skips what cannot be understood;
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

typedef struct Token {
    int kind; // enum grammar_yytokentype, or a character
    Span span;
    union {
        Symbol symbol; // words, names, strings; the directive's word
        double number;
    };
} Token;

typedef enum DirectiveRole {
    ROLE_NONE,
    ROLE_SIMPLE, // stands alone
    ROLE_OPENS,  // wants an #end
    ROLE_MIDDLE, // inside one that wants an #end, with parentheses of its own
    ROLE_ELSE,
    ROLE_END,
} DirectiveRole;

// A bracket or a directive that still wants its other end.
typedef struct Opener {
    int kind;
    Span span;
    Symbol word;      // the word before a `{`, or the directive's; SYMBOL_NONE if there is none
    bool header_done; // of a directive: its parentheses are closed
} Opener;

typedef struct GrammarState {
    const GrammarContext *context;
    AstBuilder builder;
    Source *source;
    GrammarItemFn item;
    void *client;
    ArenaMark mark;    // where the present top-level item begins
    AstList *kept;     // where items are collected; NULL when each goes to the client
    bool client_ended; // the client returned false
    bool faulty;       // a fault was reported
    bool ended;        // a fault that ends the parse: only the end of the file is delivered from now on

    // Scanner.
    void *scanner;
    jmp_buf escape;     // taken when the scanner is out of memory
    uint64_t offset;    // global offset of the next byte
    bool block_checked; // the first block was looked at for bytes that no text has
    bool file_name;     // the next string is the file name of an #include: backslashes stand for themselves
    uint64_t begin;     // of the string or comment being read
    uint64_t hash;      // of the directive being read; a comment may stand in it
    unsigned comment_depth;
    int comment_return; // start condition
    TextBuffer string;

    // Token stream.
    Token previous, current; // the last two delivered to the parser
    Token held[2];           // read while skipping, to be delivered again: the last one first
    unsigned held_count;
    bool skips;          // a fault was reported: skip before the next token
    unsigned unknown_directives; // not guessed; an #end may belong to each
    bool past_directive; // the fault is a directive inside an expression: skip all of it
    ARRAY(Opener) openers;
} GrammarState;

// Scanner: the next token into *token.
int grammar_scan(Token *token, void *scanner);
bool grammar_scan_begin(GrammarState *state) RT_MUST_CHECK;
void grammar_scan_end(GrammarState *state);

// Token stream: the symbol and directive tables.
int grammar_word_token(Symbol symbol);
// The token of a `#word`; reports E0105 and gives the one that was probably meant, or the token INVALID.
int grammar_directive_token(GrammarState *state, const char *word, size_t length, Span span);
bool grammar_is_directive(int token);
DirectiveRole grammar_role(int token);
Symbol grammar_directive_word(int token);       // of a token that is a directive
Opener *grammar_innermost(GrammarState *state); // NULL when nothing is open

// Messages: reports a fault at the current token; `expected` names the tokens that would do.
void grammar_report_syntax(GrammarState *state, const char *const *expected, size_t count);
void grammar_fault(GrammarState *state, DiagCode code, Span span, const char *format, ...) RT_PRINTF(4, 5);

// Appends a token as messages name it, for example "`rgb`" or "the end of the file".
void grammar_describe(const GrammarState *state, const Token *token, TextBuffer *out);
bool grammar_is_reserved(int token);

// The next token into state->current, without the stack of openers: for a dump.
void grammar_next_token(GrammarState *state);
// `kind text` of a token, for a dump.
void grammar_describe_token(const GrammarState *state, const Token *token, TextBuffer *out);

// Facade: hands a completed top-level item over. False when the parse is to stop.
bool grammar_emit(GrammarState *state, AstNode *item);

#endif
