// The study of error against time: one scene, several methods, each at a ladder of costs, against one reference.
//
// Turns a scene into a table of what each run cost and how far its picture was from the reference, lines through the
// points, and what follows from them: which methods stay biased, and how long each takes to an equal error. The
// reference is made by another sampler; its own error is known and is the floor below which nothing is reported. The time
// of metrics is in no run's time. Knows nothing of how it is printed.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_STUDY_H
#define CHECK_STUDY_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>

#include "check/race.h"
#include "check/study_budget.h"
#include "image/image.h"

enum { STUDY_POINTS = 32, STUDY_METHODS = 20, STUDY_TEXT = 256 };

// One rung of a method's ladder. Errors are of values clamped to 0..1, in linear light.
typedef struct StudyPoint {
    char setting[48];
    double samples; // rays a pixel; 0: not known
    double effort;  // what was asked for: samples, photons, POV-Ray's depth as the most samples that it allows
    double seconds; // of processor time, one thread, tracing alone; median of the runs
    double rmse;    // root of the mean square over the runs
    double relmse;  // mean of (x - r)² / (r² + 0.01)
    double greatest, p999, flip;
    double estimate; // what the run itself said of its error; 0: nothing
} StudyPoint;

typedef enum StudyKind {
    STUDY_SAMPLER,   // rtlang's kernels
    STUDY_REFERENCE, // its reference kernels, in one precision each
    STUDY_FORWARD,   // its forward tracer
    STUDY_POVRAY,    // in plots of a race
} StudyKind;

typedef struct StudyMethod {
    char name[48];
    StudyKind kind;
    double photons_an_arrival; // STUDY_FORWARD: how many leave a light for one that counts
    StudyPoint points[STUDY_POINTS];
    int count;
    double slope, slope_spread; // of log rmse in log seconds; half of the 95 % interval; NAN: too few points
    bool is_biased;             // more time did not help, well above the floor
} StudyMethod;

typedef struct Study {
    const char *scene;
    int width, height;
    StudyMethod methods[STUDY_METHODS];
    int count;
    double reference_samples; // as the run counted them
    bool has_methods;         // with settings->only_race there is the race alone
    bool has_race;
    Race race;
    double floor;             // the reference's own error
    double model, arithmetic; // root mean squares, one ray a pixel: against POV-Ray, against quad; NAN: not known
    double depth_bias;        // what a greater max_trace_level changes in the reference; 0: nothing was cut
    double cut_bias;          // what the renderer says that cut rays would add in the mean
    double arithmetic_float;  // that of the float reference kernel; NAN: not known
    char arithmetic_why[STUDY_TEXT]; // not known, why
    char forward_why[STUDY_TEXT];    // why there is no forward method; "" if there is
    Image picture;                   // the reference of the methods, or of the race where there is that alone; owned
    int ladder_top;                  // samples a pixel, the most that a ladder may have
    StudyBudget budget;              // what is left of it, and what it left out
    double seconds;                  // that the study took by the clock
    char fault[STUDY_TEXT];          // why there is no study
} Study;

struct StudySettings {
    const char *povray; // NULL: without
    char *const *include_paths;
    int include_path_count;
    int width, height;
    const double *clock;
    const char *folder; // for pictures and logs
    int repeats;        // runs with different seeds, of which means are taken
    int most_samples;   // of a ladder, >= 64; photons grow along
    int reference_samples;       // 0: 16 times as many as a ladder has at its top, of a race 256
    int race_width, race_height; // 0: as large as it takes
    double seconds;              // that a study may take by the clock; 0: no limit
    bool shows_progress;
    StudyBudget *budget;         // of the study that runs; study_run sets it
    bool only_race;              // without the ladders of all methods
    const volatile sig_atomic_t *interrupted;
};

// False when there is no study: `fault` says why.
bool study_run(Study *study, const char *scene, const StudySettings *settings);

void study_fini(Study *study);

// The one sentence that a reader wants: the error, rtlang's time to it, and POV-Ray's, or where there was no race that of
// plain random samples.
void study_verdict(const Study *study, char text[STUDY_TEXT]);

// ---- study_metric.c

typedef struct StudyMetric {
    double rmse, relmse, greatest, p999, flip;
} StudyMetric;

// Both clamped. False when out of memory or the sizes differ.
bool study_compare(const Image *picture, const Image *reference, StudyMetric *metric);

// The line through the points, and whether time still helps.
void study_fit(StudyMethod *method, double floor);

#endif
