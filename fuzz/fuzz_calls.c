// Any bytes are calls of rtlang.h in any order, one byte each, and numbers for their arguments: every call gives a
// status.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "fuzz/fuzz.h"
#include "rtlang/rtlang.h"

enum { CALLS_MOST = 60, SPHERES = 6, WIDTH = 12, HEIGHT = 8 };

typedef struct Calls {
    rt_session *session;
    const uint8_t *at, *end;
    double numbers[3 * SPHERES + 2]; // a colour has up to five
} Calls;

static unsigned take(Calls *calls)
{
    return calls->at < calls->end ? *calls->at++ : 0;
}

// Mostly as it should be; at times what no scene has.
static double number(Calls *calls)
{
    static const double odd[] = {
        0.0, -1.0, 1e300, -1e300, 1e-300, (double)__builtin_nanf(""), (double)__builtin_inff()};
    unsigned byte = take(calls);
    return byte >= 249 ? odd[byte - 249] : (double)byte / 32.0 - 3.0;
}

static const double *numbers(Calls *calls)
{
    for (size_t i = 0; i < sizeof calls->numbers / sizeof *calls->numbers; i++) {
        calls->numbers[i] = number(calls);
    }
    return calls->numbers;
}

static rt_array array(const double *first, int count)
{
    return (rt_array){first, RT_FLOAT64, count * (ptrdiff_t)sizeof(double), sizeof(double)};
}

static rt_status call_spheres(Calls *calls, bool is_update)
{
    const double *all = numbers(calls);
    rt_spheres spheres = {.count = take(calls) % (SPHERES + 1),
                          .centers = array(all, 3),
                          .radii = array(all, 1),
                          .look = {.colors = array(all, 3),
                                   .color_numbers = (int)(take(calls) % 7),
                                   .finish = take(calls) % 4 ? NULL : "phong 0.5 reflection 0.2"}};
    size_t group = take(calls) % 3;
    return is_update ? rt_update_spheres(calls->session, group, take(calls) % 8, &spheres)
                     : rt_add_spheres(calls->session, &spheres, &group);
}

static rt_status call_shapes(Calls *calls)
{
    const double *all = numbers(calls);
    if (take(calls) % 2) {
        return rt_add_triangles(calls->session, &(rt_triangles){.count = 2, .corners = array(all, 9)});
    }
    return rt_add_rods(calls->session, &(rt_rods){.count = SPHERES / 2,
                                                  .bases = array(all, 3),
                                                  .caps = array(all + 9, 3),
                                                  .base_radii = array(all, 1)});
}

static rt_status call_text(Calls *calls)
{
    static const char *const texts[] = {"sphere { 0, 1 pigment { rgb x } }",
                                        "camera { location -5*z }",
                                        "sphere { 0, }",
                                        "light_source { 9, 1 }",
                                        "#declare A = 1;",
                                        "union { sphere { 0, 1 } box { 0, 1 } }"};
    const char *text = texts[take(calls) % (sizeof texts / sizeof *texts)];
    return rt_load_text(calls->session, "text", text, strlen(text));
}

static rt_status call_view(Calls *calls)
{
    const double *n = numbers(calls);
    switch (take(calls) % 5) {
    case 0:
        return rt_set_camera(calls->session, &(rt_camera){.location = {n[0], n[1], n[2]},
                                                          .look_at = {n[3], n[4], n[5]},
                                                          .angle = n[6] * 30.0,
                                                          .width = n[7],
                                                          .aperture = n[8]});
    case 1:
        return rt_add_light(calls->session, &(rt_light){.position = {n[0], n[1], n[2]},
                                                        .color = {n[3], n[4], n[5]},
                                                        .radius = n[6],
                                                        .parallel = n[7] > 0.0,
                                                        .size = (int)take(calls) % 9});
    case 2:
        return rt_clear_lights(calls->session);
    case 3:
        return rt_set_background(calls->session, n);
    default:
        return rt_move_camera(calls->session, n[0]);
    }
}

static rt_status call_settings(Calls *calls)
{
    const double *n = numbers(calls);
    switch (take(calls) % 9) {
    case 0:
        return rt_set_size(calls->session, (int)take(calls) % 20, (int)take(calls) % 20);
    case 1:
        return rt_set_crop(calls->session, (int)take(calls) % 9, (int)take(calls) % 9, 4, 3);
    case 2:
        return rt_set_sampling(calls->session, &(rt_sampling){.samples = n[0], .adaptive = n[1] > 0.0});
    case 3:
        return rt_set_sky_light(calls->session, n);
    case 4:
        return rt_set_outline(calls->session, n[0], n + 1);
    case 5:
        return rt_set_depth_cue(calls->session, &(rt_depth_cue){.strength = n[0]});
    case 6:
        return rt_set_planes(calls->session, take(calls));
    case 7:
        return rt_set_isa(calls->session, rt_isa(take(calls) % 4));
    default:
        rt_set_alpha(calls->session, n[0] > 0.0);
        return RT_OK;
    }
}

static rt_status call_results(Calls *calls)
{
    static float pixels[4 * 32 * 32];
    const unsigned char *png;
    const char *text;
    size_t size;
    int width, height;
    double low[3], high[3];
    rt_error error;
    rt_output output = {.depth = (rt_depth)(take(calls) % 4)};
    switch (take(calls) % 9) {
    case 0:
        return rt_get_pixels(calls->session, &output, pixels, sizeof pixels);
    case 1:
        return rt_get_png(calls->session, &output, &png, &size);
    case 2:
        return rt_get_plane(calls->session, (rt_plane)(1u << take(calls) % 7), pixels, sizeof pixels);
    case 3:
        rt_free_pixels(rt_take_pixels(calls->session, &width, &height));
        return RT_OK;
    case 4:
        return rt_dump_scene(calls->session, &text);
    case 5:
        return rt_trace_pixel(calls->session, (int)take(calls) % 20, (int)take(calls) % 20, &text);
    case 6:
        return rt_get_box(calls->session, low, high);
    case 7:
        rt_get_error(calls->session, &error);
        return RT_OK;
    default:
        return rt_set_pixels(calls->session, 4, 4, pixels, NULL);
    }
}

static rt_status call_next(Calls *calls)
{
    switch (take(calls) % 16) {
    case 0:
        return rt_begin_scene(calls->session);
    case 1:
    case 2:
        return call_spheres(calls, false);
    case 3:
        return call_spheres(calls, true);
    case 4:
        return call_shapes(calls);
    case 5:
        return call_text(calls);
    case 6:
    case 7:
        return call_view(calls);
    case 8:
    case 9:
        return call_settings(calls);
    case 10:
        rt_cancel(calls->session);
        return RT_OK;
    case 11:
        rt_resume(calls->session);
        return RT_OK;
    case 12:
        rt_discard_scene(calls->session);
        return RT_OK;
    case 13:
        return call_results(calls);
    default:
        return rt_render(calls->session, 1);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    Calls calls = {.session = rt_session_new(NULL), .at = data, .end = data + size};
    if (calls.session) {
        rt_set_untrusted(calls.session);
        rt_set_size(calls.session, WIDTH, HEIGHT);
        if (take(&calls) % 4) {
            FUZZ_HOLDS(rt_begin_scene(calls.session) == RT_OK);
        }
    }
    for (int i = 0; calls.session && calls.at < calls.end && i < CALLS_MOST; i++) {
        rt_status status = call_next(&calls);
        FUZZ_HOLDS((unsigned)status <= RT_CANCELLED || status == RT_FAULT_USAGE);
    }
    rt_session_free(calls.session);
    return 0;
}
