// Command line of rtlang: one table of options, read into one plain struct.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_OPTIONS_H
#define CLI_OPTIONS_H

#include <stdbool.h>
#include <stdio.h>

#include "cli/frames.h"
#include "cli/option_reader.h"
#include "cli/terminal.h"
#include "rtlang/rtlang.h"

typedef enum Action {
    ACTION_RENDER,
    ACTION_CHECK,
    ACTION_DUMP_TOKENS,
    ACTION_DUMP_AST,
    ACTION_DUMP_SCENE,
    ACTION_EXPLAIN,
    ACTION_FORMAT,
    ACTION_FORMAT_CHECK,
    ACTION_TRACE_PIXEL,
    ACTION_BUDGET,
    ACTION_EXPLAIN_SCENE,
    ACTION_SERVE,
    ACTION_WATCH,
} Action;

typedef struct WarningOption {
    const char *what; // as rt_set_warning takes it
    bool is_letter;   // given by `-W`, which a width may have been meant by
} WarningOption;

enum { LIMIT_COUNT = RT_LIMIT_MESSAGES + 1 };

// Pointers refer to argv.
struct Options {
    Action action;
    const char **scenes; // owned list; "-": standard input
    int scene_count;
    const char *scene; // the one that is being run
    Frames frames;
    int frame;          // the one that is being run
    const char *rerun;  // the picture that is to be drawn again; NULL: none
    char *rerun_text, **rerun_words, *rerun_output; // its options and what is drawn to compare, owned
    const char *header; // included before the scene; NULL: none
    bool continues;     // frames whose pictures are there are not drawn
    bool keeps_scene;   // for the next frame
    bool is_povray;     // the options were POV-Ray's
    bool has_no_progress, has_no_output;
    const char *code; // ACTION_EXPLAIN
    const char *output; // NULL: the scene's name with .png in the current folder
    int width, height;
    rt_precision precision;
    int pixel_x, pixel_y; // ACTION_TRACE_PIXEL
    int digits;           // of its numbers; 0: as many as tell them apart
    const char *trace_svg; // where it is drawn; NULL: nowhere
    int threads;     // 0: as many as the machine has
    const char *isa; // NULL: the best that the machine has
    rt_output encoding;
    int crop[4]; // left, top, width and height; all 0: the whole picture
    rt_sampling sampling;
    rt_method method;
    uint64_t photons;
    rt_antialias antialias;
    bool has_alpha;
    double sky_light, outline, depth_cue; // 0: none
    const char *error_map; // where the error of each pixel is written; NULL: nowhere
    const char **include_paths; // owned list
    int include_path_count;
    bool no_povray_includes;
    const char **declarations; // owned list
    int declaration_count;
    WarningOption *warnings; // owned list
    int warning_count;
    rt_format format; // of messages
    ColorChoice color;
    const char **read_folders; // owned list
    int read_folder_count;
    const char **write_folders; // owned list
    int write_folder_count;
    double clock;
    bool clock_given;
    bool no_literals;
    bool is_lenient;
    uint64_t limits[LIMIT_COUNT]; // by rt_limit; 0: the library's default
    double max_time; // seconds of the whole run; 0: as many as it takes
    bool is_untrusted, is_unconfined, has_no_readers;
    bool has_mpi;        // ranks share the picture, or deal frames
    bool has_one_reader; // rank 0 reads the scene and sends it
    bool shares_scene;   // each has a part of the scene
    int rank, ranks;     // once they are known; 0 of 0: there are none
    int part, parts;     // of the picture; 0 of 0: all of it
    bool joins;          // the scenes are files of parts
    const char **joined; // these, once it is known
    int joined_count;
    const char **owned_joined; // that list, where it is not that of scenes
    double checkpoint;   // seconds between; < 0: none is kept
    bool resumes;
    char *command;       // the words of the command line, for files of parts; owned; NULL where none is made
    bool has_kept;       // a run was interrupted that may be continued
    bool quiet;
    OptionReading reading;
};

OptionsResult options_parse(int argc, char **argv, Options *options);
// The options alone, of which `argv` has nothing else: no scene is wanted.
OptionsResult options_read(int argc, char **argv, Options *options);
void options_fini(Options *options);

#endif
