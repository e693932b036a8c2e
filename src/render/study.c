// The reference path: what it covers, and whole pictures of it.
//
// SPDX-License-Identifier: MIT
#include "render/study.h"

#include "base/parallel.h"
#include "render/prepared.h"
#include "render/study_kernels.h"

// What the kernel has; a feature that is added later is refused until it is put here.
enum {
    COVERED = TRACE_SPHERES | TRACE_SPHERE_BVH | TRACE_ELLIPSOIDS | TRACE_PLANES | RENDER_SHADOWS | RENDER_HIGHLIGHTS |
              RENDER_BRILLIANCE | RENDER_REFLECTION | RENDER_TRANSPARENCY | RENDER_EXPONENT | RENDER_TEXTURES |
              RENDER_INTERIORS,
    REFUSED_WITH_PLACE = TRACE_PARTS | RENDER_LIGHTS | RENDER_SKY | RENDER_FOG | RENDER_NORMALS,
};

static const struct {
    const char *name;
    StudyKernel colour;
} kernels[STUDY_PRECISIONS] = {
    [STUDY_FLOAT] = {"float", study_colour_float},
    [STUDY_DOUBLE] = {"double", study_colour_double},
    [STUDY_QUAD] = {"quad", study_colour_quad},
};

const char *study_name(StudyPrecision precision)
{
    return kernels[precision].name;
}

// ---- what is covered

static bool refuse(DiagSink *diags, Span span, const char *what)
{
    if (diag_report(diags, DIAG_E0446, span, "%s is not in the reference path", what)) {
        diag_suggest(
            diags,
            "leave out `--precision`, or use spheres and planes with plain textures, point lights and parallel ones");
    }
    return false;
}

static bool lights_are_covered(const Scene *scene, const Prepared *p, DiagSink *diags)
{
    for (size_t i = 0; i < p->light_count; i++) {
        if (!p->lights[i].is_plain) {
            return refuse(diags, scene->lights.items[p->lights[i].number].span,
                          "a light that is not of one point or direction");
        }
    }
    return true;
}

static bool compound_is_plain(const Scene *scene, const Compound *compound)
{
    const Texture *texture = &scene->textures.items[compound->texture];
    return texture->pattern.type == PATTERN_NONE && texture->below == RECORD_NONE &&
           texture->pigment.pattern == RECORD_NONE && texture->normal == RECORD_NONE;
}

// Where the first shape of a compound material stands.
static uint64_t compound_source(const Scene *scene, size_t compound)
{
    MaterialIndex material = (MaterialIndex)compound | MATERIAL_COMPOUND;
    for (size_t i = 0; i < scene->spheres.count; i++) {
        if (scene->spheres.items[i].material == material) {
            return scene->spheres.items[i].source;
        }
    }
    for (size_t i = 0; i < scene->ellipsoids.count; i++) {
        if (scene->ellipsoids.items[i].material == material) {
            return scene->ellipsoids.items[i].source;
        }
    }
    for (size_t i = 0; i < scene->planes.count; i++) {
        if (scene->planes.items[i].material == material) {
            return scene->planes.items[i].source;
        }
    }
    for (size_t i = 0; i < scene->parts.count; i++) {
        if (scene->parts.items[i].material == material) {
            return scene->parts.items[i].source;
        }
    }
    return 0;
}

bool study_covers(const Prepared *p, DiagSink *diags)
{
    const Scene *scene = p->scene;
    bool covers = lights_are_covered(scene, p, diags);
    if (scene->parts.count > 0) {
        covers =
            refuse(diags, scene_source_span(scene->parts.items[0].source), "a shape other than spheres and planes");
    }
    if (scene->camera.type > CAMERA_ORTHOGRAPHIC) {
        covers = refuse(diags, scene->camera.span, "a camera that is neither perspective nor orthographic");
    }
    if (p->camera.lens_radius > 0.0) {
        covers = refuse(diags, scene->camera.span, "a camera with an `aperture`");
    }
    if (scene->sky.count > 0) {
        covers = refuse(diags, scene->sky_span, "a sky_sphere");
    }
    if (scene->fogs.count > 0) {
        covers = refuse(diags, scene->fogs.items[0].span, "fog");
    }
    for (size_t i = 0; i < scene->compounds.count; i++) {
        if (!compound_is_plain(scene, &scene->compounds.items[i])) {
            covers =
                refuse(diags, scene_source_span(compound_source(scene, i)), "a texture of patterns, layers or bumps");
            break;
        }
    }
    if (p->features & ~(unsigned)(COVERED | REFUSED_WITH_PLACE)) {
        covers = refuse(diags, scene->whole, "something that this scene needs");
    }
    return covers;
}

// ---- pictures

Rgb study_colour(const Prepared *prepared, StudyPrecision precision, double u, double v)
{
    RenderStatistics unused = {0};
    return kernels[precision].colour(prepared, u, v, &unused);
}

typedef struct Work {
    const Prepared *prepared;
    StudyKernel colour;
    const RenderOptions *options;
    Film *film;
    Filter filter;
    atomic_int next, done;
    _Atomic uint64_t camera, shadow, reflected, transmitted;
} Work;

static Rgb colour_at(const Work *work, int x, int y, FilterSample at, RenderStatistics *statistics)
{
    return work->colour(work->prepared, film_u(work->film, x, at.x), film_v(work->film, y, at.y), statistics);
}

// The mean over the places where the usual kernels sample the pixel, too.
static Rgb sampled_colour(const Work *work, int x, int y, RenderStatistics *statistics)
{
    const SamplingOptions *sampling = work->options->sampling;
    const Film *film = work->film;
    uint32_t count = (uint32_t)sampling->samples;
    SampleStream stream = {
        .kind = sampling->sampler,
        .seed = sampler_pixel_seed(sampling->seed, (uint32_t)(film->left + x), (uint32_t)(film->top + y)),
        .count = count};
    Rgb sum = rgb_grey(0.0);
    for (; stream.index < count; stream.index++) {
        stream.pair = 0;
        FilterSample at = filter_sample(&work->filter, sample_next(&stream));
        sum = rgb_add_scaled(sum, at.weight, colour_at(work, x, y, at, statistics));
    }
    return rgb_scale(1.0 / count, sum);
}

static void trace_row(const Work *work, int y, RenderStatistics *statistics)
{
    const Film *film = work->film;
    for (int x = 0; x < film->width; x++) {
        Rgb colour = work->options->sampling ? sampled_colour(work, x, y, statistics)
                                             : colour_at(work, x, y, (FilterSample){.weight = 1.0}, statistics);
        float *pixel = &film->rgb[3 * ((size_t)y * (size_t)film->width + (size_t)x)];
        pixel[0] = (float)colour.red;
        pixel[1] = (float)colour.green;
        pixel[2] = (float)colour.blue;
    }
}

static void trace_rows(void *client, int thread)
{
    Work *work = client;
    const RenderOptions *options = work->options;
    RenderStatistics statistics = {0};
    for (int y; (y = atomic_fetch_add(&work->next, 1)) < work->film->height;) {
        if (options->cancel && atomic_load(options->cancel)) {
            return;
        }
        trace_row(work, y, &statistics);
        int done = atomic_fetch_add(&work->done, 1) + 1;
        if (thread == 0 && options->progress) {
            options->progress(options->client,
                              &(RenderProgress){.done = (double)done / work->film->height, .seconds_left = -1.0});
        }
    }
    atomic_fetch_add(&work->camera, statistics.camera_rays);
    atomic_fetch_add(&work->shadow, statistics.shadow_rays);
    atomic_fetch_add(&work->reflected, statistics.reflected_rays);
    atomic_fetch_add(&work->transmitted, statistics.transmitted_rays);
}

RenderResult study_film(const Prepared *prepared, StudyPrecision precision, const RenderOptions *options, Film *film,
                        RenderStatistics *statistics)
{
    Work work = {.prepared = prepared, .colour = kernels[precision].colour, .options = options, .film = film};
    filter_init(&work.filter, options->sampling ? options->sampling->filter : FILTER_BOX);
    parallel_run(options->threads < film->height ? options->threads : film->height, trace_rows, &work);
    *statistics = (RenderStatistics){.camera_rays = work.camera,
                                     .shadow_rays = work.shadow,
                                     .reflected_rays = work.reflected,
                                     .transmitted_rays = work.transmitted};
    return atomic_load(&work.done) == film->height ? RENDER_OK : RENDER_CANCELLED;
}
