// The first half of the public interface: a text becomes a scene in the session, whole and valid, or messages.
//
// Opens the text, evaluates it, reads the pictures it names and checks the scene as a whole: once it is read, or, of one
// that is built by calls, before it is first used. Owns nothing; all results are the session's.
//
// SPDX-License-Identifier: MIT
#include "api/session.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "api/painter.h"
#include "api/probe.h"
#include "base/clock.h"
#include "scene/range.h"
#include "scene/view.h"

bool session_open(rt_session *session, const char *path, Source **source)
{
    int error_number = 0;
    uint64_t limit = session->limits.text_bytes;
    bool is_stream = strcmp(path, "-") == 0;
    const char *name = is_stream ? "<stdin>" : path;
    char memory[LIMITS_BYTES_TEXT];
    size_t most = limits_memory(&session->limits, 0); // a pipe is all kept
    source_map_set_memory(session->sources, most);
    SourceResult result = is_stream ? source_open_stream(session->sources, name, STDIN_FILENO, limit, source,
                                                         &error_number)
                                    : source_open_file(session->sources, path, limit, source, &error_number);
    switch (result) {
    case SOURCE_OK:
        return true;
    case SOURCE_CANCELLED:
        break;
    case SOURCE_NOT_FOUND:
        if (diag_report(&session->diags, DIAG_E0501, SPAN_NONE, "scene file `%s` not found", name)) {
            session_suggest_scene(session, path);
        }
        break;
    case SOURCE_NOT_READABLE:
        diag_report(&session->diags, DIAG_E0502, SPAN_NONE, "cannot read `%s`: %s", name, strerror(error_number));
        break;
    case SOURCE_IS_DIRECTORY:
        diag_report(&session->diags, DIAG_E0503, SPAN_NONE, "`%s` is a directory, not a scene", name);
        break;
    case SOURCE_TOO_LARGE:
        if (diag_report(&session->diags, DIAG_E0504, SPAN_NONE, "`%s` is larger than %llu bytes", name,
                        (unsigned long long)limit)) {
            diag_suggest(&session->diags, "`--max-text` allows more");
        }
        break;
    case SOURCE_TOO_MUCH: // a pipe or a device is kept, because it cannot be read twice
        limits_bytes_text(most, memory);
        if (diag_report(&session->diags, DIAG_E0607, SPAN_NONE, "reading `%s` takes more than %s of memory", name,
                        memory)) {
            diag_suggest(&session->diags, "`--max-memory` allows more");
        }
        break;
    case SOURCE_NOT_A_FILE: // only where only files are allowed
    case SOURCE_NO_MEMORY:
        diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory reading `%s`", name);
        break;
    }
    return false;
}

static void forward_message(void *client, EvalStream stream, const char *text, size_t length)
{
    static const rt_stream streams[] = {
        [EVAL_STREAM_DEBUG] = RT_STREAM_DEBUG,           [EVAL_STREAM_WARNING] = RT_STREAM_WARNING,
        [EVAL_STREAM_ERROR] = RT_STREAM_ERROR,           [EVAL_STREAM_RENDER] = RT_STREAM_RENDER,
        [EVAL_STREAM_STATISTICS] = RT_STREAM_STATISTICS,
    };
    rt_session *session = client;
    session_deliver(session); // what was reported before comes before
    session_say(session, streams[stream], text, length);
}

static bool load_pictures(void *client, Scene *scene)
{
    return session_load_pictures(client, scene);
}

int session_load_threads(const rt_session *session)
{
    return session->load_threads > 0 ? session->load_threads : render_default_threads();
}

bool session_evaluate(rt_session *session, Source *source, Scene *scene, double version)
{
    EvalOptions options = {
        .sources = session->sources,
        .names = session->names,
        .diags = &session->diags,
        .limits = &session->limits,
        .include_paths = (const char *const *)session->include_paths.items,
        .include_path_count = session->include_paths.count,
        .library = &session->library,
        .read_folders = (const char *const *)session->read_folders.items,
        .read_folder_count = session->read_folders.count,
        .write_folders = (const char *const *)session->write_folders.items,
        .write_folder_count = session->write_folders.count,
        .declarations = session->declarations.items,
        .declaration_count = session->declarations.count,
        .header = session->header,
        .image_width = session->width,
        .image_height = session->height,
        .clock = session->clock,
        .clock_on = session->clock_on,
        .world = session->world.scale > 0.0 ? &session->world : NULL,
        .no_literals = session->no_literals,
        .is_lenient = session->is_lenient,
        .left_out = &session->left_out,
        .version = version,
        .threads = session_load_threads(session),
        .tracer = &probe_tracer,
        .painter = &painter,
        .load_pictures = load_pictures,
        .statement = !session->frames.is_expected ? NULL
                     : session->loaded            ? session_note_slice
                                                  : session_note_statement,
        .declared = &session->names_declared,
        .share = session_scene_reading(session),
        .cancel = &session->cancel,
        .message = forward_message,
        .client = session,
    };
    return eval_source(&options, source, scene);
}

// What only the whole scene can tell. Where nothing but camera and lights changed, the shapes are not compared again.
static bool check_whole(rt_session *session, bool has_new_shapes)
{
    const Scene *scene = &session->scene;
    scene_keep_survey(&session->scene, session_load_threads(session));
    if (session->sharing.has_scene) { // the ranks will tell the rest together
        return scene_validate_share(scene, &session->diags, session_load_threads(session)) &&
               session->diags.error_count == 0;
    }
    bool fine = (has_new_shapes ? scene_validate(scene, &session->diags, session_load_threads(session))
                                : scene_validate_view(scene, &session->diags, session_load_threads(session))) &&
                session->diags.error_count == 0;
    if (fine) {
        scene_hint_of_view(scene, session->width, session->height, &session->diags);
    }
    return fine && session->diags.error_count == 0;
}

bool session_check_frame(rt_session *session, bool has_new_shapes)
{
    bool fine = check_whole(session, has_new_shapes);
    diag_finish(&session->diags);
    session_deliver(session);
    return fine;
}

static rt_status load(rt_session *session, void *argument)
{
    Source *source = argument;
    Scene *scene = &session->scene;
    session->frames.source = source_map_count(session->sources) - 1; // opened last
    scene->whole = SPAN_WHOLE(source_base(source));
    if (session->sharing.has_scene) {
        scene->share = (SceneShare){.part = (uint32_t)session->sharing.ranks.rank,
                                    .parts = (uint32_t)session->sharing.ranks.ranks};
    }
    bool fine = session_evaluate(session, source, scene, session->is_built ? scene->settings.version : 0.0);
    scene_end_share(scene);
    fine = fine &&
                (session->is_built || check_whole(session, true)) && session_load_pictures(session, scene);
    picture_reader_end(&session->reader);
    diag_finish(&session->diags);
    session->frames.source_count = source_map_count(session->sources);
    session->loaded = fine;
    session->is_broken = session->is_built && !fine;
    return session_status(session, fine);
}

// ---- a scene that is built by calls

bool session_is_whole(rt_session *session)
{
    Settings *settings = &session->scene.settings;
    if (!session->is_built || (session->is_checked && session->is_viewed)) {
        return true;
    }
    if (settings->gamma_model == GAMMA_NONE && settings->version >= 3.7) {
        settings->gamma_model = GAMMA_LINEAR; // no part said anything
    }
    session->is_checked = session->is_viewed = check_whole(session, !session->is_checked);
    diag_finish(&session->diags);
    session_deliver(session);
    return session->is_checked;
}

// Whether a text may be loaded: the whole of a scene once, the parts of one that is built by calls.
static bool may_load(rt_session *session)
{
    if (!session->is_built) {
        return !session->loaded && !session->is_spent;
    }
    session->is_checked = false;
    return session_begin(session);
}

// The time from `start` is that of parsing.
static rt_status load_source(rt_session *session, Source *source, double start)
{
    rt_status status = session_run_deep(session, load, source);
    if (session->provenance && !session->is_built) {
        session->has_digest = source_digest(source, session->scene_digest);
    }
    source_close(source);
    session->parse_seconds = clock_seconds() - start;
    return status;
}

rt_status rt_load_file(rt_session *session, const char *path)
{
    double start = clock_seconds();
    Source *source;
    if (!may_load(session)) {
        return RT_FAULT_USAGE;
    }
    if (!session_open(session, path, &source)) {
        return session_status(session, false);
    }
    return load_source(session, source, start);
}

rt_status rt_load_text(rt_session *session, const char *name, const char *text, size_t length)
{
    double start = clock_seconds();
    if (!may_load(session)) {
        return RT_FAULT_USAGE;
    }
    Source *source = source_open_text(session->sources, name, text, length);
    return source ? load_source(session, source, start) : session_no_memory(session);
}
