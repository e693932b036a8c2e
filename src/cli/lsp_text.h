// Places and names in the text of a document, as the language server needs them.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_LSP_TEXT_H
#define CLI_LSP_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

// As the protocol has it: lines from 0, characters in units of UTF-16.
typedef struct Position {
    int line, character;
} Position;

typedef struct Word {
    const char *begin;
    size_t length; // 0: there is none
} Word;

// The byte at a position; that of the end of a shorter line or text.
const char *text_at(const char *text, Position position);
// The byte of a line and column that count from 1, in characters.
const char *text_of_column(const char *text, unsigned long long line, unsigned long long column);

// The identifier that the place stands in or right behind.
Word text_word(const char *text, const char *at);
// The next name that a `#declare`, `#local` or `#macro` at or behind `from` writes.
Word text_next_declared(const char *from);
// Where a name is declared: the last time before `before`, else the first time. NULL: nowhere.
Word text_find_declared(const char *text, Word name, const char *before);
// The next name of a file that an `#include` at or behind `from` asks for, without its quotes.
Word text_next_include(const char *from);

// A range from a place on, as JSON.
void text_write_range(FILE *out, const char *text, const char *begin, const char *end);

// The path of a URI of the scheme file; NULL: it has another one, or out of memory. To be freed.
char *text_path_of_uri(const char *uri);
void text_write_uri(FILE *out, const char *path); // with quotes

#endif
