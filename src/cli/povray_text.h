// A text of options while it is read: a file's or the command line's, and messages about its places.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_POVRAY_TEXT_H
#define CLI_POVRAY_TEXT_H

#include <stdbool.h>
#include <stddef.h>

#include "cli/povray_table.h"
#include "rtlang/rtlang.h"

typedef struct PovrayText {
    rt_session *session;
    PovraySettings *settings;
    const char *name; // of the file, as messages have it
    const char *text;
    const char *path;             // resolved, to know a file again; NULL: the command line
    const struct PovrayText *outer; // the text that named this one
    bool is_usual;                // POV-Ray's own povray.ini, whose library the session searches anyway
    bool is_unnamed;              // ./povray.ini, which lies there without anybody having named it
} PovrayText;

// Bytes of the text.
typedef struct PovraySpan {
    size_t begin, end;
} PovraySpan;

enum { POVRAY_MESSAGE = 512, POVRAY_ADVICE = 160 };

__attribute__((format(printf, 5, 6))) rt_status povray_fault(const PovrayText *text, const char *code, PovraySpan span,
                                                             const char *advice, const char *format, ...);

// A copy of a part of the text, owned by the settings; NULL when out of memory. Quotes around it are left out.
const char *povray_keep(const PovrayText *text, PovraySpan span);

// Sets one option. `key` is where the option stands, `value` what it is set to; of no length: nothing was given.
rt_status povray_set(const PovrayText *text, const PovrayRow *row, PovraySpan key, PovraySpan value);
// The same for an option that is on or off by a sign.
rt_status povray_set_flag(const PovrayText *text, const PovrayRow *row, PovraySpan key, bool on);

// Reads a file of options that is named in `span`, which may end with a [section].
rt_status povray_read_file(const PovrayText *outer, PovraySpan span);

#endif
