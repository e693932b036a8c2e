// The text form of a diagnostic: place, label and message, the source line with a caret, help and notes.
//
// Owns nothing. Knows nothing of where the text goes.
//
// SPDX-License-Identifier: MIT
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "base/diag.h"
#include "base/utf8.h"

#define PROGRAM "rtlang"
#define GUTTER  "     " // as wide as the line number and the blank behind it

// Nothing in a scene or a file name may steer the terminal.
static void append_visible(TextBuffer *out, const char *text, size_t length, bool keeps_tabs)
{
    const char *end = text + length;
    while (text < end) {
        size_t visible = utf8_visible(text, end);
        if (visible > 0) {
            text_append_n(out, text, visible);
        } else {
            text_append_char(out, keeps_tabs && *text == '\t' ? '\t' : '?');
        }
        text += visible > 0 ? visible : 1;
    }
}

// Blanks as wide as the text up to the caret, then the caret and a tilde for each further character of the span.
static void append_caret(TextBuffer *out, const SourceLocation *location)
{
    const char *at = location->text, *end = at + location->text_length;
    const char *begin = at + location->caret_begin, *stop = location->text + location->caret_end;
    while (at < begin) {
        size_t visible = utf8_visible(at, end);
        text_append_char(out, *at == '\t' ? '\t' : ' ');
        at += visible > 0 ? visible : 1;
    }
    text_append_char(out, '^');
    for (bool is_first = true; at < stop; is_first = false) {
        size_t visible = utf8_visible(at, end);
        if (!is_first) {
            text_append_char(out, '~');
        }
        at += visible > 0 ? visible : 1;
    }
    text_append_char(out, '\n');
}

// Writes `place: label: message`, then the source line and the caret if the span can be found.
static void append_entry(DiagSink *sink, Span span, const char *label, const char *message, TextBuffer *out)
{
    SourceLocation location = {0};
    bool is_located = span_exists(span) && sink->sources && source_locate(sink->sources, span, &location);
    const char *name = location.name ? location.name : PROGRAM;
    append_visible(out, name, strlen(name), false);
    if (is_located) {
        text_printf(out, ":%" PRIu64 ":%" PRIu64, location.line, location.column);
    }
    text_printf(out, ": %s: ", label);
    append_visible(out, message, strlen(message), false);
    text_append_char(out, '\n');
    if (is_located) {
        size_t before = out->length;
        text_printf(out, "%4" PRIu64 " | ", location.line);
        int gutter = (int)(out->length - before) - 2;
        append_visible(out, location.text, location.text_length, true);
        text_printf(out, "\n%*s| ", gutter, "");
        append_caret(out, &location);
    }
}

static void append_help(TextBuffer *out, const char *label, const char *message)
{
    text_printf(out, GUTTER "= %s: ", label);
    append_visible(out, message, strlen(message), false);
    text_append_char(out, '\n');
}

void diag_print(DiagSink *sink, const Diag *diag, TextBuffer *out)
{
    char label[32];
    bool has_code = diag->code < DIAG_CODE_COUNT;
    snprintf(label, sizeof(label), "%s%s%s%s", diag_severity_name(diag->severity), has_code ? "[" : "",
             has_code ? diag_code_name(diag->code) : "", has_code ? "]" : "");
    append_entry(sink, diag->span, label, diag->message, out);
    if (diag->suggestion) {
        append_help(out, "help", diag->suggestion);
    }
    for (size_t i = 0; i < diag->note_count; i++) {
        const DiagNote *note = &diag->notes[i];
        if (span_exists(note->span)) {
            append_entry(sink, note->span, "note", note->message, out);
        } else {
            append_help(out, "note", note->message);
        }
    }
}
