// SPDX-License-Identifier: MIT
#include "scene/superellipsoid.h"

#include <math.h>

// (a^p + b^p)^(1/p) of what is not below 0, and how it changes with each.
static double join(double a, double b, double p, double *by_a, double *by_b)
{
    double most = a > b ? a : b, least = a > b ? b : a;
    if (!(most > 0.0)) {
        *by_a = *by_b = 1.0;
        return most;
    }
    double ratio = least / most, power = pow(ratio, p), sum = 1.0 + power;
    double by_most = pow(sum, 1.0 / p - 1.0),
           by_least = ratio > 0.0 ? by_most * (power / ratio) : by_most * pow(0.0, p - 1.0);
    *by_a = a > b ? by_most : by_least;
    *by_b = a > b ? by_least : by_most;
    return most * (by_most * sum);
}

double superellipsoid_size_and_gradient(Vec3 exponents, Vec3 point, Vec3 *gradient)
{
    double p = 2.0 / exponents.x, q = 2.0 / exponents.y, by_x, by_y, by_across, by_z;
    double across = join(fabs(point.x), fabs(point.y), p, &by_x, &by_y);
    double size = join(across, fabs(point.z), q, &by_across, &by_z);
    *gradient = vec3(copysign(by_across * by_x, point.x), copysign(by_across * by_y, point.y), copysign(by_z, point.z));
    return size;
}

double superellipsoid_size(Vec3 exponents, Vec3 point)
{
    Vec3 gradient;
    return superellipsoid_size_and_gradient(exponents, point, &gradient);
}
