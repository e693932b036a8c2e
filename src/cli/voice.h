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
    int rank;                    // of several processes; above 0 each text says so
    bool is_held;                // what is fatal waits, until it is known whether rank 0 says the same
    char *held;                  // that; owned; NULL: nothing
    const volatile sig_atomic_t *interrupted_by; // the first signal that ends runs, or 0
} Voice;

void voice_say(Voice *voice, VoiceStream stream, const char *text, size_t length);
// Of a rank above 0: fatal texts wait, until they are said or forgotten.
void voice_hold(Voice *voice);
void voice_release(Voice *voice, bool is_said);
// Closes the files; false when one could not be written.
bool voice_close(Voice *voice);

#endif
