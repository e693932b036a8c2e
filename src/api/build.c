// A scene that is built by calls: arrays become the records that text of the same numbers becomes.
//
// All numbers are looked at before any is taken, so that a call adds all or nothing. Limits count as for text. The spans
// of records name the element of the array. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "api/arrays.h"
#include "scene/form.h"
#include "scene/primitive.h"
#include "scene/room.h"

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

typedef struct List {
    rt_session *session;
    Source *source;
    uint64_t base;
    FinishIndex finish;
} List;

static Span span_of(const List *list, size_t element)
{
    return (Span){list->base + element, list->base + element + 1};
}

static bool no_memory(rt_session *session, Span span)
{
    size_t limit = session_memory_granted(session);
    MemoryBudget budget = {.limit = limit, .refused = !scene_memory_has(&session->scene, 0, 0, limit)};
    limits_report_memory(&session->diags, span, &budget, "adding shapes");
    return false;
}

// A call that takes so many more records has the room for it.
static bool has_room(const List *list, size_t count, size_t bytes_each)
{
    rt_session *session = list->session;
    size_t limit = session_memory_granted(session);
    Span span = span_of(list, 0);
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

static bool look_is_known(const rt_look *look)
{
    return !array_is_given(&look->colors) || (look->color_numbers >= 3 && look->color_numbers <= 5);
}

static ArrayCheck look_check(const rt_look *look)
{
    return (ArrayCheck){"color", &look->colors, look->color_numbers, ARRAY_COLOR};
}

// Numbers the elements, looks at all of them, and reads the finish. False after a fault, with nothing taken.
static bool list_open(List *list, rt_session *session, const char *name, size_t count, const ArrayCheck *checks,
                      int check_count, const rt_look *look)
{
    *list = (List){.session = session, .source = source_open_list(session->sources, name, count)};
    if (!list->source) {
        return no_memory(session, SPAN_NONE);
    }
    list->base = source_base(list->source);
    for (int i = 0; i < check_count; i++) {
        size_t numbers = array_is_given(checks[i].array) ? (size_t)checks[i].numbers : 0;
        session->array_bytes += numbers * count * sizeof(double);
    }
    return arrays_are_fine(session, checks, check_count, count, list->base) &&
           session_read_finish(session, look->finish, &list->finish);
}

// The status of a call, all of whose messages are handed over.
static rt_status finish_call(rt_session *session, bool fine)
{
    diag_finish(&session->diags);
    return session_status(session, fine && session->diags.error_count == 0);
}

// ---- spheres

static void warn_of_nothing(const List *list, size_t element, const char *why)
{
    diag_report(&list->session->diags, DIAG_W0348, span_of(list, element), "%s", why);
}

// Spheres [begin, end), whose places in the map of sources have one upper half.
static bool spheres_fill(const List *list, const rt_spheres *spheres, size_t begin, size_t end, SessionGroup *group)
{
    Scene *scene = &list->session->scene;
    Sphere *records = &scene->spheres.items[scene->spheres.count];
    size_t made = 0;
    MaterialIndex index = 0;
    bool is_alike = spheres->look.colors.stride == 0;
    for (size_t i = begin; i < end; i++) {
        double radius = array_number(&spheres->radii, i, 0);
        if (radius == 0.0) {
            warn_of_nothing(list, i, "a sphere of radius 0 is not drawn");
            continue;
        }
        Material material = look_material(&spheres->look, i, list->finish);
        if ((made == 0 || !is_alike) && !scene_add_material_record(scene, &material, &index)) {
            return false;
        }
        records[made++] = (Sphere){array_vector(&spheres->centers, i, 0), radius, index, (uint32_t)(list->base + i)};
    }
    group->has_gaps = group->has_gaps || made < end - begin;
    if (made > 0) {
        scene_commit_spheres(scene, made, list->base + begin);
    }
    return scene_memory_has(scene, 0, 0, session_memory_granted(list->session));
}

// A scene as it was before.
static void spheres_take_back(Scene *scene, size_t spheres, size_t runs, uint32_t shapes)
{
    scene->spheres.count = spheres;
    scene->sphere_runs.count = runs;
    scene->shape_count = shapes;
}

static bool spheres_add(const List *list, const rt_spheres *spheres, SessionGroup *group)
{
    rt_session *session = list->session;
    Scene *scene = &session->scene;
    size_t before = scene->spheres.count, runs = scene->sphere_runs.count, count = spheres->count;
    uint32_t shapes = scene->shape_count;
    if (!has_room(list, count, sizeof(Sphere))) {
        return false;
    }
    if (!scene_reserve_spheres(scene, count, 0) || !ARRAY_RESERVE(&session->groups, session->groups.count + 1)) {
        return no_memory(session, span_of(list, 0));
    }
    *group = (SessionGroup){source_name(list->source), before, count, list->base, false, RECORD_NONE};
    for (size_t begin = 0, end; begin < count; begin = end) {
        uint64_t next_half = (((list->base + begin) >> 32) + 1) << 32;
        end = list->base + count <= next_half ? count : (size_t)(next_half - list->base);
        if (!ARRAY_RESERVE(&scene->sphere_runs, scene->sphere_runs.count + 1) ||
            !spheres_fill(list, spheres, begin, end, group)) {
            spheres_take_back(scene, before, runs, shapes);
            return no_memory(session, span_of(list, begin));
        }
    }
    return true;
}

rt_status rt_add_spheres(rt_session *session, const rt_spheres *spheres, size_t *group)
{
    if (!session_begin(session)) {
        return session_not_begun(session, "rt_add_spheres");
    }
    if (!look_is_known(&spheres->look) || !array_is_given(&spheres->centers) || !array_is_given(&spheres->radii)) {
        return session_misuse(session, "rt_add_spheres needs centers, radii, and colors of 3 to 5 numbers", NULL);
    }
    ArrayCheck checks[] = {{"center", &spheres->centers, 3, ARRAY_FINITE},
                           {"radius", &spheres->radii, 1, ARRAY_NOT_NEGATIVE},
                           look_check(&spheres->look)};
    List list;
    SessionGroup added;
    bool fine = list_open(&list, session, spheres->name ? spheres->name : "spheres", spheres->count, checks, 3,
                          &spheres->look) &&
                spheres_add(&list, spheres, &added);
    if (fine) {
        session->is_checked = false;
        fine = ARRAY_PUSH(&session->groups, added);
        if (group) {
            *group = session->groups.count - 1;
        }
    }
    return finish_call(session, fine);
}

// ---- other numbers for spheres

// Their colours move to materials of their own, which may then be changed in place.
static bool group_own_materials(rt_session *session, SessionGroup *group)
{
    Scene *scene = &session->scene;
    MaterialIndex first;
    if (group->own != RECORD_NONE) {
        return true;
    }
    if (!scene_memory_has(scene, 0, group->count * sizeof(Material), session_memory_granted(session)) ||
        !scene_add_own_materials(scene, group->count, &first)) {
        return no_memory(session, SPAN_NONE);
    }
    for (size_t i = 0; i < group->count; i++) {
        Sphere *sphere = &scene->spheres.items[group->first + i];
        scene->materials.items[first + i] = scene->materials.items[sphere->material];
        sphere->material = (MaterialIndex)(first + i);
    }
    group->own = first;
    geometry_kept_change(&session->kept, group->first, group->first + group->count);
    return true;
}

static void group_change(rt_session *session, const SessionGroup *group, size_t first, const rt_spheres *spheres)
{
    Scene *scene = &session->scene;
    bool moves = array_is_given(&spheres->centers), grows = array_is_given(&spheres->radii);
    for (size_t i = 0; i < spheres->count; i++) {
        Sphere *sphere = &scene->spheres.items[group->first + first + i];
        sphere->centre = moves ? array_vector(&spheres->centers, i, 0) : sphere->centre;
        sphere->radius = grows ? array_number(&spheres->radii, i, 0) : sphere->radius;
        if (array_is_given(&spheres->look.colors)) {
            Material *material = &scene->materials.items[sphere->material];
            *material = look_material(&spheres->look, i, material->finish);
        }
    }
    if (moves || grows) {
        size_t begin = group->first + first;
        geometry_kept_change(&session->kept, begin, begin + spheres->count);
        session->is_checked = false;
    }
}

static bool radii_are_positive(rt_session *session, const rt_spheres *spheres, uint64_t base)
{
    for (size_t i = 0; array_is_given(&spheres->radii) && i < spheres->count; i++) {
        if (array_number(&spheres->radii, i, 0) == 0.0) {
            diag_report(&session->diags, DIAG_E0460, (Span){base + i, base + i + 1},
                        "the radius of a sphere that is drawn cannot become 0");
            return false;
        }
    }
    return true;
}

rt_status rt_update_spheres(rt_session *session, size_t group, size_t first, const rt_spheres *spheres)
{
    if (!session_begin(session) || group >= session->groups.count) {
        return session_misuse(session, "rt_update_spheres needs a group that rt_add_spheres gave", NULL);
    }
    SessionGroup *changed = &session->groups.items[group];
    if (changed->has_gaps || first > changed->count || spheres->count > changed->count - first ||
        !look_is_known(&spheres->look)) {
        return session_misuse(session, "rt_update_spheres changes what is in the group, and was not left out", NULL);
    }
    ArrayCheck checks[] = {{"center", &spheres->centers, 3, ARRAY_FINITE},
                           {"radius", &spheres->radii, 1, ARRAY_NOT_NEGATIVE},
                           look_check(&spheres->look)};
    uint64_t base = changed->base + first;
    bool fine = arrays_are_fine(session, checks, 3, spheres->count, base) &&
                radii_are_positive(session, spheres, base) &&
                (!array_is_given(&spheres->look.colors) || group_own_materials(session, changed));
    if (fine) {
        group_change(session, changed, first, spheres);
    }
    return finish_call(session, fine);
}

// ---- parts

typedef const char *(*MakePart)(const void *shapes, size_t element, Part *part);

// False: nothing is left to add, after a fault or not (*fine).
static bool part_make(const List *list, MakePart make, const void *shapes, size_t element, Part *part, bool *fine)
{
    *part = part_empty(list->base + element);
    const char *why_nothing = make(shapes, element, part);
    if (why_nothing) {
        warn_of_nothing(list, element, why_nothing);
        return false;
    }
    *fine = part_finish(part);
    if (!*fine) {
        diag_report(&list->session->diags, DIAG_E0460, span_of(list, element), "this %s cannot be represented",
                    primitive_class(part->kind)->word);
    }
    return *fine;
}

static bool parts_add(const List *list, MakePart make, const void *shapes, size_t count, const rt_look *look)
{
    Scene *scene = &list->session->scene;
    size_t before = scene->parts.count;
    uint32_t shape_count = scene->shape_count;
    bool fine = has_room(list, count, sizeof(Part));
    if (fine && !ARRAY_RESERVE(&scene->parts, before + count)) {
        return no_memory(list->session, span_of(list, 0));
    }
    for (size_t i = 0; fine && i < count; i++) {
        Part part;
        if (!part_make(list, make, shapes, i, &part, &fine)) {
            continue;
        }
        Material material = look_material(look, i, list->finish);
        fine = (scene_add_material_record(scene, &material, &part.material) && scene_add_part(scene, &part)) ||
               no_memory(list->session, span_of(list, i));
    }
    fine = fine && (scene_memory_has(scene, 0, 0, session_memory_granted(list->session)) ||
                    no_memory(list->session, span_of(list, 0)));
    if (!fine) {
        scene->parts.count = before;
        scene->shape_count = shape_count;
    }
    return fine;
}

static const char *make_rod(const void *shapes, size_t element, Part *part)
{
    const rt_rods *rods = shapes;
    Vec3 base = array_vector(&rods->bases, element, 0), cap = array_vector(&rods->caps, element, 0);
    double radius = array_number(&rods->base_radii, element, 0);
    return array_is_given(&rods->cap_radii)
               ? part_make_cone(part, base, radius, cap, array_number(&rods->cap_radii, element, 0), rods->open)
               : part_make_cylinder(part, base, cap, radius, rods->open);
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
    List list;
    bool fine = list_open(&list, session, rods->name ? rods->name : "rods", rods->count, checks, 5, &rods->look) &&
                rods_have_ends(session, rods, list.base) &&
                parts_add(&list, make_rod, rods, rods->count, &rods->look);
    session->is_checked = false;
    return finish_call(session, fine);
}

static const char *make_triangle(const void *shapes, size_t element, Part *part)
{
    const rt_triangles *triangles = shapes;
    Vec3 corners[3], normals[3];
    bool is_smooth = array_is_given(&triangles->normals);
    for (int k = 0; k < 3; k++) {
        corners[k] = array_vector(&triangles->corners, element, 3 * k);
        normals[k] = is_smooth ? array_vector(&triangles->normals, element, 3 * k) : corners[k];
    }
    return is_smooth ? part_make_smooth_triangle(part, corners, normals) : part_make_triangle(part, corners);
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
    List list;
    bool fine = list_open(&list, session, triangles->name ? triangles->name : "triangles", triangles->count, checks, 3,
                          &triangles->look) &&
                parts_add(&list, make_triangle, triangles, triangles->count, &triangles->look);
    session->is_checked = false;
    return finish_call(session, fine);
}
