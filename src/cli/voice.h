// Where the program's text goes: the five streams that POV-Ray has, each to stderr, to a file, to both or to neither.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_VOICE_H
#define CLI_VOICE_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "cli/progress.h"

typedef enum VoiceStream {
    VOICE_DEBUG, // what the scene says
    VOICE_FATAL,
    VOICE_RENDER, // what is about to be drawn
    VOICE_STATISTICS,
    VOICE_WARNING,
    VOICE_ALL, // as a file only: all of these
    VOICE_STREAMS,
} VoiceStream;

// All zero but for the signal: everything on stderr.
typedef struct Voice {
    Progress progress;
    bool is_mute[VOICE_STREAMS]; // not on stderr
    bool has_no_warnings;        // nowhere
    FILE *files[VOICE_STREAMS];  // NULL: none; owned
    const volatile sig_atomic_t *interrupted_by; // the first signal that ends runs, or 0
} Voice;

void voice_say(Voice *voice, VoiceStream stream, const char *text, size_t length);
// Closes the files; false when one could not be written.
bool voice_close(Voice *voice);

#endif
