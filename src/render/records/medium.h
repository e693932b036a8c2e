// What a ray is inside of: the bodies that it has entered and not left, in that order. What it travels in is the last
// one, with empty space below.
//
// Such a list is one number, the node of the body that was entered last; each node knows the one below it, so that rays
// that continue from a surface share what they have in common and each keeps four bytes of it. Nodes stand in a table
// of a thread, which a stack of rays takes from and gives back to as it grows and shrinks: a node stands after all
// those below it, so that what some lists need ends at a place in the table. All measured beside POV-Ray.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_RECORDS_MEDIUM_H
#define RENDER_RECORDS_MEDIUM_H

#include <stdbool.h>
#include <stdint.h>

#include "scene/scene.h"

enum { MEDIUM_DEPTH_MAX = 64 }; // bodies that are entered while a ray is inside of so many are not remembered

typedef struct MediumRegion {
    uint64_t body;     // scene_body_key
    uint32_t interior; // Scene.interiors, or RECORD_NONE for empty space
    bool is_solid;     // of a scene with fog: there is none inside of it
} MediumRegion;

// A list by itself, the outermost first.
typedef struct MediumList {
    uint32_t count;
    MediumRegion regions[MEDIUM_DEPTH_MAX];
} MediumList;

typedef uint32_t MediumStack; // the node of the region entered last
enum { MEDIUM_EMPTY = 0 };    // the node of no region

typedef struct MediumNode {
    MediumRegion region;
    MediumStack below;
    uint8_t depth;    // regions of the list
    bool is_in_solid; // one of them is
} MediumNode;

typedef struct MediumTable {
    MediumNode *nodes; // nodes[0] is MEDIUM_EMPTY
    uint32_t count;
} MediumTable;

// What one ray may need beyond what waiting rays keep: its own list, and a list less one of its bodies, copied.
enum { MEDIUM_NODES_EACH = 2 * MEDIUM_DEPTH_MAX };

// An empty table in an array.
static inline void medium_table_init(MediumTable *table, MediumNode *nodes)
{
    nodes[MEDIUM_EMPTY] = (MediumNode){.region = {.interior = RECORD_NONE}};
    *table = (MediumTable){nodes, 1};
}

static inline MediumStack medium_enter(MediumTable *table, MediumStack stack, MediumRegion region)
{
    const MediumNode *below = &table->nodes[stack];
    if (below->depth == MEDIUM_DEPTH_MAX) {
        return stack;
    }
    table->nodes[table->count] = (MediumNode){.region = region,
                                              .below = stack,
                                              .depth = (uint8_t)(below->depth + 1),
                                              .is_in_solid = below->is_in_solid || region.is_solid};
    return table->count++;
}

// A list without one of its nodes: those above it, copied.
MediumStack medium_without(MediumTable *table, MediumStack stack, MediumStack node);

// The body need not be the one entered last; false when it is not there at all.
static inline bool medium_leave(MediumTable *table, MediumStack *stack, uint64_t body)
{
    MediumStack at = *stack;
    while (at != MEDIUM_EMPTY && table->nodes[at].region.body != body) {
        at = table->nodes[at].below;
    }
    if (at == MEDIUM_EMPTY) {
        return false;
    }
    *stack = at == *stack ? table->nodes[at].below : medium_without(table, *stack, at);
    return true;
}

// Moves the nodes of a list that stand at `kept` and beyond to where they stand side by side from there.
MediumStack medium_gather(MediumTable *table, uint32_t kept, MediumStack stack);

// Forgets all nodes but the first `kept` and those of a list, of which the table then holds no more than a list has;
// returns the list, which may have moved.
static inline MediumStack medium_keep(MediumTable *table, uint32_t kept, MediumStack stack)
{
    if (stack >= kept + MEDIUM_DEPTH_MAX) {
        stack = medium_gather(table, kept, stack);
    }
    table->count = stack < kept ? kept : stack + 1;
    return stack;
}

// Forgets all nodes and takes in a list.
MediumStack medium_load(MediumTable *table, const MediumList *list);

static inline double medium_ior(const Interior *interiors, const MediumTable *table, MediumStack stack)
{
    uint32_t interior = table->nodes[stack].region.interior;
    return interior == RECORD_NONE ? 1.0 : interiors[interior].ior;
}

// Indices of refraction before and behind a surface as Fresnel's share has them.
typedef struct FresnelSides {
    double before, behind;
} FresnelSides;

// Of several shapes that a ray is in, the one that it leaves counts as what is before. Measured.
static inline FresnelSides medium_fresnel_sides(const Interior *interiors, const MediumTable *table, MediumStack before,
                                                MediumStack behind, uint32_t interior, bool leaves)
{
    double medium = medium_ior(interiors, table, before);
    double own = interior == RECORD_NONE ? 1.0 : interiors[interior].ior;
    bool is_nested = leaves && table->nodes[before].depth > 1;
    return (FresnelSides){is_nested ? own : medium, is_nested ? medium : medium_ior(interiors, table, behind)};
}

#endif
