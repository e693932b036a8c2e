// What a file is that is not a scene, by the bytes that it begins with.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_MAGIC_H
#define BASE_MAGIC_H

#include <stdbool.h>
#include <stddef.h>

typedef struct Magic {
    const char *signature; // `?` stands for any byte
    size_t length;
    const char *kind; // "a PNG picture"
    const char *help; // what to do about it; NULL: nothing
    bool is_text;     // such a file may have no byte that a scene cannot have, and no scene begins so
} Magic;

// For a file that holds bytes that no text has; NULL: unknown.
const Magic *magic_of_bytes(const char *bytes, size_t length);
// For one that may be a text, if no scene begins like that; else NULL.
const Magic *magic_of_text(const char *bytes, size_t length);

#endif
