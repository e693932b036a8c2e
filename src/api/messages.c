// Messages of a session: diagnostics from the sink to the client's callback, and the status they amount to.
//
// SPDX-License-Identifier: MIT
#include "api/session.h"
#include "base/json.h"

#include <stdio.h>
#include <string.h>

#include "base/explain.h"
#include "base/suggest.h"

// What is said where no memory is left to say it with: nothing of it is made.
rt_status session_no_memory(rt_session *session)
{
    static const char plain[] = "rtlang: error[E0602]: out of memory\n";
    static const char json[] = "{\"type\":\"diagnostic\",\"code\":\"E0602\",\"severity\":\"error\","
                               "\"message\":\"out of memory\",\"file\":null,\"begin\":null,\"end\":null,\"line\":null,"
                               "\"column\":null,\"end_line\":null,\"end_column\":null,\"notes\":[],\"stack\":[],"
                               "\"suggestion\":null}\n";
    rt_diagnostic out = {.severity = RT_ERROR, .code = "E0602", .message = "out of memory",
                         .text = session->is_json ? json : plain};
    if (session->callbacks.diagnostic && !session->has_told_memory) {
        session->callbacks.diagnostic(session->callbacks.client, &out);
    }
    session->has_told_memory = true;
    return RT_FAULT_LIMIT;
}

static void deliver_one(rt_session *session, const Diag *diag, TextBuffer *text)
{
    SourceLocation location = {0};
    bool found = span_exists(diag->span) && source_locate(session->sources, diag->span, &location);
    rt_diagnostic out = {
        .severity = diag->severity == DIAG_ERROR ? RT_ERROR : diag->severity == DIAG_NOTE ? RT_NOTE : RT_WARNING,
        .code = diag->code < DIAG_CODE_COUNT ? diag_code_name(diag->code) : "",
        .message = diag->message,
        .file = location.name,
        .line = found ? location.line : 0,
        .column = found ? location.column : 0,
    };
    text_clear(text);
    if (session->is_json) {
        diag_json(&session->diags, diag, text);
    } else {
        diag_print(&session->diags, diag, session->is_colored, text);
    }
    if (text->failed) {
        session->diags.out_of_memory = true;
        return;
    }
    session->has_told_memory = session->has_told_memory || diag->code == DIAG_E0602;
    out.text = text_get(text);
    session->callbacks.diagnostic(session->callbacks.client, &out);
}

void session_deliver(rt_session *session)
{
    if (!session->callbacks.diagnostic) {
        session->diags_delivered = session->diags.count;
        return;
    }
    TextBuffer text;
    text_init(&text);
    while (session->diags_delivered < session->diags.count) {
        deliver_one(session, &session->diags.items[session->diags_delivered++], &text);
    }
    text_fini(&text);
}

static void say_json(rt_session *session, rt_stream stream)
{
    static const char *const names[] = {[RT_STREAM_DEBUG] = "debug",
                                        [RT_STREAM_WARNING] = "warning",
                                        [RT_STREAM_ERROR] = "error",
                                        [RT_STREAM_RENDER] = "render",
                                        [RT_STREAM_STATISTICS] = "statistics"};
    TextBuffer line;
    text_init(&line);
    text_printf(&line, "{\"type\":\"message\",\"stream\":\"%s\",\"text\":", names[stream]);
    json_string(&line, text_get(&session->said), session->said.length);
    text_append(&line, "}\n");
    if (line.failed || session->said.failed) {
        session->diags.out_of_memory = true;
    } else {
        session->callbacks.message(session->callbacks.client, stream, text_get(&line), line.length);
    }
    text_fini(&line);
    text_clear(&session->said);
}

void session_say(rt_session *session, rt_stream stream, const char *text, size_t length)
{
    if (!session->callbacks.message) {
        return;
    }
    if (!session->is_json) {
        session->callbacks.message(session->callbacks.client, stream, text, length);
        return;
    }
    // Lines come in parts, the last of which is their newline.
    bool is_ended = length > 0 && text[length - 1] == '\n';
    text_append_n(&session->said, text, is_ended ? length - 1 : length);
    if (is_ended) {
        say_json(session, stream);
    }
}

rt_status session_status(rt_session *session, bool fine)
{
    session_deliver(session);
    bool is_cancelled = session->diags.class == CLASS_NONE && atomic_load(&session->cancel);
    // A message was lost, or there was no memory even for the record of one.
    if (session->diags.out_of_memory || (!fine && !is_cancelled && session->diags.class == CLASS_NONE)) {
        return session_no_memory(session);
    }
    return fine ? RT_OK : is_cancelled ? RT_CANCELLED : (rt_status)session->diags.class;
}

rt_status rt_set_warning(rt_session *session, const char *what)
{
    return diag_set_warning(&session->diags, what) ? RT_OK : RT_FAULT_USAGE;
}

const char *rt_nearest(const char *mistyped, const char *const *names)
{
    Suggest suggest;
    suggest_begin(&suggest, mistyped);
    for (; *names; names++) {
        suggest_offer(&suggest, *names);
    }
    return suggest.best;
}

void rt_set_format(rt_session *session, rt_format format)
{
    session->is_json = format == RT_FORMAT_JSON;
    session->is_colored = format == RT_FORMAT_COLOR;
}

rt_status rt_explain(rt_session *session, const char *code, const char **text)
{
    DiagCode found;
    text_clear(&session->dump);
    *text = text_get(&session->dump);
    if (!explain_find(code, &found)) {
        return RT_FAULT_USAGE;
    }
    explain_write(found, &session->dump);
    *text = text_get(&session->dump);
    return session->dump.failed ? session_no_memory(session) : RT_OK;
}

static rt_status report(rt_session *session, const char *code, Span span, const char *message, const char *suggestion)
{
    DiagCode found;
    if (!explain_find(code, &found)) {
        return RT_FAULT_USAGE;
    }
    if (diag_report(&session->diags, found, span, "%s", message) && suggestion) {
        diag_suggest(&session->diags, "%s", suggestion);
    }
    session_deliver(session);
    if (session->diags.out_of_memory) {
        return session_no_memory(session);
    }
    return (rt_status)diag_code_class(found);
}

rt_status rt_report(rt_session *session, const char *code, const char *message, const char *suggestion)
{
    return report(session, code, SPAN_NONE, message, suggestion);
}

rt_status rt_report_in(rt_session *session, const char *code, const char *name, const char *text, size_t begin,
                       size_t end, const char *message, const char *suggestion)
{
    size_t length = strlen(text);
    if (begin > end || end > length) {
        return RT_FAULT_USAGE;
    }
    Source *source = source_open_text(session->sources, name, text, length);
    if (!source) {
        return report(session, code, SPAN_NONE, message, suggestion);
    }
    uint64_t base = source_base(source);
    rt_status status = report(session, code, (Span){base + begin, base + end}, message, suggestion);
    source_close(source);
    return status;
}

void session_suggest_scene(rt_session *session, const char *path)
{
    enum { NAMES = 1 << 20 }; // bytes of them at most
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    int length = (int)(name - path);
    char folder[4096];
    Arena arena;
    Suggest suggest;
    snprintf(folder, sizeof folder, "%.*s", length, path);
    arena_init(&arena, NAMES);
    suggest_begin(&suggest, name);
    suggest_offer_folder(&suggest, &arena, length > 0 ? folder : ".");
    if (suggest.best) {
        diag_suggest(&session->diags, "did you mean `%.*s%s`?", length, path, suggest.best);
    }
    arena_fini(&arena);
}
