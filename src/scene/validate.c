// What only the whole scene can tell, and what the renderer relies on.
//
// Reports warnings about what is missing and located faults about records that no ray could be traced against. Changes
// nothing.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdatomic.h>

#include "base/parallel.h"
#include "scene/faces.h"
#include "scene/range.h"

static bool rgb_is_finite(Rgb a)
{
    return isfinite(a.red) && isfinite(a.green) && isfinite(a.blue);
}

static bool fault(DiagSink *diags, DiagCode code, uint64_t source, const char *what)
{
    diag_report(diags, code, scene_source_span(source), "%s", what);
    return false;
}

static bool camera_is_valid(const Camera *camera, DiagSink *diags)
{
    if (vec3_is_finite(camera->location) && vec3_is_finite(camera->direction) && vec3_is_finite(camera->right) &&
        vec3_is_finite(camera->up)) {
        return true;
    }
    diag_report(diags, DIAG_E0410, camera->span, "the camera has a coordinate that is not finite");
    return false;
}

static bool lights_are_valid(const Scene *scene, DiagSink *diags)
{
    bool valid = true;
    for (size_t i = 0; i < scene->lights.count; i++) {
        const Light *light = &scene->lights.items[i];
        if (!vec3_is_finite(light->position) || !vec3_is_finite(light->point_at) || !rgb_is_finite(light->colour) ||
            !vec3_is_finite(light->area.axis1) || !vec3_is_finite(light->area.axis2)) {
            diag_report(diags, DIAG_E0411, light->span, "the light has a number that is not finite");
            valid = false;
        }
        if (light->is_attenuated && scene->fogs.count > 0) {
            diag_report(diags, DIAG_E0251, light->span, "`media_attenuation` in fog is not supported by rtlang");
            valid = false;
        }
    }
    return valid;
}

static bool finish_is_finite(const Finish *finish)
{
    return rgb_is_finite(finish->ambient) && rgb_is_finite(finish->emission) && isfinite(finish->diffuse) &&
           isfinite(finish->diffuse_back) && isfinite(finish->brilliance) && isfinite(finish->phong) &&
           isfinite(finish->phong_size) && isfinite(finish->specular) && isfinite(finish->roughness) &&
           isfinite(finish->metallic) && rgb_is_finite(finish->reflection_min) &&
           rgb_is_finite(finish->reflection_max) && isfinite(finish->reflection_falloff) &&
           isfinite(finish->reflection_exponent) && isfinite(finish->reflection_metallic) && isfinite(finish->crand) &&
           isfinite(finish->irid) && isfinite(finish->irid_thickness) && isfinite(finish->irid_turbulence);
}

// Records that are looked at in runs, on several threads.
typedef struct Check {
    const Scene *scene;
    atomic_bool has_invalid;
} Check;

// Without a branch for each: what is not finite leaves something of 0 times itself.
static void check_materials(void *client, size_t begin, size_t end)
{
    Check *check = client;
    const Material *materials = check->scene->materials.items;
    float nothing = 0.0F; // as long as all is finite
    size_t finishes = check->scene->finishes.count;
    bool has_finish = true;
    for (size_t i = begin; i < end; i++) {
        Material material = materials[i];
        nothing += material.red * 0.0F + material.green * 0.0F + material.blue * 0.0F + material.filter * 0.0F +
                   material.transmit * 0.0F;
        has_finish = has_finish & (material.finish < finishes);
    }
    if (nothing != 0.0F || !has_finish) {
        atomic_store(&check->has_invalid, true);
    }
}

static bool materials_are_valid(const Scene *scene, DiagSink *diags, int threads)
{
    Check check = {.scene = scene};
    bool finite = true;
    for (size_t i = 0; finite && i < scene->finishes.count; i++) {
        finite = finish_is_finite(&scene->finishes.items[i]);
    }
    parallel_share(threads, scene->materials.count, SPHERE_RUN, check_materials, &check);
    finite = finite && !atomic_load(&check.has_invalid);
    return finite || fault(diags, DIAG_E0412, 0, "a texture has a number that is not finite");
}

static bool sphere_is_valid(const Scene *scene, const Sphere *sphere)
{
    return vec3_is_finite(sphere->centre) && isfinite(sphere->radius) && sphere->radius > 0.0 &&
           scene_has_material(scene, sphere->material);
}

// If there is one that is not valid, all are looked at in order.
static bool spheres_are_valid(const Scene *scene, const SphereSurvey *survey, DiagSink *diags)
{
    for (size_t i = 0; !survey->is_valid && i < scene->spheres.count; i++) {
        const Sphere *sphere = &scene->spheres.items[i];
        if (!sphere_is_valid(scene, sphere)) {
            fault(diags, DIAG_E0413, scene_sphere_source(scene, i), "the sphere cannot be represented");
        }
    }
    return survey->is_valid;
}

static bool shapes_are_valid(const Scene *scene, const SphereSurvey *survey, DiagSink *diags)
{
    bool valid = spheres_are_valid(scene, survey, diags);
    for (size_t i = 0; i < scene->planes.count; i++) {
        const Plane *plane = &scene->planes.items[i];
        if (!vec3_is_finite(plane->normal) || !isfinite(plane->distance) ||
            vec3_equal(plane->normal, vec3(0.0, 0.0, 0.0)) || !scene_has_material(scene, plane->material)) {
            valid = fault(diags, DIAG_E0413, plane->source, "the plane cannot be represented");
        }
    }
    return valid;
}

static bool parts_are_valid(const Scene *scene, DiagSink *diags)
{
    bool valid = true;
    for (size_t i = 0; i < scene->primitives.count; i++) {
        const Primitive *primitive = &scene->primitives.items[i];
        bool is_finite = transform_is_finite(&primitive->to_world) && transform_is_finite(&primitive->to_object);
        for (int k = 0; k < 3; k++) {
            is_finite = is_finite && vec3_is_finite(primitive->data[k]);
        }
        bool is_seen = !(primitive->flags & PRIMITIVE_UNSEEN);
        if (!is_finite || (is_seen && !scene_has_material(scene, primitive->material)) ||
            (primitive->node != NODE_NONE && primitive->node >= scene->nodes.count)) {
            valid = fault(diags, DIAG_E0413, primitive->source, "the shape cannot be represented");
        }
    }
    return valid;
}

static void warn_of_what_is_missing(const Scene *scene, DiagSink *diags)
{
    if (!scene->has_camera) {
        diag_report(diags, DIAG_W0401, scene->whole,
                    "no camera: the default one at <0, 0, 0> looks along z with right <1.33, 0, 0>");
    }
    if (scene->shape_count == 0) {
        diag_report(diags, DIAG_W0403, scene->whole, "no objects: only the background is drawn");
    } else if (scene->lights.count == 0 && rgb_is_black(scene->settings.sky_light)) {
        diag_report(diags, DIAG_W0402, scene->whole, "no lights: only ambient and emission are seen");
    }
}

bool scene_validate_view(const Scene *scene, DiagSink *diags, int threads)
{
    SphereSurvey survey;
    warn_of_what_is_missing(scene, diags);
    bool valid = camera_is_valid(&scene->camera, diags);
    valid = lights_are_valid(scene, diags) && valid;
    if (valid) {
        scene_survey_spheres(scene, threads, &survey);
        scene_warn_of_range(scene, &survey, diags);
    }
    return valid;
}

bool scene_validate_share(const Scene *scene, DiagSink *diags, int threads)
{
    SphereSurvey survey;
    warn_of_what_is_missing(scene, diags);
    bool valid = camera_is_valid(&scene->camera, diags);
    valid = lights_are_valid(scene, diags) && valid;
    valid = materials_are_valid(scene, diags, threads) && valid;
    valid = parts_are_valid(scene, diags) && valid;
    scene_survey_spheres(scene, threads, &survey);
    return shapes_are_valid(scene, &survey, diags) && valid;
}

bool scene_validate(const Scene *scene, DiagSink *diags, int threads)
{
    SphereSurvey survey;
    if (!scene_validate_share(scene, diags, threads)) {
        return false;
    }
    scene_survey_spheres(scene, threads, &survey);
    scene_warn_of_range(scene, &survey, diags);
    if (!scene_warn_of_coincident(scene, diags, threads) || !scene_warn_of_faces(scene, diags)) {
        diag_report(diags, DIAG_E0602, SPAN_NONE, "out of memory looking for shapes that coincide");
        return false;
    }
    return true;
}
