// The reference path: what it covers, and its kernels in the form that pictures are traced by.
//
// SPDX-License-Identifier: MIT
#include "render/reference/reference.h"

#include "render/records/prepared.h"
#include "render/reference/reference_kernels.h"

// What the kernel has; a feature that is added later is refused until it is put here.
enum {
    COVERED = TRACE_SPHERES | TRACE_SPHERE_BVH | TRACE_PLANES | RENDER_SHADOWS | RENDER_HIGHLIGHTS | RENDER_BRILLIANCE |
              RENDER_REFLECTION | RENDER_TRANSPARENCY | RENDER_EXPONENT | RENDER_PIGMENTS | RENDER_TEXTURES |
              RENDER_INTERIORS,
    REFUSED_WITH_PLACE = TRACE_PRIMITIVES | RENDER_LIGHTS | RENDER_SKY | RENDER_FOG | RENDER_NORMALS,
};

static const StudyKernel colours[STUDY_PRECISIONS] = {
    [STUDY_FLOAT] = study_colour_float,
    [STUDY_DOUBLE] = study_colour_double,
    [STUDY_QUAD] = study_colour_quad,
};

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
    if (p->has_dome) {
        return refuse(diags, scene->whole, "light from all sides");
    }
    for (size_t i = 0; i < p->light_count; i++) {
        if (!p->lights[i].is_plain || scene->lights.items[p->lights[i].number].group != 0) {
            return refuse(diags, scene->lights.items[p->lights[i].number].span,
                          "a light that is not of one point or direction");
        }
    }
    return true;
}

static bool compound_is_plain(const Scene *scene, const Compound *compound)
{
    const Texture *texture = &scene->textures.items[compound->texture];
    return compound->inner == RECORD_NONE && compound->light_group == 0 && !compound->is_double &&
           texture->pattern.type == PATTERN_NONE && texture->below == RECORD_NONE &&
           texture->pigment.pattern == RECORD_NONE && texture->normal == RECORD_NONE;
}

// Whether the primitive, or a face of it, has the material.
static bool part_shows(const Scene *scene, const Primitive *primitive, MaterialIndex material)
{
    bool does = primitive->material == material;
    if (primitive->kind == PRIMITIVE_MESH || primitive->kind == PRIMITIVE_MESH_SOLID) {
        for (uint32_t i = 0; i < primitive->mesh.mesh->texture_count && !does; i++) {
            does = scene->face_materials.items[primitive->mesh.materials + i] == material;
        }
    }
    return does;
}

// Where the first shape of a compound material stands.
static uint64_t compound_source(const Scene *scene, size_t compound)
{
    MaterialIndex material = (MaterialIndex)compound | MATERIAL_COMPOUND;
    for (size_t i = 0; i < scene->spheres.count; i++) {
        if (scene->spheres.items[i].material == material) {
            return scene_sphere_source(scene, i);
        }
    }
    for (size_t i = 0; i < scene->planes.count; i++) {
        if (scene->planes.items[i].material == material) {
            return scene->planes.items[i].source;
        }
    }
    for (size_t i = 0; i < scene->primitives.count; i++) {
        if (part_shows(scene, &scene->primitives.items[i], material)) {
            return scene->primitives.items[i].source;
        }
    }
    return 0;
}

bool study_covers(const Prepared *p, DiagSink *diags)
{
    const Scene *scene = p->scene;
    bool covers = lights_are_covered(scene, p, diags);
    for (size_t i = 0; i < scene->primitives.count; i++) {
        const Primitive *primitive = &scene->primitives.items[i];
        if (primitive->kind != PRIMITIVE_SPHERE || primitive->node != NODE_NONE || primitive->hidden ||
            primitive->flags) {
            covers = refuse(diags, scene_source_span(primitive->source), "a shape other than spheres and planes");
            break;
        }
    }
    if (scene->camera.type > CAMERA_ORTHOGRAPHIC || scene->camera.bumps) {
        covers = refuse(diags, scene->camera.span,
                        scene->camera.bumps ? "a camera with a `normal`"
                                            : "a camera that is neither perspective nor orthographic");
    }
    if (p->camera.lens_radius > 0.0) {
        covers = refuse(diags, scene->camera.span, "a camera with an `aperture`");
    }
    if (scene->sky.count > 0) {
        covers = refuse(diags, scene->sky_span, "a sky_sphere");
    }
    for (size_t i = 0; i < p->finish_count; i++) {
        if (p->finishes[i].is_special) {
            covers = refuse(diags, scene->whole, "`crand` or `irid`");
            break;
        }
    }
    if (scene->rainbows.count > 0) {
        covers = refuse(diags, scene->rainbows.items[0].span, "a rainbow");
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

// Nothing that is covered draws numbers.
static void trace_wanted(const Prepared *p, StudyPrecision precision, const KernelCall *call)
{
    const KernelPlaces *places = call->places;
    for (uint64_t left = call->wanted; left; left &= left - 1) {
        int i = __builtin_ctzll(left);
        call->light[i] = colours[precision](p, places->u[i], places->v[i], call->scratch, call->statistics);
    }
}

static void trace_float(const Prepared *p, const KernelCall *call)
{
    trace_wanted(p, STUDY_FLOAT, call);
}

static void trace_double(const Prepared *p, const KernelCall *call)
{
    trace_wanted(p, STUDY_DOUBLE, call);
}

static void trace_quad(const Prepared *p, const KernelCall *call)
{
    trace_wanted(p, STUDY_QUAD, call);
}

void study_take(Prepared *prepared, StudyPrecision precision)
{
    static const Kernel kernels[STUDY_PRECISIONS] = {
        [STUDY_FLOAT] = {"float", COVERED, trace_float},
        [STUDY_DOUBLE] = {"double", COVERED, trace_double},
        [STUDY_QUAD] = {"quad", COVERED, trace_quad},
    };
    prepared->kernel = &kernels[precision];
}
