// What a perspective or an orthographic camera cannot see: what lies wholly beyond one of the planes around its view.
//
// Owns nothing; changes nothing.
//
// SPDX-License-Identifier: MIT
#include "scene/view.h"

#include <math.h>

#include "scene/opaque.h"
#include "scene/primitive_reach.h"

enum { SIDES = 5 };

// Half spaces around what is seen: p with p·normal >= least. The last one is ahead of the camera.
typedef struct View {
    Vec3 normals[SIDES];
    double least[SIDES];
} View;

static void view_init(View *view, const Camera *camera)
{
    bool is_flat = camera->type == CAMERA_ORTHOGRAPHIC;
    const Vec3 half[] = {vec3_scale(0.5, camera->right), vec3_scale(-0.5, camera->right), vec3_scale(0.5, camera->up),
                         vec3_scale(-0.5, camera->up), vec3(0.0, 0.0, 0.0)};
    for (int i = 0; i < SIDES; i++) {
        Vec3 across = i < 2 ? camera->up : camera->right;
        Vec3 edge = vec3_add(camera->direction, half[i]);
        Vec3 normal = i == SIDES - 1 ? camera->direction : vec3_cross(is_flat ? camera->direction : edge, across);
        Vec3 inner = i == SIDES - 1 ? camera->direction : vec3_neg(half[i]);
        view->normals[i] = vec3_normalize(vec3_dot(normal, inner) < 0.0 ? vec3_neg(normal) : normal);
        Vec3 start = is_flat ? vec3_add(camera->location, half[i]) : camera->location;
        view->least[i] = vec3_dot(start, view->normals[i]);
    }
}

static bool sees_ball(const View *view, Vec3 centre, double radius)
{
    for (int i = 0; i < SIDES; i++) {
        if (vec3_dot(centre, view->normals[i]) + radius < view->least[i]) {
            return false;
        }
    }
    return true;
}

static bool sees_part(const View *view, const Primitive *primitive)
{
    for (int i = 0; i < SIDES; i++) {
        if (primitive_support(primitive, view->normals[i]) < view->least[i]) {
            return false;
        }
    }
    return true;
}

// A plane is seen unless all rays go away from it, for which those at the corners stand.
static bool sees_plane(const Camera *camera, const Plane *plane)
{
    double distance = plane->distance - vec3_dot(plane->normal, camera->location);
    bool is_seen = camera->type == CAMERA_ORTHOGRAPHIC;
    for (int corner = 0; !is_seen && corner < 4; corner++) {
        Vec3 way = vec3_add_scaled(camera->direction, corner & 1 ? 0.5 : -0.5, camera->right);
        way = vec3_add_scaled(way, corner & 2 ? 0.5 : -0.5, camera->up);
        is_seen = distance == 0.0 || vec3_dot(plane->normal, way) * distance > 0.0;
    }
    return is_seen;
}

static bool sees_anything(const Scene *scene, const View *view)
{
    bool is_seen = false;
    for (size_t i = 0; !is_seen && i < scene->planes.count; i++) {
        is_seen = sees_plane(&scene->camera, &scene->planes.items[i]);
    }
    for (size_t i = 0; !is_seen && i < scene->primitives.count; i++) {
        is_seen = sees_part(view, &scene->primitives.items[i]);
    }
    for (size_t i = 0; !is_seen && i < scene->spheres.count; i++) {
        is_seen = sees_ball(view, scene->spheres.items[i].centre, scene->spheres.items[i].radius);
    }
    return is_seen;
}

size_t scene_first_seen(const Scene *scene)
{
    View view;
    size_t i = 0;
    view_init(&view, &scene->camera);
    while (i < scene->spheres.count &&
           !sees_ball(&view, scene->spheres.items[i].centre, scene->spheres.items[i].radius)) {
        i++;
    }
    return i;
}

static Span camera_span(const Scene *scene)
{
    return scene->has_camera ? scene->camera.span : scene->whole;
}

static void hint_of_nothing(const Scene *scene, DiagSink *diags)
{
    View view;
    view_init(&view, &scene->camera);
    if (scene->shape_count > 0 && scene->camera.lens_radius == 0.0 && !sees_anything(scene, &view) &&
        diag_report(diags, DIAG_W0450, camera_span(scene), "the camera sees none of the scene's shapes")) {
        diag_suggest(diags, "`look_at` turns it to a point of the scene");
    }
}

static bool holds(const Sphere *sphere, Vec3 point)
{
    return vec3_length(vec3_sub(point, sphere->centre)) < sphere->radius;
}

// A sky around the whole scene has shapes or lights in it as well.
static bool holds_other_things(const Scene *scene, const Sphere *outer)
{
    bool holds_some = scene->planes.count + scene->primitives.count > 0;
    for (size_t i = 0; !holds_some && i < scene->lights.count; i++) {
        holds_some = holds(outer, scene->lights.items[i].position);
    }
    for (size_t i = 0; !holds_some && i < scene->spheres.count; i++) {
        const Sphere *sphere = &scene->spheres.items[i];
        holds_some = sphere != outer && holds(outer, sphere->centre);
    }
    return holds_some;
}

static void hint_of_inside(const Scene *scene, DiagSink *diags)
{
    for (size_t i = 0; i < scene->spheres.count; i++) {
        const Sphere *sphere = &scene->spheres.items[i];
        if (holds(sphere, scene->camera.location) && scene_material_is_opaque(scene, sphere->material) &&
            !holds_other_things(scene, sphere)) {
            if (diag_report(diags, DIAG_W0451, scene_source_span(scene_sphere_source(scene, i)),
                            "the camera is inside this sphere, which hides all else") && scene->has_camera) {
                diag_note(diags, scene->camera.span, "the camera");
            }
            return;
        }
    }
}

static void hint_of_sides(const Scene *scene, int width, int height, DiagSink *diags)
{
    const double least = 1.03; // the usual 1.33 and 4/3 are one part in 400 apart
    double right = vec3_length(scene->camera.right), up = vec3_length(scene->camera.up);
    double of_camera = right / up, of_picture = (double)width / (double)height;
    double stretched = of_picture / of_camera;
    if ((stretched > least || stretched < 1.0 / least) &&
        diag_report(diags, DIAG_W0452, camera_span(scene),
                    "the picture is stretched: it is %.3g times as wide as high, what the camera sees %.3g times",
                    of_picture, of_camera)) {
        diag_suggest(diags, "`right x*image_width/image_height` fits any picture");
    }
}

void scene_hint_of_view(const Scene *scene, int width, int height, DiagSink *diags)
{
    const Camera *camera = &scene->camera;
    if ((camera->type != CAMERA_PERSPECTIVE && camera->type != CAMERA_ORTHOGRAPHIC) || camera->bumps) {
        return;
    }
    if (diag_is_on(diags, DIAG_W0450)) {
        hint_of_nothing(scene, diags);
    }
    if (diag_is_on(diags, DIAG_W0451)) {
        hint_of_inside(scene, diags);
    }
    if (diag_is_on(diags, DIAG_W0452)) {
        hint_of_sides(scene, width, height, diags);
    }
}
