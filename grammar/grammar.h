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

#include "ast/ast.h"
#include "ast/words.h"
#include "base/text.h"

// Everything a parse needs; plain data, filled by the caller, shared by nested parses (#include).
typedef struct GrammarContext {
    InternTable *names; // reserved words interned
    Arena *arena;       // parse arena
    DiagSink *diags;
    const Limits *limits;
} GrammarContext;

// Called for each complete top-level item (a directive, a block, an expression, a word). The node is valid during the
// call only. Returning false stops the parse.
typedef bool (*GrammarItemFn)(void *client, const AstNode *item);

// Parses the whole source. After a syntax fault the parser resynchronises at `}`, `;` or a directive and goes on, so
// that one run reports many faults; items that are whole are still handed over. True when no fault was found and the
// client never returned false.
bool grammar_parse(const GrammarContext *context, Source *source, GrammarItemFn item, void *client) RT_MUST_CHECK;

// The same, but keeps all items in the arena as one list, for an #include inside a block.
bool grammar_parse_all(const GrammarContext *context, Source *source, AstList *items) RT_MUST_CHECK;

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
