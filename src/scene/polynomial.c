// Horner's scheme in three variables, and what completes a list.
//
// SPDX-License-Identifier: MIT
#include "scene/polynomial.h"

#include <math.h>
#include <string.h>

#include "base/attributes.h"

double polynomial_value(const double *list, Vec3 p)
{
    unsigned order = polynomial_order(list);
    const double *c = polynomial_terms(list);
    double value = 0.0;
    for (unsigned i = order + 1; i-- > 0;) {
        double row = 0.0;
        for (unsigned j = order - i + 1; j-- > 0;) {
            double line = 0.0;
            for (unsigned k = order - i - j + 1; k-- > 0;) {
                line = line * p.z + *c++;
            }
            row = row * p.y + line;
        }
        value = value * p.x + row;
    }
    return value;
}

RT_ALWAYS_INLINE Vec3 gradient_of(const double *list, unsigned order, Vec3 p)
{
    const double *c = polynomial_terms(list);
    double value = 0.0;
    Vec3 gradient = {0.0, 0.0, 0.0};
#pragma GCC unroll 3
    for (unsigned i = order + 1; i-- > 0;) {
        double row = 0.0, row_y = 0.0, row_z = 0.0;
#pragma GCC unroll 3
        for (unsigned j = order - i + 1; j-- > 0;) {
            double line = 0.0, line_z = 0.0;
#pragma GCC unroll 3
            for (unsigned k = order - i - j + 1; k-- > 0;) {
                line_z = line_z * p.z + line;
                line = line * p.z + *c++;
            }
            row_y = row_y * p.y + row;
            row_z = row_z * p.y + line_z;
            row = row * p.y + line;
        }
        gradient.x = gradient.x * p.x + value;
        gradient.y = gradient.y * p.x + row_y;
        gradient.z = gradient.z * p.x + row_z;
        value = value * p.x + row;
    }
    return gradient;
}

// Quadrics are the most by far: their loops are unrolled.
Vec3 polynomial_gradient(const double *list, Vec3 p)
{
    return polynomial_order(list) == 2 ? gradient_of(list, 2, p) : gradient_of(list, polynomial_order(list), p);
}

static void set_sizes(unsigned order, double *list)
{
    double *sizes = list + POLYNOMIAL_HEAD;
    const double *c = list + POLYNOMIAL_HEAD + order + 1;
    for (unsigned degree = 0; degree <= order; degree++) {
        sizes[degree] = 0.0;
    }
    for (unsigned i = order + 1; i-- > 0;) {
        for (unsigned j = order - i + 1; j-- > 0;) {
            for (unsigned k = order - i - j + 1; k-- > 0;) {
                sizes[i + j + k] += fabs(*c++);
            }
        }
    }
}

void polynomial_complete(double *list)
{
    Vec3 low = {0.0, 0.0, 0.0}, high = {0.0, 0.0, 0.0};
    set_sizes(polynomial_order(list), list);
    list[1] = polynomial_box(list, &low, &high);
    const double box[6] = {low.x, low.y, low.z, high.x, high.y, high.z};
    memcpy(list + 2, box, sizeof box);
}

void polynomial_part(const Numbers *list, Primitive *primitive)
{
    primitive->kind = PRIMITIVE_POLYNOMIAL;
    primitive->fixed[0] = vec3(list->items[2], list->items[3], list->items[4]);
    primitive->fixed[1] = vec3(list->items[5], list->items[6], list->items[7]);
    primitive->list = *list;
}

// Squares that are added make it so, and the form of what has a box as a quadric.
bool polynomial_is_convex(const double *list)
{
    const double *c = polynomial_terms(list);
    bool is_sum = c[1] == 0.0 && c[2] == 0.0 && c[5] == 0.0 && c[0] >= 0.0 && c[4] >= 0.0 && c[7] >= 0.0;
    return polynomial_order(list) == 2 && (is_sum || polynomial_is_bounded(list));
}

bool polynomial_is_constant(const double *list)
{
    const double *sizes = polynomial_sizes(list);
    for (unsigned degree = 1; degree <= polynomial_order(list); degree++) {
        if (sizes[degree] != 0.0) {
            return false;
        }
    }
    return true;
}
