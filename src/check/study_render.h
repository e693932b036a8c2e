// One picture by rtlang or by POV-Ray, and what it cost: what ladders and races are made of.
//
// The time of reading a scene and of writing a file is in RtlangRun.whole only; that of comparing pictures in none.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_STUDY_RENDER_H
#define CHECK_STUDY_RENDER_H

#include "peer/povray_run.h"
#include "check/study.h"
#include "rtlang/rtlang.h"

typedef struct RtlangRun {
    rt_method method; // of the run to be made, as is …
    uint64_t photons;
    const char *output; // file to write, of 16 bit; NULL: none
    bool is_optional;   // it ends as RT_CANCELLED when the budget's stage does
    rt_photons counts;
    Image image;
    double seconds; // of the processor, preparing and tracing
    double wall;    // the same by the clock
    double whole;   // of the processor, with reading and writing
    rt_error error;
    rt_status status;
    char fault[STUDY_TEXT];
    const StudySettings *settings; // of the run
    rt_session *session;           // while it runs
} RtlangRun;

// One picture by rtlang, of the settings' size; to be released with image_fini. `threads` 0: as many as the machine has.
void rtlang_render(const char *scene, const StudySettings *settings, const rt_sampling *sampling,
                   rt_precision precision, int threads, RtlangRun *run);

// One picture by POV-Ray. `name` tells files of runs apart that are made at the same time; `switches` as in PovrayJob.
typedef struct PovrayRun {
    const char *name;
    const char *const *switches;
    int threads;
    Image image; // to be released with image_fini
    PovrayCost cost;
    double whole; // of the processor, the whole process
} PovrayRun;

bool povray_render(const char *scene, const StudySettings *settings, PovrayRun *run);

// How many samples a pixel a reference may have that ends within the stage of the budget, at most `most`; where there is
// a limit a short run tells. Notes it under that name if those are fewer.
int study_reference_samples(const char *scene, const StudySettings *settings, int most, const char *name);

// The median of values, which are sorted.
double study_median(double *values, int count);

#endif
