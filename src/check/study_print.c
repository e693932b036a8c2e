// Tables of a study. All forms say the same: the points, the lines through them, the three kinds of error, the ratios.
//
// SPDX-License-Identifier: MIT
#include "check/study_print.h"

#include <math.h>

#include "check/json.h"

double study_efficiency(const StudyPoint *point)
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
void study_print_bias(const Study *study, FILE *out, const char *before, const char *after)
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

void study_print_kinds(const Study *study, FILE *out, const char *before, const char *after)
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
void study_print_forward(const Study *study, FILE *out, const char *before, const char *after)
{
    const StudyMethod *first = &study->methods[0];
    const StudyPoint *goal = &first->points[first->count > 2 ? 2 : 0]; // 16 samples

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
    study_print_kinds(study, out, "  ", "");
    study_print_bias(study, out, "  ", "");
    study_print_forward(study, out, "  ", "");
    fprintf(out, "%-22s %-24s %8s %9s %9s %9s %8s %8s %8s %10s\n", "method", "setting", "samples", "seconds", "rmse",
            "relmse", "max", "99.9 %", "flip", "efficiency");
    for (int i = 0; i < study->count; i++) {
        const StudyMethod *method = &study->methods[i];
        for (int j = 0; j < method->count; j++) {
            const StudyPoint *p = &method->points[j];
            fprintf(out, "%-22s %-24s %8.4g %9.4f %9.3g %9.3g %8.3g %8.3g %8.3g %10.3g\n", j == 0 ? method->name : "",
                    p->setting, p->samples, p->seconds, p->rmse, p->relmse, p->greatest, p->p999, p->flip,
                    study_efficiency(p));
        }
        if (!isnan(method->slope)) {
            fprintf(out, "%22s slope %.2f", "", method->slope);
            if (!isnan(method->slope_spread)) {
                fprintf(out, " +- %.2f", method->slope_spread);
            }
            fprintf(out, " in time%s\n", method->is_biased ? "; biased" : "");
        }
    }
}

// What the budget left out, and how long the study took.
void study_print_budget(const Study *study, FILE *out, const char *before, const char *after)
{
    char limit[64] = "";

    if (study->budget.seconds > 0.0) {
        snprintf(limit, sizeof limit, " of %g that --budget gives", study->budget.seconds);
    }
    fprintf(out, "%sthe study took %.0f s%s; left out%s%s\n", before, study->seconds, limit,
            study->budget.left_out_count > 0 ? ":" : " nothing", after);
    for (int i = 0; i < study->budget.left_out_count; i++) {
        fprintf(out, "%s%s%s%s\n", before, *before == ' ' ? "  " : "", study->budget.left_out[i], after);
    }
}

void study_print_text(const Study *study, FILE *out)
{
    char verdict[STUDY_TEXT];

    study_verdict(study, verdict);
    fprintf(out, "%s", study->scene);
    if (study->has_methods) {
        fprintf(out, ", %d x %d", study->width, study->height);
    }
    fprintf(out, "\n%s\n", verdict);
    study_print_budget(study, out, "  ", "");
    if (study->has_methods) {
        methods_print(study, out);
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
                    study_efficiency(p), p->estimate);
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
    json_print_number(out, "efficiency", study_efficiency(p));
    json_print_number(out, "estimate", p->estimate);
    fputc('}', out);
}

void study_print_json(const Study *study, FILE *out)
{
    char verdict[STUDY_TEXT];

    study_verdict(study, verdict);
    fputs("{\"scene\": ", out);
    json_print_text(out, study->scene);
    fputs(", \"verdict\": ", out);
    json_print_text(out, verdict);
    json_print_number(out, "budget", study->budget.seconds);
    json_print_number(out, "took", study->seconds);
    fputs(", \"left_out\": [", out);
    for (int i = 0; i < study->budget.left_out_count; i++) {
        fputs(i > 0 ? ", " : "", out);
        json_print_text(out, study->budget.left_out[i]);
    }
    fputs("]", out);
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

void study_print_total(const RaceTotal *total, FILE *out)
{
    race_print_total(total, out, "", "");
}
