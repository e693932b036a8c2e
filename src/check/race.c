// A race's runs: the size, the references, POV-Ray's settings in their order, rtlang's ladders.
//
// SPDX-License-Identifier: MIT
#include "check/race.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/clock.h"
#include "check/study_render.h"

enum {
    REFERENCE_DEPTH = 4, // of POV-Ray's, +R; 4 means 256 rays a pixel
    REFERENCE_SAMPLES = 256, // unless options say otherwise
    RUNS_MOST = 3,       // of a setting that is soon done
    SIDE_LEAST = 64,
    SIDE_MOST = 8192,
    SIZE_TRIES = 6,
    FIRST_WIDTH = 320, // from which pictures grow
    FIRST_HEIGHT = 240,
    PART_OF_ROWS = 4, // the middle quarter of the rows has POV-Ray's reference
};

static const double SHORTEST = 0.5; // seconds of POV-Ray's processor time
static const double SHORTEST_OF_BUDGET = 400.0; // less than that: a part of what is left
static const double ENOUGH = 1.0;   // a run that takes so long is not repeated

typedef struct Running {
    Race *race;
    StudySettings settings; // at the race's size
    Image povray;           // POV-Ray's reference; without values where the budget leaves it out
    double seconds_a_ray;   // POV-Ray's, of the processor
    double overhead;        // of a run of POV-Ray, seconds by the clock that are not tracing
    double stretch;         // seconds by the clock for one of the processor
} Running;

// Seconds by the clock that a run of POV-Ray takes.
static double povray_expected(const Running *running, double rays)
{
    return running->overhead + running->stretch * running->seconds_a_ray * rays;
}

// The root mean square in some rows.
static double distance_in(const Image *picture, const Image *reference, int first, int last)
{
    size_t width = (size_t)reference->width, begin = (size_t)first * width, end = (size_t)last * width;
    double sum = 0.0;

    for (size_t i = begin; i < end; i++) {
        for (size_t c = 0; c < 3; c++) {
            double a = (double)picture->values[(size_t)picture->channels * i + c];
            double b = (double)reference->values[(size_t)reference->channels * i + c];
            double off = fmin(fmax(a, 0.0), 1.0) - fmin(fmax(b, 0.0), 1.0);
            sum += off * off;
        }
    }
    return sqrt(sum / (3.0 * (double)(end - begin)));
}

// What is left of a distance when the reference's own error is taken off; NAN where that is most of it.
static double without_floor(double distance, double floor)
{
    return distance >= 1.5 * floor ? sqrt(distance * distance - floor * floor) : (double)NAN;
}

static void entry_judge(const Running *running, RaceEntry *entry, const Image *picture, bool is_povray)
{
    const Race *race = running->race;
    double whole = distance_in(picture, &race->picture, 0, race->height);
    double ours = distance_in(picture, &race->picture, race->first_row, race->last_row);
    double theirs = running->povray.values ? distance_in(picture, &running->povray, race->first_row, race->last_row)
                                           : (double)NAN;

    entry->errors[RACE_BY_RTLANG] = without_floor(whole, race->floor);
    entry->errors[RACE_BY_POVRAY] = theirs >= 2.0 * race->apart ? theirs : (double)NAN;
    entry->errors[RACE_BY_OTHER] = is_povray ? without_floor(ours, race->floor) : entry->errors[RACE_BY_POVRAY];
}

static void numbers_unset(RaceEntry *entry)
{
    for (int i = 0; i < RACE_TIMES; i++) {
        entry->seconds[i] = (double)NAN;
    }
    for (int i = 0; i < RACE_JUDGES; i++) {
        entry->errors[i] = (double)NAN;
    }
}

// ---- POV-Ray's runs

static bool povray_once(const Running *running, const RaceEntry *entry, int threads, PovrayRun *run)
{
    RaceSwitches switches;

    race_switches(entry, &switches);
    *run = (PovrayRun){.name = "race", .switches = switches.list, .threads = threads};
    bool fine = povray_render(running->race->scene, &running->settings, run);
    run->switches = NULL;
    return fine;
}

static bool povray_entry(Running *running, RaceEntry *entry, int most)
{
    Race *race = running->race;
    double seconds[3][RUNS_MOST];
    int count = 0;

    do { // the picture is the same each time
        PovrayRun run;
        bool fine = *running->settings.interrupted == 0 && povray_once(running, entry, 1, &run);
        if (fine && count == 0) {
            entry_judge(running, entry, &run.image, true);
            entry->rays = run.cost.rays / ((double)race->width * race->height);
        }
        if (!fine) {
            return false;
        }
        image_fini(&run.image);
        seconds[RACE_CPU][count] = run.cost.seconds;
        seconds[RACE_WALL][count] = run.cost.wall;
        seconds[RACE_WHOLE][count] = run.whole;
        race->spent += run.whole;
    } while (seconds[RACE_CPU][count++] < ENOUGH && count < most);
    for (int i = 0; i <= RACE_WHOLE; i++) {
        entry->seconds[i] = study_median(seconds[i], count);
    }
    entry->is_run = true;
    return true;
}

static bool povray_entry_all(Running *running, RaceEntry *entry)
{
    PovrayRun run;

    if (*running->settings.interrupted != 0 || !povray_once(running, entry, 0, &run)) {
        return false;
    }
    image_fini(&run.image);
    entry->seconds[RACE_CPU_ALL] = run.cost.seconds;
    entry->seconds[RACE_WALL_ALL] = run.cost.wall;
    entry->has_all = true;
    return true;
}

// All in order, but those that the budget's stage has no room for. A run is repeated where there is room for all.
static bool povray_entries(Running *running, const int *order, int count)
{
    Race *race = running->race;
    StudyBudget *budget = running->settings.budget;
    double all = 0.0;

    for (int i = 0; i < count; i++) {
        all += povray_expected(running, race->povray[order[i]].small_rays * race->width * race->height);
    }
    int most = RUNS_MOST * all <= budget_left(budget) ? RUNS_MOST : 1;
    for (int i = 0; i < count; i++) {
        RaceEntry *entry = &race->povray[order[i]];
        budget_say(budget, race->scene, "POV-Ray's settings", i + 1, count);
        bool is_late = povray_expected(running, entry->small_rays * race->width * race->height) > budget_left(budget);
        if (i > 0 && is_late) {
            race->left_out++;
        } else if (!povray_entry(running, entry, most)) {
            return false;
        }
    }
    if (race->left_out > 0) {
        budget_leave_out(budget, "%d of POV-Ray's settings, those that are farthest from the front",
                         race->left_out);
    }
    return true;
}

// Those at the front a second time, with all threads.
static bool povray_front(Running *running, const int *order, int count)
{
    Race *race = running->race;
    StudyBudget *budget = running->settings.budget;
    int left_out = 0;

    for (int i = 0; i < count; i++) {
        RaceEntry *entry = &race->povray[order[i]];
        bool is_front = race_is_front(race, entry, RACE_CPU, RACE_BY_RTLANG) ||
                        race_is_front(race, entry, RACE_WALL, RACE_BY_RTLANG);
        budget_say(budget, race->scene, "the front with all threads", i + 1, count);
        if (is_front && running->overhead + entry->seconds[RACE_WALL] > budget_left(budget)) {
            left_out++;
        } else if (is_front && !povray_entry_all(running, entry)) {
            return false;
        }
    }
    if (left_out > 0) {
        budget_leave_out(budget, "runs with all threads of %d of POV-Ray's settings at the front", left_out);
    }
    return true;
}

// ---- rtlang's runs

static bool rtlang_rung(Running *running, bool is_adaptive, double samples)
{
    Race *race = running->race;
    RaceEntry *entry = &race->rtlang[race->rtlang_count++];
    rt_sampling sampling = {.adaptive = is_adaptive, .samples = samples, .seed = 100};
    double seconds[RACE_TIMES][RUNS_MOST], begin = clock_seconds();
    char output[4096];
    int count = 0;

    *entry = (RaceEntry){.is_adaptive = is_adaptive, .samples = samples, .same_as = -1};
    numbers_unset(entry);
    snprintf(entry->setting, sizeof entry->setting, is_adaptive ? "--adaptive --samples=%g" : "--samples=%g", samples);
    snprintf(output, sizeof output, "%s/study-rtlang.png", running->settings.folder);
    do {
        RtlangRun one = {.method = RT_METHOD_BACKWARD, .output = output}, all = {.method = RT_METHOD_BACKWARD};
        rtlang_render(race->scene, &running->settings, &sampling, RT_PRECISION_DOUBLE, 1, &one);
        rtlang_render(race->scene, &running->settings, &sampling, RT_PRECISION_DOUBLE, 0, &all);
        bool fine = one.status == RT_OK && all.status == RT_OK && *running->settings.interrupted == 0;
        if (fine && count == 0) {
            entry_judge(running, entry, &one.image, false);
            entry->rays = fmax(one.error.samples, 1.0);
        }
        image_fini(&one.image);
        image_fini(&all.image);
        if (!fine) {
            return false;
        }
        seconds[RACE_CPU][count] = one.seconds;
        seconds[RACE_WALL][count] = one.wall;
        seconds[RACE_WHOLE][count] = one.whole;
        seconds[RACE_CPU_ALL][count] = all.seconds;
        seconds[RACE_WALL_ALL][count] = all.wall;
    } while (seconds[RACE_CPU][count++] < ENOUGH && count < RUNS_MOST &&
             (clock_seconds() - begin) / count <= budget_left(running->settings.budget));
    for (int i = 0; i < RACE_TIMES; i++) {
        entry->seconds[i] = study_median(seconds[i], count);
    }
    entry->is_run = entry->has_all = true;
    return true;
}

// Whether a rung is nearer than all that POV-Ray has drawn, by both references: there is nothing beyond to race to.
static bool is_nearest(const Race *race, const RaceEntry *rung)
{
    for (int i = 0; i < race->povray_count; i++) {
        for (int judge = 0; judge < RACE_BY_OTHER; judge++) {
            if (race->povray[i].is_run && rung->errors[judge] >= race->povray[i].errors[judge]) {
                return false;
            }
        }
    }
    return true;
}

// Until `most` samples, or until a rung is nearer than all that POV-Ray has drawn.
static bool rtlang_ladder(Running *running, bool is_adaptive, double least, double factor)
{
    Race *race = running->race;
    StudyBudget *budget = running->settings.budget;
    const char *name = is_adaptive ? "--adaptive --samples" : "--samples";
    double most = running->settings.most_samples, expected = 0.0;
    bool is_done = false;

    for (double samples = least; samples <= most && race->rtlang_count < RACE_RUNGS && !is_done; samples *= factor) {
        double begin = clock_seconds();
        if (samples > least && expected > budget_left(budget)) {
            budget_leave_out(budget, "rtlang's runs of %s=%g and more in the race", name, samples);
            break;
        }
        budget_say(budget, race->scene, name, (int)samples, (int)most);
        if (!rtlang_rung(running, is_adaptive, samples)) {
            return false;
        }
        is_done = is_nearest(race, &race->rtlang[race->rtlang_count - 1]);
        expected = factor * (clock_seconds() - begin);
    }
    return true;
}

// ---- references

static bool rtlang_reference(Running *running)
{
    Race *race = running->race;
    int asked = running->settings.reference_samples;

    budget_say(running->settings.budget, race->scene, "the race's references", 1, 2);
    // Not the sampler that races.
    rt_sampling sampling = {
        .sampler = "halton",
        .samples = asked > 0 ? asked : study_reference_samples(race->scene, &running->settings, REFERENCE_SAMPLES, "the race's reference"),
        .seed = 1};
    RtlangRun run = {.method = RT_METHOD_BACKWARD};

    rtlang_render(race->scene, &running->settings, &sampling, RT_PRECISION_DOUBLE, 0, &run);
    race->picture = run.image;
    race->reference_samples = run.error.samples;
    race->floor = run.error.rmse;
    return run.status == RT_OK;
}

// The greatest depth whose picture of these rows the budget's stage has room for; 0: none. A square of depth n has up to
// 4^n rays.
static int reference_depth(const Running *running, int rows)
{
    for (int depth = REFERENCE_DEPTH; depth > 1; depth--) {
        double rays = (double)running->race->width * rows * (double)(1 << (2 * depth));
        if (povray_expected(running, rays) <= budget_left(running->settings.budget)) {
            return depth;
        }
    }
    return 0;
}

// The middle rows alone: 256 rays a pixel of a regular grid, each pixel's corners shared, take POV-Ray long.
static bool povray_reference(Running *running)
{
    Race *race = running->race;
    char first[32], last[32], square[16];
    int rows = race->height / PART_OF_ROWS, depth = reference_depth(running, rows);

    race->first_row = (race->height - rows) / 2;
    race->last_row = race->first_row + rows;
    race->apart = (double)NAN;
    if (depth < REFERENCE_DEPTH) {
        budget_leave_out(running->settings.budget, depth > 0 ? "POV-Ray's reference is of less depth"
                                                             : "POV-Ray's own reference");
    }
    if (depth == 0) {
        return true;
    }
    snprintf(first, sizeof first, "+SR%d", race->first_row + 1);
    snprintf(last, sizeof last, "+ER%d", race->last_row);
    snprintf(square, sizeof square, "+R%d", depth);
    snprintf(race->povray_reference, sizeof race->povray_reference, "+AM2 +A0.0 %s -J", square);
    const char *switches[] = {"+AM2", "+A0.0", square, "-J", first, last, NULL};
    PovrayRun run = {.name = "reference", .switches = switches};
    bool fine = povray_render(race->scene, &running->settings, &run);
    running->povray = run.image;
    if (fine) {
        race->povray_reference_rays = run.cost.rays / ((double)race->width * rows);
        race->apart = distance_in(&running->povray, &race->picture, race->first_row, race->last_row);
    }
    return fine;
}

// ---- the size

static int side_of(double length)
{
    int side = (int)lround(length / 8.0) * 8;

    return side < SIDE_LEAST ? SIDE_LEAST : side > SIDE_MOST ? SIDE_MOST : side;
}

// What a run tells of the next ones.
static void cost_learn(Running *running, const PovrayRun *run, double seconds)
{
    running->seconds_a_ray = run->cost.seconds / run->cost.rays;
    running->overhead = fmax(seconds - run->cost.wall, 0.0);
    running->stretch = fmax(run->cost.wall / fmax(run->cost.seconds, 1e-3), 1.0);
}

// Grows the picture until the setting that has the fewest rays takes POV-Ray long enough.
static bool size_find(Running *running, const RaceEntry *least)
{
    Race *race = running->race;
    StudySettings *settings = &running->settings;
    bool is_fixed = settings->race_width > 0;
    double enough = fmin(SHORTEST, fmax(budget_left(settings->budget), 0.0) / SHORTEST_OF_BUDGET);

    settings->width = is_fixed ? settings->race_width : FIRST_WIDTH;
    settings->height = is_fixed ? settings->race_height : FIRST_HEIGHT;
    for (int i = 0; i < SIZE_TRIES; i++) {
        PovrayRun run;
        double begin = clock_seconds();
        budget_say(settings->budget, race->scene, "the race's size", i + 1, SIZE_TRIES);
        if (*settings->interrupted != 0 || !povray_once(running, least, 1, &run)) {
            return false;
        }
        image_fini(&run.image);
        race->width = settings->width;
        race->height = settings->height;
        race->shortest = run.cost.seconds;
        cost_learn(running, &run, clock_seconds() - begin);
        if (is_fixed || race->shortest >= enough || settings->width >= SIDE_MOST) {
            break;
        }
        double grow = fmin(sqrt(1.1 * enough / fmax(run.cost.seconds, 1e-3)), 8.0);
        settings->width = side_of(grow * settings->width);
        settings->height = side_of(0.75 * settings->width);
    }
    return true;
}

static bool race_all(Running *running)
{
    Race *race = running->race;
    StudyBudget *budget = running->settings.budget;
    int order[RACE_SETTINGS];

    budget_stage(budget, 0.35);
    if (!race_try_small(race, &running->settings)) {
        return false;
    }
    int count = race_order(race, order);
    const RaceEntry *least = &race->povray[order[0]];
    for (int i = 1; i < count; i++) {
        const RaceEntry *entry = &race->povray[order[i]];
        least = entry->small_rays < least->small_rays ? entry : least;
    }
    budget_stage(budget, 1.0);
    bool fine = size_find(running, least);
    budget_stage(budget, 0.15);
    fine = fine && rtlang_reference(running);
    budget_stage(budget, 0.15);
    fine = fine && povray_reference(running);
    budget_stage(budget, 0.55);
    fine = fine && povray_entries(running, order, count);
    budget_stage(budget, 0.3);
    fine = fine && povray_front(running, order, count);
    budget_stage(budget, 0.5);
    fine = fine && rtlang_ladder(running, true, 2.0, 2.0);
    budget_stage(budget, 1.0);
    return fine && rtlang_ladder(running, false, 1.0, 4.0);
}

bool race_run(Race *race, const char *scene, const StudySettings *settings)
{
    Running running = {.race = race, .settings = *settings};

    *race = (Race){.scene = scene};
    race_settings_list(race);
    for (int i = 0; i < race->povray_count; i++) {
        numbers_unset(&race->povray[i]);
    }
    bool fine = race_all(&running);
    if (!fine && race->fault[0] == '\0') {
        snprintf(race->fault, sizeof race->fault, *settings->interrupted != 0 ? "interrupted" : "a run failed");
    }
    image_fini(&running.povray);
    return fine;
}
