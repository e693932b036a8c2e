// Lists of bodies that are combined anew, because one was left that is not the last, or to give room back.
//
// SPDX-License-Identifier: MIT
#include "render/records/medium.h"

MediumStack medium_without(MediumTable *table, MediumStack stack, MediumStack node)
{
    MediumStack above[MEDIUM_DEPTH_MAX];
    MediumStack copy = table->nodes[node].below;
    int count = 0;
    for (; stack != node; stack = table->nodes[stack].below) {
        above[count++] = stack;
    }
    while (count > 0) {
        copy = medium_enter(table, copy, table->nodes[above[--count]].region);
    }
    return copy;
}

// Each moves to a place no later than its own, those below first.
MediumStack medium_gather(MediumTable *table, uint32_t kept, MediumStack stack)
{
    MediumStack moved[MEDIUM_DEPTH_MAX];
    int count = 0;
    for (; stack >= kept; stack = table->nodes[stack].below) {
        moved[count++] = stack;
    }
    table->count = kept;
    while (count > 0) {
        stack = medium_enter(table, stack, table->nodes[moved[--count]].region);
    }
    return stack;
}

MediumStack medium_load(MediumTable *table, const MediumList *list)
{
    MediumStack stack = MEDIUM_EMPTY;
    table->count = MEDIUM_EMPTY + 1;
    for (uint32_t i = 0; i < list->count; i++) {
        stack = medium_enter(table, stack, list->regions[i]);
    }
    return stack;
}
