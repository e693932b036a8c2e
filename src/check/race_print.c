// Races as text, JSON and a section of the report. All forms say the same.
//
// SPDX-License-Identifier: MIT
#include "check/race_print.h"

#include <math.h>

#include "check/json.h"
#include "check/report_html.h"

// The ratios that are printed, and the name of each.
typedef struct PrintedRatio {
    RaceTime time;
    RaceJudge judge;
    const char *name, *text;
} PrintedRatio;

static const PrintedRatio ratios[] = {
    {RACE_CPU, RACE_BY_RTLANG, "cpu", "processor, one thread"},
    {RACE_WALL, RACE_BY_RTLANG, "wall", "clock, one thread"},
    {RACE_WHOLE, RACE_BY_RTLANG, "whole", "processor, with reading and writing"},
    {RACE_CPU_ALL, RACE_BY_RTLANG, "cpu_all", "processor, all threads"},
    {RACE_WALL_ALL, RACE_BY_RTLANG, "wall_all", "clock, all threads"},
    {RACE_CPU, RACE_BY_POVRAY, "cpu_by_povray", "processor, against POV-Ray's reference"},
    {RACE_CPU, RACE_BY_OTHER, "cpu_by_other", "processor, each against the other's reference"},
};
#define PRINTED_RATIOS ((int)RT_COUNT_OF(ratios))

static void print_ratio(const RaceRatio *ratio, FILE *out)
{
    if (isnan(ratio->ratio)) {
        fprintf(out, "not known, rtlang's ladders reach none of %d settings at the front", ratio->beyond);
        return;
    }
    fprintf(out, "%.1f (%.1f to %.1f over %d settings at the front%s", ratio->ratio, ratio->least, ratio->greatest,
            ratio->settings, ratio->beyond > 0 ? "" : ")");
    if (ratio->beyond > 0) {
        fprintf(out, "; %d more are nearer than rtlang's ladders reach)", ratio->beyond);
    }
}

// What the race is, in sentences.
static void print_head(const Race *race, FILE *out, const char *before, const char *after)
{
    fprintf(out, "%sthe race: %d x %d pixels; POV-Ray's shortest run takes %.2f s of the processor%s\n", before,
            race->width, race->height, race->shortest, after);
    fprintf(out,
            "%sreferences: rtlang's of %g samples a pixel (its own error, %.3g, is taken off); POV-Ray's ",
            before, race->reference_samples, race->floor);
    if (isnan(race->apart)) {
        fprintf(out, "left out by the budget%s\n", after);
    } else {
        fprintf(out, "by %s, %.4g rays a pixel of the rows %d to %d; %.3g apart there%s\n", race->povray_reference,
                race->povray_reference_rays, race->first_row + 1, race->last_row, race->apart, after);
    }
    int tried = 0, run = 0;
    for (int i = 0; i < race->povray_count; i++) {
        tried += !isnan(race->povray[i].small_rays);
        run += race->povray[i].is_run;
    }
    fprintf(out,
            "%sPOV-Ray's settings: %d tried at %d x %d pixels, %d of them with another's picture; %d run, nearest to the "
            "front first, in %.0f s of the processor; %d left out by the budget%s\n",
            before, tried, race->small_width, race->small_height, race->same, run, race->spent, race->left_out, after);
}

static void print_ratios(const Race *race, FILE *out, const char *before, const char *after)
{
    for (int i = 0; i < PRINTED_RATIOS; i++) {
        RaceRatio ratio = race_ratio(race, ratios[i].time, ratios[i].judge);
        fprintf(out, "%sto equal error POV-Ray takes times as long as rtlang, %s: ", before, ratios[i].text);
        print_ratio(&ratio, out);
        fprintf(out, "%s\n", after);
    }
}

// Which settings are at the front by processor and by clock.
static const char *front_text(const Race *race, const RaceEntry *entry)
{
    bool cpu = race_is_front(race, entry, RACE_CPU, RACE_BY_RTLANG);
    bool wall = race_is_front(race, entry, RACE_WALL, RACE_BY_RTLANG);

    return cpu && wall ? "both" : cpu ? "processor" : wall ? "clock" : "";
}

void race_print_text(const Race *race, FILE *out)
{
    print_head(race, out, "  ", "");
    fprintf(out, "%-24s %8s %9s %9s %9s %9s %9s %9s  %s\n", "setting", "rays", "cpu s", "wall s", "whole s", "rmse",
            "rtlang s", "ratio", "front");
    for (int i = 0; i < race->rtlang_count; i++) {
        const RaceEntry *e = &race->rtlang[i];
        fprintf(out, "%-24s %8.4g %9.4f %9.4f %9.4f %9.3g\n", e->setting, e->rays, e->seconds[RACE_CPU],
                e->seconds[RACE_WALL], e->seconds[RACE_WHOLE], e->errors[RACE_BY_RTLANG]);
    }
    for (int i = 0; i < race->povray_count; i++) {
        const RaceEntry *e = &race->povray[i];
        const char *front = front_text(race, e);
        if (*front != '\0') {
            double to = race_time_to(race, e->errors[RACE_BY_RTLANG], RACE_CPU, RACE_BY_RTLANG);
            fprintf(out, "%-24s %8.4g %9.4f %9.4f %9.4f %9.3g %9.4f %9.1f  %s\n", e->setting, e->rays,
                    e->seconds[RACE_CPU], e->seconds[RACE_WALL], e->seconds[RACE_WHOLE], e->errors[RACE_BY_RTLANG], to,
                    e->seconds[RACE_CPU] / to, front);
        }
    }
    print_ratios(race, out, "", "");
}

static void json_entry(const Race *race, const RaceEntry *entry, bool is_povray, FILE *out)
{
    static const char *const times[RACE_TIMES] = {"cpu", "wall", "whole", "cpu_all", "wall_all"};
    static const char *const judges[RACE_JUDGES] = {"rmse", "rmse_by_povray", "rmse_by_other"};

    fputs("{\"setting\": ", out);
    json_print_text(out, entry->setting);
    fprintf(out, ", \"run\": %s", entry->is_run ? "true" : "false");
    if (is_povray) {
        json_print_number(out, "small_rays", entry->small_rays);
        json_print_number(out, "small_rmse", entry->small_error);
        fputs(", \"same_as\": ", out);
        json_print_text(out, entry->same_as >= 0 ? race->povray[entry->same_as].setting : "");
        fputs(", \"front\": ", out);
        json_print_text(out, front_text(race, entry));
    }
    if (entry->is_run) {
        json_print_number(out, "rays", entry->rays);
        for (int i = 0; i < RACE_TIMES; i++) {
            json_print_number(out, times[i], entry->seconds[i]);
        }
        for (int i = 0; i < RACE_JUDGES; i++) {
            json_print_number(out, judges[i], entry->errors[i]);
        }
    }
    fputc('}', out);
}

void race_print_json(const Race *race, FILE *out)
{
    fprintf(out, "{\"width\": %d, \"height\": %d", race->width, race->height);
    json_print_number(out, "shortest", race->shortest);
    json_print_number(out, "reference_samples", race->reference_samples);
    json_print_number(out, "floor", race->floor);
    fputs(", \"povray_reference\": ", out);
    json_print_text(out, race->povray_reference);
    json_print_number(out, "povray_reference_rays", race->povray_reference_rays);
    json_print_number(out, "references_apart", race->apart);
    json_print_number(out, "spent", race->spent);
    json_print_number(out, "same", race->same);
    json_print_number(out, "left_out", race->left_out);
    fputs(", \"ratios\": [", out);
    for (int i = 0; i < PRINTED_RATIOS; i++) {
        RaceRatio ratio = race_ratio(race, ratios[i].time, ratios[i].judge);
        fprintf(out, "%s{\"name\": ", i > 0 ? ", " : "");
        json_print_text(out, ratios[i].name);
        json_print_number(out, "ratio", ratio.ratio);
        json_print_number(out, "least", ratio.least);
        json_print_number(out, "greatest", ratio.greatest);
        fprintf(out, ", \"settings\": %d, \"beyond\": %d}", ratio.settings, ratio.beyond);
    }
    fputs("], \"rtlang\": [", out);
    for (int i = 0; i < race->rtlang_count; i++) {
        fputs(i > 0 ? ", " : "", out);
        json_entry(race, &race->rtlang[i], false, out);
    }
    fputs("], \"povray\": [", out);
    for (int i = 0; i < race->povray_count; i++) {
        fputs(i > 0 ? ", " : "", out);
        json_entry(race, &race->povray[i], true, out);
    }
    fputs("]}", out);
}

static void html_row(const Race *race, const RaceEntry *entry, FILE *out)
{
    double to = race_time_to(race, entry->errors[RACE_BY_RTLANG], RACE_CPU, RACE_BY_RTLANG);
    const double numbers[] = {entry->rays,
                              entry->seconds[RACE_CPU],
                              entry->seconds[RACE_WALL],
                              entry->seconds[RACE_WHOLE],
                              entry->seconds[RACE_CPU_ALL],
                              entry->seconds[RACE_WALL_ALL],
                              entry->errors[RACE_BY_RTLANG],
                              entry->errors[RACE_BY_POVRAY],
                              to,
                              entry->seconds[RACE_CPU] / to};

    fprintf(out, "<tr><td>%s</td>", entry->setting);
    for (size_t i = 0; i < RT_COUNT_OF(numbers); i++) {
        if (isnan(numbers[i])) {
            fputs("<td></td>", out);
        } else {
            fprintf(out, "<td class=\"number\" data-sort=\"%.9g\">%.4g</td>", numbers[i], numbers[i]);
        }
    }
    fprintf(out, "<td>%s</td></tr>\n", front_text(race, entry));
}

static const ReportColumn columns[] = {
    {"setting", "What the program was asked for: rtlang's samples a pixel; POV-Ray's method, threshold, depth and jitter."},
    {"rays", "Rays from the camera for a pixel, as the program counted them."},
    {"processor, s", "Time of the processor with one thread, tracing alone."},
    {"clock, s", "The same by the clock."},
    {"with reading and writing, s", "Time of the processor of the whole run, from the scene's text to the file."},
    {"processor, all threads", "Time of the processor, tracing with all threads. POV-Ray's settings at the front only."},
    {"clock, all threads", "The same by the clock."},
    {"rmse", "The error: the root of the mean square distance from rtlang's reference, in linear light from 0 to 1."},
    {"rmse, by POV-Ray's reference", "The same against the reference that POV-Ray drew of the middle rows."},
    {"rtlang to that error, s", "What rtlang takes to the same error: read off the line between two rungs of a ladder, in "
                                "logarithms, or a rung that is nearer still, whichever is least."},
    {"ratio", "Time of the processor over rtlang's to the same error. Above 1 rtlang is faster."},
    {"at the front by", "No other setting of POV-Ray's has both less time and less error."},
};

void race_print_html(const Race *race, FILE *out)
{
    fputs("<h3>The race</h3>\n<ul>\n", out);
    print_head(race, out, "<li>", "</li>");
    print_ratios(race, out, "<li>", "</li>");
    fputs("</ul>\n", out);
    report_table_open(out, "All runs of the race", columns, RT_COUNT_OF(columns));
    for (int i = 0; i < race->rtlang_count; i++) {
        html_row(race, &race->rtlang[i], out);
    }
    for (int i = 0; i < race->povray_count; i++) {
        if (race->povray[i].is_run) {
            html_row(race, &race->povray[i], out);
        }
    }
    report_table_close(out);
}

// ---- all scenes of a run

void race_total_add(RaceTotal *total, const Race *race)
{
    for (int i = 0; i < RACE_TOTALS; i++) {
        RaceRatio ratio = race_ratio(race, ratios[i].time, ratios[i].judge);
        if (!isnan(ratio.ratio)) {
            total->scenes[i]++;
            total->logarithms[i] += log(ratio.ratio);
            total->least[i] = total->scenes[i] == 1 ? ratio.ratio : fmin(total->least[i], ratio.ratio);
        }
    }
}

void race_print_total(const RaceTotal *total, FILE *out, const char *before, const char *after)
{
    _Static_assert(RACE_TOTALS == PRINTED_RATIOS, "a total for each ratio that is printed");
    for (int i = 0; i < RACE_TOTALS; i++) {
        if (total->scenes[i] > 1) {
            fprintf(out,
                    "%sover %d scenes POV-Ray takes %.1f times as long as rtlang to equal error, geometric mean; least "
                    "%.1f: %s%s\n",
                    before, total->scenes[i], exp(total->logarithms[i] / total->scenes[i]), total->least[i],
                    ratios[i].text, after);
        }
    }
}
