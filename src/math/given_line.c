// Lines with a thickness, and lumps about the origin.
//
// SPDX-License-Identifier: MIT
#include "math/given_curve.h"

#include <math.h>

static double square_of(const double *a)
{
    return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

// ---- lumps

static double bump(double strength, double square)
{
    double left = 1.0 - square;
    return left > 0.0 ? strength * left * left : 0.0;
}

double given_blob(const Noise *noise, const double *a)
{
    double across = a[1] * a[1] + a[2] * a[2], left = a[0] + a[3] / 2.0, right = a[0] - a[3] / 2.0;
    (void)noise;
    return -bump(a[4], (left * left + across) * a[5] * a[5]) - bump(a[6], (right * right + across) * a[7] * a[7]);
}

double given_blob2(const Noise *noise, const double *a)
{
    double across = a[1] * a[1] + a[2] * a[2], right = a[0] - a[3];
    (void)noise;
    return a[6] - a[5] * (exp(-a[4] * (a[0] * a[0] + across)) + exp(-a[4] * (right * right + across)));
}

// Of three ellipsoids, whose parameter is how much less they are about their axis, what falls with the distance.
static void ellipsoids(const double *a, double about, double fall, double values[3])
{
    double square = square_of(a);
    for (int axis = 0; axis < 3; axis++) {
        double along = a[axis] * a[axis];
        values[axis] = exp(-fall * (about * (square - along) + along));
    }
}

double given_cross_ellipsoids(const Noise *noise, const double *a)
{
    double v[3];
    (void)noise;
    ellipsoids(a, a[3], a[4], v);
    return a[6] - a[5] * fmax(fmax(v[0], v[1]), v[2]);
}

double given_isect_ellipsoids(const Noise *noise, const double *a)
{
    double v[3];
    (void)noise;
    ellipsoids(a, a[3], a[4], v);
    return a[6] - a[5] * fmin(fmin(v[0], v[1]), v[2]);
}

double given_flange_cover(const Noise *noise, const double *a)
{
    double v[3];
    (void)noise;
    ellipsoids(a, a[3], a[4], v);
    return a[6] - a[5] * (v[0] + v[1] + v[2]);
}

double given_spikes(const Noise *noise, const double *a)
{
    double v[3];
    (void)noise;
    ellipsoids(a, a[3], a[4], v);
    return a[5] * (v[0] + v[1] + v[2] - a[7] * exp(-a[6] * square_of(a)));
}

// A d orbital's density.
double given_quantum(const Noise *noise, const double *a)
{
    double shape = 2.0 * a[1] * a[1] - a[0] * a[0] - a[2] * a[2];
    (void)noise;
    return 1.2 - 1.6 * shape * shape * exp(-1.33333332 * sqrt(square_of(a)));
}

double given_poly4(const Noise *noise, const double *a)
{
    double y = a[1], radius = a[3] + y * (a[4] + y * (a[5] + y * (a[6] + y * a[7])));
    (void)noise;
    return sqrt(a[0] * a[0] + a[2] * a[2]) - fmax(radius, -5.0);
}

// ---- lines

// The distance from a line, two numbers across it, by the shape that it is cut with: 0 is a square, 1 a circle, 2 a
// square on a corner.
static double from_line(double across, double along, double shape)
{
    across = fabs(across);
    along = fabs(along);
    if (shape == 0.0) {
        return fmax(across, along);
    }
    return shape == 1.0 ? hypot(across, along) : pow(pow(across, 2.0 / shape) + pow(along, 2.0 / shape), shape * 0.5);
}

double given_spiral(const Noise *noise, const double *a)
{
    double radius = sqrt(a[0] * a[0] + a[2] * a[2]), distance = sqrt(square_of(a));
    double turns = radius / a[3] + atan2(a[2], a[0]) / (2.0 * M_PI);
    double line = from_line((turns - floor(turns) - 0.5) * a[3], a[1], a[8]);
    (void)noise;
    return fmax(fmin(line, distance) - a[4], distance - a[5]);
}

// A tube for each of a[3] around the y axis, every turn of it as far above the last one.
double given_helix1(const Noise *noise, const double *a)
{
    double radius = sqrt(a[0] * a[0] + a[2] * a[2]), count = a[3], period = a[4], turn = a[9] * M_PI / 180.0;
    double turned = count * (atan2(a[2], a[0]) + period * a[1]);
    double out = radius - a[6];
    double up = (turned - 2.0 * M_PI * floor(turned / (2.0 * M_PI)) - M_PI) / (count * period * a[7]);
    double line = from_line(out * cos(turn) - up * sin(turn), out * sin(turn) + up * cos(turn), a[8]);
    (void)noise;
    return (line < radius + a[6] ? line : radius + a[6]) - a[5];
}

// A section moved away from the y axis, and turned about that with the height.
double given_helix2(const Noise *noise, const double *a)
{
    double c = cos(a[4] * a[1]), s = sin(a[4] * a[1]);
    (void)noise;
    return from_line(a[0] * c + a[2] * s - a[6], a[2] * c - a[0] * s, a[8]) - a[5];
}

// The distance from the nearest of a[3] points of a circle, the first of which is at the z axis; the last one may be
// nearer to that than the others are to each other.
double given_polytubes(const Noise *noise, const double *a)
{
    double y = a[1], from = a[4] + y * (a[5] + y * (a[6] + y * (a[7] + y * a[8])));
    double radius = sqrt(a[0] * a[0] + a[2] * a[2]), turn = 2.0 * M_PI / a[3], least = INFINITY,
           last = floor(a[3]) - 1.0;
    double angle = atan2(a[0], a[2]) + (from < 0.0 ? M_PI : 0.0);
    (void)noise;
    if (!(a[3] >= 1.0)) {
        return 10000.0;
    }
    double before = floor((angle < 0.0 ? angle + 2.0 * M_PI : angle) / turn);
    const double near[] = {0.0, fmin(before, last), fmin(before + 1.0, last), last};
    for (int i = 0; i < 4; i++) {
        double off = atan2(a[0], a[2]) - near[i] * turn;
        least = fmin(least, hypot(radius * cos(off) - from, radius * sin(off)));
    }
    return least;
}

// The least of two threads of a cloth that lie at both sides; `height` is y beside what a thread is high where it is
// highest, and every other thread is low there.
static double from_threads(double place, double spacing, const double *a, double rise)
{
    double first = floor(place / spacing), least = INFINITY;
    for (int side = 0; side < 2; side++) { // nothing is beside what is infinite
        double line = first + side;
        double across = a[5] * (place - line * spacing);
        double up = a[7] * (a[1] - (fmod(line, 2.0) == 0.0 ? rise : -rise));
        least = fmin(least, sqrt(across * across + up * up));
    }
    return least;
}

double given_mesh(const Noise *noise, const double *a)
{
    double along_x = from_threads(a[2], a[4], a, a[6] * cos(M_PI * a[0] / a[3]));
    double along_z = from_threads(a[0], a[3], a, -a[6] * cos(M_PI * a[2] / a[4]));
    (void)noise;
    return fmin(along_x, along_z);
}
