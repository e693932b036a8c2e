// A scene that rank 0 alone can read: it is sent to the others, as the text of its records.
//
// That text evaluates to the same records, bit for bit (scene/dump.h), and names no other file; so a rank needs nothing
// of rank 0's file system. What tells scenes apart is sent beside it.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "api/session.h"

// What goes before the text.
typedef struct SentHead {
    long long length; // of the text; -1: rank 0 could not read it
    bool has_digest;
    unsigned char scene[DIGEST_BYTES], files[DIGEST_BYTES];
    unsigned long long file_count;
} SentHead;

// Rank 0's. False: there is nothing to be sent, which is reported.
static bool make_text(rt_session *session, TextBuffer *text)
{
    const Scene *scene = &session->scene;
    if (scene->picture_sources.count > 0) {
        if (diag_report(&session->diags, DIAG_E0714, scene_source_span(scene->whole.begin),
                        "a scene that shows `%s` cannot be sent", scene->picture_sources.items[0].path)) {
            diag_suggest(&session->diags, "give all ranks the files, and leave out `--mpi-read=one`");
        }
        return false;
    }
    scene_dump(scene, text);
    if (text->failed) {
        (void)session_no_memory(session);
    }
    return !text->failed;
}

static rt_status send(rt_session *session, const char *path)
{
    const MpiModule *module = session->sharing.ranks.module;
    rt_status status = rt_load_file(session, path);
    TextBuffer text;
    text_init(&text);
    SentHead head = {.length = -1, .has_digest = session->has_digest};
    if (!status && !make_text(session, &text)) {
        status = session_status(session, false);
    }
    if (!status) {
        head.length = (long long)text.length;
        memcpy(head.scene, session->scene_digest, sizeof head.scene);
        head.file_count = source_map_digest(session->sources, head.files);
    }
    module->broadcast(&head, sizeof head);
    if (!status) {
        module->broadcast(text.text, text.length);
    }
    text_fini(&text);
    return status;
}

static rt_status receive(rt_session *session, const char *path)
{
    SessionSharing *sharing = &session->sharing;
    const MpiModule *module = sharing->ranks.module;
    SentHead head;
    module->broadcast(&head, sizeof head);
    if (head.length < 0) {
        return RT_FAULT_SCENE; // rank 0 says why
    }
    char *text = malloc((size_t)head.length + 1);
    if (!text) {
        module->stop(RT_FAULT_LIMIT); // the others would wait
        return session_no_memory(session);
    }
    module->broadcast(text, (size_t)head.length);
    free(session->header);
    session->header = NULL; // what stands before the text and around it is in the records
    session->world.scale = 0.0;
    rt_status status = rt_load_text(session, path, text, (size_t)head.length);
    free(text);
    session->has_digest = head.has_digest;
    memcpy(session->scene_digest, head.scene, sizeof head.scene);
    sharing->is_sent = true;
    sharing->file_count = (size_t)head.file_count;
    memcpy(sharing->files, head.files, sizeof head.files);
    return status;
}

rt_status rt_load_file_of_ranks(rt_session *session, const char *path)
{
    if (!session->sharing.has_ranks || session->sharing.has_scene || session->is_built) {
        return RT_FAULT_USAGE;
    }
    return session->sharing.ranks.rank == 0 ? send(session, path) : receive(session, path);
}
