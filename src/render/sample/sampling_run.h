// A run of rounds as its parts see it. Private to sampling.c, sampling_work.c and sampling_goal.c.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SAMPLE_SAMPLING_RUN_H
#define RENDER_SAMPLE_SAMPLING_RUN_H

#include "render/sample/sampling.h"

// What is known of the time that rounds take, for what is shown. Rays of one pixel go together, those of others less:
// the rays through corners go together as those of one pixel do, those of the corner pass's pixels are the least
// together.
typedef struct Cost {
    double sample, pixel;           // seconds of the corner pass for each sample, and for each pixel that takes part
    double seconds, by_corner_pass; // of the rounds since, and as the corner pass lets expect; the last counts most
} Cost;

// What a tile's work is.
typedef enum Traces { TRACES_ROUND, TRACES_REPLICAS, TRACES_LOOKS } Traces;

typedef struct Sampling {
    const Prepared *prepared;
    const RenderOptions *options;
    const SamplingOptions *wanted;
    Film *film;
    RenderStatistics *statistics;
    SamplingError *error;
    Round round;
    Estimate estimate;
    Allocation allocation;
    Audit audit;
    Looks looks;
    Traces traces;
    RenderStatistics audited; // their rays: no part of what the picture's own say
    double audit_scale;    // the upper end of an audit's interval, over what the rounds say of the error: expected,
    double audit_least;    // and as low as may be; below it no audit finds the goal reached
    double audit_next;     // samples before which another one would cost too much
    Predictor *predictor;  // NULL: nobody asks
    Cost cost;
    float *corners;        // owned by the caller; NULL: there is no corner pass
    double start;          // by the clock
    double round_end;      // when the last one had been traced
    double sample_seconds; // of a sample, as the last round had it
    double round_samples;  // of this round, or of a slice of it
    double sliced_samples; // of the slices before
    double all_samples;    // of the run, as far as is known; 0: unknown
    double round_pixels;   // that take part, if anybody asks
    double round_seconds;  // predicted of this round
    double later_seconds;  // and of those after it
    RenderResult result;   // of the last round
} Sampling;

static inline double pixel_count(const Sampling *s)
{
    return (double)s->film->width * s->film->height;
}

// ---- sampling_work.c: what is traced, and what that says

// What rounds are chosen by where time is one of the goals: the same in all processes that share the work.
double sampling_seconds(const Sampling *s);

// Traces the round; false when it was cancelled.
bool sampling_trace(Sampling *s);

// The same, and what the pixels say then; cancelled, it leaves pixels with and without the round.
bool sampling_round(Sampling *s);

// After a round that was traced: what rays would have brought that were not followed, if they were as bright as the
// picture is in the mean.
void sampling_find_bias(Sampling *s);

// Looks at small shapes that no sample has met; false when it was cancelled.
bool sampling_look(Sampling *s);

// Whether the picture is judged by replicas: sets that are no sequences are two independent halves, which need none.
bool sampling_has_audit(const SamplingOptions *wanted);

// Judges the picture by replicas of some pixels, and by what small shapes would bring that no sample has met; false
// when it was cancelled.
bool sampling_audit(Sampling *s);

// When the run ends: by how much what no sample has met may change the picture.
void sampling_find_missed(Sampling *s);

// ---- sampling_goal.c: what is left of a goal, and rounds up to it

static const double AUDIT_FACTOR = 1.25; // the width of an audit's interval, as a factor, before one was made
static const double AUDIT_WIDTH = 1.15;  // the same of a narrow one

// What the rounds so far cost.
void goal_count_round(Sampling *s);

// Sets what is predicted: samples of the whole run, and seconds.
void goal_predict(Sampling *s);

// Whether one of the goals is reached; sets the error's `end` then.
bool goal_is_reached(Sampling *s);

// Seconds that rounds may still take; HUGE_VAL without a limit.
double goal_seconds(Sampling *s);

typedef enum Last {
    LAST_NOT,  // there will be another round
    LAST_DONE, // as many samples as are wanted
    LAST_TIME,
    LAST_INTERRUPTED,
} Last;

// Traces the round that was chosen; in slices where it may be the last.
Last goal_run_chosen(Sampling *s);

#endif
