// Reads rtlang's command line with getopt_long, by the table of options.
//
// SPDX-License-Identifier: MIT
#include "cli/options.h"

#include <getopt.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cli/confine.h"
#include "cli/option_table.h"
#include "cli/povray.h"

static bool is_optional(const OptionRow *row)
{
    return row->argument && row->argument[0] == '[';
}

void options_print_help(FILE *out)
{
    fprintf(out, "Usage: rtlang [OPTION]... SCENE...\n"
                 "Reads each SCENE, traces it and writes a picture. A SCENE of - is standard input.\n\n");
    const OptionRow *row;
    for (size_t i = 0; (row = option_row(i)); i++) {
        char left[64];
        bool may_lack = is_optional(row);
        snprintf(left, sizeof left, row->letter ? "-%c, --%s%s%s" : "%c   --%s%s%s", row->letter ? row->letter : ' ',
                 row->name, row->argument ? may_lack ? "[=" : "=" : "", row->argument ? row->argument + may_lack : "");
        fprintf(out, "  %-28s ", left);
        for (const char *c = row->help; *c; c++) {
            *c == '\n' ? fprintf(out, "\n%31s", "") : fputc(*c, out);
        }
        fputc('\n', out);
    }
    fprintf(out, "\nExit status: 0 fine, 1 a fault in the scene, 2 usage, 3 input or output, 4 a limit.\n");
}

// The table in getopt's two forms. An option's `val` is its row's number above all characters.
enum { FIRST_VAL = 256 };

static void make_getopt_tables(struct option *long_options, char *short_options)
{
    size_t count = 0;
    *short_options++ = ':';
    for (const OptionRow *row; (row = option_row(count)); count++) {
        int kind = is_optional(row) ? optional_argument : row->argument ? required_argument : no_argument;
        long_options[count] = (struct option){row->name, kind, NULL, FIRST_VAL + (int)count};
        if (row->letter) {
            *short_options++ = row->letter;
        }
        for (int colons = 0; row->letter && row->argument && colons < kind; colons++) {
            *short_options++ = ':'; // two of an argument that may lack
        }
    }
    long_options[count] = (struct option){0};
    *short_options = '\0';
}

static const OptionRow *find_row(int val)
{
    const OptionRow *row;
    for (size_t i = 0; (row = option_row(i)); i++) {
        if (val == FIRST_VAL + (int)i || (row->letter && val == row->letter)) {
            return row;
        }
    }
    return NULL;
}

__attribute__((format(printf, 2, 3))) static OptionsResult complain(Options *options, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(options->complaint, sizeof options->complaint, format, arguments);
    va_end(arguments);
    return OPTIONS_WRONG;
}

// The long options that a word, `--name` or `--name=value`, may be short for, as text; false when there are fewer than
// two.
static bool list_candidates(const char *word, char *list, size_t size)
{
    size_t length = strcspn(word, "="), used = 0;
    unsigned count = 0;
    const OptionRow *row;
    for (size_t i = 0; length > 2 && (row = option_row(i)) && used < size; i++) {
        if (strncmp(word, "--", 2) == 0 && strncmp(word + 2, row->name, length - 2) == 0) {
            used += (size_t)snprintf(list + used, size - used, "%s`--%s`", count > 0 ? ", " : "", row->name);
            count++;
        }
    }
    return count > 1;
}

static void advise(Options *options, const char *word)
{
    const char *names[OPTIONS_MOST];
    size_t count = 0;
    for (const OptionRow *row; (row = option_row(count)); count++) {
        names[count] = row->name;
    }
    names[count] = NULL;
    advise_option(word, names, options->advice, sizeof options->advice);
}

// What getopt could not make sense of.
static OptionsResult complain_getopt(Options *options, int val, int argc, char **argv)
{
    const OptionRow *row = find_row(optopt);
    bool is_letter = optopt && optopt < FIRST_VAL;
    const char *word = option_word(argc, argv, is_letter ? optopt : 0);
    char letter[3] = {'-', (char)optopt, '\0'};
    char candidates[512];
    if (val == ':') {
        snprintf(candidates, sizeof candidates, "--%s=%s", row ? row->name : "", row ? row->argument : "");
        return complain(options, "option `--%s` wants an argument: `%s`", row ? row->name : word, candidates);
    }
    if (!row && !optopt && list_candidates(word, candidates, sizeof candidates)) {
        return complain(options, "option `%s` may be short for %s", word, candidates);
    }
    if (row) {
        return complain(options, "option `--%s` takes no argument", row->name);
    }
    advise(options, word);
    return complain(options, "unknown option `%s`", is_letter ? letter : word);
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
        return complain(options, "option `--help` wants povray or nothing, found `%.40s`", optarg);
    }
    return OPTIONS_DONE;
}

static OptionsResult read_options(int argc, char **argv, Options *options)
{
    struct option long_options[OPTIONS_MOST];
    char short_options[2 * OPTIONS_MOST + 2];
    make_getopt_tables(long_options, short_options);
    opterr = 0;
    for (int val; (val = getopt_long(argc, argv, short_options, long_options, NULL)) != -1;) {
        const char *expected = "";
        const OptionRow *row = val == '?' || val == ':' ? NULL : find_row(val);
        if (!row) {
            return complain_getopt(options, val, argc, argv);
        }
        if (!row->apply) {
            return print_and_stop(options, row);
        }
        options->is_letter = val < FIRST_VAL;
        options->choices = NULL;
        if (!row->apply(options, optarg, &expected)) {
            if (options->choices) {
                advise_value(optarg, options->choices, options->advice, sizeof options->advice);
            }
            char found[96];
            snprintf(found, sizeof found, "%s, found `%.40s`", expected, optarg ? optarg : "");
            return complain(options, "option `--%s` wants %s", row->name, found);
        }
    }
    return OPTIONS_GO;
}

// The code may stand behind a `=` or as the only word that is left; any other word is a scene.
static OptionsResult settle_explain(int argc, char **argv, Options *options)
{
    const char *word = options->code ? options->code : optind < argc ? argv[optind++] : "";
    if (optind < argc || !*word) {
        return complain(options, "option `--explain` wants one code of a message, such as E0201, or one scene%s%.80s%s",
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
        return complain(options, "`--untrusted` reads the scene's folder only: leave out `--include-path` and "
                                 "`--allow-read`");
    }
    if (options->action == ACTION_RENDER && (!is_png(options->output) || !is_png(options->error_map))) {
        return complain(options, "`--untrusted` writes pictures in PNG only");
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

OptionsResult options_read(int argc, char **argv, Options *options)
{
    *options = (Options){.width = 320,
                         .height = 240,
                         .encoding = {.depth = RT_DEPTH_AUTO},
                         .antialias = {.threshold = 0.3},
                         .photons = 1000000,
                         .frames = {.clock_to = 1.0}};
    // No more paths and declarations than arguments.
    options->include_paths = calloc((size_t)argc + 1, sizeof *options->include_paths);
    options->declarations = calloc((size_t)argc + 1, sizeof *options->declarations);
    options->warnings = calloc((size_t)argc + 1, sizeof *options->warnings);
    options->read_folders = calloc((size_t)argc + 1, sizeof *options->read_folders);
    options->scenes = calloc((size_t)argc + 1, sizeof *options->scenes);
    if (!options->include_paths || !options->declarations || !options->warnings || !options->read_folders ||
        !options->scenes) {
        return OPTIONS_NO_MEMORY;
    }
    find_format(argc, argv, options);
    return read_options(argc, argv, options);
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
    if (options->action == ACTION_EXPLAIN || options->action == ACTION_EXPLAIN_SCENE) {
        options->scenes[options->scene_count++] = options->scene;
        return OPTIONS_GO;
    }
    for (; optind < argc; optind++) {
        options->scenes[options->scene_count++] = argv[optind];
    }
    if (options->scene_count == 0) {
        return complain(options, "no scene given");
    }
    if (options->scene_count > 1 && (options->output || options->error_map)) {
        return complain(options, "one file for the pictures of more than one scene: `%s` and `%s`", options->scenes[0],
                        options->scenes[1]);
    }
    if (options->action == ACTION_TRACE_PIXEL &&
        (options->pixel_x >= options->width || options->pixel_y >= options->height)) {
        return complain(options, "pixel %d,%d is not in a picture of %d x %d pixels", options->pixel_x,
                        options->pixel_y, options->width, options->height);
    }
    return options->is_untrusted ? settle_untrusted(options) : OPTIONS_GO;
}

void options_fini(Options *options)
{
    free(options->include_paths);
    free(options->declarations);
    free(options->warnings);
    free(options->read_folders);
    free(options->scenes);
}
