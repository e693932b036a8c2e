// The exact scale of a scene, and what lies beyond the range of its numbers.
//
// SPDX-License-Identifier: MIT
#include "scene/range.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>

#include "base/parallel.h"
#include "scene/primitive_reach.h"
#include "scene/primitive.h"

// As vec3_max_abs, for numbers.
static inline double max_abs(Vec3 a)
{
    double x = fabs(a.x), y = fabs(a.y), z = fabs(a.z);
    x = y > x ? y : x;
    return z > x ? z : x;
}

static double row_size(const Transform *transform, int row)
{
    const double *m = transform->m[row];
    return max_abs(vec3(m[0], m[1], m[2]));
}

// ---- all spheres

bool scene_has_material(const Scene *scene, MaterialIndex index)
{
    return index & MATERIAL_COMPOUND ? (index & ~MATERIAL_COMPOUND) < scene->compounds.count
                                     : index < scene->materials.count;
}

typedef struct Surveying {
    const Scene *scene;
    SphereSurvey *survey;
    pthread_mutex_t lock; // of the survey
} Surveying;

static void survey_some(void *client, size_t begin, size_t end)
{
    Surveying *surveying = client;
    const Scene *scene = surveying->scene;
    double least = INFINITY, greatest = 0.0, place = 0.0;
    bool has_materials = true;
    double nothing = 0.0; // as long as all is finite
    for (size_t i = scene->surveyed + begin; i < scene->surveyed + end; i++) {
        const Sphere *sphere = &scene->spheres.items[i];
        Vec3 centre = sphere->centre;
        double radius = sphere->radius, at = max_abs(centre);
        nothing += (centre.x - centre.x) + (centre.y - centre.y) + (centre.z - centre.z) + (radius - radius);
        has_materials = has_materials & scene_has_material(scene, sphere->material);
        least = radius < least ? radius : least;
        greatest = radius > greatest ? radius : greatest;
        place = at > place ? at : place;
    }
    SphereSurvey some = {
        .least_radius = least,
        .greatest_radius = greatest,
        .greatest_place = place,
        .is_valid = nothing == 0.0 && least > 0.0 && has_materials,
    };
    pthread_mutex_lock(&surveying->lock);
    sphere_survey_add(surveying->survey, &some);
    pthread_mutex_unlock(&surveying->lock);
}

void scene_survey_spheres(const Scene *scene, int threads, SphereSurvey *survey)
{
    Surveying surveying = {scene, survey, PTHREAD_MUTEX_INITIALIZER};
    *survey = scene->survey;
    parallel_share(threads, scene->spheres.count - scene->surveyed, SPHERE_RUN, survey_some, &surveying);
    pthread_mutex_destroy(&surveying.lock);
}

void scene_keep_survey(Scene *scene, int threads)
{
    SphereSurvey survey;
    scene_survey_spheres(scene, threads, &survey);
    scene->survey = survey;
    scene->surveyed = scene->spheres.count;
}

// ---- the exact scale

// What is known of each shape: its greatest half size, where it stands, and what to call it.
typedef struct Extent {
    double size;
    Vec3 place;
    uint64_t source;
    const char *what; // of a part it is made when it is reported
    const Primitive *part; // or NULL
} Extent;

static const char *extent_name(const Extent *extent)
{
    return extent->part ? primitive_name(extent->part) : extent->what;
}

static Extent part_extent(const Primitive *primitive)
{
    const Transform *map = &primitive->to_world;
    const PrimitiveClass *class = primitive_class(primitive->kind);
    Extent extent = {
        .size = max_abs(vec3(row_size(map, 0), row_size(map, 1), row_size(map, 2))),
        .place = vec3(map->m[3][0], map->m[3][1], map->m[3][2]),
        .source = primitive->source,
        .part = primitive,
    };
    if (class->measure) {
        Vec3 half, middle;
        class->measure(primitive, &half, &middle);
        extent.size = fmax(fmax(half.x * row_size(map, 0), half.y * row_size(map, 1)), half.z * row_size(map, 2));
        extent.place = transform_point(map, middle);
    }
    return extent;
}

// Visits what has a length: shapes with their size and place, and what has a place only, with the size 0: planes,
// lights, and the camera, which is `needed`.
typedef void ExtentVisitor(void *client, double size, double place, bool is_needed);

static void visit_extent(ExtentVisitor *visit, void *client, Extent extent)
{
    visit(client, extent.size, max_abs(extent.place), false);
}

static void visit_others(const Scene *scene, ExtentVisitor *visit, void *client)
{
    for (size_t i = 0; i < scene->planes.count; i++) {
        visit(client, 0.0, fabs(scene->planes.items[i].distance), false);
    }
    for (size_t i = 0; i < scene->primitives.count; i++) {
        const Primitive *primitive = &scene->primitives.items[i];
        if (primitive->kind == PRIMITIVE_PLANE) {
            visit(client, 0.0, fabs(primitive->data[1].x), false);
        } else {
            visit_extent(visit, client, part_extent(primitive));
        }
    }
    for (size_t i = 0; i < scene->lights.count; i++) {
        visit(client, 0.0, vec3_max_abs(scene->lights.items[i].position), false);
    }
    visit(client, 0.0, vec3_max_abs(scene->camera.location), true);
}

static void visit_all(const Scene *scene, ExtentVisitor *visit, void *client)
{
    for (size_t i = 0; i < scene->spheres.count; i++) {
        visit(client, scene->spheres.items[i].radius, max_abs(scene->spheres.items[i].centre), false);
    }
    visit_others(scene, visit, client);
}

// The exponents at which something is held; only what has a size can be too small.
enum { EXPONENT_LEAST = DBL_MIN_EXP - DBL_MANT_DIG, EXPONENT_MOST = DBL_MAX_EXP };

typedef struct ExponentRange {
    int low, high;
} ExponentRange;

static ExponentRange exponents_of(double size, double place)
{
    double greatest = fmax(size, place);
    ExponentRange range = {EXPONENT_LEAST, EXPONENT_MOST};
    if (!(greatest <= DBL_MAX)) {
        return (ExponentRange){1, 0}; // at none
    }
    if (greatest > 0.0) {
        range.low = ilogb(greatest) + 1 - RANGE_END;
    }
    if (size > 0.0) {
        range.high = ilogb(size) - RANGE_LEAST;
    }
    return (ExponentRange){range.low < EXPONENT_LEAST ? EXPONENT_LEAST : range.low,
                           range.high > EXPONENT_MOST ? EXPONENT_MOST : range.high};
}

// The lengths of what is held at some exponents: sizes count to both sides, places as the greatest, or, where nothing
// has a size, to both. Those that are 0, infinite or NaN do not count.
typedef struct Lengths {
    ExponentRange at; // what is not held at one of these does not count
    bool all_count;   // but all does
    double least_size, greatest, least_place;
} Lengths;

static void lengths_visit(void *client, double size, double place, bool is_needed)
{
    Lengths *lengths = client;
    if (!is_needed && !lengths->all_count) {
        ExponentRange held = exponents_of(size, place);
        if (held.low > lengths->at.low || held.high < lengths->at.high) {
            return;
        }
    }
    if (size > 0.0 && size <= DBL_MAX) {
        lengths->least_size = fmin(lengths->least_size, size);
        lengths->greatest = fmax(lengths->greatest, size);
    }
    if (place > 0.0 && place <= DBL_MAX) {
        lengths->least_place = fmin(lengths->least_place, place);
        lengths->greatest = fmax(lengths->greatest, place);
    }
}

// The exponent in the middle of the lengths, and whether all of them are held there.
static int lengths_middle(const Lengths *lengths, bool *is_all_held)
{
    double least = lengths->least_size < (double)INFINITY ? lengths->least_size : lengths->least_place;
    *is_all_held = true;
    if (!(lengths->greatest > 0.0)) {
        return 0;
    }
    int sum = ilogb(least) + ilogb(lengths->greatest), middle = (sum - (sum < 0)) / 2; // rounded down, also below 0
    ExponentRange held = exponents_of(lengths->least_size < (double)INFINITY ? least : 0.0, lengths->greatest);
    *is_all_held = held.low <= middle && middle <= held.high;
    return middle;
}

// For each exponent, how much more is held than at the one before: there are less than 2^28 of each kind of shape.
typedef struct Census {
    int32_t change[EXPONENT_MOST - EXPONENT_LEAST + 2];
    int32_t needed; // what is needed counts as so many
} Census;

static void census_visit(void *client, double size, double place, bool is_needed)
{
    Census *census = client;
    ExponentRange held = exponents_of(size, place);
    int32_t count = is_needed ? census->needed : 1;
    if (held.low <= held.high) {
        census->change[held.low - EXPONENT_LEAST] += count;
        census->change[held.high + 1 - EXPONENT_LEAST] -= count;
    }
}

// The exponents at which the most is held, the nearest such run to `middle`.
static ExponentRange exponents_of_most(const Scene *scene, int middle)
{
    Census census = {.needed = (int32_t)(scene->spheres.count + scene->planes.count + scene->primitives.count +
                                         scene->lights.count + 1)};
    int64_t held = 0, most = -1;
    int nearest = INT_MAX;
    ExponentRange best = {0, 0}, run = {0, 0};
    visit_all(scene, census_visit, &census);
    for (int e = EXPONENT_LEAST; e <= EXPONENT_MOST; e++) {
        int64_t change = census.change[e - EXPONENT_LEAST];
        held += change;
        run = change != 0 || e == EXPONENT_LEAST ? (ExponentRange){e, e} : (ExponentRange){run.low, e};
        int apart = e < middle ? middle - e : e - middle;
        bool is_same = run.low == best.low && held == most;
        if (held > most || (held == most && (is_same || apart < nearest))) {
            nearest = !is_same || apart < nearest ? apart : nearest;
            best = run;
            most = held;
        }
    }
    return best;
}

static Lengths all_lengths(const Scene *scene, const SphereSurvey *spheres)
{
    Lengths all = {{0, 0}, true, (double)INFINITY, 0.0, (double)INFINITY};
    if (isfinite(spheres->least_radius)) { // there are some, be they here or not
        lengths_visit(&all, spheres->least_radius, spheres->greatest_place, true);
        lengths_visit(&all, spheres->greatest_radius, spheres->greatest_place, true);
    }
    visit_others(scene, lengths_visit, &all);
    return all;
}

bool scene_range_is_held(const Scene *scene, const SphereSurvey *spheres)
{
    bool is_all_held;
    Lengths all = all_lengths(scene, spheres);
    (void)lengths_middle(&all, &is_all_held);
    return is_all_held;
}

// The scale of the whole scene. Where lengths span too much, that of the most of it that can be held, as if the rest
// were not there.
static SceneScale scale_with(const Scene *scene, const SphereSurvey *spheres)
{
    bool is_all_held;
    Lengths all = all_lengths(scene, spheres);
    int middle = lengths_middle(&all, &is_all_held);
    if (is_all_held) {
        return (SceneScale){middle, all.least_size};
    }
    Lengths most = {exponents_of_most(scene, middle), false, (double)INFINITY, 0.0, (double)INFINITY};
    visit_all(scene, lengths_visit, &most);
    middle = lengths_middle(&most, &is_all_held);
    middle = middle < most.at.low ? most.at.low : middle > most.at.high ? most.at.high : middle;
    return (SceneScale){middle, most.least_size};
}

SceneScale scene_scale(const Scene *scene, int threads)
{
    SphereSurvey survey;
    scene_survey_spheres(scene, threads, &survey);
    return scale_with(scene, &survey);
}

// ---- what lies beyond

static const char not_seen_perhaps[] = "it may not be drawn";

typedef struct Watch {
    DiagSink *diags;
    Vec3 eye;
    double least, end; // sizes, unscaled
} Watch;

// The least size that can be seen beside coordinates as great as `place`: the distance from there to the next number.
static double spacing(double place)
{
    return nextafter(place, (double)INFINITY) - place;
}

static void tell_lost(const Watch *watch, const Extent *extent, double place)
{
    bool is_lost = place + extent->size == place;
    DiagSink *diags = watch->diags;
    Span at = scene_source_span(extent->source);
    bool is_kept =
        is_lost ? diag_report(diags, DIAG_W0440, at, "the size of this %s is lost beside its coordinates",
                              extent_name(extent))
                : diag_report(diags, DIAG_W0441, at, "this %s is smaller than the spacing of numbers at its place",
                              extent_name(extent));
    if (is_kept) {
        diag_note(diags, SPAN_NONE, "its size is %g, and coordinates of %g are %g apart", extent->size, place,
                  spacing(place));
        diag_note(diags, SPAN_NONE,
                  extent->size == 0.0 ? "nothing of it can be seen"
                  : is_lost ? "it is seen in its size, but its shadows and mirror images are those of its centre"
                            : "it is seen in its size, but its shadows and mirror images begin at one of a few points");
        diag_suggest(diags, "move the scene, camera and all, nearer to the origin");
    }
}

static void tell_beyond(const Watch *watch, double length, uint64_t source, const char *what, const char *seen)
{
    if (diag_report(watch->diags, DIAG_W0442, scene_source_span(source),
                    "this %s is beyond the range of the scene's numbers", what)) {
        diag_note(watch->diags, SPAN_NONE,
                  "it has a length of %g, and in this scene lengths from %.2g to %.2g have squares", length,
                  watch->least, watch->end);
        diag_note(watch->diags, SPAN_NONE, "%s", seen);
        diag_suggest(watch->diags, "leave out what is so much larger or smaller than the rest");
    }
}

static void tell_far(const Watch *watch, const Extent *extent, double distance)
{
    if (diag_report(watch->diags, DIAG_W0443, scene_source_span(extent->source),
                    "this %s is too far from the camera for its size", extent_name(extent))) {
        diag_note(watch->diags, SPAN_NONE, "it is %.2g of its sizes away, and rays are exact to %.2g",
                  distance / extent->size, RANGE_RADII);
        diag_note(watch->diags, SPAN_NONE,
                  "rays cannot be aimed at it any more: its outline is coarse, or it is not met");
    }
}

// Most shapes pass with five comparisons.
static inline void check_extent(const Watch *watch, const Extent *extent, const char *seen_beyond)
{
    double place = max_abs(extent->place);
    bool is_point = extent->size == 0.0; // a box of which rounding leaves nothing
    if (!((extent->size >= watch->least || is_point) && extent->size < watch->end && place < watch->end)) {
        bool is_far = place >= watch->end;
        tell_beyond(watch, is_far ? place : extent->size, extent->source, extent_name(extent),
                    is_far ? not_seen_perhaps : seen_beyond);
        return;
    }
    if (is_point || (extent->size < place * DBL_EPSILON && extent->size < spacing(place))) {
        tell_lost(watch, extent, place);
    }
    if (is_point) {
        return;
    }
    double distance = max_abs(vec3_sub(extent->place, watch->eye));
    if (distance > RANGE_RADII * extent->size) {
        tell_far(watch, extent, distance);
    }
}

static void check_plane(const Watch *watch, double distance, uint64_t source)
{
    if (!(fabs(distance) < watch->end)) {
        tell_beyond(watch, fabs(distance), source, "plane", not_seen_perhaps);
    }
}

static void check_points(const Watch *watch, const Scene *scene)
{
    for (size_t i = 0; i < scene->lights.count; i++) {
        const Light *light = &scene->lights.items[i];
        double length = vec3_max_abs(light->position);
        if (!(length < watch->end)) {
            tell_beyond(watch, length, light->span.begin, "light", "it may give no light");
        }
    }
}

// Of length about 1, so that products are in range; zero stays zero.
static Vec3 roughly_unit(Vec3 a)
{
    double greatest = vec3_max_abs(a);
    return greatest > 0.0 ? vec3_scale(1.0 / sqrt(3.0), vec3_scale(1.0 / greatest, a)) : a;
}

// Three products and two sums of numbers up to 1 are off by less than 8 u: what is not above is 0 but for rounding.
static void check_camera(const Camera *camera, DiagSink *diags)
{
    const double least = 8.0 * DBL_EPSILON;
    Vec3 direction = roughly_unit(camera->direction);
    Vec3 across = vec3_cross(roughly_unit(camera->right), roughly_unit(camera->up));
    const char *seen = NULL;
    if (vec3_equal(direction, vec3(0.0, 0.0, 0.0))) {
        seen = "the direction of the camera is 0";
    } else if (vec3_max_abs(across) <= least) {
        seen = "`right` and `up` of the camera are parallel, or one is 0";
    } else if (fabs(vec3_dot(direction, across)) <= least) {
        seen = "the direction of the camera lies in the plane of `right` and `up`";
    }
    if (seen && diag_report(diags, DIAG_W0445, camera->span, "%s", seen)) {
        diag_note(diags, SPAN_NONE, "the picture shows a point or a line, drawn out");
    }
}

static void check_directions(const Scene *scene, DiagSink *diags)
{
    for (size_t i = 0; i < scene->lights.count; i++) {
        const Light *light = &scene->lights.items[i];
        if (light->type != LIGHT_POINT && vec3_equal(light->position, light->point_at)) {
            diag_report(diags, DIAG_W0447, light->span, "the light shines at its own location: it has no direction");
        }
    }
    check_camera(&scene->camera, diags);
}

// Whether check_extent has nothing to tell of any ball of such sizes, in coordinates up to `place`.
static bool nothing_to_tell(const Watch *watch, double least, double greatest, double place)
{
    return least >= watch->least && greatest < watch->end && place < watch->end && least >= place * DBL_EPSILON &&
           place + max_abs(watch->eye) <= RANGE_RADII * least;
}

// Spheres are seldom worth a look at each.
static void check_spheres(const Scene *scene, const SphereSurvey *survey, const Watch *watch)
{
    if (nothing_to_tell(watch, survey->least_radius, survey->greatest_radius, survey->greatest_place)) {
        return;
    }
    for (size_t i = 0; i < scene->spheres.count; i++) {
        const Sphere *sphere = &scene->spheres.items[i];
        // sphere_data_make (trace/sphere.h) leaves out spheres whose squares are beyond.
        Extent extent = {sphere->radius, sphere->centre, scene_sphere_source(scene, i), "sphere", NULL};
        check_extent(watch, &extent, "it is not drawn");
    }
}

bool scene_range_reports(const Scene *scene, const SphereSurvey *survey, const SphereSurvey *some)
{
    int exponent = scale_with(scene, survey).exponent;
    Watch watch = {NULL, scene->camera.location, ldexp(1.0, RANGE_LEAST + exponent), ldexp(1.0, RANGE_END + exponent)};
    return !nothing_to_tell(&watch, some->least_radius, some->greatest_radius, some->greatest_place);
}

void scene_warn_of_range(const Scene *scene, const SphereSurvey *survey, DiagSink *diags)
{
    int exponent = scale_with(scene, survey).exponent;
    Watch watch = {diags, scene->camera.location, ldexp(1.0, RANGE_LEAST + exponent), ldexp(1.0, RANGE_END + exponent)};
    check_spheres(scene, survey, &watch);
    for (size_t i = 0; i < scene->planes.count; i++) {
        check_plane(&watch, scene->planes.items[i].distance, scene->planes.items[i].source);
    }
    for (size_t i = 0; i < scene->primitives.count; i++) {
        const Primitive *primitive = &scene->primitives.items[i];
        if (primitive->kind == PRIMITIVE_PLANE) {
            check_plane(&watch, primitive->data[1].x, primitive->source);
        } else {
            Extent extent = part_extent(primitive);
            check_extent(&watch, &extent, not_seen_perhaps);
        }
    }
    check_points(&watch, scene);
    check_directions(scene, diags);
}
