// Which spheres of a block a bundle of rays from one point may meet: part of spheres_kernel.c.
//
// The rays lie in a cone. A sphere that one of them meets is no farther from the cone's axis than |centre - origin|
// spread + radius, and one that is met end_radius of them farther by that. Spreads carry a margin far above what rounding does, so that no sphere is lost.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_CONE_TEST_H
#define TRACE_CONE_TEST_H

#include "trace/simd.h"
#include "trace/spheres.h"

// Rays from `origin` whose directions, of unit length, are within `spread` of the axis, and what is `end_radius` of them.
typedef struct RayCone {
    Vec3 origin, axis;
    double spread, end_radius;
} RayCone;

// For the rounding of distances from an axis, which are differences of squares: their error is about 2^-25 |f|.
static const double CONE_MARGIN = 0x1p-20;

// How far some directions are from an axis; `begin` and `end` are multiples of a vector's width.
RT_ALWAYS_INLINE double cone_spread(const double direction[3][TILE_RAYS], unsigned begin, unsigned end, Vec3 axis)
{
    Doubles greatest = doubles_splat(0.0);
    for (unsigned i = begin; i < end; i += DOUBLES) {
        Doubles x = doubles_load(&direction[0][i]) - axis.x;
        Doubles y = doubles_load(&direction[1][i]) - axis.y;
        Doubles z = doubles_load(&direction[2][i]) - axis.z;
        greatest = doubles_max(greatest, x * x + y * y + z * z);
    }
    return sqrt(doubles_greatest(greatest)) + CONE_MARGIN;
}

// The spheres of a block that the cone touches, a bit for each.
RT_ALWAYS_INLINE unsigned cone_spheres(const RayCone *cone, const SphereBlock *block)
{
    unsigned touched = 0;
    for (int i = 0; i < SPHERE_BLOCK; i += DOUBLES) {
        Doubles fx = cone->origin.x - doubles_load(&block->x[i]);
        Doubles fy = cone->origin.y - doubles_load(&block->y[i]);
        Doubles fz = cone->origin.z - doubles_load(&block->z[i]);
        Doubles along = fx * cone->axis.x + fy * cone->axis.y + fz * cone->axis.z;
        Doubles f_squared = fx * fx + fy * fy + fz * fz;
        Doubles radius_squared = doubles_load(&block->radius_squared[i]);
        Doubles reach = doubles_sqrt(f_squared) * cone->spread + (doubles_sqrt(radius_squared) + cone->end_radius);
        unsigned apart = doubles_ge(f_squared - along * along, reach * reach); // never where squares overflow
        touched |= (doubles_ge(radius_squared, doubles_splat(0.0)) & ~apart) << i;
    }
    return touched;
}

// The least and the greatest of some numbers; `end` is a multiple of a vector's width.
RT_ALWAYS_INLINE void values_range(const double values[TILE_RAYS], unsigned end, double *least, double *greatest)
{
    Doubles low = doubles_load(values), high = low;
    for (unsigned i = DOUBLES; i < end; i += DOUBLES) {
        low = doubles_min(low, doubles_load(&values[i]));
        high = doubles_max(high, doubles_load(&values[i]));
    }
    *least = doubles_least(low);
    *greatest = doubles_greatest(high);
}

// Between what the components of some directions lie.
typedef struct DirectionRange {
    double low[3], high[3];
} DirectionRange;

RT_ALWAYS_INLINE void direction_range(const double direction[3][TILE_RAYS], unsigned end, DirectionRange *range)
{
    for (int axis = 0; axis < 3; axis++) {
        values_range(direction[axis], end, &range->low[axis], &range->high[axis]);
    }
}

// Whether directions differ so little that one walk for all of them pays; false for NaN.
RT_ALWAYS_INLINE bool direction_range_is_narrow(const DirectionRange *range)
{
    return range->high[0] - range->low[0] < 0.75 && range->high[1] - range->low[1] < 0.75 &&
           range->high[2] - range->low[2] < 0.75;
}

enum { OCTANTS = 8 };

// The part of it in an octant, whose bits are set for axes along which it is negative: components least and greatest by
// size. False when there is none.
RT_ALWAYS_INLINE bool direction_octant(const DirectionRange *range, unsigned octant, Vec3 *least, Vec3 *greatest)
{
    double near[3], far[3];
    for (int axis = 0; axis < 3; axis++) {
        double low = range->low[axis], high = range->high[axis];
        bool is_negative = octant >> axis & 1;
        if (is_negative ? !(low < 0.0) : !(high > 0.0 || low >= 0.0)) {
            return false;
        }
        near[axis] = is_negative ? (high < 0.0 ? high : -0.0) : (low > 0.0 ? low : 0.0);
        far[axis] = is_negative ? low : high;
    }
    *least = vec3(near[0], near[1], near[2]);
    *greatest = vec3(far[0], far[1], far[2]);
    return true;
}

#endif
