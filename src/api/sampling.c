// What sampling left of error: asked for, written as a picture, and noted in the files of pictures.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "api/session.h"
#include "render/records/linear.h"

void rt_get_error(const rt_session *session, rt_error *error)
{
    static const rt_end ends[] = {[SAMPLING_DONE] = RT_END_DONE,
                                  [SAMPLING_TARGET] = RT_END_TARGET,
                                  [SAMPLING_TIME] = RT_END_TIME,
                                  [SAMPLING_INTERRUPTED] = RT_END_INTERRUPTED};
    const SamplingError *known = &session->error;
    *error = (rt_error){.known = known->is_known,
                        .rmse = known->rmse,
                        .low = known->low,
                        .high = known->high,
                        .samples = known->samples,
                        .slope = known->slope,
                        .bias = known->bias,
                        .bias_by_level = known->bias_by_level,
                        .end = ends[known->end],
                        .seconds_left = session->seconds_left,
                        .unmet_shapes = known->unmet[SMALL_SHAPE].count,
                        .unmet_shape_area = known->unmet[SMALL_SHAPE].area,
                        .unmet_highlights = known->unmet[SMALL_HIGHLIGHT].count,
                        .unmet_highlight_area = known->unmet[SMALL_HIGHLIGHT].area,
                        .unmet_are_about = !known->unmet_is_all,
                        .missed_area = known->missed_area,
                        .missed_error = known->missed_error};
}

void rt_get_photons(const rt_session *session, rt_photons *photons)
{
    const ForwardCounts *counts = &session->photon_counts;
    *photons = (rt_photons){counts->emitted, counts->met, counts->arrived};
}

bool session_has_pixel_errors(const rt_session *session)
{
    return session->error.is_known && !session->drawn.sampling.no_pixel_errors;
}

rt_status rt_write_error(rt_session *session, const char *path)
{
    ImageError fault = {.no_memory = false};
    Image image;
    if (!session->rendered || !session_has_pixel_errors(session)) {
        return RT_FAULT_USAGE;
    }
    if (!image_init(&image, session->film.width, session->film.height, 1)) {
        return session_image_fault(session, IMAGE_NO_MEMORY, path, &fault);
    }
    size_t count = (size_t)image.width * (size_t)image.height;
    for (size_t i = 0; i < count; i++) {
        image.values[i] = (float)render_pixel_error(&session->film, &session->error, i);
    }
    ImageDepth depth = image_path_depth(path);
    ImageEncoding encoding = {.depth = depth == IMAGE_DEPTH_8 ? IMAGE_DEPTH_16 : depth,
                              .transfer = IMAGE_TRANSFER_POWER,
                              .gamma = 1.0,
                              .threads = 1};
    ImageStatus status = image_write(&image, &encoding, path, &fault);
    image_fini(&image);
    return session_image_fault(session, status, path, &fault);
}

// Light that was multiplied with alpha in the scene's working space, as it was before.
static float straight(const Settings *settings, float light, double alpha)
{
    if (!(alpha > 0.0)) {
        return 0.0f;
    }
    return linear_is_needed(settings)
               ? (float)linear_value(settings, linear_inverse(settings, fmax((double)light, 0.0)) / alpha)
               : (float)((double)light / alpha);
}

bool session_picture_with_alpha(const rt_session *session, bool is_multiplied, Image *image)
{
    const Film *film = &session->film;
    if (!image_init(image, film->width, film->height, 4)) {
        return false;
    }
    size_t count = (size_t)film->width * (size_t)film->height;
    for (size_t i = 0; i < count; i++) {
        double alpha = 1.0 - (double)film_background(film)[i];
        for (size_t c = 0; c < 3; c++) {
            float light = film->rgb[3 * i + c];
            image->values[4 * i + c] = is_multiplied ? light : straight(&session->scene.settings, light, alpha);
        }
        image->values[4 * i + 3] = (float)alpha;
    }
    return true;
}

static void note_text(SessionNotes *notes, const char *name, const char *text, const char *more)
{
    TextBuffer *kept = &notes->texts[notes->count];
    text_init(kept);
    text_append(kept, text);
    text_append(kept, more);
    notes->items[notes->count++] = (ImageNote){name, text_get(kept), false};
}

void session_free_notes(SessionNotes *notes)
{
    for (size_t i = 0; i < notes->count; i++) {
        text_fini(&notes->texts[i]);
    }
    notes->count = 0;
}

__attribute__((format(printf, 3, 4))) static void note(SessionNotes *notes, const char *name, const char *format, ...)
{
    char formatted[128];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(formatted, sizeof formatted, format, arguments);
    va_end(arguments);
    note_text(notes, name, formatted, "");
}

static void note_sampling(SessionNotes *notes, const SamplingOptions *sampling, const SamplingError *error)
{
    note(notes, "rtlang:sampler", "%s", sampler_name(sampling->sampler));
    note(notes, "rtlang:filter", "%s", filter_name(sampling->filter));
    note(notes, "rtlang:seed", "%llu", (unsigned long long)sampling->seed);
    note(notes, "rtlang:samples", "%.17g", error->samples);
    note(notes, "rtlang:adaptive", "%s", sampling->is_adaptive ? "yes" : "no");
}

static void note_error(SessionNotes *notes, const SamplingError *error)
{
    note(notes, "rtlang:rmse", "%.6g", error->rmse);
    note(notes, "rtlang:rmse-low", "%.6g", error->low);
    note(notes, "rtlang:rmse-high", "%.6g", error->high);
    static const char *const names[SMALL_KINDS] = {"rtlang:unmet-shapes", "rtlang:unmet-highlights"};
    for (int i = 0; i < SMALL_KINDS; i++) {
        if (error->unmet[i].count > 0.0) {
            note(notes, names[i], "%.0f, %.2g pixels", error->unmet[i].count, error->unmet[i].area);
        }
    }
    if (error->bias > 0.0) {
        note(notes, "rtlang:bias", "%.6g", error->bias);
    }
}

static void note_origin(SessionNotes *notes, const rt_session *session)
{
    unsigned char digest[DIGEST_BYTES];
    char text[DIGEST_TEXT];
    note_text(notes, "Software", "rtlang ", PACKAGE_VERSION);
    if (session->provenance && session->has_digest) {
        digest_text(session->scene_digest, text);
        note_text(notes, "rtlang:scene", "blake2b-256 ", text);
    }
    size_t files = session->provenance ? source_map_digest(session->sources, digest) : 0;
    if (files > 0) {
        digest_text(digest, text);
        note(notes, "rtlang:files", "%zu, blake2b-256 %s", files, text);
    }
    if (session->provenance) {
        note_text(notes, "rtlang:options", session->provenance, "");
    }
    for (size_t i = 0; i < notes->count; i++) {
        notes->items[i].is_of_origin = true;
    }
}

// Everything that the picture follows from, and its error; no times, so that the same run makes the same file.
bool session_make_notes(const rt_session *session, SessionNotes *notes)
{
    const SamplingOptions *sampling = &session->drawn.sampling;
    const SamplingError *error = &session->error;
    notes->count = 0;
    note_origin(notes, session);
    if (session->drawn.method != RT_METHOD_BACKWARD) {
        note(notes, "rtlang:method", session->drawn.method == RT_METHOD_FORWARD ? "forward" : "forward-connect");
        note(notes, "rtlang:photons", "%llu", (unsigned long long)session->drawn.photons);
        note(notes, "rtlang:seed", "%llu", (unsigned long long)sampling->seed);
    } else if (session->drawn.is_sampled) {
        note_sampling(notes, sampling, error);
        Rgb sky = session->drawn.sky_light;
        if (!rgb_is_black(sky)) {
            note(notes, "rtlang:sky-light", "%.8g, %.8g, %.8g", sky.red, sky.green, sky.blue);
        }
        if (session->drawn.precision != RT_PRECISION_DOUBLE) {
            note(notes, "rtlang:precision", "%s", session->kernel);
        }
    }
    if (error->is_known) {
        note_error(notes, error);
    }
    if (session->left_out.length > 0) {
        note_text(notes, "Warning", "drawn without ", text_get((TextBuffer *)&session->left_out));
    }
    bool is_whole = !session->left_out.failed;
    for (size_t i = 0; i < notes->count; i++) {
        is_whole = is_whole && !notes->texts[i].failed;
    }
    return is_whole;
}

double session_camera_rays(const rt_session *session)
{
    enum { GOAL_RAYS = 16 }; // a pixel, at least
    SamplingOptions sampling = session_sampling(session);
    double each = sampling.samples > 1.0 ? sampling.samples : 1.0;
    each = sampling.is_adaptive && each < GOAL_RAYS ? GOAL_RAYS : each;
    return each * session_film_width(session) * session_film_height(session);
}
