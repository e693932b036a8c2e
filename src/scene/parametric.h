// Parametric surfaces: the points that three functions give for u and v in a rectangle, within a box or a ball.
//
// A part's list says all of it: numbers, and the steps of the functions' formulas. Where a line meets the surface is
// looked for as POV-Ray does it, by halving the rectangle until its pieces are shorter than `accuracy`: so the same
// numbers give the same points. A piece is halved no more, either, that a line takes less than `accuracy` to pass.
// docs/language.md, "Parametric surfaces", says what was measured.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_PARAMETRIC_H
#define SCENE_PARAMETRIC_H

#include "math/ray.h"
#include "scene/formula.h"
#include "scene/numbers.h"

// As the list begins; the steps follow.
typedef struct Parametric {
    double first[3], step_count; // the formulas of x, y and z, and their steps
    double generator;            // of noise
    double from[2], to[2];       // of u and v
    double accuracy, max_gradient;
    double is_round;        // its container is a ball
    double low[3], high[3]; // of a box; of a ball its middle and, three times, its radius
} Parametric;

enum {
    PARAMETRIC_HEAD = sizeof(Parametric) / sizeof(double),
    PARAMETRIC_STEP = sizeof(FormulaStep) / sizeof(double),
};

// The sides of the rectangle are at most so many times `accuracy`.
#define PARAMETRIC_PIECES_MOST 0x1p24

static inline const Parametric *parametric_of(const double *list)
{
    return (const Parametric *)(const void *)list;
}

static inline const FormulaStep *parametric_steps(const double *list)
{
    return (const FormulaStep *)(const void *)(list + PARAMETRIC_HEAD);
}

// The box of its container.
void parametric_bounds(const Parametric *surface, Vec3 *low, Vec3 *high);

// What a line is tested with, in the surface's own space.
typedef struct ParametricLine {
    const double *list;
    const FormulaHost *host;
    Ray ray;
    double length;                       // what 1 of its parameter is in the scene's lengths
    bool (*is_over)(const void *client); // true: nobody wants the answer; NULL: somebody does
    const void *client;
} ParametricLine;

typedef struct ParametricHit {
    double t;
    double u, v; // the least of the piece that was found
} ParametricHit;

// Where a line comes to the surface first. False: nowhere.
bool parametric_find(const ParametricLine *line, ParametricHit *hit);

// The piece whose hit was at t, as well as a line that has begun elsewhere tells.
bool parametric_find_at(const ParametricLine *line, double t, ParametricHit *hit);

// A vector along the normal.
Vec3 parametric_across(const double *list, const FormulaHost *host, double u, double v);

#endif
