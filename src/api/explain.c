// What a scene takes and what it does not: each part of the work, why it is left out, or its costs in rays and time.
//
// Traces the loaded scene, then once more without each part that can be taken away; the differences are the costs.
// Changes the session's scene and puts it back. The text is the session's dump.
//
// SPDX-License-Identifier: MIT
#include "api/session.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "image/picture_file.h"
#include "render/records/kernel.h"
#include "scene/recentre.h"

// Runs of one scene whose times are compared with those of others.
enum { RUNS_MAX = 5 };
static const double RUNS_SECONDS = 0.5;

typedef struct Run {
    unsigned features;
    const char *kernel;
    size_t bytes;
    double prepare_seconds, trace_seconds;
    RenderStatistics statistics;
} Run;

// What is taken away for the second run, and which rays it is.
typedef enum Without {
    WITHOUT_NOTHING,
    WITHOUT_SHADOWS,
    WITHOUT_REFLECTION,
    WITHOUT_HIGHLIGHTS,
    WITHOUT_SKY,
    WITHOUT_FOG,
} Without;

// Each feature that a scene may have or lack: why it is left out, and which of its costs are known.
#define PARTS(PART)                                                                                                    \
    PART("spheres one by one", TRACE_SPHERES, "no sphere, or so many that they stand in a tree", WITHOUT_NOTHING)      \
    PART("tree of spheres", TRACE_SPHERE_BVH, "no sphere", WITHOUT_NOTHING)                                            \
    PART("planes", TRACE_PLANES, "no plane", WITHOUT_NOTHING)                                                          \
    PART("other shapes", TRACE_PRIMITIVES, "nothing but spheres and planes, none stretched", WITHOUT_NOTHING)          \
    PART("shadow rays", RENDER_SHADOWS, "no light casts shadows", WITHOUT_SHADOWS)                                     \
    PART("lights of a form", RENDER_LIGHTS, "no spotlight, area light or light that fades", WITHOUT_NOTHING)           \
    PART("highlights", RENDER_HIGHLIGHTS, "no finish has phong or specular", WITHOUT_HIGHLIGHTS)                       \
    PART("brilliance", RENDER_BRILLIANCE, "no finish has it, and none is lit from behind", WITHOUT_NOTHING)            \
    PART("mirrored rays", RENDER_REFLECTION, "no finish reflects", WITHOUT_REFLECTION)                                 \
    PART("reflection exponent", RENDER_EXPONENT, "no finish has it", WITHOUT_NOTHING)                                  \
    PART("rays through surfaces", RENDER_TRANSPARENCY, "no pigment lets light through", WITHOUT_NOTHING)               \
    PART("patterns", RENDER_PIGMENTS, "each texture is of one colour", WITHOUT_NOTHING)                                \
    PART("layers", RENDER_TEXTURES, "each texture is one layer that lets nothing through", WITHOUT_NOTHING)            \
    PART("interiors", RENDER_INTERIORS, "nothing bends light or asks what it is inside of", WITHOUT_NOTHING)           \
    PART("sky", RENDER_SKY, "no sky_sphere", WITHOUT_SKY)                                                              \
    PART("fog", RENDER_FOG, "no fog", WITHOUT_FOG)                                                                     \
    PART("bumps", RENDER_NORMALS, "no normal", WITHOUT_NOTHING)

typedef struct Feature {
    const char *name;
    unsigned feature;
    const char *absent;
    Without without; // WITHOUT_NOTHING: its cost alone is not known
} Feature;

static const Feature feature_rows[] = {
#define PART(name, feature, absent, without) {name, feature, absent, without},
    PARTS(PART)
#undef PART
};

#define PART(name, feature, absent, without) | (unsigned)feature
_Static_assert((0u PARTS(PART)) == ((unsigned)TRACE_ALL_FEATURES | (unsigned)RENDER_ALL_FEATURES),
               "each feature has a line in PARTS");
#undef PART

// ---- runs

// One run, which others of the same scene are compared with.
static bool trace_once(rt_session *session, const Prepared *prepared, int threads, Run *run)
{
    Film film = {0};
    RenderOptions options = {.threads = threads, .cancel = &session->cancel};
    SamplingError error;
    RenderStatistics statistics = {0};
    bool is_fine = film_init(&film, session->width, session->height, 0);
    double start = clock_seconds();
    is_fine = is_fine && render_film(prepared, &options, &film, &statistics, &error) == RENDER_OK;
    double seconds = clock_seconds() - start;
    run->trace_seconds = seconds < run->trace_seconds ? seconds : run->trace_seconds;
    run->statistics = statistics;
    film_fini(&film);
    return is_fine;
}

// The shortest of several runs, where they are short: the machine may do other things.
static bool run_scene(rt_session *session, int threads, Run *run)
{
    GeometryOptions geometry = {.threads = threads, .isa = session->isa};
    double start = clock_seconds();
    Prepared *prepared = prepared_new(&session->scene, &geometry);
    *run = (Run){.prepare_seconds = clock_seconds() - start, .trace_seconds = HUGE_VAL};
    bool is_fine = prepared != NULL;
    start = clock_seconds();
    for (int i = 0; is_fine && i < RUNS_MAX && (i == 0 || clock_seconds() - start < RUNS_SECONDS); i++) {
        is_fine = trace_once(session, prepared, threads, run);
    }
    if (is_fine) {
        run->features = prepared_features(prepared);
        run->kernel = prepared_kernel_name(prepared);
        run->bytes = prepared_geometry_bytes(prepared);
    }
    prepared_free(prepared);
    return is_fine;
}

// Takes a part away from the scene's lights and finishes.
static void take_away(Scene *scene, Without what)
{
    for (size_t i = 0; i < scene->lights.count && what == WITHOUT_SHADOWS; i++) {
        scene->lights.items[i].shadowless = true;
    }
    for (size_t i = 0; i < scene->finishes.count; i++) {
        Finish *finish = &scene->finishes.items[i];
        if (what == WITHOUT_REFLECTION) {
            finish->reflection_min = finish->reflection_max = rgb_grey(0.0);
        } else if (what == WITHOUT_HIGHLIGHTS) {
            finish->phong = finish->specular = 0.0;
        }
    }
    scene->sky.count = what == WITHOUT_SKY ? 0 : scene->sky.count;
    scene->fogs.count = what == WITHOUT_FOG ? 0 : scene->fogs.count;
}

static void *copy_of(const void *items, size_t bytes)
{
    void *copy = malloc(bytes > 0 ? bytes : 1);
    if (copy && bytes > 0) {
        memcpy(copy, items, bytes);
    }
    return copy;
}

static bool run_without(rt_session *session, int threads, Without what, Run *run)
{
    Scene *scene = &session->scene;
    size_t light_bytes = scene->lights.count * sizeof *scene->lights.items;
    size_t finish_bytes = scene->finishes.count * sizeof *scene->finishes.items;
    size_t skies = scene->sky.count, fogs = scene->fogs.count;
    void *lights = copy_of(scene->lights.items, light_bytes), *finishes = copy_of(scene->finishes.items, finish_bytes);
    bool is_fine = lights && finishes;
    if (is_fine) {
        take_away(scene, what);
        is_fine = run_scene(session, threads, run);
        if (light_bytes > 0) {
            memcpy(scene->lights.items, lights, light_bytes);
        }
        if (finish_bytes > 0) {
            memcpy(scene->finishes.items, finishes, finish_bytes);
        }
        scene->sky.count = skies;
        scene->fogs.count = fogs;
    }
    free(lights);
    free(finishes);
    return is_fine;
}

// ---- the text

static uint64_t secondary_rays(const RenderStatistics *s)
{
    return s->shadow_rays + s->reflected_rays + s->transmitted_rays;
}

static bool write_feature(rt_session *session, int threads, const Feature *feature, const Run *whole)
{
    TextBuffer *out = &session->dump;
    const RenderStatistics *all = &whole->statistics;
    uint64_t rays = feature->feature == RENDER_SHADOWS        ? all->shadow_rays
                    : feature->feature == RENDER_REFLECTION   ? all->reflected_rays
                    : feature->feature == RENDER_TRANSPARENCY ? all->transmitted_rays
                                                              : 0;
    text_printf(out, "  %-22s", feature->name);
    if (rays > 0) {
        text_printf(out, "%12llu rays", (unsigned long long)rays);
    }
    if (feature->without != WITHOUT_NOTHING) {
        Run without;
        if (!run_without(session, threads, feature->without, &without)) {
            return false;
        }
        uint64_t before = secondary_rays(all), after = secondary_rays(&without.statistics);
        text_printf(out, "%scosts %.3f s and %llu rays in all", rays > 0 ? "; " : "",
                    fmax(0.0, whole->trace_seconds - without.trace_seconds),
                    (unsigned long long)(before > after ? before - after : 0));
    } else if (rays == 0) {
        text_append(out, "in the kernel");
    }
    text_append_char(out, '\n');
    return true;
}

static bool needs_module(const Scene *scene)
{
    for (size_t i = 0; i < scene->picture_sources.count; i++) {
        if (!picture_file_is_own(picture_format_word((PictureFormat)scene->picture_sources.items[i].format))) {
            return true;
        }
    }
    return false;
}

static void write_stages(rt_session *session, int threads, const Run *whole)
{
    TextBuffer *out = &session->dump;
    const Scene *scene = &session->scene;
    text_printf(out, "read     %9.3f s  %llu shapes, %llu lights, %llu finishes\n", session->parse_seconds,
                (unsigned long long)scene_shapes_in_all(scene), (unsigned long long)scene->lights.count,
                (unsigned long long)scene->finishes.count);
    text_printf(out, "prepare  %9.3f s  %llu bytes of geometry\n", whole->prepare_seconds,
                (unsigned long long)whole->bytes);
    text_printf(out, "trace    %9.3f s  %d x %d, kernel `%s`, %d thread%s\n", whole->trace_seconds, session->width,
                session->height, whole->kernel, threads, threads == 1 ? "" : "s");
}

static bool write_present(rt_session *session, int threads, const Run *whole)
{
    TextBuffer *out = &session->dump;
    const Scene *scene = &session->scene;
    text_printf(out, "\nthere, and what it costs\n  %-22s%12llu rays\n", "camera rays",
                (unsigned long long)whole->statistics.camera_rays);
    for (size_t i = 0; i < RT_COUNT_OF(feature_rows); i++) {
        if ((whole->features & feature_rows[i].feature) && !write_feature(session, threads, &feature_rows[i], whole)) {
            return false;
        }
    }
    if (scene->picture_sources.count > 0) {
        text_printf(out, "  %-22s%12llu files%s\n", "pictures", (unsigned long long)scene->picture_sources.count,
                    needs_module(scene) ? ", not all of which rtlang reads itself" : "");
    }
    return true;
}

static void write_absent(rt_session *session, const Run *whole)
{
    TextBuffer *out = &session->dump;
    const Scene *scene = &session->scene;
    text_append(out, "\nleft out, and why\n");
    for (size_t i = 0; i < RT_COUNT_OF(feature_rows); i++) {
        bool has_few = feature_rows[i].feature == TRACE_SPHERE_BVH && (whole->features & TRACE_SPHERES);
        if (has_few) {
            text_printf(out, "  %-22s%llu sphere%s, tested one after the other\n", feature_rows[i].name,
                        (unsigned long long)scene->spheres.count, scene->spheres.count == 1 ? "" : "s");
        } else if (!(whole->features & feature_rows[i].feature)) {
            text_printf(out, "  %-22s%s\n", feature_rows[i].name, feature_rows[i].absent);
        }
    }
    if (session->names_declared.unused > 0) {
        text_printf(out, "  %-22s%llu of %llu are never used: no record is made of them, and no picture of theirs is read\n",
                    "declared names", (unsigned long long)session->names_declared.unused,
                    (unsigned long long)session->names_declared.declared);
    }
    if (!needs_module(scene)) {
        text_printf(out, "  %-22s%s\n", "OpenImageIO", "no picture that is read has another format than PNG");
    }
}

static rt_status explain_scene(rt_session *session, void *argument)
{
    Run whole;
    int threads = *(const int *)argument;
    Vec3 origin = scene_recentre(&session->scene);
    bool is_fine = run_scene(session, threads, &whole);
    if (is_fine) {
        write_stages(session, threads, &whole);
        is_fine = write_present(session, threads, &whole);
        write_absent(session, &whole);
    }
    scene_move_back(&session->scene, origin);
    if (atomic_load(&session->cancel)) {
        return RT_CANCELLED;
    }
    if (!is_fine || session->dump.failed) {
        diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory explaining the scene");
        return session_status(session, false);
    }
    return RT_OK;
}

rt_status rt_explain_scene(rt_session *session, int threads, const char **text)
{
    text_clear(&session->dump);
    *text = text_get(&session->dump);
    if (!session->loaded || !session_is_whole(session) || threads < 0) {
        return RT_FAULT_USAGE;
    }
    if (!session_memory_suffices(session)) {
        return session_status(session, false);
    }
    threads = threads ? threads : render_default_threads();
    rt_status status = session_run_deep(session, explain_scene, &threads);
    if (status == RT_OK) {
        *text = text_get(&session->dump);
    }
    return status;
}
