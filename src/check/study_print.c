// Tables of a study. All forms say the same: the points, the lines through them, the three kinds of error, the ratios.
//
// SPDX-License-Identifier: MIT
#include "check/study_print.h"

#include <math.h>

#include "check/json.h"

static double efficiency(const StudyPoint *point)
{
    return 1.0 / (point->rmse * point->rmse * point->seconds);
}

// Why a method stays where it is.
static const char *bias_cause(const StudyMethod *method)
{
    static const char *const causes[] = {
        [STUDY_SAMPLER] = "light that few samples meet",
        [STUDY_REFERENCE] = "its arithmetic",
        [STUDY_FORWARD] = "light that does not come from light sources",
    };

    return causes[method->kind];
}

// The sentences that tell of bias.
static void print_bias(const Study *study, FILE *out, const char *before, const char *after)
{
    if (study->depth_bias > 3.0 * study->floor) {
        fprintf(out,
                "%sbiased by max_trace_level: with 64 levels the picture changes by rmse %.3g; no number of samples of "
                "the scene as it is gets nearer%s\n",
                before, study->depth_bias, after);
    } else if (study->cut_bias > 0.0) {
        fprintf(out,
                "%sbiased by rays that are cut: they would add about %.2g in the mean, which more levels do not show "
                "above the floor%s\n",
                before, study->cut_bias, after);
    }
    for (int i = 0; i < study->count; i++) {
        const StudyMethod *method = &study->methods[i];
        if (method->is_biased) {
            fprintf(out, "%s%s is biased: it stays at rmse %.3g, more time does not help; likely cause: %s%s\n", before,
                    method->name, method->points[method->count - 1].rmse, bias_cause(method), after);
        }
    }
}

static void print_kinds(const Study *study, FILE *out, const char *before, const char *after)
{
    fprintf(out, "%ssampling: the ladders below; floor %.3g, that of the reference of %g samples%s\n", before,
            study->floor, study->reference_samples, after);
    if (isnan(study->arithmetic)) {
        fprintf(out, "%sarithmetic: not known: %s%s\n", before, study->arithmetic_why, after);
    } else {
        fprintf(out, "%sarithmetic: rmse %.3g in double, %.3g in float, one ray a pixel against quad%s\n", before,
                study->arithmetic, study->arithmetic_float, after);
    }
    if (isnan(study->model)) {
        fprintf(out, "%smodel: not known, without POV-Ray%s\n", before, after);
    } else {
        fprintf(out, "%smodel: rmse %.3g, one ray a pixel, POV-Ray against rtlang%s\n", before, study->model, after);
    }
}

// What the lecture says of photons, in numbers: how many arrive, and what equal error takes.
static void print_forward(const Study *study, FILE *out, const char *before, const char *after)
{
    const StudyPoint *goal = &study->methods[0].points[2]; // 16 samples

    if (study->forward_why[0] != '\0') {
        fprintf(out, "%sforward: not here: %s%s\n", before, study->forward_why, after);
    }
    for (int i = 0; i < study->count; i++) {
        const StudyMethod *method = &study->methods[i];
        if (method->kind != STUDY_FORWARD || method->count == 0) {
            continue;
        }
        const StudyPoint *last = &method->points[method->count - 1];
        double times = (last->rmse / goal->rmse) * (last->rmse / goal->rmse); // slope -1/2
        fprintf(out, "%s%s: a photon counts with probability %.3g, one of %.3g; the error of %s, %s (%.3g) ", before,
                method->name, 1.0 / method->photons_an_arrival, method->photons_an_arrival, study->methods[0].name,
                goal->setting, goal->rmse);
        if (method->is_biased && last->rmse > goal->rmse) {
            fprintf(out, "is not to be had by more photons%s\n", after);
            continue;
        }
        fprintf(out, "would take about %.3g photons and %.3g seconds, %.3g times as long%s\n",
                times * last->samples * study->width * study->height, times * last->seconds,
                times * last->seconds / goal->seconds, after);
    }
}

static void methods_print(const Study *study, FILE *out)
{
    print_kinds(study, out, "  ", "");
    print_bias(study, out, "  ", "");
    print_forward(study, out, "  ", "");
    fprintf(out, "%-22s %-24s %8s %9s %9s %9s %8s %8s %8s %10s\n", "method", "setting", "samples", "seconds", "rmse",
            "relmse", "max", "99.9 %", "flip", "efficiency");
    for (int i = 0; i < study->count; i++) {
        const StudyMethod *method = &study->methods[i];
        for (int j = 0; j < method->count; j++) {
            const StudyPoint *p = &method->points[j];
            fprintf(out, "%-22s %-24s %8.4g %9.4f %9.3g %9.3g %8.3g %8.3g %8.3g %10.3g\n", j == 0 ? method->name : "",
                    p->setting, p->samples, p->seconds, p->rmse, p->relmse, p->greatest, p->p999, p->flip,
                    efficiency(p));
        }
        if (!isnan(method->slope)) {
            fprintf(out, "%22s slope %.2f +- %.2f in time%s\n", "", method->slope, method->slope_spread,
                    method->is_biased ? "; biased" : "");
        }
    }
}

void study_print_text(const Study *study, FILE *out)
{
    fprintf(out, "%s", study->scene);
    if (study->has_methods) {
        fprintf(out, ", %d x %d\n", study->width, study->height);
        methods_print(study, out);
    } else {
        fputc('\n', out);
    }
    if (study->has_race) {
        race_print_text(&study->race, out);
    }
}

void study_print_csv(const Study *study, FILE *out, bool with_heading)
{
    if (with_heading) {
        fputs("scene,width,height,method,setting,samples,seconds,rmse,relmse,max,p999,flip,efficiency,estimate,slope,"
              "slope_spread,biased\r\n",
              out);
    }
    for (int i = 0; i < study->count; i++) {
        const StudyMethod *method = &study->methods[i];
        for (int j = 0; j < method->count; j++) {
            const StudyPoint *p = &method->points[j];
            fputc('"', out);
            for (const char *c = study->scene; *c != '\0'; c++) {
                fputs(*c == '"' ? "\"" : "", out);
                fputc(*c, out);
            }
            fprintf(out, "\",%d,%d,%s,%s,%.9g,%.6g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,", study->width, study->height,
                    method->name, p->setting, p->samples, p->seconds, p->rmse, p->relmse, p->greatest, p->p999, p->flip,
                    efficiency(p), p->estimate);
            if (!isnan(method->slope)) {
                fprintf(out, "%.4f", method->slope);
            }
            fputc(',', out);
            if (!isnan(method->slope_spread)) {
                fprintf(out, "%.4f", method->slope_spread);
            }
            fprintf(out, ",%d\r\n", method->is_biased);
        }
    }
}

static void json_point(FILE *out, const StudyPoint *p)
{
    fputs("{\"setting\": ", out);
    json_print_text(out, p->setting);
    json_print_number(out, "samples", p->samples);
    json_print_number(out, "seconds", p->seconds);
    json_print_number(out, "rmse", p->rmse);
    json_print_number(out, "relmse", p->relmse);
    json_print_number(out, "max", p->greatest);
    json_print_number(out, "p999", p->p999);
    json_print_number(out, "flip", p->flip);
    json_print_number(out, "efficiency", efficiency(p));
    json_print_number(out, "estimate", p->estimate);
    fputc('}', out);
}

void study_print_json(const Study *study, FILE *out)
{
    fputs("{\"scene\": ", out);
    json_print_text(out, study->scene);
    fprintf(out, ", \"width\": %d, \"height\": %d, \"reference_samples\": %g", study->width, study->height,
            study->reference_samples);
    json_print_number(out, "floor", study->floor);
    json_print_number(out, "model", study->model);
    json_print_number(out, "arithmetic", study->arithmetic);
    json_print_number(out, "arithmetic_float", study->arithmetic_float);
    json_print_number(out, "depth_bias", study->depth_bias);
    json_print_number(out, "cut_bias", study->cut_bias);
    fputs(", \"methods\": [", out);
    for (int i = 0; i < study->count; i++) {
        const StudyMethod *method = &study->methods[i];
        fprintf(out, "%s{\"name\": ", i > 0 ? ", " : "");
        json_print_text(out, method->name);
        json_print_number(out, "slope", method->slope);
        json_print_number(out, "slope_spread", method->slope_spread);
        if (method->kind == STUDY_FORWARD) {
            json_print_number(out, "photons_an_arrival", method->photons_an_arrival);
        }
        fprintf(out, ", \"biased\": %s, \"points\": [", method->is_biased ? "true" : "false");
        for (int j = 0; j < method->count; j++) {
            fputs(j > 0 ? ", " : "", out);
            json_point(out, &method->points[j]);
        }
        fputs("]}", out);
    }
    fputs("]", out);
    if (study->has_race) {
        json_print_number(out, "best_ratio", race_ratio(&study->race, RACE_CPU, RACE_BY_RTLANG).ratio);
        fputs(", \"race\": ", out);
        race_print_json(&study->race, out);
    }
    fputc('}', out);
}

static void section_table(const Study *study, FILE *out)
{
    fputs("<table "
          "class=\"sortable\"><thead><tr><th>method</th><th>setting</th><th>samples</th><th>seconds</th><th>rmse</th>"
          "<th>relMSE</th><th>max</th><th>99.9 "
          "%</th><th>FLIP</th><th>efficiency</th><th>slope</th></tr></thead><tbody>\n",
          out);
    for (int i = 0; i < study->count; i++) {
        const StudyMethod *method = &study->methods[i];
        for (int j = 0; j < method->count; j++) {
            const StudyPoint *p = &method->points[j];
            const double numbers[] = {p->samples,  p->seconds, p->rmse, p->relmse,
                                      p->greatest, p->p999,    p->flip, efficiency(p)};
            fprintf(out, "<tr><td>%s</td><td>%s</td>", method->name, p->setting);
            for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++) {
                fprintf(out, "<td class=\"number\" data-sort=\"%.9g\">%.4g</td>", numbers[k], numbers[k]);
            }
            if (isnan(method->slope)) {
                fputs("<td></td></tr>\n", out);
            } else {
                fprintf(out, "<td class=\"number%s\" data-sort=\"%.4f\">%.2f ± %.2f</td></tr>\n",
                        method->is_biased ? " bad" : "", method->slope, method->slope, method->slope_spread);
            }
        }
    }
    fputs("</tbody></table>\n", out);
}

void study_print_section(const Study *study, ReportPage *page, int number)
{
    char id[32], title[STUDY_TEXT];

    snprintf(id, sizeof id, "study-%d", number);
    snprintf(title, sizeof title, "Error against time: %s", study->scene);
    FILE *out = report_page_section(page, id, title);
    if (study->has_methods) {
        fputs("<ul>\n", out);
        print_kinds(study, out, "<li>", "</li>");
        print_bias(study, out, "<li><strong>", "</strong></li>");
        print_forward(study, out, "<li>", "</li>");
        fputs("</ul>\n", out);
        study_plot(study, out, false);
        section_table(study, out);
    }
    if (study->has_race) {
        race_plot(&study->race, out, false);
        race_print_html(&study->race, out);
    }
}

void study_print_total(const RaceTotal *total, FILE *out)
{
    race_print_total(total, out, "", "");
}

void study_print_total_section(const RaceTotal *total, ReportPage *page)
{
    if (total->scenes[0] > 1) {
        FILE *out = report_page_section(page, "study-all", "The race: all scenes");
        fputs("<ul>\n", out);
        race_print_total(total, out, "<li>", "</li>");
        fputs("</ul>\n", out);
    }
}
