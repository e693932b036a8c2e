// Orbits, and how far steps may go, in the manner of the distance that J. Hart, D. Sandin and L. Kauffman estimate
// ("Ray tracing deterministic 3-D fractals", SIGGRAPH 1989): log |h|² / n over the product of n |h| along the orbit,
// for h^n. Measured.
//
// SPDX-License-Identifier: MIT
#include "scene/julia.h"

#include <math.h>

static double square_of(const double h[4])
{
    return h[0] * h[0] + h[1] * h[1] + h[2] * h[2] + h[3] * h[3];
}

void julia_complete(Julia *julia)
{
    const double *n = julia->slice;
    julia->radius = fmin(1.0 + sqrt(square_of(julia->p)), 2.0) + 1e-7;
    julia->fourth = julia->distance * sqrt(square_of(n)) / n[3];
    for (int i = 0; i < 3; i++) {
        julia->rise[i] = n[i] / n[3];
    }
}

static void start(const Julia *julia, Vec3 p, double h[4])
{
    h[0] = p.x;
    h[1] = p.y;
    h[2] = p.z;
    h[3] = julia->fourth - (julia->rise[0] * p.x + julia->rise[1] * p.y + julia->rise[2] * p.z);
}

static void next(const Julia *julia, double h[4])
{
    double a = h[0], b = h[1], c = h[2], d = h[3], vector2 = b * b + c * c + d * d;
    const double *p = julia->p;
    bool is_cube = julia->power > 2.0;
    double real = is_cube ? a * (a * a - 3.0 * vector2) : a * a - vector2;
    double times = is_cube ? 3.0 * a * a - vector2 : 2.0 * a;
    h[0] = real + p[0];
    h[1] = times * b + p[1];
    h[2] = times * c + p[2];
    h[3] = times * d + p[3];
}

bool julia_holds(const Julia *julia, Vec3 p, double *reach)
{
    double h[4], most = julia->radius * julia->radius + 1e-7, slope2 = 1.0;
    start(julia, p, h);
    for (int i = 0; i < (int)julia->step_count; i++) {
        double square = square_of(h);
        if (!(square <= most)) {
            double estimate = log(square) / (julia->power * sqrt(slope2));
            *reach = isfinite(estimate) ? estimate : 0.0;
            return false;
        }
        slope2 *= julia->power * julia->power * square;
        next(julia, h);
    }
    *reach = 0.0;
    return true;
}

// What a step makes of a change of h.
static void change(const Julia *julia, const double h[4], double g[4])
{
    double a = h[0], b = h[1], c = h[2], d = h[3], ga = g[0], gb = g[1], gc = g[2], gd = g[3];
    double vector2 = b * b + c * c + d * d, along = 2.0 * (b * gb + c * gc + d * gd);
    bool is_cube = julia->power > 2.0;
    double times = is_cube ? 3.0 * a * a - vector2 : 2.0 * a, more = is_cube ? 6.0 * a * ga - along : 2.0 * ga;
    g[0] = is_cube ? 3.0 * (a * a - vector2) * ga - 3.0 * a * along : 2.0 * a * ga - along;
    g[1] = times * gb + more * b;
    g[2] = times * gc + more * c;
    g[3] = times * gd + more * d;
}

// Of |h|² after the last step, in the slice as if it were h[3] = 0, as POV-Ray has it. Measured.
Vec3 julia_gradient(const Julia *julia, Vec3 p)
{
    double h[4], axes[3][4] = {{1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}}, n[3];
    start(julia, p, h);
    for (int i = 0; i < (int)julia->step_count; i++) {
        double most = 0.0;
        for (int axis = 0; axis < 3; axis++) {
            change(julia, h, axes[axis]);
            most = fmax(most, square_of(axes[axis]));
        }
        next(julia, h);
        double scale = most > 0.0 && isfinite(most) ? ldexp(1.0, -ilogb(most) / 2) : 1.0;
        for (int k = 0; k < 12; k++) {
            axes[k / 4][k % 4] *= scale;
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        n[axis] = h[0] * axes[axis][0] + h[1] * axes[axis][1] + h[2] * axes[axis][2] + h[3] * axes[axis][3];
    }
    Vec3 normal = {n[0], n[1], n[2]};
    double size = vec3_max_abs(normal);
    return size > 0.0 && isfinite(size) ? vec3_scale(1.0 / size, normal) : vec3(1.0, 0.0, 0.0);
}
