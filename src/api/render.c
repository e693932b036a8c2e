// The second half of the public interface: the session's scene becomes a film, by whichever tracer was asked for.
//
// Prepares the scene, traces it, brings the light to linear and draws over it. Owns nothing; film, errors and counts are
// the session's.
//
// SPDX-License-Identifier: MIT
#include "api/session.h"

#include "base/clock.h"
#include "render/records/linear.h"
#include "render/reference/reference.h"
#include "scene/recentre.h"

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

// Whether the forward tracer, if it is requested, knows all of the scene; reports what it does not.
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

// The scene made ready for rays; NULL when out of memory or cancelled.
static Prepared *prepare(rt_session *session, int threads)
{
    bool is_spent = session->is_last && session->method == RT_METHOD_BACKWARD &&
                    session->precision == RT_PRECISION_DOUBLE;
    bool is_shared = session->sharing.has_scene;
    GeometryOptions geometry = {.threads = threads,
                                .isa = session->isa,
                                .spent = is_spent ? &session->scene : NULL,
                                .rays = session_camera_rays(session),
                                .kept = is_spent || is_shared ? NULL : &session->kept,
                                .is_shared = is_shared,
                                .has_clear = session->sharing.has_clear,
                                .cancel = &session->cancel};
    Prepared *prepared = prepared_new(&session->scene, &geometry);
    session_scene_ask(session, prepared);
    return prepared;
}

// The film, and what of the options the prepared scene gets. False after a report.
static bool begin_film(rt_session *session, Prepared *prepared)
{
    Film *film = &session->film;
    if (!prepared || !film_init(film, session_film_width(session), session_film_height(session),
                                session_film_planes(session))) {
        if (prepared || !atomic_load(&session->cancel)) {
            diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory preparing the scene");
        }
        return false;
    }
    prepared_seed(prepared, session->sampling.seed);
    if (session->has_alpha) {
        prepared_want_alpha(prepared);
    }
    if (session->crop.width) {
        film_put(film, session->crop.left, session->crop.top, session->width, session->height);
    }
    return take_precision(session, prepared) && forward_fits(session, prepared);
}

static rt_status render_scene(rt_session *session, void *argument)
{
    double start = clock_seconds();
    int threads = *(const int *)argument;
    threads = threads ? threads : render_default_threads();
    session->threads = threads;
    OverlayOptions overlay = session->overlay;
    overlay_find_reach(&overlay, &session->scene); // before the scene is spent
    Prepared *prepared = prepare(session, threads);
    if (!begin_film(session, prepared)) {
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
