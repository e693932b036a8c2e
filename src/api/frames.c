// Animations: the loaded scene at another clock, by reading again only what its camera, lights and last shapes depend on.
//
// A slice of the text is found after the first frame (eval/slice.h) and tried on that frame itself: only when it gives the
// same camera, lights, settings and shapes is it used. All else stays: shapes before the first that moves, materials,
// textures and pictures that were read. Whatever does not fit, the whole scene is to be read again, which is for the
// client. Owns the slice.
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
#include "scene/tail.h"

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
    FrameStatement statement = {span.begin, source_map_count(session->sources), session->scene.shape_count};
    frames->is_lost = frames->is_lost || !ARRAY_PUSH(&frames->statements, statement);
}

// Shapes are to come where they stand in the whole text: behind those that stay.
void session_note_slice(void *client, Span span)
{
    rt_session *session = client;
    SessionFrames *frames = &session->frames;
    if (!frames->is_past && span.begin >= frames->reading_base + frames->first_shape) {
        frames->is_past = true;
        frames->is_in_order = frames->reading->shape_count == frames->reading_shapes;
    }
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

// How many shapes there were when each statement began, and in the end; NULL when out of memory.
static uint32_t *count_shapes(const rt_session *session)
{
    const SessionFrames *frames = &session->frames;
    uint32_t *shapes = malloc((frames->statements.count + 1) * sizeof *shapes);
    for (size_t i = 0; shapes && i < frames->statements.count; i++) {
        shapes[i] = frames->statements.items[i].shapes;
    }
    if (shapes) {
        shapes[frames->statements.count] = session->scene.shape_count;
    }
    return shapes;
}

// A slice that makes all shapes again is none.
static void find_slice(rt_session *session, const char *const *varying)
{
    SessionFrames *frames = &session->frames;
    Texts texts = {0};
    TextBuffer slice;
    text_init(&slice);
    uint32_t *shapes = count_shapes(session), all = session->scene.shape_count;
    if (shapes && gather(session, &texts) &&
        slice_make(texts.items.items, texts.items.count, shapes, varying, &slice, &frames->kept_shapes,
                   &frames->first_shape) == SLICE_MADE) {
        frames->moves_shapes = frames->kept_shapes < all;
        frames->slice = frames->kept_shapes > 0 || all == 0 ? strdup(text_get(&slice)) : NULL;
    }
    text_fini(&slice);
    for (size_t i = 0; i < texts.owned.count; i++) {
        free(texts.owned.items[i]);
    }
    ARRAY_FREE(&texts.owned);
    ARRAY_FREE(&texts.items);
    free(shapes);
}

// ---- a frame

typedef struct Frame {
    Source *source;
    Scene *scene;
} Frame;

static rt_status read_slice(rt_session *session, void *argument)
{
    Frame *frame = argument;
    return session_evaluate(session, frame->source, frame->scene, 0.0) ? RT_OK : RT_FAULT_SCENE;
}

// ---- what the slice says

typedef struct SaidPart {
    rt_stream stream;
    size_t end; // in Said.text
} SaidPart;

// It is kept until it is known whether the whole scene is read instead, which says it again.
typedef struct Said {
    TextBuffer text;
    ARRAY(SaidPart) parts;
    bool no_memory;
} Said;

static void said_keep(void *client, rt_stream stream, const char *text, size_t length)
{
    Said *said = client;
    text_append_n(&said->text, text, length);
    said->no_memory = !ARRAY_PUSH(&said->parts, (SaidPart){stream, said->text.length}) || said->no_memory;
}

static void said_deliver(const Said *said, rt_session *session)
{
    const char *text = text_get(&said->text);
    for (size_t i = 0, begin = 0; i < said->parts.count; begin = said->parts.items[i++].end) {
        session_say(session, said->parts.items[i].stream, text + begin, said->parts.items[i].end - begin);
    }
}

static void said_fini(Said *said)
{
    text_fini(&said->text);
    ARRAY_FREE(&said->parts);
}

static void say_nothing(void *client, const rt_diagnostic *diagnostic)
{
    (void)client, (void)diagnostic;
}

// The session's scene as it is before the slice: its first shapes and whatever they refer to, which it takes over, and
// neither camera nor lights nor settings but those of the run.
static Scene begin_scene(rt_session *session, uint32_t shapes)
{
    Scene fresh, scene = session->scene;
    scene_init(&fresh);
    scene.settings = fresh.settings;
    scene.settings.sky_light = session->scene.settings.sky_light;
    scene.background = fresh.background;
    scene.has_camera = fresh.has_camera;
    scene.camera = fresh.camera;
    memset(&scene.lights, 0, sizeof scene.lights);
    scene_keep_shapes(&scene, shapes);
    return scene;
}

// Adds the slice to the scene; what it says with #debug and the like is kept in `said`. False where there is something to
// report, which is for the whole scene to do, and for what is more than a camera, lights and shapes.
static bool read_frame(rt_session *session, Scene *scene, Said *said)
{
    rt_callbacks callbacks = session->callbacks;
    DiagSink diags = session->diags;
    bool is_json = session->is_json;
    size_t fogs = scene->fogs.count, rainbows = scene->rainbows.count, layers = scene->sky.count;
    Frame frame = {.source = source_open_text(session->sources, source_map_name(session->sources, session->frames.source),
                                              session->frames.slice, strlen(session->frames.slice)),
                   .scene = scene};
    session->frames.reading = scene;
    session->frames.reading_base = frame.source ? source_base(frame.source) : 0;
    session->frames.reading_shapes = scene->shape_count;
    session->frames.is_past = false;
    diag_init(&session->diags, session->sources);
    session->callbacks = (rt_callbacks){.client = said, .diagnostic = say_nothing, .message = said_keep};
    session->is_json = false;
    bool fine = frame.source && session_run_deep(session, read_slice, &frame) == RT_OK &&
                session_load_pictures(session, scene) && session->diags.count == 0 &&
                session->diags.error_count + session->diags.warning_count == 0;
    picture_reader_end(&session->reader);
    if (frame.source) {
        source_close(frame.source);
        source_drop(frame.source);
    }
    diag_fini(&session->diags);
    session->diags = diags;
    session->callbacks = callbacks;
    session->is_json = is_json;
    bool is_in_order = session->frames.is_past ? session->frames.is_in_order
                                               : scene->shape_count == session->frames.reading_shapes;
    fine = fine && !said->no_memory && !said->text.failed;
    return fine && is_in_order && scene->light_groups.count == 0 && scene->fogs.count == fogs &&
           scene->rainbows.count == rainbows && scene->sky.count == layers;
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

// The scene with the camera, lights and settings of another, whose lights it takes over.
static void take_view(Scene *to, const Scene *from)
{
    ARRAY_FREE(&to->lights);
    memcpy(&to->lights, &from->lights, sizeof to->lights);
    to->camera = from->camera;
    to->has_camera = from->has_camera;
    to->settings = from->settings;
    to->background = from->background;
}

// Whether the slice gives what the frame that is loaded has. Its shapes are made once more behind the others, and taken
// away again.
static bool holds(rt_session *session)
{
    uint32_t all = session->scene.shape_count;
    Scene first = session->scene, scene = begin_scene(session, all);
    Said said = {.no_memory = false};
    text_init(&said.text);
    bool fine = read_frame(session, &scene, &said) && has_same_view(&scene, &first) &&
                scene_repeats_shapes(&scene, session->frames.kept_shapes, all);
    scene_keep_shapes(&scene, all);
    take_view(&scene, &first);
    session->scene = scene;
    said_fini(&said);
    return fine;
}

// Looks for the slice, and tries it on the frame that is loaded.
static void begin_frames(rt_session *session, const char *const *varying)
{
    SessionFrames *frames = &session->frames;
    frames->is_tried = true;
    if (!frames->is_expected || frames->is_lost || session->header) {
        return;
    }
    find_slice(session, varying);
    if (frames->slice && !holds(session)) {
        free(frames->slice);
        frames->slice = NULL;
    }
}

// Lights say where they stand by the texts of the first frame, whose order is the same.
static void keep_places(Scene *scene, const Scene *first)
{
    for (size_t i = 0; i < scene->lights.count; i++) {
        scene->lights.items[i].span = i < first->lights.count ? first->lights.items[i].span : SPAN_NONE;
    }
    scene->camera.span = first->camera.span;
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
    Scene first = session->scene, scene = begin_scene(session, frames->kept_shapes);
    Said said = {.no_memory = false};
    text_init(&said.text);
    bool fine = read_frame(session, &scene, &said);
    keep_places(&scene, &first);
    ARRAY_FREE(&first.lights);
    session->scene = scene;
    session->loaded = fine;
    if (fine && frames->moves_shapes) {
        geometry_kept_fini(&session->kept); // any of its shapes may be another one
    }
    if (fine) {
        said_deliver(&said, session);
        fine = session_check_frame(session, frames->moves_shapes);
        session->parse_seconds = clock_seconds() - start;
        *is_set = 1;
    }
    said_fini(&said);
    return *is_set && !fine ? session_status(session, false) : RT_OK;
}
