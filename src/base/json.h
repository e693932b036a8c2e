// Values of JSON as text.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_JSON_H
#define BASE_JSON_H

#include <stdio.h>

#include "base/text.h"

// A string in quotes. Bytes that are no UTF-8 become U+FFFD.
void json_string(TextBuffer *out, const char *text, size_t length);
void json_write_text(FILE *out, const char *text, size_t length);

// The shortest form that reads back as the same double. JSON has no infinity and no NaN: null stands for them.
void json_number(TextBuffer *out, double value);

#endif
