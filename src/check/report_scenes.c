// Rows of the table at once, pictures as they come: those of all scenes together need not fit into memory.
//
// SPDX-License-Identifier: MIT
#include "check/report_scenes.h"

#include "check/report_rays.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const ImageEncoding for_screens = {.depth = IMAGE_DEPTH_8, .transfer = IMAGE_TRANSFER_SRGB};
static const ImageEncoding as_codes = {
    .depth = IMAGE_DEPTH_8, .transfer = IMAGE_TRANSFER_SRGB, .already_encoded = true};

// ---- the scale of differences, logarithmic: 0 for equal pixels, 1 for those that are as far apart as can be

static const struct {
    double place;
    unsigned char colour[3];
} heat_stops[] = {
    {0.0, {10, 10, 20}},   {0.06, {44, 22, 92}},   {0.25, {118, 28, 118}}, {0.5, {212, 62, 78}},
    {0.7, {245, 140, 40}}, {0.88, {252, 216, 96}}, {1.0, {255, 255, 240}},
};

static double heat_place(double steps)
{
    return fmin(log2(1.0 + steps) / 16.0, 1.0);
}

// Codes from 0 to 1.
static void heat_colour(double place, float colour[3])
{
    size_t i = 1;
    double share;

    while (i < RT_COUNT_OF(heat_stops) - 1 && heat_stops[i].place < place) {
        i++;
    }
    share = (place - heat_stops[i - 1].place) / (heat_stops[i].place - heat_stops[i - 1].place);
    for (int c = 0; c < 3; c++) {
        double low = heat_stops[i - 1].colour[c], high = heat_stops[i].colour[c];
        colour[c] = (float)((low + share * (high - low)) / 255.0);
    }
}

static void heat_print_scale(FILE *out)
{
    static const struct {
        double steps;
        const char *words;
    } marks[] = {{0, "0"}, {2, "2"}, {16, "16"}, {257, "257 = 1/255"}, {4096, "4096"}, {65535, "65535"}};

    fputs(
        "<p class=\"tools\"><label>Scale of the difference <select class=\"scale-choice\"><option "
        "value=\"0\">logarithmic, "
        "to 65535</option><option value=\"16\">even, to 16</option><option value=\"257\">even, to 257 = 1/255</option>"
        "<option value=\"4096\">even, to 4096</option><option value=\"65535\">even, to "
        "65535</option></select></label></p>\n"
        "<div class=\"scale\" role=\"img\" aria-label=\"Scale of differences in steps of 1/65535\" data-stops=\"[",
        out);
    for (size_t i = 0; i < RT_COUNT_OF(heat_stops); i++) {
        const unsigned char *c = heat_stops[i].colour;
        fprintf(out, "%s[%g,%d,%d,%d]", i > 0 ? "," : "", heat_stops[i].place, c[0], c[1], c[2]);
    }
    fputs("]\"><div class=\"colours\" style=\"background: linear-gradient(to right", out);
    for (size_t i = 0; i < RT_COUNT_OF(heat_stops); i++) {
        const unsigned char *c = heat_stops[i].colour;
        fprintf(out, ", rgb(%d %d %d) %g%%", c[0], c[1], c[2], 100.0 * heat_stops[i].place);
    }
    fputs(")\"></div>", out);
    for (size_t i = 0; i < RT_COUNT_OF(marks); i++) {
        fprintf(out, "<span class=\"mark\" style=\"left: %.2f%%\">%s</span>", 100.0 * heat_place(marks[i].steps),
                marks[i].words);
    }
    fputs("</div>\n", out);
}

// ---- the histogram

static int histogram_bin(double steps)
{
    return steps < 0.5 ? 0 : steps < 1.5 ? 1 : (int)fmin(ceil(log2(steps)), 16.0) + 1;
}

// The greatest difference that a bin holds.
static long histogram_end(int bin)
{
    return bin == 0 ? 0 : bin < HISTOGRAM_BINS - 1 ? 1L << (bin - 1) : 65535L;
}

static void histogram_words(int bin, char words[32])
{
    long low = bin == 0 ? 0 : histogram_end(bin - 1) + 1;

    snprintf(words, 32, low == histogram_end(bin) ? "%ld" : "%ld to %ld", low, histogram_end(bin));
}

// Bars whose heights are the logarithms of the counts.
static void histogram_print(FILE *out, const Histogram *histogram, const char *name)
{
    enum { LEFT = 8, BAR = 36, GAP = 4, HEIGHT = 110, TOP = 16, ALL = 150 };
    uint64_t pixels = 0;

    for (int i = 0; i < HISTOGRAM_BINS; i++) {
        pixels += histogram->pixels[i];
    }
    fprintf(out,
            "<div class=\"histogram\" tabindex=\"0\" role=\"region\" aria-label=\"Histogram of differences, %s\">"
            "<svg class=\"plot\" viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"Histogram of differences\">\n",
            name, LEFT + HISTOGRAM_BINS * (BAR + GAP), ALL);
    for (int i = 0; i < HISTOGRAM_BINS; i++) {
        double count = (double)histogram->pixels[i];
        double height = pixels > 0 ? HEIGHT * log10(1.0 + count) / log10(1.0 + (double)pixels) : 0.0;
        int x = LEFT + i * (BAR + GAP);
        char words[32];

        histogram_words(i, words);
        fprintf(out, "<g><title>%s of 65535: %" PRIu64 " pixels, %.4f %%</title>", words, histogram->pixels[i],
                pixels > 0 ? 100.0 * count / (double)pixels : 0.0);
        fprintf(out, "<rect x=\"%d\" y=\"%.1f\" width=\"%d\" height=\"%.1f\"/>", x, TOP + HEIGHT - height, BAR, height);
        if (histogram->pixels[i] > 0) {
            fprintf(out, "<text x=\"%d\" y=\"%.1f\" text-anchor=\"middle\">%" PRIu64 "</text>", x + BAR / 2,
                    TOP + HEIGHT - height - 4.0, histogram->pixels[i]);
        }
        fprintf(out, "<text x=\"%d\" y=\"%d\" text-anchor=\"middle\">%ld</text></g>\n", x + BAR / 2, TOP + HEIGHT + 15,
                histogram_end(i));
    }
    fprintf(out, "<line x1=\"%d\" y1=\"%d\" x2=\"%d\" y2=\"%d\"/></svg></div>\n", LEFT, TOP + HEIGHT,
            LEFT + HISTOGRAM_BINS * (BAR + GAP) - GAP, TOP + HEIGHT);
}

// ---- a scene's pictures

static bool figure_print(ScenesReport *report, const Image *image, const ImageEncoding *encoding, const char *words,
                         const char *attribute)
{
    bool fine;

    fprintf(report->out, "<figure><button type=\"button\" aria-pressed=\"false\"><img%s alt=\"", attribute);
    html_text(report->out, words);
    fprintf(report->out, "\" width=\"%d\" height=\"%d\" src=\"", image->width, image->height);
    fine = html_picture(report->out, image, encoding);
    fputs("\"></button><figcaption>", report->out);
    html_text(report->out, words);
    fputs("</figcaption></figure>\n", report->out);
    return fine;
}

// The map of differences in colours, and the same as exact steps for the pointer.
static bool differences_print(ScenesReport *report, const Image *ours, const Image *theirs, Histogram *histogram)
{
    Image heat = {0}, exact = {0};
    bool fine = image_init(&heat, ours->width, ours->height, 3) && image_init(&exact, ours->width, ours->height, 3);

    for (size_t i = 0; fine && i < (size_t)ours->width * (size_t)ours->height; i++) {
        double steps = round(report_steps(fmin(image_pixel_difference(ours, theirs, i), 1.0)));

        heat_colour(heat_place(steps), heat.values + 3 * i);
        exact.values[3 * i] = (float)(floor(steps / 256.0) / 255.0);
        exact.values[3 * i + 1] = (float)(fmod(steps, 256.0) / 255.0);
        histogram->pixels[histogram_bin(steps)]++;
    }
    fine = fine && figure_print(report, &heat, &as_codes, "the difference", " class=\"difference\"");
    if (fine) {
        fputs("<img class=\"steps\" alt=\"\" hidden src=\"", report->out);
        fine = html_picture(report->out, &exact, &as_codes);
        fputs("\">\n", report->out);
    }
    image_fini(&heat);
    image_fini(&exact);
    return fine;
}

static bool pictures_print(ScenesReport *report, const Image *ours, const Image *theirs)
{
    Histogram histogram = {0};
    bool fine;

    fputs("<div class=\"pictures\">\n", report->out);
    fine = figure_print(report, ours, &for_screens, "rtlang", "") &&
           figure_print(report, theirs, &for_screens, "POV-Ray", "") &&
           differences_print(report, ours, theirs, &histogram);
    fputs("</div>\n<output class=\"probe\"></output>\n", report->out);
    char name[32];
    snprintf(name, sizeof name, "scene %d", report->count);
    histogram_print(report->out, &histogram, name);
    for (int i = 0; i < HISTOGRAM_BINS; i++) {
        report->all.pixels[i] += histogram.pixels[i];
    }
    return fine;
}

bool scenes_report_init(ScenesReport *report, int scene_count)
{
    *report = (ScenesReport){.room = scene_count};
    report->outcomes = calloc((size_t)scene_count + 1, sizeof *report->outcomes);
    report->out = tmpfile();
    return report->outcomes && report->out;
}

void scenes_report_fini(ScenesReport *report)
{
    if (report->out) {
        fclose(report->out);
    }
    free(report->outcomes);
}

static void range_print(FILE *out, const Outcome *outcome)
{
    if (outcome->range[0] != '\0') {
        fputs("<p class=\"faint\">This scene is ", out);
        html_text(out, outcome->range);
        fputs(".</p>\n", out);
    }
}

bool scenes_report_add(ScenesReport *report, const Outcome *outcome, const Options *options, rt_session *session,
                       const Image *ours, const Image *theirs)
{
    FILE *out = report->out;
    bool fine = report->count < report->room;

    if (!fine) {
        return false;
    }
    report->outcomes[report->count++] = *outcome;
    fprintf(out, "<article id=\"scene-%d\"%s>\n<h3>", report->count, outcome->agrees ? "" : " class=\"failed\"");
    html_text(out, outcome->scene);
    fputs("</h3>\n", out);
    range_print(out, outcome);
    if (outcome->compared) {
        fine = pictures_print(report, ours, theirs);
        report_rays(out, &(ComparedScene){report->count, outcome->scene, session, ours, theirs}, options);
    } else {
        fputs("<pre>", out);
        html_text(out, outcome->detail);
        fputs("</pre>\n", out);
    }
    fputs("</article>\n", out);
    return fine && ferror(out) == 0;
}

// ---- the sections

static void cell_number(FILE *out, const char *format, double value, const char *unit)
{
    if (!isfinite(value)) {
        fputs("<td class=\"number\" data-sort=\"1e308\" title=\"infinite\">\342\210\236</td>", out);
        return;
    }
    fprintf(out, "<td class=\"number\" data-sort=\"%.17g\" title=\"%.9g%s\">", value, value, unit);
    fprintf(out, format, value);
    fputs("</td>", out);
}

static void cell_count(FILE *out, uint64_t count, uint64_t pixels)
{
    fprintf(out, "<td class=\"number\" title=\"%" PRIu64 " of %" PRIu64 " pixels, %.6f %%\">%" PRIu64 "</td>", count,
            pixels, 100.0 * (double)count / (double)pixels, count);
}

// How long the name of a folder is that all scenes are in.
static size_t common_folder(const ScenesReport *report)
{
    const char *first = report->count > 0 ? report->outcomes[0].scene : "";
    size_t length = strlen(first);

    for (int i = 1; i < report->count; i++) {
        size_t same = 0;
        while (same < length && report->outcomes[i].scene[same] == first[same]) {
            same++;
        }
        length = same;
    }
    while (length > 0 && first[length - 1] != '/') {
        length--;
    }
    return length;
}

static void row_print(FILE *out, const Outcome *outcome, int number, size_t folder_length)
{
    const ImageDifference *d = &outcome->difference;
    const char *verdict = !outcome->compared ? "failed" : outcome->agrees ? "agrees" : "differs";

    fprintf(out, "<tr><td><a href=\"#scene-%d\" title=\"", number);
    html_text(out, outcome->scene);
    fputs("\">", out);
    html_text(out, outcome->scene + folder_length);
    fprintf(out, "</a></td><td class=\"%s\"", outcome->agrees ? "good" : "bad");
    if (outcome->range[0] != '\0') {
        fputs(" title=\"", out);
        html_text(out, outcome->range);
        fputs("\"", out);
    }
    fprintf(out, ">%s%s</td>", verdict, outcome->range[0] != '\0' ? ", out of range" : "");
    if (!outcome->compared) {
        for (int i = 0; i < 10; i++) {
            fputs("<td></td>", out);
        }
        fputs("</tr>\n", out);
        return;
    }
    cell_number(out, "%.0f", report_steps(d->max), " of 65535");
    cell_number(out, "%.3f", report_steps(d->rmse), " of 65535");
    cell_number(out, "%.1f", d->psnr, " dB");
    cell_number(out, "%.2e", outcome->flip, "");
    for (int i = 0; i < IMAGE_THRESHOLDS; i++) {
        cell_count(out, d->pixels_beyond[i], d->pixels);
    }
    cell_number(out, "%.3f", outcome->rtlang_seconds, " s");
    cell_number(out, "%.3f", outcome->povray_seconds, " s");
    cell_number(out, "%.1f", outcome->povray_seconds / outcome->rtlang_seconds, "");
    fputs("</tr>\n", out);
}

static void table_print(FILE *out, const ScenesReport *report)
{
    static const char *const headings[] = {
        "max", "RMSE", "PSNR", "FLIP", "beyond bar", "beyond 1/65535", "beyond 1/255", "rtlang s", "POV-Ray s", "ratio",
    };

    report_table_heading(out, "Scenes");
    fputs("<th scope=\"col\">scene</th><th scope=\"col\">verdict</th>", out);
    for (size_t i = 0; i < RT_COUNT_OF(headings); i++) {
        fprintf(out, "<th scope=\"col\" class=\"number\">%s</th>", headings[i]);
    }
    report_table_rows(out);
    for (int i = 0; i < report->count; i++) {
        row_print(out, &report->outcomes[i], i + 1, common_folder(report));
    }
    report_table_close(out);
}

static bool stream_copy(FILE *from, FILE *to)
{
    char bytes[BUFSIZ];
    size_t count;

    rewind(from);
    while ((count = fread(bytes, 1, sizeof bytes, from)) > 0) {
        fwrite(bytes, 1, count, to);
    }
    return ferror(from) == 0;
}

bool scenes_report_print(ScenesReport *report, ReportPage *page, const char *bar)
{
    FILE *out = report_page_section(page, "scenes", "Scenes");
    int agreeing = 0;

    for (int i = 0; i < report->count; i++) {
        agreeing += report->outcomes[i].agrees ? 1 : 0;
    }
    fprintf(out, "<p>%d of %d scenes agree. ", agreeing, report->count);
    html_text(out, bar);
    fputs("</p>\n", out);
    table_print(out, report);
    fputs("<p class=\"faint\">Differences are in steps of 1/65535 of linear light. FLIP is the mean of LDR-FLIP at "
          "67.02 pixels per degree. Seconds are those of whole runs.</p>\n",
          out);
    out = report_page_section(page, "differences", "Differences of all pixels");
    fputs("<p class=\"faint\">How many pixels of all scenes differ by how many steps of 1/65535. Below each bar stands "
          "the greatest difference in it; the heights are logarithms.</p>\n",
          out);
    histogram_print(out, &report->all, "all scenes");
    out = report_page_section(page, "pictures", "Pictures");
    fputs("<p>The difference of a pixel is that of the channel that differs most, on this scale of steps of "
          "1/65535:</p>\n",
          out);
    heat_print_scale(out);
    return stream_copy(report->out, out);
}

void scenes_report_json(const ScenesReport *report, FILE *out)
{
    fputs("[\n", out);
    for (int i = 0; i < report->count; i++) {
        report_json(out, &report->outcomes[i]);
        fputs(i + 1 < report->count ? ",\n" : "\n", out);
    }
    fputs("]\n", out);
}
