// The canonical layout of a file: made, compared with the file, and written.
//
// SPDX-License-Identifier: MIT
#include <errno.h>

#include <string.h>

#include "api/session.h"
#include "format/format.h"
#include "image/atomic_file.h"

static bool read_all(rt_session *session, Source *source, TextBuffer *text)
{
    char block[8 * 1024];
    ptrdiff_t length;
    while ((length = source_read(source, block, sizeof block)) > 0) {
        text_append_n(text, block, (size_t)length);
    }
    if (length < 0 && errno != ECANCELED) { // see source_map_set_cancel
        diag_report(&session->diags, DIAG_E0502, SPAN_NONE, "cannot read `%s`", source_name(source));
    } else if (text->failed) {
        diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory reading `%s`", source_name(source));
    }
    return length == 0 && !text->failed;
}

// The layout of the text of `source` into the session's dump.
static bool lay_out(rt_session *session, Source *source, const TextBuffer *text)
{
    Arena arena;
    arena_init(&arena, session->limits.memory_most);
    GrammarContext context = {session->names, &arena, &session->diags, &session->limits, NULL,
                              session->no_literals, NULL};
    bool fine = format_source(&context, source, text_get(text), text->length, &session->cancel,
                              &session->dump);
    arena_fini(&arena);
    if (!fine) {
        text_clear(&session->dump);
    }
    return fine;
}

typedef struct LayOut {
    Source *source;
    const TextBuffer *text;
} LayOut;

static rt_status run_lay_out(rt_session *session, void *argument)
{
    const LayOut *job = argument;
    return lay_out(session, job->source, job->text) ? RT_OK : session_status(session, false);
}

// Reads the file into `text`, and opens that again as *source, so that it need not be read twice.
static bool open_text(rt_session *session, const char *path, TextBuffer *text, Source **source)
{
    Source *file;
    text_clear(&session->dump);
    if (!session_open(session, path, &file)) {
        return false;
    }
    bool fine = read_all(session, file, text);
    source_close(file);
    if (!fine) {
        return false;
    }
    *source = source_open_text(session->sources, path, text_get(text), text->length);
    if (!*source) {
        diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory reading `%s`", path);
    }
    return *source;
}

// The layout of a file, into the session's dump, and whether the file is in that layout.
static bool format_file(rt_session *session, const char *path, size_t *first_difference, Source **source)
{
    TextBuffer text;
    text_init(&text);
    bool fine = open_text(session, path, &text, source) &&
                session_run_deep(session, run_lay_out, &(LayOut){*source, &text}) == RT_OK;
    if (fine) {
        const char *laid_out = text_get(&session->dump), *found = text_get(&text);
        size_t i = 0;
        while (i < text.length && i < session->dump.length && found[i] == laid_out[i]) {
            i++;
        }
        *first_difference = i == text.length && i == session->dump.length ? SIZE_MAX : i;
    }
    text_fini(&text);
    return fine;
}

rt_status rt_format_file(rt_session *session, const char *path, const char **text)
{
    size_t first_difference;
    Source *source;
    bool fine = format_file(session, path, &first_difference, &source);
    *text = text_get(&session->dump);
    return session_status(session, fine);
}

rt_status rt_format_text(rt_session *session, const char *name, const char *text, size_t length, const char **laid_out)
{
    TextBuffer copy;
    Source *source = source_open_text(session->sources, name, text, length);
    text_init(&copy);
    text_append_n(&copy, text, length);
    text_clear(&session->dump);
    bool fine = source && !copy.failed;
    if (!fine) {
        diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory reading `%s`", name);
    }
    fine = fine && session_run_deep(session, run_lay_out, &(LayOut){source, &copy}) == RT_OK;
    text_fini(&copy);
    *laid_out = text_get(&session->dump);
    return session_status(session, fine);
}

rt_status rt_check_format(rt_session *session, const char *path)
{
    size_t at = SIZE_MAX;
    Source *source;
    bool fine = format_file(session, path, &at, &source);
    if (fine && at != SIZE_MAX) {
        Span span = {source_base(source) + at, source_base(source) + at};
        if (diag_report(&session->diags, DIAG_E0120, span, "`%s` is not in the canonical layout from here on", path)) {
            diag_suggest(&session->diags, "rtlang --format -o %s %s", path, path);
        }
        fine = false;
    }
    return session_status(session, fine);
}

rt_status rt_write_text(rt_session *session, const char *path)
{
    ImageError error = {.no_memory = false};
    AtomicFile file;
    bool fine = atomic_file_open(&file, path, &error);
    if (fine && !atomic_file_write(&file, text_get(&session->dump), session->dump.length, &error)) {
        atomic_file_abandon(&file);
        fine = false;
    }
    fine = fine && atomic_file_commit(&file, &error);
    return session_image_fault(session, fine ? IMAGE_OK : IMAGE_IO, path, &error);
}
