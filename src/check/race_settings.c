// POV-Ray's settings, and which are worth a run: "Command-Line and INI-File Options", POV-Ray 3.7 manual.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "check/race.h"

static const char *const thresholds[RACE_THRESHOLDS] = {"0.3", "0.1", "0.03", "0.01", "0.003", "0.0"};

void race_settings_list(Race *race)
{
    race->povray_count = 0;
    for (int method = 1; method <= 2; method++) {
        for (int jitter = 0; jitter <= 1; jitter++) {
            for (int threshold = 0; threshold < RACE_THRESHOLDS; threshold++) {
                for (int depth = 1; depth <= RACE_DEPTHS; depth++) {
                    RaceEntry *entry = &race->povray[race->povray_count++];
                    *entry = (RaceEntry){.method = method,
                                         .depth = depth,
                                         .threshold = threshold,
                                         .has_jitter = jitter != 0,
                                         .small_rays = (double)NAN,
                                         .small_error = (double)NAN,
                                         .same_as = -1};
                    snprintf(entry->setting, sizeof entry->setting, "+AM%d +A%s +R%d %cJ", method,
                             thresholds[threshold], depth, jitter != 0 ? '+' : '-');
                }
            }
        }
    }
}

void race_switches(const RaceEntry *entry, RaceSwitches *switches)
{
    snprintf(switches->texts[0], sizeof switches->texts[0], "+AM%d", entry->method);
    snprintf(switches->texts[1], sizeof switches->texts[1], "+A%s", thresholds[entry->threshold]);
    snprintf(switches->texts[2], sizeof switches->texts[2], "+R%d", entry->depth);
    snprintf(switches->texts[3], sizeof switches->texts[3], "%cJ", entry->has_jitter ? '+' : '-');
    for (int i = 0; i < 4; i++) {
        switches->list[i] = switches->texts[i];
    }
    switches->list[4] = NULL;
}

static bool is_candidate(const RaceEntry *entry)
{
    return entry->same_as < 0 && !isnan(entry->small_rays);
}

// How much dearer the setting is than the cheapest that is as near, in rays.
static double excess_of(const Race *race, const RaceEntry *entry)
{
    double least = entry->small_rays;

    for (int i = 0; i < race->povray_count; i++) {
        const RaceEntry *other = &race->povray[i];
        if (is_candidate(other) && other->small_error <= entry->small_error) {
            least = fmin(least, other->small_rays);
        }
    }
    return log(entry->small_rays / least);
}

// qsort hands over no context: what is sorted brings its keys.
typedef struct Rank {
    double excess, rays;
    int entry;
} Rank;

static int by_rank(const void *a, const void *b)
{
    const Rank *x = a, *y = b;

    if (x->excess != y->excess) {
        return x->excess < y->excess ? -1 : 1;
    }
    if (x->rays != y->rays) {
        return x->rays < y->rays ? -1 : 1;
    }
    return x->entry - y->entry;
}

int race_order(Race *race, int order[RACE_SETTINGS])
{
    Rank ranks[RACE_SETTINGS];
    int count = 0;

    for (int i = 0; i < race->povray_count; i++) {
        RaceEntry *entry = &race->povray[i];
        if (is_candidate(entry)) {
            entry->excess = excess_of(race, entry);
            ranks[count++] = (Rank){entry->excess, entry->small_rays, i};
        }
    }
    qsort(ranks, (size_t)count, sizeof *ranks, by_rank);
    for (int i = 0; i < count; i++) {
        order[i] = ranks[i].entry;
    }
    return count;
}
