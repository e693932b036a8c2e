// Sphere sweeps: all that a ball covers whose middle and radius follow a curve of cubic or straight segments.
//
// A part's list of numbers is: which curve, how many balls the text gave, these, x, y, z and radius of each, then the
// segments, each with a box, and for each SWEEP_GROUP of them a box. A segment is a polynomial of s from -1/2 to 1/2,
// in x, y, z and radius. POV-Ray's curves, measured: straight lines from ball to ball; the cubic of Catmull and Rom
// from the second ball to the last but one; uniform cubic B-splines. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_SWEEP_H
#define SCENE_SWEEP_H

#include <stdbool.h>
#include <stdint.h>

#include "math/vec3.h"
#include "scene/numbers.h"

typedef enum SweepCurve { SWEEP_LINEAR, SWEEP_B_SPLINE, SWEEP_CUBIC, SWEEP_CURVES } SweepCurve;

enum {
    SWEEP_HEAD = 2,
    SWEEP_GROUP = 8,
    SWEEP_DEGREE = 3,
    SWEEP_BALLS_MOST = 10000,
    SWEEP_PIECES_MOST = 4, // intervals that a line has in a segment
};

typedef struct SweepBall {
    Vec3 middle;
    double radius;
} SweepBall;

typedef struct SweepBox {
    Vec3 low, high;
} SweepBox;

typedef struct SweepSegment {
    SweepBox box;
    SweepBall terms[SWEEP_DEGREE + 1]; // of s^0, s^1, …; of a straight one two
} SweepSegment;

typedef struct Sweep {
    SweepCurve curve;
    unsigned degree; // 1 or 3
    uint32_t ball_count, segment_count;
    const SweepBall *balls;
    const SweepSegment *segments;
    const SweepBox *groups;
} Sweep;

Sweep sweep_of(const double *list);

// How many balls a curve needs at least.
static inline unsigned sweep_least(SweepCurve curve)
{
    return curve == SWEEP_LINEAR ? 2 : 4;
}

// How many numbers the list of so many balls has.
size_t sweep_list_count(SweepCurve curve, uint32_t ball_count);

// Makes a list of the balls in it, behind the head.
void sweep_complete(double *list, SweepCurve curve, uint32_t ball_count);

// What it lies in, and the box that POV-Ray takes for that: of all balls, of a cubic one balls twice as large.
SweepBox sweep_bounds(const Sweep *sweep);
SweepBox sweep_given_box(const Sweep *sweep);

// The ball of a segment at s.
SweepBall sweep_ball(const Sweep *sweep, uint32_t segment, double s);

// Of all balls the one that a point is in most, or is least far from: by |p - middle|² - radius², which is returned.
double sweep_nearest(const Sweep *sweep, Vec3 p, SweepBall *ball);

#endif
