// What rtcheck prints about a scene: a line of text, or a line of JSON.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_REPORT_H
#define CHECK_REPORT_H

#include <stdbool.h>
#include <stdio.h>

#include "image/image.h"

enum { REPORT_DETAIL = 1024 };

typedef struct Outcome {
    const char *scene;
    bool compared; // both pictures were made and read
    bool agrees;
    ImageDifference difference;
    double rtlang_seconds, povray_seconds; // whole run of a renderer, from text to file
    char detail[REPORT_DETAIL];            // why nothing could be compared
} Outcome;

void report_text(FILE *out, const Outcome *outcome);
void report_json(FILE *out, const Outcome *outcome);

#endif
