// Any bytes are a scene that is the same picture, bit for bit, when all of it is larger by a power of two.
//
// The power follows from the size of the text. Where a scene comes near the ends of what numbers hold, which messages
// say, the two may differ.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <signal.h>
#include <string.h>
#include <sys/time.h>

#include "fuzz/fuzz.h"
#include "rtlang/rtlang.h"

enum { WIDTH = 16, HEIGHT = 16, VALUES = 3 * WIDTH * HEIGHT, MICROSECONDS = 400000 };

static rt_session *volatile running;

static void on_time(int signal_number)
{
    (void)signal_number;
    if (running) {
        rt_cancel(running);
    }
}

static void on_diagnostic(void *client, const rt_diagnostic *diagnostic)
{
    (void)diagnostic;
    ++*(int *)client;
}

// The picture of the scene times 2^exponent; false when there is none, or something was said of it.
static bool draw(const uint8_t *data, size_t size, int exponent, float values[VALUES])
{
    int messages = 0, width, height;
    const float *pixels = NULL;
    struct itimerval timer = {{0, MICROSECONDS / 4}, {0, MICROSECONDS}}, none = {{0, 0}, {0, 0}};
    rt_session *session = rt_session_new(&(rt_callbacks){&messages, on_diagnostic, NULL, NULL});
    running = session;
    setitimer(ITIMER_PROF, &timer, NULL);
    if (session) {
        rt_set_untrusted(session);
        rt_set_limit(session, RT_LIMIT_STEPS, 5000);
        rt_set_limit(session, RT_LIMIT_OBJECTS, 1000);
        rt_set_size(session, WIDTH, HEIGHT);
    }
    if (session && rt_set_world(session, ldexp(1.0, exponent), (const double[3]){0.0, 0.0, 0.0}) == RT_OK &&
        rt_load_text(session, "fuzz", (const char *)data, size) == RT_OK && rt_render(session, 1) == RT_OK &&
        messages == 0) {
        pixels = rt_pixels(session, &width, &height);
        memcpy(values, pixels, VALUES * sizeof *values);
    }
    setitimer(ITIMER_PROF, &none, NULL);
    running = NULL;
    rt_session_free(session);
    return pixels != NULL;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static float one[VALUES], other[VALUES];
    struct sigaction action = {.sa_handler = on_time, .sa_flags = SA_RESTART};
    sigaction(SIGPROF, &action, NULL);
    int exponent = (int)(size % 41) - 20;
    if (draw(data, size, 0, one) && draw(data, size, exponent, other)) {
        FUZZ_HOLDS(memcmp(one, other, sizeof one) == 0);
    }
    return 0;
}
