// Reads rtlang's command line with getopt_long, by the table of options.
//
// SPDX-License-Identifier: MIT
#include "cli/options.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cli/confine.h"
#include "cli/option_table.h"
#include "cli/povray.h"
#include "cli/share.h"

static void options_print_help(FILE *out)
{
    fprintf(out, "Usage: rtlang [OPTION]... SCENE...\n"
                 "Reads each SCENE, traces it and writes a picture. SCENE - is standard input.\n\n");
    option_print_rows(&option_table, out);
    fprintf(out, "\nExit status: 0 fine, 1 a fault in the scene, 2 usage, 3 input or output,\n"
                 "4 a limit.\n");
}

// --help and --version.
static OptionsResult print_and_stop(Options *options, const OptionRow *row)
{
    if (row->letter != 'h') {
        char confinement[CONFINE_TEXT];
        confine_describe(confinement);
        printf("rtlang %s\nconfinement: %s\n", rt_version(), confinement);
    } else if (!optarg) {
        options_print_help(stdout);
    } else if (strcmp(optarg, "povray") == 0) {
        povray_print_help(stdout);
    } else {
        return option_complain(&options->reading, "option `--help` wants povray or nothing, found `%.40s`", optarg);
    }
    return OPTIONS_DONE;
}

// The code may stand behind a `=` or as the only word that is left; any other word is a scene.
static OptionsResult settle_explain(int argc, char **argv, Options *options)
{
    const char *word = options->code ? options->code : optind < argc ? argv[optind++] : "";
    if (optind < argc || !*word) {
        return option_complain(&options->reading, "option `--explain` wants one code of a message, such as E0201, or one scene%s%.80s%s",
                        optind < argc ? ", found `" : "", optind < argc ? argv[optind] : "", optind < argc ? "`" : "");
    }
    if (option_is_code(word)) {
        options->code = word;
    } else {
        options->action = ACTION_EXPLAIN_SCENE;
        options->scene = word;
    }
    return OPTIONS_GO;
}

static bool is_png(const char *path)
{
    size_t length = path ? strlen(path) : 0;
    return !path || strcmp(path, "-") == 0 || (length > 4 && strcasecmp(path + length - 4, ".png") == 0);
}

enum { UNTRUSTED_SECONDS = 10 };

static OptionsResult settle_untrusted(Options *options)
{
    if (options->include_path_count > 0 || options->read_folder_count > 0) {
        return option_complain(&options->reading, "`--untrusted` reads the scene's folder only: leave out `--include-path` and "
                                 "`--allow-read`");
    }
    if (options->write_folder_count > 0) {
        return option_complain(&options->reading,
                               "`--untrusted` lets a scene write no files: leave out `--allow-write`");
    }
    if (options->action == ACTION_RENDER && (!is_png(options->output) || !is_png(options->error_map))) {
        return option_complain(&options->reading, "`--untrusted` writes pictures in PNG only");
    }
    options->max_time = options->max_time > 0.0 ? options->max_time : UNTRUSTED_SECONDS;
    return OPTIONS_GO;
}

// So that a complaint has its form even when it stands before the option.
static void find_format(int argc, char **argv, Options *options)
{
    static const char color[] = "--color=";
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--diagnostics=json") == 0) {
            options->format = RT_FORMAT_JSON;
        }
        int choice = strncmp(argv[i], color, sizeof color - 1) == 0
                         ? choice_find(argv[i] + sizeof color - 1, color_choices) : -1;
        options->color = choice >= 0 ? (ColorChoice)choice : options->color;
    }
}

// What is drawn goes to the page, from the eye, and gets better by sequences of samples.
static OptionsResult settle_watch(Options *options)
{
    const char *sampler = options->sampling.sampler;
    bool is_grid = sampler && (strcmp(sampler, "jittered") == 0 || strcmp(sampler, "grid") == 0);
    if (options->scene_count > 1 || options->frames.step || strcmp(options->scenes[0], "-") == 0) {
        return option_complain(&options->reading, "`--watch` wants one scene, in a file, and no frames");
    }
    if (options->output || options->error_map || options->rerun || options->encoding.planes || options->crop[2] > 0) {
        return option_complain(&options->reading,
                               "`--watch` shows the whole picture in its page and writes none: leave out `--output`, "
                               "`--error-map`, `--planes`, `--crop` and `--rerun`");
    }
    if (options->method != RT_METHOD_BACKWARD || options->precision != RT_PRECISION_DOUBLE ||
        options->antialias.method || options->sampling.no_estimate || is_grid) {
        return option_complain(&options->reading,
                               "`--watch` samples to a goal: leave out `--method`, `--precision`, `--antialias`, "
                               "`--no-estimate`, and `--sampler=jittered` and `grid`");
    }
    return OPTIONS_GO;
}

OptionsResult options_read(int argc, char **argv, Options *options)
{
    *options = (Options){.width = 320,
                         .height = 240,
                         .encoding = {.depth = RT_DEPTH_AUTO},
                         .antialias = {.threshold = 0.3},
                         .photons = 1000000,
                         .checkpoint = -1.0,
                         .frames = {.clock_to = 1.0}};
    // No more paths and declarations than arguments.
    options->include_paths = calloc((size_t)argc + 1, sizeof *options->include_paths);
    options->declarations = calloc((size_t)argc + 1, sizeof *options->declarations);
    options->warnings = calloc((size_t)argc + 1, sizeof *options->warnings);
    options->read_folders = calloc((size_t)argc + 1, sizeof *options->read_folders);
    options->write_folders = calloc((size_t)argc + 1, sizeof *options->write_folders);
    options->scenes = calloc((size_t)argc + 1, sizeof *options->scenes);
    if (!options->include_paths || !options->declarations || !options->warnings || !options->read_folders ||
        !options->write_folders || !options->scenes) {
        return OPTIONS_NO_MEMORY;
    }
    find_format(argc, argv, options);
    const OptionRow *stops;
    OptionsResult result = option_reader_run(&option_table, argc, argv, options, &options->reading, &stops);
    return stops ? print_and_stop(options, stops) : result;
}

OptionsResult options_parse(int argc, char **argv, Options *options)
{
    OptionsResult result = options_read(argc, argv, options);
    if (result != OPTIONS_GO) {
        return result;
    }
    if (options->action == ACTION_EXPLAIN && (result = settle_explain(argc, argv, options)) != OPTIONS_GO) {
        return result;
    }
    if (options->action == ACTION_SERVE && optind < argc) {
        return option_complain(&options->reading, "`--lsp` wants no scene: its client names them");
    }
    if (options->action == ACTION_SERVE) {
        options->scene = "";
    }
    if (options->action == ACTION_EXPLAIN || options->action == ACTION_EXPLAIN_SCENE || options->action == ACTION_SERVE) {
        options->scenes[options->scene_count++] = options->scene;
        return OPTIONS_GO;
    }
    for (; optind < argc; optind++) {
        options->scenes[options->scene_count++] = argv[optind];
    }
    if (options->scene_count == 0) {
        return option_complain(&options->reading, options->joins ? "no part given" : "no scene given");
    }
    if (options->scene_count > 1 && !options->joins && (options->output || options->error_map)) {
        return option_complain(&options->reading, "one file for the pictures of more than one scene: `%s` and `%s`", options->scenes[0],
                        options->scenes[1]);
    }
    if (options->action == ACTION_WATCH && settle_watch(options) != OPTIONS_GO) {
        return OPTIONS_WRONG;
    }
    if (options->rerun && (options->scene_count > 1 || options->frames.step || options->action != ACTION_RENDER)) {
        return option_complain(&options->reading, "`--rerun` wants one scene, and draws one picture");
    }
    if (options->action == ACTION_TRACE_PIXEL &&
        (options->pixel_x >= options->width || options->pixel_y >= options->height)) {
        return option_complain(&options->reading, "pixel %d,%d is not in a picture of %d x %d pixels", options->pixel_x,
                        options->pixel_y, options->width, options->height);
    }
    if ((options->digits > 0 || options->trace_svg) && options->action != ACTION_TRACE_PIXEL) {
        return option_complain(&options->reading, "option `%s` wants `--trace-pixel`",
                               options->digits > 0 ? "--digits" : "--trace-svg");
    }
    if (options->trace_svg && options->scene_count > 1) {
        return option_complain(&options->reading, "one drawing for more than one scene: `%s` and `%s`",
                               options->scenes[0], options->scenes[1]);
    }
    if (share_settle(options) != OPTIONS_GO) {
        return OPTIONS_WRONG;
    }
    return options->is_untrusted ? settle_untrusted(options) : OPTIONS_GO;
}

void options_fini(Options *options)
{
    free(options->include_paths);
    free(options->declarations);
    free(options->warnings);
    free(options->read_folders);
    free(options->write_folders);
    free(options->scenes);
    free(options->owned_joined);
    free(options->command);
    free(options->rerun_text);
    free(options->rerun_words);
    free(options->rerun_output);
}
