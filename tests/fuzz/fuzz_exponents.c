// Scenes with lengths of any exponents, from 1e-310 to 1e300: each ends soon in a picture or a message, never in a signal,
// and in the same picture with every instruction set.
//
// Kinds of shapes, lights and cameras are mixed; in a scene exponents are all alike, of a few clusters, or of all that
// there are. Usage: fuzz_exponents [scenes]. With sanitizers (`configure --enable-sanitizers=address,undefined`) no
// float may lead outside of an array, or become an integer that it is too great for.
//
// SPDX-License-Identifier: MIT
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "rtlang/rtlang.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { WIDTH = 16, HEIGHT = 9, TEXT_MOST = 1 << 16, ITEMS_MOST = 40, CLUSTERS = 3, SECONDS_MOST = 300 };

static char text[TEXT_MOST];
static size_t length;

// Shows the scene that the program ended in.
static void on_signal(int number)
{
    (void)!write(STDOUT_FILENO, text, length);
    signal(number, SIG_DFL);
    raise(number);
}

// Which exponents a scene has.
typedef struct Exponents {
    int centre[CLUSTERS], width;
} Exponents;

static Exponents choose_exponents(Random *random)
{
    static const int widths[] = {1, 4, 15, 60, 400};
    Exponents e = {.width = widths[random_below(random, 5)]};
    int about = (int)random_below(random, 124) - 63; // where squares, and squares of squares, are in range
    for (int i = 0; i < CLUSTERS; i++) {
        e.centre[i] = i == 0 ? 0 : random_below(random, 2) ? about : (int)random_below(random, 610) - 310;
    }
    return e;
}

static double any_size(Random *random, const Exponents *e)
{
    int exponent = e->centre[random_below(random, CLUSTERS)] - e->width / 2;
    exponent += (int)random_below(random, (unsigned)e->width);
    exponent = exponent < -310 ? -310 : exponent > 300 ? 300 : exponent;
    char number[40];
    snprintf(number, sizeof number, "%.17ge%d", random_between(random, 1.0, 10.0), exponent);
    return strtod(number, NULL);
}

static double any_coordinate(Random *random, const Exponents *e)
{
    double size = any_size(random, e);
    unsigned kind = random_below(random, 6);
    return kind == 0 ? 0.0 : kind < 4 ? size : -size;
}

__attribute__((format(printf, 1, 2))) static void put(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    length += (size_t)vsnprintf(text + length, TEXT_MOST - length, format, arguments);
    va_end(arguments);
}

static void put_vector(Random *random, const Exponents *e)
{
    double x = any_coordinate(random, e);
    double y = any_coordinate(random, e);
    double z = any_coordinate(random, e);
    put("<%.17g, %.17g, %.17g>", x, y, z);
}

static void put_material(Random *random)
{
    static const char *const finishes[] = {
        "pigment { rgb 1 }",
        "pigment { rgb <1, 0.5, 0.2> } finish { reflection 0.5 phong 1 }",
        "pigment { rgbf <0.9, 1, 1, 0.8> } finish { reflection 0.1 } interior { ior 1.5 fade_distance 1 fade_power 2 }",
        "pigment { checker rgb 1 rgb 0 } normal { bumps 0.3 }",
    };
    put(" %s }\n", finishes[random_below(random, random_below(random, 2) ? 2 : 4)]);
}

static void put_shape(Random *random, const Exponents *e, int depth)
{
    static const char *const operators[] = {"union", "difference", "intersection", "merge"};
    switch (random_below(random, depth < 2 ? 12 : 11)) {
    case 0:
        put("plane { <%.17g, ", random_between(random, -1, 1));
        put("%.17g, ", random_between(random, -1, 1));
        put("%.17g>, ", random_between(random, 0.1, 1));
        put("%.17g", any_coordinate(random, e));
        break;
    case 1:
        put("box { ");
        put_vector(random, e);
        put(", ");
        put_vector(random, e);
        break;
    case 2:
        put("cylinder { ");
        put_vector(random, e);
        put(", ");
        put_vector(random, e);
        put(", %.17g", any_size(random, e));
        break;
    case 3:
        put("triangle { ");
        put_vector(random, e);
        put(", ");
        put_vector(random, e);
        put(", ");
        put_vector(random, e);
        break;
    case 4:
        put("sphere { 0, 1 scale <%.17g, ", any_size(random, e));
        put("%.17g, ", any_size(random, e));
        put("%.17g> rotate 30 translate ", any_size(random, e));
        put_vector(random, e);
        break;
    case 11:
        put("%s {\n", operators[random_below(random, 4)]);
        for (unsigned i = 2 + random_below(random, 3); i > 0; i--) {
            put_shape(random, e, depth + 1);
        }
        break;
    default:
        put("sphere { ");
        put_vector(random, e);
        put(", %.17g", any_size(random, e));
    }
    put_material(random);
}

static void write_scene(Random *random)
{
    static const char *const kinds[] = {"perspective", "orthographic", "fisheye"};
    Exponents e = choose_exponents(random);
    length = 0;
    put("#version 3.7;\nglobal_settings { assumed_gamma 1 max_trace_level 6 }\ncamera { %s location ",
        kinds[random_below(random, 8) % 3]);
    put_vector(random, &e);
    put(" look_at ");
    put_vector(random, &e);
    put(" }\n");
    for (unsigned i = 1 + random_below(random, 3); i > 0; i--) {
        put("light_source { ");
        put_vector(random, &e);
        put(", rgb 1%s }\n", random_below(random, 4) ? "" : " area_light x, y, 3, 3");
    }
    for (unsigned i = 1 + random_below(random, ITEMS_MOST); i > 0; i--) {
        put_shape(random, &e, 0);
    }
}

// A number for the picture; 0 where there is none, only a message.
static uint64_t render(const char *isa, bool *is_drawn)
{
    rt_session *session = rt_session_new(NULL);
    uint64_t sum = 0;
    *is_drawn = false;
    rt_set_size(session, WIDTH, HEIGHT);
    if (rt_set_isa(session, isa) == RT_OK && rt_load_text(session, "scene", text, length) == RT_OK &&
        rt_render(session, 1) == RT_OK) {
        int width, height;
        const float *pixels = rt_pixels(session, &width, &height);
        for (int i = 0; i < 3 * width * height; i++) {
            uint32_t bits;
            memcpy(&bits, &pixels[i], sizeof bits);
            sum = (sum ^ bits) * UINT64_C(0x100000001b3);
        }
        *is_drawn = true;
    }
    rt_session_free(session);
    return sum;
}

static const char *const isas[] = {"plain", "v2", "v3", "v4"};

// A tree of a few sizes, and rays that come to it from 1e53 of them.
static void test_far_plane(void)
{
    length = 0;
    put("#version 3.7;\nglobal_settings { assumed_gamma 1 }\ncamera { location <0, 0, -10> look_at 0 }\n"
        "light_source { <5, 50, -50>, 1 }\nplane { z, 1e53 pigment { rgb 1 } finish { reflection 0.5 } }\n");
    for (int i = -4; i <= 4; i++) {
        put("sphere { <%d, 0, 0>, 1 pigment { rgb 1 } }\n", 3 * i);
    }
    for (int k = 0; k < 4; k++) {
        bool is_drawn;
        (void)render(isas[k], &is_drawn);
        tap_ok(is_drawn || k > 0, "nine balls before a mirror at 1e53, with %s", isas[k]);
    }
}

int main(int argc, char **argv)
{
    int scenes = argc > 1 ? atoi(argv[1]) : 300, drawn = 0, differ = 0;
    Random random = {random_seed(NULL)};
    signal(SIGSEGV, on_signal);
    signal(SIGFPE, on_signal);
    signal(SIGALRM, on_signal);
    for (int i = 0; i < scenes; i++) {
        bool is_drawn, is_other;
        write_scene(&random);
        alarm(SECONDS_MOST);
        uint64_t first = render("plain", &is_drawn);
        drawn += is_drawn;
        for (int k = 1; is_drawn && k < 4; k++) {
            uint64_t other = render(isas[k], &is_other);
            if (is_other && other != first && ++differ < 3) {
                printf("# another picture with %s:\n%s", isas[k], text);
            }
        }
    }
    alarm(0);
    tap_ok(drawn > scenes / 2, "%d of %d scenes with lengths of any exponents give a picture, none a signal", drawn,
           scenes);
    test_far_plane();
    tap_ok(differ == 0, "%d of their pictures differ between instruction sets", differ);
    return tap_done();
}
