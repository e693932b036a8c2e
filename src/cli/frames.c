// As POV-Ray does it, but that the clock of a single frame is that of the first, where POV-Ray divides 0 by 0.
//
// SPDX-License-Identifier: MIT
#include "cli/frames.h"

#include <stdio.h>
#include <string.h>

// How much the clock continues from frame to frame; 0 where there is only one.
static double frames_clock_delta(const Frames *frames)
{
    int steps = frames->final - frames->initial;
    return steps != 0 ? (frames->clock_to - frames->clock_from) / steps : 0.0;
}

double frames_clock(const Frames *frames, int frame)
{
    int steps = frames->final - frames->initial;
    double whole = frames->clock_to - frames->clock_from;
    return steps != 0 ? frames->clock_from + whole * (frame - frames->initial) / steps : frames->clock_from;
}

static int digits_of(int number)
{
    int digits = 1;
    for (; number >= 10; number /= 10) {
        digits++;
    }
    return digits;
}

void frames_name(const Frames *frames, int frame, const char *output, char *name, size_t size)
{
    const char *slash = strrchr(output, '/'), *dot = strrchr(slash ? slash : output, '.');
    int stem = dot ? (int)(dot - output) : (int)strlen(output);
    bool is_stream = output[0] == '-' && (output[1] == '\0' || (output[1] == '.' && !slash));
    if (is_stream) {
        snprintf(name, size, "%s", output);
    } else {
        snprintf(name, size, "%.*s%0*d%s", stem, output, digits_of(frames->final), frame, dot ? dot : "");
    }
}

void frames_declarations(const Frames *frames, int frame, char declarations[][FRAMES_DECLARATION_SIZE])
{
    const struct {
        const char *name;
        double value;
    } values[FRAMES_DECLARATIONS] = {{"clock_delta", frames_clock_delta(frames)}, {"initial_clock", frames->clock_from},
                                     {"final_clock", frames->clock_to},           {"initial_frame", frames->initial},
                                     {"final_frame", frames->final},              {"frame_number", frame}};
    for (size_t i = 0; i < FRAMES_DECLARATIONS; i++) {
        snprintf(declarations[i], FRAMES_DECLARATION_SIZE, "%s=%.17g", values[i].name, values[i].value);
    }
}

rt_status frames_declare(const Frames *frames, int frame, rt_session *session)
{
    char declarations[FRAMES_DECLARATIONS][FRAMES_DECLARATION_SIZE];
    frames_declarations(frames, frame, declarations);
    rt_status status = rt_set_clock(session, frames_clock(frames, frame));
    for (size_t i = 0; !status && i < FRAMES_DECLARATIONS; i++) {
        status = rt_declare(session, declarations[i]);
    }
    return status;
}

rt_status frames_set(const Frames *frames, int frame, rt_session *session, int *is_set)
{
    char declarations[FRAMES_DECLARATIONS][FRAMES_DECLARATION_SIZE];
    const char *list[FRAMES_DECLARATIONS];
    frames_declarations(frames, frame, declarations);
    for (size_t i = 0; i < FRAMES_DECLARATIONS; i++) {
        list[i] = declarations[i];
    }
    // Only the last one differs from frame to frame.
    return rt_set_frame(session, frames_clock(frames, frame), list + FRAMES_DECLARATIONS - 1, 1, is_set);
}
