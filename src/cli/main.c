// rtlang: reads a scene, traces it and writes a picture. A client of include/rtlang/rtlang.h and nothing else.
//
// SPDX-License-Identifier: MIT
#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/options.h"
#include "cli/progress.h"
#include "rtlang/rtlang.h"

enum { OUTPUT_BUFFER = 1 << 16 }; // more than --help says

// What an interrupt stops, and which one it was; at file scope, because a signal handler has no other way to them.
static rt_session *volatile interrupted_session;
static volatile sig_atomic_t interrupted_by;

static void on_interrupt(int signal_number)
{
    interrupted_by = signal_number;
    if (interrupted_session) {
        rt_cancel(interrupted_session);
    }
}

// Without SA_RESTART, so that waiting for a pipe ends; a second signal ends the program at once, as without a handler.
// A file that `ulimit -f` forbids is an error of writing, which is reported, instead of a signal.
static void hear_signals(void)
{
    struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = (int)SA_RESETHAND};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    signal(SIGXFSZ, SIG_IGN);
}

static void on_diagnostic(void *client, const rt_diagnostic *diagnostic)
{
    progress_end(client);
    fputs(diagnostic->text, stderr);
}

static void on_message(void *client, rt_stream stream, const char *text, size_t length)
{
    (void)stream;
    progress_end(client);
    fwrite(text, 1, length, stderr);
}

// What keeps the picture from getting nearer, however many samples are taken.
static const char *bias_cause(const rt_error *error)
{
    return error->bias_by_level > 0.5 * error->bias ? "max_trace_level" : "adc_bailout";
}

// What a run is at that is sampled; the session is the one that is running.
static void on_progress(void *client, double done)
{
    char note[160] = "";
    rt_error error;
    if (!((const Progress *)client)->enabled) {
        return;
    }
    rt_get_error(interrupted_session, &error);
    if (error.known && error.bias > error.high) {
        snprintf(note, sizeof note, "error %.2g at %.3g rays a pixel; more will not help: %s cuts rays", error.rmse,
                 error.samples, bias_cause(&error));
    } else if (error.known) {
        snprintf(note, sizeof note, "error %.2g at %.3g rays a pixel", error.rmse, error.samples);
    }
    progress_update(client, done, error.seconds_left, note);
}

static rt_status fail_usage(rt_session *session, const char *message)
{
    return rt_report(session, "E0703", message, "rtlang --help lists the options");
}

static rt_status fail_parse(rt_session *session, const Options *options)
{
    return options->advice[0] ? rt_report(session, "E0703", options->complaint, options->advice)
                              : fail_usage(session, options->complaint);
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

static rt_status configure(rt_session *session, const Options *options)
{
    const int *crop = options->crop;
    rt_status status = rt_set_size(session, options->width, options->height);
    if (!status && crop[2] > 0 && rt_set_crop(session, crop[0], crop[1], crop[2], crop[3])) {
        return fail_usage(session, "`--crop` wants a part that lies in the picture");
    }
    for (int i = 0; !status && i < options->include_path_count; i++) {
        status = rt_add_include_path(session, options->include_paths[i]);
    }
    status = status ? status : rt_set_povray_includes(session, !options->no_povray_includes);
    for (int i = 0; !status && i < options->read_folder_count; i++) {
        status = rt_allow_read(session, options->read_folders[i]);
    }
    for (int i = 0; !status && i < LIMIT_COUNT; i++) {
        status = options->limits[i] ? rt_set_limit(session, (rt_limit)i, options->limits[i]) : RT_OK;
    }
    rt_set_literals(session, !options->no_literals);
    status = status ? status : rt_set_load_threads(session, options->threads);
    if (!status && options->clock_given) {
        status = rt_set_clock(session, options->clock);
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
static rt_status print(rt_session *session, const char *text, rt_status status)
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
    return print(session, text, status);
}

static rt_status trace_pixel(rt_session *session, const Options *options)
{
    const char *text = "";
    rt_status status = rt_load_file(session, options->scene);
    if (!status && options->isa) {
        status = rt_set_isa(session, options->isa);
    }
    status = status ? status : rt_trace_pixel(session, options->pixel_x, options->pixel_y, &text);
    return status ? status : print(session, text, status);
}

static rt_status budget(rt_session *session, const Options *options)
{
    rt_budget b = {0};
    char text[512];
    rt_status status = rt_load_file(session, options->scene);
    status = status ? status : rt_get_budget(session, &b);
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
    return status ? status : print(session, text, status);
}

static rt_status explain(rt_session *session, const Options *options)
{
    const char *text;
    rt_status status = rt_explain(session, options->code, &text);
    if (status == RT_FAULT_USAGE) {
        return fail_argument(session, "`--explain`: no message has the code", options->code);
    }
    return print(session, text, status);
}

static rt_status explain_scene(rt_session *session, const Options *options)
{
    const char *text = "";
    rt_status status = rt_load_file(session, options->scene);
    if (!status && options->isa) {
        status = rt_set_isa(session, options->isa);
    }
    status = status ? status : rt_explain_scene(session, options->threads, &text);
    return status ? status : print(session, text, status);
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

static void print_summary(const rt_session *session, const char *output)
{
    rt_summary s;
    rt_get_summary(session, &s);
    char warnings[128] = "", beyond[64] = "";
    if (s.out_of_range > 0) {
        snprintf(beyond, sizeof beyond, ", %llu of them of the range of numbers", (unsigned long long)s.out_of_range);
    }
    if (s.warnings > 0) {
        snprintf(warnings, sizeof warnings, "; %llu warning%s%s", (unsigned long long)s.warnings,
                 s.warnings == 1 ? "" : "s", beyond);
    }
    fprintf(stderr,
            "%s: %dx%d, %llu object%s, %llu light%s; rays: %llu camera, %llu shadow, %llu reflected, %llu transmitted; "
            "seconds: parse %.3f, prepare %.3f, trace %.3f, write %.3f%s\n",
            strcmp(output, "-") == 0 ? "standard output" : output, s.width, s.height, (unsigned long long)s.objects,
            s.objects == 1 ? "" : "s", (unsigned long long)s.lights, s.lights == 1 ? "" : "s",
            (unsigned long long)s.camera_rays, (unsigned long long)s.shadow_rays, (unsigned long long)s.reflected_rays,
            (unsigned long long)s.transmitted_rays, s.parse_seconds, s.prepare_seconds, s.trace_seconds,
            s.write_seconds, warnings);
}

// "3 shapes of 0.02 pixels in all"; nothing for none. Returns how many.
static double put_unmet(char text[64], const char *word, double count, double area, bool is_about)
{
    char size[16];
    snprintf(size, sizeof size, "%.2g", area);
    text[0] = 0;
    if (count > 0.0) {
        snprintf(text, 64, "%s%.0f %s%s of %s pixel%s%s", is_about ? "about " : "", count, word,
                 count == 1.0 ? "" : "s", size, strcmp(size, "1") == 0 ? "" : "s", count == 1.0 ? "" : " in all");
    }
    return count;
}

// What no sample met, as the end of a line.
static void print_unmet(const rt_error *error)
{
    char shapes[64], highlights[64];
    double count = put_unmet(shapes, "shape", error->unmet_shapes, error->unmet_shape_area, error->unmet_are_about) +
                   put_unmet(highlights, "highlight", error->unmet_highlights, error->unmet_highlight_area,
                             error->unmet_are_about);
    if (count > 0.0) {
        fprintf(stderr, "; %s%s%s %s met by no sample", shapes, *shapes && *highlights ? " and " : "", highlights,
                count == 1.0 ? "was" : "were");
    }
}

// The error of a sampled picture, and why there is no less.
static void print_error(const rt_session *session, const Options *options)
{
    static const char *const ends[] = {[RT_END_DONE] = "", [RT_END_TARGET] = "; the target is reached",
                                       [RT_END_TIME] = "; the time is over",
                                       [RT_END_INTERRUPTED] = "; interrupted"};
    rt_error error;
    rt_get_error(session, &error);
    if (!error.known) {
        return;
    }
    fprintf(stderr, "error: rmse %.3g, with 95 %% confidence %.3g to %.3g, at %.17g %s a pixel%s%s", error.rmse,
            error.low, error.high, error.samples, options->method != RT_METHOD_BACKWARD ? "photons" : "samples",
            options->sampling.target_error > 0.0 && error.end != RT_END_TARGET ? "; the target is not reached" : "",
            ends[error.end]);
    print_unmet(&error);
    fputc('\n', stderr);
    if (options->method != RT_METHOD_BACKWARD) {
        rt_photons photons;
        rt_get_photons(session, &photons);
        fprintf(stderr, "photons: %llu, of which %llu met a surface; %llu arrivals on the film, one for %.3g photons\n",
                (unsigned long long)photons.emitted, (unsigned long long)photons.met,
                (unsigned long long)photons.arrived, (double)photons.emitted / (double)photons.arrived);
    }
    // Told where it alone could be more than all of the error that is known.
    if (error.missed_error > error.high) {
        fprintf(stderr, "missed: a detail of up to %.2g pixel%s may be in no sample, and would add up to %.2g\n",
                error.missed_area, error.missed_area == 1.0 ? "" : "s", error.missed_error);
    }
    if (error.bias > 0.0) {
        fprintf(stderr, "bias: rays cut by %s would add about %.2g in the mean%s\n", bias_cause(&error), error.bias,
                error.bias > error.high ? "; more samples will not help" : "");
    }
}

static rt_status set_sampling(rt_session *session, const Options *options)
{
    rt_set_alpha(session, options->has_alpha);
    rt_status status = rt_set_antialias(session, &options->antialias);
    rt_sampling sampling = options->sampling;
    sampling.no_pixel_errors = !options->error_map && !options->encoding.error_channel;
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

static rt_status check_output(rt_session *session, const Options *options, const char *output)
{
    rt_status status = rt_check_output(session, output, &options->encoding);
    if (status != RT_FAULT_USAGE) {
        return status;
    }
    return options->has_alpha && options->encoding.error_channel
               ? fail_usage(session, "a picture has `--alpha` or `--error-channel`, not both")
           : options->has_alpha              ? fail_usage(session, "`--alpha` wants a picture in PNG or EXR")
           : options->encoding.error_channel ? fail_usage(session, "`--error-channel` wants a picture in EXR")
                                             : status;
}

// Writes what there is to write, and tells of it.
static rt_status finish(rt_session *session, const Options *options, const char *output)
{
    rt_status status = rt_write(session, output, &options->encoding);
    if (!status && options->error_map) {
        status = rt_write_error(session, options->error_map);
    }
    if (status == RT_FAULT_USAGE) {
        return fail_usage(session,
                          options->encoding.error_channel
                              ? "`--error-channel` wants a sampled picture: `--samples` of 2 or more, or a goal"
                              : "`--error-map` wants a sampled picture: `--samples` of 2 or more, or a goal");
    }
    if (!status && !options->quiet && options->format == RT_FORMAT_TEXT) {
        print_summary(session, output);
        print_error(session, options);
    }
    return status;
}

static rt_status render(rt_session *session, const Options *options, Progress *progress)
{
    char default_name[PATH_MAX];
    const char *output = options->output;
    if (!output) {
        default_output(options->scene, default_name, sizeof default_name);
        output = default_name;
    }
    rt_status status = set_sampling(session, options);
    status = status ? status : check_output(session, options, output);
    status = status ? status : rt_load_file(session, options->scene);
    if (status) {
        return status;
    }
    progress_begin(progress, !options->quiet && options->format == RT_FORMAT_TEXT);
    status = rt_set_method(session, options->method, options->photons);
    status = status ? status : rt_set_precision(session, options->precision);
    if (status) {
        return fail_usage(session, "`--precision`: this rtlang was built with --disable-study");
    }
    status = options->isa ? rt_set_isa(session, options->isa) : RT_OK;
    rt_spend_scene(session);
    status = status ? status : rt_render(session, options->threads);
    progress_end(progress);
    int width, height;
    if (status == RT_CANCELLED && rt_pixels(session, &width, &height)) {
        rt_status written = finish(session, options, output);
        return written ? written : status;
    }
    return status ? status : finish(session, options, output);
}

static rt_status check(rt_session *session, const Options *options)
{
    return rt_load_file(session, options->scene);
}

static rt_status check_format(rt_session *session, const Options *options)
{
    return rt_check_format(session, options->scene);
}

static rt_status run(rt_session *session, const Options *options, Progress *progress)
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
    rt_status status = configure(session, options);
    if (status) {
        return status;
    }
    return options->action == ACTION_RENDER ? render(session, options, progress)
                                            : actions[options->action](session, options);
}

int main(int argc, char **argv)
{
    Options options;
    // --help waits there until `print` can say what went wrong. Never freed: it serves to the end of the program.
    char *buffer = malloc(OUTPUT_BUFFER);
    setvbuf(stdout, buffer, buffer ? _IOFBF : _IONBF, OUTPUT_BUFFER);
    OptionsResult parsed = options_parse(argc, argv, &options);
    Progress progress = {0};
    rt_callbacks callbacks = {&progress, on_diagnostic, on_message, on_progress};
    rt_session *session = rt_session_new(&callbacks);
    rt_status status = RT_FAULT_LIMIT;
    bool wrote = false;
    if (session) {
        bool is_colored = options.format == RT_FORMAT_TEXT && color_is_on(options.color);
        rt_set_format(session, is_colored ? RT_FORMAT_COLOR : options.format);
        interrupted_session = session;
        hear_signals();
        status = parsed == OPTIONS_WRONG  ? fail_parse(session, &options)
                 : parsed == OPTIONS_DONE ? print(session, "", RT_OK)
                                          : run(session, &options, &progress);
        int width, height;
        wrote = rt_pixels(session, &width, &height) != NULL;
        interrupted_session = NULL;
        rt_session_free(session);
    } else {
        fputs("rtlang: error[E0602]: out of memory\n", stderr);
    }
    bool tells = options.format == RT_FORMAT_TEXT;
    options_fini(&options);
    if (status == RT_CANCELLED) {
        fputs(!tells ? "" : wrote ? "rtlang: interrupted\n" : "rtlang: interrupted; nothing was written\n", stderr);
        return 128 + (int)interrupted_by;
    }
    return (int)status;
}
