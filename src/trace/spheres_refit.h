// A table of spheres brought up to date after some have got other places, radii or materials: its tree stays, and the
// boxes follow.
//
// That takes a tenth of what a new tree takes. What it costs rays is measured: as things drift apart their boxes grow,
// and a new tree is due. A picture does not depend on the tree. Knows nothing of what moves them.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERES_REFIT_H
#define TRACE_SPHERES_REFIT_H

#include "trace/spheres.h"

// What is kept from one refit to the next.
typedef struct SphereRefit {
    double in_things, in_root; // sum of the areas of all boxes of the tree as it was built, in that of the spheres, and
                               // in that of the root; 0: not known yet
    unsigned fits;             // since then
    unsigned skip, patience; // so many new trees before a refit is tried again; and after the next one that is in vain
} SphereRefit;

// Scene spheres begin <= i < end, the only ones whose records may be others than the table's.
typedef struct SphereRange {
    size_t begin, end;
} SphereRange;

// What has changed, for a picture of so many rays, 0: unknown; by so many threads.
typedef struct SphereMoves {
    SphereRange range;
    double rays;
    int threads;
} SphereMoves;

// Brings the table up to date; `exponent` is that of the scene now, and when
// it, or the place of everything, is another one than the table's, all spheres are in the range. False when it must be
// made anew: after one that cannot be met any more, when the tree would cost rays too much, or out of memory; it is
// then of no use.
bool sphere_table_refit(SphereTable *table, SphereRefit *refit, const Scene *scene, int exponent,
                        const SphereMoves *moves) RT_MUST_CHECK;

#endif
