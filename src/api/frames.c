// Animations: the loaded scene at another clock, by reading again only what its camera and lights depend on.
//
// A slice of the text is found after the first frame (eval/slice.h) and tried on that frame itself: only when it gives the
// same camera, lights and settings and no shapes is it used. Whatever does not fit, the whole scene is to be read again,
// which is for the client. Owns the slice.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/session.h"
#include "base/clock.h"
#include "base/number.h"
#include "eval/slice.h"
#include "scene/dump.h"

enum { TEXT_MOST = 1 << 28 }; // longer texts are not searched

rt_status rt_expect_frames(rt_session *session)
{
    if (session->loaded || session->is_built) {
        return RT_FAULT_USAGE;
    }
    session->frames.is_expected = true;
    return RT_OK;
}

void session_note_statement(void *client, Span span)
{
    rt_session *session = client;
    SessionFrames *frames = &session->frames;
    FrameStatement statement = {span.begin, source_map_count(session->sources)};
    frames->is_lost = frames->is_lost || !ARRAY_PUSH(&frames->statements, statement);
}

void session_frames_fini(rt_session *session)
{
    SessionFrames *frames = &session->frames;
    ARRAY_FREE(&frames->statements);
    free(frames->slice);
    *frames = (SessionFrames){.is_expected = false};
}

// ---- the slice

typedef struct Texts {
    ARRAY(SliceText) items;
    ARRAY(char *) owned;
} Texts;

static bool add_text(rt_session *session, Texts *texts, size_t statement, Span span)
{
    size_t length = (size_t)(span.end - span.begin);
    char *text = length <= TEXT_MOST ? malloc(length + 1) : NULL;
    if (!text || !ARRAY_PUSH(&texts->owned, text)) {
        free(text);
        return false;
    }
    return source_read_span(session->sources, span, text) &&
           ARRAY_PUSH(&texts->items, (SliceText){statement, text, length});
}

// A statement's text goes to the beginning of the next one; what was opened between belongs to it.
static bool gather(rt_session *session, Texts *texts)
{
    const SessionFrames *frames = &session->frames;
    Span scene = source_map_extent(session->sources, frames->source);
    bool fine = true;
    for (size_t i = 0; fine && i < frames->statements.count; i++) {
        const FrameStatement *statement = &frames->statements.items[i];
        bool is_last = i + 1 == frames->statements.count;
        size_t sources = is_last ? frames->source_count : statement[1].sources;
        Span own = {i == 0 ? scene.begin : statement->begin, is_last ? scene.end : statement[1].begin};
        fine = own.begin >= scene.begin && own.end <= scene.end && own.begin <= own.end &&
               add_text(session, texts, i, own);
        for (size_t k = statement->sources; fine && k < sources; k++) {
            Span included = source_map_extent(session->sources, k);
            fine = !span_exists(included) || add_text(session, texts, i, included);
        }
    }
    return fine && frames->statements.count > 0;
}

static void find_slice(rt_session *session, const char *const *varying)
{
    Texts texts = {0};
    TextBuffer slice;
    text_init(&slice);
    if (gather(session, &texts) &&
        slice_make(texts.items.items, texts.items.count, varying, &slice) == SLICE_MADE) {
        session->frames.slice = strdup(text_get(&slice));
    }
    text_fini(&slice);
    for (size_t i = 0; i < texts.owned.count; i++) {
        free(texts.owned.items[i]);
    }
    ARRAY_FREE(&texts.owned);
    ARRAY_FREE(&texts.items);
}

// ---- a frame

typedef struct Frame {
    Source *source;
    Scene scene;
} Frame;

static rt_status read_slice(rt_session *session, void *argument)
{
    Frame *frame = argument;
    return session_evaluate(session, frame->source, &frame->scene, 0.0) ? RT_OK : RT_FAULT_SCENE;
}

static void say_nothing(void *client, const rt_diagnostic *diagnostic)
{
    (void)client, (void)diagnostic;
}

// Evaluates the slice, and says nothing of it: what has something to say is read as a whole. False for that, and for what
// is more than a camera and lights.
static bool read_frame(rt_session *session, Scene *scene)
{
    rt_callbacks callbacks = session->callbacks;
    DiagSink diags = session->diags;
    Frame frame = {.source = source_open_text(session->sources, source_map_name(session->sources, session->frames.source),
                                              session->frames.slice, strlen(session->frames.slice))};
    scene_init(&frame.scene);
    diag_init(&session->diags, session->sources);
    session->callbacks.diagnostic = say_nothing;
    session->callbacks.message = NULL;
    bool fine = frame.source && session_run_deep(session, read_slice, &frame) == RT_OK && session->diags.count == 0 &&
                session->diags.error_count + session->diags.warning_count == 0;
    if (frame.source) {
        source_close(frame.source);
        source_drop(frame.source);
    }
    diag_fini(&session->diags);
    session->diags = diags;
    session->callbacks = callbacks;
    *scene = frame.scene;
    return fine && scene->shape_count == 0 && scene->fogs.count == 0 && scene->sky.count == 0 &&
           scene->pictures.count == 0;
}

// Camera, lights and settings as text, without the rest of the scene.
static bool describe_view(const Scene *scene, TextBuffer *out)
{
    Scene view;
    scene_init(&view);
    view.settings = scene->settings;
    view.background = scene->background;
    view.has_camera = scene->has_camera;
    view.camera = scene->camera;
    view.lights.items = scene->lights.items;
    view.lights.count = scene->lights.count;
    scene_dump(&view, out);
    return !out->failed;
}

static bool has_same_view(const Scene *one, const Scene *other)
{
    TextBuffer first, second;
    text_init(&first);
    text_init(&second);
    bool is_same = describe_view(one, &first) && describe_view(other, &second) && one->has_camera == other->has_camera &&
                   strcmp(text_get(&first), text_get(&second)) == 0;
    text_fini(&first);
    text_fini(&second);
    return is_same;
}

// Looks for the slice, and tries it on the frame that is loaded.
static void begin_frames(rt_session *session, const char *const *varying)
{
    SessionFrames *frames = &session->frames;
    Scene scene;
    frames->is_tried = true;
    if (!frames->is_expected || frames->is_lost || session->header) {
        return;
    }
    find_slice(session, varying);
    if (frames->slice) {
        bool fine = read_frame(session, &scene) && has_same_view(&scene, &session->scene);
        scene_fini(&scene);
        if (!fine) {
            free(frames->slice);
            frames->slice = NULL;
        }
    }
}

// Lights say where they stand by the texts of the first frame, whose order is the same.
static void take_view(Scene *to, Scene *from)
{
    for (size_t i = 0; i < from->lights.count; i++) {
        from->lights.items[i].span = i < to->lights.count ? to->lights.items[i].span : SPAN_NONE;
    }
    from->camera.span = to->camera.span;
    ARRAY_FREE(&to->lights);
    to->lights.items = from->lights.items;
    to->lights.count = from->lights.count;
    to->lights.capacity = from->lights.capacity;
    from->lights.items = NULL;
    from->lights.count = from->lights.capacity = 0;
    to->camera = from->camera;
    to->has_camera = from->has_camera;
    to->settings = from->settings;
    to->background = from->background;
}

static bool redeclare(rt_session *session, const char *name_value)
{
    size_t length = strcspn(name_value, "=");
    for (size_t i = 0; i < session->declarations.count; i++) {
        EvalDeclaration *declaration = &session->declarations.items[i];
        const char *digits = name_value + length + 1;
        bool is_negative = *digits == '-';
        double value;
        if (strlen(declaration->name) == length && strncmp(declaration->name, name_value, length) == 0) {
            if (number_parse(digits + is_negative, strlen(digits + is_negative), &value) != NUMBER_OK) {
                return false;
            }
            declaration->number = is_negative ? -value : value;
            return true;
        }
    }
    return false;
}

rt_status rt_set_frame(rt_session *session, double clock, const char *const *declarations, size_t count, int *is_set)
{
    double start = clock_seconds();
    SessionFrames *frames = &session->frames;
    *is_set = 0;
    if (!session->loaded || session->is_built || !isfinite(clock) || count > FRAME_NAMES_MOST) {
        return RT_FAULT_USAGE;
    }
    if (!frames->is_tried) {
        const char *varying[FRAME_NAMES_MOST + 2] = {"clock"};
        char names[FRAME_NAMES_MOST][64];
        for (size_t i = 0; i < count; i++) {
            size_t length = strcspn(declarations[i], "=");
            memcpy(names[i], declarations[i], length < 63 ? length : 63);
            names[i][length < 63 ? length : 63] = '\0';
            varying[i + 1] = names[i];
        }
        begin_frames(session, varying);
    }
    if (!frames->slice) {
        return RT_OK;
    }
    session->clock = clock;
    for (size_t i = 0; i < count; i++) {
        if (!redeclare(session, declarations[i])) {
            return RT_FAULT_USAGE;
        }
    }
    Scene scene;
    bool fine = read_frame(session, &scene);
    if (fine) {
        take_view(&session->scene, &scene);
        fine = session_check_view(session);
        session->parse_seconds = clock_seconds() - start;
        *is_set = 1;
    }
    scene_fini(&scene);
    return *is_set && !fine ? session_status(session, false) : RT_OK;
}
