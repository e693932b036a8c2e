// Escapes and numbers as RFC 8259 wants them.
//
// SPDX-License-Identifier: MIT
#include "base/json.h"

#include <math.h>

#include "base/utf8.h"

void json_string(TextBuffer *out, const char *text, size_t length)
{
    const char *end = text + length;
    text_append_char(out, '"');
    while (text < end) {
        size_t size = utf8_length(text, end);
        if (size == 0) {
            text_append(out, "\\ufffd");
        } else if (*text == '"' || *text == '\\') {
            text_printf(out, "\\%c", *text);
        } else if ((unsigned char)*text < 0x20) {
            text_printf(out, "\\u%04x", (unsigned)*text);
        } else {
            text_append_n(out, text, size);
        }
        text += size > 0 ? size : 1;
    }
    text_append_char(out, '"');
}

void json_write_text(FILE *out, const char *text, size_t length)
{
    TextBuffer buffer;

    text_init(&buffer);
    json_string(&buffer, text, length);
    fputs(text_get(&buffer), out);
    text_fini(&buffer);
}

void json_number(TextBuffer *out, double value)
{
    if (isfinite(value)) {
        text_append_double(out, value + 0.0); // no -0
    } else {
        text_append(out, "null");
    }
}
