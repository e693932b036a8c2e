// Outlines: closed curves in a plane, pieces of straight lines or of cubic Bézier curves, as the list of a part.
//
// A list is what is said of all (OUTLINE_HEAD numbers), then the control points of one piece after the other, u and v of
// each. A curve ends where it began. What lies inside of an odd number of curves is inside. What crosses a curve at a
// point that two pieces share crosses one of them: a point is on either side of a line, never on it, and which side that
// is depends on line and point alone.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_OUTLINE_H
#define SCENE_OUTLINE_H

#include <stdbool.h>

#include "scene/numbers.h"

enum {
    OUTLINE_DEGREE,      // 1 or 3
    OUTLINE_CONIC,       // of a prism: 1 where it grows with the height
    OUTLINE_HEAD,
    OUTLINE_PIECES_MOST = 10000,
};

typedef struct OutlinePoint {
    double u, v;
} OutlinePoint;

static inline unsigned outline_degree(const Numbers *list)
{
    return list->items[OUTLINE_DEGREE] > 1.0 ? 3 : 1;
}

static inline bool outline_is_conic(const Numbers *list)
{
    return list->items[OUTLINE_CONIC] != 0.0;
}

static inline uint32_t outline_piece_count(const Numbers *list)
{
    return (uint32_t)((list->count - OUTLINE_HEAD) / (2 * (outline_degree(list) + 1)));
}

// The control points of a piece: one more than the degree, two numbers each.
static inline const double *outline_piece(const Numbers *list, uint32_t i)
{
    return list->items + OUTLINE_HEAD + 2 * (outline_degree(list) + 1) * (size_t)i;
}

// How often a line crosses it, at most; even.
static inline uint32_t outline_crossings_most(const Numbers *list)
{
    return (outline_piece_count(list) * outline_degree(list) + 1) & ~1u;
}

// Where the line of all points with a u + b + c v = 0 crosses it, in the order of pieces: an even number of points.
uint32_t outline_cross(const Numbers *list, double a, double b, double c, OutlinePoint *points);

bool outline_holds(const Numbers *list, OutlinePoint p);

// The nearest point of it, and a vector along it there.
OutlinePoint outline_nearest(const Numbers *list, OutlinePoint p, OutlinePoint *along);

// The least and the greatest coordinates of the control points, which the outline does not leave.
void outline_bounds(const Numbers *list, OutlinePoint *low, OutlinePoint *high);

// Those of the curves themselves, which may be less.
void outline_extent(const Numbers *list, OutlinePoint *low, OutlinePoint *high);

// The greatest p·n of its control points, which no point of it exceeds.
double outline_support(const Numbers *list, OutlinePoint n);

#endif
