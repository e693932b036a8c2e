// Settings of a session: what is said before a scene is loaded.
//
// Turns calls of the client into the session's fields, and refuses what is out of range. Knows nothing of scenes.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/session.h"
#include "ast/words.h"
#include "base/number.h"

enum { SIZE_MAX_PIXELS = 65535 };

rt_status rt_add_include_path(rt_session *session, const char *folder)
{
    char *copy = strdup(folder);
    if (!copy || !ARRAY_PUSH(&session->include_paths, copy)) {
        free(copy);
        return session_no_memory(session);
    }
    return RT_OK;
}

rt_status rt_set_povray_includes(rt_session *session, int on)
{
    if (session->library.is_filled) {
        return RT_FAULT_USAGE;
    }
    session->library.has_no_povray = !on;
    return RT_OK;
}

const char *rt_include_path(rt_session *session, size_t i)
{
    size_t given = session->include_paths.count;
    if (i < given) {
        return session->include_paths.items[i];
    }
    bool is_there = library_fill(&session->library) && i - given < session->library.folders.count;
    return is_there ? session->library.folders.items[i - given] : NULL;
}

rt_status rt_allow_read(rt_session *session, const char *folder)
{
    char *copy = strdup(folder);
    if (!copy || !ARRAY_PUSH(&session->read_folders, copy)) {
        free(copy);
        return session_no_memory(session);
    }
    return RT_OK;
}

rt_status rt_allow_write(rt_session *session, const char *folder)
{
    char *copy = strdup(folder);
    if (!copy || !ARRAY_PUSH(&session->write_folders, copy)) {
        free(copy);
        return session_no_memory(session);
    }
    return RT_OK;
}

rt_status rt_set_header(rt_session *session, const char *path)
{
    char *copy = path[0] ? strdup(path) : NULL;
    if (path[0] && !copy) {
        return session_no_memory(session);
    }
    free(session->header);
    session->header = copy;
    return RT_OK;
}

void rt_set_untrusted(rt_session *session)
{
    Limits *limits = &session->limits;
    *limits = (Limits){
        .ast_depth = limits->ast_depth,
        .include_depth = limits->include_depth,
        .call_depth = limits->call_depth,
        .steps = 3 * 1000 * 1000,
        .message_bytes = 64 << 10,
        .string_bytes = 1 << 20,
        .objects = 1000 * 1000,
        .text_bytes = 64 << 20,
        .memory_bytes = 256 << 20,
        .memory_most = 512 << 20,
    };
    session->is_untrusted = true;
    session->library.is_filled = true; // with nothing
}

rt_status rt_set_clock(rt_session *session, double clock)
{
    if (!isfinite(clock)) {
        return RT_FAULT_USAGE;
    }
    session->clock = clock;
    session->clock_on = true;
    return RT_OK;
}

// Calls nest no deeper than POV-Ray lets them, whatever is requested.
static unsigned at_most(uint64_t value, unsigned greatest)
{
    return value < greatest ? (unsigned)value : greatest;
}

rt_status rt_set_limit(rt_session *session, rt_limit limit, uint64_t value)
{
    Limits *limits = &session->limits;
    if (value == 0) {
        return RT_FAULT_USAGE;
    }
    switch (limit) {
    case RT_LIMIT_STEPS:
        limits->steps = value;
        return RT_OK;
    case RT_LIMIT_DEPTH:
        limits->ast_depth = at_most(value, LIMIT_DEPTH_MAX);
        limits->include_depth = at_most(value, LIMIT_INCLUDE_DEPTH);
        limits->call_depth = at_most(value, LIMIT_CALL_DEPTH);
        return value <= LIMIT_DEPTH_MAX ? RT_OK : RT_FAULT_USAGE;
    case RT_LIMIT_OBJECTS:
        limits->objects = value;
        return RT_OK;
    case RT_LIMIT_TEXT:
        limits->text_bytes = value;
        return RT_OK;
    case RT_LIMIT_MEMORY:
        limits->memory_bytes = limits->memory_most = value < SIZE_MAX ? (size_t)value : SIZE_MAX;
        limits->memory_per_text = 0;
        return RT_OK;
    case RT_LIMIT_MESSAGES:
        limits->message_bytes = value;
        return RT_OK;
    }
    return RT_FAULT_USAGE;
}

static bool is_declared(const rt_session *session, const char *name)
{
    for (size_t i = 0; i < session->declarations.count; i++) {
        if (strcmp(session->declarations.items[i].name, name) == 0) {
            return true;
        }
    }
    return false;
}

// An identifier of the language that is not reserved.
static bool is_identifier(const rt_session *session, const char *name, size_t length)
{
    static const char allowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
    return length > 0 && strspn(name, allowed) >= length && !(name[0] >= '0' && name[0] <= '9') &&
           word_class(intern_find(session->names, name, length)) == WORD_IDENTIFIER;
}

rt_status rt_declare(rt_session *session, const char *name_value)
{
    const char *equals = strchr(name_value, '=');
    if (!equals || !is_identifier(session, name_value, (size_t)(equals - name_value))) {
        return RT_FAULT_USAGE;
    }
    const char *digits = equals + 1;
    bool negative = *digits == '-';
    digits += negative || *digits == '+';
    double value;
    if (number_parse(digits, strlen(digits), &value) != NUMBER_OK) {
        return RT_FAULT_USAGE;
    }
    char *name = strndup(name_value, (size_t)(equals - name_value));
    if (!name) {
        return session_no_memory(session);
    }
    EvalDeclaration declaration = {.name = name, .number = negative ? -value : value};
    if (is_declared(session, name)) {
        free(name);
        return RT_OK;
    }
    if (!ARRAY_PUSH(&session->declarations, declaration)) {
        free(name);
        return session_no_memory(session);
    }
    return RT_OK;
}

rt_status rt_set_size(rt_session *session, int width, int height)
{
    if (width < 1 || height < 1 || width > SIZE_MAX_PIXELS || height > SIZE_MAX_PIXELS) {
        return RT_FAULT_USAGE;
    }
    session->width = width;
    session->height = height;
    session->crop.width = 0;
    return RT_OK;
}

rt_status rt_set_crop(rt_session *session, int left, int top, int width, int height)
{
    if (left < 0 || top < 0 || width < 1 || height < 1 || left >= session->width || top >= session->height ||
        width > session->width - left || height > session->height - top) {
        return RT_FAULT_USAGE;
    }
    session->crop.left = left;
    session->crop.top = top;
    session->crop.width = width;
    session->crop.height = height;
    return RT_OK;
}

static bool find_sampler(const char *name, SamplerKind *kind)
{
    for (*kind = 0; name && *kind < SAMPLER_COUNT && strcmp(name, sampler_name(*kind)) != 0; (*kind)++) {
    }
    return *kind < SAMPLER_COUNT;
}

static bool find_filter(const char *name, FilterKind *kind)
{
    for (*kind = 0; name && *kind < FILTER_COUNT && strcmp(name, filter_name(*kind)) != 0; (*kind)++) {
    }
    return *kind < FILTER_COUNT;
}

static bool is_goal(double value)
{
    return value >= 0.0 && isfinite(value);
}

rt_status rt_set_sampling(rt_session *session, const rt_sampling *sampling)
{
    const double most = 1 << 24; // a pixel
    SamplingOptions options = {.seed = sampling->seed, .samples = sampling->samples,
                               .target_error = sampling->target_error, .time_limit = sampling->time_limit,
                               .has_no_estimate = sampling->no_estimate != 0,
                               .no_pixel_errors = sampling->no_pixel_errors != 0};
    bool has_goal = options.target_error > 0.0 || options.time_limit > 0.0;
    options.is_adaptive = sampling->adaptive || has_goal;
    if (!find_sampler(sampling->sampler, &options.sampler) || !find_filter(sampling->filter, &options.filter) ||
        !is_goal(options.target_error) || !is_goal(options.time_limit) || !is_goal(options.samples) ||
        options.samples > most || (options.samples > 0.0 && options.samples < 1.0) ||
        (options.is_adaptive && (!sampler_is_sequence(options.sampler) || options.has_no_estimate)) ||
        (sampling->adaptive && !has_goal && options.samples == 0.0) ||
        (!options.is_adaptive && options.samples != floor(options.samples))) {
        return RT_FAULT_USAGE;
    }
    if (sampling->max_trace_level < 0 || sampling->max_trace_level > TRACE_LEVEL_MAX) {
        return RT_FAULT_USAGE;
    }
    session->max_trace_level = sampling->max_trace_level;
    session->sampling = options;
    return RT_OK;
}

rt_status rt_set_antialias(rt_session *session, const rt_antialias *antialias)
{
    enum { DEPTH_DEFAULT = 3, DEPTH_MOST = 9 };
    AntialiasOptions options = {.method = antialias->method,
                                .depth = antialias->depth ? antialias->depth : DEPTH_DEFAULT,
                                .threshold = antialias->threshold,
                                .gamma = antialias->gamma != 0.0 ? antialias->gamma : 2.5};
    if (options.method < 0 || options.method > 2 || options.depth < 1 || options.depth > DEPTH_MOST ||
        !(options.threshold >= 0.0) || !(options.gamma > 0.0) || !isfinite(options.gamma)) {
        return RT_FAULT_USAGE;
    }
    session->antialias = options;
    return RT_OK;
}

static bool is_light(const double color[3])
{
    bool is_fine = true;
    for (int i = 0; i < 3; i++) {
        is_fine = is_fine && color[i] >= 0.0 && isfinite(color[i]);
    }
    return is_fine;
}

rt_status rt_set_outline(rt_session *session, double width, const double color[3])
{
    if (!(width >= 0.0 && width <= OUTLINE_WIDEST) || !is_light(color)) {
        return RT_FAULT_USAGE;
    }
    session->overlay.outline_width = width;
    session->overlay.outline_color = rgb(color[0], color[1], color[2]);
    return RT_OK;
}

rt_status rt_set_depth_cue(rt_session *session, const rt_depth_cue *cue)
{
    bool is_whole = cue->near == 0.0 && cue->far == 0.0;
    if (!(cue->strength >= 0.0 && cue->strength <= 1.0) || (cue->has_color && !is_light(cue->color)) ||
        !(is_whole || (cue->near >= 0.0 && cue->far > cue->near && isfinite(cue->far)))) {
        return RT_FAULT_USAGE;
    }
    OverlayOptions *overlay = &session->overlay;
    overlay->cue_strength = cue->strength;
    overlay->cue_color = rgb(cue->color[0], cue->color[1], cue->color[2]);
    overlay->cue_near = cue->near;
    overlay->cue_far = cue->far;
    session->has_cue_color = cue->has_color != 0;
    return RT_OK;
}

rt_status rt_set_sky_light(rt_session *session, const double color[3])
{
    if (!is_light(color)) {
        return RT_FAULT_USAGE;
    }
    session->scene.settings.sky_light = rgb(color[0], color[1], color[2]);
    session->is_viewed = false;
    return RT_OK;
}

void rt_set_alpha(rt_session *session, int on)
{
    session->has_alpha = on != 0;
}

rt_status rt_set_world(rt_session *session, double scale, const double shift[3])
{
    Vec3 by = vec3(shift[0], shift[1], shift[2]);
    if (session->is_built || !(scale > 0.0) || !isfinite(scale) || !vec3_is_finite(by)) {
        return RT_FAULT_USAGE;
    }
    session->world = (EvalWorld){scale, by};
    return RT_OK;
}

void rt_set_readers(rt_session *session, int on)
{
    session->has_readers = on != 0;
}

void rt_set_lenient(rt_session *session, int on)
{
    session->is_lenient = on != 0;
}

rt_status rt_set_provenance(rt_session *session, const char *options)
{
    char *copy = strdup(options);
    if (!copy) {
        return session_no_memory(session);
    }
    if (!session->provenance) {
        source_map_keep_digests(session->sources);
    }
    free(session->provenance);
    session->provenance = copy;
    return RT_OK;
}

void rt_set_literals(rt_session *session, int on)
{
    session->no_literals = !on;
}

rt_status rt_set_load_threads(rt_session *session, int threads)
{
    if (threads < 0) {
        return RT_FAULT_USAGE;
    }
    session->load_threads = threads;
    return RT_OK;
}

const char *rt_isa(size_t i)
{
    return geometry_isa(i);
}

rt_status rt_set_isa(rt_session *session, const char *name)
{
    for (size_t i = 0; geometry_isa(i); i++) {
        if (strcmp(name, geometry_isa(i)) == 0) {
            session->isa = geometry_isa(i);
            return RT_OK;
        }
    }
    return RT_FAULT_USAGE;
}

rt_status rt_set_precision(rt_session *session, rt_precision precision)
{
#ifdef WITH_STUDY
    bool is_there = precision <= RT_PRECISION_REFERENCE;
#else
    bool is_there = precision == RT_PRECISION_DOUBLE;
#endif
    session->precision = is_there ? precision : session->precision;
    return is_there ? RT_OK : RT_FAULT_USAGE;
}

rt_status rt_set_method(rt_session *session, rt_method method, uint64_t photons)
{
    if (method > RT_METHOD_FORWARD_CONNECT || (method != RT_METHOD_BACKWARD && photons == 0)) {
        return RT_FAULT_USAGE;
    }
    session->method = method;
    session->photons = photons;
    return RT_OK;
}
