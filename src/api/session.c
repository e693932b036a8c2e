// The public interface: sessions begin and end here. The pipeline from a scene's text to a picture file is one step a
// function, in load.c, render.c and picture.c.
//
// Owns everything of a session. Each step leaves its result in the session; messages go to the client's callbacks.
// Knows nothing of command lines, and never prints or exits.
//
// SPDX-License-Identifier: MIT
#include "api/session.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ast/words.h"
#include "base/machine.h"
#include "base/stack.h"
#include "scene/recentre.h"
#include "scene/scene_extent.h"

#ifndef PACKAGE_VERSION
#error "PACKAGE_VERSION comes from configure"
#endif

enum { WIDTH_DEFAULT = 320, HEIGHT_DEFAULT = 240 };

const char *rt_version(void)
{
    return PACKAGE_VERSION;
}

// The defaults, with as much memory as there is.
static Limits limits_of_machine(void)
{
    Limits limits = LIMITS_DEFAULT;
    size_t memory = machine_memory();
    limits.memory_most = memory < SIZE_MAX ? memory : limits.memory_most;
    return limits;
}

rt_session *rt_session_new(const rt_callbacks *callbacks)
{
    rt_session *session = calloc(1, sizeof *session);
    if (!session) {
        return NULL;
    }
    if (callbacks) {
        session->callbacks = *callbacks;
    }
    session->limits = limits_of_machine();
    session->width = WIDTH_DEFAULT;
    session->height = HEIGHT_DEFAULT;
    session->kernel = "";
    scene_init(&session->scene);
    text_init(&session->dump);
    text_init(&session->said);
    text_init(&session->left_out);
    text_init(&session->note);
    picture_reader_init(&session->reader, &session->cancel);
    session->sources = source_map_new();
    session->names = intern_new(session->limits.memory_most);
    diag_init(&session->diags, session->sources);
    if (session->sources) {
        source_map_set_cancel(session->sources, &session->cancel);
    }
    if (!session->sources || !session->names || !words_intern(session->names)) {
        rt_session_free(session);
        return NULL;
    }
    return session;
}

void rt_session_free(rt_session *session)
{
    if (!session) {
        return;
    }
    for (size_t i = 0; i < session->include_paths.count; i++) {
        free(session->include_paths.items[i]);
    }
    for (size_t i = 0; i < session->read_folders.count; i++) {
        free(session->read_folders.items[i]);
    }
    for (size_t i = 0; i < session->write_folders.count; i++) {
        free(session->write_folders.items[i]);
    }
    for (size_t i = 0; i < session->declarations.count; i++) {
        free((char *)session->declarations.items[i].name);
    }
    geometry_kept_fini(&session->kept);
    free(session->png);
    ARRAY_FREE(&session->groups);
    free(session->header);
    ARRAY_FREE(&session->include_paths);
    library_fini(&session->library);
    ARRAY_FREE(&session->read_folders);
    ARRAY_FREE(&session->write_folders);
    ARRAY_FREE(&session->declarations);
    film_fini(&session->film);
    scene_fini(&session->scene);
    diag_fini(&session->diags);
    text_fini(&session->dump);
    text_fini(&session->said);
    text_fini(&session->left_out);
    text_fini(&session->note);
    session_frames_fini(session);
    session_sharing_fini(&session->sharing);
    free(session->provenance);
    intern_free(session->names);
    source_map_free(session->sources);
    free(session);
}

// ---- what may nest deep

typedef struct DeepWork {
    rt_session *session;
    rt_status (*work)(rt_session *session, void *argument);
    void *argument;
    rt_status status;
} DeepWork;

static void run_deep(void *client)
{
    DeepWork *deep = client;
    deep->status = deep->work(deep->session, deep->argument);
}

rt_status session_run_deep(rt_session *session, rt_status (*work)(rt_session *session, void *argument), void *argument)
{
    DeepWork deep = {session, work, argument, RT_OK};
    size_t least = STACK_BYTES_LEAST + scene_composite_stack(&session->scene);
    if (least > STACK_BYTES || !stack_run(least, run_deep, &deep)) { // what is cut has too many crossings on a ray
        diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory for a stack of %d MiB", STACK_BYTES >> 20);
        return session_status(session, false);
    }
    return deep.status;
}

void rt_discard_scene(rt_session *session)
{
    session->is_last = true;
}

void rt_resume(rt_session *session)
{
    atomic_store(&session->cancel, false);
}

void rt_cancel(rt_session *session)
{
    atomic_store(&session->cancel, true);
}

// Reported as warnings, or as errors by -Werror.
static uint64_t out_of_range(const DiagSink *diags)
{
    return diags->reported[DIAG_W0440] + diags->reported[DIAG_W0441] + diags->reported[DIAG_W0442] +
           diags->reported[DIAG_W0443];
}

void rt_get_summary(const rt_session *session, rt_summary *summary)
{
    *summary = (rt_summary){
        .width = session_film_width(session),
        .height = session_film_height(session),
        .objects = session->scene.shape_count,
        .lights = session->scene.lights.count,
        .camera_rays = session->statistics.camera_rays,
        .shadow_rays = session->statistics.shadow_rays,
        .reflected_rays = session->statistics.reflected_rays,
        .transmitted_rays = session->statistics.transmitted_rays,
        .parse_seconds = session->parse_seconds,
        .prepare_seconds = session->prepare_seconds,
        .trace_seconds = session->trace_seconds,
        .write_seconds = session->write_seconds,
        .errors = session->past_errors + session->diags.error_count,
        .warnings = session->past_warnings + session->diags.warning_count,
        .kernel = session->kernel,
        .trees = session->kept.builds + session->is_spent,
        .refits = session->kept.refits,
        .out_of_range = out_of_range(&session->diags),
    };
}

void rt_get_range(const rt_session *session, rt_range *range)
{
    SceneExtent found;
    scene_extent(&session->scene, &found);
    *range = (rt_range){
        .eye_offset = found.eye_offset,
        .least_size = found.least_size,
        .reach = found.reach,
        .nearest_far = found.nearest_far,
        .least_angle = found.least_angle,
    };
}

rt_status rt_move_camera(rt_session *session, double factor)
{
    if (!session->loaded || !(factor > 0.0) || !isfinite(factor)) {
        return RT_FAULT_USAGE;
    }
    session->is_checked = false;
    scene_move_camera(&session->scene, factor);
    return RT_OK;
}
