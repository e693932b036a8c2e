// A session whose scene changes between its pictures: each is that of a fresh session with the same numbers, byte for byte,
// whatever was built before; and no more is built than what has changed.
//
// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rtlang/rtlang.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { WIDTH = 64, HEIGHT = 48, SPHERES = 700, GROUPS = 2, RODS = 5, RUNS = 16, CHANGES = 12, PLANET = 300 };

// All that a session was told, so that a fresh one can be told the same.
typedef struct Model {
    double centers[GROUPS][SPHERES][3], radii[GROUPS][SPHERES], colors[GROUPS][SPHERES][3];
    double rods[RODS][6];
    size_t counts[GROUPS], groups[GROUPS], group_count;
    bool has_rods, has_twin, are_rods_first; // before the second group
    char twin[256]; // a ball that is a part, where a sphere of the first group was
    rt_camera camera;
    rt_light light;
    int samples;
} Model;

static rt_session *session_open(void)
{
    rt_session *session = rt_session_new(NULL);
    if (!session || rt_set_size(session, WIDTH, HEIGHT) ||
        rt_set_planes(session, RT_PLANE_OBJECT | RT_PLANE_DEPTH)) {
        abort();
    }
    return session;
}

static void fill(Random *random, double *numbers, size_t count, double low, double high)
{
    for (size_t i = 0; i < count; i++) {
        numbers[i] = random_between(random, low, high);
    }
}

static rt_array array3(const double (*numbers)[3])
{
    return (rt_array){numbers, RT_FLOAT64, sizeof *numbers, sizeof(double)};
}

static rt_status tell_group(rt_session *session, const Model *m, size_t group, size_t *number)
{
    rt_spheres spheres = {.count = m->counts[group],
                          .centers = array3(m->centers[group]),
                          .radii = {m->radii[group], RT_FLOAT64, sizeof(double), 0},
                          .look = {array3(m->colors[group]), 3, "reflection 0.2 phong 0.4"}};
    return rt_add_spheres(session, &spheres, number);
}

static rt_status tell_rods(rt_session *session, const Model *m)
{
    static const double radius = 0.05;
    rt_rods rods = {.count = RODS,
                    .bases = {m->rods[0], RT_FLOAT64, sizeof m->rods[0], sizeof(double)},
                    .caps = {m->rods[0] + 3, RT_FLOAT64, sizeof m->rods[0], sizeof(double)},
                    .base_radii = {&radius, RT_FLOAT64, 0, 0}};
    return rt_add_rods(session, &rods);
}

static rt_status tell_view(rt_session *session, const Model *m)
{
    rt_sampling sampling = {.samples = m->samples};
    rt_status status = rt_set_camera(session, &m->camera);
    status = status ? status : rt_clear_lights(session);
    status = status ? status : rt_add_light(session, &m->light);
    return status ? status : rt_set_sampling(session, &sampling);
}

static void model_make(Model *m, Random *random)
{
    *m = (Model){.counts = {9 + random_below(random, SPHERES - 9)}};
    m->counts[1] = 9 + random_below(random, SPHERES - 9);
    fill(random, m->centers[0][0], GROUPS * SPHERES * 3, -3.0, 3.0);
    fill(random, m->radii[0], GROUPS * SPHERES, 0.05, 0.3);
    fill(random, m->colors[0][0], GROUPS * SPHERES * 3, 0.0, 1.0);
    fill(random, m->rods[0], RODS * 6, -3.0, 3.0);
    if (random_below(random, 3) == 0) { // a planet under them, which is kept out of the tree
        m->radii[0][0] = PLANET;
        m->centers[0][0][1] = -PLANET - 3.0;
    }
    m->camera = (rt_camera){.location = {0.5, 1.5, -9.0}, .look_at = {0.1, 0.2, 0.3}, .angle = 45.0};
    m->light = (rt_light){.position = {-4.0, 6.0, -7.0}, .color = {0.9, 0.8, 0.7}};
}

// ---- changes

static rt_status pass_on(rt_session *session, const Model *m, size_t group, size_t first, size_t count, char what)
{
    rt_spheres spheres = {.count = count};
    if (what == 'c') {
        spheres.centers = array3(&m->centers[group][first]);
    } else if (what == 'r') {
        spheres.radii = (rt_array){&m->radii[group][first], RT_FLOAT64, sizeof(double), 0};
    } else {
        spheres.look = (rt_look){array3(&m->colors[group][first]), 3, NULL};
    }
    return rt_update_spheres(session, m->groups[group], first, &spheres);
}

// Some spheres, or all, go by up to so much, and everything is scaled.
static rt_status move(rt_session *session, Model *m, Random *random, double by, double scale, bool is_all)
{
    size_t group = random_below(random, (unsigned)m->group_count), count = m->counts[group];
    size_t first = is_all ? 0 : random_below(random, (unsigned)count);
    size_t some = is_all ? count : random_below(random, (unsigned)(count - first)) + 1;
    for (size_t i = first; i < first + some; i++) {
        for (int k = 0; k < 3; k++) {
            m->centers[group][i][k] = scale * m->centers[group][i][k] + random_between(random, -by, by);
        }
    }
    return pass_on(session, m, group, first, some, 'c');
}

static rt_status resize_or_color(rt_session *session, Model *m, Random *random, bool has_colors)
{
    size_t group = random_below(random, (unsigned)m->group_count), count = m->counts[group];
    size_t first = random_below(random, (unsigned)count);
    size_t some = random_below(random, (unsigned)(count - first)) + 1;
    for (size_t i = first; i < first + some; i++) {
        m->radii[group][i] *= has_colors ? 1.0 : random_between(random, 0.8, 1.2);
        fill(random, m->colors[group][i], has_colors ? 3 : 0, 0.0, 1.0);
    }
    return pass_on(session, m, group, first, some, has_colors ? 'k' : 'r');
}

// What comes after everything else, once.
static rt_status add(rt_session *session, Model *m, Random *random)
{
    if (m->has_twin) {
        return RT_OK;
    }
    if (m->has_rods && (m->group_count == GROUPS || random_below(random, 2))) {
        const double *c = m->centers[0][1];
        m->has_twin = true;
        sprintf(m->twin, "sphere { <%.17g, %.17g, %.17g>, %.17g pigment { rgb 0.5 } no_reflection }", c[0], c[1], c[2],
                m->radii[0][1]);
        return rt_load_text(session, "twin", m->twin, strlen(m->twin));
    }
    if (!m->has_rods && (m->group_count == GROUPS || random_below(random, 2))) {
        m->has_rods = true;
        return tell_rods(session, m);
    }
    m->group_count = GROUPS;
    m->are_rods_first = m->has_rods;
    return tell_group(session, m, 1, &m->groups[1]);
}

static rt_status change(rt_session *session, Model *m, Random *random)
{
    bool is_all = random_below(random, 2);
    double scale = random_between(random, 0.3, 2.0);
    switch (random_below(random, 10)) {
    case 0: return move(session, m, random, 0.02, 1.0, true);
    case 1: return move(session, m, random, 0.02, 1.0, false);
    case 2: return move(session, m, random, 4.0, 1.0, is_all);
    case 3: return move(session, m, random, 0.0, scale, true);
    case 4: return resize_or_color(session, m, random, false);
    case 5:
    case 6: return resize_or_color(session, m, random, true);
    case 7: return add(session, m, random);
    case 8: m->samples = m->samples ? 0 : 3; break;
    default:
        m->camera.location[2] = random_between(random, -12.0, -7.0);
        m->camera.location[2] = random_below(random, 4) ? m->camera.location[2] : -0x1p30;
        m->light.position[0] = random_between(random, -9.0, 9.0);
        break;
    }
    return tell_view(session, m);
}

// ---- pictures

static rt_session *fresh_of(const Model *m)
{
    size_t number;
    rt_session *session = session_open();
    rt_status status = rt_begin_scene(session);
    status = status ? status : tell_group(session, m, 0, &number);
    for (int turn = 0; turn < 2 && !status; turn++) {
        if ((turn == 0) == m->are_rods_first) {
            status = m->has_rods ? tell_rods(session, m) : RT_OK;
        } else {
            status = m->group_count > 1 ? tell_group(session, m, 1, &number) : RT_OK;
        }
    }
    status = status || !m->has_twin ? status : rt_load_text(session, "twin", m->twin, strlen(m->twin));
    status = status ? status : tell_view(session, m);
    if (status || rt_render(session, 1)) {
        rt_session_free(session);
        return NULL;
    }
    return session;
}

static bool look_same(rt_session *a, rt_session *b)
{
    static uint32_t objects[2][WIDTH * HEIGHT];
    int width, height;
    const float *one = rt_pixels(a, &width, &height), *other = rt_pixels(b, &width, &height);
    return one && other && memcmp(one, other, (size_t)width * (size_t)height * 3 * sizeof *one) == 0 &&
           rt_get_plane(a, RT_PLANE_OBJECT, objects[0], sizeof objects[0]) == RT_OK &&
           rt_get_plane(b, RT_PLANE_OBJECT, objects[1], sizeof objects[1]) == RT_OK &&
           memcmp(objects[0], objects[1], sizeof objects[0]) == 0;
}

static void check_changes(Random *random)
{
    int equal = 0, pictures = 0;
    uint64_t trees = 0, refits = 0;
    static Model m;
    for (int run = 0; run < RUNS; run++) {
        rt_session *session = session_open();
        model_make(&m, random);
        m.group_count = 1;
        bool is_fine = rt_begin_scene(session) == RT_OK && tell_group(session, &m, 0, &m.groups[0]) == RT_OK &&
                       tell_view(session, &m) == RT_OK;
            for (int i = 0; i < CHANGES && is_fine; i++) {
            is_fine = rt_render(session, 2) == RT_OK;
            rt_session *fresh = fresh_of(&m);
            equal += is_fine && fresh && look_same(session, fresh);
            pictures++;
            rt_session_free(fresh);
            for (unsigned some = 1 + random_below(random, 2); some > 0 && is_fine; some--) {
                is_fine = change(session, &m, random) == RT_OK;
            }
        }
        rt_summary summary;
        rt_get_summary(session, &summary);
        trees += summary.trees;
        refits += summary.refits;
        rt_session_free(session);
        pictures += !is_fine; // which then are more than the equal ones
    }
    tap_ok(equal == pictures, "%d of %d pictures after changes are those of fresh sessions", equal, pictures);
    tap_ok(trees > RUNS && refits > RUNS && trees < (uint64_t)pictures, "with %d trees, and %d that were made to fit",
           (int)trees, (int)refits);
}

// ---- what is built

static void built(rt_session *session, uint64_t trees, uint64_t refits, const char *after)
{
    rt_summary summary;
    rt_status status = rt_render(session, 2);
    rt_get_summary(session, &summary);
    tap_ok(status == RT_OK && summary.trees == trees && summary.refits == refits,
                  "%s: %d trees, %d made to fit", after, (int)summary.trees, (int)summary.refits);
}

static void check_counts(Random *random)
{
    static Model m;
    rt_session *session = session_open();
    model_make(&m, random);
    m.counts[0] = m.counts[1] = SPHERES;
    m.group_count = 1;
    m.radii[0][0] = 0.1;
    (void)rt_begin_scene(session);
    (void)tell_group(session, &m, 0, &m.groups[0]);
    (void)tell_view(session, &m);
    built(session, 1, 0, "a first picture");
    m.camera.location[0] += 0.5;
    (void)tell_view(session, &m);
    (void)rt_set_crop(session, 3, 4, 20, 20);
    built(session, 1, 0, "another camera and part of the picture");
    (void)pass_on(session, &m, 0, 5, 100, 'k');
    built(session, 1, 1, "colors of some, the first time");
    (void)pass_on(session, &m, 0, 0, SPHERES, 'k');
    built(session, 1, 1, "other colors");
    (void)move(session, &m, random, 0.01, 1.0, true);
    built(session, 1, 2, "all spheres moved a little");
    (void)pass_on(session, &m, 0, 7, 1, 'c');
    built(session, 1, 3, "one sphere");
    (void)pass_on(session, &m, 0, 7, 90, 'r');
    built(session, 1, 4, "radii");
    (void)tell_rods(session, &m);
    built(session, 2, 4, "rods: a tree of their own");
    (void)move(session, &m, random, 0.01, 1.0, true);
    built(session, 2, 5, "which stays as spheres move");
    fill(random, m.centers[0][0], 3 * (size_t)SPHERES, -3.0, 3.0);
    (void)pass_on(session, &m, 0, 0, SPHERES, 'c');
    built(session, 3, 5, "spheres in other places altogether");
    (void)tell_group(session, &m, 1, &m.groups[1]);
    built(session, 4, 5, "more spheres");
    rt_session_free(session);
}

int main(int argc, char **argv)
{
    Random random = {random_seed(argc > 1 ? argv[1] : NULL)};
    check_counts(&random);
    check_changes(&random);
    return tap_done();
}
