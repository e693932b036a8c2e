// An egg is convex, so that its distance is a convex function along a line: Newton's steps from outside come to its
// root from one side, or to where it rises again, and then there is none.
//
// The distance is good to some u of the egg's size, so that a line that passes by more than a few of these is not met,
// and one that is as deep below the surface is.
//
// SPDX-License-Identifier: MIT
#include "trace/ovus.h"

#include "scene/ovus.h"
#include "trace/crossings.h"

enum { STEPS_MOST = 200 };

// What is beyond it is outside: an egg's corners are at 1 in each coordinate.
static const double REACH = 1.75;

typedef struct Line {
    Ovus ovus;
    Vec3 o, d; // seen from the point that is nearest to the middle
} Line;

static double distance_at(const Line *line, double t, double *slope)
{
    Vec3 normal;
    double distance = ovus_distance(&line->ovus, vec3_add_scaled(line->o, t, line->d), &normal);
    *slope = vec3_dot(normal, line->d);
    return distance;
}

// From a place outside on; `sign` is the direction. False: there is no root.
static bool root_from(const Line *line, double t, double sign, double *root)
{
    for (int i = 0; i < STEPS_MOST; i++) {
        double slope, distance = distance_at(line, t, &slope);
        if (!(distance > 0.0)) {
            break;
        }
        if (!(sign * slope < 0.0)) {
            return false;
        }
        double next = t - distance / slope;
        if (!(sign * next > sign * t)) {
            break;
        }
        t = next;
    }
    *root = t;
    return true;
}

unsigned ovus_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left, RayInterval *intervals)
{
    double square = vec3_length_squared(object->direction);
    double base = -vec3_dot(object->origin, object->direction) / square, first, last;
    Line line = {ovus_of(primitive->data), vec3_add_scaled(object->origin, base, object->direction), object->direction};
    double depth = REACH * REACH - vec3_length_squared(line.o);
    if (!(depth > 0.0)) {
        return 0;
    }
    double reach = sqrt(depth / square);
    if (!root_from(&line, -reach, 1.0, &first) || !root_from(&line, reach, -1.0, &last) || !(first <= last)) {
        return 0;
    }
    Crossing crossings[2] = {{base + first, 0}, {base + last, 0}};
    return crossings_intervals(crossings, 2, left, intervals);
}

Vec3 ovus_gradient(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    Ovus ovus = ovus_of(primitive->data);
    Vec3 normal;
    (void)side;
    (void)ovus_distance(&ovus, point, &normal);
    return normal;
}

Vec3 ovus_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    Ovus ovus = ovus_of(primitive->data);
    Vec3 normal;
    (void)side;
    double distance = ovus_distance(&ovus, point, &normal);
    return vec3_add_scaled(point, -distance, normal);
}
