// Any bytes are a stranger's scene that ends in a picture or a message; the picture is the same bits with each
// instruction set, and with spheres read by the quick way and by the general one.
//
// How many rays a pixel takes follows from the size of the text.
//
// SPDX-License-Identifier: MIT
#include <signal.h>
#include <string.h>
#include <sys/time.h>

#include "fuzz/fuzz.h"
#include "rtlang/rtlang.h"

enum { WIDTH = 16, HEIGHT = 16, VALUES = 3 * WIDTH * HEIGHT, MICROSECONDS = 400000 };

static rt_session *volatile running;

// Of processor time: a scene may take for ever, and is then to be ended.
static void on_time(int signal_number)
{
    (void)signal_number;
    if (running) {
        rt_cancel(running);
    }
}

static void set_timer(long microseconds)
{
    struct sigaction action = {.sa_handler = on_time, .sa_flags = SA_RESTART};
    struct itimerval timer = {{microseconds / 4 / 1000000, microseconds / 4 % 1000000},
                              {microseconds / 1000000, microseconds % 1000000}};
    sigaction(SIGPROF, &action, NULL);
    setitimer(ITIMER_PROF, &timer, NULL);
}

static rt_session *load(const uint8_t *data, size_t size, bool has_literals)
{
    rt_session *session = rt_session_new(NULL);
    if (!session) {
        return NULL;
    }
    running = session;
    rt_set_untrusted(session);
    rt_set_limit(session, RT_LIMIT_STEPS, 20000);
    rt_set_limit(session, RT_LIMIT_OBJECTS, 5000);
    rt_set_limit(session, RT_LIMIT_TEXT, 1 << 20);
    rt_set_limit(session, RT_LIMIT_MESSAGES, 1 << 12);
    rt_set_literals(session, has_literals);
    rt_set_size(session, WIDTH, HEIGHT);
    rt_set_alpha(session, size % 2 == 1);
    rt_set_antialias(session, &(rt_antialias){.method = size % 8 == 2, .depth = 1});
    rt_set_sampling(session, &(rt_sampling){.samples = size % 8 == 4 ? 2.0 : 0.0});
    if (rt_load_text(session, "fuzz", (const char *)data, size) != RT_OK) {
        running = NULL;
        rt_session_free(session);
        return NULL;
    }
    return session;
}

// Traces with one instruction set, if it is there. False: there is no picture to compare, for want of time or memory.
static bool trace(rt_session *session, const char *isa, float values[VALUES])
{
    int width, height;
    if (rt_set_isa(session, isa) != RT_OK || rt_render(session, 1) != RT_OK) {
        return false;
    }
    const float *pixels = rt_pixels(session, &width, &height);
    FUZZ_HOLDS(pixels && width == WIDTH && height == HEIGHT);
    memcpy(values, pixels, VALUES * sizeof *values);
    return true;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static float first[VALUES], other[VALUES];
    set_timer(MICROSECONDS);
    rt_session *session = load(data, size, true);
    bool is_traced = session && rt_isa(0) && trace(session, rt_isa(0), first);
    for (size_t i = 1; is_traced && rt_isa(i); i++) {
        if (trace(session, rt_isa(i), other)) {
            FUZZ_HOLDS(memcmp(first, other, sizeof first) == 0);
        }
    }
    running = NULL;
    rt_session_free(session);
    session = is_traced ? load(data, size, false) : NULL;
    if (session && trace(session, rt_isa(0), other)) {
        FUZZ_HOLDS(memcmp(first, other, sizeof first) == 0);
    }
    running = NULL;
    rt_session_free(session);
    set_timer(0);
    return 0;
}
