// Runs the studies one after another and hands each to whoever prints it.
//
// SPDX-License-Identifier: MIT
#include "check/studies.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "check/report_about.h"
#include "check/say.h"
#include "check/study_print.h"

typedef struct Files {
    const char *folder; // NULL without --report, as is the rest
    ReportPage *page;
    FILE *csv, *json;
    int studies; // that were written
} Files;

static FILE *file_open(const Files *files, const char *name)
{
    char path[PATH_MAX];

    snprintf(path, sizeof path, "%s/%s", files->folder, name);
    return fopen(path, "wb");
}

static bool files_open(Files *files, const char *folder)
{
    char page[PATH_MAX];

    *files = (Files){.folder = folder};
    if (!folder) {
        return true;
    }
    snprintf(page, sizeof page, "%s/index.html", folder);
    if ((mkdir(folder, 0777) != 0 && errno != EEXIST) || !(files->page = report_page_open(page))) {
        return false;
    }
    files->csv = file_open(files, "study.csv");
    files->json = file_open(files, "study.json");
    return files->csv && files->json;
}

static bool stream_close(FILE *out)
{
    bool fine = !out || ferror(out) == 0;

    return (!out || fclose(out) == 0) && fine;
}

static bool files_close(Files *files)
{
    bool fine = stream_close(files->csv);

    if (files->json) {
        fputs(files->studies > 0 ? "]\n" : "[]\n", files->json);
    }
    fine = stream_close(files->json) && fine;
    return (!files->page || report_page_close(files->page)) && fine;
}

static bool files_add(Files *files, const Study *study)
{
    char name[32];
    int number = ++files->studies;

    if (!files->folder) {
        return true;
    }
    snprintf(name, sizeof name, "study-%d.svg", number);
    FILE *plot = study->has_methods ? file_open(files, name) : NULL;
    snprintf(name, sizeof name, "race-%d.svg", number);
    FILE *race = study->has_race ? file_open(files, name) : NULL;
    if ((study->has_methods && !plot) || (study->has_race && !race)) {
        stream_close(plot);
        stream_close(race);
        return false;
    }
    if (plot) {
        study_plot(study, plot, true);
    }
    if (race) {
        race_plot(&study->race, race, true);
    }
    study_print_csv(study, files->csv, number == 1);
    fputs(number == 1 ? "[" : ",\n", files->json);
    study_print_json(study, files->json);
    study_print_section(study, files->page, number);
    bool fine = stream_close(plot);
    return stream_close(race) && fine;
}

static void study_say(const Study *study, bool as_json)
{
    (as_json ? study_print_json : study_print_text)(study, stdout);
    fputs(as_json ? "\n" : "", stdout);
    fflush(stdout);
}

// False when there is no study; it was said why.
static bool one_run(Study *study, const char *scene, const Options *options, const StudySettings *settings)
{
    bool fine = study_run(study, scene, settings);

    if (!fine) {
        say(options, "%s: %s", scene, study->fault);
    }
    return fine;
}

StudiesResult studies_run(const Options *options, const StudySettings *settings)
{
    Files files;
    RaceTotal total = {0};
    StudiesResult result = STUDIES_FINE;
    Study *study = malloc(sizeof *study);

    if (!study) {
        say(options, "out of memory");
        return STUDIES_FAILED;
    }
    bool fine = files_open(&files, options->report);
    for (int i = 0; fine && i < options->scene_count && *settings->interrupted == 0; i++) {
        if (one_run(study, options->scenes[i], options, settings)) {
            study_say(study, options->json);
            if (study->has_race) {
                race_total_add(&total, &study->race);
            }
            fine = files_add(&files, study);
        } else {
            result = STUDIES_FAILED;
        }
        study_fini(study);
    }
    if (!options->json) {
        study_print_total(&total, stdout);
    }
    if (fine && files.page) {
        study_print_total_section(&total, files.page);
        report_about(files.page, options, settings->povray, settings->folder);
    }
    fine = files_close(&files) && fine;
    free(study);
    return fine ? result : STUDIES_UNWRITTEN;
}
