// rtcheck: renders scenes with rtlang and with POV-Ray and says how far the pictures are apart.
//
// rtlang is used through its public header, as any program would; only reading and comparing pictures is shared inside.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "check/elsewhere.h"
#include "check/load.h"
#include "check/options.h"
#include "check/povray_range.h"
#include "peer/povray_run.h"
#include "check/report.h"
#include "check/report_about.h"
#include "check/report_html.h"
#include "check/report_scenes.h"
#include "check/say.h"
#ifdef WITH_STUDY
#include "check/stability.h"
#endif
#include "check/studies.h"
#include "image/image.h"
#include "rtlang/rtlang.h"

enum { EXIT_AGREE = 0, EXIT_DIFFER = 1, EXIT_USAGE = 2, EXIT_NO_TOOL = 3 };

typedef struct Check {
    const Options *options;
    char *povray;
    char **include_paths; // absolute; of them options->include_path_count were given
    int include_path_count;
    char folder[PATH_MAX]; // absolute; holds pictures and logs
    bool keeps_folder;
    ScenesReport *report; // NULL: none is requested
} Check;

// The files of one scene.
typedef struct Files {
    char *rtlang, *povray, *log;
} Files;

// Set by an interrupt: the handler has no other way to the loop over the scenes.
static volatile sig_atomic_t interrupted;

static void on_interrupt(int signal_number)
{
    (void)signal_number;
    interrupted = 1;
}

static bool files_init(Files *files, const Check *check, int number)
{
    const char *scene = check->options->scenes[number];
    const char *slash = strrchr(scene, '/');
    const char *name = slash ? slash + 1 : scene;

    *files = (Files){0};
    if (asprintf(&files->rtlang, "%s/%02d-%s.rtlang.png", check->folder, number + 1, name) < 0) {
        files->rtlang = NULL;
    }
    if (asprintf(&files->povray, "%s/%02d-%s.povray.png", check->folder, number + 1, name) < 0) {
        files->povray = NULL;
    }
    if (asprintf(&files->log, "%s/%02d-%s.povray.log", check->folder, number + 1, name) < 0) {
        files->log = NULL;
    }
    return files->rtlang && files->povray && files->log;
}

static void files_fini(Files *files)
{
    free(files->rtlang);
    free(files->povray);
    free(files->log);
}

typedef struct RtlangRun {
    rt_session *session;
    Outcome *outcome;
} RtlangRun;

// Keeps the first error as the outcome's detail.
static void on_diagnostic(void *client, const rt_diagnostic *diagnostic)
{
    RtlangRun *run = client;

    if (diagnostic->severity == RT_ERROR && run->outcome->detail[0] == '\0') {
        snprintf(run->outcome->detail, sizeof run->outcome->detail, "rtlang:\n%s", diagnostic->text);
    }
}

static void on_progress(void *client, double done)
{
    const RtlangRun *run = client;

    (void)done;
    if (interrupted != 0) {
        rt_cancel(run->session);
    }
}

static rt_status rtlang_steps(rt_session *session, const Check *check, const char *scene, const World *world,
                              const char *output)
{
    static const rt_output linear_16 = {.depth = RT_DEPTH_16, .file_gamma = 1.0};
    rt_status status = scene_load(session, check->options, check->include_paths, scene, world);

    if (status == RT_OK) {
        status = rt_render(session, check->options->threads);
    }
    return status == RT_OK ? rt_write(session, output, &linear_16) : status;
}

static void range_find(rt_session *session, Outcome *outcome)
{
    rt_range range;

    rt_get_range(session, &range);
    povray_range_describe(&range, outcome->range, sizeof outcome->range);
}

// The session stays, with the scene in it.
static bool rtlang_run(const Check *check, const char *output, RtlangRun *run)
{
    Outcome *outcome = run->outcome;
    rt_callbacks callbacks = {.client = run, .diagnostic = on_diagnostic, .progress = on_progress};
    double start = clock_seconds();
    rt_status status = RT_FAULT_LIMIT;

    run->session = rt_session_new(&callbacks);
    if (run->session) {
        status = rtlang_steps(run->session, check, outcome->scene, NULL, output);
    }
    outcome->rtlang_seconds = clock_seconds() - start;
    if (status == RT_OK) {
        range_find(run->session, outcome);
    }
    if (status != RT_OK && outcome->detail[0] == '\0') {
        snprintf(outcome->detail, sizeof outcome->detail, "rtlang failed with status %d", (int)status);
    }
    return status == RT_OK;
}

static bool povray_make(const Check *check, const Files *files, Outcome *outcome)
{
    const Options *options = check->options;
    PovrayJob job = {
        .program = check->povray,
        .scene = outcome->scene,
        .output = files->povray,
        .log = files->log,
        .include_paths = check->include_paths,
        .include_path_count = check->include_path_count,
        .width = options->width,
        .height = options->height,
        .clock = options->clock_given ? &options->clock : NULL,
        .threads = options->threads,
    };
    double start = clock_seconds();
    bool fine = povray_run(&job, outcome->detail, sizeof outcome->detail);

    outcome->povray_seconds = clock_seconds() - start;
    return fine;
}

static bool picture_read(const Options *options, const char *path, Image *image, Outcome *outcome)
{
    uint64_t pixels = (uint64_t)options->width * (uint64_t)options->height;
    ImageError error = {.no_memory = false};
    bool fine = image_read(path, pixels, image, &error) == IMAGE_OK;

    if (!fine) {
        snprintf(outcome->detail, sizeof outcome->detail, "cannot read %s: %s", path, error.detail);
    }
    return fine;
}

// Stored values are whole steps of 1/65535, but read as rounded floats: the threshold is put half way to the next step,
// so that a difference of just so many steps is on the right side of it.
static double threshold_between_steps(double threshold)
{
    double whole = threshold * 65535.0;
    double nearest = round(whole);
    bool is_whole = fabs(whole - nearest) <= 1e-9 * nearest; // 2/65535 as a double, or as decimals

    return ((is_whole ? nearest : floor(whole)) + 0.5) / 65535.0;
}

// Whether few enough pixels are beyond the threshold, but for those that are excused.
static void outcome_judge(const Options *options, uint64_t excused, Outcome *outcome)
{
    const ImageDifference *difference = &outcome->difference;
    uint64_t left = difference->pixels_beyond[BEYOND_THRESHOLD] - excused;

    outcome->agrees = (double)left <= options->ties * (double)difference->pixels;
}

static void pictures_compare(const Options *options, const Image *ours, const Image *theirs, Outcome *outcome)
{
    const double thresholds[IMAGE_THRESHOLDS] = {
        [BEYOND_THRESHOLD] = threshold_between_steps(options->threshold),
        [BEYOND_CODE_16] = threshold_between_steps(1.0 / 65535.0),
        [BEYOND_CODE_8] = threshold_between_steps(1.0 / 255.0),
    };

    if (ours->width != theirs->width || ours->height != theirs->height) {
        snprintf(outcome->detail, sizeof outcome->detail, "pictures of %dx%d and %dx%d cannot be compared", ours->width,
                 ours->height, theirs->width, theirs->height);
    } else if (!image_compare(ours, theirs, thresholds, &outcome->difference) ||
               !image_flip(ours, theirs, &outcome->flip)) {
        snprintf(outcome->detail, sizeof outcome->detail, "out of memory");
    } else {
        outcome->compared = true;
        outcome_judge(options, 0, outcome);
    }
}

// Of the pixels that are beyond the threshold and not yet marked, marks those in which a picture at `path` differs from
// ours by more than that; returns how many.
static uint64_t doubts_mark(const Check *check, const Image *ours, const Image *theirs, const char *path, bool *marked)
{
    double threshold = threshold_between_steps(check->options->threshold);
    Outcome unused = {0};
    Image other = {0};
    uint64_t count = 0;

    if (picture_read(check->options, path, &other, &unused)) {
        for (size_t i = 0; i < (size_t)ours->width * (size_t)ours->height; i++) {
            if (!marked[i] && image_pixel_difference(ours, theirs, i) > threshold &&
                image_pixel_difference(ours, &other, i) > threshold) {
                marked[i] = true;
                count++;
            }
        }
    }
    image_fini(&other);
    return count;
}

// A picture of the scene put elsewhere is the same but for rounding.
static bool moved_run(const Check *check, const char *scene, int number, const char *output)
{
    static const rt_callbacks silent = {0};
    World world = world_beside(1.0, 1.0 + 0.1 * number);
    rt_session *session = rt_session_new(&silent);
    bool fine = session && rtlang_steps(session, check, scene, &world, output) == RT_OK;

    rt_session_free(session);
    return fine;
}

// Takes pixels out of the judgement that rounding decides, which is not the same in two programs.
static void doubts_find(const Check *check, const Image *ours, const Image *theirs, Outcome *outcome)
{
    char scratch[PATH_MAX + 16];
    bool *marked = calloc((size_t)ours->width * (size_t)ours->height, sizeof *marked);

    snprintf(scratch, sizeof scratch, "%s/again.png", check->folder);
    for (int i = 0; marked && i < check->options->doubts && interrupted == 0; i++) {
        if (moved_run(check, outcome->scene, i, scratch)) {
            outcome->decided_by_rounding += doubts_mark(check, ours, theirs, scratch, marked);
        }
    }
    unlink(scratch);
    free(marked);
    outcome_judge(check->options, outcome->decided_by_rounding, outcome);
}

// Takes pixels out of the judgement in which POV-Ray does not agree with itself.
static void elsewhere_find(const Check *check, const Image *ours, const Image *theirs, Outcome *outcome)
{
    ElsewhereJob job = {.options = check->options,
                        .scene = outcome->scene,
                        .povray = check->povray,
                        .folder = check->folder,
                        .include_paths = check->include_paths,
                        .include_path_count = check->include_path_count,
                        .threshold = threshold_between_steps(check->options->threshold)};

    outcome->povray_elsewhere = elsewhere_count(&job, ours, theirs);
    outcome_judge(check->options, outcome->povray_elsewhere, outcome);
    if (!outcome->agrees) {
        outcome->larger = elsewhere_larger(&job, ours, theirs);
    }
}

// False when the report cannot be written.
static bool scene_check(const Check *check, int number, Outcome *outcome)
{
    Image ours = {0}, theirs = {0};
    RtlangRun run = {.outcome = outcome};
    bool fine = true;
    Files files;

    *outcome = (Outcome){.scene = check->options->scenes[number], .larger = -1};
    if (!files_init(&files, check, number)) {
        snprintf(outcome->detail, sizeof outcome->detail, "out of memory");
    } else if (rtlang_run(check, files.rtlang, &run) && povray_make(check, &files, outcome) &&
               picture_read(check->options, files.rtlang, &ours, outcome) &&
               picture_read(check->options, files.povray, &theirs, outcome)) {
        pictures_compare(check->options, &ours, &theirs, outcome);
        if (outcome->compared && !outcome->agrees && check->options->doubts > 0) {
            doubts_find(check, &ours, &theirs, outcome);
        }
        if (outcome->compared && !outcome->agrees && check->options->elsewhere > 0) {
            elsewhere_find(check, &ours, &theirs, outcome);
        }
    }
    if (check->report && interrupted == 0) {
        fine = scenes_report_add(check->report, outcome, check->options, run.session, &ours, &theirs);
    }
    rt_session_free(run.session);
    image_fini(&ours);
    image_fini(&theirs);
    files_fini(&files);
    return fine;
}

static int report_complain(const Options *options, const char *path)
{
    say(options, "cannot write the report %s: %s", path, strerror(errno));
    return EXIT_USAGE;
}

static int scenes_check(const Check *check)
{
    const Options *options = check->options;
    int exit_code = EXIT_AGREE;

    for (int i = 0; i < options->scene_count && interrupted == 0; i++) {
        Outcome outcome;

        if (!scene_check(check, i, &outcome)) {
            return report_complain(options, options->report);
        }
        if (interrupted != 0) {
            break;
        }
        (options->json ? report_json : report_text)(stdout, &outcome);
        fputs(options->json ? "\n" : "", stdout);
        fflush(stdout);
        if (!outcome.agrees) {
            exit_code = EXIT_DIFFER;
        }
    }
    return interrupted != 0 ? 128 + SIGINT : exit_code;
}

static bool report_print_page(const Check *check, const char *path)
{
    const Options *options = check->options;
    ReportPage *page = report_page_open(path);
    char bar[128];
    bool fine;

    if (!page) {
        return false;
    }
    snprintf(bar, sizeof bar,
             "A scene of %d x %d pixels agrees when at most %g %% of them differ by more than %g/65535.",
             options->width, options->height, 100.0 * options->ties, report_steps(options->threshold));
    fine = scenes_report_print(check->report, page, bar);
    report_about(page, options, check->povray, check->folder);
    return report_page_close(page) && fine;
}

static bool report_print_json(const Check *check, const char *path)
{
    FILE *out = fopen(path, "wb");

    if (!out) {
        return false;
    }
    scenes_report_json(check->report, out);
    bool fine = ferror(out) == 0;
    return fclose(out) == 0 && fine;
}

static int report_write(const Check *check, int exit_code)
{
    char page[PATH_MAX], results[PATH_MAX];

    snprintf(page, sizeof page, "%s/index.html", check->options->report);
    snprintf(results, sizeof results, "%s/results.json", check->options->report);
    if (!report_print_page(check, page)) {
        return report_complain(check->options, page);
    }
    if (check->options->json && !report_print_json(check, results)) {
        return report_complain(check->options, results);
    }
    return exit_code;
}

// All scenes and what is reported of them. What was done before an interrupt is in the report.
static int scenes_report(Check *check)
{
    const char *folder = check->options->report;
    ScenesReport report;
    int exit_code;

    if (!folder) {
        return scenes_check(check);
    }
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        return report_complain(check->options, folder);
    }
    if (scenes_report_init(&report, check->options->scene_count)) {
        check->report = &report;
        exit_code = report_write(check, scenes_check(check));
    } else {
        exit_code = report_complain(check->options, folder);
    }
    scenes_report_fini(&report);
    check->report = NULL;
    return exit_code;
}

static int scenes_study(const Check *check)
{
    const Options *options = check->options;
    StudySettings settings = {.povray = check->povray,
                              .include_paths = check->include_paths,
                              .include_path_count = check->include_path_count,
                              .width = options->width,
                              .height = options->height,
                              .clock = options->clock_given ? &options->clock : NULL,
                              .folder = check->folder,
                              .repeats = 3,
                              .most_samples = options->most_samples,
                              .reference_samples = options->reference,
                              .race_width = options->race_width,
                              .race_height = options->race_height,
                              .seconds = options->budget,
                              .shows_progress = !options->json,
                              .only_race = options->race,
                              .interrupted = &interrupted};
    StudiesResult result = studies_run(options, &settings);

    if (result == STUDIES_UNWRITTEN) {
        return report_complain(options, options->report);
    }
    return interrupted != 0 ? 128 + SIGINT : result == STUDIES_FINE ? EXIT_AGREE : EXIT_DIFFER;
}

static bool folder_make(Check *check)
{
    const char *keep = check->options->keep;
    bool fine;

    check->keeps_folder = keep != NULL;
    if (keep) {
        fine = (mkdir(keep, 0777) == 0 || errno == EEXIST) && realpath(keep, check->folder);
    } else {
        fine = povray_make_folder(check->folder);
    }
    if (!fine) {
        say(check->options, "cannot make a folder for the pictures: %s", strerror(errno));
    }
    return fine;
}

// The folder is this run's own and flat.
static void folder_remove(const Check *check)
{
    DIR *folder = check->keeps_folder ? NULL : opendir(check->folder);
    const struct dirent *entry;

    if (!folder) {
        return;
    }
    while ((entry = readdir(folder))) {
        unlinkat(dirfd(folder), entry->d_name, 0); // fails for `.` and `..`, as it should
    }
    closedir(folder);
    rmdir(check->folder);
}

#ifdef WITH_STUDY
static bool stability_write(const Check *check, const Stability *stability)
{
    char path[PATH_MAX];
    const char *folder = check->options->report;
    ReportPage *page;
    bool fine;

    if (!folder) {
        return true;
    }
    snprintf(path, sizeof path, "%s/index.html", folder);
    page = (mkdir(folder, 0777) == 0 || errno == EEXIST) ? report_page_open(path) : NULL;
    if (!page) {
        return false;
    }
    fine = stability_page(stability, page);
    report_about(page, check->options, check->povray, check->folder);
    fine = report_page_close(page) && fine;
    snprintf(path, sizeof path, "%s/stability.json", folder);
    FILE *out = fine ? fopen(path, "wb") : NULL;
    if (!out) {
        return false;
    }
    stability_json(stability, out);
    fine = ferror(out) == 0;
    return fclose(out) == 0 && fine;
}

static int stability_check(Check *check)
{
    Stability *stability = calloc(1, sizeof *stability);
    int exit_code = EXIT_USAGE;

    if (stability && stability_measure(stability, check->options, check->povray, check->folder)) {
        check->options->json ? stability_json(stability, stdout) : stability_print(stability, stdout);
        exit_code = stability_holds(stability) ? EXIT_AGREE : EXIT_DIFFER;
        if (!stability_write(check, stability)) {
            exit_code = report_complain(check->options, check->options->report);
        }
    } else {
        say(check->options, "out of memory");
    }
    if (stability) {
        stability_fini(stability);
    }
    free(stability);
    return exit_code;
}
#else
static int stability_check(const Check *check)
{
    say(check->options, "built with --disable-study, so that --stability is not there");
    return EXIT_USAGE;
}
#endif

static int run(const Options *options)
{
    Check check = {.options = options};
    int exit_code = EXIT_USAGE;

    check.povray = povray_find_program(options->povray);
    if (!check.povray && !options->is_stability && !options->study) {
        say(options, "no program `%s` found (Debian: apt-get install povray)", options->povray);
        return EXIT_NO_TOOL;
    }
    check.include_paths = include_paths_find(options, &check.include_path_count);
    if (check.include_paths && folder_make(&check)) {
        exit_code = options->is_stability ? stability_check(&check)
                    : options->study      ? scenes_study(&check)
                                          : scenes_report(&check);
        folder_remove(&check);
    }
    include_paths_free(check.include_paths, check.include_path_count);
    free(check.povray);
    return exit_code;
}

int main(int argc, char **argv)
{
    struct sigaction action = {.sa_handler = on_interrupt};
    Options options;
    OptionsResult parsed = options_parse(argc, argv, &options);
    int exit_code = parsed == OPTIONS_DONE ? EXIT_AGREE : EXIT_USAGE;

    if (parsed == OPTIONS_GO) {
        sigaction(SIGINT, &action, NULL);
        sigaction(SIGTERM, &action, NULL);
        signal(SIGXFSZ, SIG_IGN); // what `ulimit -f` forbids is an error of writing
        exit_code = run(&options);
    }
    options_fini(&options);
    return exit_code;
}
