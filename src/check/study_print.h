// Studies as text, CSV, JSON, and sections of the report with a plot.
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

// The table, the plot and the ratios as a section of the page; `number` tells studies of one page apart.
void study_print_section(const Study *study, ReportPage *page, int number);

// The ratio over all scenes, where there are several: a line, and a section.
void study_print_total(const RaceTotal *total, FILE *out);
void study_print_total_section(const RaceTotal *total, ReportPage *page);

// The plot of a race: rtlang's ladders, and POV-Ray's front of each method with and without jitter.
void race_plot(const Race *race, FILE *out, bool is_alone);

// Error against time, both in logarithms, with guides of slope -1/2 and -3/4 and the floor: an <svg> element. In a file
// of its own it needs its own colours.
void study_plot(const Study *study, FILE *out, bool is_alone);

#endif
