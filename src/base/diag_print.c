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
#define STRONG  "\033[1m" // escape sequences of ECMA-48, as every terminal of today knows them
#define RED     "\033[1;31m"
#define GREEN   "\033[1;32m"
#define YELLOW  "\033[1;33m"
#define BLUE    "\033[1;34m"
#define CYAN    "\033[1;36m"
#define PLAIN   "\033[0m"
#define GUTTER  "     " // as wide as the line number and the blank behind it

// Where the text goes, and whether it is coloured.
typedef struct Printer {
    DiagSink *sink;
    TextBuffer *out;
    bool is_colored;
} Printer;

static void begin_color(const Printer *printer, const char *color)
{
    text_append(printer->out, printer->is_colored ? color : "");
}

static void end_color(const Printer *printer)
{
    begin_color(printer, PLAIN);
}

static const char *color_of(DiagSeverity severity)
{
    return severity == DIAG_ERROR ? RED : severity == DIAG_NOTE ? CYAN : YELLOW;
}

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
static void append_caret(const Printer *printer, const SourceLocation *location, const char *color)
{
    TextBuffer *out = printer->out;
    const char *at = location->text, *end = at + location->text_length;
    const char *begin = at + location->caret_begin, *stop = location->text + location->caret_end;
    while (at < begin) {
        size_t visible = utf8_visible(at, end);
        text_append_char(out, *at == '\t' ? '\t' : ' ');
        at += visible > 0 ? visible : 1;
    }
    begin_color(printer, color);
    text_append_char(out, '^');
    for (bool is_first = true; at < stop; is_first = false) {
        size_t visible = utf8_visible(at, end);
        if (!is_first) {
            text_append_char(out, '~');
        }
        at += visible > 0 ? visible : 1;
    }
    end_color(printer);
    text_append_char(out, '\n');
}

static void append_line(const Printer *printer, const SourceLocation *location, const char *color)
{
    char number[32];
    int gutter = snprintf(number, sizeof number, "%4" PRIu64 " ", location->line);
    begin_color(printer, BLUE);
    text_printf(printer->out, "%s|", number);
    end_color(printer);
    text_append_char(printer->out, ' ');
    append_visible(printer->out, location->text, location->text_length, true);
    text_append_char(printer->out, '\n');
    begin_color(printer, BLUE);
    text_printf(printer->out, "%*s|", gutter, "");
    end_color(printer);
    text_append_char(printer->out, ' ');
    append_caret(printer, location, color);
}

static void append_label(const Printer *printer, const char *label, const char *color, const char *message)
{
    bool is_head = strcmp(color, RED) == 0 || strcmp(color, YELLOW) == 0;
    begin_color(printer, color);
    text_printf(printer->out, "%s:", label);
    end_color(printer);
    text_append_char(printer->out, ' ');
    begin_color(printer, is_head ? STRONG : "");
    append_visible(printer->out, message, strlen(message), false);
    begin_color(printer, is_head ? PLAIN : "");
    text_append_char(printer->out, '\n');
}

// Writes `place: label: message`, then the source line and the caret if the span can be found.
static void append_entry(const Printer *printer, Span span, const char *label, const char *color, const char *message)
{
    SourceMap *sources = printer->sink->sources;
    SourceLocation location = {0};
    bool is_located = span_exists(span) && sources && source_locate(sources, span, &location);
    const char *name = location.name ? location.name : PROGRAM;
    begin_color(printer, STRONG);
    append_visible(printer->out, name, strlen(name), false);
    if (is_located) {
        text_printf(printer->out, ":%" PRIu64 ":%" PRIu64, location.line, location.column);
    }
    text_append_char(printer->out, ':');
    end_color(printer);
    text_append_char(printer->out, ' ');
    append_label(printer, label, color, message);
    if (is_located) {
        append_line(printer, &location, color);
    }
}

static void append_help(const Printer *printer, const char *label, const char *color, const char *message)
{
    begin_color(printer, BLUE);
    text_append(printer->out, GUTTER "=");
    end_color(printer);
    text_append_char(printer->out, ' ');
    append_label(printer, label, color, message);
}

void diag_print(DiagSink *sink, const Diag *diag, bool is_colored, TextBuffer *out)
{
    Printer printer = {sink, out, is_colored};
    char label[32];
    bool has_code = diag->code < DIAG_CODE_COUNT;
    snprintf(label, sizeof(label), "%s%s%s%s", diag_severity_name(diag->severity), has_code ? "[" : "",
             has_code ? diag_code_name(diag->code) : "", has_code ? "]" : "");
    append_entry(&printer, diag->span, label, color_of(diag->severity), diag->message);
    if (diag->suggestion) {
        append_help(&printer, "help", GREEN, diag->suggestion);
    }
    for (size_t i = 0; i < diag->note_count; i++) {
        const DiagNote *note = &diag->notes[i];
        if (span_exists(note->span)) {
            append_entry(&printer, note->span, "note", CYAN, note->message);
        } else {
            append_help(&printer, "note", CYAN, note->message);
        }
    }
}
