// What rtcheck knows about a scene, and how it prints it: a line of text, or a line of JSON.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_REPORT_H
#define CHECK_REPORT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "image/image.h"

enum { REPORT_DETAIL = 1024, REPORT_RANGE = 128 };

// What is counted in ImageDifference.pixels_beyond: pixels that are farther apart than …
enum { BEYOND_THRESHOLD, BEYOND_CODE_16, BEYOND_CODE_8 }; // the threshold asked for, 1/65535, 1/255

typedef struct Outcome {
    const char *scene;
    bool compared; // both pictures were made and read
    bool agrees;
    uint64_t decided_by_rounding; // pixels beyond the threshold that are other where the scene is put elsewhere
    uint64_t povray_elsewhere;    // pixels beyond the threshold in which POV-Ray does not agree with itself
    int64_t larger;               // pixels beyond it where the scene is larger, or -1: see elsewhere_larger
    ImageDifference difference;
    double flip;
    double rtlang_seconds, povray_seconds; // whole run of a renderer, from text to file
    char range[REPORT_RANGE];              // how the scene is outside of POV-Ray's range; "" inside
    char detail[REPORT_DETAIL];            // why nothing could be compared
} Outcome;

// A difference in steps of 1/65535.
double report_steps(double difference);

void report_text(FILE *out, const Outcome *outcome);
void report_json(FILE *out, const Outcome *outcome); // one object, no line end

#endif
