// What is printed when a picture is done: its size, rays and seconds, and of a sampled one its error.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_SUMMARY_H
#define CLI_SUMMARY_H

#include <stdio.h>

#include "cli/options.h"
#include "cli/voice.h"
#include "rtlang/rtlang.h"

void summary_print(FILE *out, const rt_session *session, const char *output);
// Nothing where no error is known.
void summary_print_error(FILE *out, const rt_session *session, const Options *options);
// What keeps the picture from getting nearer, however many samples are taken.
const char *summary_bias_cause(const rt_error *error);

// What an animation took: pictures drawn, pictures that were there, how often the scene was read and its tree built.
typedef struct FrameCounts {
    unsigned long long drawn, there, reads, trees;
} FrameCounts;
unsigned long long summary_trees(const rt_session *session);
void summary_print_frames(Voice *voice, const FrameCounts *counts);

#endif
