// A ray against a box with its faces along the axes. Sides 0 to 5: low and high x, low and high y, low and high z.
//
// The bounds are used as they stand, not as a middle and a size, so that faces of two boxes at one coordinate are met
// at one t, bit for bit. Knows nothing of transforms.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_BOX_H
#define TRACE_BOX_H

#include "trace/ray_interval.h"

static inline bool is_flat_across(Vec3 low, Vec3 high, int axis)
{
    return axis == 0 ? low.x == high.x : axis == 1 ? low.y == high.y : low.z == high.z;
}

// A box without thickness is met once: POV-Ray passes over its other face, which is within its tolerance.
RT_ALWAYS_INLINE bool box_interval(Vec3 low, Vec3 high, Vec3 o, Vec3 d, uint8_t left_side, RayInterval *interval)
{
    RayInterval y, z;
    if (left_side < 6 && is_flat_across(low, high, left_side / 2)) {
        return false; // its two faces are one, which the ray has left
    }
    if (!interval_slab(o.x, d.x, (Slab){low.x, high.x, 0}, left_side, interval) ||
        !interval_slab(o.y, d.y, (Slab){low.y, high.y, 2}, left_side, &y) ||
        !interval_slab(o.z, d.z, (Slab){low.z, high.z, 4}, left_side, &z)) {
        return false;
    }
    interval_meet(interval, &y);
    interval_meet(interval, &z);
    return interval->enter <= interval->leave;
}

RT_ALWAYS_INLINE Vec3 box_normal(uint8_t side)
{
    double sign = side & 1 ? 1.0 : -1.0;
    return vec3(side / 2 == 0 ? sign : 0.0, side / 2 == 1 ? sign : 0.0, side / 2 == 2 ? sign : 0.0);
}

// A point near the side, put onto it.
RT_ALWAYS_INLINE Vec3 box_point(Vec3 low, Vec3 high, Vec3 point, uint8_t side)
{
    Vec3 bound = side & 1 ? high : low;
    switch (side / 2) {
    case 0:
        point.x = bound.x;
        break;
    case 1:
        point.y = bound.y;
        break;
    default:
        point.z = bound.z;
        break;
    }
    return point;
}

#endif
