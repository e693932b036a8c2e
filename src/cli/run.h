// Runs one scene, or one frame of it, as the options say. The first run confines the process for all of them.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_RUN_H
#define CLI_RUN_H

#include "cli/options.h"
#include "cli/voice.h"
#include "rtlang/rtlang.h"

rt_status run(rt_session *session, Options *options, Voice *voice);

// What options say of how scenes are read.
rt_status run_configure(rt_session *session, const Options *options);

// Prints to standard output, with what stands in its buffer; returns `status`, or what went wrong.
rt_status run_print(rt_session *session, const char *text, rt_status status);

// The frame of options->frame, of an animation whose frame before it the session has drawn; *is_drawn turns false where
// the whole scene is to be read again, which is for `run` in a new session.
rt_status run_frame(rt_session *session, Options *options, Voice *voice, bool *is_drawn);

// Whether the picture of that frame is there.
bool run_has_frame(const Options *options);

#endif
