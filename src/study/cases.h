// Families of rays that are hard for a sphere test, each in its own way, for those who compare with exact
// arithmetic.
//
// SPDX-License-Identifier: MIT
#ifndef STUDY_CASES_H
#define STUDY_CASES_H

#include <stdbool.h>

#include "math/ray.h"
#include "math/random.h"

typedef struct SphereCase {
    Ray ray;
    Vec3 centre;
    double radius;
} SphereCase;

typedef struct SphereFamily {
    const char *name;
    double distance;                // of the origin from the centre, in radii
    double impact_low, impact_high; // distance of the ray from the centre, in radii
    double radius, offset;          // offset: distance of the centre from 0
    double length;                  // of the direction, or its inverse, or between
} SphereFamily;

static const SphereFamily sphere_families[] = {
    {"ordinary", 5.0, 0.0, 1.5, 1.0, 10.0, 1.0},
    {"distance 1e3 radii", 1e3, 0.0, 1.5, 1.0, 0.0, 1.0},
    {"distance 1e6 radii", 1e6, 0.0, 1.5, 1.0, 0.0, 1.0},
    {"distance 1e12 radii", 1e12, 0.0, 1.5, 1.0, 0.0, 1.0},
    {"planet, height 1e-3 radii", 1.0 + 1e-3, 0.0, 1.0, 1e3, 1e3, 1.0},
    {"planet, height 1e-6 radii", 1.0 + 1e-6, 0.0, 1.0, 1e6, 1e6, 1.0},
    {"grazing 1 - 1e-4", 5.0, 1.0 - 1e-4, 1.0, 1.0, 10.0, 1.0},
    {"grazing 1 - 1e-8", 5.0, 1.0 - 1e-8, 1.0, 1.0, 10.0, 1.0},
    {"grazing 1 - 1e-14", 5.0, 1.0 - 1e-14, 1.0, 1.0, 10.0, 1.0},
    {"grazing 1 ± 1e-14", 5.0, 1.0 - 1e-14, 1.0 + 1e-14, 1.0, 10.0, 1.0},
    {"leaving a surface", 1.0, 0.0, 1.0, 1.0, 10.0, 1.0},
    {"inside", 0.7, 0.0, 1.0, 1.0, 10.0, 1.0},
    {"just inside", 1.0 - 1e-12, 0.0, 1.0, 1.0, 10.0, 1.0},
    {"offset 1e6", 5.0, 0.0, 1.5, 1.0, 1e6, 1.0},
    {"tiny, 1e-140", 5.0, 0.0, 1.5, 1e-140, 1e-139, 1.0},
    {"huge, 1e150", 5.0, 0.0, 1.5, 1e150, 1e151, 1.0},
    {"directions of length 1e-20 to 1e20", 5.0, 0.0, 1.5, 1.0, 10.0, 1e20},
};

// A sphere, an origin at the distance, and a ray that passes the centre at the impact parameter. Every eighth ray, and
// every ray from inside or from the surface, goes anywhere.
static inline SphereCase sphere_case(const SphereFamily *family, Random *random)
{
    Vec3 centre = vec3_scale(family->offset, random_direction(random));
    double radius = family->radius * random_between(random, 0.5, 2.0);
    Vec3 outward = random_direction(random);
    double distance = family->distance * (family->distance > 2.0 ? random_between(random, 1.0, 1.5) : 1.0);
    Vec3 origin = vec3_add_scaled(centre, radius * distance, outward);
    double sine = random_between(random, family->impact_low, family->impact_high) / distance;
    double cosine = sqrt(fmax(1.0 - sine * sine, 0.0));
    Vec3 direction = vec3_scale(sine, random_perpendicular(random, outward));
    direction = vec3_normalize(vec3_add_scaled(direction, -cosine, outward));
    if (distance <= 1.0 || random_bits(random) % 8 == 0) {
        direction = random_direction(random);
    }
    if (family->length != 1.0) {
        direction = vec3_scale(pow(family->length, random_between(random, -1, 1)), direction);
    }
    return (SphereCase){{origin, direction}, centre, radius};
}

#endif
