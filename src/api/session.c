// The public interface: the pipeline from a scene's text to a picture file, one step a function.
//
// Owns everything of a session. Each step leaves its result in the session; messages go to the client's callbacks.
// Knows nothing of command lines, and never prints or exits.
//
// SPDX-License-Identifier: MIT
#include "api/session.h"

#include "scene/view.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "api/painter.h"
#include "api/probe.h"
#include "ast/words.h"
#include "base/clock.h"
#include "base/machine.h"
#include "base/stack.h"
#include "render/records/linear.h"
#include "render/reference/reference.h"
#include "scene/range.h"
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

// ---- the scene

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
    case SOURCE_NOT_A_FILE: // only where files alone are asked for
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

// ---- the picture

static void forward_progress(void *client, const RenderProgress *progress)
{
    rt_session *session = client;
    session->seconds_left = progress->seconds_left;
    session->callbacks.progress(session->callbacks.client, progress->done);
}

void session_film_to_linear(const Settings *settings, Film *film)
{
    size_t count = (size_t)film->width * (size_t)film->height * 3;
    float *colours[] = {film->rgb, film->planes[FILM_ALBEDO]};
    for (int k = 0; k < 2 && linear_is_needed(settings); k++) {
        if (colours[k]) {
            linear_floats(settings, colours[k], count);
        }
    }
}

// Takes the kernel of the chosen precision, if it can trace the scene; reports when not.
static bool take_precision(rt_session *session, Prepared *prepared)
{
#ifdef WITH_STUDY
    static const StudyPrecision precisions[] = {
        [RT_PRECISION_FLOAT] = STUDY_FLOAT, [RT_PRECISION_QUAD] = STUDY_QUAD, [RT_PRECISION_REFERENCE] = STUDY_DOUBLE};
    if (session->precision == RT_PRECISION_DOUBLE) {
        return true;
    }
    if (!study_covers(prepared, &session->diags)) {
        return false;
    }
    study_take(prepared, precisions[session->precision]);
#else
    (void)session, (void)prepared;
#endif
    return true;
}

static void forward_done(void *client, double done)
{
    forward_progress(client, &(RenderProgress){.done = done, .seconds_left = -1.0});
}

static ForwardOptions forward_options(const rt_session *session, const RenderOptions *options)
{
    return (ForwardOptions){
        .connects = session->method == RT_METHOD_FORWARD_CONNECT,
        .photons = session->photons,
        .seed = session->sampling.seed,
        .threads = options->threads,
        .progress = options->progress ? forward_done : NULL,
        .client = options->client,
        .cancel = options->cancel,
    };
}

// Whether the forward tracer, if it is asked for, knows all of the scene; reports what it does not.
static bool forward_fits(rt_session *session, const Prepared *prepared)
{
    ForwardOptions options = forward_options(session, &(RenderOptions){.threads = 1});
    const char *misfit = session->method == RT_METHOD_BACKWARD ? NULL : forward_misfit(prepared, &options);
    if (misfit) {
        diag_report(&session->diags, DIAG_E0449, session->scene.whole, "the forward tracer does not know %s", misfit);
    }
    return !misfit;
}

static RenderResult trace_film(rt_session *session, const Prepared *prepared, const RenderOptions *options)
{
    if (session_film_planes(session) & FILM_SURFACE_PLANES) {
        RenderResult result = render_surface_planes(prepared, options, &session->film);
        if (result != RENDER_OK) {
            return result;
        }
    }
    if (session->method != RT_METHOD_BACKWARD) {
        ForwardOptions forward = forward_options(session, options);
        session->kernel = forward.connects ? "forward, connected" : "forward";
        return forward_film(prepared, &forward, &session->film, &session->error, &session->photon_counts);
    }
    return render_film(prepared, options, &session->film, &session->statistics, &session->error);
}

// Lines and depth cue, over a film of linear light. False when out of memory.
static bool draw_over(rt_session *session, const Prepared *prepared, int threads, OverlayOptions options)
{
    const Settings *settings = &session->scene.settings;
    if (!overlay_is_wanted(&options)) {
        return true;
    }
    if (!session->has_cue_color) {
        Rgb own = rgbft_rgb(session->scene.background);
        options.cue_color = linear_is_needed(settings) ? rgb(linear_value(settings, own.red), linear_value(settings, own.green),
                                                             linear_value(settings, own.blue))
                                                       : own;
    }
    return render_overlay(prepared, threads, &options, &session->film) == RENDER_OK;
}

// Traces the film, puts it in linear light and draws over it. Returns whether there is a picture: also of a run that
// was interrupted when each pixel had a sample.
static bool trace_picture(rt_session *session, const Prepared *prepared, int threads, OverlayOptions overlay,
                          RenderResult *result)
{
    SamplingOptions sampling = session_sampling(session);
    RenderOptions options = {
        .threads = threads,
        .progress = session->callbacks.progress ? forward_progress : NULL,
        .client = session,
        .cancel = &session->cancel,
        .sampling = sampling_is_wanted(&sampling) ? &sampling : NULL,
        .antialias = session->antialias.method != 0 ? &session->antialias : NULL,
        .share = session_sharing_table(session),
    };
    *result = trace_film(session, prepared, &options);
    bool has_picture = *result == RENDER_OK || (*result == RENDER_CANCELLED && session->error.samples > 0.0);
    if (has_picture) {
        session_film_to_linear(&session->scene.settings, &session->film);
        *result = draw_over(session, prepared, threads, overlay) ? *result : RENDER_NO_MEMORY;
        has_picture = *result != RENDER_NO_MEMORY;
    }
    return has_picture;
}

static rt_status render_scene(rt_session *session, void *argument)
{
    double start = clock_seconds();
    int threads = *(const int *)argument;
    threads = threads ? threads : render_default_threads();
    session->threads = threads;
    bool is_spent = session->is_last && session->method == RT_METHOD_BACKWARD &&
                    session->precision == RT_PRECISION_DOUBLE;
    GeometryOptions geometry = {.threads = threads,
                                .isa = session->isa,
                                .spent = is_spent ? &session->scene : NULL,
                                .rays = session_camera_rays(session),
                                .kept = is_spent ? NULL : &session->kept,
                                .cancel = &session->cancel};
    OverlayOptions overlay = session->overlay;
    overlay_find_reach(&overlay, &session->scene);
    geometry.is_shared = session->sharing.has_scene;
    geometry.has_clear = session->sharing.has_clear;
    geometry.kept = geometry.is_shared ? NULL : geometry.kept;
    Prepared *prepared = prepared_new(&session->scene, &geometry);
    session_scene_ask(session, prepared);
    Film *film = &session->film;
    if (!prepared || !film_init(film, session_film_width(session), session_film_height(session),
                                session_film_planes(session))) {
        film_fini(film);
        prepared_free(prepared);
        if (prepared || !atomic_load(&session->cancel)) {
            diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory preparing the scene");
        }
        return session_status(session, false);
    }
    prepared_seed(prepared, session->sampling.seed);
    if (session->has_alpha) {
        prepared_want_alpha(prepared);
    }
    if (session->crop.width) {
        film_put(film, session->crop.left, session->crop.top, session->width, session->height);
    }
    if (!take_precision(session, prepared) || !forward_fits(session, prepared)) {
        prepared_free(prepared);
        film_fini(&session->film);
        return session_status(session, false);
    }
    session->kernel = prepared_kernel_name(prepared);
    session->prepare_seconds = clock_seconds() - start;
    start = clock_seconds();
    RenderResult result;
    bool has_picture = trace_picture(session, prepared, threads, overlay, &result);
    prepared_free(prepared);
    if (!has_picture) {
        film_fini(&session->film);
    }
    session->trace_seconds = clock_seconds() - start;
    session->rendered = has_picture;
    if (result == RENDER_CANCELLED) {
        return RT_CANCELLED;
    }
    if (result == RENDER_NO_MEMORY) {
        diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory rendering");
    } else if (result == RENDER_NOT_SHARED) {
        session_sharing_report(session);
    }
    return session_status(session, result == RENDER_OK);
}

// What cannot be combined in one run.
static rt_status session_ways_fit(rt_session *session)
{
    bool is_precise = session->precision != RT_PRECISION_DOUBLE;
    if (session->method != RT_METHOD_BACKWARD && (is_precise || sampling_is_wanted(&session->sampling))) {
        return rt_report(session, "E0703",
                         "`--method=forward` cannot be combined with `--samples` or `--precision`; use `--photons`",
                         "leave out `--precision`, `--samples` and goals");
    }
    bool is_plain = !is_precise && session->method == RT_METHOD_BACKWARD;
    if (session->has_alpha && session->sampling.is_adaptive) {
        return rt_report(session, "E0703", "adaptive sampling does not tell what is behind the scene",
                         "leave out `--alpha`, or give `--samples` without `--adaptive` and goals");
    }
    if (session->has_alpha && !is_plain) {
        return rt_report(session, "E0703", "only the ordinary kernels tell what is behind the scene",
                         "leave out `--alpha`, or `--precision` and `--method`");
    }
    bool has_error = session_is_sampled(session) && !session->sampling.has_no_estimate;
    if (((session->planes & RT_PLANE_ERROR) && !has_error) ||
        ((session->planes & RT_PLANE_SAMPLES) && !session_is_sampled(session))) {
        return rt_report(session, "E0703", "only a sampled picture has the planes `error` and `samples`",
                         "give `--samples` of 2 or more or a goal, without `--no-estimate`");
    }
    if (session->antialias.method != 0 && (session_is_sampled(session) || !is_plain || session->crop.width)) {
        return rt_report(session, "E0703",
                         "`--antialias` is for whole pictures of the ordinary kernels without sampling",
                         "leave out `--samples` and goals, `--precision`, `--method` and `--crop`");
    }
    return RT_OK;
}

rt_status rt_render(rt_session *session, int threads)
{
    if (!session->loaded || threads < 0 || (session->is_built && !session_begin(session))) {
        return RT_FAULT_USAGE;
    }
    if (!session_is_whole(session)) {
        return session_status(session, false);
    }
    rt_status status = session_ways_fit(session);
    status = status ? status : session_sharing_begin(session);
    if (status) {
        return status;
    }
    if (!session_memory_suffices(session)) {
        return session_status(session, false);
    }
    film_fini(&session->film);
    session->rendered = false;
    session->error = (SamplingError){0};
    session->drawn.sampling = session_sampling(session);
    session->drawn.method = session->method;
    session->drawn.photons = session->photons;
    session->drawn.precision = session->precision;
    session->drawn.is_sampled = session_is_sampled(session);
    session->drawn.planes = session->planes;
    session->drawn.sky_light = session->scene.settings.sky_light;
    Settings *settings = &session->scene.settings;
    int max_trace_level = settings->max_trace_level;
    settings->max_trace_level = session->max_trace_level > 0 ? session->max_trace_level : max_trace_level;
    Vec3 origin = session_scene_recentre(session);
    session->kept.is_elsewhere = session->kept.is_elsewhere || !vec3_equal(origin, session->kept_origin);
    session->kept_origin = origin;
    status = session_run_deep(session, render_scene, &threads);
    settings->max_trace_level = max_trace_level;
    session->is_spent = session->is_last;
    session->loaded = !session->is_spent;
    scene_move_back(&session->scene, origin);
    return status;
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

// Told as warnings, or as errors by -Werror.
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
