// Reads rtcheck's command line with getopt_long: name, argument, help and effect of an option stand in one table row.
//
// It prints what is wrong with a command line, and knows nothing of what the options do.
//
// SPDX-License-Identifier: MIT
#include "check/options.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check/say.h"
#include "rtlang/rtlang.h"

#define COUNT_OF(array) (sizeof(array) / sizeof((array)[0]))

// Takes the argument of an option; false when it is not what the row says is expected.
typedef bool (*OptionApply)(Options *options, const char *argument);

typedef struct OptionRow {
    char letter; // 0: no short form
    const char *name;
    const char *argument; // NULL: takes none
    OptionApply apply;    // NULL: prints and stops
    const char *expected; // of the argument
    const char *help;
} OptionRow;

static bool parse_integer(const char *text, long low, long high, int *value)
{
    char *end;
    long number = strtol(text, &end, 10);

    if (end == text || *end != '\0' || number < low || number > high) {
        return false;
    }
    *value = (int)number;
    return true;
}

// A number or a quotient of two, such as 2/65535; not below zero.
static bool parse_ratio(const char *text, double *value)
{
    char *end;
    double number = strtod(text, &end);

    if (end == text) {
        return false;
    }
    if (*end == '/') {
        const char *divisor = end + 1;
        number /= strtod(divisor, &end);
        if (end == divisor) {
            return false;
        }
    }
    *value = number;
    return *end == '\0' && isfinite(number) && number >= 0.0;
}

static bool apply_width(Options *options, const char *argument)
{
    return parse_integer(argument, 1, 65535, &options->width);
}

static bool apply_height(Options *options, const char *argument)
{
    return parse_integer(argument, 1, 65535, &options->height);
}

static bool apply_clock(Options *options, const char *argument)
{
    char *end;

    options->clock = strtod(argument, &end);
    options->clock_given = true;
    return end != argument && *end == '\0' && isfinite(options->clock);
}

static bool apply_threads(Options *options, const char *argument)
{
    return parse_integer(argument, 1, 512, &options->threads);
}

static bool apply_threshold(Options *options, const char *argument)
{
    return parse_ratio(argument, &options->threshold);
}

static bool apply_ties(Options *options, const char *argument)
{
    return parse_ratio(argument, &options->ties);
}

static bool apply_povray(Options *options, const char *argument)
{
    options->povray = argument;
    return argument[0] != '\0';
}

static bool apply_include_path(Options *options, const char *argument)
{
    options->include_paths[options->include_path_count++] = argument;
    return argument[0] != '\0';
}

static bool apply_keep(Options *options, const char *argument)
{
    options->keep = argument;
    return argument[0] != '\0';
}

static bool apply_report(Options *options, const char *argument)
{
    options->report = argument;
    return argument[0] != '\0';
}

static bool apply_stability(Options *options, const char *argument)
{
    (void)argument;
    options->is_stability = true;
    return true;
}

static bool apply_cases(Options *options, const char *argument)
{
    return parse_integer(argument, 1, 1000000000, &options->cases);
}

static bool apply_seed(Options *options, const char *argument)
{
    return parse_integer(argument, 0, 1000000000, &options->seed);
}

static bool apply_doubts(Options *options, const char *argument)
{
    return parse_integer(argument, 1, 1000, &options->doubts);
}

static bool apply_elsewhere(Options *options, const char *argument)
{
    return parse_integer(argument, 1, ELSEWHERE_MOST, &options->elsewhere);
}

static bool apply_json(Options *options, const char *argument)
{
    (void)argument;
    options->json = true;
    return true;
}

static bool apply_study(Options *options, const char *argument)
{
    (void)argument;
    options->study = true;
    return true;
}

static bool apply_color(Options *options, const char *argument)
{
    int choice = choice_find(argument, color_choices);
    options->color = choice >= 0 ? (ColorChoice)choice : COLOR_AUTO;
    return choice >= 0;
}

static bool apply_most(Options *options, const char *argument)
{
    return parse_integer(argument, 64, 65536, &options->most_samples);
}

static bool apply_race(Options *options, const char *argument)
{
    (void)argument;
    options->study = options->race = true;
    return true;
}

static bool apply_reference(Options *options, const char *argument)
{
    return parse_integer(argument, 64, 1048576, &options->reference);
}

static bool apply_budget(Options *options, const char *argument)
{
    return parse_ratio(argument, &options->budget);
}

// 640x480
static bool apply_size(Options *options, const char *argument)
{
    char *end;
    long width = strtol(argument, &end, 10);

    if (end == argument || *end != 'x' || width < 16 || width > 65535) {
        return false;
    }
    options->race_width = (int)width;
    return parse_integer(end + 1, 16, 65535, &options->race_height);
}

static const OptionRow rows[] = {
    {'W', "width", "PIXELS", apply_width, "a whole number from 1 to 65535", "width of the pictures (default 320)"},
    {'H', "height", "PIXELS", apply_height, "a whole number from 1 to 65535", "height of the pictures (default 240)"},
    {'K', "clock", "NUMBER", apply_clock, "a number", "the scene's clock (default 0)"},
    {0, "threshold", "VALUE", apply_threshold, "a number or a quotient of two",
     "greatest difference of a pixel that counts as equal (default 2/65535)"},
    {0, "ties", "SHARE", apply_ties, "a number or a quotient of two",
     "share of the pixels that may differ by more (default 0.0001)"},
    {0, "doubts", "N", apply_doubts, "a whole number from 1 to 1000",
     "draw what differs N more times, put elsewhere: pixels that only rounding decides do not count"},
    {0, "elsewhere", "N", apply_elsewhere, "a whole number from 1 to 100",
     "have POV-Ray draw what differs N more times, all but the same: where it does not agree with itself does not count"},
    {0, "povray", "PROGRAM", apply_povray, "a program", "POV-Ray's program (default povray)"},
    {'I', "include-path", "FOLDER", apply_include_path, "a folder", "also look here for #include; may repeat"},
    {'j', "threads", "N", apply_threads, "a whole number from 1 to 512",
     "threads of each renderer (default: all processors)"},
    {0, "keep", "FOLDER", apply_keep, "a folder", "keep the pictures and POV-Ray's messages there"},
    {0, "report", "FOLDER", apply_report, "a folder", "write index.html there, with all pictures in it"},
    {0, "stability", NULL, apply_stability, "",
     "measure how numbers hold up: formulas, stiff scenes, and the scenes put elsewhere"},
    {0, "cases", "N", apply_cases, "a whole number from 1 to 1000000000",
     "with --stability: cases of each family (default 20000)"},
    {0, "seed", "N", apply_seed, "a whole number from 0 to 1000000000",
     "with --stability: other random cases (default 0)"},
    {0, "json", NULL, apply_json, "", "print one JSON object a scene; with --report also results.json"},
    {0, "study", NULL, apply_study, "",
     "error against time instead: ladders of samples, and the race against POV-Ray's anti-aliasing"},
    {0, "race", NULL, apply_race, "", "of --study the race against POV-Ray alone"},
    {0, "budget", "SECONDS", apply_budget, "a number or a quotient of two",
     "with --study: what POV-Ray's runs of a race may take of the processor (default 60; 0: no limit)"},
    {0, "size", "WxH", apply_size, "two whole numbers from 16 to 65535, as in 640x480",
     "with --study: size of the race's pictures (default: POV-Ray's shortest run takes 0.5 s)"},
    {0, "reference", "N", apply_reference, "a whole number from 64 to 1048576",
     "with --study: samples a pixel of the reference (default 16 times --most, of a race 256)"},
    {0, "most", "N", apply_most, "a whole number from 64 to 65536",
     "with --study: samples a pixel at the top of a ladder (default 256, with --race 64)"},
    {0, "color", "WHEN", apply_color, "auto, always or never",
     "colour what is said on stderr: always, never, or auto (default): on a terminal, unless NO_COLOR is set"},
    {'V', "version", NULL, NULL, "", "print the version and stop"},
    {'h', "help", NULL, NULL, "", "print this and stop"},
};

// The table in getopt's two forms. An option's `val` is its row's number above all characters.
enum { FIRST_VAL = 256, SHORT_ROOM = 2 * COUNT_OF(rows) + 2 };

static void print_help(void)
{
    printf("Usage: rtcheck [OPTION]... SCENE...\n"
           "       rtcheck --stability [OPTION]... [SCENE]...\n"
           "       rtcheck --study [OPTION]... SCENE...\n"
           "Renders each scene with rtlang and with POV-Ray, without anti-aliasing, and compares the pictures in\n"
           "linear 16 bit. Differences are printed in steps of 1/65535.\n\n");
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        char left[64];

        snprintf(left, sizeof left, "--%s%s%s", rows[i].name, rows[i].argument != NULL ? "=" : "",
                 rows[i].argument != NULL ? rows[i].argument : "");
        printf("  %c%c%c %-23s %s\n", rows[i].letter != 0 ? '-' : ' ', rows[i].letter != 0 ? rows[i].letter : ' ',
               rows[i].letter != 0 ? ',' : ' ', left, rows[i].help);
    }
    printf("\nExit status: 0 every scene agrees, 1 one does not, 2 usage, 3 POV-Ray is missing.\n");
}

static void getopt_tables_fill(struct option long_options[COUNT_OF(rows) + 1], char *short_options)
{
    *short_options++ = ':';
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        int has_argument = rows[i].argument != NULL ? required_argument : no_argument;

        long_options[i] = (struct option){rows[i].name, has_argument, NULL, FIRST_VAL + (int)i};
        if (rows[i].letter != 0) {
            *short_options++ = rows[i].letter;
            if (rows[i].argument != NULL) {
                *short_options++ = ':';
            }
        }
    }
    long_options[COUNT_OF(rows)] = (struct option){0};
    *short_options = '\0';
}

static const OptionRow *row_find(int val)
{
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        if (val == FIRST_VAL + (int)i || (rows[i].letter != 0 && val == rows[i].letter)) {
            return &rows[i];
        }
    }
    return NULL;
}

static OptionsResult complain(const Options *options, const char *what, const char *about)
{
    say(options, "%s%s\nrtcheck --help lists the options", what, about);
    return OPTIONS_WRONG;
}

static OptionsResult complain_unknown(const Options *options, const char *word)
{
    const char *names[COUNT_OF(rows) + 1];
    char advice[128];

    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        names[i] = rows[i].name;
    }
    names[COUNT_OF(rows)] = NULL;
    advise_option(word, names, advice, sizeof advice);
    say(options, "unknown option or needless argument: %s\n%s", word,
        advice[0] != '\0' ? advice : "rtcheck --help lists the options");
    return OPTIONS_WRONG;
}

static OptionsResult complain_value(const Options *options, const OptionRow *row, const char *value)
{
    char advice[128] = "";

    if (row->apply == apply_color) {
        advise_value(value, color_choices, advice, sizeof advice);
    }
    say(options, "option --%s wants %s, found `%s`%s%s", row->name, row->expected, value, advice[0] != '\0' ? "\n" : "",
        advice);
    return OPTIONS_WRONG;
}

static OptionsResult option_take(Options *options, int val, const char *word)
{
    const OptionRow *row = row_find(val);

    if (val == ':') {
        return complain(options, "an argument is missing after ", word);
    }
    if (row == NULL) {
        return complain_unknown(options, word);
    }
    if (row->apply == NULL && row->letter == 'h') {
        print_help();
        return OPTIONS_DONE;
    }
    if (row->apply == NULL) {
        printf("rtcheck %s\n", rt_version());
        return OPTIONS_DONE;
    }
    if (!row->apply(options, optarg)) {
        return complain_value(options, row, optarg);
    }
    return OPTIONS_GO;
}

OptionsResult options_parse(int argc, char **argv, Options *options)
{
    struct option long_options[COUNT_OF(rows) + 1];
    char short_options[SHORT_ROOM];
    int val;

    *options = (Options){.width = 320,
                         .height = 240,
                         .threshold = 2.0 / 65535.0,
                         .ties = 1e-4,
                         .povray = "povray",
                         .cases = 20000,
                         .budget = 60.0};
    options->include_paths = calloc((size_t)argc + 1, sizeof *options->include_paths); // no more than arguments
    if (options->include_paths == NULL) {
        return complain(options, "out of memory", "");
    }
    getopt_tables_fill(long_options, short_options);
    opterr = 0;
    while ((val = getopt_long(argc, argv, short_options, long_options, NULL)) != -1) {
        OptionsResult result = option_take(options, val, option_word(argc, argv, optopt));
        if (result != OPTIONS_GO) {
            return result;
        }
    }
    options->most_samples = options->most_samples > 0 ? options->most_samples : options->race ? 64 : 256;
    options->scenes = argv + optind;
    options->scene_count = argc - optind;
    return options->scene_count > 0 || options->is_stability ? OPTIONS_GO : complain(options, "no scene given", "");
}

void options_fini(Options *options)
{
    free(options->include_paths);
}
