// The life of a ray ends in the colour of its pixel: all examples and all scenes that are compared with POV-Ray.
//
// The kernels leave out what a scene has not, --trace-pixel runs with everything on; both must give the same bits. What
// is printed of a sphere is checked against the scene that it was made for.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rtlang/rtlang.h"
#include "unit/scenes.h"
#include "unit/tap.h"

enum { WIDTH = 16, HEIGHT = 12 };

static bool is_pixel(const char *text, const float *pixel)
{
    const char *linear = strstr(text, "\"linear\": [");
    double rgb[3];
    return linear && sscanf(linear, "\"linear\": [%lf, %lf, %lf]", &rgb[0], &rgb[1], &rgb[2]) == 3 &&
           (float)rgb[0] == pixel[0] && (float)rgb[1] == pixel[1] && (float)rgb[2] == pixel[2];
}

// *step: one pixel of so many is looked at.
static void check_scene(void *step, const char *folder, const char *path, size_t number)
{
    (void)number;
    int width, height, wrong = 0, first = 0, tried = 0;
    rt_session *session = rt_session_new(NULL);
    rt_set_format(session, RT_FORMAT_JSON);
    bool is_ready = rt_add_include_path(session, folder) == RT_OK && rt_set_size(session, WIDTH, HEIGHT) == RT_OK &&
                    rt_load_file(session, path) == RT_OK && rt_render(session, 1) == RT_OK;
    const float *pixels = is_ready ? rt_pixels(session, &width, &height) : NULL;
    for (int i = 0; pixels && i < WIDTH * HEIGHT; i += *(const int *)step, tried++) {
        const char *text;
        if (rt_trace_pixel(session, i % WIDTH, i / WIDTH, &text) != RT_OK || !is_pixel(text, pixels + 3 * i)) {
            first = wrong++ ? first : i;
        }
    }
    tap_ok(pixels && wrong == 0, "%s: %d of %d pixels differ, the first at %d,%d", path, wrong, tried, first % WIDTH,
           first / WIDTH);
    rt_session_free(session);
}

static bool has(const char *text, const char *part)
{
    if (strstr(text, part)) {
        return true;
    }
    printf("# not there: %s\n", part);
    return false;
}

// By hand: e = <0, 0, -5>, d = z, radius 2, so a = 1, b = -10, c = 21, h = 16, t1 = 3, t2 = 7.
static void check_quadratic(void)
{
    static const char scene[] = "camera { location -5 * z look_at 0 }\n"
                                "light_source { -9 * z, 1 }\n"
                                "sphere { 0, 2 finish { reflection 0.5 } }\n"
                                "sphere { 9 * x, 2 }\n"
                                "sphere { -9 * z, 1 }\n"
                                "sphere { -5 * z, 0.5 no_image }\n"
                                "plane { -z, -20 }\n";
    const char *text = "";
    rt_session *session = rt_session_new(NULL);
    bool is_loaded =
        rt_set_size(session, 3, 3) == RT_OK && rt_load_text(session, "q.scn", scene, sizeof scene - 1) == RT_OK;
    tap_ok(is_loaded && rt_trace_pixel(session, 1, 1, &text) == RT_OK &&
               has(text, "e = <0, 0, -5>, through the screen at <0, 0, -4>") && has(text, "(q.scn:3:1)") &&
               has(text, "a = d·d = 1, b = 2 d·(e - centre) = -10, c = (e - centre)·(e - centre) - radius² = 21") &&
               has(text, "h = b² - 4 a c = 16: h > 0") &&
               has(text, "t1 = (-b - √h) / 2a = 3, t2 = (-b + √h) / 2a = 7") && has(text, "used: t1") &&
               has(text, "h < 0, the line does not meet it") && has(text, "both points lie behind") &&
               has(text, "leaves it; a sphere is convex") && has(text, "ray 2: mirrored where ray 1 hits, level 2") &&
               has(text, "light 1 at <0, 0, -9>: distance 7, N·L = 1"),
           "the quadratic, its cases and roots, the light and the mirrored ray as text");
    tap_ok(rt_trace_pixel(session, 3, 0, &text) == RT_FAULT_USAGE &&
               rt_trace_pixel(session, 0, -1, &text) == RT_FAULT_USAGE,
           "a pixel that is not in the picture");
    rt_session_free(session);
}

// A line that touches the sphere: h = 0 in plain doubles.
static void check_touch(void)
{
    static const char scene[] = "camera { orthographic location <1, 0, -5> direction z right x up y }\n"
                                "light_source { -9 * z, 1 } sphere { 0, 1 pigment { rgbt 1 } }\n";
    const char *text = "";
    rt_session *session = rt_session_new(NULL);
    rt_set_format(session, RT_FORMAT_JSON);
    bool is_loaded =
        rt_set_size(session, 1, 1) == RT_OK && rt_load_text(session, "t.scn", scene, sizeof scene - 1) == RT_OK;
    tap_ok(is_loaded && rt_trace_pixel(session, 0, 0, &text) == RT_OK && has(text, "\"case\": \"h = 0\"") &&
               has(text, "\"used\": \"near\"") && has(text, "\"doubtful\": true") && has(text, "\"kind\": \"through\""),
           "a line that touches a sphere, as JSON");
    rt_session_free(session);
}

// The middle pixel of a scene whose camera looks along z from <0, 0, -5>, as text; NULL when it cannot be followed.
static const char *follow(rt_session *session, const char *objects)
{
    static char scene[1024];
    const char *text;
    int length = snprintf(scene, sizeof scene, "camera { location -5 * z look_at 0 }\n%s\n", objects);
    bool is_told = rt_set_size(session, 3, 3) == RT_OK &&
                   rt_load_text(session, "f.scn", scene, (size_t)length) == RT_OK &&
                   rt_trace_pixel(session, 1, 1, &text) == RT_OK;
    return is_told ? text : NULL;
}

// By hand: e and d in z are -5 / 2 and 1 / 2, so a = 1/4, b = -5/2, c = 21/4, h = 1, t1 = 3, t2 = 7.
static void check_stretched(void)
{
    rt_session *session = rt_session_new(NULL);
    const char *text = follow(session, "light_source { -9 * z, 1 } sphere { 0, 1 scale <1, 1, 2> }\n"
                                       "difference { sphere { <0, 0, 9>, 4 } box { <-9, -9, 0>, <9, 9, 6> } }");
    tap_ok(text && has(text, "stretched sphere (f.scn:2:28)") &&
               has(text, "e = <0, 0, -2.5>, d = <0, 0, 0.5>\n    a = d·d = 0.25, b = 2 d·(e - centre) = -2.5, c = "
                         "(e - centre)·(e - centre) - radius² = 5.25") &&
               has(text, "h = b² - 4 a c = 1: h > 0") && has(text, "= 3, t2 = (-b + √h) / 2a = 7") &&
               has(text, "sphere (f.scn:3:14): centre <0, 0, 9>, radius 4") &&
               has(text, "used: both: the sphere is cut") &&
               has(text, "hit: stretched sphere (f.scn:2:28) from the outside at t = 3"),
           "a stretched sphere in its own space, and one that is cut");
    rt_session_free(session);
}

// The light stands behind the camera, so N·L = 1, and the mirrored ray goes back to it: phong is at its greatest.
static void check_terms(void)
{
    rt_session *session = rt_session_new(NULL);
    const char *text =
        follow(session, "light_source { -9 * z, 0.5 }\n"
                        "light_source { -9 * z, 1 spotlight point_at <9, 0, -9> radius 5 falloff 10 }\n"
                        "light_source { -9 * z, 1 area_light x, y, 3, 3 }\n"
                        "sphere { 0, 2 pigment { rgb 1 } finish { ambient 0.125 diffuse 0.5 phong 0.25 } }\n"
                        "fog { distance 10 rgb <0, 0, 1> }");
    tap_ok(
        text && has(text, "ambient and emission: rgb <0.125, 0.125, 0.125>") &&
            has(text,
                "N·L = 1, sends rgb <0.5, 0.5, 0.5>, visible rgb <1, 1, 1>\n"
                "      diffuse rgb <0.25, 0.25, 0.25>, highlights rgb <0.125, 0.125, 0.125>, adds rgb <0.375, 0.375, "
                "0.375>") &&
            has(text, "light 2 at <0, 0, -9>: distance 7, N·L = 1, sends rgb <0, 0, 0>") &&
            has(text, "light 3 at <0, 0, -9>: distance 7, N·L = 1, sends rgb <1, 1, 1>, visible rgb <1, 1, 1>") &&
            has(text, "fog on its way adds rgb <0, 0, 0.25"),
        "each light's colour, shadow, diffuse and highlights; a spotlight that shines elsewhere; fog");
    rt_session_free(session);
    session = rt_session_new(NULL);
    text = follow(session, "light_source { -9 * z, 0.5 }\n"
                           "sphere { 0, 2 texture { pigment { rgb <1, 0, 0> } normal { bumps 0.8 scale 0.3 } }\n"
                           "texture { pigment { rgbt <0, 1, 0, 0.75> } } }");
    tap_ok(text && has(text, "pigment rgbft <0, 1, 0, 0, 0.75>") &&
               has(text, "pigment rgbft <1, 0, 0, 0, 0>, seen through") &&
               has(text, "its bumps turn the normal to N = <"),
           "layers, and what bumps make of the normal");
    rt_session_free(session);
}

// The middle ray meets one sphere of four, which mirrors it to the background.
static const char four[] = "light_source { -9 * z, 1 }\n"
                           "sphere { 9 * x, 2 } sphere { 7 * x, 2 } sphere { 8 * y, 1 }\n"
                           "sphere { 0.3 * y, 2 finish { reflection 0.5 } } background { rgb 1 / 3 }";

static void check_tree(void)
{
    rt_session *session = rt_session_new(NULL);
    const char *text = follow(session, four);
    const char *tree = text ? strstr(text, "pixel 1, 1\nthe tree of its 2 rays:\n  1 camera: sphere (f.scn:4:1) at t = 3.023, "
                                           "adds rgb <") : NULL;
    const char *child = tree ? strstr(tree, "\n    2 mirrored: the background, adds rgb <0.1667, 0.1667, 0.1667>\nray 1: camera\n")
                             : NULL;
    tap_ok(tree == text && child, "the tree of rays comes first, each below the one that it comes from");
    const char *end = text ? strstr(text, "\nray 2") : NULL, *nine = text ? strstr(text, "centre <9, 0, 0>") : NULL,
               *eight = text ? strstr(text, "centre <0, 8, 0>") : NULL;
    tap_ok(end && has(text, "sphere (f.scn:3:21): centre <7, 0, 0>") && !nine && (!eight || eight > end) &&
               has(text, "and 2 more spheres are missed\n"),
           "of the spheres that the line misses the nearest is told, and the others are counted");
    rt_session_free(session);
    session = rt_session_new(NULL);
    text = follow(session, "light_source { -9 * z, 1 } sphere { 0, 1 } background { rgb 1 }");
    tap_ok(text && !strstr(text, "tree") && !strstr(text, "missed"), "one ray has no tree, one sphere no others");
    rt_session_free(session);
}

// Every number of a text has so many digits at most.
static bool has_digits(const char *text, int most)
{
    const char *c = strstr(text, "\nray 1");
    for (; c && *c != '\0'; c++) {
        int digits = 0;
        bool is_leading = true;
        if ((*c < '0' || *c > '9') || (c[-1] >= 'a' && c[-1] <= 'z')) { // t1 is no number
            continue;
        }
        for (; (*c >= '0' && *c <= '9') || *c == '.'; c++) {
            is_leading = is_leading && (*c == '0' || *c == '.');
            digits += *c != '.' && !is_leading;
        }
        if (digits > most) {
            printf("# %d digits: %.40s\n", digits, c - digits);
            return false;
        }
        c += *c == 'e' ? 3 : 0;
        c--;
    }
    return c != NULL;
}

static void check_digits(void)
{
    rt_session *session = rt_session_new(NULL);
    tap_ok(rt_set_trace_form(session, RT_TRACE_LOG, 18) == RT_FAULT_USAGE &&
               rt_set_trace_form(session, RT_TRACE_LOG, -1) == RT_FAULT_USAGE &&
               rt_set_trace_form(session, RT_TRACE_LOG, 4) == RT_OK,
           "digits are 1 to 17, or all");
    const char *text = follow(session, four);
    tap_ok(text && has_digits(text, 4) && has(text, "t1 = (-b - √h) / 2a = 3.023, t2"), "no number has more digits");
    rt_session_free(session);
    session = rt_session_new(NULL);
    text = follow(session, four);
    tap_ok(text && !has_digits(text, 12) && has(text, "2a = 3.0226"), "and all without that");
    rt_session_free(session);
}

// By hand: the plane is that of y and z, so the sphere at 0.3 y is cut through its middle; between e, at the left edge, and
// its far side, and 10 % beyond, lie 568 of 640 units.
static void check_drawing(void)
{
    rt_session *session = rt_session_new(NULL);
    rt_set_trace_form(session, RT_TRACE_SVG, 0);
    const char *text = follow(session, four);
    tap_ok(text && strncmp(text, "<svg class=\"rays\"", 17) == 0 && has(text, "</svg>\n") && has(text, "<title>") &&
               has(text, "class=\"body\"") && has(text, ">t1</text>") && has(text, ">t2</text>") && has(text, ">N</text>") &&
               has(text, "<line class=\"camera\" x1=\"36\"") && has(text, "<line class=\"mirrored\"") &&
               has(text, "<line class=\"light\"") && !strstr(text, "nan") && !strstr(text, "inf"),
           "the drawing has the ray, both roots, the normal, the mirrored ray and the light");
    double x, y, radius;
    const char *circle = text ? strstr(text, "<circle class=\"body\"") : NULL;
    bool is_read = circle && sscanf(circle, "<circle class=\"body\" cx=\"%lf\" cy=\"%lf\" r=\"%lf\"", &x, &y, &radius) == 3;
    tap_ok(is_read && fabs(x - 36.0 - 2.5 * radius) < 0.2 && radius > 50.0, "the sphere is cut through its middle, to scale");
    rt_session_free(session);
    const char *scenes[] = {"sphere { 50 * x, 1 }", "sphere { 0, 1 }"};
    for (int i = 0; i < 2; i++) {
        session = rt_session_new(NULL);
        rt_set_trace_form(session, RT_TRACE_SVG, 0);
        text = follow(session, scenes[i]);
        tap_ok(text && has(text, "<line class=\"camera\"") && !strstr(text, "nan") && !strstr(text, ">t1<") == (i == 0),
               i == 0 ? "a ray that meets nothing is drawn, too" : "and one that meets a sphere head on");
        rt_session_free(session);
    }
}

// A scene that nothing else is asked of gives the same picture, and is then gone.
static void check_spent(void)
{
    static const char scene[] = "camera { location -9 * z look_at 0 } light_source { <5, 9, -9>, 1 } plane { y, -3 }\n"
                                "#for (I, 0, 99) sphere { <mod(I, 10) - 5, I / 10 - 5, 0>, 0.6 pigment { rgb I / 99 } }"
                                "#end sphere { <0, 0, 400>, 200 }\n";
    rt_session *kept = rt_session_new(NULL), *spent = rt_session_new(NULL), *sessions[] = {kept, spent};
    const char *text;
    bool is_rendered = true;
    rt_discard_scene(spent);
    for (int i = 0; i < 2; i++) {
        is_rendered = is_rendered && rt_set_size(sessions[i], 40, 30) == RT_OK &&
                      rt_load_text(sessions[i], "s.scn", scene, sizeof scene - 1) == RT_OK &&
                      rt_render(sessions[i], 2) == RT_OK;
    }
    int width, height;
    size_t bytes = sizeof(float) * 40 * 30 * 3;
    tap_ok(is_rendered && memcmp(rt_pixels(kept, &width, &height), rt_pixels(spent, &width, &height), bytes) == 0,
           "a scene that is spent gives the same picture");
    rt_budget budget;
    tap_ok(rt_trace_pixel(kept, 1, 1, &text) == RT_OK && rt_trace_pixel(spent, 1, 1, &text) == RT_FAULT_USAGE &&
               rt_dump_scene(spent, &text) == RT_FAULT_USAGE && rt_get_budget(spent, &budget) == RT_FAULT_USAGE &&
               rt_explain_scene(spent, 1, &text) == RT_FAULT_USAGE && rt_render(spent, 1) == RT_FAULT_USAGE &&
               rt_load_text(spent, "s.scn", scene, sizeof scene - 1) == RT_FAULT_USAGE,
           "and nothing is asked of it later");
    rt_session_free(kept);
    rt_session_free(spent);
}

int main(void)
{
    int every = 1, one_in_five = 5;
    check_quadratic();
    check_touch();
    check_stretched();
    check_terms();
    check_tree();
    check_digits();
    check_drawing();
    check_spent();
    scenes_try("examples/*.scn", check_scene, &every);
    scenes_try("tests/povray/*.scn", check_scene, &one_in_five);
    return tap_done();
}
