// A line through a fractal's ball is walked from one end to the other, as POV-Ray does it: by 1 / precision, or as far
// as the distance is estimated to be where that is more; where a step has changed sides, the crossing is found by
// halving to a width, and counted at the end that is inside. A ray that leaves it continues a little before it looks;
// where it is inside there, where it comes out is what it meets, and too near it meets nothing. The lengths are
// POV-Ray's, in the fractal's own space. Measured.
//
// SPDX-License-Identifier: MIT
#include "trace/julia.h"

#include "math/extreme.h"

enum { ASKED_EVERY = 1024 }; // so often it is asked whether somebody wants the answer

static const double crossing_width = 1e-7, start_ahead = 3e-7, least_way = 1e-4;

typedef struct Walk {
    const Julia *julia;
    const Abandon *abandon;
    Ray ray;
    double length; // of the ray's direction
    IntervalWalk found;
    bool is_alone, is_over;
} Walk;

static void cross(Walk *walk, double t)
{
    interval_walk_cross(&walk->found, t, 0);
    walk->is_over = walk->is_alone;
}

// Between a place on the side that the walk is on, and one on the other.
static double halve(const Walk *walk, double low, double high)
{
    double reach;
    for (;;) {
        double middle = 0.5 * (low + high);
        if (!((high - low) * walk->length > crossing_width && low < middle && middle < high)) {
            return walk->found.is_inside ? low : high;
        }
        *(julia_holds(walk->julia, ray_at(walk->ray, middle), &reach) == walk->found.is_inside ? &low : &high) = middle;
    }
}

// From a place on; whether that is inside is known.
static void step_on(Walk *walk, double at, double to)
{
    double least = 1.0 / walk->julia->precision, reach = 0.0;
    julia_holds(walk->julia, ray_at(walk->ray, at), &reach);
    for (unsigned asked = 1; !walk->is_over && walk->found.count < JULIA_INTERVALS_MOST; asked++) {
        double next = at + greater_of(least, walk->found.is_inside ? 0.0 : reach) / walk->length;
        bool is_lost = asked % ASKED_EVERY == 0 && walk->abandon && trace_is_abandoned(walk->abandon);
        if (!(next > at && next < to) || is_lost) {
            break;
        }
        if (julia_holds(walk->julia, ray_at(walk->ray, next), &reach) != walk->found.is_inside) {
            cross(walk, halve(walk, at, next));
        }
        at = next;
    }
}

unsigned julia_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left, RayInterval *intervals)
{
    const IsosurfaceWorld *world = primitive->isosurface.world;
    Walk walk = {.julia = julia_of(primitive->isosurface.list),
                 .abandon = world ? world->abandon : NULL,
                 .ray = *object,
                 .length = vec3_length(object->direction),
                 .found = {.open = INTERVAL_ALL, .intervals = intervals}};
    double middle, half, reach;
    if (!ball_line(object, walk.julia->radius, &middle, &half) || !(half > 0.0 && middle + half > 0.0)) {
        return 0;
    }
    double from = middle - half, to = middle + half;
    bool is_start = left.side != SIDE_NONE;
    double at = greater_of(from, start_ahead / walk.length);
    bool begins_inside = is_start && left.inward ? true : julia_holds(walk.julia, ray_at(*object, at), &reach);
    walk.is_alone = primitive->node == NODE_NONE;
    if (begins_inside && from > 0.0) {
        cross(&walk, from);
    } else {
        walk.found.is_inside = begins_inside;
    }
    step_on(&walk, at, to);
    if (!(is_start && left.inward) && begins_inside && walk.is_over &&
        walk.found.intervals[0].leave * walk.length < least_way) {
        return 0;
    }
    if (walk.is_over && walk.found.is_inside) { // it ends somewhere behind
        interval_walk_stay(&walk.found);
    } else if (walk.found.is_inside) {
        cross(&walk, to);
    }
    return walk.found.count;
}

Vec3 julia_normal(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)side;
    return julia_gradient(julia_of(primitive->isosurface.list), point);
}
