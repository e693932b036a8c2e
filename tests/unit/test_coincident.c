// Surfaces of different shapes that coincide: the one that was declared first is seen and the other might as well not
// be there, whatever the two shapes are and however each of them is rounded.
//
// Shapes with a surface in common are put elsewhere by a random turn and move, two at a time and in both orders. The
// picture of the first and the second, with lights and mirrors, has to be the first one's alone, bit for bit. Nor does
// what a light stands on throw a shadow above it. A mesh that has its faces on those of other shapes is as a box there.
//
// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/attributes.h"
#include "rtlang/rtlang.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { WIDTH = 24, HEIGHT = 18, VALUES = 3 * WIDTH * HEIGHT, PLACES = 3, SHAPES_MOST = 16, PLACE_MOST = 192 };

// Shapes as text that ends before their last brace, so that a texture and transforms can follow.
typedef struct Family {
    const char *name, *camera;
    const char *look; // of the first shape
    const char *shapes[SHAPES_MOST];
    size_t firsts; // so many of them may come first; 0: all
} Family;

#define OPAQUE "pigment { rgb <0.9, 0.5, 0.2> } finish { reflection 0.3 phong 0.5 }"
#define GLASS  "pigment { rgbt <1, 0.8, 0.6, 0.7> } finish { reflection 0.1 } interior { ior 1.3 }"

#define FLAT_SHAPES                                                                                                    \
    {                                                                                                                  \
        "plane { y, 0", "box { <-50, -1, -50>, <50, 0, 50>", "box { <-0.5, -3, -0.4>, <0.5, 0, 0.4> scale <100, 0.3, 100>", \
            "disc { 0, y, 60", "cylinder { -y, 0, 60", "cone { -2 * y, 80, 0, 60",                                     \
            "triangle { <-200, 0, -200>, <200, 0, -200>, <0, 0, 300>",                                                 \
            "difference { box { <-50, -1, -50>, <50, 1, 50> } box { <-51, 0, -51>, <51, 2, 51> }",                     \
            "intersection { box { -40, 40 } plane { y, 0 }",                                                           \
            "merge { box { <-50, -1, -50>, <0, 0, 50> } box { <0, -1, -50>, <50, 0, 50> }",                            \
            "box { <-50, -1, -50>, <50, 0, 50> clipped_by { sphere { 0, 70 } }",                                       \
            "disc { 0, y, 60 clipped_by { box { -55, 55 } }", "plane { -y, 0 inverse"                                  \
    }

static const Family families[] = {
    {"flat, from above", "location <0.1, 3, -0.2> look_at 0 angle 12", OPAQUE, FLAT_SHAPES, 0},
    {"flat, grazing", "location <0.1, 0.05, -3> look_at 0 angle 1", OPAQUE, FLAT_SHAPES, 0},
    {"round",
     "location <0.3, 5, -0.7> look_at <0, 1, 0> angle 8",
     OPAQUE,
     {"sphere { 0, 1", "sphere { 0, 2 scale 0.5", "sphere { 0, 1 no_shadow",
      "sphere { 0, 1 clipped_by { plane { -y, 0 } }", "intersection { sphere { 0, 1 } box { <-2, 0, -2>, 2 }",
      "difference { sphere { 0, 1 } box { -2, <2, -0.2, 2> }", "merge { sphere { 0, 1 } sphere { -0.8 * y, 0.5 }"},
     0},
    {"stretched",
     "location <0.3, 5, -6> look_at <0, 1, 0> angle 8",
     OPAQUE,
     {"sphere { 0, 1 scale <2, 2, 3>", "sphere { 0, 1 rotate 37 * z scale <2, 2, 3>",
      "sphere { 0, 0.5 scale <4, 4, 6> no_shadow",
      "sphere { 0, 1 rotate 71 * z scale <2, 2, 3> clipped_by { box { <-9, 0, -9>, 9 } }"},
     0},
    {"round, glass",
     "location <0.3, 5, -6> look_at 0 angle 30",
     GLASS,
     {"sphere { 0, 1", "sphere { 0, 2 scale 0.5", "sphere { 0, 1 no_shadow",
      "sphere { 0, 1 clipped_by { plane { -y, 0 } }"},
     2},
    {"stretched, glass",
     "location <0.3, 5, -6> look_at 0 angle 60",
     GLASS,
     {"sphere { 0, 1 scale <2, 2, 3>", "sphere { 0, 1 rotate 37 * z scale <2, 2, 3>",
      "sphere { 0, 0.5 scale <4, 4, 6> no_shadow",
      "sphere { 0, 1 rotate 71 * z scale <2, 2, 3> clipped_by { box { <-9, 0, -9>, 9 } }"},
     2},
};

static bool draw_text(const char *text, int length, float *values)
{
    int width, height;
    rt_session *session = rt_session_new(NULL);
    rt_set_format(session, RT_FORMAT_JSON);
    bool is_drawn = rt_set_size(session, WIDTH, HEIGHT) == RT_OK &&
                    rt_load_text(session, "coincident", text, (size_t)length) == RT_OK &&
                    rt_render(session, 1) == RT_OK;
    if (is_drawn) {
        memcpy(values, rt_pixels(session, &width, &height), VALUES * sizeof *values);
    } else {
        printf("# not drawn: %s\n", text);
    }
    rt_session_free(session);
    return is_drawn;
}

static bool draw(const Family *family, const char *place, const char *first, const char *second, float *values)
{
    static const char head[] = "global_settings { assumed_gamma 1 } background { rgb <0.2, 0.3, 0.5> }";
    static const char other[] = "pigment { rgb <0.1, 0.9, 0.2> } finish { ambient 1 }";
    char text[4096];
    int length =
        snprintf(text, sizeof text,
                 "%s\ncamera { %s %s }\nlight_source { <3, 5, -2>, 0.8 %s }\nlight_source { <-9, 0.4, 2>, 0.5 %s }\n"
                 "%s %s %s }\n",
                 head, family->camera, place, place, place, first, family->look, place);
    if (second) {
        length += snprintf(text + length, sizeof text - (size_t)length, "%s %s %s }\n", second, other, place);
    }
    return draw_text(text, length, values);
}

static int pixels_off(const float *a, const float *b)
{
    int off = 0;
    for (int i = 0; i < VALUES; i += 3) {
        off += memcmp(a + i, b + i, 3 * sizeof *a) != 0;
    }
    return off;
}

static void test_first(const Family *family, const char *first, const char places[PLACES][PLACE_MOST])
{
    static float alone[VALUES], both[VALUES];
    int off = 0, pairs = 0;
    const char *worst = first;
    for (int place = 0; place < PLACES; place++) {
        bool is_drawn = draw(family, places[place], first, NULL, alone);
        for (size_t i = 0; is_drawn && i < SHAPES_MOST && family->shapes[i]; i++) {
            if (family->shapes[i] == first) {
                continue;
            }
            int here =
                draw(family, places[place], first, family->shapes[i], both) ? pixels_off(alone, both) : WIDTH * HEIGHT;
            worst = here > 0 ? family->shapes[i] : worst;
            off += here;
            pairs++;
        }
    }
    tap_ok(pairs >= 2 * PLACES && off == 0, "%s: %s }, %d of %d pixels beside %d others are off%s%s", family->name,
           first, off, pairs * WIDTH * HEIGHT, pairs, off > 0 ? ", as beside " : "", off > 0 ? worst : "");
}

// ---- a light on a surface

// All have <0, 0, 0> on them and nothing above it.
static const char *const below[] = {
    "plane { y, 0",
    "box { <-50, -1, -50>, <50, 0, 50>",
    "disc { 0, y, 60",
    "cylinder { -y, 0, 60",
    "cone { -2 * y, 80, 0, 60",
    "triangle { <-200, 0, -200>, <200, 0, -200>, <0, 0, 300>",
    "intersection { box { -40, 40 } plane { y, 0 }",
    "merge { box { <-50, -1, -50>, <0.1, 0, 50> } box { <0, -1, -50>, <50, 0, 50> }",
    "sphere { -y, 1 scale <2, 2, 3>",
    "cylinder { <-9, -1, 0>, <9, -1, 0>, 1",
};

// A ball and a light, with something below it.
static bool draw_lit(const char *place, const char *shape, const char *pigment, float *values)
{
    char text[2048];
    int length = snprintf(text, sizeof text,
                          "#version 3.7; global_settings { assumed_gamma 1 }\n"
                          "camera { location <0.3, 1, -9> look_at <0, 3, 0> angle 14 %s }\n"
                          "light_source { 0, rgb 1 %s }\n"
                          "sphere { <0.2, 3, 0.1>, 1 pigment { rgb 1 } finish { ambient 0 } %s }\n%s %s %s %s\n",
                          place, place, place, shape ? shape : "", shape ? pigment : "", shape ? place : "",
                          shape ? "}" : "");
    return draw_text(text, length, values);
}

// The light shines on the ball as if nothing were below.
static void test_lit(const char *shape, const char *pigment, const char places[PLACES][PLACE_MOST])
{
    static float alone[VALUES], both[VALUES];
    int off = 0;
    for (int place = 0; place < PLACES; place++) {
        off += draw_lit(places[place], NULL, pigment, alone) && draw_lit(places[place], shape, pigment, both)
                   ? pixels_off(alone, both)
                   : WIDTH * HEIGHT;
    }
    tap_ok(off == 0, "a light on %s %s }: %d of %d pixels are in its shadow", shape, pigment, off,
           PLACES * WIDTH * HEIGHT);
}

// ---- a mesh in the place of a box

#define CUBE_VERTICES "mesh2 { vertex_vectors { 8, 0, x, x + y, y, z, x + z, 1, y + z } "
#define CUBE_FACES                                                                                                     \
    " <0, 1, 2>, <0, 2, 3>, <4, 5, 6>, <4, 6, 7>, <0, 1, 5>, <0, 5, 4>, <3, 2, 6>, <3, 6, 7>,"                         \
    " <0, 3, 7>, <0, 7, 4>, <1, 2, 6>, <1, 6, 5>"
#define CUBE_INSIDE " inside_vector <0.3, 1, 0.2> }"
#define CUBE_THRICE CUBE_FACES "," CUBE_FACES "," CUBE_FACES

// Once, and with more faces in one place than a ray keeps of a mesh.
static const char *const cubes[] = {
    CUBE_VERTICES "face_indices { 12, " CUBE_FACES " }" CUBE_INSIDE,
    CUBE_VERTICES "face_indices { 108, " CUBE_THRICE "," CUBE_THRICE "," CUBE_THRICE " }" CUBE_INSIDE,
};

// With other shapes that have faces on those of the cube.
static bool draw_joined(const char *eye, const char *pattern, const char *cube, float *values)
{
    char text[4096], joined[3072];
    snprintf(joined, sizeof joined, pattern, cube);
    int length = snprintf(text, sizeof text,
                          "#version 3.7; global_settings { assumed_gamma 1 }\n"
                          "camera { location %s look_at <1, 0.5, 0.4> angle 40 } background { rgb <0.2, 0.3, 0.5> }\n"
                          "%s pigment { rgbt <1, 0.5, 0.2, 0.5> } finish { ambient 1 diffuse 0 } }\n",
                          eye, joined);
    return draw_text(text, length, values);
}

static void test_joined(const char *pattern, const char *cube)
{
    static const char *const eyes[] = {"<-3, 0.7, 0.45>", "<-2, 2.2, -2.7>", "<5, 1.1, 0.3>"};
    static float meshes[VALUES], boxes[VALUES];
    int off = 0;
    for (size_t i = 0; i < RT_COUNT_OF(eyes); i++) {
        off += draw_joined(eyes[i], pattern, cube, meshes) && draw_joined(eyes[i], pattern, "box { 0, 1 }", boxes)
                   ? pixels_off(meshes, boxes)
                   : WIDTH * HEIGHT;
    }
    tap_ok(off == 0, "a mesh as a box in `%s`: %d pixels are off", pattern, off);
}

int main(int argc, char **argv)
{
    Random random = {random_seed(argc > 1 ? argv[1] : NULL)};
    char places[PLACES][PLACE_MOST] = {"rotate 0 translate 0"};
    for (int i = 1; i < PLACES; i++) {
        Vec3 turn = random_vec3(&random, 0, 360), move = random_vec3(&random, -9, 9);
        snprintf(places[i], sizeof places[i], "rotate <%.17g, %.17g, %.17g> translate <%.17g, %.17g, %.17g>", turn.x,
                 turn.y, turn.z, move.x, move.y, move.z);
    }
    for (size_t i = 0; i < RT_COUNT_OF(families); i++) {
        const Family *family = &families[i];
        for (size_t k = 0; k < SHAPES_MOST && family->shapes[k] && (family->firsts == 0 || k < family->firsts); k++) {
            test_first(family, family->shapes[k], (const char(*)[PLACE_MOST])places);
        }
    }
    for (size_t i = 0; i < RT_COUNT_OF(below); i++) {
        test_lit(below[i], "pigment { rgb 1 }", (const char(*)[PLACE_MOST])places);
        test_lit(below[i], "pigment { rgbt 0.5 }", (const char(*)[PLACE_MOST])places);
    }
    test_joined("merge { %s box { <1, 0.1, -0.2>, <1.7, 1.3, 0.8> }", cubes[0]);
    test_joined("merge { box { <1, 0.1, -0.2>, <1.7, 1.3, 0.8> } %s", cubes[0]);
    test_joined("difference { box { <-0.5, -0.5, -0.5>, <1, 1.5, 1.5> } %s", cubes[0]);
    for (size_t i = 0; i < RT_COUNT_OF(cubes); i++) {
        test_joined("difference { %s box { <1, 0.1, -0.2>, <1.7, 1.3, 0.8> }", cubes[i]);
        test_joined("intersection { %s box { <0.5, 0.1, -0.2>, <1, 1.3, 0.8> }", cubes[i]);
    }
    return tap_done();
}
