// Reads rtlang's command line with getopt_long; names, arguments, help and effect of an option stand in one table line.
//
// Long because the options are many: most of it is that table and a small function for each line that needs one.
//
// SPDX-License-Identifier: MIT
#include "cli/options.h"

#include <ctype.h>
#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define COUNT_OF(array) (sizeof(array) / sizeof((array)[0]))

// Takes the argument of an option; false when it is not acceptable, after saying why in *expected.
typedef bool (*OptionApply)(Options *options, const char *argument, const char **expected);

typedef struct OptionRow {
    char letter; // 0: no short form
    const char *name;
    const char *argument; // NULL: takes none; may be left out when it begins with `[`
    OptionApply apply;    // NULL: handled by options_parse itself
    const char *help;
} OptionRow;

static bool parse_integer(const char *text, long low, long high, int *value)
{
    char *end;
    long number = strtol(text, &end, 10);
    if (end == text || *end || number < low || number > high) {
        return false;
    }
    *value = (int)number;
    return true;
}

static bool apply_output(Options *options, const char *argument, const char **expected)
{
    *expected = "a file name";
    options->output = argument;
    return argument[0] != '\0';
}

static bool apply_warnings(Options *options, const char *argument, const char **expected)
{
    *expected = "all, error or the code of a warning";
    options->warnings[options->warning_count++] = argument;
    return argument[0] != '\0';
}

// `-Wall` and the like begin with the same letter.
static bool apply_width(Options *options, const char *argument, const char **expected)
{
    if (isalpha((unsigned char)argument[0])) {
        return apply_warnings(options, argument, expected);
    }
    *expected = "a whole number from 1 to 65535";
    return parse_integer(argument, 1, 65535, &options->width);
}

static bool apply_height(Options *options, const char *argument, const char **expected)
{
    *expected = "a whole number from 1 to 65535";
    return parse_integer(argument, 1, 65535, &options->height);
}

static bool apply_threads(Options *options, const char *argument, const char **expected)
{
    *expected = "a whole number from 1 to 1024";
    return parse_integer(argument, 1, 1024, &options->threads);
}

static bool apply_isa(Options *options, const char *argument, const char **expected)
{
    *expected = "an instruction set of this processor: plain, or on x86-64 v2, v3 or v4";
    for (size_t i = 0; rt_isa(i); i++) {
        if (strcmp(argument, rt_isa(i)) == 0) {
            options->isa = rt_isa(i);
            return true;
        }
    }
    return false;
}

static bool apply_no_literals(Options *options, const char *argument, const char **expected)
{
    (void)argument;
    *expected = "";
    return options->no_literals = true;
}

static bool apply_include_path(Options *options, const char *argument, const char **expected)
{
    *expected = "a folder";
    options->include_paths[options->include_path_count++] = argument;
    return argument[0] != '\0';
}

static bool apply_declare(Options *options, const char *argument, const char **expected)
{
    *expected = "NAME=NUMBER, with a NAME that is not reserved";
    options->declarations[options->declaration_count++] = argument;
    return strchr(argument, '=') != NULL;
}

static bool apply_allow_read(Options *options, const char *argument, const char **expected)
{
    *expected = "a folder";
    options->read_folders[options->read_folder_count++] = argument;
    return argument[0] != '\0';
}

static bool apply_clock(Options *options, const char *argument, const char **expected)
{
    char *end;
    *expected = "a number";
    options->clock = strtod(argument, &end);
    options->clock_given = true;
    return end != argument && !*end && isfinite(options->clock);
}

// A whole number; `units` are the letters that may follow, each 1024 times the one before.
static bool parse_limit(const char *text, const char *units, uint64_t greatest, uint64_t *value)
{
    char *end;
    errno = 0;
    unsigned long long number = strtoull(text, &end, 10);
    const char *unit = *end ? strchr(units, *end) : NULL;
    unsigned shift = unit ? 10 * (unsigned)(unit - units + 1) : 0;
    if (text[0] < '0' || text[0] > '9' || errno || number == 0 || number > greatest >> shift || end[unit != NULL]) {
        return false;
    }
    *value = (uint64_t)number << shift;
    return true;
}

static bool apply_max_steps(Options *options, const char *argument, const char **expected)
{
    *expected = "a whole number from 1";
    return parse_limit(argument, "", UINT64_MAX, &options->limits[RT_LIMIT_STEPS]);
}

static bool apply_max_depth(Options *options, const char *argument, const char **expected)
{
    *expected = "a whole number from 1 to 1000";
    return parse_limit(argument, "", 1000, &options->limits[RT_LIMIT_DEPTH]);
}

static bool apply_max_objects(Options *options, const char *argument, const char **expected)
{
    *expected = "a whole number from 1";
    return parse_limit(argument, "", UINT64_MAX, &options->limits[RT_LIMIT_OBJECTS]);
}

static const char bytes_expected[] = "a number of bytes, as 500K, 64M, 2G or 1T";

static bool apply_max_text(Options *options, const char *argument, const char **expected)
{
    *expected = bytes_expected;
    return parse_limit(argument, "KMGT", UINT64_MAX, &options->limits[RT_LIMIT_TEXT]);
}

static bool apply_max_memory(Options *options, const char *argument, const char **expected)
{
    *expected = bytes_expected;
    return parse_limit(argument, "KMGT", UINT64_MAX, &options->limits[RT_LIMIT_MEMORY]);
}

static bool apply_depth(Options *options, const char *argument, const char **expected)
{
    static const struct {
        const char *name;
        rt_depth depth;
    } depths[] = {{"8", RT_DEPTH_8}, {"16", RT_DEPTH_16}, {"float", RT_DEPTH_FLOAT}};
    *expected = "8, 16 or float";
    for (size_t i = 0; i < COUNT_OF(depths); i++) {
        if (strcmp(argument, depths[i].name) == 0) {
            options->encoding.depth = depths[i].depth;
            return true;
        }
    }
    return false;
}

static bool apply_file_gamma(Options *options, const char *argument, const char **expected)
{
    *expected = "srgb or a number above 0";
    char *end;
    double gamma = strcmp(argument, "srgb") == 0 ? 0.0 : strtod(argument, &end);
    options->encoding.file_gamma = gamma;
    return strcmp(argument, "srgb") == 0 || (end != argument && !*end && gamma > 0.0 && isfinite(gamma));
}

static bool parse_positive(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && !*end && *value > 0.0 && isfinite(*value);
}

static bool apply_samples(Options *options, const char *argument, const char **expected)
{
    *expected = "a number from 1 to 16777216";
    return parse_positive(argument, &options->sampling.samples) && options->sampling.samples >= 1.0 &&
           options->sampling.samples <= 16777216.0;
}

static bool apply_seed(Options *options, const char *argument, const char **expected)
{
    char *end;
    *expected = "a whole number from 0 to 18446744073709551615";
    errno = 0;
    options->sampling.seed = strtoull(argument, &end, 10);
    return argument[0] >= '0' && argument[0] <= '9' && !*end && errno == 0;
}

// Takes one of some names, of which the last is NULL.
static bool parse_name(const char *argument, const char *const *names, const char **name)
{
    for (; *names && strcmp(argument, *names) != 0; names++) {
    }
    *name = *names;
    return *names != NULL;
}

static bool apply_sampler(Options *options, const char *argument, const char **expected)
{
    static const char *const names[] = {"sobol", "halton", "jittered", "grid", "random", NULL};
    *expected = "sobol, halton, jittered, grid or random";
    return parse_name(argument, names, &options->sampling.sampler);
}

static bool apply_filter(Options *options, const char *argument, const char **expected)
{
    static const char *const names[] = {"box", "tent", "gaussian", "mitchell", NULL};
    *expected = "box, tent, gaussian or mitchell";
    return parse_name(argument, names, &options->sampling.filter);
}

static bool apply_adaptive(Options *options, const char *argument, const char **expected)
{
    (void)argument, (void)expected;
    options->sampling.adaptive = 1;
    return true;
}

static bool apply_target_error(Options *options, const char *argument, const char **expected)
{
    *expected = "a number above 0";
    return parse_positive(argument, &options->sampling.target_error);
}

static bool apply_time_limit(Options *options, const char *argument, const char **expected)
{
    *expected = "a number of seconds above 0";
    return parse_positive(argument, &options->sampling.time_limit);
}

static bool apply_no_estimate(Options *options, const char *argument, const char **expected)
{
    (void)argument, (void)expected;
    options->sampling.no_estimate = 1;
    return true;
}

static bool apply_method(Options *options, const char *argument, const char **expected)
{
    static const char *const names[] = {[RT_METHOD_BACKWARD] = "backward", [RT_METHOD_FORWARD] = "forward",
                                        [RT_METHOD_FORWARD_CONNECT] = "forward-connect"};
    *expected = "backward, forward or forward-connect";
    for (size_t i = 0; i < COUNT_OF(names); i++) {
        if (strcmp(argument, names[i]) == 0) {
            options->method = (rt_method)i;
            return true;
        }
    }
    return false;
}

static bool apply_photons(Options *options, const char *argument, const char **expected)
{
    double photons;
    *expected = "a number from 1 to 1e15, as 1000000 or 1e6";
    bool fine = parse_positive(argument, &photons) && photons >= 1.0 && photons <= 1e15;
    options->photons = fine ? (uint64_t)photons : 0;
    return fine;
}

static bool apply_antialias(Options *options, const char *argument, const char **expected)
{
    *expected = "1 or 2";
    options->antialias.method = strcmp(argument, "2") == 0 ? 2 : 1;
    return strcmp(argument, "1") == 0 || strcmp(argument, "2") == 0;
}

static bool apply_antialias_depth(Options *options, const char *argument, const char **expected)
{
    *expected = "a whole number from 1 to 9";
    options->antialias.depth = argument[0] - '0';
    return argument[0] >= '1' && argument[0] <= '9' && !argument[1];
}

static bool apply_antialias_threshold(Options *options, const char *argument, const char **expected)
{
    char *end;
    *expected = "a number, 0 or more";
    options->antialias.threshold = strtod(argument, &end);
    return end != argument && !*end && options->antialias.threshold >= 0.0;
}

static bool apply_antialias_gamma(Options *options, const char *argument, const char **expected)
{
    *expected = "a number above 0";
    return parse_positive(argument, &options->antialias.gamma);
}

static bool apply_error_map(Options *options, const char *argument, const char **expected)
{
    *expected = "a file name";
    options->error_map = argument;
    return argument[0] != '\0';
}

static bool apply_error_channel(Options *options, const char *argument, const char **expected)
{
    (void)argument, (void)expected;
    options->encoding.error_channel = 1;
    return true;
}

static bool apply_quiet(Options *options, const char *argument, const char **expected)
{
    (void)argument, (void)expected;
    options->quiet = true;
    return true;
}

static bool apply_check(Options *options, const char *argument, const char **expected)
{
    (void)argument, (void)expected;
    options->action = options->action == ACTION_FORMAT ? ACTION_FORMAT_CHECK : ACTION_CHECK;
    return true;
}

static bool apply_format(Options *options, const char *argument, const char **expected)
{
    (void)argument, (void)expected;
    options->action = options->action == ACTION_CHECK ? ACTION_FORMAT_CHECK : ACTION_FORMAT;
    return true;
}

static bool apply_budget(Options *options, const char *argument, const char **expected)
{
    (void)argument, (void)expected;
    options->action = ACTION_BUDGET;
    return true;
}

static bool apply_diagnostics(Options *options, const char *argument, const char **expected)
{
    *expected = "text or json";
    options->format = strcmp(argument, "json") == 0 ? RT_FORMAT_JSON : RT_FORMAT_TEXT;
    return options->format == RT_FORMAT_JSON || strcmp(argument, "text") == 0;
}

// A letter and four digits; everything else is the name of a scene.
static bool is_code(const char *text)
{
    return strlen(text) == 5 && strchr("EeWw", text[0]) && strspn(text + 1, "0123456789") == 4;
}

static bool apply_explain(Options *options, const char *argument, const char **expected)
{
    *expected = "the code of a message, such as E0201";
    options->action = ACTION_EXPLAIN;
    options->code = argument;
    return !argument || is_code(argument);
}

static bool apply_dump(Options *options, const char *argument, const char **expected)
{
    static const struct {
        const char *name;
        Action action;
    } stages[] = {{"tokens", ACTION_DUMP_TOKENS}, {"ast", ACTION_DUMP_AST}, {"scene", ACTION_DUMP_SCENE}};
    *expected = "tokens, ast or scene";
    for (size_t i = 0; i < COUNT_OF(stages); i++) {
        if (strcmp(argument, stages[i].name) == 0) {
            options->action = stages[i].action;
            return true;
        }
    }
    return false;
}

static bool apply_precision(Options *options, const char *argument, const char **expected)
{
    static const struct {
        const char *name;
        rt_precision precision;
    } precisions[] = {{"double", RT_PRECISION_DOUBLE},
                      {"float", RT_PRECISION_FLOAT},
                      {"quad", RT_PRECISION_QUAD},
                      {"reference", RT_PRECISION_REFERENCE}};
    *expected = "float, double, quad or reference";
    for (size_t i = 0; i < COUNT_OF(precisions); i++) {
        if (strcmp(argument, precisions[i].name) == 0) {
            options->precision = precisions[i].precision;
            return true;
        }
    }
    return false;
}

// Two whole numbers; whether they lie in the picture is known when all options are read.
static bool apply_trace_pixel(Options *options, const char *argument, const char **expected)
{
    char first[8];
    size_t length = strcspn(argument, ",");
    *expected = "the column and the row of a pixel, from 0, as 160,120";
    options->action = ACTION_TRACE_PIXEL;
    if (argument[length] == '\0' || length >= sizeof first) {
        return false;
    }
    memcpy(first, argument, length);
    first[length] = '\0';
    return parse_integer(first, 0, 65534, &options->pixel_x) &&
           parse_integer(argument + length + 1, 0, 65534, &options->pixel_y);
}

// LEFT,TOP,WIDTH,HEIGHT; whether that lies in the picture is known when all options are read.
static bool apply_crop(Options *options, const char *argument, const char **expected)
{
    int *numbers[] = {&options->crop[0], &options->crop[1], &options->crop[2], &options->crop[3]};
    *expected = "left, top, width and height in pixels, as 0,0,160,120";
    for (int i = 0; i < 4; i++) {
        char number[8];
        size_t length = strcspn(argument, ",");
        if (length >= sizeof number || (argument[length] == ',') != (i < 3)) {
            return false;
        }
        memcpy(number, argument, length);
        number[length] = '\0';
        if (!parse_integer(number, i < 2 ? 0 : 1, 65535, numbers[i])) {
            return false;
        }
        argument += length + 1;
    }
    return true;
}

static const OptionRow rows[] = {
    {'o', "output", "FILE", apply_output,
     "write the picture to FILE, its format by the ending; - is PNG to standard output\n"
     "(default: the scene's name with .png, in the current folder)"},
    {'W', "width", "PIXELS", apply_width, "width of the picture (default 320)"},
    {'H', "height", "PIXELS", apply_height, "height of the picture (default 240)"},
    {0, "crop", "L,T,W,H", apply_crop,
     "trace W x H pixels from column L and row T only; they are those of the whole picture"},
    {'t', "threads", "N", apply_threads, "threads to use (default: all processors); the picture does not depend on it"},
    {0, "isa", "NAME", apply_isa,
     "instruction set to use: plain, v2, v3 or v4 (default: the best there is); the picture does not depend on it"},
    {0, "no-literals", NULL, apply_no_literals,
     "parse spheres of nothing but numbers as all else is, not by their text; the scene is the same"},
    {'I', "include-path", "FOLDER", apply_include_path, "also look here for #include; may repeat, searched in order"},
    {'D', "declare", "NAME=NUMBER", apply_declare, "declare a name before the scene begins; may repeat"},
    {'K', "clock", "NUMBER", apply_clock, "the scene's clock (default 0)"},
    {0, "allow-read", "FOLDER", apply_allow_read,
     "let the scene read files below FOLDER too, besides its own folder and those of -I; may repeat"},
    {0, "max-steps", "N", apply_max_steps, "turns of loops and macro calls, all together (default 30000000)"},
    {0, "max-depth", "N", apply_max_depth, "nesting of expressions, blocks, macro calls and includes (default 1000)"},
    {0, "max-objects", "N", apply_max_objects, "shapes in the scene (default 1000000000)"},
    {0, "max-text", "BYTES", apply_max_text, "text of all files of the scene (default 64G)"},
    {0, "max-memory", "BYTES", apply_max_memory, "memory of scene and picture (default: the machine's)"},
    {0, "depth", "8|16|float", apply_depth, "bits of a stored value (default: float for EXR and HDR, else 8)"},
    {0, "file-gamma", "srgb|NUMBER", apply_file_gamma, "how values are stored (default srgb; 1 writes linear values)"},
    {0, "samples", "N", apply_samples, "rays a pixel (default 1, through its middle); area lights are then sampled, too"},
    {0, "seed", "N", apply_seed, "another seed, another picture with the same mean (default 0)"},
    {0, "sampler", "NAME", apply_sampler, "sobol (default), halton, jittered, grid or random"},
    {0, "filter", "NAME", apply_filter, "how a pixel's rays are spread: box (default), tent, gaussian or mitchell"},
    {0, "adaptive", NULL, apply_adaptive, "more rays where the error is; N of --samples is then the mean"},
    {0, "target-error", "E", apply_target_error,
     "sample until the picture's error is below E: root mean square in linear light, with 95 % confidence"},
    {0, "time-limit", "SECONDS", apply_time_limit, "sample as long as that; rounds are not begun that would take longer"},
    {0, "no-estimate", NULL, apply_no_estimate, "do not work out the error of --samples; the picture is the same"},
    {0, "antialias", "1|2", apply_antialias,
     "more rays where colours differ, as POV-Ray's `+A -J` with `+AM1` or `+AM2`; not with --samples"},
    {0, "antialias-depth", "N", apply_antialias_depth, "1 to 9: N² more rays, or N - 1 partings in method 2 (default 3)"},
    {0, "antialias-threshold", "X", apply_antialias_threshold,
     "by how much red, green and blue must differ together (default 0.3)"},
    {0, "antialias-gamma", "G", apply_antialias_gamma, "compare colours after their 1/G-th power (default 2.5)"},
    {0, "error-map", "FILE", apply_error_map, "write the error of each pixel, too, as a grey picture in linear light"},
    {0, "error-channel", NULL, apply_error_channel, "write it as a fourth channel `error` of the picture, which must be EXR"},
    {0, "method", "NAME", apply_method,
     "backward (default), or for study photons from the lights: forward, forward-connect"},
    {0, "photons", "N", apply_photons, "photons of the forward methods (default 1e6)"},
    {0, "check", NULL, apply_check, "read and evaluate the scene only; write nothing"},
    {0, "budget", NULL, apply_budget, "print how much memory rendering the scene takes at most, and stop"},
    {0, "warnings", "WHAT", apply_warnings,
     "all: warn of more; error: take warnings for errors; a code, or no- and a code:\n"
     "turn one on or off; may repeat. -Wall, -Werror and -Wno-CODE are short for it"},
    {0, "diagnostics", "text|json", apply_diagnostics, "form of the messages (default text; json: an object a line)"},
    {0, "explain", "[CODE]", apply_explain,
     "print what the code of a message means; with a SCENE instead of a code what the scene\n"
     "takes and what it costs, and what is left out and why"},
    {0, "format", NULL, apply_format,
     "print the scene's text in the canonical layout, or write it to -o FILE;\n"
     "with --check tell whether it is in that layout"},
    {0, "dump", "tokens|ast|scene", apply_dump, "print what a stage makes of the scene, and stop"},
    {0, "precision", "WHAT", apply_precision,
     "float, quad (float128) or reference (double): trace with the reference path, for study;\n"
     "it knows spheres, planes and plain lights, and is slow (default double, by the usual kernels)"},
    {0, "trace-pixel", "X,Y", apply_trace_pixel,
     "print the life of the ray of one pixel, from 0,0 at the top left, and stop; no picture is made"},
    {'q', "quiet", NULL, apply_quiet, "no progress and no summary; messages about the scene stay"},
    {'V', "version", NULL, NULL, "print the version and stop"},
    {'h', "help", NULL, NULL, "print this and stop"},
};

static bool is_optional(const OptionRow *row)
{
    return row->argument && row->argument[0] == '[';
}

void options_print_help(FILE *out)
{
    fprintf(out, "Usage: rtlang [OPTION]... SCENE\n"
                 "Reads SCENE, traces it and writes a picture. A SCENE of - is standard input.\n\n");
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        char left[64];
        bool may_lack = is_optional(&rows[i]);
        snprintf(left, sizeof left, rows[i].letter ? "-%c, --%s%s%s" : "%c   --%s%s%s",
                 rows[i].letter ? rows[i].letter : ' ', rows[i].name, rows[i].argument ? may_lack ? "[=" : "=" : "",
                 rows[i].argument ? rows[i].argument + may_lack : "");
        fprintf(out, "  %-28s ", left);
        for (const char *c = rows[i].help; *c; c++) {
            *c == '\n' ? fprintf(out, "\n%31s", "") : fputc(*c, out);
        }
        fputc('\n', out);
    }
    fprintf(out, "\nExit status: 0 fine, 1 a fault in the scene, 2 usage, 3 input or output, 4 a limit.\n");
}

// The table in getopt's two forms. An option's `val` is its row's number above all characters.
enum { FIRST_VAL = 256, MAX_ROWS = 64 };
_Static_assert(COUNT_OF(rows) < MAX_ROWS, "enlarge MAX_ROWS");

static void make_getopt_tables(struct option *long_options, char *short_options)
{
    *short_options++ = ':';
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        long_options[i] =
            (struct option){rows[i].name,
                            is_optional(&rows[i]) ? optional_argument
                            : rows[i].argument    ? required_argument
                                                  : no_argument,
                            NULL, FIRST_VAL + (int)i};
        if (rows[i].letter) {
            *short_options++ = rows[i].letter;
        }
        if (rows[i].letter && rows[i].argument) {
            *short_options++ = ':';
        }
    }
    long_options[COUNT_OF(rows)] = (struct option){0};
    *short_options = '\0';
}

static const OptionRow *find_row(int val)
{
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        if (val == FIRST_VAL + (int)i || (rows[i].letter && val == rows[i].letter)) {
            return &rows[i];
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
    for (size_t i = 0; length > 2 && i < COUNT_OF(rows) && used < size; i++) {
        if (strncmp(word, "--", 2) == 0 && strncmp(word + 2, rows[i].name, length - 2) == 0) {
            used += (size_t)snprintf(list + used, size - used, "%s`--%s`", count > 0 ? ", " : "", rows[i].name);
            count++;
        }
    }
    return count > 1;
}

// What getopt could not make sense of.
static OptionsResult complain_getopt(Options *options, int val, char **argv)
{
    const OptionRow *row = find_row(optopt);
    const char *word = argv[optind - 1];
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
    return complain(options, "unknown option `%s`", optopt && optopt < FIRST_VAL ? letter : word);
}

static OptionsResult read_options(int argc, char **argv, Options *options)
{
    struct option long_options[MAX_ROWS];
    char short_options[2 * MAX_ROWS + 2];
    make_getopt_tables(long_options, short_options);
    opterr = 0;
    for (int val; (val = getopt_long(argc, argv, short_options, long_options, NULL)) != -1;) {
        const char *expected = "";
        const OptionRow *row = val == '?' || val == ':' ? NULL : find_row(val);
        if (!row) {
            return complain_getopt(options, val, argv);
        }
        if (!row->apply) {
            if (row->letter == 'h') {
                options_print_help(stdout);
            } else {
                printf("rtlang %s\n", rt_version());
            }
            return OPTIONS_DONE;
        }
        if (!row->apply(options, optarg, &expected)) {
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
    if (is_code(word)) {
        options->code = word;
    } else {
        options->action = ACTION_EXPLAIN_SCENE;
        options->scene = word;
    }
    return OPTIONS_GO;
}

// So that a complaint has its form even when it stands before the option.
static void find_format(int argc, char **argv, Options *options)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--diagnostics=json") == 0) {
            options->format = RT_FORMAT_JSON;
        }
    }
}

OptionsResult options_parse(int argc, char **argv, Options *options)
{
    *options = (Options){.width = 320,
                         .height = 240,
                         .encoding = {RT_DEPTH_AUTO, 0.0},
                         .antialias = {.threshold = 0.3},
                         .photons = 1000000};
    // No more paths and declarations than arguments.
    options->include_paths = calloc((size_t)argc + 1, sizeof *options->include_paths);
    options->declarations = calloc((size_t)argc + 1, sizeof *options->declarations);
    options->warnings = calloc((size_t)argc + 1, sizeof *options->warnings);
    options->read_folders = calloc((size_t)argc + 1, sizeof *options->read_folders);
    if (!options->include_paths || !options->declarations || !options->warnings || !options->read_folders) {
        return complain(options, "out of memory");
    }
    find_format(argc, argv, options);
    OptionsResult result = read_options(argc, argv, options);
    if (result != OPTIONS_GO) {
        return result;
    }
    if (options->action == ACTION_EXPLAIN) {
        return settle_explain(argc, argv, options);
    }
    if (optind == argc) {
        return complain(options, "no scene given");
    }
    if (optind + 1 < argc) {
        return complain(options, "more than one scene given: `%s` and `%s`", argv[optind], argv[optind + 1]);
    }
    options->scene = argv[optind];
    if (options->action == ACTION_TRACE_PIXEL &&
        (options->pixel_x >= options->width || options->pixel_y >= options->height)) {
        return complain(options, "pixel %d,%d is not in a picture of %d x %d pixels", options->pixel_x, options->pixel_y,
                        options->width, options->height);
    }
    return OPTIONS_GO;
}

void options_fini(Options *options)
{
    free(options->include_paths);
    free(options->declarations);
    free(options->warnings);
    free(options->read_folders);
}
