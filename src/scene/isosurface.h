// Isosurfaces: where a function is at a threshold, within a box or a ball; inside where it is below.
//
// A part's list says all of it: numbers, and the steps of the function's formula. The surface is looked for as POV-Ray
// does it, by halving: a piece of a line is left out where the values at its ends together are at least what
// `max_gradient` lets the function fall on the way, and looked into until it is shorter than `accuracy`. So the same
// numbers give the same points. docs/language.md, "Isosurfaces", says what was measured.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_ISOSURFACE_H
#define SCENE_ISOSURFACE_H

#include "math/ray.h"
#include "scene/formula.h"
#include "scene/numbers.h"

enum {
    ISOSURFACE_OPEN = 1,  // its container has no surface
    ISOSURFACE_ROUND = 2, // its container is a ball
};

// Surfaces on a line that are seen at most; as many again bound what is cut.
enum { ISOSURFACE_ROOTS_MOST = 10 };

// As the list begins; the steps follow.
typedef struct Isosurface {
    double first, step_count, room; // the formula, its steps, numbers that it holds at a time
    double threshold, accuracy, max_gradient;
    double flags;           // ISOSURFACE_...
    double roots_most;      // `max_trace`
    double generator;       // of noise
    double low[3], high[3]; // of a box; of a ball its middle and, three times, its radius
} Isosurface;

enum {
    ISOSURFACE_HEAD = sizeof(Isosurface) / sizeof(double),
    ISOSURFACE_STEP = sizeof(FormulaStep) / sizeof(double),
};

static inline const Isosurface *isosurface_of(const double *list)
{
    return (const Isosurface *)(const void *)list;
}

static inline bool isosurface_is(const Isosurface *surface, unsigned flag)
{
    return (unsigned)surface->flags & flag;
}

static inline const FormulaStep *isosurface_steps(const double *list)
{
    return (const FormulaStep *)(const void *)(list + ISOSURFACE_HEAD);
}

// The box of its container.
void isosurface_bounds(const Isosurface *surface, Vec3 *low, Vec3 *high);

// The function less the threshold.
double isosurface_value(const double *list, const FormulaHost *host, Vec3 p);

// Whether a point is in its container, and the function below the threshold there.
bool isosurface_holds(const double *list, const FormulaHost *host, Vec3 p);

// What a line is tested with. A step of `accuracy` is `step` of its parameter, and one of 1 in it is `rise` of the
// function at most.
typedef struct IsosurfaceLine {
    const double *list;
    FormulaSource source;
    Ray ray;
    double step, rise;
    double steepest;                     // so much the function has changed on 1 of the line, as far as was seen
    bool (*is_over)(const void *client); // true: nobody wants the answer; NULL: somebody does
    const void *client;
} IsosurfaceLine;

// A line in the surface's own space; `length` is what 1 of its parameter is in the space that `accuracy` is given in.
IsosurfaceLine isosurface_line(const double *list, const FormulaHost *host, Ray ray, double length);

double isosurface_along(const IsosurfaceLine *line, double t);

// The first place after `from` and up to `to` where the function has come down from above the threshold, or, `up`, up
// from below it; values at `from` are as they are. False: none is found.
bool isosurface_find(IsosurfaceLine *line, double from, double to, bool up, double *t);

#endif
