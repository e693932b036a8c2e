// The patterns `slope` and `aoi`: angles between a surface and a direction, from 0 to 1 for 180 degrees to 0.
//
// Measured: directions are those of the scene whatever moves the pattern, and so is a point; heights are the pattern's.
//
// SPDX-License-Identifier: MIT
#include "render/surface/facing.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

// Of two vectors of which the first is of length 1.
static double turned_to(Vec3 normal, Vec3 direction)
{
    double length = vec3_length(direction);
    double cosine = length > 0.0 ? vec3_dot(normal, direction) / length : -1.0; // the point itself is faced away from
    return 1.0 - acos(fmax(-1.0, fmin(cosine, 1.0))) / pi;
}

// From low to high, if they differ, becomes from 0 to 1.
static double within(double x, double low, double high)
{
    return low != high ? (x - low) / (high - low) : x;
}

// Whole turns of the map are left out at once, and exactly, and what is below 0 is in the turn before: other patterns do
// so after 1.00001, and after their `frequency`. Measured.
static double in_map(double x)
{
    double part = fabs(x) > 1.0 ? fmod(x, 1.0) : x;
    return part < 0.0 ? part + 1.0 : part;
}

double facing_slope(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    const Facing *facing = source->facing;
    if (!facing) {
        return 0.0;
    }
    Vec3 direction = pattern->flags & PATTERN_TO_POINT ? vec3_sub(pattern->vector, facing->point) : pattern->vector;
    double slope = within(turned_to(facing->normal, direction), pattern->metric, pattern->offset);
    double height_weight = vec3_length(pattern->form), slope_weight = vec3_length(pattern->vector);
    if (!(height_weight > 0.0)) {
        return in_map(slope);
    }
    double along = vec3_dot(p, pattern->form) / height_weight;
    double height = within(along, pattern->exterior_factor, pattern->interior_factor);
    return in_map((slope_weight * slope + height_weight * height) / (slope_weight + height_weight));
}

double facing_aoi(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)pattern;
    (void)p;
    return source->facing ? turned_to(source->facing->normal, vec3_neg(source->facing->direction)) : 0.0;
}
