// Eggs: two balls, and between them what an arc of a circle about the y axis sweeps that touches both from outside.
//
// The greater ball's radius is half of the arc's. All is measured from half the egg's height, and is as great as the
// primitive's numbers say: an Ovus is its data. Where a point is nearest to which of the three is decided by normals of
// the profile: so the distance is right outside, and within as far as the arc's end. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_OVUS_H
#define SCENE_OVUS_H

#include <math.h>

#include "math/vec3.h"

typedef struct Ovus {
    double bottom, top;     // radii of the balls
    double low, high;       // the y of their middles
    double arc, beyond, at; // the arc's radius; its middle is so far beyond the axis, and at this y
} Ovus;

enum { OVUS_NUMBERS = 7 };

// Of two radii, the second less than twice the first.
static inline Ovus ovus_make(double bottom, double top)
{
    double arc = 2.0 * fmax(bottom, top), to_bottom = arc - bottom, to_top = arc - top;
    double at = ((to_bottom - to_top) * (to_bottom + to_top) + bottom * bottom) / (2.0 * bottom), middle = 0.5 * top;
    double beyond = sqrt(fmax((to_bottom - at) * (to_bottom + at), 0.0));
    return (Ovus){bottom, top, -middle, bottom - middle, arc, beyond, at - middle};
}

static inline Ovus ovus_of(const Vec3 data[3])
{
    return (Ovus){data[0].x, data[0].y, data[0].z, data[1].x, data[1].y, data[1].z, data[2].x};
}

// Where a ball or the arc has its middle, for a point, or a direction from the middle of the egg, across the axis and
// along it; of the arc it is on the other side of the axis. Its radius.
static inline double ovus_part(const Ovus *ovus, double across, double along_low, double along_high, double *beyond,
                               double *at)
{
    *beyond = 0.0;
    if (ovus->beyond * along_low + (ovus->at - ovus->low) * across < 0.0) {
        *at = ovus->low;
        return ovus->bottom;
    }
    if (ovus->beyond * along_high + (ovus->at - ovus->high) * across > 0.0) {
        *at = ovus->high;
        return ovus->top;
    }
    *beyond = ovus->beyond;
    *at = ovus->at;
    return ovus->arc;
}

// How far outside a point is, and the direction of what is nearest.
static inline double ovus_distance(const Ovus *ovus, Vec3 p, Vec3 *normal)
{
    double across = hypot(p.x, p.z), beyond, at;
    double radius = ovus_part(ovus, across, p.y - ovus->low, p.y - ovus->high, &beyond, &at);
    double out = across + beyond, up = p.y - at, length = hypot(out, up);
    double share = across > 0.0 ? out / (across * length) : 0.0;
    *normal = vec3(p.x * share, length > 0.0 ? up / length : 1.0, p.z * share);
    return length - radius;
}

// The greatest p·n.
static inline double ovus_support(const Ovus *ovus, Vec3 n)
{
    double across = hypot(n.x, n.z), beyond, at;
    double radius = ovus_part(ovus, across, n.y, n.y, &beyond, &at);
    return radius * hypot(across, n.y) - beyond * across + at * n.y;
}

#endif
