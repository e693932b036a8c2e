// Places among values along a pattern, beside the rule entry by entry; and what whole periods leave, beside fmod.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "math/rest.h"
#include "render/surface/along.h"
#include "scene/scene.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { MOST = 48 };

typedef struct Record {
    uint32_t unused, first;
} Record;

// The rule as docs have it: the last entry from its own place on, the first up to its own, between them the one before
// the first entry beyond the value, mixed with the next by its share of the way.
static AlongPlace by_rule(const SlopeEntry *entries, uint32_t first, double value)
{
    uint32_t chain[MOST], count = 0, low = 0;
    for (uint32_t i = first; i != RECORD_NONE; i = entries[i].next) {
        chain[count++] = i;
    }
    bool is_last = value >= entries[chain[count - 1]].at, is_first = !is_last && !(value > entries[first].at);
    for (low = 0; !is_last && !is_first && low + 1 < count && !(entries[chain[low + 1]].at > value); low++) {
    }
    low = is_last ? count - 1 : low;
    double from = entries[chain[low]].at;
    if (low == count - 1 || !(value > from)) {
        return (AlongPlace){chain[low], chain[low], 0.0};
    }
    double width = (double)(float)(entries[chain[low + 1]].at - from);
    return (AlongPlace){chain[low], chain[low + 1], (value - from) / width};
}

// Values in steps of a quarter, so that many are equal and meet what is asked for.
static double any_value(Random *random)
{
    double step = 0.25 * random_below(random, 6) - 0.25;
    if (random_below(random, 3) != 0) {
        return step;
    }
    return random_between(random, -0.2, 1.2);
}

// A chain in which each entry names another one, in no order; it rises, or not.
static uint32_t any_chain(Random *random, SlopeEntry *entries, bool rises)
{
    uint32_t next = RECORD_NONE, count = 1 + random_below(random, MOST - 1), step = 5; // prime to MOST
    double at = 1.0;
    for (uint32_t n = 0; n < count; n++) {
        uint32_t index = (n * step + 3) % MOST;
        at = rises ? at - 0.25 * random_below(random, 2) : any_value(random);
        entries[index] = (SlopeEntry){.at = at, .next = next};
        next = index;
    }
    return next;
}

static void test_places(bool rises)
{
    Random random = {random_seed(NULL)};
    int different = 0, missing = 0;
    for (int turn = 0; turn < 3000; turn++) {
        Arena arena;
        SlopeEntry entries[MOST] = {{0}};
        uint32_t first = any_chain(&random, entries, rises);
        const Record records[] = {{0, RECORD_NONE}, {0, first}, {0, first}};
        arena_init(&arena, SIZE_MAX);
        const AlongList *lists =
            along_lists(&arena, &(AlongRecords){records, 3, sizeof(Record), offsetof(Record, first)},
                        &(AlongRecords){entries, MOST, sizeof(SlopeEntry), offsetof(SlopeEntry, next)});
        missing += !lists || lists[0].count != 0 || lists[2].at != lists[1].at;
        for (int asked = 0; lists && asked < 20; asked++) {
            double value = asked == 0 ? (double)NAN : any_value(&random);
            AlongPlace own = along_find(&lists[1], value), other = by_rule(entries, first, value);
            different += own.low != other.low || own.high != other.high || own.share != other.share;
        }
        arena_fini(&arena);
    }
    tap_ok(missing == 0, "each record has its list, of no entries, or shared (%d have not)", missing);
    tap_ok(different == 0, "values find their place in lists that %s (%d do not)", rises ? "rise" : "fall and rise",
           different);
}

static void test_rests(void)
{
    Random random = {random_seed(NULL)};
    static const double odd[] = {0.0, -0.0, 1.0, -1.0, 2.0, -2.0, 1.00001, 2.00002, 0x1p52, -0x1p53, 1e300, INFINITY};
    int different = 0, count = 100000 + (int)(RT_COUNT_OF(odd));
    for (int turn = 0; turn < count; turn++) {
        double scale = exp2((double)random_below(&random, 60) - 4.0);
        double usual = scale * random_between(&random, -4.0, 4.0);
        double x = turn < 100000 ? usual : odd[turn - 100000];
        double own[] = {fraction_of(x), rest_of(x, 1.00001), rest_of(x, 1.0)};
        double others[] = {fmod(x, 1.0), fmod(x, 1.00001), fmod(x, 1.0)};
        different += isinf(x) ? !(isnan(own[0]) && isnan(own[1])) : memcmp(own, others, sizeof own) != 0;
    }
    tap_ok(different == 0, "rests of periods have the bits of fmod (%d have not)", different);
}

int main(void)
{
    test_places(true);
    test_places(false);
    test_rests();
    return tap_done();
}
