// Where things stand in groups that are far apart for their size.
//
// What a tree would blur is divided at the widest gap between its boxes along an axis, again and again.
//
// SPDX-License-Identifier: MIT
#include "trace/shapes_clusters.h"

#include <stdlib.h>

// A gap is at least this part of the room along its axis: with less, division would not end soon.
#define GAP_LEAST 0.125

typedef struct Span1 {
    double low, high;
    PlacedItem item;
} Span1;

typedef struct Finder {
    PlacedItem *items;
    Span1 *spans; // room for as many
    ItemRun *runs;
    uint32_t run_count, parts; // in how many primitives all is divided
} Finder;

static double along(Vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static int span_order(const void *a, const void *b)
{
    double x = ((const Span1 *)a)->low, y = ((const Span1 *)b)->low;
    uint32_t first = ((const Span1 *)a)->item.item, second = ((const Span1 *)b)->item.item;
    return x != y ? (x > y) - (x < y) : (first > second) - (first < second);
}

static int double_order(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static bool run_is_blurred(const Finder *finder, ItemRun run)
{
    enum { SAMPLES = 256 };
    double sizes[SAMPLES];
    uint32_t count = 0, step = (run.end - run.begin) / SAMPLES + 1;
    Bounds all = BOUNDS_NONE;
    for (uint32_t i = run.begin; i < run.end; i++) {
        const Bounds *own = finder->items[i].bounds;
        all = bounds_join(all, *own);
        if ((i - run.begin) % step == 0) {
            sizes[count++] = vec3_max_abs(vec3_sub(own->high, own->low));
        }
    }
    qsort(sizes, count, sizeof sizes[0], double_order);
    return size_is_blurred(sizes[count / 2], vec3_max_abs(vec3_sub(all.high, all.low)));
}

// The things of a run in their order along an axis.
static void sort_along(Finder *finder, ItemRun run, int axis)
{
    for (uint32_t i = run.begin; i < run.end; i++) {
        PlacedItem item = finder->items[i];
        finder->spans[i] = (Span1){along(item.bounds->low, axis), along(item.bounds->high, axis), item};
    }
    qsort(finder->spans + run.begin, run.end - run.begin, sizeof *finder->spans, span_order);
}

// The place behind the widest gap, and how wide it is as a share of the room.
static uint32_t widest_gap(const Finder *finder, ItemRun run, double *share)
{
    const Span1 *spans = finder->spans;
    double reached = spans[run.begin].high, widest = 0.0;
    uint32_t at = run.begin;
    for (uint32_t i = run.begin + 1; i < run.end; i++) {
        if (spans[i].low - reached > widest) {
            widest = spans[i].low - reached;
            at = i;
        }
        reached = spans[i].high > reached ? spans[i].high : reached;
    }
    *share = widest / (reached - spans[run.begin].low);
    return at;
}

// Where a run is divided, which is put into that order; its begin: nowhere.
static uint32_t divide(Finder *finder, ItemRun run)
{
    double widest = 0.0, share;
    int best = -1;
    for (int axis = 0; axis < 3; axis++) {
        sort_along(finder, run, axis);
        (void)widest_gap(finder, run, &share);
        if (share > widest) {
            widest = share;
            best = axis;
        }
    }
    if (!(widest >= GAP_LEAST)) {
        return run.begin;
    }
    sort_along(finder, run, best);
    for (uint32_t i = run.begin; i < run.end; i++) {
        finder->items[i] = finder->spans[i].item;
    }
    return widest_gap(finder, run, &share);
}

// The recursion is no deeper than there are primitives.
static void find(Finder *finder, ItemRun run, bool is_whole)
{
    bool is_large = run.end - run.begin >= CLUSTER_LEAST;
    bool may_divide = is_large && finder->parts < CLUSTERS_MOST && run_is_blurred(finder, run);
    uint32_t at = may_divide ? divide(finder, run) : run.begin;
    if (at > run.begin) {
        finder->parts++;
        find(finder, (ItemRun){run.begin, at}, false);
        find(finder, (ItemRun){at, run.end}, false);
    } else if (is_large && !is_whole) {
        finder->runs[finder->run_count++] = run;
    }
}

uint32_t clusters_find(PlacedItem *items, uint32_t count, ItemRun runs[CLUSTERS_MOST])
{
    Finder finder = {.items = items, .spans = malloc(count * sizeof *finder.spans), .runs = runs, .parts = 1};
    if (!finder.spans) {
        return UINT32_MAX;
    }
    find(&finder, (ItemRun){0, count}, true);
    free(finder.spans);
    return finder.run_count;
}
