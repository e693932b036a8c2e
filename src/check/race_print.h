// Races as text, JSON and part of a report's section.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_RACE_PRINT_H
#define CHECK_RACE_PRINT_H

#include <stdio.h>

#include "check/race.h"

void race_print_text(const Race *race, FILE *out);
void race_print_json(const Race *race, FILE *out); // one object, no line end
void race_print_html(const Race *race, FILE *out);

// The ratios over the scenes of a run.
enum { RACE_TOTALS = 7 };
typedef struct RaceTotal {
    int scenes[RACE_TOTALS]; // that have this ratio
    double logarithms[RACE_TOTALS], least[RACE_TOTALS];
} RaceTotal;

void race_total_add(RaceTotal *total, const Race *race);
// A line for each ratio, where there are several scenes.
void race_print_total(const RaceTotal *total, FILE *out, const char *before, const char *after);

#endif
