// Command line of rtlang: one table of options, read into one plain struct.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_OPTIONS_H
#define CLI_OPTIONS_H

#include <stdbool.h>
#include <stdio.h>

#include "rtlang/rtlang.h"

typedef enum Action { ACTION_RENDER, ACTION_CHECK, ACTION_DUMP_TOKENS, ACTION_DUMP_AST, ACTION_DUMP_SCENE } Action;

// Pointers refer to argv.
typedef struct Options {
    Action action;
    const char *scene;
    const char *output; // NULL: the scene's name with .png in the current folder
    int width, height;
    int threads; // 0: as many as the machine has
    rt_output encoding;
    const char **include_paths; // owned list
    int include_path_count;
    const char **declarations; // owned list
    int declaration_count;
    bool quiet;
} Options;

typedef enum OptionsResult {
    OPTIONS_GO,    // run
    OPTIONS_DONE,  // --help or --version was printed
    OPTIONS_WRONG, // a message was printed to stderr
} OptionsResult;

OptionsResult options_parse(int argc, char **argv, Options *options);
void options_fini(Options *options);
void options_print_help(FILE *out);

#endif
