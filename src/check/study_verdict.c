// The one sentence of a study.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check/study.h"

static const double GOAL = 0.01; // an error that is hard to see

// How far an error is from the goal, by factors.
static double off_goal(double error)
{
    return fabs(log(error / GOAL));
}

// The setting of POV-Ray at the front that is nearest to the goal and that rtlang's ladders reach; NULL: none.
static const RaceEntry *race_setting(const Race *race)
{
    const RaceEntry *found = NULL;

    for (int i = 0; i < race->povray_count; i++) {
        const RaceEntry *entry = &race->povray[i];
        double error = entry->errors[RACE_BY_RTLANG];
        if (race_is_front(race, entry, RACE_CPU, RACE_BY_RTLANG) &&
            !isnan(race_time_to(race, error, RACE_CPU, RACE_BY_RTLANG)) &&
            (!found || off_goal(error) < off_goal(found->errors[RACE_BY_RTLANG]))) {
            found = entry;
        }
    }
    return found;
}

static void race_verdict(const Race *race, char text[STUDY_TEXT])
{
    const RaceEntry *entry = race_setting(race);

    if (!entry) {
        snprintf(text, STUDY_TEXT, "No setting of POV-Ray's was run whose error rtlang's ladders reach.");
        return;
    }
    double error = entry->errors[RACE_BY_RTLANG], theirs = entry->seconds[RACE_CPU];
    double ours = race_time_to(race, error, RACE_CPU, RACE_BY_RTLANG);
    snprintf(text, STUDY_TEXT, "To an error of %.2g, rtlang takes %.2g s, POV-Ray %.2g s (%s): %.1f times.", error, ours,
             theirs, entry->setting, theirs / ours);
}

static const StudyMethod *method_of(const Study *study, const char *name)
{
    for (int i = 0; i < study->count; i++) {
        if (strcmp(study->methods[i].name, name) == 0) {
            return &study->methods[i];
        }
    }
    return NULL;
}

// Seconds to an error on the line between two rungs of a ladder, in logarithms; NAN where it does not reach.
static double method_time_to(const StudyMethod *method, double error)
{
    double best = (double)NAN;

    for (int i = 0; i + 1 < method->count; i++) {
        const StudyPoint *a = &method->points[i], *b = a + 1;
        double share = log(error / a->rmse) / log(b->rmse / a->rmse);
        if (share >= 0.0 && share <= 1.0 && a->seconds > 0.0 && b->seconds > 0.0) {
            best = fmin(best, a->seconds * pow(b->seconds / a->seconds, share));
        }
    }
    return best;
}

// At the rung of random samples that is nearest to the goal and that others reach.
static void methods_verdict(const Study *study, char text[STUDY_TEXT])
{
    const StudyMethod *sobol = method_of(study, "rtlang sobol"), *adaptive = method_of(study, "rtlang adaptive");
    const StudyMethod *random = method_of(study, "rtlang random");
    const StudyPoint *found = NULL;
    double ours = (double)NAN;

    for (int i = 0; sobol && adaptive && random && i < random->count; i++) {
        const StudyPoint *point = &random->points[i];
        double time = fmin(method_time_to(sobol, point->rmse), method_time_to(adaptive, point->rmse));
        if (!isnan(time) && point->rmse > 0.0 && (!found || off_goal(point->rmse) < off_goal(found->rmse))) {
            found = point;
            ours = time;
        }
    }
    if (found) {
        snprintf(text, STUDY_TEXT, "To an error of %.2g, rtlang takes %.2g s, with plain random samples %.2g s: %.1f times.",
                 found->rmse, ours, found->seconds, found->seconds / ours);
    } else {
        snprintf(text, STUDY_TEXT, "Too few rungs were run to say how long an error takes.");
    }
}

void study_verdict(const Study *study, char text[STUDY_TEXT])
{
    if (study->has_race) {
        race_verdict(&study->race, text);
    } else {
        methods_verdict(study, text);
    }
}
