// An animation: which frames are drawn, the clock of each, and what its picture is called.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_FRAMES_H
#define CLI_FRAMES_H

#include <stdbool.h>
#include <stddef.h>

#include "rtlang/rtlang.h"

// All zero: a single picture.
typedef struct Frames {
    int initial, final;     // numbers of the whole animation's frames; of a cyclic one `final` is the first again
    int first, last, step;  // those that are drawn; a step of 0: there is no animation
    double clock_from, clock_to;
} Frames;

double frames_clock(const Frames *frames, int frame);

// The name of a frame's picture: its number, of as many digits as the last one has, before the ending. Standard output
// has the same name for all.
void frames_name(const Frames *frames, int frame, const char *output, char *name, size_t size);

// What a scene may ask about a frame beside the clock, by POV-Ray's names, as NAME=VALUE.
enum { FRAMES_DECLARATIONS = 6, FRAMES_DECLARATION_SIZE = 64 };
void frames_declarations(const Frames *frames, int frame, char declarations[][FRAMES_DECLARATION_SIZE]);

// What a scene may ask about its animation: the clock, and POV-Ray's names for the rest.
rt_status frames_declare(const Frames *frames, int frame, rt_session *session);

// The scene of the session shows another frame and is to show this one, as rt_set_frame does it.
rt_status frames_set(const Frames *frames, int frame, rt_session *session, int *is_set);

#endif
