// The race to equal error: rtlang's samples against POV-Ray's anti-aliasing, at all settings of both.
//
// Every setting of POV-Ray is tried on a small picture first, which shows those that make the same picture as another
// and how much dearer each is than the best ones to its error. In that order they run at the race's size, as far as the
// budget lets them; what was not run is kept and counted. A setting is at the front when no other has both less time and
// less error. The ratio at such a setting is POV-Ray's time over rtlang's to the same error: rtlang's is read off the
// line between the two rungs of a ladder around it, both axes in logarithms, from the ladder that is faster there; where
// no ladder reaches the error there is no ratio. Knows nothing of how it is printed.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_RACE_H
#define CHECK_RACE_H

#include <stdbool.h>

#include "image/image.h"

typedef struct StudySettings StudySettings;

enum {
    RACE_TEXT = 256,
    RACE_DEPTHS = 9,
    RACE_THRESHOLDS = 6,
    RACE_LADDERS = 2 * 2 * RACE_THRESHOLDS, // of POV-Ray: method, jitter, threshold
    RACE_SETTINGS = RACE_LADDERS * RACE_DEPTHS,
    RACE_RUNGS = 24, // of rtlang, both ladders
};

// What time is taken; the first three of one thread.
typedef enum RaceTime {
    RACE_CPU,      // of the processor, tracing
    RACE_WALL,     // by the clock, tracing
    RACE_WHOLE,    // of the processor, with reading the scene and writing the picture
    RACE_CPU_ALL,  // as the first two, with all threads
    RACE_WALL_ALL,
    RACE_TIMES,
} RaceTime;

// Against whose reference errors are.
typedef enum RaceJudge {
    RACE_BY_RTLANG,
    RACE_BY_POVRAY, // in the rows that this reference has
    RACE_BY_OTHER,  // each program's against the other's reference, in these rows
    RACE_JUDGES,
} RaceJudge;

typedef struct RaceEntry {
    char setting[48]; // as given to the program
    double rays;      // a pixel
    double seconds[RACE_TIMES];
    double errors[RACE_JUDGES]; // root mean square of values clamped to 0..1, in linear light
    bool is_run;                // at the race's size, with one thread; else the numbers above are NAN
    bool has_all;               // with all threads, too
    // Of POV-Ray's.
    int method, depth, threshold;
    bool has_jitter;
    double small_rays, small_error; // of the small picture
    double excess;                  // logarithm of how much dearer it was there than the best to its error
    int same_as;                    // the setting before it that makes the same picture; -1: none
    // Of rtlang's.
    bool is_adaptive;
    double samples; // asked for
} RaceEntry;

typedef struct Race {
    const char *scene;
    int width, height, small_width, small_height;
    int first_row, last_row;                // of POV-Ray's reference; the last is not in it
    double reference_samples;               // a pixel, as the run counted them
    char povray_reference[48];              // its setting
    double povray_reference_rays;           // a pixel of its rows
    double floor;                           // the own error of rtlang's reference, which is taken off
    double apart;                           // how far the references are apart in POV-Ray's rows
    double shortest;                        // POV-Ray's shortest run, seconds of the processor
    double spent;                           // seconds of the processor, by POV-Ray's runs at the race's size
    RaceEntry povray[RACE_SETTINGS], rtlang[RACE_RUNGS];
    int povray_count, rtlang_count;
    int same, left_out; // settings that make another's picture; that the budget left out once they were tried
    Image picture; // rtlang's reference; owned by the study that has it
    char fault[RACE_TEXT];
} Race;

typedef struct RaceRatio {
    double ratio, least, greatest; // geometric mean over the settings at the front, and its ends; NAN: none
    int settings;                  // of the mean
    int beyond;                    // at the front, but rtlang's ladders do not reach their error
} RaceRatio;

// False when there is no race: `fault` says why.
bool race_run(Race *race, const char *scene, const StudySettings *settings);

// ---- race_settings.c

// Fills in POV-Ray's settings, none of which has been tried.
void race_settings_list(Race *race);

// The switches of a setting, ending with NULL.
typedef struct RaceSwitches {
    char texts[4][16];
    const char *list[5];
} RaceSwitches;
void race_switches(const RaceEntry *entry, RaceSwitches *switches);

// From what the small pictures said: each setting's excess, and the order in which they are to run, the nearest to the
// front first and the cheaper of equal ones, without those that make the picture of another. Returns how many.
int race_order(Race *race, int order[RACE_SETTINGS]);

// ---- race_small.c

// Tries all settings on small pictures. A ladder of depths ends with the first that takes more than RACE_RAYS_MOST rays
// a pixel.
enum { RACE_RAYS_MOST = 100 };
bool race_try_small(Race *race, const StudySettings *settings);

// ---- race_ratio.c

// Whether a setting of POV-Ray is at the front.
bool race_is_front(const Race *race, const RaceEntry *entry, RaceTime time, RaceJudge judge);

// rtlang's time to an error; NAN where its ladders do not reach.
double race_time_to(const Race *race, double error, RaceTime time, RaceJudge judge);

RaceRatio race_ratio(const Race *race, RaceTime time, RaceJudge judge);

#endif
