// All settings of POV-Ray on small pictures. Its cost is counted in rays, so that several may run at a time: most of the
// second that such a run takes POV-Ray waits.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "check/race.h"
#include "check/study_render.h"

enum { SMALL_SAMPLES = 256, AT_A_TIME = 8, SMALL_WIDTH = 160, SMALL_LEAST = 40 };

// Seconds of the processor that the cheapest setting may take: all of them together take some thousand times as long.
static const double CHEAPEST = 0.005;


typedef struct Small {
    Race *race;
    int depth; // that is being tried
    bool is_over[RACE_LADDERS]; // a setting of the ladder took too many rays
    StudySettings settings; // of the small picture
    Image reference;
    uint64_t hashes[RACE_SETTINGS]; // of pictures; 0: none
    atomic_int next, left_out;
    atomic_bool failed;
} Small;

// FNV-1a of the values.
static uint64_t picture_hash(const Image *image)
{
    const unsigned char *bytes = (const unsigned char *)image->values;
    size_t size = (size_t)image->width * (size_t)image->height * (size_t)image->channels * sizeof *image->values;
    uint64_t hash = UINT64_C(0xcbf29ce484222325);

    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ bytes[i]) * UINT64_C(0x100000001b3);
    }
    return hash;
}

static bool try_one(Small *small, int number)
{
    RaceEntry *entry = &small->race->povray[number];
    RaceSwitches switches;
    StudyMetric metric;
    char name[32];

    race_switches(entry, &switches);
    snprintf(name, sizeof name, "small-%d", number);
    PovrayRun run = {.name = name, .switches = switches.list, .threads = 1};
    bool fine = povray_render(small->race->scene, &small->settings, &run) &&
                study_compare(&run.image, &small->reference, &metric);
    if (fine) {
        entry->small_rays = run.cost.rays / ((double)small->settings.width * small->settings.height);
        entry->small_error = metric.rmse;
        small->hashes[number] = picture_hash(&run.image);
    }
    image_fini(&run.image);
    return fine;
}

// One rung of each ladder that is not over.
static void *try_rungs(void *client)
{
    Small *small = client;

    for (int ladder; (ladder = atomic_fetch_add(&small->next, 1)) < RACE_LADDERS;) {
        int number = ladder * RACE_DEPTHS + small->depth;
        if (*small->settings.interrupted != 0 || atomic_load(&small->failed)) {
            return NULL;
        }
        if (small->is_over[ladder]) {
            continue;
        }
        if (small->depth > 0 && budget_left(small->settings.budget) <= 0.0) {
            atomic_fetch_add(&small->left_out, 1);
            small->is_over[ladder] = true;
        } else if (!try_one(small, number)) {
            atomic_store(&small->failed, true);
            return NULL;
        } else {
            small->is_over[ladder] = small->race->povray[number].small_rays > RACE_RAYS_MOST;
        }
    }
    return NULL;
}

// All ladders of settings, depth by depth: what the budget leaves out has the most rays.
static void try_depths(Small *small)
{
    for (small->depth = 0; small->depth < RACE_DEPTHS; small->depth++) {
        pthread_t threads[AT_A_TIME];
        int started = 0;

        budget_say(small->settings.budget, small->race->scene, "small pictures, depth", small->depth + 1, RACE_DEPTHS);
        atomic_store(&small->next, 0);
        while (started < AT_A_TIME - 1 && pthread_create(&threads[started], NULL, try_rungs, small) == 0) {
            started++;
        }
        try_rungs(small);
        for (int i = 0; i < started; i++) {
            pthread_join(threads[i], NULL);
        }
    }
    if (atomic_load(&small->left_out) > 0) {
        budget_leave_out(small->settings.budget, "the upper ends of %d of POV-Ray's %d ladders of depths",
                         atomic_load(&small->left_out), RACE_LADDERS);
    }
}

// Of settings that make one picture the first is kept.
static void find_same(Small *small)
{
    for (int i = 0; i < small->race->povray_count; i++) {
        for (int j = 0; j < i && small->hashes[i] != 0 && small->race->povray[i].same_as < 0; j++) {
            if (small->hashes[j] == small->hashes[i]) {
                small->race->povray[i].same_as = j;
                small->race->same++;
            }
        }
    }
}

// The size at which the cheapest setting is cheap enough, not above the race's where that is fixed.
static bool small_size(Race *race, const StudySettings *settings)
{
    RaceSwitches switches;
    int width = settings->race_width > 0 && settings->race_width < SMALL_WIDTH ? settings->race_width : SMALL_WIDTH;
    StudySettings first = *settings;
    const RaceEntry *cheapest = &race->povray[race->povray_count / 2]; // +AM2 +R1 -J

    first.width = race->small_width = width;
    first.height = race->small_height = 3 * width / 4;
    race_switches(cheapest, &switches);
    PovrayRun run = {.name = "first", .switches = switches.list, .threads = 1};
    bool fine = povray_render(race->scene, &first, &run);
    image_fini(&run.image);
    if (fine && run.cost.seconds > CHEAPEST) {
        width = (int)(width * sqrt(CHEAPEST / run.cost.seconds)) / 4 * 4;
        race->small_width = width < SMALL_LEAST ? SMALL_LEAST : width;
        race->small_height = 3 * race->small_width / 4;
    }
    return fine;
}

bool race_try_small(Race *race, const StudySettings *settings)
{
    if (!small_size(race, settings)) {
        return false;
    }
    Small small = {.race = race, .settings = *settings};
    rt_sampling sampling = {.sampler = "halton", .samples = SMALL_SAMPLES, .seed = 1};
    RtlangRun reference = {.method = RT_METHOD_BACKWARD};

    small.settings.width = race->small_width;
    small.settings.height = race->small_height;
    rtlang_render(race->scene, &small.settings, &sampling, RT_PRECISION_DOUBLE, 0, &reference);
    if (reference.status != RT_OK) {
        snprintf(race->fault, sizeof race->fault, "%s", reference.fault);
        return false;
    }
    small.reference = reference.image;
    try_depths(&small);
    find_same(&small);
    image_fini(&reference.image);
    return !atomic_load(&small.failed) && *settings->interrupted == 0;
}
