// Diagnostics: keeps what was reported, up to a number, and counts the rest.
//
// Owns the records and all text in them, and the table of codes. Knows nothing of how a record is written.
//
// SPDX-License-Identifier: MIT
#include "base/diag.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/array.h"

enum { KEEP_ERRORS = 20, KEEP_WARNINGS = 100, KEEP_ALIKE = 5, FRAMES_SHOWN = 8 };

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

DiagSeverity diag_code_severity(DiagCode code)
{
    return codes[code].severity == DIAG_ERROR ? DIAG_ERROR : DIAG_WARNING;
}

DiagClass diag_code_class(DiagCode code)
{
    return codes[code].class;
}

bool diag_code_is_extra(DiagCode code)
{
    return codes[code].severity == DIAG_EXTRA;
}

const char *diag_severity_name(DiagSeverity severity)
{
    return severity == DIAG_ERROR ? "error" : severity == DIAG_NOTE ? "note" : "warning";
}

void diag_init(DiagSink *sink, SourceMap *sources)
{
    *sink = (DiagSink){
        .sources = sources, .keep_errors = KEEP_ERRORS, .keep_warnings = KEEP_WARNINGS, .keep_alike = KEEP_ALIKE};
    for (size_t code = 0; code < DIAG_CODE_COUNT; code++) {
        sink->levels[code] = codes[code].severity == DIAG_EXTRA ? 0 : DIAG_ON;
    }
}

static void records_free(DiagSink *sink)
{
    for (size_t i = 0; i < sink->count; i++) {
        Diag *diag = &sink->items[i];
        for (size_t k = 0; k < diag->note_count; k++) {
            free(diag->notes[k].message);
            free(diag->notes[k].name);
        }
        free(diag->notes);
        free(diag->message);
        free(diag->suggestion);
        free(diag->replacement);
    }
    ARRAY_FREE(sink);
}

void diag_fini(DiagSink *sink)
{
    records_free(sink);
    diag_init(sink, sink->sources);
}

void diag_restart(DiagSink *sink)
{
    records_free(sink);
    sink->error_count = sink->warning_count = sink->kept_warnings = 0;
    sink->class = CLASS_NONE;
    sink->out_of_memory = false;
    memset(sink->dropped, 0, sizeof sink->dropped);
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

// Puts a note before the last `behind` ones. Takes the note's texts; without a message memory ran out.
static void note_insert(DiagSink *sink, Diag *diag, DiagNote note, size_t behind)
{
    size_t count = diag->note_count;
    DiagNote *notes = note.message ? realloc(diag->notes, (count + 1) * sizeof(*notes)) : NULL;
    if (!notes) {
        sink->out_of_memory = true;
        free(note.message);
        free(note.name);
        return;
    }
    DiagNote *place = notes + (count - behind);
    memmove(place + 1, place, behind * sizeof(*notes));
    *place = note;
    diag->notes = notes;
    diag->note_count = count + 1;
}

static char *text_format(DiagSink *sink, const char *format, ...) RT_PRINTF(2, 3);
static char *text_format(DiagSink *sink, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *text = text_new(sink, format, arguments);
    va_end(arguments);
    return text;
}

static void frame_note(DiagSink *sink, Diag *diag, const DiagFrame *frame)
{
    DiagNote note = {.span = frame->span, .what = frame->what};
    if (frame->name) {
        const char *here = strcmp(frame->what, "in macro") == 0 ? ", called here" : " here";
        note.name = text_format(sink, "%s", frame->name);
        note.message = text_format(sink, "%s `%s`%s", frame->what, frame->name, here);
    } else {
        note.message = text_format(sink, "%s here", frame->what);
    }
    note_insert(sink, diag, note, 0);
}

static void frames_copy(DiagSink *sink, Diag *diag)
{
    const DiagFrame *frame = sink->frame;
    for (int shown = 0; frame && shown < FRAMES_SHOWN; shown++, frame = frame->outer) {
        frame_note(sink, diag, frame);
    }
    size_t more = 0;
    for (; frame; frame = frame->outer) {
        more++;
    }
    if (more > 0) {
        note_insert(sink, diag, (DiagNote){.message = text_format(sink, "and %zu more", more), .what = "more"}, 0);
    }
    sink->frame_note_count = diag->note_count;
}

// ---- which warnings count

// The part of a text after a beginning, or NULL.
static const char *after(const char *text, const char *beginning)
{
    size_t length = strlen(beginning);
    return strncmp(text, beginning, length) == 0 ? text + length : NULL;
}

bool diag_set_warning(DiagSink *sink, const char *what)
{
    const char *taken_back = after(what, "no-");
    what = taken_back ? taken_back : what;
    const char *fatal = after(what, "error");
    const char *name = fatal && *fatal == '=' ? fatal + 1 : what;
    bool means_all = strcmp(what, "error") == 0 || strcmp(what, "all") == 0, is_known = means_all;
    uint8_t level = fatal ? DIAG_FATAL : DIAG_ON;
    for (size_t code = 0; code < DIAG_CODE_COUNT; code++) {
        bool is_warning = codes[code].severity != DIAG_ERROR;
        bool is_extra = codes[code].severity == DIAG_EXTRA;
        bool is_meant = means_all ? fatal || is_extra : strcasecmp(codes[code].name, name) == 0;
        if (is_warning && is_meant) {
            uint8_t levels = sink->levels[code];
            uint8_t added = fatal && !means_all ? DIAG_FATAL | DIAG_ON : level;
            sink->levels[code] = (uint8_t)(taken_back ? levels & ~level : levels | added);
            is_known = true;
        }
    }
    return is_known;
}

bool diag_is_on(const DiagSink *sink, DiagCode code)
{
    return (sink->levels[code] & DIAG_ON) != 0;
}

// Whether a warning is one too many of those that say the same.
static bool is_repeated(const DiagSink *sink, DiagCode code, const char *message)
{
    size_t alike = 0;
    for (size_t i = 0; i < sink->count; i++) {
        const Diag *kept = &sink->items[i];
        alike += kept->code == code && kept->severity == DIAG_WARNING && strcmp(kept->message, message) == 0;
    }
    return alike >= sink->keep_alike;
}

// Counts a report; true when there is room for its record.
static bool report_count(DiagSink *sink, const Diag *diag)
{
    if (diag->severity == DIAG_WARNING) {
        sink->warning_count++;
        return sink->kept_warnings < sink->keep_warnings;
    }
    // What a limit stops was not looked at whole, whatever was found before.
    if (sink->error_count == 0 || diag->class == CLASS_LIMIT) {
        sink->class = diag->class;
    }
    return sink->error_count++ < sink->keep_errors;
}

// Keeps a record. Takes its message.
static bool record_keep(DiagSink *sink, Diag diag)
{
    if (!diag.message || !ARRAY_PUSH(sink, diag)) {
        free(diag.message);
        sink->out_of_memory = true;
        return false;
    }
    sink->kept_warnings += diag.severity == DIAG_WARNING;
    return true;
}

bool diag_report(DiagSink *sink, DiagCode code, Span span, const char *format, ...)
{
    const CodeInfo *info = &codes[code];
    Diag diag = {.code = code, .severity = diag_code_severity(code), .class = info->class, .span = span};
    if (!diag_is_on(sink, code)) {
        return false;
    }
    if (sink->levels[code] & DIAG_FATAL) {
        diag.severity = DIAG_ERROR;
        diag.class = CLASS_SCENE;
    }
    sink->reported[code]++;
    if (!report_count(sink, &diag)) {
        sink->dropped[code]++;
        return false;
    }
    va_list arguments;
    va_start(arguments, format);
    diag.message = text_new(sink, format, arguments);
    va_end(arguments);
    if (diag.severity == DIAG_WARNING && diag.message && is_repeated(sink, code, diag.message)) {
        free(diag.message);
        sink->dropped[code]++;
        return false;
    }
    if (!record_keep(sink, diag)) {
        return false;
    }
    frames_copy(sink, &sink->items[sink->count - 1]);
    return true;
}

// ---- additions to the last record

void diag_note(DiagSink *sink, Span span, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *message = text_new(sink, format, arguments);
    note_insert(sink, &sink->items[sink->count - 1], (DiagNote){.span = span, .message = message},
                sink->frame_note_count);
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

void diag_replace(DiagSink *sink, Span replaced, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    char *replacement = text_new(sink, format, arguments);
    va_end(arguments);
    if (replacement) {
        Diag *diag = &sink->items[sink->count - 1];
        free(diag->replacement);
        diag->replacement = replacement;
        diag->replaced = replaced;
    }
}

void diag_did_you_mean(DiagSink *sink, Span replaced, const char *word)
{
    diag_suggest(sink, "did you mean `%s`?", word);
    diag_replace(sink, replaced, "%s", word);
}

// ---- the end

void diag_finish(DiagSink *sink)
{
    bool has_dropped_error = false;
    for (int code = 0; code < DIAG_CODE_COUNT; code++) {
        size_t count = sink->dropped[code];
        bool is_error = codes[code].severity == DIAG_ERROR || sink->levels[code] & DIAG_FATAL;
        sink->dropped[code] = 0;
        has_dropped_error = has_dropped_error || (count > 0 && is_error);
        if (count > 0 && !is_error) {
            record_keep(sink, (Diag){.code = (DiagCode)code, .severity = DIAG_NOTE,
                                     .message = text_format(sink, "%zu more of this warning %s not shown: %s", count,
                                                            count == 1 ? "is" : "are", codes[code].summary)});
        }
    }
    if (has_dropped_error) {
        record_keep(sink, (Diag){.code = DIAG_CODE_COUNT, .severity = DIAG_NOTE,
                                 .message = text_format(sink, "stopped after %zu errors; there may be more",
                                                        sink->keep_errors)});
    }
}

bool diag_is_full(const DiagSink *sink)
{
    return sink->error_count > sink->keep_errors;
}

