// Warps: how space is bent on the way to a pattern.
//
// A list of records in the order in which a point comes to them. Each bends the point, then takes it through
// `to_outside` backwards, to the next one or to the pattern's own space. Plain data without padding, kept once where
// equal.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_WARP_H
#define SCENE_WARP_H

#include <stdint.h>

#include "math/transform.h"
#include "math/vec3.h"

typedef enum WarpType {
    WARP_TURBULENCE, // moves each point by noise
    WARP_REPEAT,     // one slice of space again and again
    WARP_BLACK_HOLE, // a ball in which points are drawn to its middle, or thrown out of it
    WARP_PLANAR,     // a plane's coordinates become x and y
    WARP_CYLINDRICAL,
    WARP_SPHERICAL,
    WARP_TOROIDAL,
    WARP_CUBIC,
    WARP_TYPES
} WarpType;

enum { WARP_INVERSE = 1 }; // of a black hole

typedef struct Warp {
    Transform to_outside; // from the space behind it
    Vec3 vector;   // turbulence: how far; repeat: along and how wide; black hole: its middle; mappings: orientation
    Vec3 offset;   // repeat: of each slice from the one before; black hole: how far its places are off
    Vec3 flip;     // repeat: components of every other slice that are turned; black hole: how wide what has one each is, 0 for all of space
    double radius; // black hole; planar: its distance; toroidal: of the ring
    double strength, power; // black hole
    double lambda, omega;   // turbulence
    double exponent;        // mappings: of the distance
    uint32_t octaves;       // turbulence
    uint32_t flags;         // WARP_...
    uint32_t type;          // WarpType
    uint32_t next;          // the one that follows, or RECORD_NONE
} Warp;

#endif
