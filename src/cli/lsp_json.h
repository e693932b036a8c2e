// JSON (RFC 8259) as messages of the Language Server Protocol need it: a value is found by its path in the text, without a
// tree of it.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_LSP_JSON_H
#define CLI_LSP_JSON_H

#include <stdbool.h>
#include <stddef.h>

// A value within a message; NULL: there is none.
typedef struct Json {
    const char *begin, *end;
} Json;

// The whole of a message, if it is one JSON value and nothing else, nested at most 100 deep.
Json json_whole(const char *text, size_t length);
// By names of members with dots between, "params.textDocument.uri"; `$` is the last element of an array.
Json json_at(Json value, const char *path);
// A text without its escapes, to be freed; NULL when it is none or out of memory.
char *json_take_text(Json value);
// A whole number from 0 that an int holds; -1: it is none.
int json_take_count(Json value);

#endif
