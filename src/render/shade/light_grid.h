// The mean over the lights of an area: which of them are evaluated, each at most once, and how much each result counts.
//
// Knows neither places nor rays: the caller answers for lights by their row and column, and shares of light come back.
// Without `adaptive` all lights are evaluated, row by row. With it the grid is divided depth first, and answers are
// kept where a part that is divided later may want them: those of a part's corners go to its quarters, and those of its
// lower and right edge to the parts beyond. One row and one column of answers suffice for that, however large the grid
// is: only parts of one level want a light within an edge, and they come from left to right and from top to bottom.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_LIGHT_GRID_H
#define RENDER_SHADE_LIGHT_GRID_H

#include "math/colour.h"
#include "scene/scene.h"

// A part of an area light counts as the mean of its four corners, or, where it is divided, as the mean of its quarters.
typedef struct LightPart {
    int left, right, top, bottom; // lights, both ends included
    int level;
    double weight;
    Rgb corners[4]; // what reaches the point from them: the left one above, the right one above, the two below
} LightPart;

// An answer of the light of a row, or of a column, that was asked for last on the edge of a part.
typedef struct LightAnswer {
    int at; // its place in the row or column; -1: none
    Rgb share;
} LightAnswer;

// Light (i, j) of an area, and what reaches the point of it, by colour.
typedef struct LightAsked {
    int i, j;
    int row, column; // adaptive: among the ends of the divided part's quarters
    double weight;   // otherwise
    Rgb share;
} LightAsked;

// The columns, or rows, of a part's quarters: their ends in order, and for each the place of the first that is the same
// light, where the part's own ends come before the others.
typedef struct LightEnds {
    int at[4], same[4];
} LightEnds;

enum {
    LIGHT_PARTS_MAX = 32,   // three wait for each halving of at most 1024 rows, and one is being divided
    LIGHT_ASKED_MAX = 16,   // dividing a part asks for 12 lights at most
    LIGHT_ANSWERS_OWN = 96, // answers of larger grids are kept in memory of their own
};

typedef struct LightGrid {
    const LightArea *area;
    Rgb sum; // the mean, at the end
    int asked_count;
    LightAsked asked[LIGHT_ASKED_MAX];
    int next_i, next_j; // not adaptive: the first light that was not asked for yet
    // Adaptive:
    LightPart divided;  // the one whose lights are evaluated
    LightEnds columns, rows; // of that
    bool is_whole;      // the lights are its corners: it may stay whole
    Rgb shares[4][4];   // at the ends of its quarters
    int count;          // of parts that wait
    LightPart parts[LIGHT_PARTS_MAX];
    LightAnswer *lower, *right; // by column, by row; NULL when there is no memory: then lights are evaluated again
    LightAnswer *allocated;
    LightAnswer own[LIGHT_ANSWERS_OWN];
} LightGrid;

// Asks for the first lights.
void light_grid_begin(LightGrid *grid, const LightArea *area);

// Takes the shares of the lights that were asked for, which the caller has set, and asks for others; for none when all
// that are wanted are known: then `sum` is the mean. All of the light would be `arriving`. To be called until then.
void light_grid_next(LightGrid *grid, Rgb arriving);

// Asks for no more lights, whatever is known: for a run that is cancelled. The last light_grid_next does it, too.
void light_grid_end(LightGrid *grid);

#endif
