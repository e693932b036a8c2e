// Patterns at a point: the value of one that varies, the block of one that fills space with blocks.
//
// Points are in the pattern's own space. The formulas are those of the scene language's manual, with what it leaves open
// measured; docs/language.md, "Patterns". Knows nothing of colours.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_PATTERN_H
#define RENDER_PATTERN_H

#include "math/noise.h"
#include "math/vec3.h"
#include "scene/pattern.h"

// Whether a pattern's value depends on noise.
bool pattern_needs_noise(const Pattern *pattern);

// What a scene's patterns take their noise from.
typedef struct NoiseSource {
    const Noise *noise;       // NULL when no pattern of the scene needs noise
    NoiseGenerator generator; // of patterns that say nothing else
} NoiseSource;

// From 0 to 1, after turbulence, frequency, phase and wave. For patterns without blocks.
double pattern_value(const Pattern *pattern, const NoiseSource *source, Vec3 point);

// The number of the block that holds the point, less than the pattern's count of blocks.
unsigned pattern_block(const Pattern *pattern, const NoiseSource *source, Vec3 point);

// The point at which a pattern is looked at: moved, if it has turbulence that is no part of its formula.
Vec3 pattern_moved(const Pattern *pattern, const NoiseSource *source, Vec3 point);

// The block at a point that is moved already.
unsigned pattern_block_moved(const Pattern *pattern, Vec3 moved);

// What a normal takes for height at a point that is moved already: the value, or the number of the block after frequency,
// phase and wave.
double pattern_height(const Pattern *pattern, const NoiseSource *source, Vec3 point);

#endif
