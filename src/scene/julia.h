// Julia fractals: points whose orbit h, f(h) + p, f(f(h) + p) + p, … does not leave a ball for as many steps as are
// asked for, h being the point in a space of four dimensions that `slice` cuts.
//
// A part's list of numbers is the structure Julia. The algebra is that of quaternions, f(h) is h² or h³. What bounds a
// fractal is a ball of radius 1 + |p|, 2 at most, and 1e-7 more, which orbits must not leave, either. Measured. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_JULIA_H
#define SCENE_JULIA_H

#include <stdbool.h>

#include "math/vec3.h"

typedef struct Julia {
    double p[4], slice[4], distance;
    double power; // 2 or 3
    double step_count, precision;
    double radius; // of its ball
    double fourth; // of a point the fourth coordinate is that less rise[]·(x, y, z)
    double rise[3];
} Julia;

enum { JULIA_NUMBERS = sizeof(Julia) / sizeof(double), JULIA_INTERVALS_MOST = 64 };

static inline const Julia *julia_of(const double *list)
{
    return (const Julia *)(const void *)list;
}

// Sets what follows from the rest.
void julia_complete(Julia *julia);

// Whether a point is inside. Where it is not, *reach is how far a step from there may go, as POV-Ray takes it.
bool julia_holds(const Julia *julia, Vec3 p, double *reach);

// A vector along the normal, out of the fractal.
Vec3 julia_gradient(const Julia *julia, Vec3 p);

#endif
