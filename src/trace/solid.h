// A ray against any part: prepared parts, their intervals, and surfaces at a hit.
//
// The ray is taken into the part's own space, where its parameter means the same; its direction is not of unit length
// there. Knows nothing of composites.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SOLID_H
#define TRACE_SOLID_H

#include "math/ray.h"
#include "math/transform.h"
#include "scene/scene.h"
#include "trace/ray_interval.h"
#include "trace/sphere.h"

// A part as the tracer wants it. The map is kept as a centre and two linear parts, so that no digits are lost far from
// the origin.
typedef struct Solid {
    PartKind kind;
    uint8_t flags, hidden; // of the composite, if it is in one
    bool flips;            // the outside of what the part is in is this part's inside
    bool decides;          // outside of it nothing is seen of the composite; it is convex, so a line is inside once
    uint32_t node;         // of the geometry; NODE_NONE alone
    uint32_t composite;    // NODE_NONE alone
    uint32_t twin;         // of a ball: the slot of a sphere that equals it, SLOT_NONE if there is none
    MaterialIndex material;
    uint32_t order, body;
    Vec3 centre;
    double extent, spread; // solid_measure; extent: 0 where no column has more than one entry
    Vec3 columns;          // lengths of the columns of to_object
    uint8_t entries[3];    // of each column: a bit for each that is not 0
    Linear to_object, to_world; // what tests need stands before what surfaces need
    Vec3 data[3];
} Solid;

RT_ALWAYS_INLINE bool solid_is_flat(const Solid *solid)
{
    return solid->kind >= PART_DISC;
}

// The ray in the solid's own space; for a plane as it is.
RT_ALWAYS_INLINE Ray solid_ray(const Solid *solid, const Ray *ray)
{
    if (solid->kind == PART_PLANE) {
        return *ray;
    }
    return (Ray){linear_direction(&solid->to_object, vec3_sub(ray->origin, solid->centre)),
                 linear_direction(&solid->to_object, ray->direction)};
}

// The line inside a solid that is not flat; `object` is the ray in its space. `left_side`: as in interval.h.
bool solid_interval(const Solid *solid, const Ray *object, uint8_t left_side, RayInterval *interval) RT_MUST_CHECK;

// Where the line meets a flat solid.
bool solid_flat_root(const Solid *solid, const Ray *object, double *t) RT_MUST_CHECK;

// What the bounds of rounding want of the map: its columns, and as `extent` the sum of the lengths that it gives to the
// fixed shape, more where it makes angles narrow: what its own rounding, and its inverse's, are beside. `spread` is that
// and the sum of the coordinates of the centre.
void solid_measure(Solid *solid);

// How far a crossing's t may be off by rounding; docs/numerics.md has the bound. Infinite along the surface.
double solid_crossing_error(const Solid *solid, const Ray *ray, const Ray *object, double t, uint8_t side);

// What is at least that, for less work; `span` is |o| + t |d| of the ray, each |v| the sum of its coordinates' sizes. It
// may be NaN.
double solid_crossing_bound(const Solid *solid, const Ray *ray, const Ray *object, double t, uint8_t side, double span);

// The same for a ball, whose crossing is not off by more than its interval is long.
double solid_ball_error(const Solid *ball, const Ray *ray, const Ray *object, double t);

// The same for an end of an interval. Where the ray grazes a round side the bound has no bounds, but a crossing is not
// off by more than the interval is long. 0 for an end that is infinite.
double solid_interval_error(const Solid *solid, const Ray *ray, const Ray *object, const RayInterval *interval,
                            bool leaves);
double solid_end_error(const Solid *solid, const Ray *ray, const Ray *object, double t, uint8_t side, double length);

// The point of a hit put back onto the side, and the solid's own outward unit normal there.
void solid_surface(const Solid *solid, const Ray *ray, double t, uint8_t side, Vec3 *point, Vec3 *normal);

// True when two solids are the same surface, declared twice.
bool solid_equal(const Solid *a, const Solid *b);

#endif
