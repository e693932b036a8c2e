// The sections of the report that tell of scenes: a table of all of them, and each one's pictures.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_REPORT_SCENES_H
#define CHECK_REPORT_SCENES_H

#include <stdio.h>

#include "check/options.h"
#include "check/report.h"
#include "check/report_html.h"
#include "rtlang/rtlang.h"

// Of the differences of pixels in steps of 1/65535: bin 0 holds 0, bin k those of 2^(k-2) + 1 to 2^(k-1).
enum { HISTOGRAM_BINS = 18 };

typedef struct Histogram {
    uint64_t pixels[HISTOGRAM_BINS];
} Histogram;

typedef struct ScenesReport {
    FILE *out;         // of the pictures, which come behind the table; owned
    Outcome *outcomes; // owned
    int count, room;
    Histogram all;
} ScenesReport;

// False when out of memory or of room for files.
bool scenes_report_init(ScenesReport *report, int scene_count);
void scenes_report_fini(ScenesReport *report);

// Adds a scene, its outcome being copied but for the name. Where the pictures were compared, `ours` and `theirs` are
// they, in linear light, and the session has the scene; otherwise they are not read. False when something could
// not be written.
bool scenes_report_add(ScenesReport *report, const Outcome *outcome, const Options *options, rt_session *session,
                       const Image *ours, const Image *theirs);

// Writes the sections. `bar` says in words when a scene agrees.
bool scenes_report_print(ScenesReport *report, ReportPage *page, const char *bar);

// All outcomes as one array of JSON.
void scenes_report_json(const ScenesReport *report, FILE *out);

#endif
