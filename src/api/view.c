// Camera, lights, background and finish of a scene that is built by calls.
//
// Numbers become a piece of text, and the evaluator makes of it what it makes of any text: there is one meaning only,
// and one set of faults. Knows nothing of arrays but how their records look.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "api/arrays.h"
#include "scene/scene_extent.h"

rt_status session_misuse(rt_session *session, const char *message, const char *suggestion)
{
    return rt_report(session, "E0709", message, suggestion);
}

rt_status session_not_begun(rt_session *session, const char *function)
{
    char message[120];
    snprintf(message, sizeof message, "%s is for a scene that was begun and is whole", function);
    return session_misuse(session, message, "rt_begin_scene");
}

typedef struct Piece {
    Source *source;
    Scene *scene;
} Piece;

static rt_status read_piece(rt_session *session, void *argument)
{
    const Piece *piece = argument;
    return session_evaluate(session, piece->source, piece->scene, session->scene.settings.version) ? RT_OK
                                                                                                   : RT_FAULT_SCENE;
}

// Evaluates a piece of text into a scene of its own, for what calls say in numbers; the scene is the caller's to
// free. What the text says wrong is reported under the name. False after a fault.
static bool session_read_piece(rt_session *session, const char *name, const char *text, Scene *scene)
{
    scene_init(scene);
    scene->settings = session->scene.settings;
    Piece piece = {source_open_text(session->sources, name, text, strlen(text)), scene};
    size_t before = session->diags.count;
    if (!piece.source) {
        diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory reading `%s`", name);
        return false;
    }
    bool is_fine = session_run_deep(session, read_piece, &piece) == RT_OK;
    source_close(piece.source);
    if (session->diags.count == before) {
        source_drop(piece.source); // nothing points there
    }
    return is_fine;
}

bool session_read_finish(rt_session *session, const char *finish, FinishIndex *index)
{
    TextBuffer text;
    Scene scene;
    text_init(&text);
    // The client's text has a line of its own, so that columns are right.
    text_printf(&text, "sphere { 0, 1 pigment { rgb 1 } finish {\n%s\n} }", finish ? finish : "");
    bool is_fine = !text.failed && session_read_piece(session, "finish", text_get(&text), &scene);
    if (is_fine) {
        const Sphere *sphere = scene.spheres.items;
        bool is_plain = scene.shape_count == 1 && scene.spheres.count == 1 && !(sphere->material & MATERIAL_COMPOUND);
        const Material *material = is_plain ? &scene.materials.items[sphere->material] : NULL;
        is_fine = is_plain && scene_add_finish(&session->scene, &scene.finishes.items[material->finish], index);
        if (!is_plain) {
            session_misuse(session, "a finish is what stands in the braces of `finish { }`, and no more", NULL);
        }
    }
    scene_fini(&scene);
    text_fini(&text);
    return is_fine;
}

// ---- numbers as text

static void add_number(TextBuffer *text, const char *before, double number)
{
    text_append(text, before);
    text_append_double(text, number);
}

static void add_vector(TextBuffer *text, const char *before, const double v[3])
{
    add_number(text, before, v[0]);
    add_number(text, ", ", v[1]);
    add_number(text, ", ", v[2]);
    text_append_char(text, '>');
}

static bool is_finite(const double *numbers, int count)
{
    bool are_finite = true;
    for (int i = 0; i < count; i++) {
        are_finite = are_finite && isfinite(numbers[i]);
    }
    return are_finite;
}

static bool is_zero(const double v[3])
{
    return v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0;
}

static bool number_fault(rt_session *session, const char *what)
{
    diag_report(&session->diags, DIAG_E0460, SPAN_NONE, "%s", what);
    return false;
}

static rt_status finish_call(rt_session *session, bool fine)
{
    diag_finish(&session->diags);
    return session_status(session, fine && session->diags.error_count == 0);
}

// ---- camera

static bool camera_is_known(rt_session *session, const rt_camera *camera)
{
    const double numbers[] = {camera->angle, camera->width, camera->aspect, camera->aperture};
    if (!is_finite(camera->location, 3) || !is_finite(camera->look_at, 3) || !is_finite(camera->up, 3) ||
        !is_finite(numbers, 4)) {
        return number_fault(session, "all numbers of a camera must be finite");
    }
    if (camera->angle < 0.0 || camera->angle >= 180.0 || camera->width < 0.0 || camera->aspect < 0.0 ||
        camera->aperture < 0.0) {
        return number_fault(session, "angle, width, aspect and aperture of a camera must be 0 or more, the angle less "
                                     "than 180");
    }
    return true;
}

static void camera_text(const rt_session *session, const rt_camera *camera, TextBuffer *text)
{
    double aspect = camera->aspect > 0.0 ? camera->aspect : (double)session->width / session->height;
    double unit = camera->width > 0.0 ? camera->width / aspect : 1.0; // the height of an orthographic picture
    double across = unit * aspect * (camera->right_handed ? -1.0 : 1.0);
    text_append(text, camera->width > 0.0 ? "camera { orthographic" : "camera {");
    add_vector(text, " location <", camera->location);
    add_vector(text, " right <", (const double[]){across, 0.0, 0.0});
    add_vector(text, " up <", (const double[]){0.0, unit, 0.0});
    if (!is_zero(camera->up)) {
        add_vector(text, " sky <", camera->up);
    }
    if (camera->angle > 0.0 && !(camera->width > 0.0)) {
        add_number(text, " angle ", camera->angle);
    }
    add_vector(text, " look_at <", camera->look_at);
    if (camera->aperture > 0.0) {
        add_number(text, " aperture ", camera->aperture);
        add_vector(text, " blur_samples 1 focal_point <", camera->look_at);
    }
    text_append(text, " }");
}

rt_status rt_set_camera(rt_session *session, const rt_camera *camera)
{
    if ((!session_begin(session) && session->is_built) || !session->loaded) {
        return session_misuse(session, "rt_set_camera needs a scene", "rt_begin_scene or rt_load_file");
    }
    if (!camera_is_known(session, camera)) {
        return finish_call(session, false);
    }
    TextBuffer text;
    Scene scene;
    text_init(&text);
    camera_text(session, camera, &text);
    bool is_fine = !text.failed && session_read_piece(session, "camera", text_get(&text), &scene);
    if (is_fine) {
        session->scene.camera = scene.camera;
        session->scene.camera.span = SPAN_NONE;
        session->scene.has_camera = true;
        session->is_viewed = false;
    }
    scene_fini(&scene);
    text_fini(&text);
    return finish_call(session, is_fine);
}

// ---- lights and background

static bool light_is_known(rt_session *session, const rt_light *light)
{
    if (!is_finite(light->position, 3) || !is_finite(light->color, 3) || !is_finite(light->point_at, 3) ||
        !isfinite(light->radius)) {
        return number_fault(session, "all numbers of a light must be finite");
    }
    if (light->radius < 0.0 || light->size < 0 || light->size == 1 || light->size > 64) {
        return number_fault(session, "the radius of a light must be 0 or more, and its size 2 to 64");
    }
    return true;
}

static void light_text(const rt_light *light, TextBuffer *text)
{
    int size = light->size > 0 ? light->size : 4;
    add_vector(text, "light_source { <", light->position);
    add_vector(text, ", rgb <", light->color);
    if (light->radius > 0.0) {
        add_vector(text, " area_light <", (const double[]){2.0 * light->radius, 0.0, 0.0});
        add_vector(text, ", <", (const double[]){0.0, 2.0 * light->radius, 0.0});
        text_printf(text, ", %d, %d circular orient jitter", size, size);
    }
    if (light->parallel) {
        add_vector(text, " parallel point_at <", light->point_at);
    }
    text_append(text, light->shadowless ? " shadowless }" : " }");
}

rt_status rt_add_light(rt_session *session, const rt_light *light)
{
    if (!session_begin(session)) {
        return session_not_begun(session, "rt_add_light");
    }
    if (!light_is_known(session, light)) {
        return finish_call(session, false);
    }
    TextBuffer text;
    Scene scene;
    text_init(&text);
    light_text(light, &text);
    bool is_fine = !text.failed && session_read_piece(session, "light", text_get(&text), &scene) &&
                   scene.lights.count > 0;
    if (is_fine) {
        scene.lights.items[0].span = SPAN_NONE;
        is_fine = scene_add_light(&session->scene, &scene.lights.items[0]);
        session->is_viewed = false;
    }
    scene_fini(&scene);
    text_fini(&text);
    return finish_call(session, is_fine);
}

rt_status rt_clear_lights(rt_session *session)
{
    if (!session_begin(session)) {
        return session_not_begun(session, "rt_clear_lights");
    }
    session->scene.lights.count = 0;
    session->is_viewed = false;
    return RT_OK;
}

rt_status rt_set_background(rt_session *session, const double color[4])
{
    if (!session_begin(session)) {
        return session_not_begun(session, "rt_set_background");
    }
    if (!is_finite(color, 4)) {
        number_fault(session, "all numbers of a background must be finite");
        return finish_call(session, false);
    }
    TextBuffer text;
    Scene scene;
    text_init(&text);
    add_vector(&text, "background { rgbt <", color);
    text.length -= !text.failed; // without its end
    add_number(&text, ", ", color[3]);
    text_append(&text, "> }");
    bool is_fine = !text.failed && session_read_piece(session, "background", text_get(&text), &scene);
    if (is_fine) {
        session->scene.background = scene.background;
    }
    scene_fini(&scene);
    text_fini(&text);
    return finish_call(session, is_fine);
}

// ---- the box

rt_status rt_get_box(const rt_session *session, double low[3], double high[3])
{
    static const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    bool has_shapes = session->loaded;
    for (int k = 0; k < 3; k++) {
        has_shapes = scene_span(&session->scene, axes[k], &low[k], &high[k]) && has_shapes;
    }
    return has_shapes ? RT_OK : RT_FAULT_USAGE;
}
