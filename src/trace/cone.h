// A ray against a cone or cylinder about z: 0 <= z <= 1, radius 1 + (ratio - 1) z, 0 <= ratio <= 1. Side 0 is round, 1
// the disc at z = 0, 2 the one at z = 1.
//
// With o and d the ray in x and y, p + q t the radius at its z: |o + t d|² = (p + q t)² has the discriminant
// |p d - q o|² - (o × d)², which compares lengths where b² - ac would cancel. Knows nothing of transforms.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_CONE_H
#define TRACE_CONE_H

#include "math/extreme.h"
#include "trace/ray_interval.h"

enum { CONE_ROUND, CONE_BASE, CONE_CAP };

#include "math/lane_double.h"
#include "trace/cone.inc"

// The line inside the round side, on the tip's own side only where the discs' planes decide.
RT_ALWAYS_INLINE bool cone_round_interval(const ConeRoots *r, RayInterval *interval)
{
    *interval = (RayInterval){-(double)INFINITY, (double)INFINITY, CONE_ROUND, CONE_ROUND};
    if (r->a == 0.0 && r->b == 0.0) {
        return r->c <= 0.0;
    }
    // Negative for a < 0 by rounding alone, where the line goes through the tip.
    if (!(r->discriminant >= 0.0) && !(r->a < 0.0)) {
        return false;
    }
    double sum = cone_sum(r, sqrt(greater_of(r->discriminant, 0.0)));
    if (r->a == 0.0) {
        *(r->b < 0.0 ? &interval->enter : &interval->leave) = r->c / sum;
    } else {
        *interval = cone_round(r, sum);
    }
    return !isnan(interval->enter) && !isnan(interval->leave);
}

// The same for a ray that starts on the round side and goes in: c = 0 leaves -2 b / a.
RT_ALWAYS_INLINE bool cone_round_interval_inward(const ConeRoots *r, RayInterval *interval)
{
    *interval = (RayInterval){-(double)INFINITY, (double)INFINITY, CONE_ROUND, CONE_ROUND};
    if (r->a > 0.0) {
        interval->leave = -2.0 * r->b / r->a;
    }
    return interval->leave > 0.0;
}

RT_ALWAYS_INLINE bool cone_interval(double ratio, Vec3 o, Vec3 d, uint8_t left_side, RayInterval *interval)
{
    RayInterval slab;
    ConeRoots roots = cone_roots(ratio, o, d);
    if (!(left_side == CONE_ROUND ? cone_round_interval_inward(&roots, interval)
                                  : cone_round_interval(&roots, interval)) ||
        !interval_slab(o.z, d.z, (Slab){0.0, 1.0, CONE_BASE}, left_side, &slab)) {
        return false;
    }
    interval_meet(interval, &slab);
    return interval->enter <= interval->leave;
}

// The outward normal at a point of the side, not of unit length.
RT_ALWAYS_INLINE Vec3 cone_normal(double ratio, Vec3 point, uint8_t side)
{
    if (side != CONE_ROUND) {
        return vec3(0.0, 0.0, side == CONE_CAP ? 1.0 : -1.0);
    }
    double radius = sqrt(point.x * point.x + point.y * point.y);
    return radius > 0.0 ? vec3(point.x / radius, point.y / radius, 1.0 - ratio) : vec3(0.0, 0.0, 1.0);
}

// A vector along that, of any length, for what does not want it to the last bit: no root where it can be done without.
RT_ALWAYS_INLINE Vec3 cone_gradient(double ratio, Vec3 point, uint8_t side)
{
    if (side != CONE_ROUND || (point.x == 0.0 && point.y == 0.0)) {
        return vec3(0.0, 0.0, 1.0);
    }
    double rise = ratio == 1.0 ? 0.0 : (1.0 - ratio) * sqrt(point.x * point.x + point.y * point.y);
    return vec3(point.x, point.y, rise);
}

// A point near the side, put onto it.
RT_ALWAYS_INLINE Vec3 cone_point(double ratio, Vec3 point, uint8_t side)
{
    if (side != CONE_ROUND) {
        return vec3(point.x, point.y, side == CONE_CAP ? 1.0 : 0.0);
    }
    double radius = sqrt(point.x * point.x + point.y * point.y);
    double factor = radius > 0.0 ? (1.0 + (ratio - 1.0) * point.z) / radius : 1.0;
    return vec3(factor * point.x, factor * point.y, point.z);
}

#endif
