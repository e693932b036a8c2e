// Messages of a session: diagnostics from the sink to the client's callback, and the status they amount to.
//
// SPDX-License-Identifier: MIT
#include "api/session.h"

static void deliver_one(rt_session *session, const Diag *diag, TextBuffer *text)
{
    SourceLocation location = {0};
    bool found = span_exists(diag->span) && source_locate(session->sources, diag->span, &location);
    rt_diagnostic out = {
        .severity = diag->severity == DIAG_ERROR ? RT_ERROR : RT_WARNING,
        .code = diag_code_name(diag->code),
        .message = diag->message,
        .file = location.name,
        .line = found ? location.line : 0,
        .column = found ? location.column : 0,
    };
    text_clear(text);
    diag_print(&session->diags, diag, text);
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

rt_status session_status(rt_session *session, bool fine)
{
    session_deliver(session);
    if (fine) {
        return RT_OK;
    }
    // Without a recorded class there was no memory even for the record.
    return session->diags.class == CLASS_NONE ? RT_FAULT_LIMIT : (rt_status)session->diags.class;
}
