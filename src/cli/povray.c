// Turns POV-Ray's options, once they are read, into those of the program, and finds the files as POV-Ray does.
//
// SPDX-License-Identifier: MIT
#include "cli/povray.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/option_table.h"
#include "cli/povray_read.h"
#include "cli/share.h"

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

// ---- whether it is meant

// Whether the word behind this one is its argument: then it says nothing of its own.
static bool takes_next(const char *word)
{
    for (const OptionRow *row = option_table.rows; row < option_table.rows + option_table.count; row++) {
        bool takes = row->argument && row->argument[0] != '[';
        bool is_letter = row->letter && word[0] == '-' && word[1] == row->letter && word[2] == '\0';
        if (takes && (is_letter || (strncmp(word, "--", 2) == 0 && strcmp(word + 2, row->name) == 0))) {
            return true;
        }
    }
    return false;
}

static bool is_key_and_value(const char *word)
{
    size_t length = 0;
    while (isalnum((unsigned char)word[length]) || word[length] == '_') {
        length++;
    }
    return isalpha((unsigned char)word[0]) && word[length] == '=' && access(word, F_OK) != 0;
}

static bool is_ini(const char *word)
{
    size_t length = strcspn(word, "[");
    return word[0] != '-' && length > 4 && strncasecmp(word + length - 4, ".ini", 4) == 0;
}

bool povray_is_meant(int argc, char **argv)
{
    bool is_meant = argc > 0 && strcmp(base_name(argv[0]), "povray") == 0;
    for (int i = 1; i < argc && !is_meant; i++) {
        bool is_argument = i > 1 && takes_next(argv[i - 1]);
        is_meant = strcmp(argv[i], "--povray") == 0 || (argv[i][0] == '+' && isalpha((unsigned char)argv[i][1])) ||
                   (!is_argument && (is_ini(argv[i]) || is_key_and_value(argv[i])));
    }
    return is_meant;
}

// ---- the scene and its picture

// As it is, or with the ending that POV-Ray adds, here or in a folder of Library_Path. What is nowhere keeps its name.
static bool find_scene(Povray *povray)
{
    static const char *const endings[] = {"", ".pov", ".POV"};
    const PovraySettings *settings = &povray->settings;
    char name[PATH_MAX];
    struct stat status;
    bool has_ending = strchr(base_name(settings->input), '.') != NULL;
    for (size_t i = 0; i < (has_ending ? 1 : 3); i++) {
        bool fits = snprintf(name, sizeof name, "%s%s", settings->input, endings[i]) < (int)sizeof name;
        if (fits && povray_find(settings, name, povray->scene, sizeof povray->scene) &&
            stat(povray->scene, &status) == 0 && !S_ISDIR(status.st_mode)) {
            return true;
        }
    }
    return snprintf(povray->scene, sizeof povray->scene, "%s", settings->input) < (int)sizeof povray->scene;
}

static const char *ending_of(char type)
{
    static const struct {
        char type;
        const char *ending;
    } endings[] = {{'N', ".png"}, {'T', ".tga"}, {'C', ".tga"}, {'P', ".ppm"},
                   {'J', ".jpg"}, {'B', ".bmp"}, {'E', ".exr"}, {'H', ".hdr"}};
    size_t i = 0;
    while (endings[i].type != type) {
        i++;
    }
    return endings[i].ending;
}

// The name that POV-Ray gives: its ending is the format's, added where the name has another one; without a name the
// scene's, in the scene's folder, or in the one that is named.
static bool name_output(Povray *povray)
{
    const PovraySettings *settings = &povray->settings;
    const char *given = settings->output, *ending = ending_of(settings->type), *scene = base_name(settings->input);
    const char *dot = strrchr(scene, '.');
    int stem = dot && dot != scene ? (int)(dot - scene) : (int)strlen(scene), length;
    size_t size = sizeof povray->output, given_length = given ? strlen(given) : 0, ending_length = strlen(ending);
    if (given && strcmp(given, "-") == 0) {
        length = snprintf(povray->output, size, "-%s", ending);
    } else if (!given) {
        length = snprintf(povray->output, size, "%.*s%.*s%s", (int)(scene - settings->input), settings->input, stem,
                          scene, ending);
    } else if (given_length > 0 && given[given_length - 1] == '/') {
        length = snprintf(povray->output, size, "%s%.*s%s", given, stem, scene, ending);
    } else {
        bool has_ending = given_length > ending_length && strcmp(given + given_length - ending_length, ending) == 0;
        length = snprintf(povray->output, size, "%s%s", given, has_ending ? "" : ending);
    }
    return length < (int)size;
}

// ---- what is drawn

// The first and the last column or row, from 0; both are counted from 1, and below 1 they are shares.
static bool find_part(double start, double end, int size, int *first, int *count)
{
    int begin = start == 0.0 ? 1 : start < 1.0 ? (int)(start * size) + 1 : (int)start;
    int last = end < 0.0 ? size : end <= 1.0 ? (int)(end * size) : (int)end;
    *first = begin - 1;
    *count = last - begin + 1;
    return *count >= 1 && last <= size;
}

static rt_status follow_primitive(rt_session *session, const PovraySettings *settings, Options *options)
{
    int *crop = options->crop;
    options->width = settings->width;
    options->height = settings->height;
    if (!find_part(settings->start_column, settings->end_column, settings->width, &crop[0], &crop[2]) ||
        !find_part(settings->start_row, settings->end_row, settings->height, &crop[1], &crop[3])) {
        return rt_report(session, "E0708", "no pixel lies in the rows and columns that are asked for",
                         "they are counted from 1; a number below 1 is a share of the picture");
    }
    if (crop[2] == settings->width && crop[3] == settings->height) {
        crop[2] = 0; // all of it
    }
    options->encoding.whole = 1;
    return RT_OK;
}

// The number of a frame that may be said as a share of all.
static int frame_at(double where, const Frames *frames, int count)
{
    int frame = where < 1.0 ? (int)(where * count) : (int)where;
    return frame > frames->initial ? frame : frames->initial;
}

static void follow_frames(const PovraySettings *settings, Options *options)
{
    Frames *frames = &options->frames;
    if (settings->final_frame < 0 && settings->initial_frame == 1) {
        return;
    }
    frames->initial = settings->initial_frame;
    frames->final = settings->final_frame > frames->initial ? settings->final_frame : frames->initial;
    int count = frames->final - frames->initial + 1;
    frames->first = settings->subset_start > 0.0 ? frame_at(settings->subset_start, frames, count) : frames->initial;
    frames->last = settings->subset_end > 0.0 ? frame_at(settings->subset_end, frames, count) : frames->final;
    frames->step = settings->frame_step;
    frames->clock_from = settings->initial_clock;
    frames->clock_to = settings->final_clock;
    frames->final += settings->is_cyclic;
}

static void follow_picture(const PovraySettings *settings, Options *options)
{
    bool has_depths = settings->type == 'N' || settings->type == 'P';
    options->encoding.depth = has_depths && settings->bits > 8 ? RT_DEPTH_16 : RT_DEPTH_AUTO;
    options->encoding.file_gamma = settings->file_gamma;
    options->antialias = (rt_antialias){.method = settings->antialias ? settings->method : 0,
                                        .depth = settings->depth,
                                        .threshold = settings->threshold,
                                        .gamma = settings->antialias_gamma};
    options->has_alpha = settings->has_alpha;
    options->has_no_output = !settings->has_output;
    options->has_no_progress = !settings->verbose;
    options->threads = settings->threads;
    options->clock_given = !isnan(settings->clock);
    options->clock = settings->clock;
    options->header = settings->header;
}

// Folders and declarations, behind those of rtlang's own options.
static rt_status follow_lists(rt_session *session, const PovraySettings *settings, Options *options)
{
    size_t libraries = settings->library_count - settings->usual_count;
    const char **paths =
        realloc(options->include_paths, ((size_t)options->include_path_count + libraries + 1) * sizeof *paths);
    options->include_paths = paths ? paths : options->include_paths;
    const char **declarations =
        realloc(options->declarations,
                ((size_t)options->declaration_count + settings->declaration_count + 1) * sizeof *declarations);
    options->declarations = declarations ? declarations : options->declarations;
    if (!paths || !declarations) {
        return rt_report(session, "E0602", "out of memory reading options", NULL);
    }
    for (size_t i = settings->usual_count; i < settings->library_count; i++) {
        paths[options->include_path_count++] = settings->libraries[i];
    }
    for (size_t i = 0; i < settings->declaration_count; i++) {
        declarations[options->declaration_count++] = settings->declarations[i];
    }
    return RT_OK;
}

// ---- messages

// A name without a folder lies in the picture's.
static FILE *open_file(const Povray *povray, const char *name)
{
    char path[2 * PATH_MAX];
    const char *output = povray->output, *base = base_name(output);
    snprintf(path, sizeof path, "%.*s%s", strchr(name, '/') ? 0 : (int)(base - output), output, name);
    return fopen(path, povray->settings.appends ? "ae" : "we");
}

static rt_status open_files(rt_session *session, const Povray *povray, Voice *voice)
{
    _Static_assert((int)POVRAY_STREAMS == (int)VOICE_STREAMS, "the streams are the same");
    const PovraySettings *settings = &povray->settings;
    for (int i = 0; i < POVRAY_STREAMS; i++) {
        const char *name = settings->files[i];
        if (name && !(voice->files[i] = open_file(povray, name))) {
            char message[COMPLAINT_SIZE];
            snprintf(message, sizeof message, "cannot write `%.200s`: %s", name, strerror(errno));
            return rt_report(session, "E0505", message, NULL);
        }
        voice->is_mute[i] = !settings->consoles[i];
    }
    voice->has_no_warnings = settings->warning_level == 0;
    return RT_OK;
}

// Create_Ini; its name is the scene's where none was said.
static rt_status write_ini(rt_session *session, const Povray *povray)
{
    const char *name = povray->settings.create_ini, *scene = base_name(povray->settings.input),
               *dot = strrchr(scene, '.');
    char path[PATH_MAX], message[COMPLAINT_SIZE];
    if (!name) {
        return RT_OK;
    }
    int fits = name[0] ? snprintf(path, sizeof path, "%s", name)
                       : snprintf(path, sizeof path, "%.*s.ini", dot ? (int)(dot - scene) : PATH_MAX, scene);
    errno = ENAMETOOLONG;
    if (fits < (int)sizeof path && povray_write_ini(&povray->settings, path)) {
        return RT_OK;
    }
    snprintf(message, sizeof message, "cannot write `%.200s`: %s", path, strerror(errno));
    return rt_report(session, "E0505", message, NULL);
}

static rt_status check_scene(rt_session *session, const Povray *povray)
{
    const PovrayPlace *place = &povray->settings.input_place;
    char message[PATH_MAX + 32];
    struct stat status;
    if (strcmp(povray->scene, "-") == 0 || stat(povray->scene, &status) == 0 || errno != ENOENT) {
        return RT_OK; // loading it reports the rest
    }
    snprintf(message, sizeof message, "scene file `%s` not found", povray->scene);
    return rt_report_in(session, "E0501", place->name, place->text, place->begin, place->end, message, NULL);
}

static void say_what_is_drawn(const Povray *povray, const Options *options, Voice *voice)
{
    char text[2 * PATH_MAX + 64];
    bool is_stream = povray->output[0] == '-' && strchr(".", povray->output[1]);
    const char *output = is_stream ? "standard output" : povray->output;
    int length = snprintf(text, sizeof text, "%s: %d by %d%s%s\n", povray->scene, options->width, options->height,
                          options->has_no_output ? "" : " to ", options->has_no_output ? "" : output);
    voice_say(voice, VOICE_RENDER, text, (size_t)length);
}

// ---- the whole

static rt_status follow(rt_session *session, Povray *povray, Options *options, Voice *voice)
{
    const PovraySettings *settings = &povray->settings;
    if (!settings->input) {
        return rt_report(session, "E0708", "no scene is named", "a word that ends with .pov, or +I, names one");
    }
    if (settings->has_alpha && !strchr("NTE", settings->type)) {
        return rt_report(session, "E0708", "`Output_Alpha` wants a picture in PNG, Targa or OpenEXR",
                         "+FN, +FT or +FE says so");
    }
    if (!find_scene(povray) || !name_output(povray)) {
        return rt_report(session, "E0708", "the name of the scene or of its picture is too long", NULL);
    }
    options->scenes[options->scene_count++] = povray->scene;
    options->output = povray->output;
    follow_picture(settings, options);
    follow_frames(settings, options);
    rt_status status = follow_primitive(session, settings, options);
    status = status ? status : follow_lists(session, settings, options);
    status = status ? status : write_ini(session, povray);
    status = status ? status : open_files(session, povray, voice);
    status = status ? status : check_scene(session, povray);
    if (!status) {
        say_what_is_drawn(povray, options, voice);
    }
    return status;
}

// Words of the X window system, which POV-Ray takes for its preview; the first ones have an argument.
static bool is_of_window(const char *word, bool *has_argument)
{
    static const char *const words[] = {"-display", "-geometry", "-title", "-visual", "-icon", NULL};
    int i = choice_find(word, words);
    *has_argument = i >= 0 && i < 4;
    return i >= 0;
}

static bool asks_for_help(int argc, char **argv)
{
    static const char *const words[] = {"-h", "-H", "+h", "+H", "-?", "+?", "-help", "--help", NULL};
    return argc == 2 && choice_find(argv[1], words) >= 0;
}

OptionsResult povray_parse(rt_session *session, CommandLine line, Povray *povray, Options *options, Voice *voice,
                           rt_status *status)
{
    const int argc = line.argc;
    char **argv = line.argv;
    int own_count = 1;
    size_t count = 0;
    char **words = calloc(2 * (size_t)argc + 2, sizeof *words), **own = words + argc + 1;
    povray->words = words;
    povray_settings_init(&povray->settings);
    if (!words) {
        *status = rt_report(session, "E0602", "out of memory reading options", NULL);
        return OPTIONS_WRONG;
    }
    own[0] = argv[0];
    for (int i = 1; i < argc; i++) {
        bool has_argument;
        if (is_of_window(argv[i], &has_argument)) {
            i += has_argument;
        } else if (strncmp(argv[i], "--", 2) == 0) {
            own[own_count++] = argv[i];
        } else {
            words[count++] = argv[i];
        }
    }
    if (asks_for_help(argc, argv)) {
        povray_print_help(stdout);
        return OPTIONS_DONE;
    }
    OptionsResult result = options_read(own_count, own, options);
    options->is_povray = true;
    rt_set_format(session, options->format);
    if (result == OPTIONS_WRONG) {
        *status = rt_report(session, "E0703", options->reading.complaint,
                            options->reading.advice[0] ? options->reading.advice : NULL);
    }
    if (result == OPTIONS_GO && options->rerun) {
        *status =
            rt_report(session, "E0703", "`--rerun` does not go with POV-Ray's options", "its picture has its own");
    } else if (result == OPTIONS_GO) {
        *status = povray_read(session, &povray->settings, words, count);
        *status = *status ? *status : follow(session, povray, options, voice);
        if (!*status && share_settle(options) != OPTIONS_GO) {
            *status = rt_report(session, "E0703", options->reading.complaint, NULL);
        }
    }
    return *status ? OPTIONS_WRONG : result;
}

void povray_fini(Povray *povray)
{
    povray_settings_fini(&povray->settings);
    free(povray->words);
}
