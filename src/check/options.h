// Command line of rtcheck: one table of options, read into one plain struct.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_OPTIONS_H
#define CHECK_OPTIONS_H

#include <stdbool.h>

#include "cli/option_reader.h"
#include "cli/terminal.h"

enum { ELSEWHERE_MOST = 100 };

// Pointers refer to argv.
struct Options {
    int width, height;
    double clock;
    bool clock_given;
    int threads;      // for both renderers; 0: as many as the machine has
    double threshold; // of a channel's difference, in linear light
    double ties;      // the share of pixels that may differ by more
    int doubts;       // how often a scene is drawn elsewhere, to find pixels that rounding decides
    int elsewhere;    // how many more pictures POV-Ray draws, to find pixels in which it does not agree with itself
    const char *povray;
    const char *keep; // folder for the pictures and POV-Ray's messages; NULL: they are thrown away
    const char *report; // folder for the page; NULL: none is written
    const char **include_paths; // owned list
    int include_path_count;
    const char **write_folders; // owned list: below them scenes may write
    int write_folder_count;
    bool is_stability; // numbers instead of pictures beside POV-Ray's
    int cases, seed;   // is_stability: of each family; added to the seed
    bool json;
    int most_samples; // of a study
    int reference; // samples of a study's references; 0: by most_samples
    double budget; // of a study, seconds by the clock; 0: no limit
    int race_width, race_height; // 0: as large as it takes
    bool race;  // the race alone
    bool study; // of error against time, instead of a comparison
    char **words; // of the command line, the program's name first
    int word_count;
    char **scenes;
    int scene_count;
    ColorChoice color; // of what is said on stderr
};

// Prints what is wrong to stderr. To be released by options_fini whatever the result.
OptionsResult options_parse(int argc, char **argv, Options *options);
void options_fini(Options *options);

#endif
