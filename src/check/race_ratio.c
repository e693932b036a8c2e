// The front of POV-Ray's settings, and rtlang's time to the errors there.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stddef.h>

#include "check/race.h"

static bool counts(const RaceEntry *entry, RaceTime time, RaceJudge judge)
{
    return entry->is_run && entry->seconds[time] > 0.0 && entry->errors[judge] > 0.0; // not NAN, either
}

bool race_is_front(const Race *race, const RaceEntry *entry, RaceTime time, RaceJudge judge)
{
    if (!counts(entry, time, judge)) {
        return false;
    }
    for (int i = 0; i < race->povray_count; i++) {
        const RaceEntry *other = &race->povray[i];
        if (counts(other, time, judge) && other->seconds[time] < entry->seconds[time] &&
            other->errors[judge] < entry->errors[judge]) {
            return false;
        }
    }
    return true;
}

// On one ladder: of two neighbouring rungs that the error lies between, the faster way; or a rung that is nearer still.
static double ladder_time(const Race *race, bool is_adaptive, double error, RaceTime time, RaceJudge judge)
{
    const RaceEntry *before = NULL;
    double best = (double)NAN;

    for (int i = 0; i < race->rtlang_count; i++) {
        const RaceEntry *rung = &race->rtlang[i];
        if (rung->is_adaptive != is_adaptive || !counts(rung, time, judge)) {
            continue;
        }
        if (rung->errors[judge] <= error) {
            best = fmin(best, rung->seconds[time]);
        }
        if (before) {
            double high = log(before->errors[judge]), low = log(rung->errors[judge]);
            double share = (log(error) - high) / (low - high);
            if (share >= 0.0 && share <= 1.0) {
                best = fmin(best, exp(log(before->seconds[time]) +
                                      share * (log(rung->seconds[time]) - log(before->seconds[time]))));
            }
        }
        before = rung;
    }
    return best;
}

double race_time_to(const Race *race, double error, RaceTime time, RaceJudge judge)
{
    return fmin(ladder_time(race, false, error, time, judge), ladder_time(race, true, error, time, judge));
}

RaceRatio race_ratio(const Race *race, RaceTime time, RaceJudge judge)
{
    RaceRatio found = {.ratio = (double)NAN, .least = (double)NAN, .greatest = (double)NAN};
    double logarithms = 0.0;

    for (int i = 0; i < race->povray_count; i++) {
        const RaceEntry *entry = &race->povray[i];
        if (!race_is_front(race, entry, time, judge)) {
            continue;
        }
        double ratio = entry->seconds[time] / race_time_to(race, entry->errors[judge], time, judge);
        if (isnan(ratio)) {
            found.beyond++;
            continue;
        }
        logarithms += log(ratio);
        found.settings++;
        found.least = fmin(found.least, ratio);
        found.greatest = fmax(found.greatest, ratio);
    }
    if (found.settings > 0) {
        found.ratio = exp(logarithms / found.settings);
    }
    return found;
}
