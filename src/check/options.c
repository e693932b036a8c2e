// The table of rtcheck's options, and its command line read by it.
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

#include "base/attributes.h"
#include "check/say.h"
#include "rtlang/rtlang.h"

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

static bool apply_width(Options *options, const char *argument, OptionReading *reading)
{
    return option_take_integer(reading, argument, 1, 65535, &options->width);
}

static bool apply_height(Options *options, const char *argument, OptionReading *reading)
{
    return option_take_integer(reading, argument, 1, 65535, &options->height);
}

static bool apply_clock(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number";
    options->clock_given = true;
    return option_parse_number(argument, &options->clock);
}

static bool apply_threads(Options *options, const char *argument, OptionReading *reading)
{
    return option_take_integer(reading, argument, 1, 512, &options->threads);
}

static bool apply_threshold(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number or a quotient of two";
    return parse_ratio(argument, &options->threshold);
}

static bool apply_ties(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number or a quotient of two";
    return parse_ratio(argument, &options->ties);
}

static bool apply_povray(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a program";
    options->povray = argument;
    return argument[0] != '\0';
}

static bool apply_include_path(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a folder";
    options->include_paths[options->include_path_count++] = argument;
    return argument[0] != '\0';
}

static bool apply_keep(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a folder";
    options->keep = argument;
    return argument[0] != '\0';
}

static bool apply_report(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a folder";
    options->report = argument;
    return argument[0] != '\0';
}

static bool apply_stability(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->is_stability = true;
    return true;
}

static bool apply_cases(Options *options, const char *argument, OptionReading *reading)
{
    return option_take_integer(reading, argument, 1, 1000000000, &options->cases);
}

static bool apply_seed(Options *options, const char *argument, OptionReading *reading)
{
    return option_take_integer(reading, argument, 0, 1000000000, &options->seed);
}

static bool apply_doubts(Options *options, const char *argument, OptionReading *reading)
{
    return option_take_integer(reading, argument, 1, 1000, &options->doubts);
}

static bool apply_elsewhere(Options *options, const char *argument, OptionReading *reading)
{
    return option_take_integer(reading, argument, 1, ELSEWHERE_MOST, &options->elsewhere);
}

static bool apply_json(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->json = true;
    return true;
}

static bool apply_study(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->study = true;
    return true;
}

static bool apply_color(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "auto, always or never";
    int choice;
    bool is_one = option_parse_choice(reading, argument, color_choices, &choice);
    options->color = is_one ? (ColorChoice)choice : COLOR_AUTO;
    return is_one;
}

static bool apply_most(Options *options, const char *argument, OptionReading *reading)
{
    return option_take_integer(reading, argument, 64, 65536, &options->most_samples);
}

static bool apply_race(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->study = options->race = true;
    return true;
}

static bool apply_reference(Options *options, const char *argument, OptionReading *reading)
{
    return option_take_integer(reading, argument, 64, 1048576, &options->reference);
}

static bool apply_budget(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number or a quotient of two";
    return parse_ratio(argument, &options->budget);
}

// 640x480
static bool apply_size(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "two whole numbers from 16 to 65535, as in 640x480";
    char *end;
    long width = strtol(argument, &end, 10);

    if (end == argument || *end != 'x' || width < 16 || width > 65535) {
        return false;
    }
    options->race_width = (int)width;
    return option_parse_integer(end + 1, 16, 65535, &options->race_height);
}

static bool apply_allow_write(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a folder";
    options->write_folders[options->write_folder_count++] = argument;
    return argument[0] != '\0';
}

static const OptionRow rows[] = {
    {'W', "width", "PIXELS", apply_width, "width of the pictures (default 320)"},
    {'H', "height", "PIXELS", apply_height, "height of the pictures (default 240)"},
    {'K', "clock", "NUMBER", apply_clock, "the scene's clock (default 0)"},
    {'I', "include-path", "FOLDER", apply_include_path, "also look here for #include; may repeat"},
    {0, "allow-write", "FOLDER", apply_allow_write,
     "let rtlang's run of a scene write files below FOLDER, as POV-Ray's does; may repeat"},
    {0, "threshold", "VALUE", apply_threshold, "greatest difference of a pixel that counts as equal (default 2/65535)"},
    {0, "ties", "SHARE", apply_ties, "share of the pixels that may differ by more (default 0.0001)"},
    {0, "doubts", "N", apply_doubts,
     "draw what differs N more times, put elsewhere: pixels that only rounding decides do not count"},
    {0, "elsewhere", "N", apply_elsewhere,
     "have POV-Ray draw what differs N more times, all but the same: where it does not agree with itself does not "
     "count"},
    {0, "povray", "PROGRAM", apply_povray, "POV-Ray's program (default povray)"},
    {0, "study", NULL, apply_study,
     "error against time instead: ladders of samples, and the race against POV-Ray's anti-aliasing"},
    {0, "race", NULL, apply_race, "of --study the race against POV-Ray alone"},
    {0, "budget", "SECONDS", apply_budget,
     "how long a scene's study may take, what does not fit being left out (default 120; 0: no limit)"},
    {0, "most", "N", apply_most, "samples a pixel at the top of a ladder (default 256, with --race 64)"},
    {0, "reference", "N", apply_reference,
     "samples a pixel of the reference (default 16 times --most, of a race 256, or less by the budget)"},
    {0, "size", "WxH", apply_size,
     "size of the race's pictures (default: POV-Ray's shortest run takes 0.5 s, or less by the budget)"},
    {0, "stability", NULL, apply_stability,
     "measure how numbers hold up: formulas, stiff scenes, and the scenes put elsewhere"},
    {0, "cases", "N", apply_cases, "cases of each family (default 20000)"},
    {0, "seed", "N", apply_seed, "other random cases (default 0)"},
    {0, "report", "FOLDER", apply_report, "write index.html there, with all pictures in it"},
    {0, "keep", "FOLDER", apply_keep, "keep the pictures and POV-Ray's messages there"},
    {0, "json", NULL, apply_json, "print one JSON object a scene; with --report also results.json"},
    {0, "color", "WHEN", apply_color,
     "colour what is said on stderr: always, never, or auto (default): on a terminal, unless NO_COLOR is set"},
    {'j', "threads", "N", apply_threads, "threads of each renderer (default: all processors)"},
    {'V', "version", NULL, NULL, "print the version and stop"},
    {'h', "help", NULL, NULL, "print this and stop"},
};

static const OptionGroup groups[] = {
    {"The cross-check against POV-Ray", "width"},
    {"Error against time (--study)", "study"},
    {"How numbers hold up (--stability)", "stability"},
    {"What it writes", "report"},
    {"The machine", "threads"},
};
static const OptionTable option_table = {rows, RT_COUNT_OF(rows), groups, RT_COUNT_OF(groups)};
_Static_assert(RT_COUNT_OF(rows) <= OPTIONS_MOST, "enlarge OPTIONS_MOST");

static void print_help(void)
{
    printf("Usage: rtcheck [OPTION]... SCENE...\n"
           "       rtcheck --stability [OPTION]... [SCENE]...\n"
           "       rtcheck --study [OPTION]... SCENE...\n"
           "Renders each scene with rtlang and with POV-Ray, without anti-aliasing, and\n"
           "compares the pictures in linear 16 bit. Differences are printed in steps of\n"
           "1/65535.\n\n");
    option_print_rows(&option_table, stdout);
    printf("\nExit status: 0 every scene agrees, 1 one does not, 2 usage, 3 POV-Ray is missing.\n");
}

static OptionsResult complain(const Options *options, const OptionReading *reading)
{
    say(options, "%s\n%s", reading->complaint,
        reading->advice[0] != '\0' ? reading->advice : "rtcheck --help lists the options");
    return OPTIONS_WRONG;
}

OptionsResult options_parse(int argc, char **argv, Options *options)
{
    OptionReading reading = {.advice = ""};
    const OptionRow *stops;

    *options = (Options){.words = argv,
                         .word_count = argc,
                         .width = 320,
                         .height = 240,
                         .threshold = 2.0 / 65535.0,
                         .ties = 1e-4,
                         .povray = "povray",
                         .cases = 20000,
                         .budget = 120.0};
    options->include_paths = calloc((size_t)argc + 1, sizeof *options->include_paths); // no more than arguments
    options->write_folders = calloc((size_t)argc + 1, sizeof *options->write_folders);
    if (!options->include_paths || !options->write_folders) {
        (void)option_complain(&reading, "out of memory");
        return complain(options, &reading);
    }
    OptionsResult result = option_reader_run(&option_table, argc, argv, options, &reading, &stops);
    if (stops) {
        stops->letter == 'h' ? print_help() : (void)printf("rtcheck %s\n", rt_version());
        return result;
    }
    options->most_samples = options->most_samples > 0 ? options->most_samples : options->race ? 64 : 256;
    options->scenes = argv + optind;
    options->scene_count = argc - optind;
    if (result == OPTIONS_GO && options->scene_count == 0 && !options->is_stability) {
        result = option_complain(&reading, "no scene given");
    }
    return result == OPTIONS_GO ? result : complain(options, &reading);
}

void options_fini(Options *options)
{
    free(options->include_paths);
    free(options->write_folders);
}
