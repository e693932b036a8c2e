// A scene that is built by calls: arrays become the records that text of the same numbers becomes; spheres do in
// build_spheres.c.
//
// All numbers are looked at before any is taken, so that a call adds all or nothing. Limits count as for text. The
// spans of records name the element of the array. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "api/arrays.h"
#include "scene/form.h"
#include "scene/primitive.h"
#include "scene/room.h"
#include "scene/tail.h"

bool session_begin(rt_session *session)
{
    session->past_errors += session->diags.error_count;
    session->past_warnings += session->diags.warning_count;
    diag_restart(&session->diags);
    session->diags_delivered = 0;
    return session->is_built && !session->is_broken && !session->is_spent;
}

rt_status rt_begin_scene(rt_session *session)
{
    if (session->loaded || session->is_spent || session->is_broken || session->world.scale > 0.0) {
        return RT_FAULT_USAGE;
    }
    session->is_built = true;
    session->loaded = true;
    session->scene.settings.version = 3.7;
    return RT_OK;
}

// ---- a list of elements

Span shape_list_span(const ShapeList *list, size_t element)
{
    return (Span){list->base + element, list->base + element + 1};
}

bool session_no_room(rt_session *session, Span span)
{
    size_t limit = session_memory_granted(session);
    MemoryBudget budget = {.limit = limit, .refused = !scene_memory_has(&session->scene, 0, 0, limit)};
    limits_report_memory(&session->diags, span, &budget, "adding shapes");
    return false;
}

bool shape_list_has_room(const ShapeList *list, size_t count, size_t bytes_each)
{
    rt_session *session = list->session;
    size_t limit = session_memory_granted(session);
    Span span = shape_list_span(list, 0);
    if (!scene_has_room(&session->scene, count, &session->limits, &session->diags, span)) {
        return false;
    }
    if (count > SIZE_MAX / bytes_each || !scene_memory_has(&session->scene, 0, count * bytes_each, limit)) {
        MemoryBudget budget = {.limit = limit, .refused = true};
        limits_report_memory(&session->diags, span, &budget, "adding shapes");
        return false;
    }
    return true;
}

bool look_is_known(const rt_look *look)
{
    return !array_is_given(&look->colors) || (look->color_numbers >= 3 && look->color_numbers <= 5);
}

ArrayCheck look_check(const rt_look *look)
{
    return (ArrayCheck){"color", &look->colors, look->color_numbers, ARRAY_COLOR};
}

bool shape_list_begin(ShapeList *list, rt_session *session, const ShapeArrays *arrays)
{
    *list = (ShapeList){.session = session, .source = source_open_list(session->sources, arrays->name, arrays->count)};
    if (!list->source) {
        return session_no_room(session, SPAN_NONE);
    }
    list->base = source_base(list->source);
    for (int i = 0; i < arrays->check_count; i++) {
        const ArrayCheck *check = &arrays->checks[i];
        size_t numbers = array_is_given(check->array) ? (size_t)check->numbers : 0;
        session->array_bytes += numbers * arrays->count * sizeof(double);
    }
    return session_read_finish(session, arrays->look->finish, &list->finish);
}

// The same, and looks at all of the elements.
static bool shape_list_open(ShapeList *list, rt_session *session, const ShapeArrays *arrays)
{
    return shape_list_begin(list, session, arrays) &&
           arrays_are_fine(session, arrays->checks, arrays->check_count, arrays->count, list->base);
}

rt_status session_finish_call(rt_session *session, bool fine)
{
    diag_finish(&session->diags);
    return session_status(session, fine && session->diags.error_count == 0);
}

// ---- parts

void shape_list_warn(const ShapeList *list, size_t element, const char *why)
{
    diag_report(&list->session->diags, DIAG_W0348, shape_list_span(list, element), "%s", why);
}

typedef const char *(*MakePart)(const void *shapes, size_t element, Primitive *primitive);

// False: nothing is left to add, after a fault or not (*fine).
static bool part_make(const ShapeList *list, MakePart make, const void *shapes, size_t element, Primitive *primitive,
                      bool *fine)
{
    *primitive = part_empty(list->base + element);
    const char *why_nothing = make(shapes, element, primitive);
    if (why_nothing) {
        shape_list_warn(list, element, why_nothing);
        return false;
    }
    *fine = part_finish(primitive);
    if (!*fine) {
        diag_report(&list->session->diags, DIAG_E0460, shape_list_span(list, element), "this %s cannot be represented",
                    primitive_class(primitive->kind)->word);
    }
    return *fine;
}

static bool parts_add(const ShapeList *list, MakePart make, const void *shapes, size_t count, const rt_look *look)
{
    Scene *scene = &list->session->scene;
    uint32_t shape_count = scene->shape_count;
    bool fine = shape_list_has_room(list, count, sizeof(Primitive));
    if (fine && !ARRAY_RESERVE(&scene->primitives, scene->primitives.count + count)) {
        return session_no_room(list->session, shape_list_span(list, 0));
    }
    for (size_t i = 0; fine && i < count; i++) {
        Primitive primitive;
        if (!part_make(list, make, shapes, i, &primitive, &fine)) {
            continue;
        }
        Material material = look_material(look, i, list->finish);
        fine = (scene_add_material_record(scene, &material, &primitive.material) &&
                scene_add_primitive(scene, &primitive)) ||
               session_no_room(list->session, shape_list_span(list, i));
    }
    fine = fine && (scene_memory_has(scene, 0, 0, session_memory_granted(list->session)) ||
                    session_no_room(list->session, shape_list_span(list, 0)));
    if (!fine) {
        scene_keep_shapes(scene, shape_count);
    }
    return fine;
}

static const char *make_rod(const void *shapes, size_t element, Primitive *primitive)
{
    const rt_rods *rods = shapes;
    Vec3 base = array_vector(&rods->bases, element, 0), cap = array_vector(&rods->caps, element, 0);
    double radius = array_number(&rods->base_radii, element, 0);
    return array_is_given(&rods->cap_radii)
               ? primitive_make_cone(primitive, base, radius, cap, array_number(&rods->cap_radii, element, 0),
                                     rods->open)
               : primitive_make_cylinder(primitive, base, cap, radius, rods->open);
}

static bool rods_have_ends(rt_session *session, const rt_rods *rods, uint64_t base)
{
    for (size_t i = 0; i < rods->count; i++) {
        if (vec3_equal(array_vector(&rods->bases, i, 0), array_vector(&rods->caps, i, 0))) {
            diag_report(&session->diags, DIAG_E0460, (Span){base + i, base + i + 1},
                        "the ends of a rod cannot be one point");
            return false;
        }
    }
    return true;
}

rt_status rt_add_rods(rt_session *session, const rt_rods *rods)
{
    if (!session_begin(session)) {
        return session_not_begun(session, "rt_add_rods");
    }
    if (!look_is_known(&rods->look) || !array_is_given(&rods->bases) || !array_is_given(&rods->caps) ||
        !array_is_given(&rods->base_radii)) {
        return session_misuse(session, "rt_add_rods needs bases, caps, radii, and colors of 3 to 5 numbers", NULL);
    }
    ArrayCheck checks[] = {{"base", &rods->bases, 3, ARRAY_FINITE},
                           {"cap", &rods->caps, 3, ARRAY_FINITE},
                           {"radius", &rods->base_radii, 1, ARRAY_NOT_NEGATIVE},
                           {"radius of the cap", &rods->cap_radii, 1, ARRAY_NOT_NEGATIVE},
                           look_check(&rods->look)};
    const ShapeArrays arrays = {rods->name ? rods->name : "rods", rods->count, checks, 5, &rods->look};
    ShapeList list;
    bool fine = shape_list_open(&list, session, &arrays) && rods_have_ends(session, rods, list.base) &&
                parts_add(&list, make_rod, rods, rods->count, &rods->look);
    session->is_checked = false;
    return session_finish_call(session, fine);
}

static const char *make_triangle(const void *shapes, size_t element, Primitive *primitive)
{
    const rt_triangles *triangles = shapes;
    Vec3 corners[3], normals[3];
    bool is_smooth = array_is_given(&triangles->normals);
    for (int k = 0; k < 3; k++) {
        corners[k] = array_vector(&triangles->corners, element, 3 * k);
        normals[k] = is_smooth ? array_vector(&triangles->normals, element, 3 * k) : corners[k];
    }
    return is_smooth ? primitive_make_smooth_triangle(primitive, corners, normals)
                     : primitive_make_triangle(primitive, corners);
}

rt_status rt_add_triangles(rt_session *session, const rt_triangles *triangles)
{
    if (!session_begin(session)) {
        return session_not_begun(session, "rt_add_triangles");
    }
    if (!look_is_known(&triangles->look) || !array_is_given(&triangles->corners)) {
        return session_misuse(session, "rt_add_triangles needs corners, and colors of 3 to 5 numbers", NULL);
    }
    ArrayCheck checks[] = {{"corners", &triangles->corners, 9, ARRAY_FINITE},
                           {"normals", &triangles->normals, 9, ARRAY_FINITE},
                           look_check(&triangles->look)};
    const ShapeArrays arrays = {triangles->name ? triangles->name : "triangles", triangles->count, checks, 3,
                                &triangles->look};
    ShapeList list;
    bool fine = shape_list_open(&list, session, &arrays) &&
                parts_add(&list, make_triangle, triangles, triangles->count, &triangles->look);
    session->is_checked = false;
    return session_finish_call(session, fine);
}
