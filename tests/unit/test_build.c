// Scenes that are built by calls: their pictures are those of text of the same numbers, byte for byte, whatever else
// the session has drawn before; and what is wrong with arrays and the order of calls is told.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/attributes.h"
#include "rtlang/rtlang.h"
#include "unit/build_scenes.h"
#include "unit/tap.h"

enum { TEXT_BYTES = 1 << 18, SCENES = 24 };

// ---- pictures

static bool pictures_equal(rt_session *a, rt_session *b)
{
    int width, height;
    const float *one = rt_pixels(a, &width, &height), *other = rt_pixels(b, &width, &height);
    bool is_equal = one && other && memcmp(one, other, (size_t)width * (size_t)height * 3 * sizeof *one) == 0;
    rt_output output = {0};
    const unsigned char *bytes[2] = {NULL, NULL};
    size_t sizes[2];
    is_equal = is_equal && rt_get_png(a, &output, &bytes[0], &sizes[0]) == RT_OK &&
               rt_get_png(b, &output, &bytes[1], &sizes[1]) == RT_OK;
    return is_equal && sizes[0] == sizes[1] && memcmp(bytes[0], bytes[1], sizes[0]) == 0;
}

static rt_session *draw_text(const char *text)
{
    rt_session *session = session_open(NULL);
    rt_status status = rt_load_text(session, "text.scn", text, strlen(text));
    if (status || rt_render(session, 2)) {
        printf("# status %d of\n%s", status, text);
    }
    return session;
}

// Spheres in the same colours as those of a group, added when these have colours of their own, keep them when the group
// turns grey.
static bool stays_apart(rt_session *session, Random *random, Numbers *n, size_t group)
{
    size_t extra;
    n->is_single = false;
    Numbers aside = *n;
    for (size_t i = 0; i < n->spheres; i++) {
        aside.centers[i][1] += 2.0;
    }
    rt_spheres grey = {.count = n->spheres, .look = {{n->background, RT_FLOAT64, 0, sizeof(double)}, 3, NULL}};
    bool is_equal = add_spheres(session, random, &aside, &extra) == RT_OK &&
                    rt_update_spheres(session, group, 0, &grey) == RT_OK && rt_render(session, 1) == RT_OK;
    for (size_t i = 0; i < n->spheres; i++) {
        memset(n->colors[i], 0, sizeof n->colors[i]);
        memcpy(n->colors[i], n->background, 3 * sizeof(double));
    }
    rt_session *fresh = session_open(NULL);
    is_equal = is_equal && rt_begin_scene(fresh) == RT_OK && add_view(fresh, n) == RT_OK &&
               add_spheres(fresh, random, n, &group) == RT_OK && add_spheres(fresh, random, &aside, &extra) == RT_OK &&
               rt_render(fresh, 1) == RT_OK && pictures_equal(session, fresh);
    rt_session_free(fresh);
    return is_equal;
}

// Spheres that get other places, then other colours, twice, and then sizes; after each the picture is that of text.
static bool updates_equal(Random *random, Numbers *n, char *text)
{
    Numbers other;
    size_t group;
    rt_session *session = session_open(NULL);
    bool is_equal = rt_begin_scene(session) == RT_OK && add_view(session, n) == RT_OK &&
                    add_spheres(session, random, n, &group) == RT_OK && rt_render(session, 1) == RT_OK;
    n->rods = n->triangles = 0;
    for (int turn = 0; turn < 5; turn++) {
        const ptrdiff_t step = sizeof(double);
        bool moves = turn == 0 || turn == 3, grows = turn == 4;
        rt_spheres changed = {.count = n->spheres};
        numbers_make(&other, random);
        if (moves) {
            memcpy(n->centers, other.centers, sizeof n->centers);
            changed.centers = (rt_array){n->centers, RT_FLOAT64, sizeof n->centers[0], step};
        } else if (grows) {
            memcpy(n->radii, other.radii, sizeof n->radii);
            changed.radii = (rt_array){n->radii, RT_FLOAT64, step, 0};
        } else {
            memcpy(n->colors, other.colors, sizeof n->colors);
            changed.look = (rt_look){{n->colors, RT_FLOAT64, sizeof n->colors[0], step}, n->color_numbers, NULL};
        }
        rt_session *written = session_open(NULL);
        write_text(n, text);
        is_equal = is_equal && rt_update_spheres(session, group, 0, &changed) == RT_OK &&
                   rt_render(session, 2) == RT_OK && rt_load_text(written, "text", text, strlen(text)) == RT_OK &&
                   rt_render(written, 1) == RT_OK && pictures_equal(session, written);
        rt_session_free(written);
    }
    is_equal = is_equal && stays_apart(session, random, n, group);
    rt_session_free(session);
    return is_equal;
}

static void check_equal_to_text(Random *random, char *text)
{
    int equal = 0, equal_again = 0, equal_moved = 0;
    for (int i = 0; i < SCENES; i++) {
        Numbers n;
        size_t group;
        numbers_make(&n, random);
        rt_session *built = session_open(NULL);
        bool is_made = rt_begin_scene(built) == RT_OK && add_view(built, &n) == RT_OK &&
                       add_shapes(built, random, &n, &group) == RT_OK && rt_render(built, 2) == RT_OK;
        write_text(&n, text);
        rt_session *written = draw_text(text);
        equal += is_made && pictures_equal(built, written);
        rt_session_free(written);
        n.camera.location[0] += 1.0;
        write_text(&n, text);
        written = draw_text(text);
        equal_again += rt_set_camera(built, &n.camera) == RT_OK && rt_render(built, 1) == RT_OK &&
                       pictures_equal(built, written);
        rt_session_free(written);
        equal_moved += updates_equal(random, &n, text);
        rt_session_free(built);
    }
    tap_ok(equal == SCENES, "%d of %d scenes: from arrays as from text, byte for byte", equal, SCENES);
    tap_ok(equal_again == SCENES, "%d of %d: with another camera, too", equal_again, SCENES);
    tap_ok(equal_moved == SCENES, "%d of %d: with other places and colours", equal_moved, SCENES);
}

// A scene far from the origin is moved there where a camera's place allows that exactly, and the range of numbers that
// it is traced in follows the camera: what was built for another camera must not serve then.
static void check_cameras_apart(double far)
{
    const double places[][3] = {
        {far + 3.0, 1.0, -9.0}, {far + 0.3, 1.1, -9.0}, {far - 2.0, 3.0, -8.0}, {far, 0.0, -0x1p48},
        {far + 1.0, 0.7, -7.0}};
    enum { PLACES = RT_COUNT_OF(places) };
    double centers[5][3], radius = 0.7, colors[5][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}};
    rt_light light = {.position = {far - 4.0, 8.0, -9.0}, .color = {1, 1, 1}};
    rt_spheres spheres = {.count = 5,
                          .centers = {centers, RT_FLOAT64, sizeof centers[0], sizeof(double)},
                          .radii = {&radius, RT_FLOAT64, 0, 0},
                          .look = {{colors, RT_FLOAT64, sizeof colors[0], sizeof(double)}, 3, "reflection 0.3"}};
    rt_session *sessions[2] = {session_open(NULL), NULL};
    int equal = 0;
    for (int i = 0; i < 5; i++) {
        centers[i][0] = far + i - 2.0;
        centers[i][1] = 0.5 * i - 1.0;
        centers[i][2] = i % 2;
    }
    for (int i = 0; i < PLACES; i++) {
        rt_camera camera = {.look_at = {far, 0.0, 0.0}, .angle = 40.0};
        memcpy(camera.location, places[i], sizeof camera.location);
        camera.width = i == 3 ? 8.0 : 0.0;
        sessions[1] = session_open(NULL);
        bool is_drawn = true;
        for (int k = 0; k < 2; k++) {
            if (k == 1 || i == 0) {
                is_drawn = is_drawn && rt_begin_scene(sessions[k]) == RT_OK &&
                           rt_add_spheres(sessions[k], &spheres, NULL) == RT_OK &&
                           rt_add_light(sessions[k], &light) == RT_OK;
            }
            is_drawn = is_drawn && rt_set_camera(sessions[k], &camera) == RT_OK && rt_render(sessions[k], 1) == RT_OK;
        }
        equal += is_drawn && pictures_equal(sessions[0], sessions[1]);
        rt_session_free(sessions[1]);
    }
    rt_session_free(sessions[0]);
    tap_ok(equal == PLACES, "%d of %d cameras, %g from the origin: as from a session of their own", equal,
           PLACES, far);
}

// ---- what is told

static rt_spheres three_spheres(double centers[3][3], double radii[3])
{
    for (int i = 0; i < 3; i++) {
        centers[i][0] = 2.0 * i;
        centers[i][1] = centers[i][2] = 0.0;
        radii[i] = 0.5;
    }
    return (rt_spheres){.count = 3,
                        .centers = {centers, RT_FLOAT64, 3 * sizeof(double), sizeof(double)},
                        .radii = {radii, RT_FLOAT64, sizeof(double), 0}};
}

static void check_faults(void)
{
    Told told;
    double centers[3][3], radii[3], colors[3][3] = {{1, 0, 0}, {0, 255, 255}, {0, 0, 1}};
    rt_spheres spheres = three_spheres(centers, radii);
    rt_session *session = session_open(&told);
    tap_ok(rt_add_spheres(session, &spheres, NULL) == RT_FAULT_USAGE &&
               says(&told, "rtlang: error[E0709]: rt_add_spheres is for a scene that was begun and is whole\n"
                           "     = help: rt_begin_scene\n"),
           "arrays before rt_begin_scene");
    (void)rt_begin_scene(session);
    (void)rt_set_warning(session, "W0211");
    radii[1] = -1.0;
    tap_ok(rt_add_spheres(session, &spheres, NULL) == RT_FAULT_SCENE &&
               says(&told, "spheres[1]: error[E0460]: the radius must be 0 or more, and finite, not -1\n"),
           "a negative radius");
    radii[1] = 0.5;
    centers[2][1] = (double)NAN;
    spheres.name = "atoms";
    tap_ok(rt_add_spheres(session, &spheres, NULL) == RT_FAULT_SCENE &&
               says(&told, "atoms[2]: error[E0460]: number 1 of the center must be finite, not nan\n"),
           "a coordinate that is no number");
    centers[2][1] = 0.0;
    spheres.look = (rt_look){{colors, RT_FLOAT64, sizeof colors[0], sizeof(double)}, 3, NULL};
    radii[0] = 0.0;
    tap_ok(rt_add_spheres(session, &spheres, NULL) == RT_OK &&
               says(&told, "atoms[1]: warning[W0211]: this colour looks like bytes\n"
                           "     = help: components go from 0 to 1: divide by 255\n"
                           "atoms[0]: warning[W0348]: a sphere of radius 0 is not drawn\n"),
           "a colour like bytes, and a radius of 0");
    size_t group;
    spheres = three_spheres(centers, radii);
    spheres.look.finish = "phong 1 rouhness 2";
    tap_ok(rt_add_spheres(session, &spheres, &group) == RT_FAULT_SCENE &&
               says(&told, "finish:2:9: error[E0250]: unknown property `rouhness` in finish\n"
                           "   2 | phong 1 rouhness 2\n     |         ^~~~~~~~\n"
                           "     = help: did you mean `roughness`?\n"),
           "a finish that is mistyped");
    rt_camera camera = {.location = {0, 0, -5}, .look_at = {0, 0, -5}};
    tap_ok(rt_set_camera(session, &camera) == RT_FAULT_SCENE && strstr(told.texts, "error[E0346]"),
           "a camera that looks at itself");
    told.texts[0] = '\0';
    camera = (rt_camera){.location = {0, (double)INFINITY, -5}};
    tap_ok(rt_set_camera(session, &camera) == RT_FAULT_SCENE &&
               says(&told, "rtlang: error[E0460]: all numbers of a camera must be finite\n"),
           "a camera at infinity");
    camera = (rt_camera){.location = {2, 0, -10}, .look_at = {2, 0, 0}};
    rt_light light = {.position = {0, 5, -5}, .color = {1, 1, 1}};
    tap_ok(rt_set_camera(session, &camera) == RT_OK && rt_add_light(session, &light) == RT_OK &&
               rt_render(session, 1) == RT_OK && says(&told, ""),
           "after all this the scene can be drawn");
    rt_set_limit(session, RT_LIMIT_OBJECTS, 4);
    spheres = three_spheres(centers, radii);
    tap_ok(rt_add_spheres(session, &spheres, NULL) == RT_FAULT_LIMIT && strstr(told.texts, "error[E0490]"),
           "more spheres than the limit");
    rt_session_free(session);
}

static void check_places(void)
{
    Told told;
    double centers[3][3], radii[3];
    rt_spheres spheres = three_spheres(centers, radii);
    rt_session *session = session_open(&told);
    rt_camera camera = {.location = {2, 0, -10}, .look_at = {2, 0, 0}};
    rt_light light = {.position = {0, 5, -5}, .color = {1, 1, 1}};
    const char stage[] = "plane { y, -1 pigment { rgb 0.7 } }";
    (void)rt_begin_scene(session);
    memcpy(centers[2], centers[1], sizeof centers[1]);
    double colors[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    spheres.look = (rt_look){{colors, RT_FLOAT64, sizeof colors[0], sizeof(double)}, 3, NULL};
    bool is_made = rt_load_text(session, "stage.scn", stage, strlen(stage)) == RT_OK &&
                   rt_add_spheres(session, &spheres, NULL) == RT_OK && rt_set_camera(session, &camera) == RT_OK &&
                   rt_add_light(session, &light) == RT_OK;
    tap_ok(is_made && rt_render(session, 1) == RT_OK &&
               strncmp(told.texts, "spheres[2]: warning[W0", 22) == 0,
           "what only the whole scene tells names the element: %.60s", told.texts);
    told.texts[0] = '\0';
    tap_ok(rt_load_text(session, "more.scn", "sphere {", 8) == RT_FAULT_SCENE &&
               rt_render(session, 1) == RT_FAULT_USAGE,
           "after a part that could not be loaded the scene is lost");
    rt_session_free(session);
}

static void check_pixels(void)
{
    double centers[3][3], radii[3], low[3], high[3];
    rt_spheres spheres = three_spheres(centers, radii);
    rt_session *session = session_open(NULL);
    rt_camera camera = {.location = {2, 0, -10}, .look_at = {2, 0, 0}};
    static uint8_t bytes[WIDTH * HEIGHT * 4];
    static uint16_t words[WIDTH * HEIGHT * 3];
    static float floats[WIDTH * HEIGHT * 3];
    rt_output eight = {.depth = RT_DEPTH_8}, sixteen = {.depth = RT_DEPTH_16}, wide = {.depth = RT_DEPTH_FLOAT};
    int width, height;
    (void)rt_begin_scene(session);
    tap_ok(rt_get_pixels(session, &eight, bytes, sizeof bytes) == RT_FAULT_USAGE &&
               rt_get_box(session, low, high) == RT_FAULT_USAGE,
           "pixels of no picture, the box around nothing");
    spheres.look.finish = "ambient 1 diffuse 0";
    (void)rt_add_spheres(session, &spheres, NULL);
    (void)rt_set_camera(session, &camera);
    tap_ok(rt_get_box(session, low, high) == RT_OK && low[0] == -0.5 && high[0] == 4.5 && low[1] == -0.5 &&
               high[2] == 0.5,
           "the box around the shapes");
    tap_ok(rt_render(session, 1) == RT_OK && rt_get_pixels(session, &eight, bytes, WIDTH * HEIGHT * 3) == RT_OK &&
               rt_get_pixels(session, &sixteen, words, sizeof words) == RT_OK &&
               rt_get_pixels(session, &wide, floats, sizeof floats) == RT_OK &&
               rt_get_pixels(session, &eight, bytes, sizeof bytes) == RT_FAULT_USAGE &&
               memcmp(floats, rt_pixels(session, &width, &height), sizeof floats) == 0,
           "pixels of 8, 16 and 32 bits");
    size_t middle = 3 * (HEIGHT / 2 * WIDTH + WIDTH / 2);
    tap_ok(floats[middle] == 1.0F && bytes[middle] == 255 && words[middle] == 65535 && bytes[0] == 0,
           "a white sphere in the middle: %g %d %d", (double)floats[middle], bytes[middle], words[middle]);
    rt_set_alpha(session, 1);
    tap_ok(rt_render(session, 1) == RT_OK && rt_get_pixels(session, &eight, bytes, sizeof bytes) == RT_OK &&
               bytes[3] == 0 && bytes[4 * (HEIGHT / 2 * WIDTH + WIDTH / 2) + 3] == 255,
           "alpha");
    rt_cancel(session);
    rt_status cancelled = rt_render(session, 1);
    rt_resume(session);
    tap_ok(cancelled == RT_CANCELLED && rt_render(session, 1) == RT_OK, "cancelled, and on again");
    rt_set_alpha(session, 0);
    (void)rt_render(session, 1);
    float *taken = rt_take_pixels(session, &width, &height);
    tap_ok(taken && width == WIDTH && height == HEIGHT && memcmp(taken, floats, sizeof floats) == 0 &&
               !rt_take_pixels(session, &width, &height) && !rt_pixels(session, &width, &height) &&
               rt_get_pixels(session, &wide, floats, sizeof floats) == RT_FAULT_USAGE,
           "pixels that are taken are gone");
    tap_ok(rt_render(session, 1) == RT_OK && memcmp(taken, rt_pixels(session, &width, &height), sizeof floats) == 0,
           "and a next picture is another one");
    rt_free_pixels(taken);
    rt_session_free(session);
}

// ---- any order of calls

// What changes how the same scene looks; the numbers may be wrong.
// ---- more than a thread takes on end

enum { MANY = 4 * 16384 + 77, PIECE = 999 };

static double many_centers[MANY][3], many_radii[MANY];
static float many_colors[MANY][3];

// At first a few colours, then others, of which some equal the one before, and some spheres of no size.
static void many_make(Random *random, bool has_pairs, bool has_points)
{
    for (int i = 0; i < MANY; i++) {
        bool is_again = i > 0 && (i < 20000 ? i % 5 != 0 : has_pairs && random_below(random, 2));
        fill(random, many_centers[i], 3, -3.0, 3.0, false);
        many_radii[i] = has_points && random_below(random, 9000) == 0 ? 0.0 : random_between(random, 0.01, 0.04);
        for (int k = 0; k < 3; k++) {
            many_colors[i][k] = is_again ? many_colors[i - 1][k] : (float)random_between(random, 0.0, 1.0);
        }
    }
}

static rt_spheres many_from(int first, int count)
{
    return (rt_spheres){
        .count = (size_t)count,
        .centers = {many_centers[first], RT_FLOAT64, sizeof many_centers[0], sizeof(double)},
        .radii = {&many_radii[first], RT_FLOAT64, sizeof(double), 0},
        .look = {{many_colors[first], RT_FLOAT32, sizeof many_colors[0], sizeof(float)}, 3, NULL},
    };
}

static rt_session *many_draw(int piece, int threads)
{
    rt_session *session = session_open(NULL);
    rt_camera camera = {.location = {1, 2, -9}, .angle = 40};
    rt_light light = {.position = {5, 9, -5}, .color = {1, 1, 1}};
    bool is_made = rt_set_load_threads(session, threads) == RT_OK && rt_begin_scene(session) == RT_OK &&
                   rt_set_camera(session, &camera) == RT_OK && rt_add_light(session, &light) == RT_OK;
    for (int first = 0; is_made && first < MANY; first += piece) {
        rt_spheres spheres = many_from(first, MANY - first < piece ? MANY - first : piece);
        is_made = rt_add_spheres(session, &spheres, NULL) == RT_OK;
    }
    if (!is_made || rt_render(session, threads)) {
        printf("# spheres in pieces of %d are not drawn\n", piece);
    }
    return session;
}

static void check_many(Random *random)
{
    for (int i = 0; i < 4; i++) {
        bool has_pairs = i & 1, has_points = i & 2;
        many_make(random, has_pairs, has_points);
        rt_session *one = many_draw(MANY, 1), *three = many_draw(MANY, 3), *pieces = many_draw(PIECE, 2);
        tap_ok(pictures_equal(one, three) && pictures_equal(one, pieces),
               "many spheres%s%s: on one thread, on three, and in pieces", has_pairs ? ", some alike in turn" : "",
               has_points ? ", some of no size" : "");
        rt_session_free(one);
        rt_session_free(three);
        rt_session_free(pieces);
    }
}

// Of each array the first fault is told, and nothing is taken.
static void check_many_faults(Random *random)
{
    Told told;
    many_make(random, false, false);
    rt_session *session = session_open(&told);
    rt_camera camera = {.location = {1, 2, -9}, .angle = 40};
    rt_light light = {.position = {5, 9, -5}, .color = {1, 1, 1}};
    rt_spheres all = many_from(0, MANY);
    (void)rt_begin_scene(session);
    (void)rt_set_warning(session, "W0211");
    double kept = many_centers[50000][2];
    float color = many_colors[40000][0];
    many_centers[50000][2] = (double)INFINITY;
    many_radii[65000] = -0.5;
    many_colors[40000][0] = NAN;
    tap_ok(rt_add_spheres(session, &all, NULL) == RT_FAULT_SCENE &&
               says(&told, "spheres[50000]: error[E0460]: number 2 of the center must be finite, not inf\n"
                           "spheres[65000]: error[E0460]: the radius must be 0 or more, and finite, not -0.5\n"
                           "spheres[40000]: error[E0460]: number 0 of the color must be finite, not nan\n"),
           "faults in three arrays of many");
    many_centers[50000][2] = kept;
    many_radii[65000] = 0.02;
    many_colors[40000][0] = color;
    many_colors[60000][0] = many_colors[60000][1] = 0.0F;
    many_colors[60000][2] = 200.0F;
    tap_ok(rt_set_camera(session, &camera) == RT_OK && rt_add_light(session, &light) == RT_OK &&
               rt_add_spheres(session, &all, NULL) == RT_OK && strstr(told.texts, "spheres[60000]: warning[W0211]"),
           "a colour like bytes among many");
    rt_session *after = many_draw(MANY, 2);
    tap_ok(rt_render(session, 2) == RT_OK && pictures_equal(session, after),
           "after faults many are drawn as in a new scene");
    rt_session_free(session);
    rt_session_free(after);
}

static void call_look(rt_session *session, Random *random)
{
    static const double numbers[] = {0, 0.5, 1, 4, -1, 17, (double)NAN, (double)INFINITY};
    double own[6], color[3];
    for (int i = 0; i < 6; i++) {
        unsigned choice = random_below(random, 32);
        own[i] = numbers[choice < 24 ? choice % 4 : choice % 8];
    }
    memcpy(color, own, sizeof color);
    const char *text;
    static float plane[16 * 12];
    rt_depth_cue cue = {.strength = own[3], .has_color = (int)random_below(random, 2), .color = {own[0], own[1], own[2]},
                        .near = own[4], .far = own[5]};
    int left = (int)random_below(random, 16), top = 0, width = 0, height = 0;
    top = (int)random_below(random, 12);
    width = 1 + (int)random_below(random, 8);
    height = 1 + (int)random_below(random, 8);
    switch (random_below(random, 7)) {
    case 0: (void)rt_set_sky_light(session, color); break;
    case 1: (void)rt_set_outline(session, own[3], color); break;
    case 2: (void)rt_set_depth_cue(session, &cue); break;
    case 3: (void)rt_set_planes(session, random_below(random, 2) ? RT_PLANE_DEPTH | RT_PLANE_OBJECT : 0); break;
    case 4: (void)rt_get_plane(session, RT_PLANE_DEPTH, plane, sizeof plane); break;
    case 5: (void)rt_set_crop(session, left, top, width, height); break;
    default: (void)rt_trace_pixel(session, left, top, &text); break;
    }
}

static void call_one(rt_session *session, Random *random, Numbers *n)
{
    static const char *const texts[] = {"sphere { 0, 1 }", "#declare A = 1;", "light_source { 9, 1 }", "sphere {",
                                        "plane { y, -2 pigment { checker rgb 1, rgb 0 } }"};
    bool may_fail = random_below(random, 8) == 0;
    const char *text = texts[random_below(random, may_fail ? 5 : 3)];
    static uint8_t bytes[16 * 12 * 3];
    const unsigned char *png;
    size_t size;
    rt_output output = {0};
    rt_spheres spheres = {.count = random_below(random, 4),
                          .centers = {n->centers, RT_FLOAT64, sizeof n->centers[0], sizeof(double)},
                          .radii = {n->radii, RT_FLOAT64, sizeof(double), 0},
                          .look = {{n->colors, RT_FLOAT64, sizeof n->colors[0], sizeof(double)}, 3, NULL}};
    spheres.radii.data = random_below(random, 2) ? n->radii : NULL;
    spheres.look.color_numbers = 2 + (int)random_below(random, 5);
    unsigned a = random_below(random, 3), b = 0;
    b = random_below(random, 3);
    rt_sampling sampling = {.samples = random_below(random, 3)};
    double box[3];
    int width, height;
    switch (random_below(random, 23)) {
    case 0: (void)rt_begin_scene(session); break;
    case 1: (void)rt_load_text(session, "part", text, strlen(text)); break;
    case 2: (void)add_view(session, n); break;
    case 3: (void)add_shapes(session, random, n, NULL); break;
    case 4: (void)rt_add_spheres(session, &spheres, NULL); break;
    case 5:
    case 6: (void)rt_update_spheres(session, a, b, &spheres); break;
    case 7:
    case 8: (void)rt_render(session, (int)a); break;
    case 9: (void)rt_get_pixels(session, &output, bytes, sizeof bytes); break;
    case 10: (void)rt_get_png(session, &output, &png, &size); break;
    case 11: (void)rt_set_size(session, 16, 12 - 4 * (int)random_below(random, 2)); break;
    case 12: (void)rt_clear_lights(session); break;
    case 13: (void)rt_get_box(session, box, n->background); break;
    case 14: rt_set_alpha(session, (int)random_below(random, 2)); break;
    case 15: (void)rt_set_sampling(session, &sampling); break;
    case 16: (void)rt_set_limit(session, RT_LIMIT_OBJECTS, 1 + random_below(random, 200)); break;
    case 17:
    case 18:
    case 19:
    case 20: call_look(session, random); break;
    case 21: rt_free_pixels(rt_take_pixels(session, &width, &height)); break;
    default:
        random_below(random, 20) ? rt_resume(session) : rt_discard_scene(session);
        break;
    }
}

// Under a sanitizer nothing else needs to be looked at. RTLANG_ORDERS: how many.
static void check_orders(Random *random)
{
    const char *wanted = getenv("RTLANG_ORDERS");
    int orders = wanted ? atoi(wanted) : 300;
    for (int i = 0; i < orders; i++) {
        Numbers n;
        rt_session *session = session_open(NULL);
        numbers_make(&n, random);
        n.spheres %= 6;
        (void)rt_set_size(session, 16, 12);
        if (random_below(random, 4)) {
            (void)rt_begin_scene(session);
        }
        for (unsigned calls = 1 + random_below(random, 20); calls > 0; calls--) {
            call_one(session, random, &n);
        }
        rt_session_free(session);
    }
    tap_ok(true, "%d orders of calls", orders);
}

int main(int argc, char **argv)
{
    static char text[TEXT_BYTES];
    uint64_t seed = random_seed(argc > 1 ? argv[1] : NULL);
    Random random = {seed};
    check_equal_to_text(&random, text);
    check_cameras_apart(0x1p40);
    check_cameras_apart(0.0);
    check_faults();
    check_places();
    check_pixels();
    check_many(&random);
    check_many_faults(&random);
    check_orders(&random);
    return tap_done();
}
