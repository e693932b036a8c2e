// TextBuffer: text that grows while it is printed into; the printable forms of all stages are written with it.
//
// A buffer that ran out of memory stays valid, keeps what it holds and remembers the failure, so that a printer
// need not check each call: it asks once, at the end.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_TEXT_H
#define BASE_TEXT_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/attributes.h"

typedef struct TextBuffer {
    char *text; // zero-terminated; NULL while nothing has been written
    size_t length, capacity;
    bool failed; // memory ran out: something is missing at the end
} TextBuffer;

void text_init(TextBuffer *buffer);
void text_fini(TextBuffer *buffer);
void text_clear(TextBuffer *buffer); // keeps the memory
void text_append(TextBuffer *buffer, const char *text);
void text_append_n(TextBuffer *buffer, const char *text, size_t length);
void text_append_char(TextBuffer *buffer, char c);
void text_printf(TextBuffer *buffer, const char *format, ...) RT_PRINTF(2, 3);
void text_vprintf(TextBuffer *buffer, const char *format, va_list arguments) RT_PRINTF(2, 0);

// A character up to U+FFFF, surrogates too, in UTF-8.
void text_append_utf8(TextBuffer *buffer, unsigned point);

// What the escape at the beginning of the text stands for: `\n` and the like, `\uNNNN` in UTF-8, with a mark before it
// where it is no ASCII. Returns the length of the escape, 0 when it means nothing (then nothing is appended).
#define TEXT_MARK ((char)0xFF)
size_t text_append_escape(TextBuffer *buffer, const char *text, size_t length);

// The shortest decimal form that reads back as the same double, with `.` whatever the locale.
// Plain (`3`, `0.25`) from 1e-6 up to below 1e21, else `1.5e-7`, `1e21`.
// Not for NaN or infinity (written as `nan`, `inf`, `-inf`).
void text_append_double(TextBuffer *buffer, double value);

// Words and a line break at the end, broken between words so that no line is longer than `columns` if its words are not.
// The first line has `column` characters already; the others begin with `indent` spaces.
void text_append_wrapped(TextBuffer *buffer, const char *words, size_t column, size_t indent, size_t columns);

// The text so far, "" when empty; valid until the next call.
const char *text_get(const TextBuffer *buffer);

#endif
