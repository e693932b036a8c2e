// Studies as text, CSV, JSON, and sections of the report with a picture and a plot.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_STUDY_PRINT_H
#define CHECK_STUDY_PRINT_H

#include <stdio.h>

#include "check/race_print.h"
#include "check/report_html.h"
#include "check/study.h"

void study_print_text(const Study *study, FILE *out);
void study_print_csv(const Study *study, FILE *out, bool with_heading);
void study_print_json(const Study *study, FILE *out); // one object, no line end

double study_efficiency(const StudyPoint *point);

// Sentences, one a line, each between `before` and `after`: what the budget left out, the kinds of error, what is biased,
// what photons take.
void study_print_budget(const Study *study, FILE *out, const char *before, const char *after);
void study_print_kinds(const Study *study, FILE *out, const char *before, const char *after);
void study_print_bias(const Study *study, FILE *out, const char *before, const char *after);
void study_print_forward(const Study *study, FILE *out, const char *before, const char *after);

// study_page.c: the table, the plot and the ratios as a section of the page; `number` tells studies of one page apart.
void study_print_section(const Study *study, ReportPage *page, int number);

// The ratio over all scenes, where there are several: a line, and a section.
void study_print_total(const RaceTotal *total, FILE *out);
void study_print_total_section(const RaceTotal *total, ReportPage *page);

// The plot of a race: rtlang's ladders, and POV-Ray's front of each method with and without jitter.
void race_plot(const Race *race, FILE *out, bool is_alone);

// Error against time, both in logarithms, with guides of slope -1/2 and -3/4 and the floor: an <svg> element, which in a
// file of its own has its own colours and a list of the methods. On a page it shows four curves, and a box for each
// shows the others.
void study_plot(const Study *study, FILE *out, bool is_alone);

#endif
