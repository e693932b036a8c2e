// What each option does with its argument, and the table that names them all.
//
// SPDX-License-Identifier: MIT
#include "cli/option_table.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/attributes.h"

static bool apply_output(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a file name";
    options->output = argument;
    return argument[0] != '\0';
}

static bool apply_warnings(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "all, error or the code of a warning";
    options->warnings[options->warning_count++] = (WarningOption){argument, reading->is_letter};
    return argument[0] != '\0';
}

// `-Wall` and the like begin with the same letter.
static bool apply_width(Options *options, const char *argument, OptionReading *reading)
{
    if (reading->is_letter && isalpha((unsigned char)argument[0])) {
        return apply_warnings(options, argument, reading);
    }
    return option_take_integer(reading, argument, 1, 65535, &options->width);
}

static bool apply_height(Options *options, const char *argument, OptionReading *reading)
{
    return option_take_integer(reading, argument, 1, 65535, &options->height);
}

static bool apply_threads(Options *options, const char *argument, OptionReading *reading)
{
    return option_take_integer(reading, argument, 1, 1024, &options->threads);
}

static bool apply_isa(Options *options, const char *argument, OptionReading *reading)
{
    static const char *const names[] = {"plain", "v2", "v3", "v4", NULL};
    reading->expected = "an instruction set of this processor: plain, or on x86-64 v2, v3 or v4";
    reading->choices = names;
    for (size_t i = 0; rt_isa(i); i++) {
        if (strcmp(argument, rt_isa(i)) == 0) {
            options->isa = rt_isa(i);
            return true;
        }
    }
    return false;
}

static bool apply_no_literals(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument;
    reading->expected = "";
    return options->no_literals = true;
}

static bool apply_lenient(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    return options->is_lenient = true;
}

static bool apply_whole(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->encoding.whole = 1;
    return true;
}

static bool apply_header(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a file name";
    options->header = argument;
    return argument[0] != '\0';
}

static bool apply_rerun(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "the file of a picture";
    options->rerun = argument;
    return argument[0] != '\0';
}

static bool apply_lsp(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->action = ACTION_SERVE;
    return true;
}

static bool apply_watch(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->action = ACTION_WATCH;
    return true;
}

static bool apply_include_path(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a folder";
    options->include_paths[options->include_path_count++] = argument;
    return argument[0] != '\0';
}

static bool apply_no_povray_includes(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument;
    reading->expected = "";
    return options->no_povray_includes = true;
}

static bool apply_declare(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "NAME=NUMBER, with a NAME that is not reserved";
    options->declarations[options->declaration_count++] = argument;
    return strchr(argument, '=') != NULL;
}

static bool apply_allow_read(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a folder";
    options->read_folders[options->read_folder_count++] = argument;
    return argument[0] != '\0';
}

static bool apply_allow_write(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a folder";
    options->write_folders[options->write_folder_count++] = argument;
    return argument[0] != '\0';
}

static bool apply_clock(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number";
    options->clock_given = true;
    return option_parse_number(argument, &options->clock);
}

// A..B, from 0 upward.
static bool apply_frames(Options *options, const char *argument, OptionReading *reading)
{
    Frames *frames = &options->frames;
    char first[16];
    const char *dots = strstr(argument, "..");
    size_t length = dots ? (size_t)(dots - argument) : sizeof first;
    reading->expected = "the first and the last frame, as 1..100";
    if (length >= sizeof first) {
        return false;
    }
    memcpy(first, argument, length);
    first[length] = '\0';
    bool fine = option_parse_integer(first, 0, 999999999, &frames->initial) &&
                option_parse_integer(dots + 2, frames->initial, 999999999, &frames->final);
    frames->first = frames->initial, frames->last = frames->final, frames->step = 1;
    return fine;
}

static bool apply_continue(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    return options->continues = true, true;
}

static bool apply_clock_from(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number";
    return option_parse_number(argument, &options->frames.clock_from);
}

static bool apply_clock_to(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number";
    return option_parse_number(argument, &options->frames.clock_to);
}

// By this word the command line is known for POV-Ray's before it is read.
static bool apply_povray(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    return options->is_povray = true;
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

static bool apply_max_steps(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a whole number from 1";
    return parse_limit(argument, "", UINT64_MAX, &options->limits[RT_LIMIT_STEPS]);
}

static bool apply_max_depth(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a whole number from 1 to 1000";
    return parse_limit(argument, "", 1000, &options->limits[RT_LIMIT_DEPTH]);
}

static bool apply_max_objects(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a whole number from 1";
    return parse_limit(argument, "", UINT64_MAX, &options->limits[RT_LIMIT_OBJECTS]);
}

static const char bytes_expected[] = "a number of bytes, as 500K, 64M, 2G or 1T";

static bool apply_max_text(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = bytes_expected;
    return parse_limit(argument, "KMGT", UINT64_MAX, &options->limits[RT_LIMIT_TEXT]);
}

static bool apply_max_memory(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = bytes_expected;
    return parse_limit(argument, "KMGT", UINT64_MAX, &options->limits[RT_LIMIT_MEMORY]);
}

static bool apply_max_messages(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = bytes_expected;
    return parse_limit(argument, "KMGT", UINT64_MAX, &options->limits[RT_LIMIT_MESSAGES]);
}

static bool apply_depth(Options *options, const char *argument, OptionReading *reading)
{
    static const struct {
        const char *name;
        rt_depth depth;
    } depths[] = {{"8", RT_DEPTH_8}, {"16", RT_DEPTH_16}, {"float", RT_DEPTH_FLOAT}};
    reading->expected = "8, 16 or float";
    for (size_t i = 0; i < RT_COUNT_OF(depths); i++) {
        if (strcmp(argument, depths[i].name) == 0) {
            options->encoding.depth = depths[i].depth;
            return true;
        }
    }
    return false;
}

static bool apply_file_gamma(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "srgb or a number above 0";
    char *end;
    double gamma = strcmp(argument, "srgb") == 0 ? 0.0 : strtod(argument, &end);
    options->encoding.file_gamma = gamma;
    return strcmp(argument, "srgb") == 0 || (end != argument && !*end && gamma > 0.0 && isfinite(gamma));
}

static bool parse_positive(const char *text, double *value)
{
    return option_parse_number(text, value) && *value > 0.0;
}

static bool apply_samples(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number from 1 to 16777216";
    return parse_positive(argument, &options->sampling.samples) && options->sampling.samples >= 1.0 &&
           options->sampling.samples <= 16777216.0;
}

static bool apply_seed(Options *options, const char *argument, OptionReading *reading)
{
    char *end;
    reading->expected = "a whole number from 0 to 18446744073709551615";
    errno = 0;
    options->sampling.seed = strtoull(argument, &end, 10);
    return argument[0] >= '0' && argument[0] <= '9' && !*end && errno == 0;
}

static bool parse_name(OptionReading *reading, const char *argument, const char *const *names, const char **name)
{
    int place;
    bool is_one = option_parse_choice(reading, argument, names, &place);
    *name = is_one ? names[place] : NULL;
    return is_one;
}

static bool apply_sampler(Options *options, const char *argument, OptionReading *reading)
{
    static const char *const names[] = {"sobol", "halton", "jittered", "grid", "random", NULL};
    reading->expected = "sobol, halton, jittered, grid or random";
    return parse_name(reading, argument, names, &options->sampling.sampler);
}

static bool apply_filter(Options *options, const char *argument, OptionReading *reading)
{
    static const char *const names[] = {"box", "tent", "gaussian", "mitchell", NULL};
    reading->expected = "box, tent, gaussian or mitchell";
    return parse_name(reading, argument, names, &options->sampling.filter);
}

static bool apply_adaptive(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->sampling.adaptive = 1;
    return true;
}

static bool apply_target_error(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number above 0";
    return parse_positive(argument, &options->sampling.target_error);
}

static bool apply_time_limit(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number of seconds above 0";
    return parse_positive(argument, &options->sampling.time_limit);
}

// The timer takes whole microseconds, and a year is as good as none.
static bool apply_max_time(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number of seconds from 0.001 to 31536000";
    return parse_positive(argument, &options->max_time) && options->max_time >= 0.001 &&
           options->max_time <= 31536000.0;
}

static bool apply_untrusted(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->is_untrusted = true;
    return true;
}

static bool apply_no_confinement(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->is_unconfined = options->has_no_readers = true;
    return true;
}

static bool apply_no_estimate(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->sampling.no_estimate = 1;
    return true;
}

static bool apply_method(Options *options, const char *argument, OptionReading *reading)
{
    static const char *const names[] = {[RT_METHOD_BACKWARD] = "backward", [RT_METHOD_FORWARD] = "forward",
                                        [RT_METHOD_FORWARD_CONNECT] = "forward-connect", NULL};
    int place;
    reading->expected = "backward, forward or forward-connect";
    bool is_one = option_parse_choice(reading, argument, names, &place);
    options->method = is_one ? (rt_method)place : RT_METHOD_BACKWARD;
    return is_one;
}

static bool apply_photons(Options *options, const char *argument, OptionReading *reading)
{
    double photons;
    reading->expected = "a number from 1 to 1e15, as 1000000 or 1e6";
    bool fine = parse_positive(argument, &photons) && photons >= 1.0 && photons <= 1e15;
    options->photons = fine ? (uint64_t)photons : 0;
    return fine;
}

static bool apply_antialias(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "1 or 2";
    options->antialias.method = strcmp(argument, "2") == 0 ? 2 : 1;
    return strcmp(argument, "1") == 0 || strcmp(argument, "2") == 0;
}

static bool apply_antialias_depth(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a whole number from 1 to 9";
    options->antialias.depth = argument[0] - '0';
    return argument[0] >= '1' && argument[0] <= '9' && !argument[1];
}

static bool apply_antialias_threshold(Options *options, const char *argument, OptionReading *reading)
{
    char *end;
    reading->expected = "a number, 0 or more";
    options->antialias.threshold = strtod(argument, &end);
    return end != argument && !*end && options->antialias.threshold >= 0.0;
}

static bool apply_antialias_gamma(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number above 0";
    return parse_positive(argument, &options->antialias.gamma);
}

static bool apply_error_map(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a file name";
    options->error_map = argument;
    return argument[0] != '\0';
}

const OptionPlane option_planes[] = {{"error", RT_PLANE_ERROR},   {"samples", RT_PLANE_SAMPLES}, {"depth", RT_PLANE_DEPTH},
                                     {"normal", RT_PLANE_NORMAL}, {"object", RT_PLANE_OBJECT},   {"albedo", RT_PLANE_ALBEDO}};
const size_t option_plane_count = RT_COUNT_OF(option_planes);

static bool apply_planes(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "error, samples, depth, normal, object or albedo, or several with commas between";
    for (;;) {
        size_t length = strcspn(argument, ","), i = 0;
        while (i < option_plane_count && (strlen(option_planes[i].name) != length || strncmp(option_planes[i].name, argument, length) != 0)) {
            i++;
        }
        if (i == option_plane_count) {
            return false;
        }
        options->encoding.planes |= option_planes[i].plane;
        if (!argument[length]) {
            return true;
        }
        argument += length + 1;
    }
}

static bool apply_alpha(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->has_alpha = true;
    return true;
}

static bool apply_sky_light(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number from 0 to 1e6";
    return option_parse_number(argument, &options->sky_light) && options->sky_light >= 0.0 &&
           options->sky_light <= 1e6;
}

static bool apply_outline(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number from 0 to 16";
    return option_parse_number(argument, &options->outline) && options->outline >= 0.0 && options->outline <= 16.0;
}

static bool apply_depth_cue(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number from 0 to 1";
    return option_parse_number(argument, &options->depth_cue) && options->depth_cue >= 0.0 && options->depth_cue <= 1.0;
}

static bool apply_quiet(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->quiet = true;
    return true;
}

// I/N; whether I is one of N is said apart, since the numbers are fine.
static bool apply_part(Options *options, const char *argument, OptionReading *reading)
{
    char first[16];
    size_t length = strcspn(argument, "/");
    reading->expected = "a part and the number of parts, as 3/8";
    if (argument[length] != '/' || length >= sizeof first) {
        return false;
    }
    memcpy(first, argument, length);
    first[length] = '\0';
    return option_parse_integer(argument + length + 1, 1, 999999, &options->parts) &&
           option_parse_integer(first, 1, options->parts, &options->part);
}

static bool apply_mpi(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "tiles or scene";
    options->shares_scene = argument && strcmp(argument, "scene") == 0;
    return options->has_mpi = !argument || options->shares_scene || strcmp(argument, "tiles") == 0;
}

static bool apply_mpi_read(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "all or one";
    options->has_one_reader = strcmp(argument, "one") == 0;
    return options->has_one_reader || strcmp(argument, "all") == 0;
}

static bool apply_join(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    return options->joins = true;
}

static bool apply_checkpoint(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a number of seconds";
    return option_parse_number(argument, &options->checkpoint) && options->checkpoint >= 0.0;
}

// Also where no time is given: what is continued may be stopped again.
static bool apply_resume(Options *options, const char *argument, OptionReading *reading)
{
    const double usual = 60.0;
    (void)argument, (void)reading;
    options->checkpoint = options->checkpoint >= 0.0 ? options->checkpoint : usual;
    return options->resumes = options->continues = true;
}

static bool apply_check(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->action = options->action == ACTION_FORMAT ? ACTION_FORMAT_CHECK : ACTION_CHECK;
    return true;
}

static bool apply_format(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->action = options->action == ACTION_CHECK ? ACTION_FORMAT_CHECK : ACTION_FORMAT;
    return true;
}

static bool apply_budget(Options *options, const char *argument, OptionReading *reading)
{
    (void)argument, (void)reading;
    options->action = ACTION_BUDGET;
    return true;
}

static bool apply_diagnostics(Options *options, const char *argument, OptionReading *reading)
{
    static const char *const names[] = {[RT_FORMAT_TEXT] = "text", [RT_FORMAT_JSON] = "json", NULL};
    int place;
    reading->expected = "text or json";
    bool is_one = option_parse_choice(reading, argument, names, &place);
    options->format = is_one ? (rt_format)place : RT_FORMAT_TEXT;
    return is_one;
}

static bool apply_color(Options *options, const char *argument, OptionReading *reading)
{
    int place;
    reading->expected = "auto, always or never";
    bool is_one = option_parse_choice(reading, argument, color_choices, &place);
    options->color = is_one ? (ColorChoice)place : COLOR_AUTO;
    return is_one;
}

// A letter and four digits; everything else is the name of a scene.
bool option_is_code(const char *text)
{
    return strlen(text) == 5 && strchr("EeWw", text[0]) && strspn(text + 1, "0123456789") == 4;
}

static bool apply_explain(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "the code of a message, such as E0201";
    options->action = ACTION_EXPLAIN;
    options->code = argument;
    return !argument || option_is_code(argument);
}

static bool apply_dump(Options *options, const char *argument, OptionReading *reading)
{
    static const char *const names[] = {"tokens", "ast", "scene", NULL};
    static const Action actions[] = {ACTION_DUMP_TOKENS, ACTION_DUMP_AST, ACTION_DUMP_SCENE};
    int place;
    reading->expected = "tokens, ast or scene";
    bool is_one = option_parse_choice(reading, argument, names, &place);
    options->action = is_one ? actions[place] : options->action;
    return is_one;
}

static bool apply_precision(Options *options, const char *argument, OptionReading *reading)
{
    static const char *const names[] = {"double", "float", "quad", "reference", NULL};
    static const rt_precision precisions[] = {RT_PRECISION_DOUBLE, RT_PRECISION_FLOAT, RT_PRECISION_QUAD,
                                              RT_PRECISION_REFERENCE};
    int place;
    reading->expected = "float, double, quad or reference";
    bool is_one = option_parse_choice(reading, argument, names, &place);
    options->precision = is_one ? precisions[place] : RT_PRECISION_DOUBLE;
    return is_one;
}

// Two whole numbers; whether they lie in the picture is known when all options are read.
static bool apply_trace_pixel(Options *options, const char *argument, OptionReading *reading)
{
    char first[8];
    size_t length = strcspn(argument, ",");
    reading->expected = "the column and the row of a pixel, from 0, as 160,120";
    options->action = ACTION_TRACE_PIXEL;
    if (argument[length] == '\0' || length >= sizeof first) {
        return false;
    }
    memcpy(first, argument, length);
    first[length] = '\0';
    return option_parse_integer(first, 0, 65534, &options->pixel_x) &&
           option_parse_integer(argument + length + 1, 0, 65534, &options->pixel_y);
}

static bool apply_digits(Options *options, const char *argument, OptionReading *reading)
{
    return option_take_integer(reading, argument, 1, 17, &options->digits);
}

static bool apply_trace_svg(Options *options, const char *argument, OptionReading *reading)
{
    reading->expected = "a file name";
    options->trace_svg = argument;
    return argument[0] != '\0';
}

// LEFT,TOP,WIDTH,HEIGHT; whether that lies in the picture is known when all options are read.
static bool apply_crop(Options *options, const char *argument, OptionReading *reading)
{
    int *numbers[] = {&options->crop[0], &options->crop[1], &options->crop[2], &options->crop[3]};
    reading->expected = "left, top, width and height in pixels, as 0,0,160,120";
    for (int i = 0; i < 4; i++) {
        char number[8];
        size_t length = strcspn(argument, ",");
        if (length >= sizeof number || (argument[length] == ',') != (i < 3)) {
            return false;
        }
        memcpy(number, argument, length);
        number[length] = '\0';
        if (!option_parse_integer(number, i < 2 ? 0 : 1, 65535, numbers[i])) {
            return false;
        }
        argument += length + 1;
    }
    return true;
}

static const OptionRow rows[] = {
    {'o', "output", "FILE", apply_output,
     "write the picture to FILE, its format by the ending (- is PNG to standard output, -.ppm PPM, -.y4m the film of "
     "all frames; default: the scene's name with .png, in the current folder)"},
    {'W', "width", "PIXELS", apply_width, "width of the picture (default 320)"},
    {'H', "height", "PIXELS", apply_height, "height of the picture (default 240)"},
    {0, "target-error", "E", apply_target_error,
     "sample until the picture's error is below E: root mean square in linear light, with 95 % confidence"},
    {0, "check", NULL, apply_check, "read and evaluate the scene only; draw nothing"},
    {0, "crop", "L,T,W,H", apply_crop,
     "trace W x H pixels from column L and row T only; they are those of the whole picture"},
    {0, "whole", NULL, apply_whole,
     "with --crop: the picture has its whole size, and is black where it was not traced"},
    {0, "depth", "8|16|float", apply_depth, "bits of a stored value (default: float for EXR and HDR, else 8)"},
    {0, "file-gamma", "srgb|NUMBER", apply_file_gamma, "how values are stored (default srgb; 1 writes linear values)"},
    {0, "alpha", NULL, apply_alpha,
     "with a channel that tells where what is behind the scene is seen, as POV-Ray's `+UA`: "
     "no background, or its transmit and filter; the picture must be PNG, Targa or EXR"},
    {0, "planes", "LIST", apply_planes,
     "channels beside the light, in EXR: error and samples of sampled pictures; depth, normal, "
     "object (a number) and albedo (its colour) of what is seen; several with commas between"},
    {0, "error-map", "FILE", apply_error_map, "write the error of each pixel, too, as a grey picture in linear light"},
    {0, "sky-light", "STRENGTH", apply_sky_light,
     "light from all sides beside the scene's own: what a surface gets of it that nothing covers (default 0)"},
    {0, "outline", "WIDTH", apply_outline, "black lines around shapes, so many pixels wide (default 0)"},
    {0, "depth-cue", "STRENGTH", apply_depth_cue,
     "let far shapes turn to the colour of the background: so much of it at the farthest (default 0)"},
    {0, "samples", "N", apply_samples,
     "rays a pixel (default 1, through its middle); area lights are then sampled, too"},
    {0, "adaptive", NULL, apply_adaptive, "more rays where the error is; N of --samples is then the mean"},
    {0, "time-limit", "SECONDS", apply_time_limit,
     "sample as long as that; rounds are not begun that would take longer"},
    {0, "seed", "N", apply_seed, "another seed, another picture with the same mean (default 0)"},
    {0, "sampler", "NAME", apply_sampler, "sobol (default), halton, jittered, grid or random"},
    {0, "filter", "NAME", apply_filter, "how a pixel's rays are spread: box (default), tent, gaussian or mitchell"},
    {0, "no-estimate", NULL, apply_no_estimate, "do not compute the error of --samples; the picture is the same"},
    {0, "antialias", "1|2", apply_antialias,
     "more rays where colours differ, as POV-Ray's `+A -J` with `+AM1` or `+AM2`; not with --samples"},
    {0, "antialias-depth", "N", apply_antialias_depth,
     "1 to 9: N² more rays, or N - 1 partings in method 2 (default 3)"},
    {0, "antialias-threshold", "X", apply_antialias_threshold,
     "by how much red, green and blue must differ together (default 0.3)"},
    {0, "antialias-gamma", "G", apply_antialias_gamma, "compare colours after their 1/G-th power (default 2.5)"},
    {0, "frames", "A..B", apply_frames,
     "draw an animation: frames A to B, whose numbers stand in their pictures' names"},
    {'K', "clock", "NUMBER", apply_clock, "the scene's clock (default 0)"},
    {0, "clock-from", "NUMBER", apply_clock_from, "the clock of frame A (default 0)"},
    {0, "clock-to", "NUMBER", apply_clock_to, "the clock of frame B (default 1)"},
    {0, "continue", NULL, apply_continue, "do not draw the frames whose pictures are there"},
    {0, "rerun", "PICTURE", apply_rerun,
     "draw PICTURE, of PNG or EXR, again from SCENE with the options that its file keeps, "
     "and say whether the bytes are the same; the new file stays where -o names it"},
    {0, "checkpoint", "SECONDS", apply_checkpoint,
     "keep what is done, as often, beside the picture in PICTURE.checkpoint, and when the run is interrupted"},
    {0, "resume", NULL, apply_resume,
     "begin with what such a file has, if there is one; frames whose pictures are there are not drawn"},
    {0, "part", "I/N", apply_part, "trace part I of N of the picture, 1 to N, into PICTURE.part-I-of-N, for --join"},
    {0, "join", NULL, apply_join,
     "SCENE... are the files of all parts: make their picture, of the bytes that one run makes"},
    {0, "mpi", "[scene]", apply_mpi,
     "with mpirun: all ranks trace tiles of each picture, or draw frames of their own, and rank 0 writes; "
     "the bytes do not depend on their number; with scene, each rank holds a part of its spheres"},
    {0, "mpi-read", "all|one", apply_mpi_read,
     "of --mpi: each rank reads the scene's files (default), or rank 0 alone, which sends it to the others"},
    {'I', "include-path", "FOLDER", apply_include_path, "also look here for #include; may repeat, searched in order"},
    {0, "header", "FILE", apply_header, "include FILE before the scene's first statement"},
    {0, "no-povray-includes", NULL, apply_no_povray_includes,
     "do not look for #include where an installed POV-Ray has its files"},
    {'D', "declare", "NAME=NUMBER", apply_declare, "declare a name before the scene begins; may repeat"},
    {0, "lenient", NULL, apply_lenient,
     "leave out what POV-Ray has and rtlang has not, with a warning that also the picture's file keeps"},
    {0, "povray", NULL, apply_povray,
     "all other words are POV-Ray's, as they are when one of them begins with + or ends with .ini, or is KEY=VALUE"},
    {0, "untrusted", NULL, apply_untrusted,
     "for the scene of a stranger: small limits, 10 seconds, pictures in PNG only, and nothing "
     "is read but the scene's folder"},
    {0, "allow-read", "FOLDER", apply_allow_read,
     "let the scene read files below FOLDER too, besides its own folder and those of -I; may repeat"},
    {0, "allow-write", "FOLDER", apply_allow_write,
     "let the scene write files below FOLDER, and read them; else it writes none; may repeat"},
    {0, "max-time", "SECONDS", apply_max_time, "end a run that takes longer, all stages together; nothing is written"},
    {0, "max-memory", "BYTES", apply_max_memory,
     "memory of scene and picture (default: 1 GiB and 16 bytes for each byte of text, the "
     "picture apart, and together no more than there is)"},
    {0, "max-steps", "N", apply_max_steps, "turns of loops and macro calls, all together (default 30000000)"},
    {0, "max-depth", "N", apply_max_depth, "nesting of expressions, blocks, macro calls and includes (default 1000)"},
    {0, "max-objects", "N", apply_max_objects, "shapes in the scene (default 1000000000)"},
    {0, "max-text", "BYTES", apply_max_text, "text of all files of the scene (default 64G)"},
    {0, "max-messages", "BYTES", apply_max_messages, "text of #debug and its like (default 16M)"},
    {0, "no-confinement", NULL, apply_no_confinement,
     "do not let the kernel forbid what the program has no use for, to trace its system calls"},
    {0, "watch", NULL, apply_watch,
     "print the address of a page that shows the scene and draws it again at each save, and serve it, on this machine "
     "only, until interrupted; drawing ends at --target-error (default 0.002) or --time-limit (default 60)"},
    {0, "explain", "[CODE]", apply_explain,
     "print what the code of a message means; with a SCENE instead of a code what the scene "
     "takes and what it costs, and what is left out and why"},
    {0, "budget", NULL, apply_budget, "print how much memory rendering the scene takes at most, and stop"},
    {0, "trace-pixel", "X,Y", apply_trace_pixel,
     "print the life of the ray of one pixel, from 0,0 at the top left, and stop; no picture is made"},
    {0, "digits", "N", apply_digits,
     "with --trace-pixel: digits of its numbers, 1 to 17 (default: all that there are)"},
    {0, "trace-svg", "FILE", apply_trace_svg,
     "with --trace-pixel: draw the rays, too, as SVG, in the plane of the first one"},
    {0, "dump", "tokens|ast|scene", apply_dump, "print what a stage makes of the scene, and stop"},
    {0, "format", NULL, apply_format,
     "print the scene's text in the canonical layout, or write it to -o FILE; "
     "with --check tell whether it is in that layout"},
    {0, "lsp", NULL, apply_lsp,
     "serve an editor: messages, values, definitions, words and layout by the Language Server Protocol "
     "on standard input and output"},
    {0, "precision", "WHAT", apply_precision,
     "float, quad (float128) or reference (double): trace with the reference path, for study; "
     "it knows spheres, planes and plain lights, and is slow (default double, by the usual kernels)"},
    {0, "method", "NAME", apply_method,
     "backward (default), or for study photons from the lights: forward, forward-connect"},
    {0, "photons", "N", apply_photons, "photons of the forward methods (default 1e6)"},
    {0, "no-literals", NULL, apply_no_literals,
     "read and evaluate all text by the one general way, without what makes usual text faster; the scene is the same"},
    {0, "isa", "NAME", apply_isa,
     "instruction set to use: plain, v2, v3 or v4 (default: the best there is); the picture does not depend on it"},
    {'t', "threads", "N", apply_threads, "threads to use (default: all processors); the picture does not depend on it"},
    {0, "warnings", "WHAT", apply_warnings,
     "all: warn of more; error: take warnings for errors; a code, or no- and a code: "
     "turn one on or off; may repeat. -Wall, -Werror and -Wno-CODE are short for it"},
    {0, "diagnostics", "text|json", apply_diagnostics, "form of the messages (default text; json: an object a line)"},
    {0, "color", "WHEN", apply_color,
     "colour messages: always, never, or auto (default): on a terminal, unless NO_COLOR is set or it is dumb"},
    {'q', "quiet", NULL, apply_quiet, "no progress and no summary; messages about the scene stay"},
    {'V', "version", NULL, NULL, "print the version and stop"},
    {'h', "help", "[povray]", NULL,
     "print this and stop, or with `=povray` POV-Ray's options and what becomes of each"},
};
_Static_assert(RT_COUNT_OF(rows) <= OPTIONS_MOST, "enlarge OPTIONS_MOST");

static const OptionGroup groups[] = {
    {"What most runs need", "output"},
    {"The picture", "crop"},
    {"Samples and their error", "samples"},
    {"Anti-aliasing as POV-Ray does it", "antialias"},
    {"Animations, and pictures again", "frames"},
    {"Long runs and several machines", "checkpoint"},
    {"The scene's files and names", "include-path"},
    {"Limits, and scenes of strangers", "untrusted"},
    {"Looking into a scene", "watch"},
    {"For study", "precision"},
    {"Messages and the machine", "threads"},
};

const OptionTable option_table = {rows, RT_COUNT_OF(rows), groups, RT_COUNT_OF(groups)};
