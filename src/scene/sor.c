// SPDX-License-Identifier: MIT
#include "scene/sor.h"

#include <math.h>

// The slope of the radius squared at point i, from its neighbours.
static double slope_at(const double *points, uint32_t i)
{
    const double *p = points + 2 * (uint64_t)i;
    return 2.0 * p[0] * (p[2] - p[-2]) / (p[3] - p[-1]);
}

void sor_complete(double *items)
{
    uint32_t count = (uint32_t)items[0];
    const double *points = items + 1;
    double *squares = items + 1 + 2 * (uint64_t)count;
    for (uint32_t i = 1; i + 2 < count; i++, squares += 4) {
        const double *p = points + 2 * (uint64_t)i;
        double third = (p[3] - p[1]) / 3.0;
        squares[0] = p[0] * p[0];
        squares[3] = p[2] * p[2];
        squares[1] = squares[0] + slope_at(points, i) * third;
        squares[2] = squares[3] - slope_at(points, i + 1) * third;
    }
}

uint32_t sor_stretch_of(const Numbers *list, double y)
{
    uint32_t low = 0, high = sor_stretch_count(list);
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        *(sor_height(list, middle) <= y ? &low : &high) = middle;
    }
    return low;
}

double sor_square(const Numbers *list, uint32_t stretch, double y, double *slope)
{
    const double *f = sor_squares(list, stretch);
    double from = sor_height(list, stretch), height = sor_height(list, stretch + 1) - from;
    double s = fmin(1.0, fmax(0.0, (y - from) / height)), r = 1.0 - s;
    double rise = (f[1] - f[0]) * r * r + 2.0 * s * r * (f[2] - f[1]) + s * s * (f[3] - f[2]);
    *slope = 3.0 * rise / height;
    return ((f[0] * r + 3.0 * s * f[1]) * r + 3.0 * s * s * f[2]) * r + s * s * s * f[3];
}

bool sor_holds(const Numbers *list, double square, double y)
{
    uint32_t count = sor_stretch_count(list);
    double slope;
    return y >= sor_height(list, 0) && y <= sor_height(list, count) &&
           square < sor_square(list, sor_stretch_of(list, y), y, &slope);
}

double sor_radius_most(const Numbers *list)
{
    const double *f = sor_squares(list, 0);
    double most = 0.0;
    for (uint64_t i = 0; i < 4 * (uint64_t)sor_stretch_count(list); i++) {
        most = fmax(most, f[i]);
    }
    return sqrt(most);
}

double sor_radius_extent(const Numbers *list)
{
    double most = 0.0, slope;
    for (uint32_t i = 0; i < sor_stretch_count(list); i++) {
        const double *f = sor_squares(list, i);
        double from = sor_height(list, i), height = sor_height(list, i + 1) - from;
        double a = f[1] - f[0], b = f[2] - f[1], c = f[3] - f[2], square = (a - b) - (b - c), half = a - b;
        double root = sqrt(fmax(0.0, half * half - square * a)), q = half + copysign(root, half);
        const double at[2] = {q / square, a / q};
        most = fmax(most, fmax(f[0], f[3]));
        for (int k = 0; k < 2; k++) {
            if (at[k] > 0.0 && at[k] < 1.0) {
                most = fmax(most, sor_square(list, i, from + at[k] * height, &slope));
            }
        }
    }
    return sqrt(most);
}
