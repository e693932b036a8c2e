// Where things stand in groups that are far apart for their size: which of them go into a tree of their own.
//
// A tree's boxes are floats in units of the whole tree's size, so things that are much smaller than the
// room between their groups would be blurred until every ray met a whole group.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SHAPES_CLUSTERS_H
#define TRACE_SHAPES_CLUSTERS_H

#include "trace/bounds.h"
#include "trace/shapes.h"

typedef struct PlacedItem {
    const Bounds *bounds;
    ShapeItem item;
} PlacedItem;

typedef struct ItemRun {
    uint32_t begin, end;
} ItemRun;

enum { CLUSTERS_MOST = 256, CLUSTER_LEAST = 16 };

// Whether a tree of such room would blur things of such a size.
static inline bool size_is_blurred(double size, double room)
{
    return size * 0x1p16 < room;
}

// Puts the items into an order in which each group is a run, and gives the runs of CLUSTER_LEAST and more, in order.
// None where all belong together. Returns how many; UINT32_MAX when out of memory.
uint32_t clusters_find(PlacedItem *items, uint32_t count, ItemRun runs[CLUSTERS_MOST]);

#endif
