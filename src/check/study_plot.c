// The plot of a study: an <svg> element made of numbers alone.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check/study_print.h"

// Small enough for letters that can be read on a screen of 400 pixels.
enum { WIDTH = 440, HEIGHT = 360, LEFT = 58, RIGHT = 40, TOP = 16, BOTTOM = 46 };

// Where the list of methods begins in a file of its own, beside the slopes of the guides, and how wide it is.
enum { LIST = WIDTH + 4, LIST_WIDTH = 240 };

enum { CURVES_FIRST = 4 }; // that are shown before a reader asks for more

typedef struct Scale {
    double low_x, high_x, low_y, high_y; // decimal logarithms
} Scale;

enum { COLOURS = 6 };

// How the methods of a kind are drawn: no two of a study look alike. Each colour stands out from a white page and from a
// black one by 3 to 1, as WCAG 2.1 wants it.
static const struct {
    const char *dash;
    const char *mark; // a path around the point
    const char *colours[COLOURS];
} looks[] = {
    [STUDY_SAMPLER] = {"none",
                       "m-3,0 a3,3 0 1,0 6,0 a3,3 0 1,0 -6,0z",
                       {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#a0655a", "#7f7f7f"}},
    [STUDY_REFERENCE] = {"2 2",
                         "m-2.8,-2.8 h5.6 v5.6 h-5.6z",
                         {"#0f8f9c", "#0b8a8a", "#3d7f94", "#0f8f9c", "#0b8a8a", "#3d7f94"}},
    [STUDY_FORWARD] = {"10 3 2 3",
                       "m0,-4 l3.8,6.6 h-7.6z",
                       {"#d9660a", "#b8560f", "#d9660a", "#b8560f", "#d9660a", "#b8560f"}},
    [STUDY_POVRAY] = {"6 3",
                      "m0,-4 l4,4 l-4,4 l-4,-4z",
                      {"#a67c00", "#8a8b00", "#767600", "#cc5aa8", "#c2258d", "#777777"}},
};

// What a reader looks for, in this order.
static const char *const first_curves[] = {
    "rtlang sobol",    "rtlang",          "rtlang adaptive", "rtlang random",  "rtlang forward-connect",
    "POV-Ray +AM1 -J", "POV-Ray +AM2 -J", "POV-Ray +AM1 +J", "POV-Ray +AM2 +J"};

// Marks the curves that a reader sees first.
static void curves_choose(const Study *study, bool chosen[STUDY_METHODS])
{
    int count = 0;

    for (size_t i = 0; i < RT_COUNT_OF(first_curves); i++) {
        for (int k = 0; k < study->count && count < CURVES_FIRST; k++) {
            if (study->methods[k].count > 0 && strcmp(study->methods[k].name, first_curves[i]) == 0) {
                chosen[k] = true;
                count++;
            }
        }
    }
}

// By its place among those of its kind.
static const char *colour_of(const Study *study, int number)
{
    const StudyMethod *method = &study->methods[number];
    int place = 0;

    for (int i = 0; i < number; i++) {
        place += study->methods[i].kind == method->kind;
    }
    return looks[method->kind].colours[place % COLOURS];
}

static double place_x(const Scale *scale, double x)
{
    return LEFT + (log10(x) - scale->low_x) / (scale->high_x - scale->low_x) * (WIDTH - LEFT - RIGHT);
}

static double place_y(const Scale *scale, double y)
{
    return TOP + (scale->high_y - log10(y)) / (scale->high_y - scale->low_y) * (HEIGHT - TOP - BOTTOM);
}

static bool is_shown(const StudyPoint *point)
{
    return point->seconds > 0.0 && point->rmse > 0.0;
}

// Whole powers of ten around all points and the floor.
static Scale scale_of(const Study *study)
{
    Scale scale = {INFINITY, -INFINITY, study->floor > 0.0 ? log10(study->floor) : INFINITY, -INFINITY};

    for (int i = 0; i < study->count; i++) {
        for (int j = 0; j < study->methods[i].count; j++) {
            const StudyPoint *point = &study->methods[i].points[j];
            if (is_shown(point)) {
                scale.low_x = fmin(scale.low_x, log10(point->seconds));
                scale.high_x = fmax(scale.high_x, log10(point->seconds));
                scale.low_y = fmin(scale.low_y, log10(point->rmse));
                scale.high_y = fmax(scale.high_y, log10(point->rmse));
            }
        }
    }
    if (!(scale.low_x <= scale.high_x)) { // no point at all: axes only
        return (Scale){-2.0, 0.0, -3.0, 0.0};
    }
    scale.low_x = floor(scale.low_x);
    scale.low_y = floor(scale.low_y);
    scale.high_x = fmax(ceil(scale.high_x), scale.low_x + 1.0);
    scale.high_y = fmax(ceil(scale.high_y), scale.low_y + 1.0);
    return scale;
}

// The style stands in the element, where the page's own style for plots does not reach it.
static void print_line(FILE *out, double x1, double y1, double x2, double y2, const char *style)
{
    fprintf(out, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" style=\"%s\"/>\n", x1, y1, x2, y2, style);
}

static void print_axes(FILE *out, const Scale *scale)
{
    static const char grid[] = "stroke: currentColor; stroke-opacity: 0.15";

    for (double x = scale->low_x; x <= scale->high_x; x += 1.0) {
        double at = place_x(scale, pow(10.0, x));
        print_line(out, at, TOP, at, HEIGHT - BOTTOM, grid);
        fprintf(out, "<text x=\"%.1f\" y=\"%d\" text-anchor=\"middle\">%g s</text>\n", at, HEIGHT - BOTTOM + 18,
                pow(10.0, x));
    }
    for (double y = scale->low_y; y <= scale->high_y; y += 1.0) {
        double at = place_y(scale, pow(10.0, y));
        print_line(out, LEFT, at, WIDTH - RIGHT, at, grid);
        fprintf(out, "<text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n", LEFT - 6, at + 4, pow(10.0, y));
    }
    fprintf(out, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">processor seconds of one thread</text>\n",
            (LEFT + WIDTH - RIGHT) / 2, HEIGHT - 12);
    fprintf(
        out,
        "<text x=\"16\" y=\"%d\" text-anchor=\"middle\" transform=\"rotate(-90 16 %d)\">rmse, linear light</text>\n",
        (TOP + HEIGHT - BOTTOM) / 2, (TOP + HEIGHT - BOTTOM) / 2);
}

// From the first point of the first method downward.
static void print_guide(FILE *out, const Study *study, const Scale *scale, double slope)
{
    const StudyPoint *first = &study->methods[0].points[0];
    double end = pow(10.0, scale->high_x), reach = log10(first->rmse) + slope * (scale->high_x - log10(first->seconds));

    if (reach < scale->low_y) {
        end = first->seconds * pow(10.0, (scale->low_y - log10(first->rmse)) / slope);
        reach = scale->low_y;
    }
    print_line(out, place_x(scale, first->seconds), place_y(scale, first->rmse), place_x(scale, end),
               place_y(scale, pow(10.0, reach)), "stroke: currentColor; stroke-opacity: 0.5; stroke-dasharray: 3 4");
    fprintf(out, "<text x=\"%.1f\" y=\"%.1f\">%g</text>\n", place_x(scale, end) + 3,
            place_y(scale, pow(10.0, reach)) - 3, slope);
}

static void print_method(FILE *out, const Study *study, const Scale *scale, int number, bool is_chosen)
{
    const StudyMethod *method = &study->methods[number];
    const char *dash = looks[method->kind].dash, *mark = looks[method->kind].mark, *colour = colour_of(study, number);

    fprintf(out, "<g data-curve=\"%d\"%s>\n", number, is_chosen ? "" : " class=\"off\"");
    fprintf(out, "<polyline fill=\"none\" stroke=\"%s\" stroke-width=\"1.6\" stroke-dasharray=\"%s\" points=\"", colour,
            dash);
    for (int i = 0; i < method->count; i++) {
        if (is_shown(&method->points[i])) {
            fprintf(out, "%.1f,%.1f ", place_x(scale, method->points[i].seconds),
                    place_y(scale, method->points[i].rmse));
        }
    }
    fputs("\"/>\n", out);
    for (int i = 0; i < method->count; i++) {
        const StudyPoint *point = &method->points[i];
        if (is_shown(point)) {
            fprintf(out,
                    "<path d=\"M%.1f,%.1f %s\" style=\"fill: %s; stroke: none\"><title>%s, %s: %.3g s, rmse "
                    "%.3g</title></path>\n",
                    place_x(scale, point->seconds), place_y(scale, point->rmse), mark, colour, method->name,
                    point->setting, point->seconds, point->rmse);
        }
    }
    fputs("</g>\n", out);
}

// The line and the mark of a method, with their middle at the given place.
static void print_key(FILE *out, const Study *study, int number, int x, int y)
{
    const StudyMethod *method = &study->methods[number];
    const char *dash = looks[method->kind].dash, *mark = looks[method->kind].mark, *colour = colour_of(study, number);
    char style[96];

    snprintf(style, sizeof style, "stroke: %s; stroke-width: 2; stroke-dasharray: %s", colour, dash);
    print_line(out, x - 12, y, x + 12, y, style);
    fprintf(out, "<path d=\"M%d,%d %s\" style=\"fill: %s; stroke: none\"/>\n", x, y, mark, colour);
}

static const char *bias_words(const StudyMethod *method)
{
    return method->is_biased ? " (biased)" : "";
}

// In a file of its own.
static void print_list(FILE *out, const Study *study)
{
    for (int i = 0; i < study->count; i++) {
        int y = TOP + 14 + 20 * i;
        print_key(out, study, i, LIST + 12, y - 4);
        fprintf(out, "<text x=\"%d\" y=\"%d\">%s%s</text>\n", LIST + 30, y, study->methods[i].name,
                bias_words(&study->methods[i]));
    }
}

// On a page: a box to tick for each curve.
static void print_boxes(FILE *out, const Study *study, const bool chosen[STUDY_METHODS])
{
    fputs("<fieldset class=\"curves\"><legend>Curves</legend>\n", out);
    for (int i = 0; i < study->count; i++) {
        const StudyMethod *method = &study->methods[i];
        if (method->count > 0) {
            fprintf(out,
                    "<label><input type=\"checkbox\" data-curve=\"%d\"%s><svg class=\"key\" viewBox=\"0 0 26 12\" "
                    "aria-hidden=\"true\">",
                    i, chosen[i] ? " checked" : "");
            print_key(out, study, i, 13, 6);
            fprintf(out, "</svg>%s%s</label>\n", method->name, bias_words(method));
        }
    }
    fputs("</fieldset>\n", out);
}

static void print_svg(const Study *study, FILE *out, bool is_alone, const bool chosen[STUDY_METHODS])
{
    Scale scale = scale_of(study);

    fprintf(out,
            "<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" "
            "font-size=\"12\"%s role=\"img\" aria-label=\"Error against time, both in logarithms\">\n",
            is_alone ? LIST + LIST_WIDTH : WIDTH, HEIGHT,
            is_alone ? " color=\"black\" fill=\"black\" style=\"background: white\"" : " fill=\"currentColor\"");
    print_axes(out, &scale);
    if (study->floor > 0.0) {
        double y = place_y(&scale, study->floor);
        print_line(out, LEFT, y, WIDTH - RIGHT, y, "stroke: #d62728; stroke-dasharray: 1 3");
        fprintf(out, "<text x=\"%d\" y=\"%.1f\">the reference's own error</text>\n", LEFT + 6, y - 4);
    }
    if (study->count > 0 && study->methods[0].count > 0 && is_shown(&study->methods[0].points[0])) {
        print_guide(out, study, &scale, -0.5);
        print_guide(out, study, &scale, -0.75);
    }
    for (int i = 0; i < study->count; i++) {
        print_method(out, study, &scale, i, chosen[i]);
    }
    if (is_alone) {
        print_list(out, study);
    }
    fputs("</svg>\n", out);
}

void study_plot(const Study *study, FILE *out, bool is_alone)
{
    bool chosen[STUDY_METHODS] = {false};

    if (is_alone) {
        memset(chosen, 1, sizeof chosen);
        print_svg(study, out, true, chosen);
        return;
    }
    curves_choose(study, chosen);
    fputs("<div class=\"curves\">\n", out);
    print_svg(study, out, false, chosen);
    print_boxes(out, study, chosen);
    fputs("</div>\n", out);
}

static StudyMethod *curve_add(Study *plot, const char *name, StudyKind kind)
{
    StudyMethod *method = &plot->methods[plot->count++];

    *method = (StudyMethod){.kind = kind};
    snprintf(method->name, sizeof method->name, "%s", name);
    return method;
}

static void curve_put(StudyMethod *method, const RaceEntry *entry)
{
    if (method->count < STUDY_POINTS && entry->errors[RACE_BY_RTLANG] > 0.0) {
        StudyPoint *point = &method->points[method->count++];
        *point = (StudyPoint){.seconds = entry->seconds[RACE_CPU], .rmse = entry->errors[RACE_BY_RTLANG]};
        snprintf(point->setting, sizeof point->setting, "%s", entry->setting);
    }
}

static int by_seconds(const void *a, const void *b)
{
    double x = ((const StudyPoint *)a)->seconds, y = ((const StudyPoint *)b)->seconds;

    return x < y ? -1 : x > y;
}

void race_plot(const Race *race, FILE *out, bool is_alone)
{
    static const char *const names[2][2] = {{"POV-Ray +AM1 -J", "POV-Ray +AM1 +J"},
                                            {"POV-Ray +AM2 -J", "POV-Ray +AM2 +J"}};
    Study *plot = calloc(1, sizeof *plot);

    if (!plot) {
        return; // a plot less
    }
    plot->floor = race->floor;
    for (int ladder = 0; ladder < 2; ladder++) {
        StudyMethod *method = curve_add(plot, ladder == 0 ? "rtlang" : "rtlang adaptive", STUDY_SAMPLER);
        for (int i = 0; i < race->rtlang_count; i++) {
            if (race->rtlang[i].is_adaptive == (ladder == 1)) {
                curve_put(method, &race->rtlang[i]);
            }
        }
    }
    for (int kind = 0; kind < 4; kind++) {
        StudyMethod *method = curve_add(plot, names[kind / 2][kind % 2], STUDY_POVRAY);
        for (int i = 0; i < race->povray_count; i++) {
            const RaceEntry *entry = &race->povray[i];
            bool is_kind = entry->method == kind / 2 + 1 && entry->has_jitter == (kind % 2 == 1);
            if (is_kind && race_is_front(race, entry, RACE_CPU, RACE_BY_RTLANG)) {
                curve_put(method, entry);
            }
        }
        qsort(method->points, (size_t)method->count, sizeof *method->points, by_seconds);
    }
    study_plot(plot, out, is_alone);
    free(plot);
}
