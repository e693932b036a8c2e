// Spheres of a scene that is built by calls: arrays become records in one pass on all threads, and may get other
// numbers.
//
// What is wrong is found by the same pass; then all arrays are looked at for what to say, and nothing is taken. Colours
// are looked up among those that the scene has as long as that pays. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "api/arrays.h"
#include "base/parallel.h"
#include "scene/range.h"
#include "scene/room.h"
#include "scene/tail.h"

// ---- elements become records

// What a run of elements holds.
typedef struct FilledRun {
    SphereSurvey survey;
    size_t colors; // that are unlike the one before
    bool is_odd;   // there is something to report of it
    bool has_points;
} FilledRun;

// Records stand behind the end of the scene's lists until all is known to be right.
typedef struct Filling {
    const ShapeList *list;
    const rt_spheres *spheres;
    Sphere *records;     // the first one
    bool is_alike;       // one material for all …
    MaterialIndex alike; // … which is this one; else that of the last one that is colored
    size_t colored;      // so many have a material already; the others …
    Material *materials; // … get one each, here
    MaterialIndex first; // the number of the first of these
    FilledRun *runs;
    bool is_told; // what is odd
} Filling;

// Not finite, or like bytes.
static inline bool color_is_odd(const Material *m)
{
    return !(isfinite(m->red) && isfinite(m->green) && isfinite(m->blue) && isfinite(m->filter) &&
             isfinite(m->transmit)) ||
           rgb_is_like_bytes((double)m->red, (double)m->green, (double)m->blue);
}

static inline uint32_t bits_that_differ(float a, float b)
{
    uint32_t one, other;
    memcpy(&one, &a, sizeof one);
    memcpy(&other, &b, sizeof other);
    return one ^ other;
}

// Of materials of one finish.
static inline bool colors_differ(const Material *a, const Material *b)
{
    return (bits_that_differ(a->red, b->red) | bits_that_differ(a->green, b->green) |
            bits_that_differ(a->blue, b->blue) | bits_that_differ(a->filter, b->filter) |
            bits_that_differ(a->transmit, b->transmit)) != 0;
}

static size_t filled_runs(const Filling *filling)
{
    return (filling->spheres->count + SPHERE_RUN - 1) / SPHERE_RUN;
}

// Without a branch, which no one could predict; the known one beside what is no number.
static inline double greater(double number, double known)
{
    return number > known ? number : known;
}

// Places and radii of a run, of arrays whose kinds of numbers are known where it is compiled. What is not finite makes
// the sum of all not finite; where numbers are so large that they do so, too, all is looked at again.
RT_ALWAYS_INLINE void fill_places_of(const Filling *filling, size_t begin, size_t end, FilledRun *run,
                                     rt_number center_number, rt_number radius_number)
{
    rt_array centers = filling->spheres->centers, radii = filling->spheres->radii;
    centers.number = center_number;
    radii.number = radius_number;
    SphereSurvey survey = SURVEY_OF_NOTHING;
    uint32_t source = (uint32_t)filling->list->base;
    double sum = 0.0;
    for (size_t i = begin; i < end; i++) {
        Sphere *record = &filling->records[i];
        Vec3 centre = array_vector(&centers, i, 0);
        double radius = array_number(&radii, i, 0);
        record->centre = centre;
        record->radius = radius;
        record->source = source + (uint32_t)i;
        sum += (centre.x + centre.y) + (centre.z + radius);
        survey.least_radius = radius < survey.least_radius ? radius : survey.least_radius;
        survey.greatest_radius = greater(radius, survey.greatest_radius);
        survey.greatest_place = greater(fabs(centre.x), survey.greatest_place);
        survey.greatest_place = greater(fabs(centre.y), survey.greatest_place);
        survey.greatest_place = greater(fabs(centre.z), survey.greatest_place);
    }
    run->survey = survey;
    run->has_points = survey.least_radius <= 0.0;
    run->is_odd = !isfinite(sum) || !(survey.least_radius >= 0.0);
}

static void fill_places(const Filling *filling, size_t begin, size_t end, FilledRun *run)
{
    bool has_narrow_radii = filling->spheres->radii.number == RT_FLOAT32;
    if (filling->spheres->centers.number == RT_FLOAT32) {
        has_narrow_radii ? fill_places_of(filling, begin, end, run, RT_FLOAT32, RT_FLOAT32)
                         : fill_places_of(filling, begin, end, run, RT_FLOAT32, RT_FLOAT64);
    } else {
        has_narrow_radii ? fill_places_of(filling, begin, end, run, RT_FLOAT64, RT_FLOAT32)
                         : fill_places_of(filling, begin, end, run, RT_FLOAT64, RT_FLOAT64);
    }
}

// Whether one of a run's materials is odd, of which some number is not usual.
static bool has_odd_color(const Material *materials, size_t count)
{
    bool is_odd = false;
    for (size_t i = 0; !is_odd && i < count; i++) {
        is_odd = color_is_odd(&materials[i]);
    }
    return is_odd;
}

// A material for each of a run, and how many are unlike the one before; likewise. Nearly all colours differ by their
// size.
RT_ALWAYS_INLINE void fill_colors_of(const Filling *filling, size_t begin, size_t end, FilledRun *run, rt_number number,
                                     int color_numbers)
{
    rt_look look = filling->spheres->look;
    look.colors.number = number;
    look.color_numbers = color_numbers;
    const float usual = (float)COLOUR_USUAL;
    FinishIndex finish = filling->list->finish;
    size_t before = begin - filling->colored; // materials of runs that come first
    Material last = look_material(&look, begin - 1, finish), *materials = &filling->materials[before];
    bool is_usual = true;
    size_t colors = 0;
    for (size_t i = begin; i < end; i++) {
        Material material = look_material(&look, i, finish);
        colors += colors_differ(&material, &last);
        is_usual = is_usual & (fabsf(material.red) <= usual) & (fabsf(material.green) <= usual) &
                   (fabsf(material.blue) <= usual) & (fabsf(material.filter) <= usual) &
                   (fabsf(material.transmit) <= usual);
        materials[i - begin] = last = material;
        filling->records[i].material = (MaterialIndex)(filling->first + before + (i - begin));
    }
    run->colors = colors;
    run->is_odd = run->is_odd || (!is_usual && has_odd_color(materials, end - begin));
}

static void fill_colors(const Filling *filling, size_t begin, size_t end, FilledRun *run)
{
    const rt_look *look = &filling->spheres->look;
    if (look->color_numbers != 3) {
        fill_colors_of(filling, begin, end, run, look->colors.number, look->color_numbers);
    } else if (look->colors.number == RT_FLOAT32) {
        fill_colors_of(filling, begin, end, run, RT_FLOAT32, 3);
    } else {
        fill_colors_of(filling, begin, end, run, RT_FLOAT64, 3);
    }
}

static void fill_run(void *client, size_t begin, size_t end)
{
    const Filling *filling = client;
    FilledRun run = {.colors = 0};
    fill_places(filling, begin, end, &run);
    if (filling->is_alike) {
        for (size_t i = begin; i < end; i++) {
            filling->records[i].material = filling->alike;
        }
    } else if (begin >= filling->colored) {
        fill_colors(filling, begin, end, &run);
    }
    run.is_odd = run.is_odd && !filling->is_told;
    filling->runs[begin / SPHERE_RUN] = run;
}

// ---- materials

// One for all that are alike, and as long as it pays to look for equal ones, those of whole runs. False when out of
// memory, or when a colour is odd; *is_odd then says so.
static bool fill_known_colors(Filling *filling, bool *is_odd)
{
    Scene *scene = &filling->list->session->scene;
    size_t count = filling->is_alike ? 1 : filling->spheres->count, i = 0;
    for (; i < count && (i == 0 || i % SPHERE_RUN != 0 || !scene_materials_add_up(scene)); i++) {
        Material material = look_material(&filling->spheres->look, i, filling->list->finish);
        *is_odd = *is_odd || (!filling->is_told && color_is_odd(&material));
        if (*is_odd || !scene_add_material_record(scene, &material, &filling->alike)) {
            return false;
        }
        filling->records[i].material = filling->alike;
    }
    filling->colored = i;
    return true;
}

// Materials side by side, where some equal the one before.
static void color_run(void *client, size_t begin, size_t end)
{
    const Filling *filling = client;
    size_t from = filling->colored + begin, at = 0;
    for (size_t run = filling->colored / SPHERE_RUN; run < from / SPHERE_RUN; run++) {
        at += filling->runs[run].colors;
    }
    Material last = look_material(&filling->spheres->look, from - 1, filling->list->finish);
    for (size_t i = from; i < filling->colored + end; i++) {
        Material material = look_material(&filling->spheres->look, i, filling->list->finish);
        if (colors_differ(&material, &last)) {
            filling->materials[at++] = last = material;
        }
        filling->records[i].material = at > 0 ? (MaterialIndex)(filling->first + at - 1) : filling->alike;
    }
}

// The materials that were filled in are the scene's.
static void commit_colors(Filling *filling)
{
    rt_session *session = filling->list->session;
    size_t more = 0, rest = filling->is_alike ? 0 : filling->spheres->count - filling->colored;
    for (size_t run = filling->colored / SPHERE_RUN; rest > 0 && run < filled_runs(filling); run++) {
        more += filling->runs[run].colors;
    }
    if (more < rest) {
        parallel_share(session_load_threads(session), rest, SPHERE_RUN, color_run, filling);
    }
    scene_commit_materials(&session->scene, more);
}

// ---- all of them

// What has no size is left out, from `begin` to `end`, with a warning. Returns how many are left, from *to on.
static size_t drop_points(const Filling *filling, size_t begin, size_t end, Sphere *to)
{
    size_t made = 0;
    for (size_t i = begin; i < end; i++) {
        if (filling->records[i].radius == 0.0) {
            shape_list_warn(filling->list, i, "a sphere of radius 0 is not drawn");
        } else {
            to[made++] = filling->records[i];
        }
    }
    return made;
}

// The elements are the scene's. Those whose places in the map of sources have one upper half go together.
static bool commit_spheres(const Filling *filling, bool has_points)
{
    Scene *scene = &filling->list->session->scene;
    uint64_t base = filling->list->base;
    size_t count = filling->spheres->count;
    Sphere *to = filling->records;
    for (size_t begin = 0, end; begin < count; begin = end) {
        uint64_t next_half = (((base + begin) >> 32) + 1) << 32;
        end = base + count <= next_half ? count : (size_t)(next_half - base);
        size_t made = has_points ? drop_points(filling, begin, end, to) : end - begin;
        if (!ARRAY_RESERVE(&scene->sphere_runs, scene->sphere_runs.count + 1)) {
            return false;
        }
        if (made > 0) {
            scene_commit_spheres(scene, made, base + begin);
        }
        to += made;
    }
    return true;
}

// What was seen of the spheres while they were taken need not be looked at again.
static void note_survey(const Filling *filling, size_t before)
{
    Scene *scene = &filling->list->session->scene;
    if (scene->surveyed == before) {
        for (size_t run = 0; run < filled_runs(filling); run++) {
            sphere_survey_add(&scene->survey, &filling->runs[run].survey);
        }
        scene->surveyed = scene->spheres.count;
    }
}

// Elements go behind the end of the scene's lists. False when out of memory.
static bool fill_all(Filling *filling, bool *is_odd, bool *has_points)
{
    rt_session *session = filling->list->session;
    Scene *scene = &session->scene;
    size_t count = filling->spheres->count;
    filling->runs = malloc(filled_runs(filling) * sizeof *filling->runs);
    if (!filling->runs || !scene_reserve_spheres(scene, count, 0) ||
        !ARRAY_RESERVE(&session->groups, session->groups.count + 1)) {
        return false;
    }
    filling->records = &scene->spheres.items[scene->spheres.count];
    if (!fill_known_colors(filling, is_odd) ||
        (!filling->is_alike && !scene_reserve_spheres(scene, count, count - filling->colored))) {
        return *is_odd;
    }
    filling->first = (MaterialIndex)scene->materials.count;
    filling->materials = scene->materials.items ? &scene->materials.items[scene->materials.count] : NULL;
    parallel_share(session_load_threads(session), count, SPHERE_RUN, fill_run, filling);
    for (size_t run = 0; run < filled_runs(filling); run++) {
        *is_odd = *is_odd || filling->runs[run].is_odd;
        *has_points = *has_points || filling->runs[run].has_points;
    }
    return true;
}

// All that is filled in is taken. False when out of memory.
static bool commit_all(Filling *filling, bool has_points)
{
    rt_session *session = filling->list->session;
    size_t before = session->scene.spheres.count;
    commit_colors(filling);
    if (!commit_spheres(filling, has_points) ||
        !scene_memory_has(&session->scene, 0, 0, session_memory_granted(session))) {
        return false;
    }
    if (!has_points) {
        note_survey(filling, before);
    }
    return true;
}

// Fills until nothing is odd that was not reported. False after a fault, and out of memory, which *has_memory tells.
static bool fill_told(Filling *filling, const ArrayCheck checks[3], bool *has_points, bool *has_memory)
{
    const ShapeList *list = filling->list;
    bool is_odd = false;
    *has_memory = fill_all(filling, &is_odd, has_points);
    if (*has_memory && is_odd) {
        if (!arrays_are_fine(list->session, checks, 3, filling->spheres->count, list->base)) {
            return false;
        }
        filling->is_told = true;
        is_odd = false;
        free(filling->runs);
        *has_memory = fill_all(filling, &is_odd, has_points);
    }
    return *has_memory;
}

// `checks`: of centers, radii and colors.
static bool spheres_add(const ShapeList *list, const rt_spheres *spheres, const ArrayCheck checks[3],
                        SessionGroup *group)
{
    rt_session *session = list->session;
    Scene *scene = &session->scene;
    uint32_t shapes = scene->shape_count;
    Filling filling = {.list = list, .spheres = spheres, .is_alike = spheres->look.colors.stride == 0};
    *group =
        (SessionGroup){source_name(list->source), scene->spheres.count, spheres->count, list->base, false, RECORD_NONE};
    if (spheres->count == 0) {
        return ARRAY_RESERVE(&session->groups, session->groups.count + 1) ||
               session_no_room(session, shape_list_span(list, 0));
    }
    if (!shape_list_has_room(list, spheres->count, sizeof(Sphere))) {
        return false;
    }
    bool has_memory, is_fine = fill_told(&filling, checks, &group->has_gaps, &has_memory);
    has_memory = has_memory && (!is_fine || commit_all(&filling, group->has_gaps));
    free(filling.runs);
    if (!has_memory) {
        scene_keep_shapes(scene, shapes);
        return session_no_room(session, shape_list_span(list, 0));
    }
    return is_fine;
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
    const ShapeArrays arrays = {spheres->name ? spheres->name : "spheres", spheres->count, checks, 3, &spheres->look};
    ShapeList list;
    SessionGroup added;
    bool fine = shape_list_begin(&list, session, &arrays) && spheres_add(&list, spheres, checks, &added);
    if (fine) {
        session->is_checked = false;
        fine = ARRAY_PUSH(&session->groups, added);
        if (group) {
            *group = session->groups.count - 1;
        }
    }
    return session_finish_call(session, fine);
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
        return session_no_room(session, SPAN_NONE);
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

typedef struct GroupChange {
    Scene *scene;
    const rt_spheres *spheres;
    size_t first; // Scene.spheres
} GroupChange;

static void change_run(void *client, size_t begin, size_t end)
{
    const GroupChange *change = client;
    const rt_spheres *spheres = change->spheres;
    bool moves = array_is_given(&spheres->centers), grows = array_is_given(&spheres->radii);
    for (size_t i = begin; i < end; i++) {
        Sphere *sphere = &change->scene->spheres.items[change->first + i];
        sphere->centre = moves ? array_vector(&spheres->centers, i, 0) : sphere->centre;
        sphere->radius = grows ? array_number(&spheres->radii, i, 0) : sphere->radius;
        if (array_is_given(&spheres->look.colors)) {
            Material *material = &change->scene->materials.items[sphere->material];
            *material = look_material(&spheres->look, i, material->finish);
        }
    }
}

static void group_change(rt_session *session, const SessionGroup *group, size_t first, const rt_spheres *spheres)
{
    GroupChange change = {&session->scene, spheres, group->first + first};
    parallel_share(session_load_threads(session), spheres->count, SPHERE_RUN, change_run, &change);
    if (array_is_given(&spheres->centers) || array_is_given(&spheres->radii)) {
        geometry_kept_change(&session->kept, change.first, change.first + spheres->count);
        scene_spheres_change(&session->scene);
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
    return session_finish_call(session, fine);
}
