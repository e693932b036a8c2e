// Outlines: closed curves in a plane, pieces of straight lines or of cubic Bézier curves, as the list of a part.
//
// A list is what is said of all (OUTLINE_HEAD numbers), then one piece after the other: the box of its control points,
// its degree, and the points, u and v of each; before each OUTLINE_GROUP of them stands the box of these. A piece of a
// curved outline may be straight. A curve ends where it began. What lies inside of an odd number of curves is inside.
// What crosses a curve at a point that two pieces share crosses one of them: a point is on either side of a line, never
// on it, and which side that is depends on line and point alone.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_OUTLINE_H
#define SCENE_OUTLINE_H

#include <math.h>
#include <stdbool.h>

#include "scene/numbers.h"

enum {
    OUTLINE_DEGREE, // 1 or 3
    OUTLINE_CONIC,  // of a prism: 1 where it grows with the height
    OUTLINE_MIRRORED = OUTLINE_CONIC, // of a lathe: 1 where u is less than 0 somewhere, which -u is drawn for
    OUTLINE_HEAD,
    OUTLINE_PIECES_MOST = 10000,
};

typedef struct OutlinePoint {
    double u, v;
} OutlinePoint;

enum {                // of a piece
    PIECE_LOW,        // u and v
    PIECE_HIGH = 2,   // likewise
    PIECE_DEGREE = 4, // 1 or that of the outline; 0: straight, and of a lathe not seen
    PIECE_POINTS = 5, // one more than the degree of the outline
    OUTLINE_GROUP = 8,
    OUTLINE_BOX = 4,
    OUTLINE_PIECE_NUMBERS = 13 + OUTLINE_BOX, // at most, with all that stands before it
};

static inline unsigned outline_degree(const Numbers *list)
{
    return list->items[OUTLINE_DEGREE] > 1.0 ? 3 : 1;
}

static inline bool outline_is_conic(const Numbers *list)
{
    return list->items[OUTLINE_CONIC] != 0.0;
}

static inline uint32_t outline_stride(const Numbers *list)
{
    return PIECE_POINTS + 2 * (outline_degree(list) + 1);
}

static inline uint32_t outline_piece_count(const Numbers *list)
{
    uint32_t stride = outline_stride(list), group = OUTLINE_BOX + OUTLINE_GROUP * stride;
    uint32_t count = (uint32_t)list->count - OUTLINE_HEAD, rest = count % group;
    return OUTLINE_GROUP * (count / group) + (rest > 0 ? (rest - OUTLINE_BOX) / stride : 0);
}

// Where a piece begins, its stride being known.
static inline const double *outline_place(const Numbers *list, uint32_t stride, uint32_t i)
{
    return list->items + OUTLINE_HEAD + OUTLINE_BOX * (i / OUTLINE_GROUP + 1) + (size_t)stride * i;
}

// The control points of a piece: one more than the degree of the outline, two numbers each.
static inline const double *outline_piece(const Numbers *list, uint32_t i)
{
    return outline_place(list, outline_stride(list), i) + PIECE_POINTS;
}

// Whether a piece of degree 3 is straight and evenly run through, as outline_straighten makes it of its ends.
bool outline_is_straight(const double points[8]);
void outline_straighten(double points[8]);

// Begin a list of that degree, and add a piece by its control points, as many as the outline's degree and one. `items`
// has room: OUTLINE_HEAD, and OUTLINE_PIECE_NUMBERS for each piece; *count is how many numbers are there.
void outline_begin(double *items, size_t *count, unsigned degree, bool is_conic);
void outline_add(double *items, size_t *count, const double *points);

// Add a straight piece that is not seen.
void outline_add_unseen(double *items, size_t *count, OutlinePoint from, OutlinePoint to);

// How often a line crosses it, at most; even.
static inline uint32_t outline_crossings_most(const Numbers *list)
{
    return (outline_piece_count(list) * outline_degree(list) + 1) & ~1u;
}

// How often a line crosses it once it is turned about v, at most; even.
static inline uint32_t lathe_crossings_most(const Numbers *list)
{
    return 2 * outline_piece_count(list) * outline_degree(list);
}

// A line, of all points with a u + b + c v = 0, and the box of what of it counts.
typedef struct OutlineLine {
    double a, b, c;
    OutlinePoint low, high;
} OutlineLine;

// What was asked of a part of a line: no piece is near, some are, or one of them ends on the line but for rounding.
typedef enum OutlineAnswer { OUTLINE_FAR, OUTLINE_NEAR, OUTLINE_DOUBTFUL } OutlineAnswer;

#define OUTLINE_ALL                                                                                                    \
    {-(double)INFINITY, -(double)INFINITY},                                                                            \
    {                                                                                                                  \
        (double)INFINITY, (double)INFINITY                                                                             \
    }

// Where the line crosses it, in the order of pieces, but for pieces that are not in the box: of a whole line an even
// number of points. `answer` may be NULL.
uint32_t outline_cross(const Numbers *list, const OutlineLine *line, OutlinePoint *points, OutlineAnswer *answer);

bool outline_holds(const Numbers *list, OutlinePoint p);

// Of a lathe: whether a point at that distance from its axis is inside.
bool outline_holds_turned(const Numbers *list, double radius, double y);

// The nearest point of it, a vector along it there, and how many of its pieces that are seen it is behind: 1.5 in the
// middle of the second. `place` may be NULL.
OutlinePoint outline_nearest(const Numbers *list, OutlinePoint p, OutlinePoint *along, double *place);

// How many of its pieces are seen.
uint32_t outline_seen_count(const Numbers *list);

// The least and the greatest coordinates of the control points, which the outline does not leave.
void outline_bounds(const Numbers *list, OutlinePoint *low, OutlinePoint *high);

// Those of the curves themselves, which may be less.
void outline_extent(const Numbers *list, OutlinePoint *low, OutlinePoint *high);

// The greatest p·n of its control points, which no point of it exceeds.
double outline_support(const Numbers *list, OutlinePoint n);

#endif
