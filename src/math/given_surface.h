// Functions that POV-Ray gives to scenes by number, as functions.inc names them, for surfaces where they are 0.
//
// Turns three coordinates and the parameters of one into a number. Formulas are those of the shapes' names; signs,
// bounds and the small distance of f_rounded_box are as POV-Ray evaluates them, found by evaluating it at chosen
// points.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_GIVEN_SURFACE_H
#define MATH_GIVEN_SURFACE_H

#include <stdbool.h>

#include "math/noise.h"

// How many numbers it takes, with x, y and z; 0: there is none of that number here.
unsigned given_surface_arguments(unsigned number);
bool given_surface_asks_noise(unsigned number);
double given_surface(unsigned number, const Noise *noise, const double *a);

#endif
