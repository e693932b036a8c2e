// Tests of the race's arithmetic: the list of settings, their order, the front, and the time to an error. Everything is
// compared with what is found by hand or by looking at all pairs.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check/race.h"
#include "tap.h"

static void entry_set(RaceEntry *entry, double seconds, double error)
{
    entry->is_run = true;
    for (int i = 0; i < RACE_TIMES; i++) {
        entry->seconds[i] = seconds;
    }
    for (int i = 0; i < RACE_JUDGES; i++) {
        entry->errors[i] = error;
    }
}

static void test_list(Race *race)
{
    const char *thresholds[] = {"0.3", "0.1", "0.03", "0.01", "0.003", "0.0"};
    int found = 0;
    race_settings_list(race);
    for (int method = 1; method <= 2; method++) {
        for (int depth = 1; depth <= 9; depth++) {
            for (int t = 0; t < 6; t++) {
                for (int jitter = 0; jitter < 2; jitter++) {
                    char want[4][16];
                    snprintf(want[0], sizeof want[0], "+AM%d", method);
                    snprintf(want[1], sizeof want[1], "+A%s", thresholds[t]);
                    snprintf(want[2], sizeof want[2], "+R%d", depth);
                    snprintf(want[3], sizeof want[3], jitter ? "+J" : "-J");
                    for (int i = 0; i < race->povray_count; i++) {
                        RaceSwitches switches;
                        race_switches(&race->povray[i], &switches);
                        bool same = switches.list[4] == NULL;
                        for (int k = 0; k < 4; k++) {
                            same = same && strcmp(switches.list[k], want[k]) == 0;
                        }
                        found += same;
                    }
                }
            }
        }
    }
    tap_ok(found == 216 && race->povray_count == 216, "each method, threshold, depth, with jitter and without: once");
}

static void test_order(Race *race)
{
    int order[RACE_SETTINGS];
    race_settings_list(race);
    const double tried[][2] = {{1, 0.1}, {4, 0.02}, {2, 0.03}, {8, 0.02}, {3, 0.1}}; // rays, error
    for (int i = 0; i < 5; i++) {
        race->povray[i].small_rays = tried[i][0];
        race->povray[i].small_error = tried[i][1];
    }
    race->povray[5] = race->povray[0];
    race->povray[5].same_as = 0;
    int count = race_order(race, order);
    const int want[] = {0, 2, 1, 3, 4}; // the front by rays, then twice as dear, then three times
    tap_ok(count == 5 && memcmp(order, want, sizeof want) == 0, "the front runs first, then what is next to it; no picture twice");
    tap_ok(fabs(race->povray[3].excess - log(2.0)) < 1e-12 && fabs(race->povray[4].excess - log(3.0)) < 1e-12,
       "how much dearer than the best to its error");
}

static void test_front(Race *race)
{
    *race = (Race){.povray_count = 100};
    int wrong = 0;
    for (int i = 0; i < 100; i++) {
        entry_set(&race->povray[i], 1.0 + rand() % 50, 1.0 + rand() % 50);
    }
    for (int i = 0; i < 100; i++) {
        bool is_front = true;
        for (int j = 0; j < 100; j++) {
            is_front = is_front && !(race->povray[j].seconds[0] < race->povray[i].seconds[0] &&
                                     race->povray[j].errors[0] < race->povray[i].errors[0]);
        }
        wrong += is_front != race_is_front(race, &race->povray[i], RACE_CPU, RACE_BY_RTLANG);
    }
    tap_ok(wrong == 0, "the front is what nothing is both faster and nearer than");
    race->povray[0].is_run = false;
    tap_ok(!race_is_front(race, &race->povray[0], RACE_CPU, RACE_BY_RTLANG), "what was not run is not there");
}

static void test_ratio(Race *race)
{
    *race = (Race){.povray_count = 3, .rtlang_count = 4};
    entry_set(&race->rtlang[0], 1.0, 0.08);
    entry_set(&race->rtlang[1], 4.0, 0.02);
    entry_set(&race->rtlang[2], 1.5, 0.04);
    entry_set(&race->rtlang[3], 6.0, 0.01);
    race->rtlang[2].is_adaptive = race->rtlang[3].is_adaptive = true;
    // 0.04 is met by the line of the first ladder at 2 s, and by a rung of the second at 1.5 s.
    tap_ok(fabs(race_time_to(race, 0.04, RACE_CPU, RACE_BY_RTLANG) - 1.5) < 1e-12, "the faster ladder counts");
    tap_ok(fabs(race_time_to(race, 0.02, RACE_CPU, RACE_BY_RTLANG) - 3.0) < 1e-12, "on the line, in logarithms");
    tap_ok(fabs(race_time_to(race, 0.5, RACE_CPU, RACE_BY_RTLANG) - 1.0) < 1e-12, "a rung that is nearer still");
    tap_ok(isnan(race_time_to(race, 0.009, RACE_CPU, RACE_BY_RTLANG)), "what no ladder reaches has no time");
    entry_set(&race->povray[0], 6.0, 0.04);
    entry_set(&race->povray[1], 27.0, 0.02);
    entry_set(&race->povray[2], 90.0, 0.001);
    RaceRatio ratio = race_ratio(race, RACE_CPU, RACE_BY_RTLANG);
    tap_ok(fabs(ratio.ratio - 6.0) < 1e-9 && fabs(ratio.least - 4.0) < 1e-9 && fabs(ratio.greatest - 9.0) < 1e-9 &&
           ratio.settings == 2 && ratio.beyond == 1,
       "the geometric mean over the front, and what is beyond");
}

int main(void)
{
    Race *race = calloc(1, sizeof *race);
    if (!race) {
        abort();
    }
    srand(1);
    test_list(race);
    test_order(race);
    test_front(race);
    test_ratio(race);
    free(race);
    return tap_done();
}
