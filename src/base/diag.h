// Diagnostics: what is to be reported about a scene or a run, recorded as plain data where the fact is known.
//
// Nothing here prints. A sink counts and keeps the records; diag_print turns one into the text form, diag_json into the
// form for programs. The codes stand in base/diag_codes.def; base/diag_texts.def explains each.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_DIAG_H
#define BASE_DIAG_H

#include <stdbool.h>
#include <stddef.h>

#include "base/attributes.h"
#include "base/source.h"
#include "base/text.h"

typedef enum DiagSeverity {
    DIAG_WARNING,
    DIAG_ERROR,
    DIAG_EXTRA, // in the table of codes only: a warning that must be asked for
    DIAG_NOTE,  // what diag_finish adds
} DiagSeverity;

// What kind of fault it is; also the program's exit code.
typedef enum DiagClass { CLASS_NONE = 0, CLASS_SCENE = 1, CLASS_USAGE = 2, CLASS_IO = 3, CLASS_LIMIT = 4 } DiagClass;

typedef enum DiagCode {
#define DIAG(code, severity, class, summary) DIAG_##code,
#include "base/diag_codes.def"
#undef DIAG
    DIAG_CODE_COUNT
} DiagCode;

// Why we are here: an #include, a macro call, a loop. Frames live on the caller's C stack; a record copies them as
// notes, innermost first: "in macro `Atom`, called here" for what = "in macro", else "<what> `<name>` here", for
// example "included `colors.inc` here". At most 8, then one note "and N more".
typedef struct DiagFrame {
    const struct DiagFrame *outer; // NULL at the outermost text
    const char *what;              // for example "in macro", "included"
    const char *name;              // for example the macro's name; may be NULL
    Span span;                     // the call or the #include
} DiagFrame;

typedef struct DiagNote {
    Span span;        // may be SPAN_NONE
    char *message;    // owned by the record
    const char *what; // of a note of the call stack, as in DiagFrame, or "more"; NULL for all others
    char *name;       // owned; the frame's name, or NULL
} DiagNote;

typedef struct Diag {
    DiagCode code; // DIAG_CODE_COUNT: none
    DiagSeverity severity;
    DiagClass class;
    Span span;         // may be SPAN_NONE
    char *message;     // owned, one line, no full stop
    char *suggestion;  // owned; NULL, or what to write instead, for example "did you mean `radius`?"
    char *replacement; // owned; NULL, or the text that the suggestion would put in the place of `replaced`
    Span replaced;     // empty where text is only put in
    DiagNote *notes;  // owned; the call stack stands at the end, innermost first
    size_t note_count;
} Diag;

typedef struct DiagSink {
    SourceMap *sources;     // not owned; for printing
    const DiagFrame *frame; // the present call stack; the evaluator keeps it
    Diag *items;
    size_t count, capacity;
    size_t error_count, warning_count; // all that were reported, kept or not
    size_t keep_errors, keep_warnings; // records beyond these are only counted
    size_t keep_alike;                 // so are warnings beyond this number of one code and message
    size_t kept_warnings;
    size_t dropped[DIAG_CODE_COUNT];   // reported and only counted, by code, since the last diag_finish
    size_t reported[DIAG_CODE_COUNT];  // all, by code
    uint8_t levels[DIAG_CODE_COUNT];   // DIAG_ON, DIAG_FATAL
    DiagClass class;                   // of the first error, or CLASS_LIMIT; CLASS_NONE while there is no error
    bool out_of_memory;                // a record, or a part of one, could not be kept
    size_t frame_note_count;           // of the record kept last: the notes at its end that are its call stack
} DiagSink;

// Of a code: whether it is reported, and whether as an error.
enum { DIAG_ON = 1, DIAG_FATAL = 2 };

// Keeps at most 20 errors, 100 warnings and 5 warnings that say the same, unless the caller sets keep_errors,
// keep_warnings and keep_alike. All codes but the extra ones are on.
void diag_init(DiagSink *sink, SourceMap *sources);
void diag_fini(DiagSink *sink);

// Forgets the records and what was counted towards the limits above, for a new task of one run; totals by code, levels
// and limits stay.
void diag_restart(DiagSink *sink);

// What warnings are reported, in the words of a command line: "all" adds the extra ones, "error" makes errors of all,
// "W0201" and "error=W0201" say the same of one, each with "no-" before it takes that back. False when it is none of
// these.
bool diag_set_warning(DiagSink *sink, const char *what) RT_MUST_CHECK;
bool diag_is_on(const DiagSink *sink, DiagCode code);

// Records a fault or a warning. True when the record was kept, so that notes and a suggestion may be added.
bool diag_report(DiagSink *sink, DiagCode code, Span span, const char *format, ...) RT_PRINTF(4, 5);

// Add to the record that was kept last. Call only after diag_report returned true.
void diag_note(DiagSink *sink, Span span, const char *format, ...) RT_PRINTF(3, 4);
void diag_suggest(DiagSink *sink, const char *format, ...) RT_PRINTF(2, 3);
// What the suggestion would put in the place of a span.
void diag_replace(DiagSink *sink, Span replaced, const char *format, ...) RT_PRINTF(3, 4);
// Both, for a mistyped word: "did you mean `word`?".
void diag_did_you_mean(DiagSink *sink, Span replaced, const char *word);

// Adds a record for all that was only counted since the last call, so that nothing is lost without a word. Call when a
// scene is done.
void diag_finish(DiagSink *sink);

// True when enough errors were reported to stop work (more than keep_errors).
bool diag_is_full(const DiagSink *sink);

const char *diag_code_name(DiagCode code);    // "E0203"
const char *diag_code_summary(DiagCode code); // "unknown word"
DiagSeverity diag_code_severity(DiagCode code); // DIAG_WARNING for the extra ones
DiagClass diag_code_class(DiagCode code);
bool diag_code_is_extra(DiagCode code);
const char *diag_severity_name(DiagSeverity severity); // "error", "warning", "note"

// The text form, each line ended by LF:
//
//     scene.scn:3:8: error[E0201]: unknown property `raduis` in sphere
//        3 |     raduis 2
//          |     ^~~~~~
//          = help: did you mean `radius`?
//     scene.scn:1:1: note: in macro `Atom`, called here
//        1 | Atom(<0,0,0>)
//          | ^~~~
//
// The line number takes 4 columns or more. Tabs of the source line stand in the caret line too; an empty span has a
// caret; a span over several lines ends with its first. Control characters and bytes that are not UTF-8 are shown as
// `?`. Where the line cannot be read, the head is `name: error[...]: ...`; without a span, `rtlang: error[...]: ...`;
// a note without a span is `     = note: ...`.
// `is_colored`: with the escape sequences of a terminal around the place, the label, the message and the caret; without
// them the text is the same.
void diag_print(DiagSink *sink, const Diag *diag, bool is_colored, TextBuffer *out);

// The form for programs: one JSON object (RFC 8259) on one line, ended by LF; its members are listed in
// docs/diagnostics.md. Bytes that are not UTF-8 become U+FFFD.
void diag_json(DiagSink *sink, const Diag *diag, TextBuffer *out);

#endif
