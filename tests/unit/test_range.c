// No sphere is dropped without a word: what is written is met by rays, or a warning with its place says that it is not.
//
// Scenes of spheres with sizes, places and cameras from all exponents that double has, a new seed each run. Spheres
// written are those that the geometry holds and those that are told as not drawn; and a camera ray that is aimed at the
// centre of one that is not called too far meets it. Usage: test_range [scenes].
//
// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/session.h"
#include "scene/recentre.h"
#include "scene/range.h"
#include "trace/geometry.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { SPHERES = 60, TEXT_MOST = 1 << 14, HEAD_LINES = 1 };

// What is known of the sphere on line HEAD_LINES + 1 + i.
typedef struct Written {
    bool is_empty;                        // radius 0, told
    bool is_beyond, is_not_drawn, is_far; // W0442, with that promise; W0443
    bool is_lost;                         // W0440, W0441
    bool is_record, is_held, is_met;
} Written;

typedef struct Told {
    Written spheres[SPHERES];
    int without_place, warnings;
} Told;

// Of all scenes.
typedef struct Counts {
    int written, held, empty, beyond, far, lost, dropped, called, missed;
} Counts;

static void on_diagnostic(void *client, const rt_diagnostic *diagnostic)
{
    Told *told = client;
    const char *code = diagnostic->code;
    if (diagnostic->severity != RT_WARNING) {
        return;
    }
    bool is_range = strncmp(code, "W044", 4) == 0 && code[4] <= '3';
    told->warnings += is_range;
    told->without_place += is_range && diagnostic->line == 0;
    if (diagnostic->line <= HEAD_LINES || diagnostic->line > HEAD_LINES + SPHERES) {
        return;
    }
    Written *sphere = &told->spheres[diagnostic->line - HEAD_LINES - 1];
    sphere->is_empty |= strcmp(code, "W0348") == 0;
    sphere->is_beyond |= strcmp(code, "W0442") == 0;
    sphere->is_not_drawn |= strcmp(code, "W0442") == 0 && strstr(diagnostic->text, "it is not drawn");
    sphere->is_far |= strcmp(code, "W0443") == 0;
    sphere->is_lost |= strcmp(code, "W0440") == 0 || strcmp(code, "W0441") == 0;
}

static double any_length(Random *random, int least, int most)
{
    double mantissa = random_between(random, 1, 2);
    return ldexp(mantissa, least + (int)(random_bits(random) % (unsigned)(most - least)));
}

static double any_coordinate(Random *random, int most)
{
    double length = random_bits(random) % 4 == 0 ? 0.0 : any_length(random, most - 60, most);
    return random_bits(random) & 1 ? length : -length;
}

static Vec3 any_place(Random *random, int most)
{
    double x = any_coordinate(random, most);
    double y = any_coordinate(random, most);
    double z = any_coordinate(random, most);
    return vec3(x, y, z);
}

// Places within some powers of two, sizes within others: of one scene alike, so that not all of it is beyond.
static void write_scene(Random *random, char *text)
{
    static const int spans[] = {4, 40, 120, 500, 1000};
    int about = (int)(random_bits(random) % 400) - 200;
    int places = spans[random_bits(random) % 5] / 2, sizes = spans[random_bits(random) % 5];
    Vec3 at = any_place(random, about);
    size_t length = (size_t)snprintf(text, TEXT_MOST, "camera { location <%.17g, %.17g, %.17g> direction z }\n", at.x,
                                     at.y, at.z);
    for (int i = 0; i < SPHERES; i++) {
        double radius = random_bits(random) % 30 == 0 ? 0.0 : any_length(random, about - sizes, about + sizes / 2);
        at = any_place(random, about + places);
        length += (size_t)snprintf(text + length, TEXT_MOST - length, "sphere { <%.17g, %.17g, %.17g>, %.17g }\n", at.x,
                                   at.y, at.z, radius);
    }
}

static bool is_met(Vec3 eye, const SphereData *ball)
{
    bool inside;
    SphereRay ray = sphere_ray_make(eye, vec3_normalize(vec3_sub(ball->centre, eye)));
    return vec3_equal(eye, ball->centre) || sphere_hit(&ray, ball, &inside) > 0.0;
}

// Looks each of the scene's spheres up in the geometry that pictures are made with.
static bool look_up(rt_session *session, Told *told)
{
    Scene *scene = &session->scene;
    Vec3 origin = scene_recentre(scene);
    int exponent = scene_scale(scene, 1).exponent;
    Geometry *geometry = geometry_new(scene, exponent);
    Vec3 eye = vec3_scale(ldexp(1.0, -exponent), scene->camera.location);
    const SphereTable *table = geometry ? &geometry->spheres : NULL;
    for (size_t i = 0; table && i < scene->spheres.count; i++) {
        SourceLocation at;
        if (!source_locate(session->sources, scene_source_span(scene_sphere_source(scene, i)), &at)) {
            continue;
        }
        Written *sphere = &told->spheres[at.line - HEAD_LINES - 1];
        sphere->is_record = true;
        for (uint32_t slot = 0; slot < table->block_count * SPHERE_BLOCK; slot++) {
            SphereData ball = sphere_table_ball(table, slot);
            if (!isnan(ball.radius_squared) && table->info[slot].order == scene_sphere_order(scene, i)) {
                sphere->is_held = true;
                sphere->is_met = is_met(eye, &ball);
            }
        }
    }
    geometry_free(geometry);
    scene_move_back(scene, origin);
    return geometry;
}

static void count(const Told *told, Counts *counts, const char *text)
{
    for (int i = 0; i < SPHERES; i++) {
        const Written *sphere = &told->spheres[i];
        bool is_dropped = !sphere->is_held && !sphere->is_beyond && !sphere->is_empty;
        bool is_called = sphere->is_held && (sphere->is_not_drawn || sphere->is_empty);
        bool is_missed = sphere->is_held && !sphere->is_met && !sphere->is_far && !sphere->is_beyond;
        counts->written++;
        counts->held += sphere->is_held;
        counts->empty += sphere->is_empty;
        counts->beyond += sphere->is_beyond;
        counts->far += sphere->is_far;
        counts->lost += sphere->is_lost;
        counts->dropped += is_dropped;
        counts->called += is_called;
        counts->missed += is_missed;
        if ((is_dropped || is_called || is_missed) && counts->dropped + counts->called + counts->missed < 5) {
            printf("# line %d is %s in\n%s", HEAD_LINES + 1 + i,
                   is_dropped  ? "dropped without a word"
                   : is_called ? "drawn, and told as not drawn"
                               : "missed",
                   text);
        }
    }
}

static const char ordinary[] =
    "camera { location <0, 1, -6> look_at 0 } light_source { <5, 8, -9>, 1 }\n"
    "plane { y, -1 pigment { checker rgb 1 rgb 0.2 } }\n"
    "sphere { 0, 1 pigment { rgb <1, 0.3, 0.2> } finish { phong 1 reflection 0.3 } }\n"
    "sphere { <2, 0, 1>, 1 pigment { rgb <0.2, 0.5, 1> } finish { reflection 0.3 } }\n";

// The sum of all values of a picture of the ordinary scene and what comes after it, each weighed by its place.
static double picture_sum(const char *more, Told *told)
{
    char text[1024];
    int width, height;
    double sum = 0.0;
    rt_session *session = rt_session_new(&(rt_callbacks){told, on_diagnostic, NULL, NULL});
    snprintf(text, sizeof text, "%s%s\n", ordinary, more);
    rt_set_size(session, 40, 30);
    if (rt_load_text(session, "range.scn", text, strlen(text)) == RT_OK && rt_render(session, 1) == RT_OK) {
        const float *pixels = rt_pixels(session, &width, &height);
        for (int i = 0; i < 3 * width * height; i++) {
            sum += pixels[i] * (1.0 + i % 1009);
        }
    }
    rt_session_free(session);
    return sum;
}

// What cannot be held is given up by itself.
static void test_given_up(void)
{
    static const char *const extremes[] = {"sphere { <0.2, 0.3, -2>, 1e-310 }", "sphere { 1e300 * x, 1 }",
                                           "sphere { 0, 1e-300 } sphere { 1e290 * y, 1e280 }", "plane { y, 1e305 }"};
    Told alone = {.warnings = 0};
    double expected = picture_sum("", &alone);
    for (size_t i = 0; i < RT_COUNT_OF(extremes); i++) {
        Told told = {.warnings = 0};
        double sum = picture_sum(extremes[i], &told);
        tap_ok(expected > 0.0 && sum == expected && told.warnings > 0,
               "an ordinary scene with %s is drawn as without, with %d warnings", extremes[i], told.warnings);
    }
}

int main(int argc, char **argv)
{
    static char text[TEXT_MOST];
    int scenes = argc > 1 ? atoi(argv[1]) : 400, wrong = 0, without_place = 0;
    Random random = {random_seed(NULL)};
    Counts counts = {0};
    for (int i = 0; i < scenes; i++) {
        Told told = {.warnings = 0};
        rt_session *session = rt_session_new(&(rt_callbacks){&told, on_diagnostic, NULL, NULL});
        write_scene(&random, text);
        session->diags.keep_warnings = session->diags.keep_alike = SIZE_MAX;
        bool is_read = rt_load_text(session, "range.scn", text, strlen(text)) == RT_OK && look_up(session, &told);
        rt_summary summary;
        rt_get_summary(session, &summary);
        wrong += !is_read || summary.out_of_range != (uint64_t)told.warnings;
        without_place += told.without_place;
        count(&told, &counts, text);
        rt_session_free(session);
    }
    tap_ok(wrong == 0 && without_place == 0,
           "%d scenes: %d not read, or not counted in the summary; %d warnings without a place", scenes, wrong,
           without_place);
    tap_ok(counts.dropped == 0,
           "of %d spheres %d are held, %d beyond the range, %d of radius 0, and %d dropped without a word",
           counts.written, counts.held, counts.beyond, counts.empty, counts.dropped);
    tap_ok(counts.called == 0, "%d of those held are told as not drawn", counts.called);
    tap_ok(counts.missed == 0,
           "a ray at its centre misses %d of those held; %d of them are told as too far, %d as lost", counts.missed,
           counts.far, counts.lost);
    tap_ok(counts.held > 0 && counts.beyond > 0 && counts.empty > 0 && counts.far > 0 && counts.lost > 0,
           "there are spheres of each kind");
    test_given_up();
    return tap_done();
}
