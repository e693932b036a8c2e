// What the program does with one scene: the action that its options name, and messages about options that do not fit.
//
// SPDX-License-Identifier: MIT
#include "cli/run.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/confine.h"
#include "cli/frames.h"
#include "cli/lsp.h"
#include "cli/provenance.h"
#include "cli/share.h"
#include "cli/summary.h"
#include "rtlang/sharing.h"
#include "watch/watch.h"

enum { OUTPUT_NAME = PATH_MAX + 16 };

static rt_status fail_usage(rt_session *session, const char *message)
{
    return rt_report(session, "E0703", message, "rtlang --help lists the options");
}

// `-W abc`: as mistyped `-Wall`, or a width.
static rt_status fail_warning(rt_session *session, const WarningOption *option)
{
    static const char *const names[] = {"all", "error", NULL};
    char message[COMPLAINT_SIZE], advice[ADVICE_SIZE];
    snprintf(message, sizeof message, "option `--warnings` wants all, error or the code of a warning, found `%.80s`",
             option->what);
    advise_value(option->what, names, advice, sizeof advice);
    if (!advice[0] && !option->is_letter) {
        return fail_usage(session, message);
    }
    return rt_report(session, "E0703", message, advice[0] ? advice : "a width is a number, as in `-W 320`");
}

static rt_status fail_argument(rt_session *session, const char *expected, const char *found)
{
    char message[COMPLAINT_SIZE];
    snprintf(message, sizeof message, "option %s `%.80s`", expected, found);
    return fail_usage(session, message);
}

rt_status run_configure(rt_session *session, const Options *options)
{
    const int *crop = options->crop;
    if (options->is_untrusted) {
        rt_set_untrusted(session);
    }
    rt_status status = rt_set_size(session, options->width, options->height);
    if (!status && crop[2] > 0 && rt_set_crop(session, crop[0], crop[1], crop[2], crop[3])) {
        return fail_usage(session, "`--crop` wants a part that lies in the picture");
    }
    for (int i = 0; !status && i < options->include_path_count; i++) {
        status = rt_add_include_path(session, options->include_paths[i]);
    }
    if (!status && options->header) {
        status = rt_set_header(session, options->header);
    }
    if (!status && !options->is_untrusted) { // whose includes are found already: there are none
        status = rt_set_povray_includes(session, !options->no_povray_includes);
    }
    for (int i = 0; !status && i < options->read_folder_count; i++) {
        status = rt_allow_read(session, options->read_folders[i]);
    }
    for (int i = 0; !status && i < options->write_folder_count; i++) {
        status = rt_allow_write(session, options->write_folders[i]);
    }
    for (int i = 0; !status && i < LIMIT_COUNT; i++) {
        status = options->limits[i] ? rt_set_limit(session, (rt_limit)i, options->limits[i]) : RT_OK;
    }
    status = status ? status : rt_set_sky_light(session, (const double[]){options->sky_light, options->sky_light,
                                                                          options->sky_light});
    status = status ? status : rt_set_outline(session, options->outline, (const double[]){0.0, 0.0, 0.0});
    status = status ? status : rt_set_depth_cue(session, &(rt_depth_cue){.strength = options->depth_cue});
    // A copy of a program of several threads is none to work with.
    rt_set_readers(session, !options->has_no_readers && options->action != ACTION_WATCH);
    rt_set_literals(session, !options->no_literals);
    rt_set_lenient(session, options->is_lenient);
    status = status ? status : rt_set_load_threads(session, options->threads);
    if (!status && options->clock_given) {
        status = rt_set_clock(session, options->clock);
    }
    if (!status && options->frames.step) {
        status = frames_declare(&options->frames, options->frame, session);
    }
    for (int i = 0; !status && i < options->declaration_count; i++) {
        status = rt_declare(session, options->declarations[i]);
        if (status == RT_FAULT_USAGE) {
            return fail_argument(session, "`--declare` wants NAME=NUMBER, with a NAME that is not reserved, found",
                                 options->declarations[i]);
        }
    }
    for (int i = 0; !status && i < options->warning_count; i++) {
        status = rt_set_warning(session, options->warnings[i].what);
        if (status) {
            return fail_warning(session, &options->warnings[i]);
        }
    }
    return status;
}

// What stands in the buffer of standard output goes out, too.
rt_status run_print(rt_session *session, const char *text, rt_status status)
{
    errno = 0;
    if (fputs(text, stdout) == EOF || fflush(stdout) != 0 || ferror(stdout)) {
        char message[COMPLAINT_SIZE];
        snprintf(message, sizeof message, "cannot write standard output: %s", strerror(errno ? errno : EIO));
        return rt_report(session, "E0505", message, NULL);
    }
    return status;
}

// Prints a stage. What could be read is printed even when there were faults.
static rt_status dump(rt_session *session, const Options *options)
{
    const char *text = "";
    rt_status status;
    if (options->action == ACTION_DUMP_SCENE) {
        status = rt_load_file(session, options->scene);
        if (!status) {
            status = rt_dump_scene(session, &text);
        }
    } else {
        rt_syntax stage = options->action == ACTION_DUMP_TOKENS ? RT_SYNTAX_TOKENS : RT_SYNTAX_AST;
        status = rt_dump_syntax(session, stage, options->scene, &text);
    }
    return run_print(session, text, status);
}

static rt_status trace_pixel(rt_session *session, const Options *options)
{
    const char *text = "";
    rt_status status = rt_load_file(session, options->scene);
    if (!status && options->isa) {
        status = rt_set_isa(session, options->isa);
    }
    status = status ? status : rt_set_trace_form(session, RT_TRACE_LOG, options->digits);
    status = status ? status : rt_trace_pixel(session, options->pixel_x, options->pixel_y, &text);
    status = status ? status : run_print(session, text, status);
    if (status || !options->trace_svg) {
        return status;
    }
    status = rt_set_trace_form(session, RT_TRACE_SVG, options->digits);
    status = status ? status : rt_trace_pixel(session, options->pixel_x, options->pixel_y, &text);
    return status ? status : rt_write_text(session, options->trace_svg);
}

static rt_status budget(rt_session *session, const Options *options)
{
    rt_budget b = {0};
    char text[512];
    rt_status status = rt_load_file(session, options->scene);
    rt_status got = status && !options->shares_scene ? status : rt_get_budget(session, &b);
    status = status ? status : got;
    if (options->rank > 0) {
        return status; // rank 0 has what the greatest needs
    }
    snprintf(text, sizeof text,
             "objects          %15llu\n"
             "scene, bytes     %15llu\n"
             "tree, at most    %15llu\n"
             "picture          %15llu\n"
             "all, at most     %15llu\n"
             "limit            %15llu\n",
             (unsigned long long)b.objects, (unsigned long long)b.scene, (unsigned long long)b.prepared,
             (unsigned long long)b.picture, (unsigned long long)(b.scene + b.prepared + b.picture),
             (unsigned long long)b.limit);
    return status ? status : run_print(session, text, status);
}

static rt_status explain(rt_session *session, const Options *options)
{
    const char *text;
    rt_status status = rt_explain(session, options->code, &text);
    if (status == RT_FAULT_USAGE) {
        return fail_argument(session, "`--explain`: no message has the code", options->code);
    }
    return run_print(session, text, status);
}

static rt_status explain_scene(rt_session *session, const Options *options)
{
    const char *text = "";
    rt_status status = rt_load_file(session, options->scene);
    if (!status && options->isa) {
        status = rt_set_isa(session, options->isa);
    }
    status = status ? status : rt_explain_scene(session, options->threads, &text);
    return status ? status : run_print(session, text, status);
}

static rt_status format(rt_session *session, const Options *options)
{
    const char *text;
    rt_status status = rt_format_file(session, options->scene, &text);
    return status ? status : rt_write_text(session, options->output ? options->output : "-");
}

// The scene's name without folder and ending, with .png; that of standard input is stdin.png.
static void default_output(const char *scene, char *output, size_t size)
{
    const char *base = strrchr(scene, '/');
    base = strcmp(scene, "-") == 0 ? "stdin" : base ? base + 1 : scene;
    const char *dot = strrchr(base, '.');
    int length = dot && dot != base ? (int)(dot - base) : (int)strlen(base);
    snprintf(output, size, "%.*s.png", length, base);
}

static rt_status set_sampling(rt_session *session, const Options *options)
{
    rt_set_alpha(session, options->has_alpha);
    (void)rt_set_planes(session, options->encoding.planes); // bits of the option's own table
    rt_status status = rt_set_antialias(session, &options->antialias);
    rt_sampling sampling = options->sampling;
    sampling.no_pixel_errors = !options->error_map && !(options->encoding.planes & RT_PLANE_ERROR);
    if (status || rt_set_sampling(session, &sampling) == RT_OK) {
        return status;
    }
    return fail_usage(session, options->sampling.adaptive && options->sampling.samples == 0.0
                                   ? "`--adaptive` wants `--samples`, `--target-error` or `--time-limit`"
                               : options->sampling.no_estimate
                                   ? "adaptive sampling needs the estimate that `--no-estimate` turns off"
                               : options->sampling.adaptive || options->sampling.target_error > 0.0 ||
                                       options->sampling.time_limit > 0.0
                                   ? "adaptive sampling and goals want a sampler of sequences: sobol, halton or random"
                                   : "`--samples` wants a whole number, unless with `--adaptive` or a goal");
}

// Y4M holds all frames, of which a file for each would be a film of its own.
static bool is_film_in_parts(const Options *options, const char *output)
{
    size_t length = strlen(output);
    return options->frames.step && output[0] != '-' && length > 4 && strcmp(output + length - 4, ".y4m") == 0;
}

static rt_status check_output(rt_session *session, const Options *options, const char *output)
{
    if (is_film_in_parts(options, output)) {
        return fail_usage(session, "frames in Y4M go to standard output, as one film: `-o -.y4m`");
    }
    rt_status status = rt_check_output(session, output, &options->encoding);
    if (status != RT_FAULT_USAGE) {
        return status;
    }
    return options->encoding.planes ? fail_usage(session, "`--planes` wants a picture in EXR")
           : options->has_alpha     ? fail_usage(session, "`--alpha` wants a picture in PNG, Targa or EXR")
                                    : status;
}

static void say_summary(const rt_session *session, const Options *options, const char *output, Voice *voice)
{
    char *text = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&text, &length);
    if (out) {
        summary_print(out, session, output);
        summary_print_error(out, session, options);
        if (fclose(out) == 0) {
            voice_say(voice, VOICE_STATISTICS, text, length);
        }
        free(text);
    }
}

// `samples` a pixel were taken; 0: that is not known yet.
static rt_status set_provenance(rt_session *session, const Options *options, double samples)
{
    char *text = provenance_options(options, samples);
    rt_status status = text ? rt_set_provenance(session, text) : rt_report(session, "E0602", "out of memory", NULL);
    free(text);
    return status;
}

// Writes what there is to write, and tells of it.
static rt_status finish(rt_session *session, const Options *options, const char *output, Voice *voice)
{
    rt_error error;
    rt_get_error(session, &error);
    rt_status status = set_provenance(session, options, error.known ? error.samples : 0.0);
    status = status || options->has_no_output ? status : rt_write(session, output, &options->encoding);
    if (!status && options->error_map) {
        status = rt_write_error(session, options->error_map);
    }
    if (status == RT_FAULT_USAGE) {
        return fail_usage(session,
                          "`--error-map` wants a sampled picture: `--samples` of 2 or more, or a goal");
    }
    if (!status && !options->quiet && options->format == RT_FORMAT_TEXT) {
        say_summary(session, options, output, voice);
    }
    return status;
}

// Of --rerun: what was drawn beside what it is to repeat. It goes unless it has a name of its own.
static rt_status compare_again(rt_session *session, const Options *options, Voice *voice)
{
    char text[PATH_MAX + 64];
    rt_status status = provenance_compare(session, options->rerun, options->output);
    int length = snprintf(text, sizeof text, "%s: drawn again, the bytes are the same\n", options->rerun);
    if (!status && !options->quiet) {
        voice_say(voice, VOICE_STATISTICS, text, (size_t)length);
    }
    if (options->rerun_output) {
        (void)remove(options->rerun_output);
    }
    return status;
}

// Where the picture goes; `name` has room for it.
static const char *output_name(const Options *options, char name[OUTPUT_NAME])
{
    char default_name[PATH_MAX];
    const char *output = options->output;
    if (!output) {
        default_output(options->scene, default_name, sizeof default_name);
        output = default_name;
    }
    if (options->frames.step) {
        frames_name(&options->frames, options->frame, output, name, OUTPUT_NAME);
    } else {
        snprintf(name, OUTPUT_NAME, "%s", output);
    }
    return name;
}

bool run_has_frame(const Options *options)
{
    char name[OUTPUT_NAME];
    struct stat status;
    return stat(output_name(options, name), &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0;
}

static rt_status write_part(rt_session *session, const Options *options, const char *output, Voice *voice)
{
    char *name = share_part_name(options, output);
    rt_status status = name ? rt_write_part(session, name) : rt_report(session, "E0602", "out of memory", NULL);
    if (!status && !options->quiet && options->format == RT_FORMAT_TEXT) {
        say_summary(session, options, name, voice);
    }
    free(name);
    return status;
}

// Of a scene that is loaded.
static rt_status draw(rt_session *session, Options *options, const char *output, Voice *voice)
{
    progress_begin(&voice->progress, !options->quiet && !options->has_no_progress && options->format == RT_FORMAT_TEXT);
    rt_status status = rt_render(session, options->threads);
    progress_end(&voice->progress);
    if (share_has_ranks(options) && status && status != RT_CANCELLED) {
        rt_stop_ranks(session, (int)status); // the others would wait
    }
    if (share_has_ranks(options) && options->rank > 0) {
        return status;
    }
    int width, height;
    bool is_late = *voice->interrupted_by == SIGALRM; // then nothing is written
    options->has_kept = status == RT_CANCELLED && share_keeps(options);
    if (status == RT_CANCELLED && !is_late && !options->has_kept && options->parts == 0 &&
        rt_pixels(session, &width, &height)) {
        rt_status written = finish(session, options, output, voice);
        return written ? written : status;
    }
    status = status               ? status
             : options->parts > 0 ? write_part(session, options, output, voice)
                                  : finish(session, options, output, voice);
    if (!status) {
        share_done(options, output);
    }
    return !status && options->rerun ? compare_again(session, options, voice) : status;
}

static rt_status load_scene(rt_session *session, const Options *options)
{
    bool is_sent = share_has_ranks(options) && options->has_one_reader;
    return is_sent ? rt_load_file_of_ranks(session, options->scene) : rt_load_file(session, options->scene);
}

static rt_status render(rt_session *session, Options *options, Voice *voice)
{
    char name[OUTPUT_NAME];
    const char *output = output_name(options, name);
    bool is_silent = share_has_ranks(options) && options->rank > 0; // another rank writes
    rt_status status = set_sampling(session, options);
    status = status || options->has_no_output || is_silent ? status : check_output(session, options, output);
    status = status ? status : set_provenance(session, options, 0.0);
    status = status ? status : share_set(session, options, output);
    if (!status && options->keeps_scene) {
        status = rt_expect_frames(session);
    }
    status = status ? status : load_scene(session, options);
    status = status ? status : rt_set_method(session, options->method, options->photons);
    status = share_agree(session, options, voice, status);
    if (status) {
        return status;
    }
    if (rt_set_precision(session, options->precision)) {
        return fail_usage(session, "`--precision`: this rtlang was built with --disable-study");
    }
    status = options->isa ? rt_set_isa(session, options->isa) : RT_OK;
    if (!options->keeps_scene) {
        rt_discard_scene(session);
    }
    return status ? status : draw(session, options, output, voice);
}

rt_status run_frame(rt_session *session, Options *options, Voice *voice, bool *is_drawn)
{
    char name[OUTPUT_NAME];
    int is_set;
    *is_drawn = false;
    rt_status status = frames_set(&options->frames, options->frame, session, &is_set);
    if (status || !is_set) {
        return status;
    }
    *is_drawn = true;
    const char *output = output_name(options, name);
    status = options->has_no_output ? RT_OK : check_output(session, options, output);
    status = status ? status : set_provenance(session, options, 0.0);
    status = status ? status : share_set(session, options, output);
    return status ? status : draw(session, options, output, voice);
}

static rt_status check(rt_session *session, const Options *options)
{
    return rt_load_file(session, options->scene);
}

static rt_status check_format(rt_session *session, const Options *options)
{
    return rt_check_format(session, options->scene);
}

// The folder of a file, to be freed; NULL when out of memory.
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return !slash ? strdup(".") : strndup(path, slash == path ? 1 : (size_t)(slash - path));
}

// From here on the kernel forbids what neither this run nor those after it, of further scenes and frames, have a use
// for: pictures of frames are all in one folder, and the folders of include files are those of all scenes.
static rt_status confine_runs(rt_session *session, Options *options)
{
    const char *output = options->output ? options->output : options->action == ACTION_RENDER ? "./output.png" : NULL;
    char *kept = output ? share_checkpoint_name(options, output) : NULL; // in the folder of parts, too
    const char *path, *writes[] = {output, options->error_map, options->trace_svg, kept};
    bool writes_file = options->action == ACTION_RENDER || options->action == ACTION_FORMAT || options->trace_svg;
    size_t count = 0, folders = 0, scenes = (size_t)options->scene_count;
    while (rt_include_path(session, folders)) {
        folders++;
    }
    const char **reads = calloc(
        2 * scenes + 3 + folders + (size_t)options->read_folder_count + (size_t)options->joined_count, sizeof *reads);
    char **own = calloc(scenes + 1, sizeof *own);
    bool is_whole = reads && own;
    if (is_whole && options->resumes) {
        reads[count++] = own[scenes] = kept ? folder_of(kept) : NULL;
    }
    for (int i = 0; is_whole && i < options->joined_count; i++) {
        reads[count++] = options->joined[i];
    }
    for (size_t i = 0; is_whole && i < scenes; i++) {
        reads[count++] = options->scenes[i];
        reads[count++] = own[i] = folder_of(options->scenes[i]);
        is_whole = own[i] != NULL;
    }
    if (is_whole) {
        reads[count++] = options->header;
        reads[count++] = options->rerun;
        for (int i = 0; i < options->read_folder_count; i++) {
            reads[count++] = options->read_folders[i];
        }
        for (size_t i = 0; i < folders && (path = rt_include_path(session, i)); i++) {
            reads[count++] = path;
        }
        confine(&(Confinement){.reads = reads,
                               .read_count = count,
                               .writes = writes,
                               .write_count = writes_file ? RT_COUNT_OF(writes) : 0,
                               .folders = options->write_folders,
                               .folder_count = (size_t)options->write_folder_count,
                               .serves = options->action == ACTION_WATCH,
                               .is_strict = options->is_untrusted});
        options->is_unconfined = true; // the kernel holds to these rules: there are none to be added
    }
    rt_status status = is_whole ? RT_OK : rt_report(session, "E0602", "out of memory", NULL);
    for (size_t i = 0; own && i <= scenes; i++) {
        free(own[i]);
    }
    free(own);
    free(kept);
    free(reads);
    return status;
}

static rt_status configure_watched(rt_session *session, const void *options)
{
    return run_configure(session, options);
}

// What the page needs of the system is opened before the kernel forbids it; scenes are read after.
static rt_status watch(rt_session *session, Options *options, const Voice *voice)
{
    const char **include_paths = options->include_paths;
    WatchJob job = {.scene = options->scene,
                    .width = options->width,
                    .height = options->height,
                    .threads = options->threads,
                    .sampling = options->sampling,
                    .configure = configure_watched,
                    .client = options,
                    .interrupted_by = voice->interrupted_by,
                    .has_no_peer = options->is_untrusted,
                    .include_paths = include_paths,
                    .include_path_count = options->include_path_count,
                    .declarations = options->declarations,
                    .declaration_count = options->declaration_count,
                    .clock = options->clock_given ? &options->clock : NULL};
    char why[PATH_MAX], message[COMPLAINT_SIZE];
    Watch *watch = watch_open(&job, why, sizeof why);
    rt_status status = RT_OK;
    if (watch && !options->is_unconfined) {
        status = confine_runs(session, options);
    }
    snprintf(message, sizeof message, "%s\n", watch ? watch_address(watch) : "");
    status = watch && !status ? run_print(session, message, status) : status;
    if (!watch || (!status && !watch_run(watch))) {
        snprintf(message, sizeof message, "`--watch` cannot serve its page: %.400s", watch ? "no thread" : why);
        status = rt_report(session, "E0514", message, NULL);
    }
    watch_close(watch);
    return status;
}

rt_status run(rt_session *session, Options *options, Voice *voice)
{
    static rt_status (*const actions[])(rt_session *session, const Options *options) = {
        [ACTION_CHECK] = check,
        [ACTION_DUMP_TOKENS] = dump,
        [ACTION_DUMP_AST] = dump,
        [ACTION_DUMP_SCENE] = dump,
        [ACTION_EXPLAIN] = explain,
        [ACTION_EXPLAIN_SCENE] = explain_scene,
        [ACTION_FORMAT] = format,
        [ACTION_FORMAT_CHECK] = check_format,
        [ACTION_TRACE_PIXEL] = trace_pixel,
        [ACTION_BUDGET] = budget,
    };
    int rank, ranks;
    rt_status status = share_has_ranks(options) ? rt_join_ranks(session, &rank, &ranks) : RT_OK;
    if (!status && options->shares_scene) {
        status = rt_share_scene(session);
    }
    if (share_has_ranks(options)) {
        voice_hold(voice); // until the ranks agree
    }
    status = status ? status : run_configure(session, options);
    if (status) {
        return share_agree(session, options, voice, status);
    }
    if (options->action == ACTION_WATCH) {
        return watch(session, options, voice);
    }
    if (!options->is_unconfined && options->action != ACTION_EXPLAIN && options->action != ACTION_SERVE) {
        status = confine_runs(session, options);
    }
    if (status) {
        return status;
    }
    if (options->action == ACTION_SERVE) {
        return lsp_run(options) ? RT_FAULT_USAGE : RT_OK;
    }
    return options->action == ACTION_RENDER ? render(session, options, voice)
                                            : actions[options->action](session, options);
}
