// Where a coordinate lies among whole numbers that are counted around a period. Private to noise*.c.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_NOISE_CELL_H
#define MATH_NOISE_CELL_H

#include <math.h>

// Where a coordinate lies in the lattice.
typedef struct Cell {
    unsigned index[2]; // of the lattice points before and after it, below the period
    double way[2];     // from them to it
    double weight[2];  // what they count, 3 t^2 - 2 t^3
} Cell;

// floor, without a call for numbers of ordinary size.
static inline double floor_of(double x, long long *number)
{
    static const double largest = 1e15; // beyond, a double has no fraction left to speak of
    if (fabs(x) < largest) {
        *number = (long long)x;
        *number -= (double)*number > x;
        return (double)*number;
    }
    *number = (long long)fmax(fmin(floor(x), largest), -largest);
    return floor(x);
}

// All coordinates are moved by `offset`, so that POV-Ray meets none below 0; its points lie at these places.
static inline Cell cell_of(double x, double offset, unsigned period)
{
    long long number;
    double moved = x + offset, t = moved - floor_of(moved, &number);
    unsigned index = (unsigned)number & (period - 1);
    double weight = t * t * (3.0 - 2.0 * t);
    return (Cell){{index, (index + 1) & (period - 1)}, {t, t - 1.0}, {1.0 - weight, weight}};
}

#endif
