// Random numbers for the unit tests, and their seed: a new one each run, so that no constant can be fitted to the
// cases.
//
// SPDX-License-Identifier: MIT
#ifndef UNIT_RANDOM_H
#define UNIT_RANDOM_H

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "math/random.h"

// The seed in `text`, else in the environment's RTLANG_SEED, else one from the clock. It is printed, so that a run can
// be repeated.
__attribute__((unused)) static uint64_t random_seed(const char *text)
{
    struct timespec now;
    text = text ? text : getenv("RTLANG_SEED");
    clock_gettime(CLOCK_REALTIME, &now);
    uint64_t seed = text && *text ? strtoull(text, NULL, 0)
                                  : (uint64_t)now.tv_sec * UINT64_C(1000000007) + (uint64_t)now.tv_nsec;
    printf("# RTLANG_SEED=%" PRIu64 " repeats this run\n", seed);
    return seed;
}

// Evenly from 0 to bound - 1, but for the rest of a division.
__attribute__((unused)) static unsigned random_below(Random *random, unsigned bound)
{
    return (unsigned)((random_bits(random) >> 33) % bound);
}

#endif
