// Surfaces of revolution whose radius squared is a cubic of the height between two points, as the list of a part.
//
// A list is how many points there are, the points, radius and height of each, as they were written, and for each
// stretch between two of them, but for the first and the last one, which only say how steep the others are, the four
// Bernstein coefficients of the radius squared. Two stretches that meet have the same number there.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_SOR_H
#define SCENE_SOR_H

#include <stdbool.h>

#include "scene/numbers.h"

enum { SOR_POINTS_LEAST = 4, SOR_POINTS_MOST = 10000 };

static inline uint32_t sor_point_count(const Numbers *list)
{
    return (uint32_t)list->items[0];
}

static inline uint32_t sor_stretch_count(const Numbers *list)
{
    return sor_point_count(list) - 3;
}

// How many numbers a list has.
static inline uint64_t sor_list_count(uint32_t points)
{
    return 1 + 2 * (uint64_t)points + 4 * (uint64_t)(points - 3);
}

// The radius and the height of a point.
static inline const double *sor_point_at(const Numbers *list, uint32_t i)
{
    return list->items + 1 + 2 * (uint64_t)i;
}

// Where stretch i begins; it ends where the next one does.
static inline double sor_height(const Numbers *list, uint32_t i)
{
    return sor_point_at(list, i + 1)[1];
}

static inline const double *sor_squares(const Numbers *list, uint32_t i)
{
    return list->items + 1 + 2 * (uint64_t)sor_point_count(list) + 4 * (uint64_t)i;
}

// How often a line crosses it, with its ends, at most; even.
static inline uint32_t sor_crossings_most(const Numbers *list)
{
    return (3 * sor_stretch_count(list) + 3) & ~1u;
}

// Fills in what follows the points.
void sor_complete(double *items);

// The stretch that has a height, or the nearest one.
uint32_t sor_stretch_of(const Numbers *list, double y);

// The radius squared there, and how it changes with the height.
double sor_square(const Numbers *list, uint32_t stretch, double y, double *slope);

bool sor_holds(const Numbers *list, double square, double y);

// No square exceeds it: that of all coefficients.
double sor_radius_most(const Numbers *list);

// That of the curve itself.
double sor_radius_extent(const Numbers *list);

#endif
