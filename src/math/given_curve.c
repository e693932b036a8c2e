// Curves: what is 0 on one, of x and y.
//
// SPDX-License-Identifier: MIT
#include "math/given_curve.h"

#include <math.h>

#include "base/number.h"

// Where a point is in the curve's plane: with the first of three parameters greater than 0 it is turned about the y
// axis, moved along x and turned by degrees.
static void to_plane(const double *a, const double *turn, double *x, double *y)
{
    *x = a[0];
    *y = a[1];
    if (turn[0] > 0.0) {
        double angle = number_radians(turn[2]), from = sqrt(a[0] * a[0] + a[2] * a[2]) - turn[1];
        *x = from * cos(angle) - a[1] * sin(angle);
        *y = a[1] * cos(angle) + from * sin(angle);
    }
}

static double cut(double value, double most)
{
    value = value < most ? value : most;
    return value > -most ? value : -most;
}

double given_algebraic1(const Noise *noise, const double *a)
{
    double x, y;
    (void)noise;
    to_plane(a, a + 5, &x, &y);
    return cut(a[3] * (y * y + fabs(x) * x * x - x * x), a[4]);
}

double given_algebraic2(const Noise *noise, const double *a)
{
    double x, y;
    (void)noise;
    to_plane(a, a + 5, &x, &y);
    double x2 = x * x, y2 = y * y;
    return -cut(a[3] * (2.0 * x2 * x2 - 3.0 * x2 * y + y2 - 2.0 * y2 * y + y2 * y2), a[4]);
}

double given_algebraic3(const Noise *noise, const double *a)
{
    double x, y;
    (void)noise;
    to_plane(a, a + 5, &x, &y);
    double x2 = x * x, y2 = y * y;
    return -cut(a[3] * (x2 * x2 + x2 * y2 - 2.0 * x2 * y - x * y2 + y2), a[4]);
}

double given_algebraic4(const Noise *noise, const double *a)
{
    double x, y;
    (void)noise;
    to_plane(a, a + 5, &x, &y);
    double sum = x * x + y * y;
    return -cut(a[3] * (sum * sum + 3.0 * x * x * y - y * y * y), a[4]);
}

double given_devils_curve(const Noise *noise, const double *a)
{
    double x, y;
    (void)noise;
    to_plane(a, a + 6, &x, &y);
    double x2 = x * x, y2 = y * y;
    return cut(a[3] * (y2 * (y2 - a[5] * a[5]) - x2 * (x2 - a[4] * a[4])), 10.0);
}

double given_folium(const Noise *noise, const double *a)
{
    double x, y;
    (void)noise;
    to_plane(a, a + 6, &x, &y);
    return -cut(a[3] * (y * y * (1.0 + (a[5] - 4.0 * a[4]) * x) + (1.0 + a[5]) * x * x), 10.0);
}

double given_kampyle(const Noise *noise, const double *a)
{
    double x, y;
    (void)noise;
    to_plane(a, a + 6, &x, &y);
    double x2 = x * x;
    return cut(a[3] * (a[5] * a[5] * (x2 * x2 - a[4] * a[5] * x2) - y * y), 10.0);
}

double given_lemniscate(const Noise *noise, const double *a)
{
    double x, y;
    (void)noise;
    to_plane(a, a + 6, &x, &y);
    double x2 = x * x;
    return -cut(a[3] * (a[5] * a[5] * (x2 * x2 - a[4] * a[4] * x2) + y * y), 10.0);
}

double given_piriform(const Noise *noise, const double *a)
{
    double x, y;
    (void)noise;
    to_plane(a, a + 7, &x, &y);
    return cut(a[3] * (a[6] * a[6] * x * x * x * (a[4] + a[5] * x) - y * y), 10.0);
}

double given_strophoid(const Noise *noise, const double *a)
{
    double x, y;
    (void)noise;
    to_plane(a, a + 7, &x, &y);
    return cut(a[3] * (y * y * (x - a[5]) + a[6] * a[6] * x * x * (x + a[4])), 10.0);
}

double given_witch_of_agnesi(const Noise *noise, const double *a)
{
    double x, y;
    (void)noise;
    to_plane(a, a + 6, &x, &y);
    return cut(a[3] * (a[5] - y * (a[4] * a[4] + x * x)), 10.0);
}
