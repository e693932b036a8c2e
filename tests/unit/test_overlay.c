// Outlines and depth cue through the public interface: what lines cover beside closed forms, where there are none, and
// that nothing depends on threads and parts of the picture.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/attributes.h"
#include "rtlang/rtlang.h"
#include "unit/tap.h"

enum { SIDE = 80, NUMBERS = 3 * SIDE * SIDE };

typedef struct Drawing {
    const char *scene;
    double width;
    rt_depth_cue cue;
    int threads, crop[4];
    bool has_alpha, is_last;
} Drawing;

static const double line_color[3] = {0, 0, 0};

static rt_session *draw(const Drawing *drawing)
{
    rt_session *session = rt_session_new(NULL);
    bool is_fine = session && rt_set_outline(session, drawing->width, line_color) == RT_OK &&
                   rt_set_depth_cue(session, &drawing->cue) == RT_OK && rt_set_size(session, SIDE, SIDE) == RT_OK &&
                   rt_load_text(session, "scene", drawing->scene, strlen(drawing->scene)) == RT_OK;
    const int *crop = drawing->crop;
    is_fine = is_fine && (crop[2] == 0 || rt_set_crop(session, crop[0], crop[1], crop[2], crop[3]) == RT_OK);
    if (is_fine && drawing->is_last) {
        rt_discard_scene(session);
    }
    if (is_fine) {
        rt_set_alpha(session, drawing->has_alpha);
    }
    if (!is_fine || rt_render(session, drawing->threads ? drawing->threads : 2) != RT_OK) {
        printf("# cannot draw\n%s\n", drawing->scene);
        abort();
    }
    return session;
}

static void draw_into(const Drawing *drawing, float *pixels)
{
    int width, height;
    rt_session *session = draw(drawing);
    memcpy(pixels, rt_pixels(session, &width, &height), NUMBERS * sizeof *pixels);
    rt_session_free(session);
}

// Everything is white; a picture is so many units wide as it has pixels.
#define BEGIN                                                                                                          \
    "#version 3.7; global_settings { assumed_gamma 1 } background { rgb 1 } "                                          \
    "#default { finish { ambient 0 diffuse 0 emission 1 } pigment { rgb 1 } } "                                        \
    "camera { orthographic location -100*z right 80*x up 80*y look_at 0 } "

// ---- lines

// How many pixels lines cover of a white picture.
static double covered(const Drawing *drawing)
{
    float pixels[NUMBERS];
    double sum = 0.0;
    draw_into(drawing, pixels);
    for (int i = 0; i < NUMBERS; i += 3) {
        sum += 1.0 - (double)pixels[i];
    }
    return sum;
}

static void check_covered(const char *name, const char *scene, double width, double wanted)
{
    double found = covered(&(Drawing){.scene = scene, .width = width});
    tap_ok(fabs(found - wanted) <= 0.05 * wanted, "%s, %.3g wide: %.1f pixels, wanted %.1f", name, width, found,
           wanted);
}

static void test_lines(void)
{
    const double turn = 6.283185307179586;
    check_covered("around a sphere", BEGIN "sphere { <0.3, 0.1, 0>, 25 }", 1.5, turn * 25 * 1.5);
    check_covered("around a sphere", BEGIN "sphere { <0.3, 0.1, 0>, 25 }", 16.0, turn * 25 * 16);
    check_covered("around a sphere before a plane that is alike", BEGIN "sphere { 0, 25 } plane { -z, -50 }", 2.0,
                  turn * 25 * 2);
    check_covered("where spheres cut each other", BEGIN "sphere { -10*x, 20 } sphere { 10*x, 20 }", 2.0,
                  2.0 * (turn * 20 * 4.0 / 3.0 + sqrt(1200.0)));
    check_covered("a mesh",
                  BEGIN "triangle { <-20, -20, 0>, <20, -20, 0>, <20, 20, 1> } "
                        "triangle { <-20, -20, 0>, <20, 20, 1>, <-20, 20, 1> pigment { rgb 1 } }",
                  2.0, 160 * 2);
    check_covered("a smooth triangle",
                  BEGIN "smooth_triangle { <-20, -20, 0>, -x-z, <20, -20, 0>, x-z, <20, 20, 0>, y-z }", 2.0,
                  (80 + sqrt(3200.0)) * 2);
    check_covered("a rod of two halves", BEGIN "cylinder { -20*x, 0, 5 open } cylinder { 0, 20*x, 5 open }", 2.0,
                  100 * 2);
    check_covered("an object before itself", BEGIN "union { box { <-20, -20, 0>, <20, 20, 1> } sphere { -30*z, 10 } }",
                  2.0, (160 + turn * 10) * 2);
    check_covered("edges of one object", BEGIN "box { -10, 10 rotate <35.26439, 45, 0> }", 2.0,
                  6 * 20 * sqrt(2.0 / 3.0) * 2);
    tap_ok(covered(&(Drawing){.scene = BEGIN "plane { -z, 0 }", .width = 3.0}) == 0.0,
           "nothing ends, so there is no line");
}

// A limb before a plane that goes to the horizon is drawn all around.
static void test_limb(void)
{
    static const char scene[] =
        "#version 3.7; global_settings { assumed_gamma 1 } background { rgb 1 } #default { finish { ambient 0 diffuse "
        "0 "
        "emission 1 } pigment { rgb 1 } } camera { location <0, 1, -10> right x up y look_at <0, 1, 0> angle 40 } "
        "plane { y, 0 } sphere { y, 0.9 }";
    float pixels[NUMBERS];
    int gaps = 0;
    draw_into(&(Drawing){.scene = scene, .width = 2.0}, pixels);
    double radius = SIDE / 2.0 / tan(20.0 * 0.017453292519943295) * tan(asin(0.09));
    for (int i = 0; i < 360; i++) {
        double angle = i * 0.017453292519943295;
        int x = (int)floor(SIDE / 2.0 + radius * cos(angle)), y = (int)floor(SIDE / 2.0 + radius * sin(angle));
        gaps += pixels[3 * (y * SIDE + x)] > 0.6F;
    }
    tap_ok(gaps == 0, "a limb before a plane that continues behind it: %d of 360 places without a line", gaps);
}

#define CROWD                                                                                                          \
    BEGIN "#declare R = seed(2); #for (I, 1, 60) sphere { <rand(R) - 0.5, rand(R) - 0.5, rand(R)>*70, 8 "              \
          "pigment { rgbt <rand(R), rand(R), rand(R), (I < 10 ? 0.5 : 0)> } } #end cylinder { <-30, -30, 0>, <30, "    \
          "30, 9>, 4 } "

static void test_same(void)
{
    static float whole[NUMBERS], other[NUMBERS];
    Drawing drawing = {.scene = CROWD, .width = 2.5, .cue = {.strength = 0.7}, .threads = 1};
    int differ = 0;
    draw_into(&drawing, whole);
    drawing.threads = 3;
    draw_into(&drawing, other);
    tap_ok(memcmp(whole, other, sizeof whole) == 0, "one thread and three");
    drawing.is_last = true;
    draw_into(&drawing, other);
    tap_ok(memcmp(whole, other, sizeof whole) == 0, "a scene that is given up for its picture");
    for (int i = 0; i < 12; i++) {
        int width, height, left = 5 * i, top = 47 - 4 * i, size = 20 + i % 3;
        memcpy(drawing.crop, (int[]){left, top, size, size}, sizeof drawing.crop);
        rt_session *part = draw(&drawing);
        const float *pixels = rt_pixels(part, &width, &height);
        for (int y = 0; y < height; y++) {
            differ += memcmp(&pixels[3 * y * width], &whole[3 * ((y + top) * SIDE + left)],
                             3 * sizeof(float) * (size_t)width) != 0;
        }
        rt_session_free(part);
    }
    tap_ok(differ == 0, "parts are those of the whole: %d rows are not", differ);
}

static void test_alpha(void)
{
    static const char scene[] = "#version 3.7; global_settings { assumed_gamma 1 } background { rgbt 1 } "
                                "camera { orthographic location -100*z right 80*x up 80*y look_at 0 } "
                                "sphere { 0, 25 finish { ambient 0 diffuse 0 emission 1 } pigment { rgb 1 } }";
    int width, height, wrong = 0;
    double seen = 0.0, dark = 0.0;
    rt_session *session = draw(&(Drawing){.scene = scene, .width = 4.0, .has_alpha = true});
    const float *clear = rt_transparency(session), *pixels = rt_pixels(session, &width, &height);
    for (int i = 0; i < SIDE * SIDE; i++) {
        seen += 1.0 - (double)clear[i];
        dark += 1.0 - (double)clear[i] - (double)pixels[3 * i];
        wrong += pixels[3 * i] > 1.0F - clear[i] + 1e-6F;
    }
    tap_ok(wrong == 0 && fabs(seen - 3.14159 * 27 * 27) < 20 && fabs(dark - 6.28319 * 25 * 4) < 20,
           "lines stand before what is clear: %.0f pixels covered, %.0f by the line", seen, dark);
    rt_session_free(session);
}

// ---- the depth cue

static float middle_of(const Drawing *drawing, int x)
{
    float pixels[NUMBERS];
    draw_into(drawing, pixels);
    return pixels[3 * (SIDE / 2 * SIDE + x)];
}

static void test_cue(void)
{
    static const char scene[] = BEGIN "background { rgb 0.25 } sphere { <-25, 0, -60>, 10 } sphere { <0, 0, 0>, 10 } "
                                      "sphere { <25, 0, 60>, 10 }";
    Drawing cue = {.scene = scene, .cue = {.strength = 0.8}};
    // From 30, the front of the first, to 170, the back of the last; to the background's 0.25.
    const double wanted[] = {1.0, 1.0 - 0.75 * 0.8 * 60 / 140, 1.0 - 0.75 * 0.8 * 120 / 140};
    int wrong = 0;
    for (int i = 0; i < 3; i++) {
        double found = (double)middle_of(&cue, 15 + 25 * i);
        wrong += fabs(found - wanted[i]) > 2e-3;
        printf("# %.5f, wanted %.5f\n", found, wanted[i]);
    }
    tap_ok(wrong == 0 && middle_of(&cue, 28) == 0.25F, "as far as shapes reach, to the background's colour");
    cue.cue = (rt_depth_cue){.strength = 1.0, .has_color = 1, .color = {0.5, 0, 0}, .near = 40, .far = 90};
    wrong = 0;
    const double given[] = {1.0, 0.5, 0.5};
    for (int i = 0; i < 3; i++) {
        wrong += fabs((double)middle_of(&cue, 15 + 25 * i) - given[i]) > 1e-3;
    }
    tap_ok(wrong == 0, "between depths that are given, to a colour that is");
}

static void test_refused(void)
{
    const double black[] = {0, 0, 0}, wrong[] = {0, -1, 0}, nan[] = {0, 0, (double)NAN};
    rt_session *session = rt_session_new(NULL);
    int refused = rt_set_outline(session, -1, black) == RT_FAULT_USAGE;
    refused += rt_set_outline(session, 16.5, black) == RT_FAULT_USAGE;
    refused += rt_set_outline(session, (double)NAN, black) == RT_FAULT_USAGE;
    refused += rt_set_outline(session, 1, wrong) == RT_FAULT_USAGE;
    refused += rt_set_outline(session, 1, nan) == RT_FAULT_USAGE;
    const rt_depth_cue cues[] = {{.strength = -0.1},
                                 {.strength = 1.1},
                                 {.strength = (double)NAN},
                                 {.near = 2, .far = 1},
                                 {.near = -1, .far = 1},
                                 {.near = 1, .far = (double)INFINITY},
                                 {.strength = 1, .has_color = 1, .color = {-1, 0, 0}}};
    for (size_t i = 0; i < RT_COUNT_OF(cues); i++) {
        refused += rt_set_depth_cue(session, &cues[i]) == RT_FAULT_USAGE;
    }
    tap_ok(refused == 12, "%d of 12 wrong numbers are refused", refused);
    rt_session_free(session);
}

int main(void)
{
    test_lines();
    test_limb();
    test_same();
    test_alpha();
    test_cue();
    test_refused();
    return tap_done();
}
