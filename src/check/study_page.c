// A study on a page: the verdict first, the picture and the plot, what each number means, and the tables last.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "check/study_print.h"

enum { PICTURE_WIDTH = 480 };

static const ReportColumn columns[] = {
    {"method", "How a pixel's rays are chosen, or who draws."},
    {"setting", "What the run was asked for."},
    {"samples", "Rays from the camera for a pixel, as the run counted them; of photons, those for a pixel."},
    {"seconds", "Time of the processor, one thread, preparing and tracing. Reading, writing and comparing are not in it."},
    {"rmse", "The error: the root of the mean square distance from the reference, in linear light from 0 to 1. "
             "0.01 is hard to see."},
    {"relMSE", "The mean square distance, each divided by the square of what is there plus 0.01: dark parts count like "
               "bright ones."},
    {"max", "The greatest distance of any channel of any pixel. One pixel decides it."},
    {"99.9 %", "One pixel in a thousand is farther off than that."},
    {"FLIP", "How much an eye notices when the picture and the reference are flipped, from 0 to 1 (LDR-FLIP, 67 pixels a "
             "degree)."},
    {"efficiency", "One over seconds times the square of rmse. Twice as much: the same error in half the time."},
    {"slope", "The power of the time with which the error falls: -0.5 takes four times as long for half the error, "
              "-1 twice. Then half of its 95 % interval."},
};

static void print_table(const Study *study, FILE *out)
{
    report_table_open(out, "All runs of the study", columns, RT_COUNT_OF(columns));
    for (int i = 0; i < study->count; i++) {
        const StudyMethod *method = &study->methods[i];
        for (int j = 0; j < method->count; j++) {
            const StudyPoint *p = &method->points[j];
            const double numbers[] = {p->samples,  p->seconds, p->rmse, p->relmse,
                                      p->greatest, p->p999,    p->flip, study_efficiency(p)};
            fprintf(out, "<tr><td>%s</td><td>%s</td>", method->name, p->setting);
            for (size_t k = 0; k < RT_COUNT_OF(numbers); k++) {
                fprintf(out, "<td class=\"number\" data-sort=\"%.9g\">%.4g</td>", numbers[k], numbers[k]);
            }
            if (isnan(method->slope)) {
                fputs("<td></td></tr>\n", out);
            } else {
                fprintf(out, "<td class=\"number%s\" data-sort=\"%.4f\">%.2f", method->is_biased ? " bad" : "",
                        method->slope, method->slope);
                if (!isnan(method->slope_spread)) {
                    fprintf(out, " ± %.2f", method->slope_spread);
                }
                fputs("</td></tr>\n", out);
            }
        }
    }
    report_table_close(out);
}

// Squares of so many pixels become one of their mean.
static bool picture_shrink(const Image *from, int times, Image *to)
{
    if (!image_init(to, from->width / times, from->height / times, 3)) {
        return false;
    }
    for (int y = 0; y < to->height * times; y++) {
        for (int x = 0; x < to->width * times; x++) {
            size_t at = 3 * ((size_t)(y / times) * (size_t)to->width + (size_t)(x / times));
            size_t in = (size_t)from->channels * ((size_t)y * (size_t)from->width + (size_t)x);
            for (size_t c = 0; c < 3; c++) {
                to->values[at + c] += from->values[in + c] / (float)(times * times);
            }
        }
    }
    return true;
}

static void print_picture(const Study *study, FILE *out)
{
    static const ImageEncoding encoding = {.depth = IMAGE_DEPTH_8, .transfer = IMAGE_TRANSFER_SRGB};
    const Image *image = &study->picture;
    Image small = {0};

    if (image->width > 0 && picture_shrink(image, (image->width + PICTURE_WIDTH - 1) / PICTURE_WIDTH, &small)) {
        fprintf(out, "<figure class=\"scene\"><img alt=\"The scene, drawn by rtlang\" width=\"%d\" height=\"%d\" src=\"",
                small.width, small.height);
        html_picture(out, &small, &encoding);
        fputs("\"><figcaption>The reference: the scene with many samples a pixel.</figcaption></figure>\n", out);
    }
    image_fini(&small);
}

static void print_top(const Study *study, FILE *out)
{
    char verdict[STUDY_TEXT];

    study_verdict(study, verdict);
    fputs("<p class=\"verdict\">", out);
    html_text(out, verdict);
    fputs("</p>\n<div class=\"top\">\n", out);
    print_picture(study, out);
    if (study->has_race) {
        race_plot(&study->race, out, false);
    } else {
        study_plot(study, out, false);
    }
    fputs("</div>\n<p>Each mark is a run: to the right it takes longer, further down it is nearer to the reference. The "
          "curve that lies lower left is better. The dashed guides fall as the power -1/2 of the time, which random "
          "samples do, and -3/4.</p>\n",
          out);
    if (study->budget.left_out_count > 0) {
        fputs("<details><summary>What the budget left out</summary><ul>\n", out);
        study_print_budget(study, out, "<li>", "</li>");
        fputs("</ul></details>\n", out);
    }
}

void study_print_section(const Study *study, ReportPage *page, int number)
{
    char id[32], title[STUDY_TEXT];

    snprintf(id, sizeof id, "study-%d", number);
    snprintf(title, sizeof title, "Error against time: %s", study->scene);
    FILE *out = report_page_section(page, id, title);
    print_top(study, out);
    if (study->has_methods) {
        fputs("<h3>rtlang's methods</h3>\n<ul>\n", out);
        study_print_kinds(study, out, "<li>", "</li>");
        study_print_bias(study, out, "<li><strong>", "</strong></li>");
        study_print_forward(study, out, "<li>", "</li>");
        fputs("</ul>\n", out);
        if (study->has_race) {
            study_plot(study, out, false);
        }
        print_table(study, out);
    }
    if (study->has_race) {
        race_print_html(&study->race, out);
    }
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
