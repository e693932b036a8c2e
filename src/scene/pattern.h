// Patterns: numbers spread over space, by which pigments and textures change from place to place.
//
// A pattern turns a point into a value from 0 to 1, or into the number of a block for those that fill space with blocks
// (checker, hexagon, brick). Plain data without padding, so that patterns can be compared bit by bit.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_PATTERN_H
#define SCENE_PATTERN_H

#include <stdbool.h>
#include <stdint.h>

#include "math/vec3.h"

typedef enum PatternType {
    PATTERN_NONE, // the same everywhere
    PATTERN_CHECKER,
    PATTERN_HEXAGON,
    PATTERN_BRICK,
    PATTERN_GRADIENT,
    PATTERN_RADIAL,
    PATTERN_ONION,
    PATTERN_LEOPARD,
    PATTERN_SPHERICAL,
    PATTERN_PLANAR,
    PATTERN_BOXED,
    PATTERN_CYLINDRICAL,
    PATTERN_BOZO,
    PATTERN_BUMPS,
    PATTERN_SPOTTED,
    PATTERN_GRANITE,
    PATTERN_AGATE,
    PATTERN_MARBLE,
    PATTERN_WOOD,
    PATTERN_WRINKLES,
    PATTERN_DENTS,
    PATTERN_RIPPLES,
    PATTERN_WAVES,
    PATTERN_IMAGE_MAP, // colours of a picture, of pigments only
    PATTERN_CELLS,
    PATTERN_CRACKLE,
    PATTERN_SPIRAL1,
    PATTERN_MANDEL,
    PATTERN_JULIA,
    PATTERN_QUILTED,
    PATTERN_SPIRAL2,
    PATTERN_FUNCTION,      // a formula of x, y and z
    PATTERN_PIGMENT,       // the grey of a pigment
    PATTERN_SLOPE,         // how the surface faces a direction, or a point
    PATTERN_AOI,           // how it faces the ray
    PATTERN_IMAGE_PATTERN, // what a picture tells as values
    PATTERN_BUMP_MAP,      // as heights, of normals only
    PATTERN_MATERIAL_MAP,  // as numbers of textures, of textures only
    PATTERN_OBJECT,        // whether a point is inside of an object
    PATTERN_AVERAGE,       // no pattern: all that lies along it, mixed
    PATTERN_COUNT
} PatternType;

enum { PATTERN_STEPS_MOST = 1000000 }; // of mandel and julia

enum {
    PATTERN_SOLID = 1,      // crackle: each cell has one value
    PATTERN_ON_SURFACE = 2, // its space holds the surface coordinates <u, v, 0> of what it lies on, and no places
    PATTERN_TO_POINT = 4,   // slope: `vector` is a point
};

typedef enum WaveType { WAVE_RAMP, WAVE_TRIANGLE, WAVE_SINE, WAVE_SCALLOP, WAVE_CUBIC, WAVE_POLY } WaveType;

typedef struct Pattern {
    uint32_t type; // PatternType
    uint32_t wave; // WaveType
    int32_t generator; // NoiseGenerator, 0: the scene's
    int32_t octaves;   // of turbulence, at least 1
    int32_t count;     // material_map: its textures; spiral1: its arms; mandel, julia: steps, at least 1
    uint32_t flags;    // PATTERN_SOLID and the like
    int32_t magnet, power;      // mandel, julia: which of the magnets, 0 for none; else the power of z in each step
    int32_t exterior, interior; // what is returned for points that leave, and for those that stay
    double exterior_factor, interior_factor;
    Vec3 vector;   // gradient: its direction as written; brick: the size of a brick with its mortar; julia: its number;
                   // quilted: its two control values; slope: the direction that it faces
    Vec3 form;     // crackle: what the distances to the nearest three points count; slope: along what heights count
    double metric, offset; // crackle: exponent of the distance, a distance in a fourth dimension; slope: the slopes of
                           // 0 and of 1, equal: its own; the factors above are such heights of it
    double mortar; // brick: width of the mortar
    double frequency, phase; // both of no effect where frequency is 0
    double exponent; // WAVE_POLY
    double agate_turb; // agate: of its own turbulence
    Vec3 turbulence;
    double lambda, omega; // of turbulence, see Octaves
    uint32_t image;       // of a picture: of Scene.image_maps; PATTERN_FUNCTION: the first of Scene.formula_steps;
                          // PATTERN_PIGMENT: of Scene.patterns; PATTERN_OBJECT: of Scene.insides; else 0
    uint32_t warps;  // 1 + the first of Scene.warps on the way to it; 0: there is none
} Pattern;

// What a pattern gives for a point.
typedef enum PatternForm {
    PATTERN_OF_VALUES, // one number
    PATTERN_OF_BLOCKS,
    PATTERN_OF_COLOURS,
    PATTERN_OF_ALL, // nothing: all that lies along it counts, by weights
} PatternForm;

typedef struct PatternInfo {
    const char *word;    // of the language
    PatternForm form;
    uint32_t blocks;     // kinds of block that fill space, 0 for another form
    bool has_direction;  // a vector follows the word
    bool has_count;      // a whole number follows
    bool uses_noise;
    bool has_own_turbulence; // turbulence is part of the formula
    WaveType wave;           // if none is said
    bool is_special_normal;  // turns a normal in a way of its own, not by its value
    bool is_of_surface;      // asks how the surface lies
} PatternInfo;

// The entry of a type, never NULL; PATTERN_NONE's word is "".
const PatternInfo *pattern_info(PatternType type);

// Whether it is made of a picture.
static inline bool pattern_is_picture(uint32_t type)
{
    return type == PATTERN_IMAGE_MAP ||
           (type >= PATTERN_IMAGE_PATTERN && type <= PATTERN_MATERIAL_MAP);
}
// "ramp_wave" and the like.
const char *pattern_wave_word(WaveType wave);

#endif
