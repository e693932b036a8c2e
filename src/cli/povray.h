// POV-Ray's command line as another way to say what rtlang is to do.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_POVRAY_H
#define CLI_POVRAY_H

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>

#include "cli/options.h"
#include "cli/povray_table.h"
#include "cli/voice.h"
#include "rtlang/rtlang.h"

// What the options point to.
typedef struct Povray {
    PovraySettings settings;
    char scene[PATH_MAX], output[PATH_MAX];
    char **words; // owned list, of argv
} Povray;

// Whether a command line is POV-Ray's: the program is called povray, `--povray` is said, or a word begins with +, ends
// with .ini, or is KEY=VALUE.
bool povray_is_meant(int argc, char **argv);

typedef struct CommandLine {
    int argc;
    char **argv;
} CommandLine;

// Reads it into the options and opens the files of the voice. *status says what went wrong, which has been reported.
OptionsResult povray_parse(rt_session *session, CommandLine line, Povray *povray, Options *options, Voice *voice,
                           rt_status *status);
void povray_fini(Povray *povray);

void povray_print_help(FILE *out);

#endif
