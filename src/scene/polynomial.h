// Surfaces where a polynomial of x, y and z is 0; inside is where it is less.
//
// A part's list of numbers is: the order n, whether a box bounds the surface, that box's low and high corner, the sums
// of the sizes of all coefficients of each degree from 0 to n, then the coefficients in POV-Ray's order: by falling
// powers of x, then of y, then of z, so that Horner's scheme in z, y and x takes them one after the other. Knows nothing
// of rays.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_POLYNOMIAL_H
#define SCENE_POLYNOMIAL_H

#include <stdbool.h>

#include "base/attributes.h"
#include "math/vec3.h"
#include "scene/scene.h"

enum { POLYNOMIAL_ORDER_LEAST = 2, POLYNOMIAL_ORDER_MOST = 35, POLYNOMIAL_HEAD = 8 };

// How many coefficients a polynomial of an order has: (n + 1)(n + 2)(n + 3) / 6.
static inline unsigned polynomial_count(unsigned order)
{
    return (order + 1) * (order + 2) * (order + 3) / 6;
}

// How long the list is.
static inline unsigned polynomial_list_count(unsigned order)
{
    return POLYNOMIAL_HEAD + order + 1 + polynomial_count(order);
}

static inline unsigned polynomial_order(const double *list)
{
    return (unsigned)list[0];
}

static inline bool polynomial_is_bounded(const double *list)
{
    return list[1] != 0.0;
}

static inline const double *polynomial_sizes(const double *list)
{
    return list + POLYNOMIAL_HEAD;
}

static inline const double *polynomial_terms(const double *list)
{
    return list + POLYNOMIAL_HEAD + polynomial_order(list) + 1;
}

// Completes a list of which the order and the coefficients are in place, and makes a part of a complete one.
void polynomial_complete(double *list);
void polynomial_part(const Numbers *list, Primitive *primitive);

// Whether all coefficients but the last are 0.
bool polynomial_is_constant(const double *list);

// The box of a surface that holds its inside; the list is complete but for it. False: none is known, which is so of all
// but ellipsoids and of what the terms of an even order of at most 8 close (polynomial_box.c).
bool polynomial_box(const double *list, Vec3 *low, Vec3 *high);

// Whether the inside of a quadric is certainly convex.
bool polynomial_is_convex(const double *list);

double polynomial_value(const double *list, Vec3 p);
Vec3 polynomial_gradient(const double *list, Vec3 p);

#endif
