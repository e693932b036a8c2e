// Random numbers for tests and studies: splitmix64 (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number
// Generators", OOPSLA 2014), the same on every machine.
//
// SPDX-License-Identifier: MIT
#ifndef MATH_RANDOM_H
#define MATH_RANDOM_H

#include <math.h>
#include <stdint.h>

#include "math/vec3.h"

typedef struct Random {
    uint64_t state;
} Random;

static inline uint64_t random_bits(Random *random)
{
    uint64_t z = random->state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

static inline double random_between(Random *random, double low, double high)
{
    return low + (high - low) * ((double)(random_bits(random) >> 11) * 0x1p-53);
}

// Each component evenly from one range. One after the other: C leaves open in which order arguments are computed.
static inline Vec3 random_vec3(Random *random, double low, double high)
{
    double x = random_between(random, low, high);
    double y = random_between(random, low, high);
    double z = random_between(random, low, high);
    return vec3(x, y, z);
}

// Uniform on the unit sphere, of length 1 to rounding.
static inline Vec3 random_direction(Random *random)
{
    for (;;) {
        Vec3 v = random_vec3(random, -1, 1);
        double square = vec3_length_squared(v);
        if (square <= 1.0 && square > 0.01) {
            return vec3_normalize(v);
        }
    }
}

// A unit vector at right angles to the unit vector v.
static inline Vec3 random_perpendicular(Random *random, Vec3 v)
{
    for (;;) {
        Vec3 w = vec3_cross(v, random_direction(random));
        if (vec3_length_squared(w) > 0.01) {
            return vec3_normalize(w);
        }
    }
}

#endif
