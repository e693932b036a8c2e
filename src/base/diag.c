// Diagnostics: keeps what was reported, up to a number, and writes a record as text with its source line.
//
// Owns the records and all text in them. Knows nothing of where the text form goes.
//
// SPDX-License-Identifier: MIT
#include "base/diag.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"

enum { KEEP_ERRORS = 20, KEEP_WARNINGS = 100, FRAMES_SHOWN = 8 };

#define PROGRAM "rtlang"
#define GUTTER  "     " // as wide as the line number and the blank behind it

typedef struct CodeInfo {
    const char *name, *summary;
    DiagSeverity severity;
    DiagClass class;
} CodeInfo;

static const CodeInfo codes[] = {
#define DIAG(code, severity, class, summary) {#code, summary, severity, class},
#include "base/diag_codes.def"
#undef DIAG
};

const char *diag_code_name(DiagCode code)
{
    return codes[code].name;
}

const char *diag_code_summary(DiagCode code)
{
    return codes[code].summary;
}

void diag_init(DiagSink *sink, SourceMap *sources)
{
    *sink = (DiagSink){.sources = sources, .keep_errors = KEEP_ERRORS, .keep_warnings = KEEP_WARNINGS};
}

void diag_fini(DiagSink *sink)
{
    for (size_t i = 0; i < sink->count; i++) {
        Diag *diag = &sink->items[i];
        for (size_t k = 0; k < diag->note_count; k++) {
            free(diag->notes[k].message);
        }
        free(diag->notes);
        free(diag->message);
        free(diag->suggestion);
    }
    ARRAY_FREE(sink);
    diag_init(sink, sink->sources);
}

// A text of its own, or NULL and out_of_memory.
static char *text_new(DiagSink *sink, const char *format, va_list arguments) RT_PRINTF(2, 0);
static char *text_new(DiagSink *sink, const char *format, va_list arguments)
{
    TextBuffer buffer;
    text_init(&buffer);
    text_vprintf(&buffer, format, arguments);
    if (buffer.failed) {
        text_fini(&buffer);
        sink->out_of_memory = true;
    }
    return buffer.text;
}

// Puts a note before the last `behind` ones. Takes the message, which may be NULL when memory ran out.
static void note_insert(DiagSink *sink, Diag *diag, Span span, char *message, size_t behind)
{
    size_t count = diag->note_count;
    DiagNote *notes = message ? realloc(diag->notes, (count + 1) * sizeof(*notes)) : NULL;
    if (!notes) {
        sink->out_of_memory = true;
        free(message);
        return;
    }
    DiagNote *place = notes + (count - behind);
    memmove(place + 1, place, behind * sizeof(*notes));
    *place = (DiagNote){span, message};
    diag->notes = notes;
    diag->note_count = count + 1;
}

static void frame_note(DiagSink *sink, Diag *diag, Span span, const char *format, ...) RT_PRINTF(4, 5);
static void frame_note(DiagSink *sink, Diag *diag, Span span, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    note_insert(sink, diag, span, text_new(sink, format, arguments), 0);
    va_end(arguments);
}

static void frames_copy(DiagSink *sink, Diag *diag)
{
    const DiagFrame *frame = sink->frame;
    for (int shown = 0; frame && shown < FRAMES_SHOWN; shown++, frame = frame->outer) {
        const char *here = strcmp(frame->what, "in macro") == 0 ? ", called here" : " here";
        if (frame->name) {
            frame_note(sink, diag, frame->span, "%s `%s`%s", frame->what, frame->name, here);
        } else {
            frame_note(sink, diag, frame->span, "%s%s", frame->what, here);
        }
    }
    size_t more = 0;
    for (; frame; frame = frame->outer) {
        more++;
    }
    if (more > 0) {
        frame_note(sink, diag, SPAN_NONE, "and %zu more", more);
    }
    sink->frame_note_count = diag->note_count;
}

// Counts a report; true when its record is to be kept.
static bool report_count(DiagSink *sink, const CodeInfo *info)
{
    if (info->severity == DIAG_WARNING) {
        return sink->warning_count++ < sink->keep_warnings;
    }
    if (sink->error_count == 0) {
        sink->class = info->class;
    }
    return sink->error_count++ < sink->keep_errors;
}

bool diag_report(DiagSink *sink, DiagCode code, Span span, const char *format, ...)
{
    const CodeInfo *info = &codes[code];
    if (!report_count(sink, info)) {
        return false;
    }
    va_list arguments;
    va_start(arguments, format);
    char *message = text_new(sink, format, arguments);
    va_end(arguments);
    Diag diag = {.code = code, .severity = info->severity, .class = info->class, .span = span, .message = message};
    if (!message || !ARRAY_PUSH(sink, diag)) {
        free(message);
        sink->out_of_memory = true;
        return false;
    }
    frames_copy(sink, &sink->items[sink->count - 1]);
    return true;
}

void diag_note(DiagSink *sink, Span span, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *message = text_new(sink, format, arguments);
    note_insert(sink, &sink->items[sink->count - 1], span, message, sink->frame_note_count);
    va_end(arguments);
}

void diag_suggest(DiagSink *sink, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *suggestion = text_new(sink, format, arguments);
    va_end(arguments);
    if (suggestion) {
        Diag *diag = &sink->items[sink->count - 1];
        free(diag->suggestion);
        diag->suggestion = suggestion;
    }
}

bool diag_is_full(const DiagSink *sink)
{
    return sink->error_count > sink->keep_errors;
}

// The length of the well-formed, visible UTF-8 character (Unicode 15, table 3-7) at `text`; 0 for all else.
static size_t visible_length(const char *text, const char *end)
{
    const unsigned char *at = (const unsigned char *)text;
    size_t room = (size_t)(end - text);
    if (at[0] < 0x80) {
        return at[0] >= 0x20 && at[0] != 0x7F ? 1 : 0;
    }
    size_t length = at[0] < 0xC2 || at[0] > 0xF4 ? 0 : at[0] < 0xE0 ? 2 : at[0] < 0xF0 ? 3 : 4;
    if (length == 0 || length > room) {
        return 0;
    }
    unsigned low = at[0] == 0xC2 ? 0xA0 : at[0] == 0xE0 ? 0xA0 : at[0] == 0xF0 ? 0x90 : 0x80; // C2 80..9F are controls
    unsigned high = at[0] == 0xED ? 0x9F : at[0] == 0xF4 ? 0x8F : 0xBF;
    if (at[1] < low || at[1] > high) {
        return 0;
    }
    for (size_t i = 2; i < length; i++) {
        if ((at[i] & 0xC0) != 0x80) {
            return 0;
        }
    }
    return length;
}

// Nothing in a scene or a file name may steer the terminal.
static void append_visible(TextBuffer *out, const char *text, size_t length, bool keeps_tabs)
{
    const char *end = text + length;
    while (text < end) {
        size_t visible = visible_length(text, end);
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
        size_t visible = visible_length(at, end);
        text_append_char(out, *at == '\t' ? '\t' : ' ');
        at += visible > 0 ? visible : 1;
    }
    text_append_char(out, '^');
    for (bool is_first = true; at < stop; is_first = false) {
        size_t visible = visible_length(at, end);
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
    snprintf(label, sizeof(label), "%s[%s]", diag->severity == DIAG_ERROR ? "error" : "warning",
             diag_code_name(diag->code));
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
