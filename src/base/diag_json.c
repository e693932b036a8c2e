// The form of a diagnostic for programs: one JSON object on one line.
//
// Owns nothing. Knows nothing of where the line goes.
//
// SPDX-License-Identifier: MIT
#include <inttypes.h>
#include <string.h>

#include "base/diag.h"
#include "base/json.h"

static void append_member(TextBuffer *out, const char *name, const char *text)
{
    text_printf(out, ",\"%s\":", name);
    if (text) {
        json_string(out, text, strlen(text));
    } else {
        text_append(out, "null");
    }
}

// `"file":…` to `"end_column":…`; null where it is not known.
static void append_place(DiagSink *sink, Span span, TextBuffer *out)
{
    SourceLocation begin = {0}, end = {0};
    bool has_begin = span_exists(span) && sink->sources && source_locate(sink->sources, span, &begin);
    Span last = {span.end, span.end};
    append_member(out, "file", begin.name);
    if (!has_begin) {
        text_append(out, ",\"begin\":null,\"end\":null,\"line\":null,\"column\":null,\"end_line\":null,"
                         "\"end_column\":null");
        return;
    }
    text_printf(out, ",\"begin\":%" PRIu64 ",\"end\":%" PRIu64 ",\"line\":%" PRIu64 ",\"column\":%" PRIu64,
                begin.offset, begin.offset + (span.end - span.begin), begin.line, begin.column);
    if (!source_locate(sink->sources, last, &end)) {
        end = begin;
    }
    text_printf(out, ",\"end_line\":%" PRIu64 ",\"end_column\":%" PRIu64, end.line, end.column);
}

static void append_suggestion(DiagSink *sink, const Diag *diag, TextBuffer *out)
{
    if (!diag->suggestion) {
        text_append(out, ",\"suggestion\":null");
        return;
    }
    text_append(out, ",\"suggestion\":{\"message\":");
    json_string(out, diag->suggestion, strlen(diag->suggestion));
    append_member(out, "replacement", diag->replacement);
    if (diag->replacement) {
        append_place(sink, diag->replaced, out);
    }
    text_append_char(out, '}');
}

// Those that are of the call stack, or those that are not.
static void append_notes(DiagSink *sink, const Diag *diag, bool of_stack, TextBuffer *out)
{
    bool is_first = true;
    for (size_t i = 0; i < diag->note_count; i++) {
        const DiagNote *note = &diag->notes[i];
        if ((note->what != NULL) != of_stack) {
            continue;
        }
        text_append(out, is_first ? "{\"message\":" : ",{\"message\":");
        is_first = false;
        json_string(out, note->message, strlen(note->message));
        if (of_stack) {
            append_member(out, "kind", strcmp(note->what, "in macro") == 0   ? "macro"
                                       : strcmp(note->what, "included") == 0 ? "include"
                                                                             : "more");
            append_member(out, "name", note->name);
        }
        append_place(sink, note->span, out);
        text_append_char(out, '}');
    }
}

void diag_json(DiagSink *sink, const Diag *diag, TextBuffer *out)
{
    text_append(out, "{\"type\":\"diagnostic\"");
    append_member(out, "code", diag->code < DIAG_CODE_COUNT ? diag_code_name(diag->code) : NULL);
    append_member(out, "severity", diag_severity_name(diag->severity));
    append_member(out, "message", diag->message);
    append_place(sink, diag->span, out);
    text_append(out, ",\"notes\":[");
    append_notes(sink, diag, false, out);
    text_append(out, "],\"stack\":[");
    append_notes(sink, diag, true, out);
    text_append_char(out, ']');
    append_suggestion(sink, diag, out);
    text_append(out, "}\n");
}
