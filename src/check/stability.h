// What `rtcheck --stability` measures: formulas on hard rays, stiff paths, and pictures of scenes put elsewhere.
//
// Measuring, printing and the page are apart: stability_measure fills a Stability, the others read it.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_STABILITY_H
#define CHECK_STABILITY_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "check/options.h"
#include "check/report_html.h"
#include "study/spheres.h"

enum { FAMILIES_MOST = 32, SCALES = 9, MIRRORS = 3, SHELLS = 6 };

// One picture beside another of the same scene.
typedef struct PictureRow {
    const char *scene;
    char what[48];        // how it was put elsewhere
    const char *beside;   // what it is compared with
    bool is_made;         // false: the scene could not be read, or the reference path refuses it
    bool is_same;         // bit for bit
    uint64_t values, off; // values of the picture; those that differ by more than 1e-6
    double rmse;
} PictureRow;

// A stiff scene in each precision, and by POV-Ray.
enum { SHOWN_FLOAT, SHOWN_DOUBLE, SHOWN_QUAD, SHOWN_POVRAY, SHOWN };
typedef struct ShownRow {
    const char *scene;
    bool has[SHOWN]; // false: it cannot be drawn so
    Image in[SHOWN]; // owned
} ShownRow;

// A scene where POV-Ray's fixed tolerances end.
typedef struct BreakRow {
    const char *scene, *what; // how it was put elsewhere
    bool has_povray;          // its picture could be made
    uint64_t povray_off, off; // pixels that differ from the scene where it says by more than 2/255
    uint64_t pixels;
    Image ours, povray; // owned
} BreakRow;

enum { BREAKS = 9, STIFF_SCENES = 7 };

typedef struct Stability {
    SphereRow families[FAMILIES_MOST];
    size_t family_count;
    DistancePoint distances[DISTANCE_POINTS];
    SecondaryRow secondary[SCALES];
    MirrorRow mirrors[MIRRORS];
    ShellRow shells[SHELLS];
    TotalRow total;
    uint64_t malformed, malformed_hits[FORMULAS];
    PictureRow *pictures; // owned
    size_t picture_count, picture_room;
    ShownRow shown[STIFF_SCENES];
    size_t shown_count;
    BreakRow *breaks; // owned; BREAKS for each scene
    size_t break_count;
} Stability;

// Measures all. `povray` may be NULL, `folder` is one for temporary files. False when out of memory.
bool stability_measure(Stability *stability, const Options *options, const char *povray, const char *folder);
void stability_fini(Stability *stability);

// stability_pictures.c: the pictures of stiff scenes and of the options' scenes.
bool stability_pictures(Stability *stability, const Options *options, const char *povray, const char *folder);

// stability_breaks.c: POV-Ray's limits.
bool stability_breaks(Stability *stability, const Options *options, const char *povray, const char *folder);

// True when nothing is worse than docs/numerics.md promises of ours.
bool stability_holds(const Stability *stability);

void stability_print(const Stability *stability, FILE *out);
void stability_json(const Stability *stability, FILE *out);
// stability_html.c
bool stability_page(const Stability *stability, ReportPage *page);

#endif
